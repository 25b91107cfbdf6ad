//! What the jobs around fits do, wherever they run: on a thread, or in the worker of a page.

use crate::app::platform::Instant;
use crate::app::work::edit::Refit;
use crate::app::work::fit_history::{FitEntry, JointEntry, JointPart};
use crate::app::work::model_fit::{ComparedModel, NotFitted};
use crate::app::work::open_measurement::OpenMeasurement;
use pbrdf::fit::{
    Bootstrap, BootstrapEstimate, FitResult, Intervals, JointError, JointProblem, JointResult, JointUnknown, Observer, Problem,
    ProblemError, Profile, SpecialCases, Starts, TracePoint, bootstrap, bootstrap_jointly, fit, fit_jointly, fit_ladder, profile,
    profile_jointly, with_intervals, with_intervals_jointly,
};
use pbrdf::model::{Parameter, ParameterSet, Preset};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What a job asks and tells while it works.
pub trait Watch<P>: Sync {
    /// Whether it is to stop.
    fn is_cancelled(&self) -> bool;

    /// How far it is.
    fn report(&self, progress: P);
}

/// A job that shares nothing with the window while it runs.
pub trait Work: Send + Sized + 'static {
    type Output: Send + 'static;
    type Progress: Send + 'static;

    /// Does the work.
    fn run(self, watch: &impl Watch<Self::Progress>) -> Self::Output;
}

/// How a search is made.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Search {
    pub starts: Starts,
    pub seed: u64,
}

/// Fits measurements one after the other; cancelled, those that are done are the result.
pub struct FitOneByOne {
    pub about: Vec<(Problem, OpenMeasurement)>,
    pub search: Search,
    /// Whether intervals are found as well.
    pub intervals: bool,
}

impl Work for FitOneByOne {
    type Output = Vec<FitEntry>;
    type Progress = TracePoint;

    fn run(self, watch: &impl Watch<TracePoint>) -> Vec<FitEntry> {
        let Self { about, search, intervals } = self;
        let mut fits = Vec::new();
        for (problem, about) in about {
            let report = watched(watch, |observer| {
                let linear = fit(&problem, search.starts, search.seed, observer);
                let whole = if intervals { whole_intervals(&problem, linear.clone(), observer) } else { None };
                whole.unwrap_or(linear)
            });
            fits.push(FitEntry::new(about, Arc::new(problem), report));
            if watch.is_cancelled() {
                break;
            }
        }
        fits
    }
}

/// Fits measurements together.
pub struct FitTogether {
    pub problem: JointProblem,
    pub about: Vec<OpenMeasurement>,
    pub shared: ParameterSet,
    pub search: Search,
}

impl Work for FitTogether {
    type Output = Vec<FitEntry>;
    type Progress = TracePoint;

    fn run(self, watch: &impl Watch<TracePoint>) -> Vec<FitEntry> {
        let Self { problem, about, shared, search } = self;
        let result = watched(watch, |observer| fit_jointly(&problem, search.starts, search.seed, Intervals::Linear, observer));
        FitEntry::of_joint(about, JointEntry { result, problem: Arc::new(problem), shared })
    }
}

/// Fits from the sliders alone while they move.
pub enum RefitSliders {
    One(Box<FitOneByOne>),
    Joint(Box<FitTogether>),
}

impl RefitSliders {
    const SEARCH: Search = Search { starts: Starts::One, seed: 0 };

    /// Of one measurement.
    pub fn one(problem: Problem, about: OpenMeasurement) -> Self {
        Self::One(Box::new(FitOneByOne { about: vec![(problem, about)], search: Self::SEARCH, intervals: false }))
    }

    /// Of several together.
    pub fn joint(problem: JointProblem, about: Vec<OpenMeasurement>, shared: ParameterSet) -> Self {
        Self::Joint(Box::new(FitTogether { problem, about, shared, search: Self::SEARCH }))
    }

    /// What these fits say of the sliders.
    pub fn found(fits: Vec<FitEntry>) -> Refit {
        Refit(fits.into_iter().map(|fit| (fit.number, fit.report.estimates)).collect())
    }
}

impl Work for RefitSliders {
    type Output = Refit;
    type Progress = TracePoint;

    fn run(self, watch: &impl Watch<TracePoint>) -> Refit {
        Self::found(match self {
            Self::One(alone) => alone.run(watch),
            Self::Joint(together) => together.run(watch),
        })
    }
}

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

/// A finished fit.
pub struct Fitted {
    pub fit: FitEntry,
    /// All entries of a joint fit in the order of its measurements.
    pub parts: Vec<FitEntry>,
}

/// Finds the intervals of a finished fit.
pub struct FindIntervals(pub Fitted);

impl Work for FindIntervals {
    type Output = FinishedIntervals;
    type Progress = ();

    fn run(self, watch: &impl Watch<()>) -> FinishedIntervals {
        let FitEntry { id, problem, report, joint, .. } = self.0.fit;
        let begun = Instant::now();
        let cancelled = || watch.is_cancelled();
        let observer = Observer { clock: &|| milliseconds_since(begun), ..observer(&cancelled) };
        let result = match joint {
            None => whole_intervals(&problem, report, observer).map(|report| WithIntervals::One(Box::new(report))),
            Some(JointPart { of, .. }) => {
                let result = whole_joint_intervals(&of.problem, &of.result, observer);
                result.map(|result| WithIntervals::Joint(Box::new(result)))
            }
        };
        FinishedIntervals { id, result }
    }
}

/// The models that were fitted to the measurements of those numbers.
pub struct ComparedModels {
    pub numbers: Vec<u64>,
    pub models: Vec<ComparedModel>,
}

/// Fits several models, one after the other, each also from the best fits of its special cases; a model without a problem keeps
/// the reason.
pub struct CompareModels {
    pub about: OpenMeasurement,
    pub problems: Vec<(&'static Preset, Result<Problem, ProblemError>)>,
    pub search: Search,
}

impl Work for CompareModels {
    type Output = ComparedModels;
    /// The key of the model.
    type Progress = &'static str;

    fn run(self, watch: &impl Watch<&'static str>) -> ComparedModels {
        let Self { about, problems, search } = self;
        let fits = ladder(&problems, watch, |problem, observer| {
            let linear = fit(problem, search.starts, search.seed, observer);
            whole_intervals(problem, linear.clone(), observer).unwrap_or(linear)
        });
        let entry = |problem: Problem, report| vec![FitEntry::new(about.clone(), Arc::new(problem), report)];
        ComparedModels { numbers: vec![about.number], models: compared(problems, fits, NotFitted::One, entry) }
    }
}

/// The same of several measurements together.
pub struct CompareTogether {
    pub about: Vec<OpenMeasurement>,
    pub shared: ParameterSet,
    pub problems: Vec<(&'static Preset, Result<JointProblem, JointError>)>,
    pub search: Search,
}

impl Work for CompareTogether {
    type Output = ComparedModels;
    /// The key of the model.
    type Progress = &'static str;

    fn run(self, watch: &impl Watch<&'static str>) -> ComparedModels {
        let Self { about, shared, problems, search } = self;
        let fits = ladder(&problems, watch, |problem, observer| {
            let linear = fit_jointly(problem, search.starts, search.seed, Intervals::Linear, observer);
            whole_joint_intervals(problem, &linear, observer).unwrap_or(linear)
        });
        let entries =
            |problem: JointProblem, result| FitEntry::of_joint(about.clone(), JointEntry { result, problem: Arc::new(problem), shared });
        let numbers = about.iter().map(|open| open.number).collect();
        ComparedModels { numbers, models: compared(problems, fits, NotFitted::Together, entries) }
    }
}

/// The fits of a ladder of models, until the job is cancelled; it reports the key of the model that is being fitted.
fn ladder<P: SpecialCases, E>(
    problems: &[(&'static Preset, Result<P, E>)],
    watch: &impl Watch<&'static str>,
    fit: impl Fn(&P, Observer<'_>) -> P::Fitted,
) -> Vec<Option<P::Fitted>> {
    let posed: Vec<Option<&P>> = problems.iter().map(|(_, problem)| problem.as_ref().ok()).collect();
    fit_ladder(&posed, |place, problem| {
        if watch.is_cancelled() {
            return None;
        }
        watch.report(problems[place].0.key);
        let begun = Instant::now();
        let observer = Observer { clock: &|| milliseconds_since(begun), cancelled: &|| watch.is_cancelled(), ..Observer::NONE };
        Some(fit(problem, observer))
    })
}

/// The models that were fitted or cannot be; those that were not reached are left out.
pub fn compared<P, R, E>(
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

/// Profiles a parameter of a finished fit.
pub struct ProfileOne {
    pub fit: Fitted,
    pub parameter: Parameter,
}

impl Work for ProfileOne {
    type Output = Profile;
    type Progress = ();

    fn run(self, watch: &impl Watch<()>) -> Profile {
        let Self { fit: Fitted { fit: FitEntry { problem, report, joint, .. }, .. }, parameter } = self;
        let cancelled = || watch.is_cancelled();
        match joint {
            None => profile(&problem, &report, parameter, observer(&cancelled)),
            Some(part) => profile_in_joint(&part, parameter, observer(&cancelled)),
        }
    }
}

/// Fits resampled data of a finished fit.
pub struct BootstrapOne {
    pub fit: Fitted,
    pub replicates: usize,
    pub seed: u64,
}

impl Work for BootstrapOne {
    type Output = Bootstrap;
    type Progress = ();

    fn run(self, watch: &impl Watch<()>) -> Bootstrap {
        let Self { fit: Fitted { fit: FitEntry { problem, report, joint, .. }, .. }, replicates, seed } = self;
        let cancelled = || watch.is_cancelled();
        match joint {
            None => bootstrap(&problem, &report, replicates, seed, observer(&cancelled)),
            Some(part) => bootstrap_in_joint(&part, replicates, seed, observer(&cancelled)),
        }
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
fn watched<T>(watch: &impl Watch<TracePoint>, fit: impl FnOnce(Observer<'_>) -> T) -> T {
    let begun = Instant::now();
    fit(Observer { clock: &|| milliseconds_since(begun), cancelled: &|| watch.is_cancelled(), progress: &|point| watch.report(point) })
}

/// An observer that only cancels.
pub fn observer<'a>(cancelled: &'a (dyn Fn() -> bool + Sync)) -> Observer<'a> {
    Observer { cancelled, ..Observer::NONE }
}

fn milliseconds_since(begun: Instant) -> f64 {
    begun.elapsed().as_secs_f64() * 1e3
}
