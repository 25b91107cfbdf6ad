//! Why a file is no session, and why a fit of one is left out.

use crate::app::storage::fit_record::FitRecordError;
use crate::app::text::localized::Localized;
use crate::app::work::settings_error::SettingsError;
use pbrdf::fit::{BoundsError, JointError, ProblemError};
use pbrdf::measurement::ReadError;
use pbrdf::model::ParameterError;
use tr::tr;

/// Name of the format in its files.
pub const SESSION_FORMAT: &str = "pbrdf-session";
/// Files of a later version are refused: they may mean something else. Earlier ones are read.
pub const SESSION_VERSION: u32 = 3;

/// Why a file is no session.
#[derive(Debug)]
pub enum SessionError {
    /// It is no JSON, or JSON of something else.
    Json(JsonError),
    /// It does not say that it is a session.
    Format,
    /// It is of a version that this program does not read.
    Version { found: u32 },
    /// A setting means nothing.
    Settings(SettingsError),
    /// Its table cannot be read.
    Measurement(ReadError),
}

/// A place in JSON, and what is wrong there.
#[derive(Debug)]
pub struct JsonError {
    path: String,
    error: serde_json::Error,
}

/// Why a fit of a session is left out.
#[derive(Debug)]
pub enum SavedFitError {
    Json(JsonError),
    Bounds(BoundsError),
    Record(FitRecordError),
    /// The session has no measurement of its number.
    Measurement,
    /// Its masked rows are not in their order, or not all in the table.
    Mask,
    Parameters(ParameterError),
    Problem(ProblemError),
    /// Its measurements cannot be fitted together.
    Joint(JointError),
}

impl From<serde_path_to_error::Error<serde_json::Error>> for JsonError {
    fn from(error: serde_path_to_error::Error<serde_json::Error>) -> Self {
        Self { path: error.path().to_string(), error: error.into_inner() }
    }
}

impl From<serde_json::Error> for JsonError {
    fn from(error: serde_json::Error) -> Self {
        Self { path: String::new(), error }
    }
}

impl Localized for JsonError {
    fn localized(&self) -> String {
        match self.path.as_str() {
            "" | "." | "?" => self.error.localized(),
            path => tr!("{0}: {1}", path, self.error.localized()),
        }
    }
}

impl Localized for SessionError {
    fn localized(&self) -> String {
        match self {
            Self::Json(error) => error.localized(),
            Self::Format => tr!("this is no session: expected JSON with \"format\": \"{}\"", SESSION_FORMAT),
            Self::Version { found } => tr!("the session is of version {0}; this program reads version {1}", found, SESSION_VERSION),
            Self::Settings(error) => format!("settings.{}", error.localized()),
            Self::Measurement(error) => tr!("{0}: {1}", "measurement.table", error.localized()),
        }
    }
}

impl Localized for SavedFitError {
    fn localized(&self) -> String {
        match self {
            Self::Json(error) => error.localized(),
            Self::Bounds(error) => error.localized(),
            Self::Record(error) => error.localized(),
            Self::Measurement => tr!("measurement: the session has none of that number"),
            Self::Mask => tr!("masked: the rows are not in their order, or not all in the table"),
            Self::Parameters(error) => error.localized(),
            Self::Problem(error) => error.localized(),
            Self::Joint(error) => error.localized(),
        }
    }
}
