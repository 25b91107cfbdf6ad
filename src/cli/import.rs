//! `import`: foreign files as measurements.

use crate::cli::arguments::ImportArguments;
use crate::cli::failure::Failure;
use crate::cli::{input, interrupt, output};
use pbrdf::measurement;
use pbrdf::measurement::{
    Field, Mapping, Measurement, Table, grid_geometries, is_tensor, is_woollam, read_mapped, read_tensor, read_woollam,
};
use std::process::ExitCode;

pub fn run(task: &ImportArguments) -> Result<ExitCode, Failure> {
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
    let Ok(table) = Table::foreign(bytes) else { return format!("{unknown} theta_i=1,theta_r=2,dolp=3") };
    let guess = Mapping::guess(table.header(), table.metadata());
    if guess.columns.is_empty() {
        return format!("{unknown} theta_i=1,theta_r=2,dolp=3");
    }
    if !guess.has_quantity() {
        return format!("{unknown}; no column for DoLP or BRDF was found, the columns are {}", table.titles());
    }
    let option = |name: &str, angle: Option<f64>| angle.map_or_else(String::new, |angle| format!(" --{name} {angle}"));
    format!("{unknown}; its header suggests --columns {guess}{}{}", option("theta-i", guess.theta_i), option("dphi", guess.dphi))
}

/// The columns that were named, and the angles that were given for want of a column.
fn with_constants(task: &ImportArguments, columns: &Mapping) -> Result<Mapping, Failure> {
    let theta_i = match task.theta_i.as_ref().map(|grid| grid.0.as_slice()) {
        None => None,
        Some(&[only]) => Some(only),
        Some(_) if columns.find(Field::ThetaI).is_some() => None,
        Some(_) => return Err(Failure::usage("--theta-i has to be one angle where a table has no column for it.")),
    };
    for (name, field, is_given) in [("theta-i", Field::ThetaI, task.theta_i.is_some()), ("dphi", Field::Dphi, task.dphi.is_some())] {
        if is_given && columns.find(field).is_some() {
            output::notice(format_args!("{}: --{name} is not used; there is a column for it.", task.input.display()));
        }
    }
    Ok(Mapping { theta_i, dphi: task.dphi, ..columns.clone() })
}

fn mapped(task: &ImportArguments, bytes: &[u8], mapping: &Mapping) -> Result<Measurement, Failure> {
    let mapping = with_constants(task, mapping)?;
    let measurement =
        read_mapped(bytes, &mapping, &mut input::while_reading()).map_err(|error| input::read_failure(&task.input, &error))?;
    if !measurement.ignored_columns.is_empty() {
        output::notice(format_args!("{}: {}.", task.input.display(), measurement.ignored_notice()));
    }
    Ok(measurement)
}

fn woollam(task: &ImportArguments, bytes: &[u8]) -> Result<Measurement, Failure> {
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

fn not_chosen(task: &ImportArguments, error: &measurement::WavelengthError) -> Failure {
    let hint = if task.wavelength.is_none() { " with --wavelength" } else { "" };
    Failure::input(&task.input, format!("{error}{hint}"))
}

/// Says which wavelengths were taken in place of the one asked for.
fn notice_nearest(task: &ImportArguments, taken_nm: &[f64]) {
    if let Some(wanted) = task.wavelength.filter(|wanted| taken_nm != [*wanted]) {
        let taken: Vec<String> = taken_nm.iter().map(f64::to_string).collect();
        output::notice(format_args!("{}: has no {wanted} nm; the nearest was taken, {} nm.", task.input.display(), taken.join(" and ")));
    }
}

fn tensor(task: &ImportArguments, bytes: &[u8]) -> Result<Measurement, Failure> {
    let tensor = read_tensor(bytes).map_err(|error| Failure::input(&task.input, error))?;
    let path = task.input.display();
    if !tensor.assumed_grids().is_empty() {
        let names = tensor.assumed_grids().join(", ");
        output::notice(format_args!("{path}: gives no angles for {names}; they are taken to be even over their whole range."));
    }
    let theta_i = task.theta_i.as_ref().map_or_else(|| vec![15.0, 30.0, 45.0, 60.0, 75.0], |grid| grid.0.clone());
    let geometries =
        grid_geometries(&theta_i, &task.theta_r.0, task.dphi.unwrap_or(180.0)).map_err(|error| Failure::usage(format!("{error}.")))?;
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
