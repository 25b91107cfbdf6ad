//! An entry of the history of fits in a session: a fit of one measurement, or of several together.

use crate::app::storage::saved_fit::{RestoredFit, SavedFit, SavedMeasurement};
use crate::app::storage::saved_joint_fit::{RestoredJointFit, SavedJointFit};
use crate::app::storage::session_error::SavedFitError;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::open_measurement::{Mask, OpenMeasurement};
use pbrdf::model::{Parameters, Preset};
use serde::Serialize;

/// A fit of a session. In the file a joint one is known by its key `sets`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum SavedEntry {
    One(Box<SavedFit>),
    Joint(Box<SavedJointFit>),
}

/// A fit of a session, made again.
pub enum RestoredEntry {
    One(Box<RestoredFit>),
    Joint(Box<RestoredJointFit>),
}

impl SavedEntry {
    /// Of the parts of a fit, each with the number of its measurement in the session, from 0.
    pub fn new(parts: &[(&FitEntry, usize)]) -> Option<Self> {
        match parts {
            [(fit, measurement)] if fit.joint.is_none() => Some(Self::One(Box::new(SavedFit::new(fit, *measurement)))),
            _ => SavedJointFit::new(parts).map(|fit| Self::Joint(Box::new(fit))),
        }
    }

    /// A fit of a file, if it can be one of its measurements.
    ///
    /// # Errors
    /// It is none.
    pub fn read(value: serde_json::Value, measurements: &[SavedMeasurement]) -> Result<Self, SavedFitError> {
        if value.get("sets").is_some() {
            SavedJointFit::read(value, measurements).map(|fit| Self::Joint(Box::new(fit)))
        } else {
            SavedFit::read(value, measurements).map(|fit| Self::One(Box::new(fit)))
        }
    }

    /// The fit again. None where the data of the session are no longer such that there is one.
    pub fn restore(&self, measurements: &[SavedMeasurement]) -> Option<RestoredEntry> {
        match self {
            Self::One(fit) => fit.restore(measurements).map(|fit| RestoredEntry::One(Box::new(fit))),
            Self::Joint(fit) => fit.restore(measurements).map(|fit| RestoredEntry::Joint(Box::new(fit))),
        }
    }
}

impl RestoredEntry {
    /// Whether it is, alone or with others, of the measurement of that number in the session, and has the terms of a preset.
    pub fn is_of(&self, measurement: usize, preset: &Preset) -> bool {
        match self {
            Self::One(fit) => fit.measurement == measurement && preset.has_terms_of(fit.report.model),
            Self::Joint(fit) => fit.sets.iter().any(|set| set.0 == measurement) && preset.has_terms_of(fit.joint.result.model),
        }
    }

    /// The entries of the history, each with the number of its measurement in the session, from 0.
    pub fn into_entries(self, measurements: &[OpenMeasurement]) -> Vec<(usize, FitEntry)> {
        match self {
            Self::One(fit) => {
                let RestoredFit { measurement, report, problem, before, mask } = *fit;
                let about = measurements[measurement].clone();
                let entry = FitEntry::new(about.clone(), problem, report);
                vec![(measurement, placed(entry, before, mask, &about))]
            }
            Self::Joint(fit) => {
                let RestoredJointFit { joint, sets } = *fit;
                let about: Vec<OpenMeasurement> = sets.iter().map(|(measurement, ..)| measurements[*measurement].clone()).collect();
                let entries = FitEntry::of_joint(about.clone(), joint);
                let place = |((entry, (measurement, before, mask)), about)| (measurement, placed(entry, before, mask, &about));
                entries.into_iter().zip(sets).zip(about).map(place).collect()
            }
        }
    }
}

/// With the sliders before and the mask that it had. A fit with another mask is of no generation of its measurement.
fn placed(entry: FitEntry, before: Parameters, mask: Mask, about: &OpenMeasurement) -> FitEntry {
    let generation = if mask == *about.mask() { about.generation } else { 0 };
    FitEntry { before, mask, generation, ..entry }
}
