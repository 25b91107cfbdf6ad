//! What a fit from the window is about: a measurement, the sliders, their bounds, the choices.

use crate::app::text::localized::Localized as _;
use crate::app::work::design::DesignSettings;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::surface::Surface;
use pbrdf::fit::{Bounds, Fit, FitOptions, JointError, JointFit, JointProblem, Problem, ProblemError};
use pbrdf::measurement::Measurement;
use pbrdf::model::{DolpFormula, Model, Parameter, ParameterSet, Parameters};
use tr::tr;

/// The problem of fitting those parameters from the sliders.
///
/// A start outside bounds that somebody has set moves to the nearest bound; a slider's own range
/// makes room for the start.
pub fn fit_problem(
    surface: &Surface,
    measurement: &Measurement,
    model: Model,
    free: ParameterSet,
    fit_options: FitOptions,
) -> Result<Problem, ProblemError> {
    let (start, bounds) = start_in_bounds(surface, free);
    let problem = Problem::new(measurement, model, start, free, bounds, fit_options)?;
    if surface.ties.is_empty() { Ok(problem) } else { problem.with_ties(&surface.ties) }
}

/// Whether a fit is one of all measurements together: there are several, and they share something of their model.
pub fn is_joint(list: &MeasurementList) -> bool {
    let shared = list.shared().intersection(list.active().surface.model.parameters());
    !shared.is_empty() && list.measured().count() > 1
}

/// The problem of fitting all measurements together from their surfaces. Parameters that are held stay on all surfaces where they are
/// shared, on the active one where they are its own.
pub fn joint_problem(list: &MeasurementList, held: ParameterSet, fit_options: FitOptions) -> Result<JointProblem, JointError> {
    let (model, shared) = (list.active().surface.model, list.shared());
    let mut surfaces = list.measured();
    let fit = joint_fit(list, model, fit_options).each(|fit| {
        let Some(open) = surfaces.next() else { return fit };
        let is_active = open.number == list.active().number;
        let free = free_together(list, open).without_all(if is_active { held } else { held.intersection(shared) });
        let (start, bounds) = start_in_bounds(&open.surface, free);
        let fit = model.parameters().without_all(free).iter().fold(fit.start_at(start), Fit::hold);
        let fit = open.surface.ties.iter().fold(fit, |fit, tie| fit.tie(tie.parameter, tie.factor, tie.to));
        free.iter().fold(fit, |fit, parameter| {
            let (low, high) = bounds.of(parameter);
            fit.free(parameter).bound(parameter, low..=high)
        })
    });
    fit.problem()
}

/// The problem of fitting another model to all measurements together, from their surfaces within their bounds, with what is free by
/// default.
pub fn joint_problem_of(list: &MeasurementList, model: Model, fit_options: FitOptions) -> Result<JointProblem, JointError> {
    let mut surfaces = list.measured();
    let fit = joint_fit(list, model, fit_options).each(|fit| {
        let Some(open) = surfaces.next() else { return fit };
        let (start, bounds) = start_in_bounds(&open.surface, model.parameters());
        let fit = open.surface.ties.iter().fold(fit.start_at(start), |fit, tie| fit.tie(tie.parameter, tie.factor, tie.to));
        model.parameters().iter().fold(fit, |fit, parameter| {
            let (low, high) = bounds.of(parameter);
            fit.bound(parameter, low..=high)
        })
    });
    fit.problem()
}

/// A fit of all measurements with their names, weights, and what each has for itself.
fn joint_fit(list: &MeasurementList, model: Model, fit_options: FitOptions) -> JointFit<'_> {
    let fit = JointFit::new(list.measured().map(|open| &*open.measurement), model);
    let fit = fit.named(list.measured().map(OpenMeasurement::title)).own(model.parameters().without_all(list.shared()).iter());
    fit.options(fit_options).weights(list.measured().map(|open| open.weight))
}

/// The parameters that a joint fit would change on the surface of a measurement: of the shared ones those that any data can speak of.
pub fn free_together(list: &MeasurementList, open: &OpenMeasurement) -> ParameterSet {
    let has_brdf = list.measured().any(|open| open.measurement.has_brdf());
    let shared = free(&open.surface, has_brdf).intersection(list.shared());
    free(&open.surface, open.measurement.has_brdf()).without_all(list.shared()).union(shared)
}

/// The parameters that a fit would change: those that the data can speak of, less the locked and the tied ones.
pub fn free(surface: &Surface, has_brdf: bool) -> ParameterSet {
    free_of_model(surface, has_brdf).without_all(surface.locked).without_all(surface.tied())
}

/// The same for planned angles: if they decide otherwise than the open measurement whether there is
/// a BRDF, so does k_s.
pub fn free_in_design(surface: &Surface, design: &DesignSettings, has_brdf: bool) -> ParameterSet {
    let planned = design.has_brdf();
    let locked = match surface.locked {
        locked if has_brdf == planned => locked,
        locked if planned || surface.model.dolp_formula == DolpFormula::AsPrinted => locked.without(Parameter::Ks),
        locked => locked.with(Parameter::Ks),
    };
    free_of_model(surface, planned).without_all(locked)
}

fn free_of_model(surface: &Surface, has_brdf: bool) -> ParameterSet {
    let model = surface.model;
    if has_brdf { model.parameters() } else { model.dolp_parameters() }
}

/// The sliders inside the box, and the box.
pub fn start_in_bounds(surface: &Surface, free: ParameterSet) -> (Parameters, Bounds) {
    let mut start = surface.parameters;
    let mut bounds = Bounds::default();
    for &(parameter, low, high) in &surface.bounds {
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
pub fn explain(error: &ProblemError, measurement: &Measurement) -> String {
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
    use crate::app::work::surface::Surface;
    use pbrdf::model::{Parameter, ParameterSet};

    #[test]
    fn a_start_moves_into_bounds_that_were_set_and_widens_those_that_were_not() {
        let mut surface = Surface::default();
        surface.set_bounds(Parameter::N, 0.5, 1.5).expect("sound bounds");
        surface.parameters.n = 2.0;
        surface.parameters.k = 30.0;
        let (start, bounds) = start_in_bounds(&surface, ParameterSet::ALL);
        assert_eq!((start.n, bounds.of(Parameter::N)), (1.5, (0.5, 1.5)));
        assert_eq!((start.k, bounds.of(Parameter::K)), (30.0, (0.0, 30.0)));
        let (fixed, _) = start_in_bounds(&surface, ParameterSet::ALL.without(Parameter::N));
        assert_eq!(fixed.n, 2.0, "what is fixed stays where it is");
    }
}
