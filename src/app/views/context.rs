//! What a pane is, and what it gets to see of the window.

use crate::app::tasks::jobs::Jobs;
use crate::app::views::action::Action;
use crate::app::views::benchmarks::Benchmarks;
use crate::app::views::derived::Derived;
use crate::app::work::diagnostics::Diagnostics;
use crate::app::work::document::Document;
use crate::app::work::fit_history::{FitEntry, FitHistory};
use crate::app::work::model_fit::ModelFit;
use crate::app::work::settings::Settings;
use crate::figure::Figure;
use egui::{Key, Ui};
use std::any::Any;
use std::sync::Arc;

/// What a pane may look at, and where it leaves what it wants to have done.
pub struct Cx<'a> {
    /// A draft of the settings: its differences become edits of the work after the frame.
    pub settings: &'a mut Settings,
    pub document: &'a Document,
    /// The fit that is shown.
    pub fit: Option<&'a Arc<FitEntry>>,
    pub fits: &'a FitHistory,
    pub comparison: &'a [ModelFit],
    /// Profile and bootstrap of that fit.
    pub diagnostics: &'a mut Diagnostics,
    pub derived: &'a mut Derived,
    /// The progress of jobs; commands start and cancel them.
    pub jobs: &'a Jobs,
    pub benchmarks: &'a mut Benchmarks,
    pub actions: &'a mut Vec<Action>,
    /// Whether a button of the mouse is down: axes then grow and do not shrink.
    pub interacting: bool,
}

/// The content of a pane.
pub trait View: Any {
    /// Makes anew what it paints where inputs are others; called before each frame that has the pane on screen, and at no other time.
    fn refresh(&mut self, _cx: &mut Cx<'_>) {}

    /// Paints it; evaluates nothing.
    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui);

    /// The content of its *Show* menu.
    fn options_ui(&mut self, _cx: &mut Cx<'_>, _ui: &mut Ui) {}

    /// What it shows, for files and the clipboard.
    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        None
    }

    /// Stops what is being made for it, once it is off the screen.
    fn suspend(&mut self) {}

    /// How many frames it is behind the sliders.
    fn lag(&self) -> u64 {
        0
    }
}

/// What there is to know of a pane.
pub struct PaneSpec {
    pub title: &'static str,
    pub tooltip: &'static str,
    /// Shows it, together with Ctrl.
    pub shortcut: Option<Key>,
    /// Whether it has a *Show* menu.
    pub has_options: bool,
    /// Whether it has a plot to export.
    pub has_figure: bool,
    pub new: fn() -> Box<dyn View>,
}
