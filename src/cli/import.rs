//! `import`: foreign files as measurements.

use crate::cli::arguments::ImportArguments;
use crate::cli::failure::{Failure, input_name, is_standard_input};
use crate::cli::{input, interrupt, output};
use pbrdf::measurement::foreign::{LabTable, TableOptions, is_workbook};
use pbrdf::measurement::formats::{ForeignFile, Format, ImportError, ImportNote, ImportOptions, Imported, Question, recognise};
use pbrdf::measurement::{Measurement, ReadErrorKind, write_measurements};
use std::process::ExitCode;

pub fn run(task: &ImportArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let bytes = input::bytes(&task.input)?;
    let mut imported = match recognise(&bytes).filter(|_| task.columns.is_none()) {
        Some(format) => recognised(task, format, bytes)?,
        None => table(task, bytes)?,
    };
    let name = task
        .input
        .file_name()
        .filter(|_| !is_standard_input(&task.input))
        .map(|name| name.to_string_lossy().replace(char::is_control, " "));
    let source = ("imported_from".to_owned(), name.unwrap_or_default());
    imported.measurements.iter_mut().for_each(|measurement| measurement.metadata.push(source.clone()));
    notice_all(task, &imported.notes);
    write(task, &imported.measurements)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes one table, or where the output is a folder one file for each measurement.
fn write(task: &ImportArguments, measurements: &[Measurement]) -> Result<(), Failure> {
    let folder = task.output.as_deref().filter(|path| path.is_dir() || path.to_string_lossy().ends_with(['/', '\\']));
    let Some(folder) = folder else {
        return output::write(task.output.as_deref(), |out| write_measurements(measurements, out));
    };
    std::fs::create_dir_all(folder).map_err(|error| Failure::output(folder.display(), &error))?;
    let stem = task.input.file_stem().map_or_else(|| "measurement".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let mut taken: Vec<String> = Vec::new();
    for (index, measurement) in measurements.iter().enumerate() {
        let plain: String =
            measurement.name.chars().map(|letter| if letter.is_alphanumeric() || "-_. ".contains(letter) { letter } else { '_' }).collect();
        let mut name = if plain.trim().is_empty() { stem.clone() } else { format!("{stem} {}", plain.trim()) };
        if taken.contains(&name) {
            name = format!("{name} {}", index + 1);
        }
        output::write(Some(&folder.join(format!("{name}.csv"))), |out| measurement.write(out))?;
        taken.push(name);
    }
    Ok(())
}

/// What the options say about a table.
fn table_options(task: &ImportArguments) -> Result<TableOptions, Failure> {
    let theta_i = match task.theta_i.as_ref().map(|grid| grid.0.as_slice()) {
        None => None,
        Some(&[only]) => Some(only),
        Some(_) => return Err(Failure::usage("--theta-i has to be one angle where a table has no column for it.")),
    };
    Ok(TableOptions {
        columns: task.columns.clone(),
        sheet: task.sheet.clone(),
        thousands: task.thousands,
        flip: task.flip,
        wide: task.wide,
        normalised: task.normalised,
        brdf_is: task.brdf_is,
        theta_i,
        dphi: task.dphi,
        wavelength_nm: task.wavelength,
    })
}

/// The measurements of a table: one of this project's own as it is, another by its guess or by
/// `--columns`.
fn table(task: &ImportArguments, bytes: Vec<u8>) -> Result<Imported, Failure> {
    let options = table_options(task)?;
    if options == TableOptions::default()
        && !is_workbook(&bytes)
        && let Ok(measurements) = Measurement::read_sets(&bytes[..], &mut input::while_reading())
    {
        let mut notes: Vec<ImportNote> = measurements.iter().flat_map(|measurement| measurement.notes.clone()).collect();
        let ignored = measurements[0].ignored_columns.clone();
        notes.extend((!ignored.is_empty()).then_some(ImportNote::IgnoredColumns { names: ignored }));
        let signed = || measurements.iter().flat_map(|measurement| &measurement.rows).map(|row| row.geometry.signed_theta_r().0);
        if signed().any(|theta_r| theta_r < 0.0) && signed().all(|theta_r| theta_r <= 0.0) {
            notes.push(ImportNote::AllBackscatter);
        }
        return Ok(Imported { measurements, notes });
    }
    let table = LabTable::open(bytes, &options, &mut input::while_reading()).map_err(|error| failure(task, &error))?;
    let guess = table.guess(&options).map_err(|error| input::read_failure(&task.input, &error))?;
    if task.columns.is_none() {
        output::notice(format_args!("{}: {guess}", input_name(&task.input)));
        if !task.auto && guess.doubts.is_empty() {
            return Err(Failure::input(&task.input, "take this guess with --auto, or name the columns with --columns"));
        }
    }
    for (name, is_given, field) in [
        ("theta-i", task.theta_i.is_some(), pbrdf::measurement::Field::ThetaI),
        ("dphi", task.dphi.is_some(), pbrdf::measurement::Field::Dphi),
    ] {
        if is_given && guess.columns.iter().flatten().any(|column| column.field == Some(field)) {
            output::notice(format_args!("{}: --{name} is not used; there is a column for it.", input_name(&task.input)));
        }
    }
    table.read(&options, &mut input::while_reading()).map_err(|error| failure(task, &error))
}

/// The measurement of a file whose content tells its form.
fn recognised(task: &ImportArguments, format: &dyn Format, bytes: Vec<u8>) -> Result<Imported, Failure> {
    let file = format.open(bytes, &mut input::while_reading()).map_err(|error| failure(task, &error))?;
    notice_all(task, &file.notes());
    let questions = file.questions();
    let has_slices = questions.iter().any(|question| matches!(question, Question::Directions));
    let offered = || if has_slices { ImportOptions::offered_theta_i() } else { Vec::new() };
    let options = ImportOptions {
        wavelength_nm: task.wavelength,
        theta_i: task.theta_i.as_ref().map_or_else(offered, |grid| grid.0.clone()),
        theta_r: task.theta_r.0.clone(),
        dphi: task.dphi,
        ..ImportOptions::default()
    };
    let wavelengths = questions.iter().find_map(|question| match question {
        Question::Wavelength { available_nm } if task.auto && task.wavelength.is_none() => Some(available_nm),
        _ => None,
    });
    if let Some(available_nm) = wavelengths {
        return every_wavelength(task, &*file, &options, available_nm);
    }
    file.import(&options, &mut input::while_reading()).map_err(|error| {
        if let ImportError::NoValue { notes } = &error {
            notice_all(task, notes);
        }
        failure(task, &error)
    })
}

/// With --auto and without --wavelength: a measurement for each wavelength.
fn every_wavelength(
    task: &ImportArguments,
    file: &dyn ForeignFile,
    options: &ImportOptions,
    available_nm: &[f64],
) -> Result<Imported, Failure> {
    let mut all = Imported::default();
    for &wavelength_nm in available_nm {
        let options = ImportOptions { wavelength_nm: Some(wavelength_nm), ..options.clone() };
        let imported = file.import(&options, &mut input::while_reading()).map_err(|error| failure(task, &error))?;
        for mut measurement in imported.measurements {
            measurement.name = format!("{wavelength_nm} nm");
            all.measurements.push(measurement);
        }
    }
    Ok(all)
}

fn notice_all(task: &ImportArguments, notes: &[ImportNote]) {
    for note in notes {
        output::notice(format_args!("{}: {note}.", input_name(&task.input)));
    }
}

fn failure(task: &ImportArguments, error: &ImportError) -> Failure {
    match error {
        ImportError::Read(error) if matches!(error.kind, ReadErrorKind::NoNumbers) => Failure::input(
            &task.input,
            format_args!("{error}; if it is a table, name its columns as in --columns theta_i=1,theta_r=2,dolp=3"),
        ),
        ImportError::Read(error) => input::read_failure(&task.input, error),
        ImportError::Geometry(error) => Failure::usage(format!("{error}.")),
        ImportError::Wavelength(error) if task.wavelength.is_none() => {
            Failure::input(&task.input, format_args!("{error} with --wavelength"))
        }
        _ => Failure::input(&task.input, error),
    }
}
