//! Tables of parameter sets, such as `posterior -o` writes them.

use crate::cli::failure::Failure;
use crate::cli::input::{bytes, read_failure, while_reading};
use pbrdf::measurement::{Expected, Table};
use pbrdf::model::{Parameter, Parameters};
use std::path::Path;

/// The sets of a table with a column for each parameter that varies; the others are as they are elsewhere.
pub fn parameter_sets(path: &Path, others: Parameters) -> Result<Vec<Parameters>, Failure> {
    let read = |error| read_failure(path, &error);
    let table = Table::new(&*bytes(path)?).map_err(read)?;
    let mut columns: Vec<(Parameter, usize)> = Vec::new();
    for parameter in Parameter::ALL {
        if let Some(column) = table.find(parameter.key()).map_err(read)? {
            columns.push((parameter, column));
        }
    }
    if columns.is_empty() {
        return Err(Failure::input(path, format!("no column is a parameter; expected some of {}", Parameter::keys())));
    }
    let mut sets = Vec::new();
    table
        .for_each(&mut while_reading(), |record| {
            let mut parameters = others;
            for &(parameter, column) in &columns {
                parameters[parameter] = record.number(column, Expected::Parameter(parameter.domain()))?;
            }
            sets.push(parameters);
            Ok(())
        })
        .map_err(read)?;
    if sets.is_empty() {
        return Err(Failure::input(path, "there is no row with a parameter set"));
    }
    Ok(sets)
}
