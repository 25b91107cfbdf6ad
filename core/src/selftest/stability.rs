//! Stability: a gallery of named stiff and extreme cases, and whether the program holds its digits, or its word, in each.
//!
//! Evaluation cases come from `assets/reference/stability_gallery.csv`, values and derivatives to 60 digits; fits from [`crate::selftest::stability_fits`].

use crate::fit::{Observer, StopReason};
use crate::measurement::Measurement;
use crate::model::{Gradient, GradientRequest, Model, Parameters, Reflection};
use crate::optics::{Facet, Geometry, SlopeDistribution};
use crate::selftest::reference::{Reference, critical_angle_factor, gradient_error, references, relative_error};
use crate::selftest::stability_fits::StiffFit;
use crate::selftest::textbook::textbook_f64;
use crate::selftest::{BenchmarkRow, Cell, Host, Machine, Note, Report};
use std::fmt;

/// The evaluation cases.
const GALLERY: &str = include_str!("../../assets/reference/stability_gallery.csv");

/// Bar on the relative error of BRDF and DoLP.
pub const VALUE_BAR: f64 = 1e-13;
/// Bar on the error of the gradient.
pub const GRADIENT_BAR: f64 = 1e-12;

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

impl Stability {
    /// The cases in the order of the report.
    #[must_use]
    pub fn cases() -> Vec<StabilityCase> {
        let evaluations = references(GALLERY).into_iter();
        let evaluations = evaluations
            .map(|reference| StabilityCase::Evaluation { name: reference.case, distribution: reference.surface.model().distribution });
        evaluations.chain(StiffFit::all().iter().map(|fit| StabilityCase::Fit(fit.case))).collect()
    }

    /// Makes the report.
    #[must_use]
    pub fn run(machine: Machine, date: String, surroundings: Host<'_>) -> Report<Self> {
        let (evaluations, fits) = (references(GALLERY), StiffFit::all());
        #[expect(clippy::cast_precision_loss, reason = "a number of fits")]
        let whole = fits.len() as f64;
        let mut rows: Vec<Self> = evaluations.iter().map(Self::of_evaluation).collect();
        let watch = Observer { clock: surroundings.clock, cancelled: surroundings.cancelled, progress: &|_| {} };
        for (done, fit) in fits.into_iter().enumerate() {
            if (surroundings.cancelled)() {
                break;
            }
            rows.push(fit.run(watch));
            #[expect(clippy::cast_precision_loss, reason = "a number of fits")]
            let done = (done + 1) as f64;
            (surroundings.progress)(done / whole);
        }
        let notes = vec![Note::StabilityEvaluations, Note::StabilityFits];
        Report::new("Stability in stiff and extreme cases", machine, date, rows, notes)
    }

    fn of_evaluation(reference: &Reference) -> Self {
        let Reference { case, surface, geometry, .. } = reference;
        let (model, parameters) = (surface.model(), *surface.parameters());
        let (reflection, gradient) = surface.reflection_and_gradient(&Facet::new(*geometry), GradientRequest::ALL);
        let error = |brdf: f64, dolp: f64| (relative_error(brdf, reference.brdf), relative_error(dolp, reference.dolp));
        let (brdf_error, dolp_error) = error(reflection.brdf, reflection.dolp);
        let of_gradient = |[brdf, dolp]: [[f64; 9]; 2]| {
            gradient_error(&gradient.brdf, &brdf, &parameters).max(gradient_error(&gradient.dolp, &dolp, &parameters))
        };
        let gradient_error = reference.gradient.map(of_gradient);
        let (brdf, dolp) = textbook_f64(model, &parameters, *geometry);
        let (textbook_brdf, textbook_dolp) = error(brdf, dolp);
        let textbook = textbook_brdf.max(textbook_dolp);
        let factor = critical_angle_factor(&parameters, *geometry);
        let worst = brdf_error.max(dolp_error);
        Self {
            case: StabilityCase::Evaluation { name: case.clone(), distribution: model.distribution },
            setting: Setting::Evaluation { model, parameters, geometry: *geometry },
            brdf_error: Some(brdf_error),
            dolp_error: Some(dolp_error),
            gradient_error,
            textbook_error: Some(textbook),
            condition: condition(&reflection, &gradient, &parameters),
            outcome: StabilityOutcome::Digits {
                values: digits(worst),
                gradient: digits(gradient_error.unwrap_or(1.0)),
                textbook: digits(textbook),
            },
            pass: worst <= VALUE_BAR * factor && gradient_error.is_some_and(|error| error <= GRADIENT_BAR * factor),
        }
    }
}

/// Decimal digits that an error leaves, 0 to 16.
#[must_use]
pub fn digits(error: f64) -> f64 {
    // Adding 0 turns -0 into 0.
    -libm::log10(error.clamp(1e-16, 1.0)) + 0.0
}

/// The largest `|p ∂f/∂p|/|f|` of BRDF and DoLP, where these are not 0.
fn condition(reflection: &Reflection, gradient: &Gradient, parameters: &Parameters) -> f64 {
    let of = |value: f64, slopes: &[f64; 9]| {
        let relative = slopes.iter().zip(parameters.to_array()).map(|(slope, parameter)| (slope * parameter / value).abs());
        relative.filter(|x| x.is_finite()).fold(0.0, f64::max)
    };
    of(reflection.brdf, &gradient.brdf).max(of(reflection.dolp, &gradient.dolp))
}

#[cfg(test)]
mod tests {
    use super::{GALLERY, Stability, references};
    use crate::fit::Observer;
    use crate::selftest::stability_fits::StiffFit;

    #[test]
    fn every_row_of_the_gallery_is_read_and_every_evaluation_case_passes() {
        let rows = references(GALLERY);
        assert_eq!(rows.len(), GALLERY.lines().filter(|line| !line.starts_with('#')).count() - 1);
        for row in &rows {
            let judged = Stability::of_evaluation(row);
            assert!(judged.pass, "{judged:?}");
        }
    }

    #[test]
    fn a_wrong_derivative_fails() {
        let mut row = references(GALLERY).swap_remove(0);
        let mut gradient = row.gradient.expect("the gallery has derivatives");
        gradient[1][0] *= 1.0 + 1e-11;
        row.gradient = Some(gradient);
        assert!(!Stability::of_evaluation(&row).pass);
    }

    #[test]
    fn every_fit_does_what_its_name_asks_for() {
        for fit in StiffFit::all() {
            let row = fit.run(Observer::NONE);
            assert!(row.pass, "{}: {}", row.case, row.outcome);
        }
    }
}
