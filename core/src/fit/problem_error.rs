//! Why data, model and options make no problem.

use crate::fit::observations::UnstatedSigma;
use crate::fit::ties::TieError;
use crate::model::Parameter;
use crate::optics::shortest;

/// Why data, model and options make no problem.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProblemError {
    /// A stated standard deviation is needed and missing.
    #[error("the value of {quantity} has no {quantity}_sigma, which weights by standard deviation need")]
    MissingSigma {
        /// Index of the row in the measurement.
        row: usize,
        /// `dolp` or `brdf`.
        quantity: &'static str,
    },
    /// No measured quantity that the model predicts.
    #[error("the model predicts DoLP only, and no DoLP is measured")]
    NothingToPredict,
    /// A free parameter starts outside its bounds.
    #[error(
        "{} = {} is outside its bounds {} … {}", .parameter.key(), shortest(*.value), shortest(*.low), shortest(*.high)
    )]
    StartOutsideBounds {
        /// Which parameter.
        parameter: Parameter,
        /// Where it starts.
        value: f64,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// Parameters that cannot be tied.
    #[error(transparent)]
    Tie(#[from] TieError),
}

impl ProblemError {
    /// What to do about it, where there is more to say than the error says.
    #[must_use]
    pub fn hint(&self) -> Option<&'static str> {
        match self {
            Self::MissingSigma { .. } => Some("state all standard deviations, or fit without weights"),
            Self::NothingToPredict => Some("choose a model with a BRDF, such as specular"),
            Self::StartOutsideBounds { .. } | Self::Tie(_) => None,
        }
    }
}

impl From<UnstatedSigma> for ProblemError {
    fn from(UnstatedSigma { row, quantity }: UnstatedSigma) -> Self {
        Self::MissingSigma { row, quantity }
    }
}
