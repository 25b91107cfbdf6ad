//! `import`: foreign files as measurements.

use super::arguments::Import;
use super::failure::Failure;
use super::{input, interrupt, output};
use pbrdf::measurement::{
    self, Mapping, Measurement, Table, grid_geometries, is_tensor, is_woollam, read_mapped, read_tensor, read_woollam,
};
use std::process::ExitCode;

pub fn run(task: &Import) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let bytes = input::bytes(&task.input)?;
    let mut measurement = if let Some(mapping) = &task.columns {
        mapped(task, &bytes, mapping)?
    } else if is_woollam(&bytes) {
        woollam(task, &bytes)?
    } else if is_tensor(&bytes) {
        tensor(task, &bytes)?
    } else {
        return Err(Failure::input(&task.input, unknown(&bytes)));
    };
    let name = task.input.file_name().map(|name| name.to_string_lossy().replace(char::is_control, " "));
    measurement.metadata.push(("imported_from".to_owned(), name.unwrap_or_default()));
    output::write(task.output.as_deref(), |out| measurement::write(&measurement, out))?;
    Ok(ExitCode::SUCCESS)
}

/// What to do with a file that says nothing of itself.
fn unknown(bytes: &[u8]) -> String {
    let unknown = "this is neither Woollam ellipsometry text nor a tensor file (.pbsdf); name the columns of a table with --columns";
    let guess = Table::new(bytes).map(|table| Mapping::guess(table.header())).unwrap_or_default();
    if guess.columns.is_empty() {
        format!("{unknown} theta_i=1,theta_r=2,dolp=3")
    } else {
        format!("{unknown}; its header suggests --columns {guess}")
    }
}

fn mapped(task: &Import, bytes: &[u8], mapping: &Mapping) -> Result<Measurement, Failure> {
    let measurement = read_mapped(bytes, mapping, &mut input::while_reading()).map_err(|error| input::read_failure(&task.input, &error))?;
    if !measurement.ignored_columns.is_empty() {
        output::notice(format_args!("{}: {}.", task.input.display(), measurement.ignored_notice()));
    }
    Ok(measurement)
}

fn woollam(task: &Import, bytes: &[u8]) -> Result<Measurement, Failure> {
    let ellipsometry = read_woollam(bytes, &mut input::while_reading()).map_err(|error| input::read_failure(&task.input, &error))?;
    let path = task.input.display();
    for (name, count) in &ellipsometry.ignored {
        output::notice(format_args!("{path}: ignored {count} rows of {name}."));
    }
    if !ellipsometry.depolarisation.is_empty() {
        let count = ellipsometry.depolarisation.len();
        output::notice(format_args!("{path}: {count} rows of depolarisation (dpolE) are named in the metadata, not applied to DoLP."));
    }
    let slice = ellipsometry.specular_dolp(task.wavelength).map_err(|error| not_chosen(task, &error))?;
    notice_nearest(task, &slice.wavelengths_nm);
    for theta_i in &slice.left_out {
        output::notice(format_args!("{path}: left out θi = {theta_i}°, which has no wavelength near the one asked for."));
    }
    Ok(slice.measurement)
}

fn not_chosen(task: &Import, error: &measurement::WavelengthError) -> Failure {
    let hint = if task.wavelength.is_none() { " with --wavelength" } else { "" };
    Failure::input(&task.input, format!("{error}{hint}"))
}

/// Says which wavelengths were taken in place of the one asked for.
fn notice_nearest(task: &Import, taken_nm: &[f64]) {
    if let Some(wanted) = task.wavelength.filter(|wanted| taken_nm != [*wanted]) {
        let taken: Vec<String> = taken_nm.iter().map(f64::to_string).collect();
        output::notice(format_args!("{}: has no {wanted} nm; the nearest was taken, {} nm.", task.input.display(), taken.join(" and ")));
    }
}

fn tensor(task: &Import, bytes: &[u8]) -> Result<Measurement, Failure> {
    let tensor = read_tensor(bytes).map_err(|error| Failure::input(&task.input, error))?;
    let path = task.input.display();
    if !tensor.assumed_grids().is_empty() {
        let names = tensor.assumed_grids().join(", ");
        output::notice(format_args!("{path}: gives no angles for {names}; they are taken to be even over their whole range."));
    }
    let geometries = grid_geometries(&task.theta_i.0, &task.theta_r.0, task.dphi).map_err(|error| Failure::usage(format!("{error}.")))?;
    let slice = tensor.slice(&geometries, task.wavelength).map_err(|error| not_chosen(task, &error))?;
    notice_nearest(task, &[slice.wavelength_nm]);
    if slice.without_value > 0 {
        output::notice(format_args!("{path}: left out {} geometries without a value.", slice.without_value));
    }
    if slice.beyond_one > 0 {
        output::notice(format_args!("{path}: left out the DoLP of {} geometries where it is above 1.", slice.beyond_one));
    }
    if slice.measurement.rows.is_empty() {
        return Err(Failure::input(&task.input, "none of the geometries has a value"));
    }
    Ok(slice.measurement)
}
