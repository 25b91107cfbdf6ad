//! One row of the comparison of models.

use crate::app::work::fit_history::FitEntry;
use pbrdf::fit::posterior::LogEvidence;
use pbrdf::fit::{FitResult, JointError, ProblemError};
use pbrdf::model::Preset;
use std::sync::Arc;

/// A model of the list of presets with its fit to a measurement, which is one of the history, or why
/// there is none.
pub struct ModelFit {
    pub preset: &'static Preset,
    pub result: Result<Arc<FitEntry>, NotFitted>,
    /// Its likelihood averaged over the priors; none before it was found.
    pub evidence: Option<LogEvidence>,
}

/// A model with its fits as a comparison brings them: one, or those of the measurements that were fitted
/// together.
pub struct ComparedModel {
    pub preset: &'static Preset,
    pub result: Result<Vec<FitEntry>, NotFitted>,
}

/// Why a model of a comparison has no fit.
#[derive(Debug, Clone)]
pub enum NotFitted {
    One(ProblemError),
    Together(JointError),
}

impl ModelFit {
    /// What came of the fit.
    pub fn report(&self) -> Option<&FitResult> {
        self.result.as_ref().ok().map(|fit| &fit.report)
    }

    /// ΔE of what was fitted: of a joint fit that of all its measurements.
    pub fn objective(&self) -> Option<f64> {
        let fit = self.result.as_ref().ok()?;
        fit.joint.as_ref().map_or(fit.report.objective, |part| part.of.result.objective)
    }
}
