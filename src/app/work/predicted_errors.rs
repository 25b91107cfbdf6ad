//! The standard errors that a choice of angles predicts.

use crate::app::text::localized::Localized as _;
use crate::app::work::design::MOST_PLANNED;
use crate::app::work::settings::Settings;
use pbrdf::fit::{Design, DesignPrediction, UndeterminedDirection};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Parameter, ParameterSet};
use pbrdf::optics::Geometry;
use tr::tr;

/// What angles would determine.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictedErrors {
    /// Standard error of each free parameter; none where it would stay open.
    pub errors: Vec<(Parameter, Option<f64>)>,
    /// What would stay open, in words.
    pub open: Vec<UndeterminedDirection>,
}

impl PredictedErrors {
    /// Of the planned angles, at the sliders.
    pub fn of_plan(settings: &Settings, free: ParameterSet) -> Result<Self, String> {
        let (incidences, views) = settings.plan.counts();
        if incidences * views > MOST_PLANNED {
            return Err(tr!("{0} × {1} angles are more than the {2} points that can be planned at once.", incidences, views, MOST_PLANNED));
        }
        Self::new(settings, free, settings.plan.geometries())
    }

    /// Of the angles of the open measurement, as if they were measured with the planned noise and columns.
    pub fn of_measurement(settings: &Settings, free: ParameterSet, measurement: &Measurement) -> Result<Self, String> {
        let used = measurement.rows.iter().filter(|row| !row.masked).map(|row| row.geometry);
        if used.clone().count() > MOST_PLANNED {
            return Err(tr!("The open measurement has more than {} rows.", MOST_PLANNED));
        }
        Self::new(settings, free, used.collect())
    }

    fn new(settings: &Settings, free: ParameterSet, geometries: Vec<Geometry>) -> Result<Self, String> {
        if geometries.is_empty() {
            return Err(tr!("There is no angle: add one of incidence and one of view."));
        }
        let plan = Design { model: settings.model, parameters: settings.parameters, geometries, noise: settings.plan.noise(), free };
        let DesignPrediction { errors, undetermined, .. } = plan.predict().map_err(|error| tr!("{}.", error.localized()))?;
        Ok(Self { errors, open: undetermined })
    }

    /// Standard error of a parameter.
    pub fn error_of(&self, parameter: Parameter) -> Option<f64> {
        self.errors.iter().find(|(other, _)| *other == parameter).and_then(|(_, error)| *error)
    }
}

#[cfg(test)]
mod tests {
    use super::PredictedErrors;
    use crate::app::work::design::{Plan, Span};
    use crate::app::work::settings::Settings;
    use pbrdf::model::{Parameter, ParameterSet};

    #[test]
    fn more_angles_and_less_noise_determine_more() {
        let free = ParameterSet::ALL.without(Parameter::Ks);
        let n_error = |plan: Plan| {
            let settings = Settings { plan, ..Settings::default() };
            PredictedErrors::of_plan(&settings, free).expect("a prediction").error_of(Parameter::N).expect("n is determined")
        };
        let dense = n_error(Plan::default());
        let quiet = n_error(Plan { noise: 0.0025, ..Plan::default() });
        // Errors are proportional to the noise.
        assert!((dense / quiet - 2.0).abs() < 1e-9, "{dense} {quiet}");
        let few = Plan { theta_i: vec![Span::new(30.0, 50.0, 10.0)], theta_r: vec![Span::new(20.0, 60.0, 5.0)], ..Plan::default() };
        assert!(n_error(few) > 5.0 * dense);
    }

    #[test]
    fn a_plan_without_angles_is_a_sentence() {
        let settings = Settings { plan: Plan { theta_r: Vec::new(), ..Plan::default() }, ..Settings::default() };
        assert!(PredictedErrors::of_plan(&settings, ParameterSet::ALL).is_err_and(|sentence| sentence.contains("no angle")));
        let spans = vec![Span::new(0.0, 80.0, 0.1)];
        let settings = Settings { plan: Plan { theta_i: spans.clone(), theta_r: spans, ..Plan::default() }, ..Settings::default() };
        assert!(PredictedErrors::of_plan(&settings, ParameterSet::ALL).is_err_and(|sentence| sentence.contains("more than")));
    }
}
