//! Keys of files of earlier releases that mean the same under another key now.

use crate::app::work::layout::Layout;
use crate::app::work::surface::Surface;
use pbrdf::model::{DolpFormula, Model};
use serde::Deserialize;

/// Earlier keys of settings, and of a fit of a session: the formula of DoLP stood under
/// `choices.eq17`.
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
    window: EarlierWindow,
}

/// The layout of panes stood under `window.layout` of the settings file.
#[derive(Deserialize, Default)]
#[serde(default)]
struct EarlierWindow {
    #[serde(deserialize_with = "Layout::lenient")]
    layout: Layout,
}

impl EarlierFile {
    /// Puts the values where they stand now; weights too small for the domain, which earlier
    /// releases took, become 0.
    pub fn apply(&self, surface: &mut Surface) {
        self.settings.apply(&mut surface.model);
        surface.parameters = surface.parameters.flushed_to_zero();
    }

    /// The layout under its earlier key, or the default.
    pub fn layout(self) -> Layout {
        self.window.layout
    }
}

impl EarlierKeys {
    /// Puts the values where they stand now.
    pub fn apply(&self, model: &mut Model) {
        model.dolp_formula = self.choices.eq17.unwrap_or(model.dolp_formula);
    }
}
