//! A joint fit of a session: its measurements, where it ended, and the fit again.

use crate::app::storage::fit_record::{FitRecord, on_one_line};
use crate::app::storage::saved_fit::{SavedMeasurement, is_mask, with_mask};
use crate::app::storage::session_error::SavedFitError;
use crate::app::work::fit_history::{FitEntry, JointEntry};
use crate::app::work::open_measurement::Mask;
use crate::app::work::surface::can_be_set;
use pbrdf::fit::{Fit, FitOptions, JointFit, JointProblem, Tie};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// What a joint fit was about, and how it came about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedJointFit {
    model: Model,
    /// The parameters that surfaces shared.
    pub shared: ParameterSet,
    fit_options: FitOptions,
    sets: Vec<SavedSet>,
    account: FitRecord,
}

/// A measurement of a joint fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SavedSet {
    /// Which measurement of the session, from 0.
    measurement: usize,
    /// What it was called.
    name: String,
    start: Parameters,
    free: Vec<Parameter>,
    bounds: Vec<(Parameter, f64, f64)>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    ties: Vec<Tie>,
    /// How often its squared residuals counted.
    #[serde(default = "one")]
    weight: f64,
    /// The sliders before it.
    before: Parameters,
    /// The rows that were masked, from 0.
    #[serde(serialize_with = "on_one_line")]
    masked: Vec<usize>,
}

fn one() -> f64 {
    1.0
}

/// A joint fit of a session, made again.
pub struct RestoredJointFit {
    pub joint: JointEntry,
    /// Of each measurement of the fit its number in the session, from 0, the sliders before, and the rows that were masked.
    pub sets: Vec<(usize, Parameters, Mask)>,
}

impl SavedJointFit {
    /// Of the parts of a joint fit in the order of its measurements, each with the number of its measurement in the session; none where
    /// nothing is known of how it came about.
    pub fn new(parts: &[(&FitEntry, usize)]) -> Option<Self> {
        let joint = &parts.first()?.0.joint.as_ref()?.of;
        let sets = parts.iter().map(|(fit, measurement)| (*measurement, fit.before, &*fit.mask));
        Some(Self { account: FitRecord::of_joint(joint)?, ..Self::to_be_made(&joint.problem, joint.shared, sets) })
    }

    /// A joint fit that is still to be made: of each measurement its number in the session, from 0, the sliders, and the masked rows.
    pub fn to_be_made<'a>(
        problem: &JointProblem,
        shared: ParameterSet,
        sets: impl Iterator<Item = (usize, Parameters, &'a [usize])>,
    ) -> Self {
        let set = |(part, (measurement, before, mask)): (usize, (usize, Parameters, &[usize]))| {
            let own = &problem.parts()[part];
            let bounds = own.free().iter().map(|&parameter| {
                let (low, high) = own.bounds().of(parameter);
                (parameter, low, high)
            });
            SavedSet {
                measurement,
                name: problem.set_names()[part].to_string(),
                start: *own.start(),
                free: own.free().to_vec(),
                bounds: bounds.collect(),
                ties: own.ties().to_vec(),
                weight: own.emphasis(),
                before,
                masked: mask.to_vec(),
            }
        };
        Self {
            model: problem.model(),
            shared,
            fit_options: *problem.options(),
            sets: sets.enumerate().map(set).collect(),
            account: FitRecord::default(),
        }
    }

    /// A joint fit of a file, if it can be one of its measurements.
    ///
    /// # Errors
    /// It is none.
    pub fn read(value: serde_json::Value, measurements: &[SavedMeasurement]) -> Result<Self, SavedFitError> {
        let fit: Self = serde_path_to_error::deserialize(value).map_err(|error| SavedFitError::Json(error.into()))?;
        let problem = fit.problem(measurements)?;
        if let Some(fault) = fit.account.fault(problem.unknowns().len()) {
            return Err(SavedFitError::Record(fault));
        }
        let befores = fit.sets.iter().map(|set| set.before);
        let places: Vec<Parameters> = fit.account.points(&problem).flatten().chain(befores).collect();
        let can_be_set = |place: &Parameters| can_be_set(place, fit.model.parameters());
        places.iter().try_for_each(can_be_set).map_err(SavedFitError::Parameters)?;
        Ok(fit)
    }

    /// What was fitted, or is to be.
    ///
    /// # Errors
    /// These measurements cannot be fitted so.
    pub fn problem(&self, measurements: &[SavedMeasurement]) -> Result<JointProblem, SavedFitError> {
        let masked = self.sets.iter().map(|set| -> Result<Cow<'_, Measurement>, SavedFitError> {
            let measurement = &measurements.get(set.measurement).ok_or(SavedFitError::Measurement)?.measurement;
            if !is_mask(&set.masked, measurement.rows.len()) {
                return Err(SavedFitError::Mask);
            }
            Ok(with_mask(measurement, &set.masked))
        });
        let masked = masked.collect::<Result<Vec<_>, _>>()?;
        let mut sets = self.sets.iter();
        let fit = JointFit::new(masked.iter().map(|measurement| &**measurement), self.model);
        let fit = fit.named(self.sets.iter().map(|set| set.name.as_str())).own(self.model.parameters().without_all(self.shared).iter());
        let fit = fit.options(self.fit_options).weights(self.sets.iter().map(|set| set.weight)).each(|fit| {
            let Some(set) = sets.next() else { return fit };
            let free: ParameterSet = set.free.iter().copied().collect();
            let fit = self.model.parameters().without_all(free).iter().fold(fit.start_at(set.start), Fit::hold);
            let fit = free.iter().fold(fit, Fit::free);
            let fit = set.ties.iter().fold(fit, |fit, tie| fit.tie(tie.parameter, tie.factor, tie.to));
            set.bounds.iter().fold(fit, |fit, &(parameter, low, high)| fit.bound(parameter, low..=high))
        });
        fit.problem().map_err(SavedFitError::Joint)
    }

    /// The fit again. None where the data of the session are no longer such that there is one.
    pub fn restore(&self, measurements: &[SavedMeasurement]) -> Option<RestoredJointFit> {
        let problem = self.problem(measurements).ok()?;
        let result = self.account.joint_result(&problem)?;
        let sets = self.sets.iter().map(|set| (set.measurement, set.before, Mask::from(&set.masked[..]))).collect();
        Some(RestoredJointFit { joint: JointEntry { result, problem: Arc::new(problem), shared: self.shared }, sets })
    }
}
