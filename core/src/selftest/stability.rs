//! Stability: a gallery of named stiff and extreme cases, and whether the program holds its digits, or its word, in each.
//!
//! Evaluation cases come from `assets/reference/stability_gallery.csv`, values and derivatives to 60 digits; fits from [`crate::selftest::stability_fits`].

use crate::fit::Observer;
use crate::model::{Gradient, GradientRequest, Parameters, PerParameter, Reflection};
use crate::optics::Facet;
use crate::selftest::reference::{
    DARK_BAR, GRADIENT_BAR, Reference, VALUE_BAR, critical_angle_factor, gradient_error, references, relative_error,
};
use crate::selftest::stability_case::{Setting, Stability, StabilityCase, StabilityOutcome};
use crate::selftest::stability_fits::StiffFit;
use crate::selftest::textbook::textbook_f64;
use crate::selftest::{Host, Machine, Note, Report};

/// The evaluation cases.
const GALLERY: &str = include_str!("../../assets/reference/stability_gallery.csv");

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
    pub fn run(machine: Machine, date: String, host: Host<'_>) -> Report<Self> {
        let (evaluations, fits) = (references(GALLERY), StiffFit::all());
        #[expect(clippy::cast_precision_loss, reason = "a number of fits")]
        let whole = fits.len() as f64;
        let mut rows: Vec<Self> = evaluations.iter().map(Self::of_evaluation).collect();
        let watch = Observer { clock: host.clock, cancelled: host.cancelled, progress: &|_| {} };
        for (done, fit) in fits.into_iter().enumerate() {
            if (host.cancelled)() {
                break;
            }
            rows.push(fit.run(watch));
            #[expect(clippy::cast_precision_loss, reason = "a number of fits")]
            let done = (done + 1) as f64;
            (host.progress)(done / whole);
        }
        let notes = vec![totals(&rows), Note::StabilityEvaluations, Note::StabilityFits];
        Report::new("Stability in stiff and extreme cases", machine, date, rows, notes)
    }

    fn of_evaluation(reference: &Reference) -> Self {
        let Reference { case, surface, geometry, .. } = reference;
        let (model, parameters) = (surface.model(), *surface.parameters());
        let (reflection, gradient) = surface.reflection_and_gradient(&Facet::new(*geometry), GradientRequest::ALL);
        let error = |brdf: f64, dolp: f64| (relative_error(brdf, reference.brdf), relative_error(dolp, reference.dolp));
        let (brdf_error, dolp_error) = error(reflection.brdf, reflection.dolp);
        let of_gradient = |[brdf, dolp]: [PerParameter<f64>; 2]| {
            [gradient_error(&gradient.brdf, &brdf, &parameters), gradient_error(&gradient.dolp, &dolp, &parameters)]
        };
        let gradient_errors = reference.gradient.map(of_gradient);
        let gradient_error = gradient_errors.map(|[brdf, dolp]| brdf.max(dolp));
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
            pass: brdf_error <= VALUE_BAR * factor
                && dolp_error <= if reference.is_dark { DARK_BAR } else { VALUE_BAR * factor }
                && gradient_errors.is_some_and(|[brdf, dolp]| {
                    brdf <= GRADIENT_BAR * factor && dolp <= if reference.is_dark { DARK_BAR } else { GRADIENT_BAR * factor }
                }),
        }
    }
}

fn totals(rows: &[Stability]) -> Note {
    let textbook: Vec<f64> = rows.iter().filter_map(|row| row.textbook_error).collect();
    Note::StabilityTotals {
        passed: rows.iter().filter(|row| row.pass).count(),
        cases: rows.len(),
        textbook_misses: textbook.iter().filter(|&&error| error > VALUE_BAR).count(),
        evaluations: textbook.len(),
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
    let of = |value: f64, slopes: &PerParameter<f64>| {
        let relative = slopes.iter().zip(parameters.to_array()).map(|(slope, parameter)| (slope * parameter / value).abs());
        relative.filter(|x| x.is_finite()).fold(0.0, f64::max)
    };
    of(reflection.brdf, &gradient.brdf).max(of(reflection.dolp, &gradient.dolp))
}

#[cfg(test)]
mod tests {
    use super::{GALLERY, Stability, references};
    use crate::fit::Observer;
    use crate::model::Parameter;
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
        gradient[1][Parameter::N] *= 1.0 + 1e-11;
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
