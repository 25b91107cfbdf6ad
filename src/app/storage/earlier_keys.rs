//! Keys of files of earlier releases that mean the same under another key now.

use crate::app::work::settings::Settings;
use pbrdf::model::{DolpFormula, Model};
use serde::Deserialize;

/// Earlier keys of settings, and of a fit of a session: the formula of DoLP stood under `choices.eq17`.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct EarlierKeys {
    choices: EarlierChoices,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct EarlierChoices {
    eq17: Option<DolpFormula>,
}

/// A file with settings: a session or the settings file.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct EarlierFile {
    settings: EarlierKeys,
}

impl EarlierFile {
    /// Puts the values where they stand now; weights too small for the domain, which earlier releases took, become 0.
    pub fn apply(&self, settings: &mut Settings) {
        self.settings.apply(&mut settings.model);
        settings.parameters = settings.parameters.flushed_to_zero();
    }
}

impl EarlierKeys {
    /// Puts the values where they stand now.
    pub fn apply(&self, model: &mut Model) {
        model.dolp_formula = self.choices.eq17.unwrap_or(model.dolp_formula);
    }
}
