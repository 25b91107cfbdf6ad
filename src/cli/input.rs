//! Files from the command line.

use crate::cli::failure::{Failure, input_name, is_standard_input};
use crate::cli::import_command::{command, options_for};
use crate::cli::interrupt;
use crate::cli::output::{Progress, notice};
use crate::files::open_file::open_file;
use pbrdf::measurement::foreign::{OtherFormat, is_workbook};
use pbrdf::measurement::formats::{ImportNote, recognise};
use pbrdf::measurement::{Hint, Measurement, ReadError, ReadErrorKind};
use std::io::Read as _;
use std::ops::ControlFlow;
use std::path::Path;

/// The bytes of a file, or of standard input where the path is `-`.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    if is_standard_input(path) {
        let read = interrupt::waiting(|| std::io::stdin().lock().read_to_end(&mut bytes));
        return read.map(|_| bytes).map_err(|error| Failure::input(path, format!("it cannot be read: {error}")));
    }
    let mut file = open_file(path).map_err(|reason| Failure::input(path, reason))?;
    file.read_to_end(&mut bytes).map_err(|error| Failure::input(path, format!("the file cannot be read: {error}")))?;
    Ok(bytes)
}

/// Turns an error of a reader into the failure of a command, with its hint.
pub fn read_failure(path: &Path, error: &ReadError) -> Failure {
    match (&error.kind, error.hint()) {
        (ReadErrorKind::Cancelled, _) => Failure::interrupted(),
        // Another form is for `measurement` to tell: other tables are no measurements.
        (_, None | Some(Hint::Import)) => Failure::input(path, error),
        (_, Some(hint)) => Failure::input(path, format_args!("{error}; {hint}")),
    }
}

/// Tells how much is read; stops on Ctrl-C.
pub fn while_reading() -> impl FnMut(f64) -> ControlFlow<()> {
    let mut progress = Progress::new("reading");
    move |done| {
        progress.tell_fraction(done);
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A measurement, with a notice of the columns that are not used.
pub fn measurement(path: &Path, bytes: &[u8]) -> Result<Measurement, Failure> {
    let measurement = Measurement::read_with(bytes, &mut while_reading()).map_err(|error| measurement_failure(path, bytes, &error))?;
    notice_of_reading(path, &measurement);
    Ok(measurement)
}

/// The measurements of a file, one for each set and wavelength, with a notice of the columns that are not used.
pub fn measurements(path: &Path, bytes: &[u8]) -> Result<Vec<Measurement>, Failure> {
    let read = Measurement::read_sets(bytes, &mut while_reading());
    let measurements = read.map_err(|error| measurement_failure(path, bytes, &error))?;
    if let Some(first) = measurements.first() {
        notice_of_reading(path, first);
    }
    Ok(measurements)
}

/// What the reader of a file has to say: its notices, and the columns that no row uses.
pub fn notices(measurement: &Measurement) -> Vec<String> {
    let names = &measurement.ignored_columns;
    let ignored = (!names.is_empty()).then(|| ImportNote::IgnoredColumns { names: names.clone() });
    measurement.notes.iter().chain(&ignored).map(ToString::to_string).collect()
}

/// The same on stderr.
pub fn notice_of_reading(path: &Path, measurement: &Measurement) {
    for note in notices(measurement) {
        notice(format_args!("{}: {note}.", input_name(path)));
    }
}

/// The failure of a command whose input is no measurement; for a foreign file with the command that
/// imports it.
pub fn measurement_failure(path: &Path, bytes: &[u8], error: &ReadError) -> Failure {
    if error.may_be_foreign() || recognise(bytes).is_some() || is_workbook(bytes) {
        if let Some(other) = OtherFormat::of(bytes) {
            let command = other.options.map_or_else(String::new, |options| format!("; to import it, use {}", command(path, options)));
            return Failure::input(path, format_args!("{other}{command}"));
        }
        if let Some(options) = options_for(bytes) {
            let command = command(path, &options);
            return Failure::input(path, format_args!("{error}; to import it, use {command}"));
        }
    }
    read_failure(path, error)
}
