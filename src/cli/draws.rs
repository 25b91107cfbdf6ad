//! Tables of parameter sets, such as `posterior -o` writes them.

use crate::cli::failure::Failure;
use crate::cli::input::{bytes, read_failure, while_reading};
use pbrdf::measurement::{Expected, Table};
use pbrdf::model::{Parameter, Parameters};
use std::path::Path;

/// The sets of a table with a column for each parameter that varies; the others are as they are elsewhere. A row of draws of several
/// measurements, with columns such as `n@FILE`, is a set for each of them.
pub fn parameter_sets(path: &Path, others: Parameters) -> Result<Vec<Parameters>, Failure> {
    let read = |error| read_failure(path, &error);
    let table = Table::new(&*bytes(path)?).map_err(read)?;
    let mut columns: Vec<(Parameter, usize)> = Vec::new();
    for parameter in Parameter::ALL {
        if let Some(column) = table.find(parameter.key()).map_err(read)? {
            columns.push((parameter, column));
        }
    }
    let mut own: Vec<(&str, Vec<(Parameter, usize)>)> = Vec::new();
    for (column, name) in table.header().iter().enumerate() {
        let Some((key, set)) = name.split_once('@') else { continue };
        let Some(parameter) = Parameter::from_key(key) else { continue };
        table.find(name).map_err(read)?;
        match own.iter_mut().find(|(other, _)| *other == set) {
            Some((_, of_set)) => of_set.push((parameter, column)),
            None => own.push((set, vec![(parameter, column)])),
        }
    }
    if columns.is_empty() && own.is_empty() {
        return Err(Failure::input(path, format!("no column is a parameter; expected some of {}", Parameter::keys())));
    }
    let mut sets = Vec::new();
    table
        .for_each(&mut while_reading(), |record| {
            let read = |parameters: &mut Parameters, columns: &[(Parameter, usize)]| {
                columns.iter().try_for_each(|&(parameter, column)| {
                    parameters[parameter] = record.number(column, Expected::Parameter(parameter.domain()))?;
                    Ok(())
                })
            };
            let mut shared = others;
            read(&mut shared, &columns)?;
            for (_, of_set) in &own {
                let mut parameters = shared;
                read(&mut parameters, of_set)?;
                sets.push(parameters);
            }
            if own.is_empty() {
                sets.push(shared);
            }
            Ok(())
        })
        .map_err(read)?;
    if sets.is_empty() {
        return Err(Failure::input(path, "there is no row with a parameter set"));
    }
    Ok(sets)
}
