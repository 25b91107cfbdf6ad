//! The user's work as one value: what is open, what is set, and what was fitted.

use crate::app::work::diagnostics::Diagnostics;
use crate::app::work::document::{Document, Mask};
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::{FitEntry, FitHistory};
use crate::app::work::history::History;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::settings::Settings;
use pbrdf::fit::FitResult;
use pbrdf::measurement::Measurement;
use pbrdf::model::{Model, Parameters};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

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
    revision: u64,
}

/// What a step of undo restores.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    pub settings: Settings,
    /// The mask of the measurement of that number.
    pub mask: Mask,
    pub number: u64,
}

fn next_revision() -> u64 {
    static LAST: AtomicU64 = AtomicU64::new(0);
    LAST.fetch_add(1, Ordering::Relaxed) + 1
}

impl Workspace {
    /// Work with these settings and no measurement.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            document: Document::new(String::new(), Measurement::default()),
            shown_fit: None,
            fit_history: FitHistory::default(),
            model_comparison: Vec::new(),
            diagnostics: Diagnostics::default(),
            undo: History::default(),
            last_refit_at: None,
            session_file: None,
            revision: next_revision(),
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

    /// Work that was kept: these settings, and fits from the oldest to the newest, each with whether it is shown.
    pub fn restored(settings: Settings, document: Document, fits: impl IntoIterator<Item = (FitEntry, bool)>) -> Self {
        let mut work = Self { last_refit_at: Some(settings.parameters), document, ..Self::new(settings) };
        for (fit, is_shown) in fits {
            let fit = work.fit_history.push(fit);
            if is_shown {
                work.shown_fit = Some(fit);
            }
        }
        work.record_step();
        work
    }

    /// Another number after every change, and none twice in a run of the program: work of the same revision is the same work.
    #[cfg(test)]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Notes that something changes.
    pub(super) fn touch(&mut self) {
        self.revision = next_revision();
    }

    /// Makes one change.
    pub fn apply(&mut self, edit: Edit) {
        self.touch();
        match edit {
            Edit::SetParameter(parameter, value) => self.settings.parameters[parameter] = value,
            Edit::SetParameters(parameters) => self.settings.parameters = parameters,
            Edit::SetModel(model) => self.settings.model = model,
            Edit::SetLocked(locked) => self.settings.locked = locked,
            Edit::SetBounds(parameter, None) => self.settings.reset_bounds(parameter),
            Edit::SetBounds(parameter, Some((low, high))) => drop(self.settings.set_bounds(parameter, low, high)),
            Edit::SetDirection { theta_i, dphi } => (self.settings.theta_i, self.settings.dphi) = (theta_i, dphi),
            Edit::SetSwitch(switch, on) => switch.set(&mut self.settings, on),
            Edit::SetFitOptions(options) => self.settings.choices = options,
            Edit::SetStarts(starts) => self.settings.starts = starts,
            Edit::SetSeed(seed) => self.settings.seed = seed,
            Edit::SetViewOptions(options) => self.settings.shown = options,
            Edit::SetLandscapeAxes(axes) => self.settings.landscape = axes,
            Edit::SetMetalSelection(selection) => self.settings.tabulated = selection,
            Edit::SetPlan(plan) => self.settings.plan = plan,
            Edit::Mask { rows, masked } => {
                self.document.set_masked(&rows, masked);
                self.last_refit_at = None;
            }
            Edit::Open(document) => self.open(*document),
            Edit::SetProfile(profile) => self.diagnostics.profile = profile,
            Edit::SetBootstrap(scatter) => self.diagnostics.scatter = scatter,
            Edit::SetModelComparison(fits) => self.model_comparison = fits,
            Edit::Undo => self.restore(History::undo),
            Edit::Redo => self.restore(History::redo),
            Edit::AddFit(fit) => {
                self.take_values(fit.report.parameters, self.settings.model);
                let fit = self.fit_history.push(*fit);
                self.show_fit(Some(fit));
            }
            Edit::Refit(report) => self.take_refit(&report),
            Edit::TakeValues { parameters, model } => self.take_values(parameters, model),
            Edit::UseFit => {
                if let Some(FitResult { parameters, model, .. }) = self.shown_fit.as_ref().map(|fit| &fit.report) {
                    (self.settings.parameters, self.settings.model) = (*parameters, *model);
                }
            }
            Edit::UseValuesBeforeFit => {
                self.settings.parameters = self.shown_fit.as_ref().map_or(self.settings.parameters, |fit| fit.before);
            }
            Edit::ReturnToFit(index) => {
                if let Some(fit) = self.fit_history.get(index) {
                    self.take_values(fit.report.parameters, fit.report.model);
                    self.show_fit(Some(fit).filter(|fit| fit.number == self.document.number));
                }
            }
            Edit::UseModelFit(index) => {
                if let Some(ModelFit { result: Ok(report), .. }) = self.model_comparison.get(index) {
                    self.take_values(report.parameters, report.model);
                }
            }
        }
    }

    /// Records a step of undo, if anything that undo restores differs from the step before. Called while no slider is held.
    pub fn record_step(&mut self) {
        self.undo.rest(self.setup());
    }

    /// What a step of undo restores, as it is now.
    pub fn setup(&self) -> Setup {
        Setup { settings: self.settings.clone(), mask: self.document.mask().clone(), number: self.document.number }
    }

    fn restore(&mut self, step: fn(&mut History<Setup>) -> Option<Setup>) {
        let Some(Setup { settings, mask, number }) = step(&mut self.undo) else { return };
        self.settings = settings;
        self.last_refit_at = Some(self.settings.parameters);
        // The rows of another measurement are other rows.
        if number == self.document.number {
            self.document.restore_mask(&mask);
        }
        self.undo.replace(self.setup());
    }

    /// Puts a measurement in the place of the active one, without its fits; no step of undo of its own.
    pub(super) fn open(&mut self, document: Document) {
        self.document = document;
        self.settings.suit(&self.document);
        self.show_fit(None);
        self.model_comparison.clear();
        self.undo.replace(self.setup());
    }

    /// Values and model from a fit: the live refit does not begin at them.
    fn take_values(&mut self, parameters: Parameters, model: Model) {
        (self.settings.parameters, self.settings.model) = (parameters, model);
        self.last_refit_at = Some(parameters);
    }

    /// Takes what a live refit found. Sliders may have moved since it began: locked ones stay, free ones are the fit's.
    fn take_refit(&mut self, report: &FitResult) {
        let free = report.estimates.iter().map(|estimate| estimate.parameter);
        for parameter in free.filter(|parameter| !self.settings.locked.contains(*parameter)) {
            self.settings.parameters[parameter] = report.parameters[parameter];
        }
        if self.settings.parameters == report.parameters {
            self.last_refit_at = Some(report.parameters);
        }
    }

    /// Shows a fit; profile and bootstrap of another one are dropped.
    pub(super) fn show_fit(&mut self, fit: Option<Arc<FitEntry>>) {
        self.shown_fit = fit;
        self.diagnostics.forget();
    }
}

#[cfg(test)]
mod tests {
    use super::Workspace;
    use crate::app::work::document::{Document, EXAMPLES};
    use crate::app::work::edit::{Edit, Switch};
    use crate::app::work::settings::Settings;
    use pbrdf::measurement::Measurement;
    use pbrdf::model::Parameter;

    /// Work on an example that holds as many rows as a user would mask by hand.
    fn opened() -> Workspace {
        let mut work = Workspace::new(Settings::default());
        let measurement = Measurement::read(EXAMPLES[0].text.as_bytes()).expect("an example is a measurement");
        work.apply(Edit::Open(Box::new(Document::new(EXAMPLES[0].name.to_owned(), measurement))));
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
        for edit in [
            Edit::SetParameter(Parameter::N, 2.5),
            Edit::Mask { rows: vec![0, 3], masked: true },
            Edit::SetSwitch(Switch::LogBrdf, true),
            Edit::SetBounds(Parameter::K, Some((0.5, 4.0))),
        ] {
            work.apply(edit);
            revisions.push(work.revision());
            work.record_step();
        }
        assert!(revisions.is_sorted_by(|one, next| one < next), "{revisions:?}");
        let after = work.setup();
        assert_eq!((after.mask.to_vec(), after.settings.parameters.n, after.settings.log_brdf), (vec![0, 3], 2.5, true));
        for _ in 0..4 {
            assert!(work.undo.can_undo());
            work.apply(Edit::Undo);
        }
        assert_eq!(work.setup(), before);
        assert!(!work.undo.can_undo());
        for _ in 0..4 {
            work.apply(Edit::Redo);
        }
        assert_eq!(work.setup(), after);
    }

    #[test]
    fn opening_a_measurement_is_no_step_and_undo_leaves_its_rows_alone() {
        let mut work = opened();
        work.record_step();
        work.apply(Edit::Mask { rows: vec![1], masked: true });
        work.record_step();
        let document = work.document.clone();
        work.apply(Edit::Open(Box::new(Document::new("again".to_owned(), (*document.measurement).clone()))));
        let steps = work.undo.can_redo();
        work.apply(Edit::Undo);
        assert_eq!((work.document.name.as_str(), work.document.mask().to_vec(), steps), ("again", vec![1], false));
    }

    #[test]
    fn bounds_that_mean_nothing_change_nothing() {
        let mut work = opened();
        work.apply(Edit::SetBounds(Parameter::N, Some((3.0, 1.0))));
        assert!(!work.settings.has_own_bounds(Parameter::N));
    }
}
