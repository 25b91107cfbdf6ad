//! Why a foreign file is no measurement.

use super::pbsdf::TensorError;
use crate::measurement::note::ImportNote;
use crate::measurement::{Hint, ReadError, ReadErrorKind, WavelengthError};
use crate::optics::GeometryError;

/// Why a foreign file is no measurement.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// A text cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A tensor file cannot be read.
    #[error(transparent)]
    Tensor(#[from] TensorError),
    /// No wavelength can be chosen.
    #[error(transparent)]
    Wavelength(#[from] WavelengthError),
    /// An angle asked for is outside its range.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The file has no value at any geometry asked for.
    #[error("none of the geometries has a value")]
    NoValue {
        /// The notices of the import.
        notes: Vec<ImportNote>,
    },
}

impl ImportError {
    /// Whether the reading was stopped on request.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Read(ReadError { kind: ReadErrorKind::Cancelled, .. }))
    }

    /// What helps, where something does.
    #[must_use]
    pub fn hint(&self) -> Option<Hint> {
        match self {
            Self::Read(error) => error.hint(),
            _ => None,
        }
    }
}
