//! One row of the comparison of models.

use crate::app::work::fit_history::FitEntry;
use pbrdf::fit::{FitResult, ProblemError};
use pbrdf::model::Preset;
use std::sync::Arc;

/// A model of the list of presets with its fit to a measurement, which is one of the history, or why
/// there is none.
pub struct ModelFit {
    pub preset: &'static Preset,
    pub result: Result<Arc<FitEntry>, ProblemError>,
}

impl ModelFit {
    /// What came of the fit.
    pub fn report(&self) -> Option<&FitResult> {
        self.result.as_ref().ok().map(|fit| &fit.report)
    }
}
