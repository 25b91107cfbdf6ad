//! Why a fit ended.

use serde::{Deserialize, Serialize};

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// Objective, parameters or gradient change by no more than rounding.
    Converged,
    /// Model and data agree to the last digits.
    ResidualsZero,
    /// No step improves the objective, though the tests of convergence are not met.
    NoImprovement,
    /// The limit of evaluations or steps is reached.
    EvaluationLimit,
    /// Stopped on request; the best point so far is the result.
    Cancelled,
    /// A direction in the space of the free parameters is not determined by the data.
    Underdetermined,
    /// No row to fit, or all of them masked.
    NoData,
    /// A residual or a derivative is not a finite number.
    Numerical,
}

impl StopReason {
    /// In words.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::ResidualsZero => "model and data agree to the last digits",
            Self::NoImprovement => "no further improvement is possible",
            Self::EvaluationLimit => "too many evaluations",
            Self::Cancelled => "cancelled; the best so far is shown",
            Self::Underdetermined => "the data leave some parameters open",
            Self::NoData => "there are no data to fit",
            Self::Numerical => "a number beyond the range of f64 came up",
        }
    }
}

impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.text())
    }
}
