//! What a pane is, and what it gets to see of the window.

use crate::app::tasks::jobs::Jobs;
use crate::app::views::action::Action;
use crate::app::views::benchmarks::Benchmarks;
use crate::app::views::derived::Derived;
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::settings::ViewOptions;
use crate::app::work::workspace::Workspace;
use crate::figure::Figure;
use crate::report::ResultTable;
use egui::{Key, Response, Ui};
use std::any::Any;

/// What a pane may look at, and where it leaves what it wants to have done.
pub struct Cx<'a> {
    pub work: &'a Workspace,
    pub derived: &'a Derived,
    /// The progress of jobs; actions start and cancel them.
    pub jobs: &'a Jobs,
    pub benchmarks: &'a mut Benchmarks,
    /// Changes of the work, carried out after the frame.
    pub edits: &'a mut Vec<Edit>,
    pub actions: &'a mut Vec<Action>,
    /// Whether a button of the mouse is down: axes then grow and do not shrink.
    pub interacting: bool,
    /// Whether panes are presented: what is seldom changed then leaves its room to the plots.
    pub is_presented: bool,
}

impl Cx<'_> {
    /// A tick box for a switch.
    pub fn switch_ui(&mut self, switch: Switch, text: String, ui: &mut Ui) -> Response {
        let mut on = switch.is_on(self.work.settings());
        let response = ui.checkbox(&mut on, text);
        if response.changed() {
            self.edits.push(Edit::SetSwitch(switch, on));
        }
        response
    }

    /// Widgets that change what panes show.
    pub fn view_options_ui(&mut self, content: impl FnOnce(&mut ViewOptions)) {
        let before = self.work.settings().view_options;
        let mut options = before;
        content(&mut options);
        if options != before {
            self.edits.push(Edit::SetViewOptions(options));
        }
    }
}

/// The content of a pane.
pub trait View: Any {
    /// Whether it shows the curves and points that panes share; they are made before it.
    fn needs_curves(&self) -> bool {
        false
    }

    /// Makes anew what it paints where inputs are others; called before each frame that has the
    /// pane on screen, and at no other time.
    fn refresh(&mut self, _cx: &mut Cx<'_>) {}

    /// Paints it; evaluates nothing.
    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui);

    /// Whether the pane itself has what its *Show* menu would have, which is then left out.
    fn has_options_beside(&self, _cx: &Cx<'_>) -> bool {
        false
    }

    /// The content of its *Show* menu.
    fn options_ui(&mut self, _cx: &mut Cx<'_>, _ui: &mut Ui) {}

    /// What it shows, for files and the clipboard.
    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        None
    }

    /// Its table of results, the same way.
    fn table(&self, _cx: &Cx<'_>) -> Option<ResultTable> {
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
