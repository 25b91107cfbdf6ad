//! The table of forms, and which of them a file has.

use super::ellipsometer_table::EllipsometerTable;
use super::error::ImportError;
use super::film_sense::FilmSense;
use super::format::{ForeignFile, Format};
use super::pbsdf::Pbsdf;
use super::pgii::PabPgii;
use super::spectraray::SpectraRay;
use super::table::ForeignTable;
use super::woollam::Woollam;
use super::zemax::Zemax;
use crate::measurement::foreign::{OtherFormat, is_workbook};
use crate::measurement::{Field, Hint, Measurement, Progress, ReadError, ReadErrorKind};

/// The forms that are recognised by content, in the order in which they are tried.
pub static FORMATS: &[&dyn Format] = &[&Woollam, &EllipsometerTable, &SpectraRay, &FilmSense, &Pbsdf, &PabPgii, &Zemax];

/// Usual endings of the names of files of this project and of tables.
const TABLE_EXTENSIONS: [&str; 6] = ["csv", "tsv", "txt", "xlsx", "xls", "ods"];

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

/// Whether an answer about the thousands separator would help.
fn has_thousands(error: &ReadError) -> bool {
    matches!(error.hint(), Some(Hint::NameThousands(_)))
}

/// What a file holds.
pub enum Opened {
    /// Measurements in this project's own form.
    Measurements(Vec<Measurement>),
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
    if is_workbook(&bytes) {
        return Ok(Opened::Foreign(Box::new(ForeignTable::new(bytes, progress)?)));
    }
    match Measurement::read_sets(&bytes[..], progress) {
        Ok(measurements) => Ok(Opened::Measurements(measurements)),
        // The program's own names, and nothing measured among them: no other table either.
        Err(error) if matches!(&error.kind, ReadErrorKind::NoQuantity { names } if names.iter().all(|name| Field::from_key(name).is_some())) => {
            Err(error.into())
        }
        Err(error) if (error.may_be_foreign() || has_thousands(&error)) && OtherFormat::of(&bytes).is_none() => {
            match ForeignTable::new(bytes, progress) {
                Ok(table) => Ok(Opened::Foreign(Box::new(table))),
                // No table at all: the reason is what the file lacks.
                Err(ImportError::Read(ReadError { kind: ReadErrorKind::NoNumbers | ReadErrorKind::EmptyText, .. })) => Err(error.into()),
                Err(foreign) => Err(foreign),
            }
        }
        Err(error) => Err(OtherFormat::of(&bytes).map_or(error.into(), ImportError::OtherFormat)),
    }
}
