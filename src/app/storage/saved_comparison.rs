//! The comparison of models of a measurement in a session: row by row the key of a preset, and which fit.

use crate::app::work::model_fit::ModelFit;
use pbrdf::model::Preset;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;

/// The rows with a fit, in their order. Without one of its fits a comparison would be another one, with another best model: it is kept whole
/// or not at all.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct SavedComparison(Vec<(String, usize)>);

impl<'de> Deserialize<'de> for SavedComparison {
    /// What is no comparison is none: the measurement is worth more.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_json::Value::deserialize(deserializer)?;
        Ok(Self(serde_json::from_value(value).unwrap_or_default()))
    }
}

impl SavedComparison {
    /// Of rows, given the place in the session of the fit of an id.
    pub fn new(rows: &[ModelFit], place_of: impl Fn(usize) -> Option<usize>) -> Self {
        let by_id = rows.iter().filter_map(|row| Some((row.preset.key.to_owned(), row.result.as_ref().ok()?.id)));
        Self(by_id.collect()).moved(place_of)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The same where the fits have other places.
    pub fn moved(self, place_of: impl Fn(usize) -> Option<usize>) -> Self {
        let rows: Option<Vec<_>> = self.0.into_iter().map(|(key, fit)| Some((key, place_of(fit)?))).collect();
        Self(rows.unwrap_or_default())
    }

    /// Its models by the places of their fits, if each of these is one.
    pub fn presets(&self, is_fit_of: impl Fn(usize, &Preset) -> bool) -> BTreeMap<usize, &'static Preset> {
        let row = |(key, fit): &(String, usize)| Some((*fit, Preset::from_key(key).filter(|preset| is_fit_of(*fit, preset))?));
        let presets: Option<BTreeMap<_, _>> = self.0.iter().map(row).collect();
        presets.unwrap_or_default()
    }
}
