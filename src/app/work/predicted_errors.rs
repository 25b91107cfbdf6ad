//! The standard errors that a choice of angles predicts.

use crate::app::text::localized::Localized as _;
use crate::app::work::design::{DesignSettings, MOST_PLANNED};
use crate::app::work::surface::Surface;
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
    /// The parameters whose error says something about the value.
    pub determined: ParameterSet,
    /// What would stay open, in words.
    pub open: Vec<UndeterminedDirection>,
}

impl PredictedErrors {
    /// Of the planned angles, at the sliders.
    pub fn of_design(surface: &Surface, design: &DesignSettings, free: ParameterSet) -> Result<Self, String> {
        let (incidences, views) = design.counts();
        if incidences * views > MOST_PLANNED {
            return Err(tr!("{0} × {1} angles are more than the {2} points that can be planned at once.", incidences, views, MOST_PLANNED));
        }
        Self::new(surface, design, free, design.geometries())
    }

    /// Of the angles of the open measurement, as if they were measured with the planned noise and
    /// columns.
    pub fn of_measurement(
        surface: &Surface,
        design: &DesignSettings,
        free: ParameterSet,
        measurement: &Measurement,
    ) -> Result<Self, String> {
        let used = measurement.rows.iter().filter(|row| !row.masked).map(|row| row.geometry);
        if used.clone().count() > MOST_PLANNED {
            return Err(tr!("The open measurement has more than {} rows.", MOST_PLANNED));
        }
        Self::new(surface, design, free, used.collect())
    }

    fn new(surface: &Surface, design: &DesignSettings, free: ParameterSet, geometries: Vec<Geometry>) -> Result<Self, String> {
        if geometries.is_empty() {
            return Err(tr!("There is no angle: add one of incidence and one of view."));
        }
        let plan =
            Design { model: surface.model, parameters: surface.parameters, geometries, noise: design.noise(), free, given: Vec::new() };
        let DesignPrediction { errors, determined, undetermined, .. } = plan.predict().map_err(|error| tr!("{}.", error.localized()))?;
        Ok(Self { errors, determined, open: undetermined })
    }

    /// Standard error of a parameter.
    pub fn error_of(&self, parameter: Parameter) -> Option<f64> {
        self.errors.iter().find(|(other, _)| *other == parameter).and_then(|(_, error)| *error)
    }
}

#[cfg(test)]
mod tests {
    use super::{DesignSettings, PredictedErrors, Surface};
    use crate::app::work::design::AngleRange;
    use pbrdf::model::{Parameter, ParameterSet};

    #[test]
    fn more_angles_and_less_noise_determine_more() {
        let free = ParameterSet::ALL.without(Parameter::Ks);
        let n_error = |design: &DesignSettings| {
            let predicted = PredictedErrors::of_design(&Surface::default(), design, free).expect("a prediction");
            predicted.error_of(Parameter::N).expect("n is determined")
        };
        let dense = n_error(&DesignSettings::default());
        let quiet = n_error(&DesignSettings { noise: 0.0025, ..DesignSettings::default() });
        // Errors are proportional to the noise.
        assert!((dense / quiet - 2.0).abs() < 1e-9, "{dense} {quiet}");
        let (theta_i, theta_r) = (vec![AngleRange::new(30.0, 50.0, 10.0)], vec![AngleRange::new(20.0, 60.0, 5.0)]);
        assert!(n_error(&DesignSettings { theta_i, theta_r, ..DesignSettings::default() }) > 5.0 * dense);
    }

    #[test]
    fn a_design_without_angles_is_a_sentence() {
        let ranges = vec![AngleRange::new(0.0, 80.0, 0.1)];
        for (theta_i, theta_r, expected) in [(ranges.clone(), Vec::new(), "no angle"), (ranges.clone(), ranges, "more than")] {
            let design = DesignSettings { theta_i, theta_r, ..DesignSettings::default() };
            let predicted = PredictedErrors::of_design(&Surface::default(), &design, ParameterSet::ALL);
            assert!(predicted.is_err_and(|sentence| sentence.contains(expected)));
        }
    }
}
