//! The user's work as one value: what is open, what is set, and what was fitted.

use crate::app::work::diagnostics::Diagnostics;
use crate::app::work::document::{Document, Mask};
use crate::app::work::fit_history::{FitEntry, FitHistory};
use crate::app::work::history::History;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::settings::Settings;
use pbrdf::measurement::Measurement;
use pbrdf::model::Parameters;
use std::path::PathBuf;
use std::sync::Arc;

/// The user's work.
pub struct Workspace {
    pub settings: Settings,
    pub document: Document,
    /// The fit that is shown.
    pub shown_fit: Option<Arc<FitEntry>>,
    /// The fits of this session, the newest first.
    pub fit_history: FitHistory,
    /// The presets fitted to the open measurement.
    pub model_comparison: Vec<ModelFit>,
    /// Profile and bootstrap of the shown fit.
    pub diagnostics: Diagnostics,
    pub undo: History<Setup>,
    /// The parameters at which the last live refit began or ended.
    pub last_refit_at: Option<Parameters>,
    /// The file of the session that is open.
    pub session_file: Option<PathBuf>,
}

/// What a step of undo restores.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    pub settings: Settings,
    /// The mask of the measurement of that number.
    pub mask: Mask,
    pub number: u64,
}

impl Workspace {
    /// Work with these settings and no measurement.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            document: Document::new(String::new(), Measurement::default(), 0),
            shown_fit: None,
            fit_history: FitHistory::default(),
            model_comparison: Vec::new(),
            diagnostics: Diagnostics::default(),
            undo: History::default(),
            last_refit_at: None,
            session_file: None,
        }
    }

    /// The workspace in which a lesson begins: the same measurement and fits, default settings, nothing to undo.
    pub fn for_lesson(&self) -> Self {
        let settings = Settings::for_measurement(&self.document.measurement);
        Self {
            last_refit_at: Some(settings.parameters),
            document: self.document.clone(),
            fit_history: self.fit_history.clone(),
            ..Self::new(settings)
        }
    }

    /// What a step of undo restores, as it is now.
    pub fn setup(&self) -> Setup {
        Setup { settings: self.settings.clone(), mask: self.document.mask().clone(), number: self.document.number }
    }
}
