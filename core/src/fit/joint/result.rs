//! The result of a joint fit: what the measurements share, and what each has for itself.

use crate::fit::analysis::Analysis;
use crate::fit::estimate::{Estimate, EstimateStatus, Undetermined};
use crate::fit::intervals::band::PredictionBand;
use crate::fit::intervals::bootstrap::{Bootstrap, bootstrap_of};
use crate::fit::intervals::interval::Interval;
use crate::fit::intervals::linear::{Uncertainty, UndeterminedDirection};
use crate::fit::intervals::profile::{Profile, profile_all, profile_of, set_interval};
use crate::fit::joint::problem::JointProblem;
use crate::fit::joint::unknown::JointUnknown;
use crate::fit::multistart::basin::MultistartResult;
use crate::fit::observer::Observer;
use crate::fit::result::{ByKey, Correlations, Course, FitResult, SUMMARY_FIELDS, Statistics, is_exact, serialize_summary};
use crate::fit::stop_reason::StopReason;
use crate::model::{Model, Parameter, Parameters};
use serde::ser::SerializeStruct as _;
use serde::{Serialize, Serializer};
use std::fmt;
use std::sync::Arc;

/// One measurement of a joint fit.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SetResult {
    /// What it is called.
    pub name: Arc<str>,
    /// Number of residuals.
    pub residuals: usize,
    /// All values of its surface.
    pub parameters: Parameters,
    /// The parameters that it has for itself.
    pub own: Vec<Estimate>,
    /// ΔE of Eq. (18) by its own Σ Xm²; none where all measured values are 0.
    pub objective: Option<f64>,
    /// The same at the start.
    pub start_objective: Option<f64>,
    /// Its share in the residual sum of squares.
    pub rss: f64,
    /// Standard errors of its curves at any geometry.
    pub band: PredictionBand,
}

/// The result of a joint fit.
///
/// `Display` lists all estimates and what is undetermined; serialised, it has the keys of the JSON that the command line prints.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct JointResult {
    /// Which terms there are.
    pub model: Model,
    /// The parameters that all measurements share.
    pub shared: Vec<Estimate>,
    /// The measurements, in their order.
    pub sets: Vec<SetResult>,
    /// ΔE of Eq. (18) over all rows, of DoLP if measured, else of BRDF; with both, the sum. None where all measured values are 0.
    pub objective: Option<f64>,
    /// The same at the start.
    pub start_objective: Option<f64>,
    /// Why the fit ended.
    pub stop_reason: StopReason,
    /// How well the model describes the data.
    pub statistics: Statistics,
    /// Correlations of the determined unknowns.
    pub correlations: Correlations<JointUnknown>,
    /// Directions that the data leave undetermined.
    pub undetermined: Vec<UndeterminedDirection<JointUnknown>>,
    /// Linear standard errors and correlations at the minimum.
    pub uncertainty: Uncertainty<JointUnknown>,
    /// How the fit came about.
    pub course: Course<Vec<Parameters>>,
}

impl JointResult {
    /// Of an analysis, with the intervals of the unknowns where they are known.
    pub(crate) fn new(problem: &JointProblem, analysis: Analysis<JointProblem>, intervals: Option<&[[Interval; 2]]>) -> Self {
        let point = problem.parameters_of(&analysis.x);
        let (weights, dof) = (problem.options().weights, analysis.statistics.dof);
        let of = |part: usize, parameter: Parameter| {
            let place = problem.parts()[part].free().iter().position(|&free| free == parameter);
            let Some(unknown) = place.map(|place| problem.places()[part][place]) else {
                return Estimate::fixed(parameter, point[part][parameter]);
            };
            let mut estimate = analysis.estimate(problem, unknown);
            if let Some(intervals) = intervals.and_then(|intervals| intervals.get(unknown)) {
                set_interval(&mut estimate, *intervals, weights, dof);
            }
            estimate
        };
        let estimate = |part: usize, parameter: Parameter| {
            let tie = problem.parts()[part].ties().iter().find(|tie| tie.parameter == parameter);
            tie.map_or_else(|| of(part, parameter), |tie| of(part, tie.to).of_tied(tie))
        };
        let all = problem.model().parameters();
        let fitted = analysis.fitted(problem);
        let set = |part: usize| {
            let (own_problem, parameters) = (&fitted.parts()[part], &point[part]);
            let uncertainty = analysis.uncertainty.restricted(|unknown: &JointUnknown| {
                let is_its = unknown.set.as_ref().is_none_or(|set| *set == problem.set_names()[part]);
                is_its.then_some(unknown.parameter)
            });
            SetResult {
                name: problem.set_names()[part].clone(),
                residuals: own_problem.len(),
                parameters: *parameters,
                own: all.intersection(problem.own()).iter().map(|parameter| estimate(part, parameter)).collect(),
                objective: own_problem.delta_e(parameters).filter(|_| !own_problem.is_empty()),
                start_objective: own_problem.delta_e(&problem.start()[part]),
                rss: own_problem.sum_of_squares(parameters).unwrap_or(0.0) * problem.rss_scale(),
                band: PredictionBand::new(own_problem, parameters, uncertainty),
            }
        };
        Self {
            model: problem.model(),
            shared: all.without_all(problem.own()).iter().map(|parameter| estimate(0, parameter)).collect(),
            sets: (0..point.len()).map(set).collect(),
            objective: analysis.objective,
            start_objective: analysis.start_objective,
            stop_reason: analysis.stop_reason,
            statistics: analysis.statistics,
            correlations: analysis.correlations(),
            undetermined: analysis.uncertainty.undetermined.clone(),
            uncertainty: analysis.uncertainty,
            course: analysis.course,
        }
    }

    /// As the analysis of that problem, which says the same.
    fn analysis(&self, problem: &JointProblem) -> Analysis<JointProblem> {
        Analysis {
            x: problem.unknowns_at(&self.points()),
            objective: self.objective,
            start_objective: self.start_objective,
            stop_reason: self.stop_reason,
            statistics: self.statistics,
            uncertainty: self.uncertainty.clone(),
            course: self.course.clone(),
        }
    }

    /// All values, for each measurement.
    #[must_use]
    pub fn points(&self) -> Vec<Parameters> {
        self.sets.iter().map(|set| set.parameters).collect()
    }

    /// Whether the model meets the data to the last digits, as [`FitResult::is_exact`].
    #[must_use]
    pub fn is_exact(&self) -> bool {
        is_exact(self.stop_reason, self.objective, self.statistics.rss)
    }

    /// Without standard errors of the parameters.
    #[must_use]
    pub fn without_errors(mut self) -> Self {
        let own = self.sets.iter_mut().flat_map(|set| set.own.iter_mut());
        self.shared.iter_mut().chain(own).for_each(|estimate| estimate.std_error = None);
        self
    }

    /// The estimate of a parameter for a measurement, shared or own; none if the model does not have it.
    #[must_use]
    pub fn estimate(&self, set: usize, parameter: Parameter) -> Option<&Estimate> {
        self.sets[set].own.iter().chain(&self.shared).find(|estimate| estimate.parameter == parameter)
    }

    /// All estimates with their names, the shared ones first.
    pub fn estimates(&self) -> impl Iterator<Item = (JointUnknown, &Estimate)> {
        let shared = self.shared.iter().map(|estimate| (JointUnknown { parameter: estimate.parameter, set: None }, estimate));
        let own = self.sets.iter().flat_map(|set| {
            set.own.iter().map(|estimate| (JointUnknown { parameter: estimate.parameter, set: Some(set.name.clone()) }, estimate))
        });
        shared.chain(own)
    }

    /// What the data leave open: directions and, by the intervals, unknowns that are not determined; without intervals, unknowns that are
    /// poorly determined.
    #[must_use]
    pub fn describe_undetermined(&self) -> Vec<Undetermined<JointUnknown>> {
        let of = |is_such: &dyn Fn(&JointUnknown, &Estimate) -> bool| -> Vec<JointUnknown> {
            self.estimates().filter(|(name, estimate)| is_such(name, estimate)).map(|(name, _)| name).collect()
        };
        let is_named =
            |name: &JointUnknown| self.undetermined.iter().any(|open| matches!(&open.direction[..], [(only, _)] if only == name));
        let is_open = |name: &JointUnknown, estimate: &Estimate| {
            let is_undetermined = estimate.interval68.is_some() && estimate.status() == EstimateStatus::Undetermined;
            is_undetermined && !is_named(name)
        };
        let lists = [Undetermined::Parameters(of(&is_open)), Undetermined::Poorly(of(&|_, estimate| estimate.is_poorly_determined()))];
        let lists = lists.into_iter().filter(|list| !list.is_empty());
        self.undetermined.iter().cloned().map(Undetermined::Direction).chain(lists).collect()
    }

    /// One measurement as the result of a fit by itself: its surface, with the uncertainties of the joint fit. Its statistics are its own
    /// sums of squares and the joint degrees of freedom.
    #[must_use]
    pub fn of_set(&self, set: usize) -> FitResult {
        let of = &self.sets[set];
        let estimates = self.model.parameters().iter().filter_map(|parameter| self.estimate(set, parameter).copied());
        let uncertainty: &Uncertainty = of.band.uncertainty();
        FitResult {
            model: self.model,
            parameters: of.parameters,
            estimates: estimates.collect(),
            objective: of.objective,
            start_objective: of.start_objective,
            stop_reason: self.stop_reason,
            statistics: Statistics { rss: of.rss, ..self.statistics },
            correlations: Correlations { parameters: uncertainty.determined.clone(), matrix: uncertainty.correlations() },
            undetermined: Vec::new(),
            band: of.band.clone(),
            course: Course {
                evaluations: self.course.evaluations,
                elapsed_ms: self.course.elapsed_ms,
                intervals_ms: self.course.intervals_ms,
                intervals_complete: self.course.intervals_complete,
                ..Course::default()
            },
        }
    }
}

/// The result of a search of several measurements, which may have been made before, with the intervals of the unknowns where they are known.
/// The problem has the loss scales and block weights that the search had.
#[must_use]
pub fn analyse_jointly(
    problem: &JointProblem,
    search: MultistartResult<Vec<Parameters>>,
    elapsed_ms: f64,
    intervals: Option<&[[Interval; 2]]>,
) -> JointResult {
    JointResult::new(problem, Analysis::new(problem, search, elapsed_ms), intervals)
}

/// The joint result with the profile-likelihood intervals of all unknowns, as [`crate::fit::with_intervals`] has it of one measurement.
#[must_use]
pub fn with_intervals_jointly(problem: &JointProblem, result: &JointResult, observer: Observer<'_>) -> JointResult {
    let (analysis, intervals) = profile_all(problem, result.analysis(problem), observer);
    JointResult::new(problem, analysis, intervals.as_deref())
}

/// Follows the profile of an unknown of a finished joint fit; it ends early, with what it has, when it is cancelled.
#[must_use]
pub fn profile_jointly(
    problem: &JointProblem,
    result: &JointResult,
    unknown: &JointUnknown,
    observer: Observer<'_>,
) -> Profile<JointUnknown> {
    profile_of(problem, &result.analysis(problem), unknown, observer)
}

/// Refits `replicates` resampled data sets of a finished joint fit; residuals are resampled within each measurement.
#[must_use]
pub fn bootstrap_jointly(
    problem: &JointProblem,
    result: &JointResult,
    replicates: usize,
    seed: u64,
    observer: Observer<'_>,
) -> Bootstrap<JointUnknown> {
    bootstrap_of(problem, &result.analysis(problem), replicates, seed, observer)
}

impl fmt::Display for JointResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.stop_reason)?;
        for (name, estimate) in self.estimates() {
            writeln!(f, "{} = {estimate}", crate::fit::fit_problem::UnknownName::symbol(&name))?;
        }
        self.undetermined.iter().try_for_each(|direction| writeln!(f, "{direction}"))
    }
}

impl Serialize for JointResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { statistics, course, .. } = self;
        let mut result = serializer.serialize_struct("JointResult", SUMMARY_FIELDS + 6)?;
        serialize_summary(&mut result, self.model, self.objective, self.stop_reason, statistics, course)?;
        result.serialize_field("parameters", &ByKey(&self.shared))?;
        result.serialize_field("sets", &self.sets)?;
        result.serialize_field("undetermined", &self.undetermined)?;
        result.serialize_field("correlations", &self.correlations)?;
        result.serialize_field("starts", &course.minima)?;
        result.serialize_field("trace", &course.trace)?;
        result.end()
    }
}

impl Serialize for SetResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut set = serializer.serialize_struct("SetResult", 4)?;
        set.serialize_field("set", &*self.name)?;
        set.serialize_field("objective", &self.objective)?;
        set.serialize_field("sum_of_squares", &self.rss)?;
        set.serialize_field("parameters", &ByKey(&self.own))?;
        set.end()
    }
}
