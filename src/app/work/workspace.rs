//! The user's work as one value: what is open, what is set, and what was fitted.

mod fits;
mod measurements;
mod results;

use crate::app::work::diagnostics::Diagnostics;
use crate::app::work::edit::{Edit, Refit};
use crate::app::work::fit_history::{FitEntry, FitHistory, KeptFit};
use crate::app::work::history::History;
use crate::app::work::layout::Layout;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::open_measurement::{Mask, OpenMeasurement};
use crate::app::work::posterior::DrawnPosterior;
use crate::app::work::predicted_errors::PlannedAngles;
use crate::app::work::settings::Settings;
use crate::app::work::setup::Setup;
use crate::app::work::surface::{PinnedSurface, Surface};
use crate::app::work::weakest_walk::WeakestWalk;
use crate::app::work::workspace::results::ResultsByMeasurement;
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
    fit_history: FitHistory,
    results: ResultsByMeasurement,
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
        let nothing = OpenMeasurement::nothing().with_surface(surface);
        let revision = next_revision();
        Self {
            settings,
            measurements: MeasurementList::single(nothing),
            pinned: Vec::new(),
            layout,
            fit_history: FitHistory::default(),
            results: ResultsByMeasurement::default(),
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

    /// Work that was kept; fits from the oldest to the newest: a comparison gets its rows in that order, the last one first.
    pub fn restored(
        settings: Settings,
        layout: Layout,
        measurements: MeasurementList,
        pinned: Vec<PinnedSurface>,
        fits: impl IntoIterator<Item = KeptFit>,
    ) -> Self {
        let mut work = Self { settings, layout, measurements, pinned, moved_at: 0, ..Self::default() };
        for KeptFit { fit, is_shown, compared_as } in fits {
            let fit = work.fit_history.push(fit);
            if let Some(preset) = compared_as {
                // The fit of the first row of a comparison is the newest.
                let row = ModelFit { preset, result: Ok(fit.clone()), evidence: None };
                work.results.of_mut(fit.number).model_comparison.insert(0, row);
            }
            if is_shown {
                work.show_fit(fit);
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

    /// The fit that is shown of the active measurement.
    pub fn shown_fit(&self) -> Option<&Arc<FitEntry>> {
        self.results.of(self.active().number).shown_fit.as_ref()
    }

    /// The fit that is shown of the measurement of that number while it is active.
    pub fn shown_fit_of(&self, number: u64) -> Option<&Arc<FitEntry>> {
        self.results.of(number).shown_fit.as_ref()
    }

    /// The fits of this session, the newest first.
    pub fn fit_history(&self) -> &FitHistory {
        &self.fit_history
    }

    /// The presets fitted to the active measurement.
    pub fn model_comparison(&self) -> &[ModelFit] {
        self.model_comparison_of(self.active().number)
    }

    /// The comparison of models of the measurement of that number.
    pub fn model_comparison_of(&self, number: u64) -> &[ModelFit] {
        &self.results.of(number).model_comparison
    }

    /// Profile and bootstrap of the shown fit.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.results.of(self.active().number).diagnostics
    }

    /// The draws from the posterior of the active measurement.
    pub fn posterior(&self) -> Option<&Arc<DrawnPosterior>> {
        self.results.of(self.active().number).posterior.as_ref()
    }

    /// The angles that were chosen last for the active measurement, while the plan holds them.
    pub fn plan(&self) -> Option<&PlannedAngles> {
        let planned = self.results.of(self.active().number).plan.as_ref()?;
        let readings = planned.angles.iter().map(|[theta_i, theta_r, _]| [*theta_i, *theta_r]);
        readings.eq(self.settings.design.readings.iter().copied()).then_some(planned)
    }

    /// The way from the shown fit along the direction that the data determine least, and how far the sliders have come on it.
    pub fn walk(&self) -> Option<&(Arc<WeakestWalk>, f64)> {
        let fit = self.shown_fit()?.id;
        self.results.of(self.active().number).walk.as_ref().filter(|(walk, _)| walk.fit == fit)
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
            Edit::SetModel(model) => self.measurements.set_model(model),
            Edit::SetSurface(surface) => {
                self.move_to(surface.parameters);
                self.measurements.set_surface(*surface);
            }
            Edit::Share(shared) => self.measurements.share(shared),
            Edit::SetDirection { theta_i, dphi } => (self.settings.theta_i, self.settings.dphi) = (theta_i, dphi),
            Edit::SetSwitch(switch, on) => switch.set(&mut self.settings, on),
            Edit::SetFitOptions(options) => self.settings.fit_options = options,
            Edit::SetStarts(starts) => self.settings.starts = starts,
            Edit::SetSeed(seed) => self.settings.seed = seed,
            Edit::SetViewOptions(options) => self.settings.view_options = options,
            Edit::SetPictureOptions(options) => self.settings.panes.picture = options,
            Edit::SetResultsOptions(options) => self.settings.panes.results = options,
            Edit::SetLandscapeAxes(axes) => self.settings.panes.landscape = axes,
            Edit::SetPosteriorOptions(options) => self.settings.panes.posterior = options,
            Edit::SetEvidence { number, found } => self.set_evidence(number, found),
            Edit::SetPosterior(drawn) => self.set_posterior(&drawn),
            Edit::SetPlan(planned) => {
                self.settings.design.readings = planned.angles.iter().map(|[theta_i, theta_r, _]| [*theta_i, *theta_r]).collect();
                self.active_results().plan = Some(planned);
            }
            Edit::SetWalk(walk) => self.set_walk(&walk),
            Edit::WalkTo(share) => self.walk_to(share),
            Edit::UseDraw(values) => self.use_draw(&values),
            Edit::SetMetalSelection(selection) => self.settings.metal_selection = selection,
            Edit::SetDesign(design) => self.settings.design = design,
            Edit::Mask { rows, masked } => {
                let active = self.measurements.active_mut();
                active.set_masked(&rows, masked);
                active.is_placeholder = false;
                (self.moved_at, self.moved) = (self.revision, ParameterSet::EMPTY);
            }
            Edit::Open(opened) => self.open(*opened),
            Edit::Close(number) => self.close(number),
            Edit::Activate(number) => self.activate(number),
            Edit::MoveMeasurement { number, by } => self.measurements.move_by(number, by),
            Edit::RenameMeasurement { number, name } => self.rename(number, name),
            Edit::SetMeasurementStyle { number, style } => self.set_style(number, style),
            Edit::SetWeight { number, weight } => {
                if let Some(open) = self.measurements.get_mut(number) {
                    open.weight = weight;
                }
            }
            Edit::SetDrawnSeries { number, drawn } => {
                if let Some(open) = self.measurements.get_mut(number) {
                    open.set_drawn(&drawn);
                }
            }
            Edit::Pin { name, model, parameters } => self.pin(&name, model, parameters),
            Edit::SetPin(place, pin) => self.set_pin(place, *pin),
            Edit::Unpin(place) => self.unpin(place),
            Edit::UsePin(place) => self.use_pin(place),
            Edit::SetProfiled(parameter) => self.active_results().diagnostics.parameter = Some(parameter),
            Edit::SetProfile(profile) => self.active_results().diagnostics.profile = profile,
            Edit::SetReplicates(replicates) => self.active_results().diagnostics.replicates = replicates,
            Edit::SetBootstrap(scatter) => self.active_results().diagnostics.scatter = scatter,
            Edit::SetModelComparison { numbers, models } => self.set_model_comparison(&numbers, models),
            Edit::SetLayout(layout) => self.layout = layout,
            Edit::SetSessionFile(file) => self.session_file = file,
            Edit::Undo => self.restore(History::undo),
            Edit::Redo => self.restore(History::redo),
            Edit::AddFits(fits) => fits.into_iter().for_each(|fit| self.add_fit(fit)),
            Edit::SetFitReport { id, report } => self.set_fit_report(id, *report),
            Edit::SetJointResult { id, result } => self.set_joint_result(id, *result),
            Edit::Refit(refit) => self.take_refit(&refit),
            Edit::TakeValues { parameters, model } => self.take_values(parameters, model),
            Edit::UseFit => self.use_shown_fit(|fit| fit.report.parameters, true),
            Edit::UseValuesBeforeFit => self.use_shown_fit(|fit| fit.before, false),
            Edit::ReturnToFit(index) => self.return_to_fit(index),
            Edit::UseModelFit(index) => self.use_model_fit(index),
        }
    }

    /// Records a step of undo, if anything that undo restores differs from the step before. Called
    /// while no slider is held.
    pub fn record_step(&mut self) {
        if self.recorded_at != self.revision {
            self.recorded_at = self.revision;
            self.undo.record(self.setup());
            let Self { measurements, undo, .. } = self;
            measurements.forget_closed(|number| undo.steps().any(|setup| setup.holds(number)));
        }
    }

    /// Makes the work as it is now the last step of undo, in place of the one before.
    pub(super) fn replace_step(&mut self) {
        self.recorded_at = self.revision;
        self.undo.replace(self.setup());
    }

    /// Takes over the steps of undo of other work, with the measurements that they lead to: the work
    /// as it is now becomes the next one.
    pub fn continue_undo_of(&mut self, other: Self) {
        self.undo = other.undo;
        self.measurements.keep_closed(other.measurements);
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
        self.measurements.set_model(model);
        self.measurements.set_parameters(parameters);
        self.moved_at = 0;
    }

    /// Takes what a live refit found. Sliders may have moved since it began: locked and moved ones
    /// stay, those that it fitted are the fit's.
    fn take_refit(&mut self, Refit(found): &Refit) {
        for (number, estimates) in found {
            let Some(open) = self.measurements.get(*number) else { continue };
            let Surface { mut parameters, locked, .. } = open.surface;
            let is_moved = |parameter| *number == self.active().number || self.measurements.shared().contains(parameter);
            let held = locked.union(self.moved.iter().filter(|&parameter| is_moved(parameter)).collect());
            for estimate in estimates.iter().filter(|estimate| estimate.free && !held.contains(estimate.parameter)) {
                parameters[estimate.parameter] = estimate.value;
            }
            self.measurements.set_parameters_of(*number, parameters);
        }
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
        self.active_results().shown_fit = Some(Arc::new(fit));
    }
}

#[cfg(test)]
mod tests;
