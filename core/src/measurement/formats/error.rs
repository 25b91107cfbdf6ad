//! Why a foreign file is no measurement.

use super::pbsdf::TensorError;
use crate::measurement::foreign::{Doubt, OtherFormat};
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
    /// The angle of incidence is not in the file, and one angle was not given.
    #[error("the file does not state the angle of incidence; give it with --theta-i")]
    NoThetaI,
    /// A form that is not read.
    #[error("{0}")]
    OtherFormat(OtherFormat),
    /// A workbook that is damaged or too large.
    #[error("the workbook cannot be read: {reason}")]
    Workbook {
        /// What its reader says.
        reason: String,
    },
    /// No sheet of that name, or none with a table.
    #[error("{}; the sheets are {}", Sheet(.wanted), .names.join(", "))]
    NoSheet {
        /// The name asked for; empty for the first one, which holds no rows of numbers.
        wanted: String,
        /// The names of the sheets.
        names: Vec<String>,
    },
    /// The guess of a table leaves something open.
    #[error("{}", Doubts(.doubts))]
    Undecided {
        /// What is open, at least one question.
        doubts: Vec<Doubt>,
    },
    /// The file has no value at any geometry asked for.
    #[error("none of the geometries has a value")]
    NoValue {
        /// The notices of the import.
        notes: Vec<ImportNote>,
    },
}

struct Sheet<'a>(&'a str);

impl std::fmt::Display for Sheet<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0.is_empty() {
            f.write_str("the first sheet holds no rows of numbers; choose another with --sheet")
        } else {
            write!(f, "there is no sheet {:?}", self.0)
        }
    }
}

struct Doubts<'a>(&'a [Doubt]);

impl std::fmt::Display for Doubts<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (index, doubt) in self.0.iter().enumerate() {
            write!(f, "{}{doubt}", if index == 0 { "" } else { "; " })?;
        }
        Ok(())
    }
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
