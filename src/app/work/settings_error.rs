//! Why a value of the settings or of a surface means nothing.

use crate::app::text::localized::Localized;
use pbrdf::fit::{BoundsError, TieError};
use pbrdf::model::ParameterError;
use pbrdf::optics::GeometryError;
use tr::tr;

/// A value of the settings that means nothing.
#[derive(Debug, Clone, PartialEq)]
pub enum SettingsError {
    Parameters(ParameterError),
    Bounds(BoundsError),
    Ties(TieError),
    Angles(GeometryError),
    /// The value of that key.
    OutOfRange(&'static str),
}

/// The key first, as it stands in the file.
impl Localized for SettingsError {
    fn localized(&self) -> String {
        match self {
            Self::Parameters(error) => tr!("{0}: {1}", "parameters", error.localized()),
            Self::Bounds(error) => tr!("{0}: {1}", "bounds", error.localized()),
            Self::Ties(error) => tr!("{0}: {1}", "ties", error.localized()),
            Self::Angles(error) => tr!("{0}: {1}", "theta_i, dphi", error.localized()),
            Self::OutOfRange(key) => tr!("{0}: {1}", key, tr!("a value is outside its range")),
        }
    }
}
