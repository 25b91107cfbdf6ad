//! What an import gives: measurements, and notices.

use crate::measurement::Measurement;
use crate::measurement::note::ImportNote;

/// The measurements of a file and the notices of its import.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Imported {
    /// The measurements, in the order of the file.
    pub measurements: Vec<Measurement>,
    /// The notices.
    pub notes: Vec<ImportNote>,
}

impl Imported {
    /// One measurement.
    pub(crate) fn one(measurement: Measurement, notes: Vec<ImportNote>) -> Self {
        Self { measurements: vec![measurement], notes }
    }

    /// Number of rows of all measurements.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.measurements.iter().map(|measurement| measurement.rows.len()).sum()
    }
}
