//! `import`: foreign files as measurements.

use crate::cli::arguments::ImportArguments;
use crate::cli::failure::Failure;
use crate::cli::{input, interrupt, output};
use pbrdf::measurement::formats::{FORMATS, Format, ImportError, ImportNote, ImportOptions, Imported, recognise};
use pbrdf::measurement::{Field, Mapping, Measurement, Table};
use std::process::ExitCode;

pub fn run(task: &ImportArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let bytes = input::bytes(&task.input)?;
    let mut measurement = if let Some(mapping) = &task.columns {
        mapped(task, &bytes, mapping)?
    } else if let Some(format) = recognise(&bytes) {
        recognised(task, format, bytes)?
    } else {
        return Err(Failure::input(&task.input, unknown(&bytes)));
    };
    let name = task.input.file_name().map(|name| name.to_string_lossy().replace(char::is_control, " "));
    measurement.metadata.push(("imported_from".to_owned(), name.unwrap_or_default()));
    output::write(task.output.as_deref(), |out| measurement.write(out))?;
    Ok(ExitCode::SUCCESS)
}

/// The answer to a file whose content does not tell its form.
fn unknown(bytes: &[u8]) -> String {
    let names: Vec<&str> = FORMATS.iter().map(|format| format.name()).collect();
    let unknown = format!("this is neither {}; name the columns of a table with --columns", names.join(" nor "));
    let guess = Table::foreign(bytes).ok().map(|table| (Mapping::guess(table.header(), table.metadata()), table.titles()));
    match guess {
        Some((guess, names)) if !guess.columns.is_empty() => {
            if guess.has_quantity() {
                format!("{unknown}; its header suggests {}", input::columns_options(&guess))
            } else {
                format!("{unknown}; no column for DoLP or BRDF was found, the columns are {}", names.join(", "))
            }
        }
        _ => format!("{unknown} theta_i=1,theta_r=2,dolp=3"),
    }
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
    let measurement = mapping.read_table(bytes, &mut input::while_reading()).map_err(|error| input::read_failure(&task.input, &error))?;
    input::notice_of_reading(&task.input, &measurement);
    Ok(measurement)
}

/// The measurement of a file whose content tells its form.
fn recognised(task: &ImportArguments, format: &dyn Format, bytes: Vec<u8>) -> Result<Measurement, Failure> {
    let file = format.open(bytes, &mut input::while_reading()).map_err(|error| failure(task, &error))?;
    notice_all(task, &file.notes());
    let options = ImportOptions {
        wavelength_nm: task.wavelength,
        theta_i: task.theta_i.as_ref().map_or_else(ImportOptions::offered_theta_i, |grid| grid.0.clone()),
        theta_r: task.theta_r.0.clone(),
        dphi: task.dphi,
        ..ImportOptions::default()
    };
    let Imported { measurement, notes } = file.import(&options, &mut input::while_reading()).map_err(|error| {
        if let ImportError::NoValue { notes } = &error {
            notice_all(task, notes);
        }
        failure(task, &error)
    })?;
    notice_all(task, &notes);
    Ok(measurement)
}

fn notice_all(task: &ImportArguments, notes: &[ImportNote]) {
    for note in notes {
        output::notice(format_args!("{}: {note}.", task.input.display()));
    }
}

fn failure(task: &ImportArguments, error: &ImportError) -> Failure {
    match error {
        ImportError::Read(error) => input::read_failure(&task.input, error),
        ImportError::Geometry(error) => Failure::usage(format!("{error}.")),
        ImportError::Wavelength(error) if task.wavelength.is_none() => {
            Failure::input(&task.input, format_args!("{error} with --wavelength"))
        }
        _ => Failure::input(&task.input, error),
    }
}
