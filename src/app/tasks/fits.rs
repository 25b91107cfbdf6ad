//! Jobs that fit, and that examine a fit.

use crate::app::jobs::job::JobContext;
#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::platform::Instant;
use crate::app::tasks::start_error::start_error;
use crate::app::work::edit::Refit;
use crate::app::work::fit_history::{FitEntry, JointEntry, JointPart};
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::model_fit::{ComparedModel, NotFitted};
use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::fit::{
    Bootstrap, BootstrapEstimate, FitResult, Intervals, JointError, JointProblem, JointResult, JointUnknown, Observer, Problem,
    ProblemError, Profile, SpecialCases, Starts, TracePoint, bootstrap, bootstrap_jointly, fit, fit_jointly, fit_ladder, profile,
    profile_jointly, with_intervals, with_intervals_jointly,
};
use pbrdf::model::{Parameter, Preset};
use std::sync::Arc;

/// A fit with the intervals of its parameters.
pub struct FinishedIntervals {
    /// The id of the fit in the history.
    pub id: usize,
    /// None where the job was stopped before their ends.
    pub result: Option<WithIntervals>,
}

/// A result, of one measurement or of several.
pub enum WithIntervals {
    One(Box<FitResult>),
    Joint(Box<JointResult>),
}

/// The models that were fitted to the measurements of those numbers.
pub struct ComparedModels {
    pub numbers: Vec<u64>,
    pub models: Vec<ComparedModel>,
}

/// What is fitted while sliders move: a measurement by its number, or several.
pub enum RefitProblem {
    One(u64, Box<Problem>),
    Joint(Vec<u64>, Box<JointProblem>),
}

/// Slots of the jobs around fits.
pub struct FitJobs {
    spawner: Spawner,
    /// The history numbers the fit.
    pub fit: Slot<Vec<FitEntry>, TracePoint>,
    pub intervals: Slot<FinishedIntervals>,
    /// Fits from the sliders while they move.
    pub refit: Slot<Refit>,
    /// The number of the measurement that refits and scans are about.
    pub active: u64,
    /// The revision at which the user had moved the sliders that the last refit began at.
    pub refitted_at: u64,
    /// Fits several models; the progress is the name of the model.
    pub compare: Slot<ComparedModels, &'static str>,
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
        let about = document.clone();
        let job = move |context: &JobContext<TracePoint>| {
            let begun = Instant::now();
            let report = watched(context, begun, |observer| fit(&problem, starts, seed, observer));
            vec![FitEntry::new(about, Arc::new(problem), report)]
        };
        self.fit.start(&self.spawner, "fit", job).map_err(start_error)
    }

    /// Fits documents together from so many starts.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn fit_jointly(&mut self, problem: JointProblem, list: &MeasurementList, starts: Starts, seed: u64) -> Result<(), String> {
        let about: Vec<OpenMeasurement> = list.measured().cloned().collect();
        let shared = list.shared();
        let job = move |context: &JobContext<TracePoint>| {
            let begun = Instant::now();
            let result = watched(context, begun, |observer| fit_jointly(&problem, starts, seed, Intervals::Linear, observer));
            FitEntry::of_joint(about, JointEntry { result, problem: Arc::new(problem), shared })
        };
        self.fit.start(&self.spawner, "joint fit", job).map_err(start_error)
    }

    /// Fits documents one after the other, intervals included; cancelled, those that are done are the result.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn fit_each(&mut self, problems: Vec<(Problem, OpenMeasurement)>, starts: Starts, seed: u64) -> Result<(), String> {
        let job = move |context: &JobContext<TracePoint>| {
            let mut fits = Vec::new();
            for (problem, about) in problems {
                let begun = Instant::now();
                let report = watched(context, begun, |observer| {
                    let linear = fit(&problem, starts, seed, observer);
                    whole_intervals(&problem, linear.clone(), observer).unwrap_or(linear)
                });
                fits.push(FitEntry::new(about, Arc::new(problem), report));
                if context.is_cancelled() {
                    break;
                }
            }
            fits
        };
        self.fit.start(&self.spawner, "fit each", job).map_err(start_error)
    }

    /// Finds the intervals of a finished fit, in place of those that are being found.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn intervals(&mut self, fit: &FitEntry) -> Result<(), String> {
        let (id, problem, report, joint) = (fit.id, fit.problem.clone(), fit.report.clone(), fit.joint.clone());
        let job = move |context: &JobContext| {
            let begun = Instant::now();
            let cancelled = || context.is_cancelled();
            let observer = Observer { clock: &|| milliseconds_since(begun), ..observer(&cancelled) };
            let result = match joint {
                None => whole_intervals(&problem, report, observer).map(|report| WithIntervals::One(Box::new(report))),
                Some(JointPart { of, .. }) => {
                    let result = whole_joint_intervals(&of.problem, &of.result, observer);
                    result.map(|result| WithIntervals::Joint(Box::new(result)))
                }
            };
            FinishedIntervals { id, result }
        };
        self.intervals.start(&self.spawner, "intervals", job).map_err(start_error)
    }

    /// Fits from the sliders alone.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn refit(&mut self, problem: RefitProblem) -> Result<(), String> {
        let job = move |context: &JobContext| {
            let (cancelled, starts) = (|| context.is_cancelled(), Starts::One);
            match problem {
                RefitProblem::One(number, problem) => Refit(vec![(number, fit(&problem, starts, 0, observer(&cancelled)).estimates)]),
                RefitProblem::Joint(numbers, problem) => {
                    let result = fit_jointly(&problem, starts, 0, Intervals::Linear, observer(&cancelled));
                    let of_set = |(set, number)| (number, result.of_set(set).estimates);
                    Refit(numbers.into_iter().enumerate().map(of_set).collect())
                }
            }
        };
        self.refit.start(&self.spawner, "refit", job).map_err(start_error)
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
        let job = move |context: &JobContext<&'static str>| {
            let fits = ladder(&problems, context, |problem, observer| {
                let linear = fit(problem, starts, seed, observer);
                whole_intervals(problem, linear.clone(), observer).unwrap_or(linear)
            });
            let entry = |problem: Problem, report| vec![FitEntry::new(about.clone(), Arc::new(problem), report)];
            ComparedModels { numbers: vec![about.number], models: compared(problems, fits, NotFitted::One, entry) }
        };
        self.compare.start(&self.spawner, "compare models", job).map_err(start_error)
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
        let about: Vec<OpenMeasurement> = list.measured().cloned().collect();
        let shared = list.shared();
        let job = move |context: &JobContext<&'static str>| {
            let fits = ladder(&problems, context, |problem, observer| {
                let linear = fit_jointly(problem, starts, seed, Intervals::Linear, observer);
                whole_joint_intervals(problem, &linear, observer).unwrap_or(linear)
            });
            let entries = |problem: JointProblem, result| {
                FitEntry::of_joint(about.clone(), JointEntry { result, problem: Arc::new(problem), shared })
            };
            let numbers = about.iter().map(|open| open.number).collect();
            ComparedModels { numbers, models: compared(problems, fits, NotFitted::Together, entries) }
        };
        self.compare.start(&self.spawner, "compare models together", job).map_err(start_error)
    }

    /// Profiles a parameter of a finished fit, in place of the running scan.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn profile(&mut self, fit: &FitEntry, parameter: Parameter) -> Result<(), String> {
        self.abandon_scan();
        let (problem, report, joint) = (fit.problem.clone(), fit.report.clone(), fit.joint.clone());
        let job = move |context: &JobContext| {
            let cancelled = || context.is_cancelled();
            match joint {
                None => profile(&problem, &report, parameter, observer(&cancelled)),
                Some(part) => profile_in_joint(&part, parameter, observer(&cancelled)),
            }
        };
        self.profile.start(&self.spawner, "profile", job).map_err(start_error)
    }

    /// Fits resampled data of a finished fit, in place of the running scan.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn bootstrap(&mut self, fit: &FitEntry, replicates: usize, seed: u64) -> Result<(), String> {
        self.abandon_scan();
        let (problem, report, joint) = (fit.problem.clone(), fit.report.clone(), fit.joint.clone());
        let job = move |context: &JobContext| {
            let cancelled = || context.is_cancelled();
            match joint {
                None => bootstrap(&problem, &report, replicates, seed, observer(&cancelled)),
                Some(part) => bootstrap_in_joint(&part, replicates, seed, observer(&cancelled)),
            }
        };
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

/// The same of a joint fit.
fn whole_joint_intervals(problem: &JointProblem, result: &JointResult, observer: Observer<'_>) -> Option<JointResult> {
    let result = with_intervals_jointly(problem, result, observer);
    let is_part = result.course.intervals_complete == Some(false) && (observer.cancelled)();
    (!is_part).then_some(result)
}

/// The fits of a ladder of models, until the job is cancelled; it reports the name of the model that is being fitted.
fn ladder<P: SpecialCases, E>(
    problems: &[(&'static Preset, Result<P, E>)],
    context: &JobContext<&'static str>,
    fit: impl Fn(&P, Observer<'_>) -> P::Fitted,
) -> Vec<Option<P::Fitted>> {
    let posed: Vec<Option<&P>> = problems.iter().map(|(_, problem)| problem.as_ref().ok()).collect();
    fit_ladder(&posed, |place, problem| {
        if context.is_cancelled() {
            return None;
        }
        context.report(problems[place].0.name);
        let begun = Instant::now();
        let observer = Observer { clock: &|| milliseconds_since(begun), cancelled: &|| context.is_cancelled(), ..Observer::NONE };
        Some(fit(problem, observer))
    })
}

/// The models that were fitted or cannot be; those that were not reached are left out.
fn compared<P, R, E>(
    problems: Vec<(&'static Preset, Result<P, E>)>,
    fits: Vec<Option<R>>,
    reason: fn(E) -> NotFitted,
    entries: impl Fn(P, R) -> Vec<FitEntry>,
) -> Vec<ComparedModel> {
    let model = |((preset, problem), fit): ((&'static Preset, Result<P, E>), Option<R>)| match problem {
        Ok(problem) => fit.map(|fit| ComparedModel { preset, result: Ok(entries(problem, fit)) }),
        Err(error) => Some(ComparedModel { preset, result: Err(reason(error)) }),
    };
    problems.into_iter().zip(fits).filter_map(model).collect()
}

/// The profile of a parameter of one measurement of a joint fit, its own one or that of all.
fn profile_in_joint(JointPart { of, set }: &JointPart, parameter: Parameter, observer: Observer<'_>) -> Profile {
    let own = of.problem.own().contains(parameter).then(|| of.problem.set_names()[*set].clone());
    let unknown = JointUnknown { parameter, set: own };
    let Profile { points, interval68, interval95, limits, is_complete, .. } = profile_jointly(&of.problem, &of.result, &unknown, observer);
    Profile { parameter, points, interval68, interval95, limits, is_complete }
}

/// A bootstrap of a joint fit, as one of the parameters of one of its measurements.
fn bootstrap_in_joint(JointPart { of, set }: &JointPart, replicates: usize, seed: u64, observer: Observer<'_>) -> Bootstrap {
    let Bootstrap { asked, replicates, estimates } = bootstrap_jointly(&of.problem, &of.result, replicates, seed, observer);
    let name = &of.problem.set_names()[*set];
    let is_its = |estimate: &BootstrapEstimate<JointUnknown>| estimate.parameter.set.as_ref().is_none_or(|set| set == name);
    let plain = |BootstrapEstimate { parameter, std_error, low, high }: BootstrapEstimate<JointUnknown>| BootstrapEstimate {
        parameter: parameter.parameter,
        std_error,
        low,
        high,
    };
    Bootstrap { asked, replicates, estimates: estimates.into_iter().filter(is_its).map(plain).collect() }
}

/// What a fit gives that can be cancelled and tells how far it is.
fn watched<T>(context: &JobContext<TracePoint>, begun: Instant, fit: impl FnOnce(Observer<'_>) -> T) -> T {
    fit(Observer { clock: &|| milliseconds_since(begun), cancelled: &|| context.is_cancelled(), progress: &|point| context.report(point) })
}

/// An observer that only cancels.
fn observer<'a>(cancelled: &'a (dyn Fn() -> bool + Sync)) -> Observer<'a> {
    Observer { cancelled, ..Observer::NONE }
}

fn milliseconds_since(begun: Instant) -> f64 {
    begun.elapsed().as_secs_f64() * 1e3
}
