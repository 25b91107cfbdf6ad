//! Jobs that fit, and that examine a fit.

use crate::app::jobs::job::JobContext;
#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::platform::Instant;
use crate::app::tasks::start_error::start_error;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::fit::{
    Bootstrap, FitResult, Observer, Problem, ProblemError, Profile, Starts, TracePoint, bootstrap, fit, profile, special_cases_first,
    with_intervals, with_special_cases,
};
use pbrdf::model::{Model, Parameter, Preset};
use std::sync::Arc;

/// A fit with the intervals of its parameters.
pub struct FinishedIntervals {
    /// The id of the fit in the history.
    pub id: usize,
    /// None where the job was stopped before their ends.
    pub report: Option<Box<FitResult>>,
}

/// Slots of the jobs around fits.
pub struct FitJobs {
    spawner: Spawner,
    /// The history numbers the fit.
    pub fit: Slot<Box<FitEntry>, TracePoint>,
    pub intervals: Slot<FinishedIntervals>,
    /// Fits from the sliders while they move.
    pub refit: Slot<Box<FitResult>>,
    /// The number of the measurement that refits and scans are about.
    pub active: u64,
    /// The revision at which the user had moved the sliders that the last refit began at.
    pub refitted_at: u64,
    /// Fits several models to the measurement of a number; the progress is the name of the model.
    pub compare: Slot<(u64, Vec<ModelFit>), &'static str>,
    pub profile: Slot<Profile>,
    pub bootstrap: Slot<Bootstrap>,
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
        }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        let Self { spawner: _, active: _, refitted_at: _, fit, intervals, refit, compare, profile, bootstrap } = self;
        vec![fit, intervals, refit, compare, profile, bootstrap]
    }

    /// Fits a document from so many starts.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn fit(&mut self, problem: Problem, document: &OpenMeasurement, starts: Starts, seed: u64) -> Result<(), String> {
        let OpenMeasurement { name, sha256, measurement, number, generation, surface, .. } = document.clone();
        let mask = document.mask().clone();
        let job = move |context: &JobContext<TracePoint>| {
            let begun = Instant::now();
            let observer = Observer {
                clock: &|| milliseconds_since(begun),
                cancelled: &|| context.is_cancelled(),
                progress: &|point| context.report(point),
            };
            let report = fit(&problem, starts, seed, observer);
            let (document, data, problem, before) = (name, measurement, Arc::new(problem), surface.parameters);
            Box::new(FitEntry { id: 0, report, problem, before, document, sha256, data, number, generation, mask })
        };
        self.fit.start(&self.spawner, "fit", job).map_err(start_error)
    }

    /// Finds the intervals of a finished fit, in place of those that are being found.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn intervals(&mut self, fit: &FitEntry) -> Result<(), String> {
        let (id, problem, report) = (fit.id, fit.problem.clone(), fit.report.clone());
        let job = move |context: &JobContext| {
            let begun = Instant::now();
            let cancelled = || context.is_cancelled();
            let observer = Observer { clock: &|| milliseconds_since(begun), ..observer(&cancelled) };
            FinishedIntervals { id, report: whole_intervals(&problem, report, observer).map(Box::new) }
        };
        self.intervals.start(&self.spawner, "intervals", job).map_err(start_error)
    }

    /// Fits from the sliders alone.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn refit(&mut self, problem: Problem) -> Result<(), String> {
        let job = move |context: &JobContext| Box::new(fit(&problem, Starts::One, 0, observer(&|| context.is_cancelled())));
        self.refit.start(&self.spawner, "refit", job).map_err(start_error)
    }

    /// Fits several models, one after the other, each also from the best fits of its special cases; a model without a problem keeps
    /// the reason.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn compare(
        &mut self,
        number: u64,
        problems: Vec<(&'static Preset, Result<Problem, ProblemError>)>,
        starts: Starts,
        seed: u64,
    ) -> Result<(), String> {
        let job = move |context: &JobContext<&'static str>| {
            let models: Vec<Model> = problems.iter().map(|(preset, _)| preset.model).collect();
            let mut fits: Vec<(usize, ModelFit)> = Vec::new();
            for index in special_cases_first(&models) {
                let (preset, problem) = &problems[index];
                if context.is_cancelled() {
                    break;
                }
                context.report(preset.name);
                let begun = Instant::now();
                let observer = Observer { clock: &|| milliseconds_since(begun), cancelled: &|| context.is_cancelled(), ..Observer::NONE };
                let fitted = |problem: &Problem| {
                    let before = fits.iter().filter_map(|(_, fit)| fit.result.as_deref().ok());
                    let problem = with_special_cases(problem, before);
                    let linear = fit(&problem, starts, seed, observer);
                    Box::new(whole_intervals(&problem, linear.clone(), observer).unwrap_or(linear))
                };
                let result = problem.as_ref().map(fitted).map_err(Clone::clone);
                fits.push((index, ModelFit { preset, result }));
            }
            fits.sort_by_key(|&(index, _)| index);
            (number, fits.into_iter().map(|(_, fit)| fit).collect())
        };
        self.compare.start(&self.spawner, "compare models", job).map_err(start_error)
    }

    /// Profiles a parameter of a finished fit, in place of the running scan.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn profile(&mut self, problem: Problem, report: FitResult, parameter: Parameter) -> Result<(), String> {
        self.abandon_scan();
        let job = move |context: &JobContext| profile(&problem, &report, parameter, observer(&|| context.is_cancelled()));
        self.profile.start(&self.spawner, "profile", job).map_err(start_error)
    }

    /// Fits resampled data of a finished fit, in place of the running scan.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn bootstrap(&mut self, problem: Problem, report: FitResult, replicates: usize, seed: u64) -> Result<(), String> {
        self.abandon_scan();
        let job = move |context: &JobContext| bootstrap(&problem, &report, replicates, seed, observer(&|| context.is_cancelled()));
        self.bootstrap.start(&self.spawner, "bootstrap", job).map_err(start_error)
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
        self.abandon_scan();
    }
}

/// The result with its intervals; none where these were cancelled on the way.
fn whole_intervals(problem: &Problem, result: FitResult, observer: Observer<'_>) -> Option<FitResult> {
    let result = with_intervals(problem, result, observer);
    let is_part = result.course.intervals_complete == Some(false) && (observer.cancelled)();
    (!is_part).then_some(result)
}

/// An observer that only cancels.
fn observer<'a>(cancelled: &'a (dyn Fn() -> bool + Sync)) -> Observer<'a> {
    Observer { cancelled, ..Observer::NONE }
}

fn milliseconds_since(begun: Instant) -> f64 {
    begun.elapsed().as_secs_f64() * 1e3
}
