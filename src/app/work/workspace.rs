//! The user's work as one value: what is open, what is set, and what was fitted.

use crate::app::work::diagnostics::Diagnostics;
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::{FitEntry, FitHistory};
use crate::app::work::history::History;
use crate::app::work::layout::Layout;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::open_measurement::{Mask, OpenMeasurement};
use crate::app::work::settings::Settings;
use crate::app::work::setup::Setup;
use crate::app::work::surface::{PinnedSurface, Surface};
use pbrdf::fit::FitResult;
use pbrdf::measurement::Measurement;
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The user's work.
pub struct Workspace {
    settings: Settings,
    measurements: MeasurementList,
    pinned: Vec<PinnedSurface>,
    layout: Layout,
    shown_fit: Option<Arc<FitEntry>>,
    fit_history: FitHistory,
    model_comparison: Vec<ModelFit>,
    diagnostics: Diagnostics,
    session_file: Option<PathBuf>,
    undo: History<Setup>,
    revision: u64,
    /// The revision at which a step of undo was recorded last.
    recorded_at: u64,
    /// The revision at which the user last moved a value or masked a row; 0 where the values are
    /// those of a fit.
    moved_at: u64,
    /// The parameters that the user moved then.
    moved: ParameterSet,
}

fn next_revision() -> u64 {
    static LAST: AtomicU64 = AtomicU64::new(0);
    LAST.fetch_add(1, Ordering::Relaxed) + 1
}

impl Default for Workspace {
    fn default() -> Self {
        Self::new(Settings::default(), Surface::default(), Layout::default())
    }
}

impl Workspace {
    /// Work without a measurement.
    pub fn new(settings: Settings, surface: Surface, layout: Layout) -> Self {
        let nothing = OpenMeasurement::new(String::new(), Measurement::default()).with_surface(surface);
        let revision = next_revision();
        Self {
            settings,
            measurements: MeasurementList::single(nothing),
            pinned: Vec::new(),
            layout,
            shown_fit: None,
            fit_history: FitHistory::default(),
            model_comparison: Vec::new(),
            diagnostics: Diagnostics::default(),
            session_file: None,
            undo: History::default(),
            revision,
            recorded_at: 0,
            moved_at: revision,
            moved: ParameterSet::EMPTY,
        }
    }

    /// The workspace in which a lesson begins: the same measurement, fits and panes, default
    /// settings, nothing to undo.
    pub fn for_lesson(&self) -> Self {
        let active = self.active().clone();
        let surface = Surface::for_measurement(&active.measurement);
        Self {
            measurements: MeasurementList::single(active.with_surface(surface)),
            fit_history: self.fit_history.clone(),
            layout: self.layout.clone(),
            moved_at: 0,
            ..Self::default()
        }
    }

    /// Work that was kept; fits from the oldest to the newest, each with whether it is shown.
    pub fn restored(
        settings: Settings,
        layout: Layout,
        measurements: MeasurementList,
        pinned: Vec<PinnedSurface>,
        fits: impl IntoIterator<Item = (FitEntry, bool)>,
    ) -> Self {
        let mut work = Self { settings, layout, measurements, pinned, moved_at: 0, ..Self::default() };
        for (fit, is_shown) in fits {
            let fit = work.fit_history.push(fit);
            if is_shown {
                work.shown_fit = Some(fit);
            }
        }
        work.record_step();
        work
    }

    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    pub fn measurements(&self) -> &MeasurementList {
        &self.measurements
    }

    /// The measurement that panels and panes show.
    pub fn active(&self) -> &OpenMeasurement {
        self.measurements.active()
    }

    /// The surface that the sliders show.
    pub fn surface(&self) -> &Surface {
        &self.active().surface
    }

    pub fn pinned(&self) -> &[PinnedSurface] {
        &self.pinned
    }

    /// Where the panes lie; while all are closed, where they lay before.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The fit that is shown.
    pub fn shown_fit(&self) -> Option<&Arc<FitEntry>> {
        self.shown_fit.as_ref()
    }

    /// The fits of this session, the newest first.
    pub fn fit_history(&self) -> &FitHistory {
        &self.fit_history
    }

    /// The presets fitted to the active measurement.
    pub fn model_comparison(&self) -> &[ModelFit] {
        &self.model_comparison
    }

    /// Profile and bootstrap of the shown fit.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// The file of the session that is open.
    pub fn session_file(&self) -> Option<&Path> {
        self.session_file.as_deref()
    }

    pub fn can_undo(&self) -> bool {
        self.undo.can_undo()
    }

    pub fn can_redo(&self) -> bool {
        self.undo.can_redo()
    }

    /// Another number after every change, and none twice in a run of the program: work of the same
    /// revision is the same work.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The revision at which the user last moved a value or masked a row, 0 where the values are
    /// those of a fit: a live refit of an earlier one is out of date.
    pub fn moved_at(&self) -> u64 {
        self.moved_at
    }

    /// The parameters that the user moved last, all others having stayed: a live refit holds them.
    pub fn moved(&self) -> ParameterSet {
        self.moved
    }

    /// Makes one change.
    pub fn apply(&mut self, edit: Edit) {
        self.revision = next_revision();
        match edit {
            Edit::SetParameters(parameters) => self.move_to(parameters),
            Edit::SetModel(model) => self.measurements.active_mut().surface.model = model,
            Edit::SetSurface(surface) => {
                self.move_to(surface.parameters);
                self.measurements.active_mut().surface = *surface;
            }
            Edit::SetDirection { theta_i, dphi } => (self.settings.theta_i, self.settings.dphi) = (theta_i, dphi),
            Edit::SetSwitch(switch, on) => switch.set(&mut self.settings, on),
            Edit::SetFitOptions(options) => self.settings.fit_options = options,
            Edit::SetStarts(starts) => self.settings.starts = starts,
            Edit::SetSeed(seed) => self.settings.seed = seed,
            Edit::SetViewOptions(options) => self.settings.view_options = options,
            Edit::SetLandscapeAxes(axes) => self.settings.landscape = axes,
            Edit::SetMetalSelection(selection) => self.settings.metal_selection = selection,
            Edit::SetDesign(design) => self.settings.design = design,
            Edit::Mask { rows, masked } => {
                self.measurements.active_mut().set_masked(&rows, masked);
                (self.moved_at, self.moved) = (self.revision, ParameterSet::EMPTY);
            }
            Edit::Open(opened) => self.open(*opened),
            Edit::SetProfiled(parameter) => self.diagnostics.parameter = Some(parameter),
            Edit::SetProfile(profile) => self.diagnostics.profile = profile,
            Edit::SetReplicates(replicates) => self.diagnostics.replicates = replicates,
            Edit::SetBootstrap(scatter) => self.diagnostics.scatter = scatter,
            Edit::SetModelComparison(fits) => self.model_comparison = fits,
            Edit::SetLayout(layout) => self.layout = layout,
            Edit::SetSessionFile(file) => self.session_file = file,
            Edit::Undo => self.restore(History::undo),
            Edit::Redo => self.restore(History::redo),
            Edit::AddFit(fit) => {
                self.take_values(fit.report.parameters, self.surface().model);
                let fit = self.fit_history.push(*fit);
                self.show_fit(Some(fit));
            }
            Edit::SetFitReport { id, report } => self.set_fit_report(id, *report),
            Edit::Refit(report) => self.take_refit(&report),
            Edit::TakeValues { parameters, model } => self.take_values(parameters, model),
            Edit::UseFit => {
                if let Some(fit) = self.shown_fit.clone() {
                    self.measurements.active_mut().surface.model = fit.report.model;
                    self.move_to(fit.report.parameters);
                }
            }
            Edit::UseValuesBeforeFit => {
                if let Some(fit) = self.shown_fit.clone() {
                    self.move_to(fit.before);
                }
            }
            Edit::ReturnToFit(index) => {
                if let Some(fit) = self.fit_history.get(index) {
                    self.take_values(fit.report.parameters, fit.report.model);
                    self.show_fit(Some(fit).filter(|fit| fit.number == self.active().number));
                }
            }
            Edit::UseModelFit(index) => {
                if let Some(ModelFit { result: Ok(report), .. }) = self.model_comparison.get(index) {
                    let (parameters, model) = (report.parameters, report.model);
                    self.take_values(parameters, model);
                }
            }
        }
    }

    /// Records a step of undo, if anything that undo restores differs from the step before. Called
    /// while no slider is held.
    pub fn record_step(&mut self) {
        if self.recorded_at != self.revision {
            self.recorded_at = self.revision;
            self.undo.record(self.setup());
        }
    }

    /// Makes the work as it is now the last step of undo, in place of the one before.
    pub(super) fn replace_step(&mut self) {
        self.recorded_at = self.revision;
        self.undo.replace(self.setup());
    }

    /// Takes over the steps of undo of other work: the work as it is now becomes the next one.
    pub fn continue_undo_of(&mut self, other: Self) {
        self.undo = other.undo;
        self.recorded_at = 0;
    }

    /// What a step of undo restores, as it is now.
    pub fn setup(&self) -> Setup {
        Setup::of(&self.settings, &self.measurements, &self.pinned)
    }

    fn restore(&mut self, step: fn(&mut History<Setup>) -> Option<Setup>) {
        if let Some(setup) = step(&mut self.undo) {
            self.moved_at = 0;
            (self.settings, self.pinned) = setup.restore(&mut self.measurements);
            self.replace_step();
        }
    }

    /// Puts a measurement in the place of all that are open, without its fits; no step of undo of
    /// its own. The sliders stay.
    pub(super) fn open(&mut self, mut opened: OpenMeasurement) {
        opened.surface = self.surface().clone();
        opened.surface.adapt_to(&opened.measurement);
        self.settings.adapt_to(&opened);
        self.measurements = MeasurementList::single(opened);
        self.forget_fits();
        self.replace_step();
    }

    /// Sets up settings, surface and mask as a lesson wants them.
    pub(super) fn set_up(&mut self, settings: Settings, surface: Surface, mask: &Mask) {
        self.revision = next_revision();
        self.settings = settings;
        self.moved_at = 0;
        let active = self.measurements.active_mut();
        active.surface = surface;
        active.restore_mask(mask);
    }

    /// The user moves the sliders.
    fn move_to(&mut self, parameters: Parameters) {
        let before = self.surface().parameters;
        if parameters != before {
            self.moved_at = self.revision;
            self.moved = Parameter::ALL.into_iter().filter(|&parameter| parameters[parameter] != before[parameter]).collect();
        }
        self.measurements.set_parameters(parameters);
    }

    /// Values and model from a fit: the live refit does not begin at them.
    fn take_values(&mut self, parameters: Parameters, model: Model) {
        self.measurements.set_parameters(parameters);
        self.measurements.active_mut().surface.model = model;
        self.moved_at = 0;
    }

    /// Takes what a live refit found. Sliders may have moved since it began: locked and moved ones
    /// stay, those that it fitted are the fit's.
    fn take_refit(&mut self, report: &FitResult) {
        let Surface { mut parameters, locked, .. } = *self.surface();
        let held = locked.union(self.moved);
        for estimate in report.estimates.iter().filter(|estimate| estimate.free && !held.contains(estimate.parameter)) {
            parameters[estimate.parameter] = estimate.value;
        }
        self.measurements.set_parameters(parameters);
    }

    fn set_fit_report(&mut self, id: usize, report: FitResult) {
        let Some(before) = self.fit_history.iter().find(|fit| fit.id == id).map(|fit| fit.report.parameters) else { return };
        let (after, model) = (report.parameters, report.model);
        let Some(fit) = self.fit_history.replace_report(id, report) else { return };
        let surface = self.surface();
        if after != before && fit.number == self.active().number && (surface.parameters, surface.model) == (before, model) {
            self.record_step();
            self.take_values(after, model);
            // Undo goes from the better minimum to what was before the fit.
            self.replace_step();
        }
        if self.shown_fit.as_ref().is_some_and(|shown| shown.id == id) {
            self.shown_fit = Some(fit);
            if after != before {
                self.diagnostics.forget();
            }
        }
    }

    /// Shows a fit; profile and bootstrap of another one are dropped.
    fn show_fit(&mut self, fit: Option<Arc<FitEntry>>) {
        self.shown_fit = fit;
        self.diagnostics.forget();
    }

    /// Shows no fit, and no comparison of models.
    pub(super) fn forget_fits(&mut self) {
        self.show_fit(None);
        self.model_comparison.clear();
    }
}

/// Tests set things without a widget.
#[cfg(test)]
impl Workspace {
    pub fn settings_mut(&mut self) -> &mut Settings {
        self.revision = next_revision();
        &mut self.settings
    }

    /// As if a user moved the sliders.
    pub fn surface_mut(&mut self) -> &mut Surface {
        self.revision = next_revision();
        self.moved_at = self.revision;
        &mut self.measurements.active_mut().surface
    }

    /// All that sliders, switches and menus set.
    pub fn values(&self) -> (Settings, Surface) {
        (self.settings.clone(), self.surface().clone())
    }

    pub fn set_shown_fit(&mut self, fit: FitEntry) {
        self.revision = next_revision();
        self.shown_fit = Some(Arc::new(fit));
    }
}

#[cfg(test)]
mod tests {
    use super::{Layout, MeasurementList, Settings, Workspace};
    use crate::app::work::edit::{Edit, Switch};
    use crate::app::work::open_measurement::{EXAMPLES, OpenMeasurement};
    use pbrdf::measurement::Measurement;
    use pbrdf::model::{Parameter, ParameterSet, Parameters};

    fn example(name: &str) -> Edit {
        let measurement = Measurement::read(EXAMPLES[0].text.as_bytes()).expect("an example is a measurement");
        Edit::Open(Box::new(OpenMeasurement::new(name.to_owned(), measurement)))
    }

    /// Work on an example that holds as many rows as a user would mask by hand.
    fn opened() -> Workspace {
        let mut work = Workspace::default();
        work.apply(example("first"));
        work
    }

    #[test]
    fn work_can_be_sent_to_another_thread() {
        fn assert_send<T: Send + Sync>() {}
        assert_send::<Workspace>();
    }

    #[test]
    fn every_edit_has_a_revision_of_its_own_and_undo_restores_what_was_recorded() {
        let mut work = opened();
        let mut revisions = vec![work.revision()];
        let before = work.setup();
        let mut surface = work.surface().clone();
        surface.parameters.n = 2.5;
        surface.locked = ParameterSet::EMPTY.with(Parameter::K);
        surface.set_bounds(Parameter::K, 0.5, 4.0).expect("sound bounds");
        for edit in [
            Edit::SetParameters(Parameters { n: 2.5, ..Parameters::default() }),
            Edit::Mask { rows: vec![0, 3], masked: true },
            Edit::SetSwitch(Switch::LogBrdf, true),
            Edit::SetSurface(Box::new(surface.clone())),
        ] {
            work.apply(edit);
            revisions.push(work.revision());
            work.record_step();
        }
        assert!(revisions.is_sorted_by(|one, next| one < next), "{revisions:?}");
        let after = work.setup();
        assert_eq!((work.active().mask().to_vec(), work.surface(), work.settings().log_brdf), (vec![0, 3], &surface, true));
        for _ in 0..4 {
            assert!(work.can_undo());
            work.apply(Edit::Undo);
        }
        assert_eq!(work.setup(), before);
        assert!(!work.can_undo());
        for _ in 0..4 {
            work.apply(Edit::Redo);
        }
        assert_eq!(work.setup(), after);
    }

    #[test]
    fn undo_takes_a_shared_parameter_back_on_every_surface() {
        let open = ["a", "b"].map(|name| OpenMeasurement::new(name.to_owned(), Measurement::default())).to_vec();
        let list = MeasurementList::several(open, 0, ParameterSet::EMPTY.with(Parameter::Sigma));
        let mut work = Workspace::restored(Settings::default(), Layout::default(), list, Vec::new(), []);
        let sigmas = |work: &Workspace| -> Vec<f64> { work.measurements().iter().map(|open| open.surface.parameters.sigma).collect() };
        let before = sigmas(&work);
        work.apply(Edit::SetParameters(Parameters { sigma: 0.125, ..Parameters::default() }));
        work.record_step();
        assert_eq!(sigmas(&work), [0.125, 0.125]);
        work.apply(Edit::Undo);
        assert_eq!(sigmas(&work), before);
    }

    #[test]
    fn a_change_that_is_taken_back_is_no_step() {
        let mut work = opened();
        work.record_step();
        for value in [2.5, work.surface().parameters.n] {
            work.apply(Edit::SetParameters(Parameters { n: value, ..Parameters::default() }));
        }
        work.record_step();
        assert!(!work.can_undo());
    }

    #[test]
    fn opening_a_measurement_is_no_step_and_undo_leaves_its_rows_alone() {
        let mut work = opened();
        work.record_step();
        work.apply(Edit::Mask { rows: vec![1], masked: true });
        work.record_step();
        work.apply(example("second"));
        work.apply(Edit::Mask { rows: vec![2], masked: true });
        work.record_step();
        for _ in 0..2 {
            work.apply(Edit::Undo);
        }
        assert_eq!((work.active().name.as_str(), work.active().mask().len(), work.can_undo()), ("second", 0, false));
    }

    #[test]
    fn a_live_refit_is_out_of_date_when_the_user_moves_something_and_not_when_a_fit_does() {
        let mut work = opened();
        let (parameters, model) = (work.surface().parameters, work.surface().model);
        work.apply(Edit::TakeValues { parameters: Parameters { n: 3.5, ..parameters }, model });
        work.apply(Edit::SetSwitch(Switch::Limit, false));
        work.apply(Edit::SetParameters(Parameters { n: 3.5, ..parameters }));
        assert_eq!(work.moved_at(), 0);
        work.apply(Edit::SetParameters(parameters));
        assert_eq!(work.moved_at(), work.revision());
        work.apply(Edit::Mask { rows: vec![1], masked: true });
        assert_eq!(work.moved_at(), work.revision());
    }
}
