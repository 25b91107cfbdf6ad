//! Jobs that fit, and that examine a fit.

#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::tasks::fit_work::{
    BootstrapOne, CompareModels, CompareTogether, ComparedModels, FindIntervals, FinishedIntervals, FitOneByOne, FitTogether, Fitted,
    ProfileOne, RefitSliders, Search,
};
use crate::app::tasks::inquiry_work::FollowWeakest;
use crate::app::tasks::portable::start;
use crate::app::work::edit::Refit;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::weakest_walk::WeakestWalk;
use pbrdf::fit::{Bootstrap, JointError, JointProblem, Problem, ProblemError, Profile, Starts, TracePoint};
use pbrdf::model::{Parameter, Preset};
use std::sync::Arc;

/// Slots of the jobs around fits.
pub struct FitJobs {
    spawner: Spawner,
    /// The history numbers the fit.
    pub fit: Slot<Vec<FitEntry>, TracePoint>,
    pub intervals: Slot<FinishedIntervals>,
    /// Fits from the sliders while they move.
    pub refit: Slot<Refit, TracePoint>,
    /// The number of the measurement that refits and scans are about.
    pub active: u64,
    /// The revision at which the user had moved the sliders that the last refit began at.
    pub refitted_at: u64,
    /// Fits several models; the progress is the name of the model.
    pub compare: Slot<ComparedModels, &'static str>,
    pub profile: Slot<Profile>,
    pub bootstrap: Slot<Bootstrap>,
    /// The way from a fit along the direction that the data determine least.
    pub walk: Slot<Arc<WeakestWalk>>,
    /// When sliders began to move along such a way, in seconds of the window.
    pub walking_since: Option<f64>,
}

impl FitJobs {
    pub fn new(spawner: Spawner) -> Self {
        Self {
            spawner,
            fit: Slot::default(),
            intervals: Slot::default(),
            refit: Slot::default(),
            active: 0,
            refitted_at: 0,
            compare: Slot::default(),
            profile: Slot::default(),
            bootstrap: Slot::default(),
            walk: Slot::default(),
            walking_since: None,
        }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        let Self { spawner: _, active: _, refitted_at: _, walking_since: _, fit, intervals, refit, compare, profile, bootstrap, walk } =
            self;
        vec![fit, intervals, refit, compare, profile, bootstrap, walk]
    }

    /// Fits a document from so many starts.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn fit(&mut self, problem: Problem, document: &OpenMeasurement, starts: Starts, seed: u64) -> Result<(), String> {
        let about = vec![(problem, document.clone())];
        start(&self.spawner, &mut self.fit, "fit", FitOneByOne { about, search: Search { starts, seed }, intervals: false })
    }

    /// Fits documents together from so many starts.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn fit_jointly(&mut self, problem: JointProblem, list: &MeasurementList, starts: Starts, seed: u64) -> Result<(), String> {
        let (about, shared) = (list.measured().cloned().collect(), list.shared());
        start(&self.spawner, &mut self.fit, "joint fit", FitTogether { problem, about, shared, search: Search { starts, seed } })
    }

    /// Fits documents one after the other, intervals included; cancelled, those that are done are the result.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn fit_each(&mut self, about: Vec<(Problem, OpenMeasurement)>, starts: Starts, seed: u64) -> Result<(), String> {
        start(&self.spawner, &mut self.fit, "fit each", FitOneByOne { about, search: Search { starts, seed }, intervals: true })
    }

    /// Finds the intervals of a finished fit, in place of those that are being found.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn intervals(&mut self, fit: Fitted) -> Result<(), String> {
        start(&self.spawner, &mut self.intervals, "intervals", FindIntervals(fit))
    }

    /// Fits from the sliders alone.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn refit(&mut self, from_sliders: RefitSliders) -> Result<(), String> {
        start(&self.spawner, &mut self.refit, "refit", from_sliders)
    }

    /// Fits several models to a measurement, one after the other, each also from the best fits of its special cases; a model without a
    /// problem keeps the reason.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn compare(
        &mut self,
        document: &OpenMeasurement,
        problems: Vec<(&'static Preset, Result<Problem, ProblemError>)>,
        starts: Starts,
        seed: u64,
    ) -> Result<(), String> {
        let about = document.clone();
        start(&self.spawner, &mut self.compare, "compare models", CompareModels { about, problems, search: Search { starts, seed } })
    }

    /// The same of several measurements together.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn compare_jointly(
        &mut self,
        list: &MeasurementList,
        problems: Vec<(&'static Preset, Result<JointProblem, JointError>)>,
        starts: Starts,
        seed: u64,
    ) -> Result<(), String> {
        let (about, shared) = (list.measured().cloned().collect(), list.shared());
        let job = CompareTogether { about, shared, problems, search: Search { starts, seed } };
        start(&self.spawner, &mut self.compare, "compare models together", job)
    }

    /// Profiles a parameter of a finished fit, in place of the running scan.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn profile(&mut self, fit: Fitted, parameter: Parameter) -> Result<(), String> {
        self.abandon_scan();
        start(&self.spawner, &mut self.profile, "profile", ProfileOne { fit, parameter })
    }

    /// Fits resampled data of a finished fit, in place of the running scan.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn bootstrap(&mut self, fit: Fitted, replicates: usize, seed: u64) -> Result<(), String> {
        self.abandon_scan();
        start(&self.spawner, &mut self.bootstrap, "bootstrap", BootstrapOne { fit, replicates, seed })
    }

    /// Follows the direction that the data of a finished fit determine least.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn walk(&mut self, job: FollowWeakest) -> Result<(), String> {
        start(&self.spawner, &mut self.walk, "geodesic", job)
    }

    /// Whether a profile or a bootstrap is being made.
    pub fn is_scanning(&self) -> bool {
        self.profile.is_running() || self.bootstrap.is_running()
    }

    /// Asks the profile or the bootstrap to stop; it shows what it has.
    pub fn cancel_scan(&self) {
        self.profile.cancel();
        self.bootstrap.cancel();
    }

    /// Stops the scan of a fit that is no longer shown.
    pub fn abandon_scan(&mut self) {
        self.profile.abandon();
        self.bootstrap.abandon();
    }

    /// Stops all work that is about other work than what is shown next.
    pub fn abandon(&mut self) {
        self.fit.abandon();
        self.intervals.abandon();
        self.refit.abandon();
        self.compare.abandon();
        self.walk.abandon();
        self.walking_since = None;
        self.abandon_scan();
    }
}
