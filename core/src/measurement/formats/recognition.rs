//! The table of forms, and which of them a file has.

use super::error::ImportError;
use super::format::{ForeignFile, Format};
use super::pbsdf::Pbsdf;
use super::pgii::PabPgii;
use super::table::ForeignTable;
use super::woollam::Woollam;
use crate::measurement::{Measurement, Progress};

/// The forms that are recognised by content, in the order in which they are tried.
pub static FORMATS: &[&dyn Format] = &[&Woollam, &Pbsdf, &PabPgii];

/// Usual endings of the names of files of this project and of tables.
const TABLE_EXTENSIONS: [&str; 3] = ["csv", "tsv", "txt"];

/// The form of a file, where its content tells.
#[must_use]
pub fn recognise(bytes: &[u8]) -> Option<&'static dyn Format> {
    FORMATS.iter().copied().find(|format| format.sniff(bytes))
}

/// Usual endings of the names of all files that can be opened, each once.
#[must_use]
pub fn extensions() -> Vec<&'static str> {
    let mut extensions = TABLE_EXTENSIONS.to_vec();
    for extension in FORMATS.iter().flat_map(|format| format.extensions()) {
        if !extensions.contains(extension) {
            extensions.push(extension);
        }
    }
    extensions
}

/// What a file holds.
pub enum Opened {
    /// A measurement in this project's own form.
    Measurement(Measurement),
    /// A file that has questions, or none.
    Foreign(Box<dyn ForeignFile>),
}

/// Reads any file: a form of [`FORMATS`], a measurement of this project's own, or a foreign table.
///
/// # Errors
/// The file is damaged, is no table with two columns of numbers, or `progress` stops the reading.
pub fn open(bytes: Vec<u8>, progress: Progress<'_>) -> Result<Opened, ImportError> {
    if let Some(format) = recognise(&bytes) {
        return format.open(bytes, progress).map(Opened::Foreign);
    }
    match Measurement::read_with(&bytes[..], progress) {
        Ok(measurement) => Ok(Opened::Measurement(measurement)),
        Err(error) if error.is_about_names() => Ok(Opened::Foreign(Box::new(ForeignTable::new(bytes, error)?))),
        Err(error) => Err(error.into()),
    }
}
