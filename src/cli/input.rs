//! Files from the command line.

use super::failure::Failure;
use super::interrupt;
use super::output::{Progress, notice};
use pbrdf::measurement::{self, Measurement, ReadError, ReadErrorKind};
use std::ops::ControlFlow;
use std::path::Path;

/// The bytes of a file.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    std::fs::read(path).map_err(|error| Failure::input(path, open_reason(path, &error)))
}

/// Why a file cannot be opened or read, without the operating system's numbers.
pub fn open_reason(path: &Path, error: &std::io::Error) -> String {
    match error.kind() {
        _ if path.is_dir() => "this is a directory; expected a file".to_owned(),
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission to read the file is denied".to_owned(),
        _ => format!("the file cannot be read: {error}"),
    }
}

/// Turns an error of a reader into the failure of a command.
pub fn read_failure(path: &Path, error: &ReadError) -> Failure {
    match error.kind {
        ReadErrorKind::Cancelled => Failure::interrupted(),
        _ => Failure::input(path, error),
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

/// A measurement, with a notice of the columns that mean nothing here.
pub fn measurement(path: &Path, bytes: &[u8]) -> Result<Measurement, Failure> {
    let measurement = measurement::read(bytes, &mut while_reading()).map_err(|error| read_failure(path, &error))?;
    if !measurement.ignored_columns.is_empty() {
        notice(format_args!("{}: ignored the columns {}.", path.display(), measurement.ignored_columns.join(", ")));
    }
    Ok(measurement)
}
