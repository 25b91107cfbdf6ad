//! What the window holds; the files beside this one say what it does.

pub mod arrange;
pub mod autosave;
mod eframe_app;
pub mod execute;
pub mod fits;
mod inquiries;
pub mod job_results;
mod lesson;
pub mod link;
mod lists;
pub mod logic;
pub mod open;
mod plans;
pub mod posteriors;
pub mod session;
pub mod title;
pub mod ui;
mod walk;

use crate::app::jobs::spawner::Spawner;
use crate::app::platform;
use crate::app::shell::dialogs::{Dialogs, Lists};
use crate::app::shell::docking::Dock;
use crate::app::shell::frame_times::FrameTimes;
use crate::app::shell::lessons::Lessons;
use crate::app::shell::persistence::Persistence;
use crate::app::shell::theme;
use crate::app::shell::toasts::Toasts;
use crate::app::storage::export::SheetForm;
use crate::app::storage::settings_file::{SavedSettings, SettingsFile};
use crate::app::tasks::jobs::Jobs;
use crate::app::text::i18n;
use crate::app::views::action::Action;
use crate::app::views::benchmarks::Benchmarks;
use crate::app::views::derived::Derived;
use crate::app::views::{Cx, Views};
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::free;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::WindowSettings;
use crate::app::work::workspace::Workspace;
use crate::figure::Figure;
use crate::report::ResultTable;
use pbrdf::model::ParameterSet;

/// The window.
pub struct App {
    /// The work that is shown: the user's own, or that of the lesson that is open.
    pub work: Workspace,
    pub window: WindowSettings,
    pub derived: Derived,
    pub jobs: Jobs,
    /// What the program found out about itself.
    pub benchmarks: Benchmarks,
    pub toasts: Toasts,
    pub views: Views,
    pub dock: Dock,
    pub dialogs: Dialogs,
    pub lessons: Lessons,
    pub persistence: Persistence,
    /// Whether a button of the mouse is down: axes then grow and do not shrink.
    pub interacting: bool,
    /// Changes of the work that views and panels ask for in this frame.
    pub edits: Vec<Edit>,
    /// What is carried out before the next frame.
    pub actions: Vec<Action>,
    pub frame_times: FrameTimes,
}

impl App {
    pub fn new(ctx: &egui::Context, stored: SettingsFile) -> Self {
        let SettingsFile { settings: SavedSettings { settings, surface }, layout, window } = stored;
        theme::install(ctx);
        if platform::has_fingers() {
            theme::widen(ctx);
        }
        theme::set(ctx, window.theme);
        ctx.set_zoom_factor(window.zoom);
        i18n::install();
        i18n::set(window.language);
        let repaint = ctx.clone();
        Self {
            dock: Dock::new(&layout),
            work: Workspace::new(settings, surface, layout),
            window,
            derived: Derived::default(),
            jobs: Jobs::new(Spawner::new(move || repaint.request_repaint())),
            benchmarks: Benchmarks::default(),
            toasts: Toasts::default(),
            views: Views::default(),
            dialogs: Dialogs::default(),
            lessons: Lessons::default(),
            persistence: Persistence::default(),
            interacting: false,
            edits: Vec::new(),
            actions: Vec::new(),
            frame_times: FrameTimes::default(),
        }
    }

    /// The user's own work, also while a lesson is open.
    pub fn own_work(&self) -> &Workspace {
        self.lessons.session.as_ref().map_or(&self.work, |session| &session.saved)
    }

    /// The parameters that a fit would change: those that the data can speak of, less the locked
    /// ones.
    pub fn free(&self) -> ParameterSet {
        free(self.work.surface(), self.work.active().measurement.has_brdf())
    }

    /// What panes get to see, the panes, and where they lie.
    pub fn split(&mut self) -> (Cx<'_>, &mut Views, &mut Dock) {
        let Self { work, derived, jobs, benchmarks, edits, actions, interacting, views, dock, .. } = self;
        let is_presented = dock.is_presented();
        let cx = Cx { work, derived, jobs, benchmarks, edits, actions, interacting: *interacting, is_presented };
        (cx, views, dock)
    }

    /// What panels get to see, and the lists above the sliders.
    pub fn split_lists(&mut self) -> (Cx<'_>, &mut Lists) {
        let Self { work, derived, jobs, benchmarks, edits, actions, interacting, dialogs, dock, .. } = self;
        let is_presented = dock.is_presented();
        let cx = Cx { work, derived, jobs, benchmarks, edits, actions, interacting: *interacting, is_presented };
        (cx, &mut dialogs.lists)
    }

    /// The figure of a pane, for files and the clipboard.
    pub fn figure(&mut self, pane: PaneId) -> Option<Figure> {
        let (cx, views, _) = self.split();
        views.figure(pane, &cx)
    }

    /// The plots on screen as one figure; none where there are fewer than two.
    pub fn sheet(&mut self, form: SheetForm) -> Option<Figure> {
        let panes = self.dock.on_screen();
        let (rows, columns) = form.shape();
        let figures: Vec<Figure> = panes.into_iter().filter_map(|pane| self.figure(pane)).take(rows * columns).collect();
        (figures.len() > 1).then(|| Figure::sheet("", figures, columns))
    }

    /// The table of results as it is shown.
    pub fn results(&mut self) -> Option<ResultTable> {
        let (cx, views, _) = self.split();
        views.table(PaneId::Results, &cx)
    }

    /// Carries out what views and panels asked for, and takes over where the panes lie.
    pub fn apply_edits(&mut self) {
        let layout = self.dock.take_edit().filter(|layout| layout != self.work.layout());
        for edit in self.edits.drain(..).chain(layout.map(Edit::SetLayout)) {
            self.work.apply(edit);
        }
    }

    /// Shows other work from the beginning, with its panes where they lay.
    pub fn show_work(&mut self, work: Workspace) -> Workspace {
        self.dock.rearrange(Dock::new(work.layout()));
        self.dialogs.import = None;
        self.dialogs.imports_waiting.clear();
        self.views = Views::default();
        self.jobs.fits.abandon();
        self.jobs.posteriors.abandon();
        self.jobs.plans.abandon();
        std::mem::replace(&mut self.work, work)
    }
}
