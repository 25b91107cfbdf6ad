//! One row of the comparison of models.

use pbrdf::fit::{FitResult, ProblemError};
use pbrdf::model::Preset;

/// A model of the list of presets with its fit to the open measurement, or why there is none.
pub struct ModelFit {
    pub preset: &'static Preset,
    pub result: Result<Box<FitResult>, ProblemError>,
}
