//! `import`: foreign files as measurements.

use super::arguments::Import;
use super::failure::Failure;
use super::{input, interrupt, output};
use pbrdf::measurement::{self, Measurement, is_woollam, read_woollam};
use std::process::ExitCode;

pub fn run(task: &Import) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let bytes = input::bytes(&task.input)?;
    let mut measurement = if is_woollam(&bytes) {
        woollam(task, &bytes)?
    } else {
        return Err(Failure::input(&task.input, "this is not a file that import knows; expected Woollam ellipsometry text"));
    };
    let name = task.input.file_name().map(|name| name.to_string_lossy().replace(char::is_control, " "));
    measurement.metadata.push(("imported_from".to_owned(), name.unwrap_or_default()));
    output::write(task.output.as_deref(), |out| measurement::write(&measurement, out))?;
    Ok(ExitCode::SUCCESS)
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
