//! The standard errors that a choice of angles predicts.

use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::work::design::{DesignGoal, DesignSettings, MOST_PLANNED};
use crate::app::work::fit_setup::free_in_design;
use crate::app::work::surface::{Surface, another};
use pbrdf::fit::{AngleChoice, CandidateGrid, Design, DesignCriterion, DesignPrediction, UndeterminedDirection};
use pbrdf::measurement::{Measurement, Quantity, Row};
use pbrdf::model::{Model, Parameter, ParameterSet};
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
        check_count(incidences, views)?;
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

    /// Of the planned readings beside what is measured, as if that were measured with the planned noise too; of all planned pairs where no
    /// reading is planned.
    pub fn of_plan(surface: &Surface, design: &DesignSettings, free: ParameterSet, measured: &[Row]) -> Result<Self, String> {
        if design.readings.is_empty() {
            return Self::of_design(surface, design, free);
        }
        let planned = design.readings.iter().filter_map(|reading| design.geometry(*reading));
        Self::new(surface, design, free, planned.chain(measured.iter().map(|row| row.geometry)).collect())
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

/// Refuses more pairs of angles than can be planned at once.
fn check_count(incidences: usize, views: usize) -> Result<(), String> {
    if incidences * views <= MOST_PLANNED {
        return Ok(());
    }
    Err(tr!("{0} × {1} angles are more than the {2} points that can be planned at once.", incidences, views, MOST_PLANNED))
}

/// Angles that were chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedAngles {
    /// θi, signed θr and Δφ in degrees, a repeated one as often as it is repeated.
    pub angles: Vec<[f64; 3]>,
    /// The criterion: ln det, the sum of relative variances, or the sum of squares that the rival leaves.
    pub value: f64,
    /// What they tell of what all candidates tell, 0 to 1.
    pub efficiency: f64,
    /// Of the wanted parameters that stay undetermined: the least standard error that any choice of so many readings gives.
    pub limits: Vec<(Parameter, f64)>,
}

/// The rows that are measured and not masked, without their own standard deviations.
pub fn measured(measurement: &Measurement) -> Vec<Row> {
    let plain = |quantity: Option<Quantity>| quantity.map(|quantity| Quantity { sigma: None, ..quantity });
    let used = measurement.rows.iter().filter(|row| !row.masked);
    used.map(|row| Row { dolp: plain(row.dolp), brdf: plain(row.brdf), ..*row }).collect()
}

/// The request for the angles of a plan: what is measured counts if the plan says so, planned readings do not.
pub fn angle_choice(surface: &Surface, design: &DesignSettings, measurement: &Measurement) -> Result<AngleChoice, String> {
    let free = free_in_design(surface, design, design.has_brdf());
    let [theta_i, theta_r] = design.lists();
    let grid = CandidateGrid::new(&theta_i, &theta_r, &[design.dphi]).map_err(|error| tr!("{}.", error.localized()))?;
    check_count(theta_i.len(), theta_r.len())?;
    let criterion = match design.goal {
        DesignGoal::All => DesignCriterion::Determinant,
        DesignGoal::Index | DesignGoal::Roughness => {
            let wanted: Vec<Parameter> = design.goal.parameters(free).iter().collect();
            if wanted.is_empty() {
                return Err(tr!("Neither of {} is free: there is nothing to determine.", translated(design.goal.name())));
            }
            DesignCriterion::Variances(wanted)
        }
        DesignGoal::Distribution => {
            let rival = Model { distribution: another(surface.model.distribution), ..surface.model };
            DesignCriterion::Discrimination { rival, fixed: surface.model.parameters().without_all(free) }
        }
    };
    let given = if design.counts_given { measured(measurement) } else { Vec::new() };
    let (model, surfaces, noise) = (surface.model, vec![surface.parameters], design.noise());
    Ok(AngleChoice { model, surfaces, noise, free, grid, given, count: design.count, repeats: false, criterion })
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
