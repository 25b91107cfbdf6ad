//! Files from the command line.

use crate::cli::failure::Failure;
use crate::cli::interrupt;
use crate::cli::output::{Progress, notice};
use crate::open_file::open_file;
use pbrdf::measurement;
use pbrdf::measurement::{Measurement, ReadError, ReadErrorKind};
use std::io::Read as _;
use std::ops::ControlFlow;
use std::path::Path;

/// The bytes of a file.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let mut file = open_file(path).map_err(|reason| Failure::input(path, reason))?;
    file.read_to_end(&mut bytes).map_err(|error| Failure::input(path, format!("the file cannot be read: {error}")))?;
    Ok(bytes)
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
        notice(format_args!("{}: {}.", path.display(), measurement.ignored_notice()));
    }
    Ok(measurement)
}
