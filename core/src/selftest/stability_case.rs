//! A row of the report of stability: a case, and what became of it.

use crate::fit::StopReason;
use crate::measurement::Measurement;
use crate::model::{Model, Parameters};
use crate::optics::{Geometry, SlopeDistribution};
use crate::selftest::{BenchmarkRow, Cell};
use std::fmt;

/// What has to be set to see a case in the window.
#[derive(Debug, Clone, PartialEq)]
pub enum Setting {
    /// A surface under one pair of directions.
    Evaluation {
        /// Which terms there are.
        model: Model,
        /// The values.
        parameters: Parameters,
        /// The directions.
        geometry: Geometry,
    },
    /// A fit of a measurement.
    Fit {
        /// Which terms there are.
        model: Model,
        /// Where it begins.
        start: Parameters,
        /// What is fitted.
        measurement: Measurement,
    },
}

/// A case and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stability {
    /// Its name.
    pub case: StabilityCase,
    /// How to see it.
    pub setting: Setting,
    /// Relative error of the BRDF; evaluation cases only, as the three below.
    pub brdf_error: Option<f64>,
    /// Relative error of DoLP.
    pub dolp_error: Option<f64>,
    /// Error of the nine derivatives of either, the larger.
    pub gradient_error: Option<f64>,
    /// The larger relative error of BRDF and DoLP by the textbook form.
    pub textbook_error: Option<f64>,
    /// Of an evaluation: the largest |∂ln f/∂ln p|. Of a fit: largest over smallest singular value of the scaled Jacobian.
    pub condition: f64,
    /// What came out.
    pub outcome: StabilityOutcome,
    /// Whether that meets the bar.
    pub pass: bool,
}

/// The name of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum StabilityCase {
    /// An evaluation.
    Evaluation {
        /// What is extreme in it.
        name: String,
        /// Distribution of the slopes.
        distribution: SlopeDistribution,
    },
    /// A fit, by what is stiff in it.
    Fit(&'static str),
}

impl fmt::Display for StabilityCase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Evaluation { name, distribution } => write!(f, "{name} ({})", distribution.key()),
            Self::Fit(name) => write!(f, "fit: {name}"),
        }
    }
}

/// What became of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StabilityOutcome {
    /// Decimal digits that an evaluation holds, 16 at most.
    Digits {
        /// Of BRDF and DoLP, the worse.
        values: f64,
        /// Of their derivatives.
        gradient: f64,
        /// Of BRDF and DoLP by the textbook form.
        textbook: f64,
    },
    /// How a fit ended.
    Fit {
        /// Why it ended.
        stop_reason: StopReason,
        /// ΔE of Eq. (18), where it is defined.
        objective: Option<f64>,
        /// Number of directions that the data leave open.
        undetermined: usize,
    },
    /// There was no problem to fit.
    NoProblem,
}

impl fmt::Display for StabilityOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Digits { values, gradient, textbook } => {
                write!(f, "{values:.1} digits, gradient {gradient:.1}, textbook {textbook:.1}")
            }
            Self::Fit { stop_reason, objective, undetermined } => {
                f.write_str(stop_reason.text())?;
                if let Some(objective) = objective {
                    write!(f, ", ΔE {objective:.1e}")?;
                }
                match undetermined {
                    0 => Ok(()),
                    1 => f.write_str(", 1 direction open"),
                    count => write!(f, ", {count} directions open"),
                }
            }
            Self::NoProblem => f.write_str("no problem to fit"),
        }
    }
}

impl BenchmarkRow for Stability {
    const COLUMNS: &'static [&'static str] =
        &["case", "brdf_error", "dolp_error", "gradient_error", "textbook_error", "condition", "outcome", "pass"];

    fn cells(&self) -> Vec<Cell> {
        vec![
            Cell::Text(self.case.to_string()),
            Cell::maybe(self.brdf_error),
            Cell::maybe(self.dolp_error),
            Cell::maybe(self.gradient_error),
            Cell::maybe(self.textbook_error),
            Cell::Number(self.condition),
            Cell::Text(self.outcome.to_string()),
            Cell::Flag(self.pass),
        ]
    }
}
