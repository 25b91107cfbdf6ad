//! What a fit from the window is about: a measurement, the sliders, their bounds, the choices.

use crate::app::text::localized::Localized as _;
use crate::app::work::settings::Settings;
use pbrdf::fit::{Bounds, FitOptions, Problem, ProblemError};
use pbrdf::measurement::Measurement;
use pbrdf::model::{DolpFormula, Model, Parameter, ParameterSet, Parameters};
use tr::tr;

/// The problem of fitting those parameters from the sliders.
///
/// A start outside bounds that somebody has set moves to the nearest bound; a slider's own range makes room for the start.
pub fn problem(
    settings: &Settings,
    measurement: &Measurement,
    model: Model,
    free: ParameterSet,
    choices: FitOptions,
) -> Result<Problem, ProblemError> {
    let (start, bounds) = start_in_bounds(settings, free);
    Problem::new(measurement, model, start, free, bounds, choices)
}

/// The parameters that a fit would change: those that the data can speak of, less the locked ones.
pub fn free(settings: &Settings, has_brdf: bool) -> ParameterSet {
    free_of_model(settings, has_brdf).without_all(settings.locked)
}

/// The same for planned angles: if they decide otherwise than the open measurement whether there is a BRDF, so does k_s.
pub fn free_in_plan(settings: &Settings, has_brdf: bool) -> ParameterSet {
    let planned = settings.plan.has_brdf();
    let locked = match settings.locked {
        locked if has_brdf == planned => locked,
        locked if planned || settings.model.dolp_formula == DolpFormula::AsPrinted => locked.without(Parameter::Ks),
        locked => locked.with(Parameter::Ks),
    };
    free_of_model(settings, planned).without_all(locked)
}

fn free_of_model(settings: &Settings, has_brdf: bool) -> ParameterSet {
    let model = settings.model;
    if has_brdf { model.parameters() } else { model.dolp_parameters() }
}

/// The sliders inside the box, and the box.
pub fn start_in_bounds(settings: &Settings, free: ParameterSet) -> (Parameters, Bounds) {
    let mut start = settings.parameters;
    let mut bounds = Bounds::default();
    for &(parameter, low, high) in &settings.bounds {
        // Settings hold sound bounds only.
        if bounds.set(parameter, low, high).is_ok() && free.contains(parameter) {
            start[parameter] = bounds.clamp(parameter, start[parameter]);
        }
    }
    for parameter in free {
        bounds.widen_to(parameter, start[parameter]);
    }
    (start, bounds)
}

/// Why there is no problem, with the line of the file where one is to blame.
pub fn reason(error: &ProblemError, measurement: &Measurement) -> String {
    match error {
        ProblemError::MissingSigma { row, .. } => match measurement.lines.get(*row) {
            Some(line) => tr!("line {0}: {1}", line, error.localized()),
            None => tr!("row {0}: {1}", row + 1, error.localized()),
        },
        _ => error.localized(),
    }
}

#[cfg(test)]
mod tests {
    use super::start_in_bounds;
    use crate::app::work::settings::Settings;
    use pbrdf::model::{Parameter, ParameterSet};

    #[test]
    fn a_start_moves_into_bounds_that_were_set_and_widens_those_that_were_not() {
        let mut settings = Settings::default();
        settings.set_bounds(Parameter::N, 0.5, 1.5).expect("sound bounds");
        settings.parameters.n = 2.0;
        settings.parameters.k = 30.0;
        let (start, bounds) = start_in_bounds(&settings, ParameterSet::ALL);
        assert_eq!((start.n, bounds.of(Parameter::N)), (1.5, (0.5, 1.5)));
        assert_eq!((start.k, bounds.of(Parameter::K)), (30.0, (0.0, 30.0)));
        let (fixed, _) = start_in_bounds(&settings, ParameterSet::ALL.without(Parameter::N));
        assert_eq!(fixed.n, 2.0, "what is fixed stays where it is");
    }
}
