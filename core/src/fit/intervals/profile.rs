//! Profile-likelihood intervals of a fit, and the profile of one parameter as a curve.
//!
//! A parameter is held, all others are fitted again. The interval holds the values at which the sum of squares S stays below
//! `S_min (1 + F_{1,dof}(level)/dof)` or, where standard deviations were stated, `χ²_min + χ²₁(level)` (Bates and Watts, *Nonlinear
//! Regression Analysis*, 1988, ch. 6). Under a robust loss the rise is multiplied by the ratio of the plain to the sandwich
//! variance of the parameter.

use crate::fit::analysis::Analysis;
use crate::fit::estimate::Estimate;
use crate::fit::fit_problem::FitProblem;
use crate::fit::intervals::confidence::{Profiles, profiles};
use crate::fit::intervals::interval::Interval;
use crate::fit::intervals::quantile::{chi_squared_quantile, f_quantile};
use crate::fit::intervals::walk::{Landmarks, ProfileFit};
use crate::fit::local::solution::LocalFit;
use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::multistart::basin::{Basin, MultistartResult, is_same};
use crate::fit::multistart::search::{Patience, Starts, multistart_with};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::Weights;
use crate::fit::result::FitResult;
use crate::model::Parameter;
use nalgebra::DVector;
use serde::Serialize;

/// The levels of the two intervals: that of one standard error, and the usual one.
pub const LEVELS: [f64; 2] = [0.682_689_492_137_085_9, 0.95];
/// A linear standard error is shown where both ends of the 68.3 % interval lie within this fraction of it.
const AGREEMENT: f64 = 0.25;
/// Sum of squares below which residuals are rounding, in the units of Eq. (18): a relative misfit of 1e-10. Limits of a thousand
/// rows lie another factor of a thousand lower, and still well above the rounding of the residuals, a relative 1e-15.
const ROUNDING: f64 = 1e-20;
/// Times that a better minimum found by a profile becomes the result, at most.
const MOST_MINIMA: usize = 4;
/// Better points of a round that are followed to their minima.
const POLISHED: usize = 6;
/// Seed of the search that looks once more: no usual choice for the first one.
const SECOND_SEED: u64 = 0x9e37_79b9;
/// First guesses that fits at a limit are started from.
const GUESSES: usize = 4;
/// Other minima that fits at a limit are started from, at most.
const OTHER_MINIMA: usize = 8;

/// The best fit with one parameter held.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ProfilePoint {
    /// Where it is held.
    pub value: f64,
    /// ΔE of Eq. (18) of the best fit there.
    pub objective: f64,
    /// Residual sum of squares, [`Problem::rss`].
    #[serde(rename = "sum_of_squares")]
    pub rss: f64,
}

/// A parameter's profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile<N = Parameter> {
    /// Which parameter.
    pub parameter: N,
    /// Held fits from one limit of 95 % to the other, or to the bound, in ascending values.
    pub points: Vec<ProfilePoint>,
    /// The interval at 68.3 %.
    pub interval68: Interval,
    /// The interval at 95 %.
    pub interval95: Interval,
    /// Residual sums of squares that the ends of both have.
    pub limits: [f64; 2],
    /// Whether it was not cancelled on the way.
    pub is_complete: bool,
}

/// The result with the profile-likelihood intervals of all free parameters, and linear standard errors only where they agree with these.
///
/// Where a profile finds a minimum better than that of the search, the result is the better one. Cancelled, the intervals are as
/// far as they came, and [`crate::fit::Course::intervals_complete`] says so.
#[must_use]
pub fn with_intervals(problem: &Problem, result: FitResult, observer: Observer<'_>) -> FitResult {
    let (analysis, intervals) = profile_all(problem, Analysis::of_result(problem, result), observer);
    let mut result = analysis.into_result(problem);
    if let Some(intervals) = intervals {
        set_intervals(&result.fitted(problem), &mut result, &intervals);
    }
    result
}

/// The intervals of all unknowns, and the analysis of the best minimum that was met on the way; none without data or unknowns.
pub(crate) fn profile_all<P: FitProblem>(
    problem: &P,
    mut analysis: Analysis<P>,
    observer: Observer<'_>,
) -> (Analysis<P>, Option<Vec<[Interval; 2]>>) {
    let begin = (observer.clock)();
    analysis = searched_again(problem, analysis, observer);
    let mut intervals = None;
    for round in 1..=MOST_MINIMA {
        let fitted = analysis.fitted(problem);
        if fitted.residual_count() == 0 || fitted.names().is_empty() {
            break;
        }
        let all: Vec<usize> = (0..fitted.names().len()).collect();
        let found = profiles_of(&fitted, &analysis, &all, observer);
        let is_settled = found.better.is_empty() || round == MOST_MINIMA || (observer.cancelled)();
        if !found.better.is_empty() {
            analysis = with_better_minimum(&fitted, analysis, &found.better, observer);
        }
        if is_settled {
            analysis.course.intervals_complete = Some(found.is_complete);
            intervals = Some(found.ends.into_iter().map(intervals_of).collect());
            break;
        }
    }
    analysis.course.intervals_ms = (observer.clock)() - begin;
    (analysis, intervals)
}

/// Follows the profile of a free parameter of a finished fit; it ends early, with what it has, when it is cancelled.
#[must_use]
pub fn profile(problem: &Problem, result: &FitResult, parameter: Parameter, observer: Observer<'_>) -> Profile {
    profile_of(problem, &Analysis::of_result(problem, result.clone()), &parameter, observer)
}

/// The same of any problem.
pub(crate) fn profile_of<P: FitProblem>(problem: &P, analysis: &Analysis<P>, name: &P::Name, observer: Observer<'_>) -> Profile<P::Name> {
    let fitted = analysis.fitted(problem);
    let parameter = name.clone();
    let Some(unknown) = fitted.names().iter().position(|free| free == name) else {
        let [interval68, interval95] = [Interval::OPEN; 2];
        return Profile { parameter, points: Vec::new(), interval68, interval95, limits: [f64::INFINITY; 2], is_complete: true };
    };
    let found = profiles_of(&fitted, analysis, &[unknown], observer);
    let sum_of_squares = fitted.sum_of_squares_at(&analysis.x).unwrap_or(f64::NAN);
    let limits = rises(&fitted, analysis, sum_of_squares, unknown).map(|rise| (sum_of_squares + rise) * fitted.rss_scale());
    let point = |fit: &ProfileFit| ProfilePoint {
        value: fit.x[unknown],
        objective: fitted.objective_at(fit.sum_of_squares, &fit.x),
        rss: fit.sum_of_squares * fitted.rss_scale(),
    };
    let [interval68, interval95] = intervals_of(found.ends[unknown]);
    let points = found.points[unknown].iter().map(point).collect();
    Profile { parameter, points, interval68, interval95, limits, is_complete: found.is_complete }
}

fn profiles_of<P: FitProblem>(problem: &P, analysis: &Analysis<P>, of: &[usize], observer: Observer<'_>) -> Profiles {
    let sum_of_squares = problem.sum_of_squares_at(&analysis.x).unwrap_or(f64::NAN);
    let minima = analysis.course.minima.iter().skip(1).take(OTHER_MINIMA);
    let others: Vec<DVector<f64>> = minima.map(|minimum| problem.unknowns_of(&minimum.parameters)).collect();
    let elsewhere = |unknown: usize, value: f64| {
        let mut x = analysis.x.clone();
        x[unknown] = value;
        problem.guesses_with_held(unknown, &x).iter().take(GUESSES).map(|guess| problem.unknowns_of(guess)).collect()
    };
    let minimum = &ProfileFit { x: analysis.x.clone(), sum_of_squares };
    let landmarks = Landmarks { problem, minimum, others: &others, elsewhere: &elsewhere, observer };
    let names = problem.names();
    let unknowns: Vec<usize> = of.iter().copied().filter(|&j| !is_idle(analysis, &names[j])).collect();
    // Where residuals are rounding, the linear errors go by the same sum of squares as the limits.
    let scale = (above_rounding(problem.options().weights, sum_of_squares) / sum_of_squares).sqrt();
    let error_of = |name| analysis.uncertainty.error_of(name).map(|error| scale * error).filter(|error| error.is_finite());
    let errors: Vec<Option<f64>> = names.iter().map(error_of).collect();
    let rises: Vec<[f64; 2]> = (0..names.len()).map(|j| rises(problem, analysis, sum_of_squares, j)).collect();
    if !sum_of_squares.is_finite() || rises.iter().flatten().any(|rise| !rise.is_finite()) {
        // Without a degree of freedom there is no limit to cross.
        return Profiles::open(names.len());
    }
    profiles(&landmarks, &unknowns, &errors, &rises)
}

/// Whether the unknown changes nothing.
fn is_idle<P: FitProblem>(analysis: &Analysis<P>, name: &P::Name) -> bool {
    let directions = &analysis.uncertainty.undetermined;
    directions.iter().any(|undetermined| matches!(&undetermined.direction[..], [(only, _)] if only == name))
}

/// The rises of the sum of squares at the limits of both levels.
fn rises<P: FitProblem>(problem: &P, analysis: &Analysis<P>, sum_of_squares: f64, unknown: usize) -> [f64; 2] {
    let inflation = analysis.uncertainty.inflation(&problem.names()[unknown]);
    let dof = analysis.statistics.dof;
    LEVELS.map(|level| inflation * rise(problem.options().weights, sum_of_squares, dof, level))
}

/// By how much the sum of squares may rise above its minimum at that level; without a degree of freedom there is no limit.
#[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
pub(crate) fn rise(weights: Weights, minimum: f64, dof: usize, level: f64) -> f64 {
    match weights {
        Weights::Sigma => chi_squared_quantile(level),
        Weights::None if dof == 0 => f64::INFINITY,
        Weights::None => above_rounding(weights, minimum) * f_quantile(level, dof) / dof as f64,
    }
}

/// The sum of squares that limits and linear errors go by: one that is rounding counts as [`ROUNDING`], unless deviations are stated.
fn above_rounding(weights: Weights, sum_of_squares: f64) -> f64 {
    if weights == Weights::None { sum_of_squares.max(ROUNDING) } else { sum_of_squares }
}

/// The same fit, or the better one that a second search with other starts finds. Where the first met several minima, a narrow one may
/// have been missed; the intervals take longer than a search, and are worth nothing about the wrong minimum.
fn searched_again<P: FitProblem>(problem: &P, analysis: Analysis<P>, observer: Observer<'_>) -> Analysis<P> {
    let fitted = analysis.fitted(problem);
    let is_settled = analysis.course.minima.len() < 2 || problem.is_composed();
    if is_settled || fitted.residual_count() == 0 || fitted.names().is_empty() {
        return analysis;
    }
    let quiet = Observer { progress: &|_| {}, ..observer };
    let start = fitted.starting_at(&fitted.point_at(&analysis.x));
    let again = multistart_with(&start, Starts::Automatic, SECOND_SEED, Patience::SECOND, quiet);
    let before = fitted.sum_of_squares_at(&analysis.x).unwrap_or(f64::INFINITY);
    let is_better = |basin: &Basin<P::Point>| basin.local_fit.sum_of_squares < before && !is_same(basin.local_fit.sum_of_squares, before);
    let better: Vec<ProfileFit> = (again.basins.iter().filter(|basin| is_better(basin)))
        .map(|Basin { local_fit, .. }| ProfileFit {
            x: fitted.unknowns_of(&local_fit.parameters),
            sum_of_squares: local_fit.sum_of_squares,
        })
        .collect();
    if better.is_empty() { analysis } else { with_better_minimum(&fitted, analysis, &better, observer) }
}

/// The same fit from the better points.
fn with_better_minimum<P: FitProblem>(fitted: &P, analysis: Analysis<P>, better: &[ProfileFit], observer: Observer<'_>) -> Analysis<P> {
    let polished = |fit: &ProfileFit| fit_local(&fitted.starting_at(&fitted.point_at(&fit.x)), Effort::Polish, observer);
    let followed: Vec<LocalFit<P::Point>> = better.iter().take(POLISHED).map(polished).collect();
    let Analysis { x, course, stop_reason, .. } = analysis;
    let known = |parameters: P::Point| LocalFit {
        sum_of_squares: fitted.sum_of_squares_at(&fitted.unknowns_of(&parameters)).unwrap_or(f64::INFINITY),
        parameters,
        stop_reason,
        evaluations: 0,
        trace: Vec::new(),
        path: Vec::new(),
    };
    // Those of the search, like its time.
    let mut found = MultistartResult { basins: Vec::new(), evaluations: course.evaluations };
    let before = LocalFit { trace: course.trace, path: course.path, evaluations: course.evaluations, ..known(fitted.point_at(&x)) };
    for further in followed {
        found.merge(Basin { local_fit: before.clone().followed_by(further), hits: 1 });
    }
    for minimum in course.minima {
        found.merge(Basin { local_fit: known(minimum.parameters), hits: minimum.hits });
    }
    Analysis::new(fitted, found, course.elapsed_ms)
}

/// The intervals at both levels between the ends below and above the minimum.
fn intervals_of([low, high]: [[Option<f64>; 2]; 2]) -> [Interval; 2] {
    [0, 1].map(|level| Interval { low: low[level], high: high[level] })
}

/// Sets intervals at 68.3 and 95 % that were found before, one pair for each free parameter of the problem; a linear standard error
/// stays only where it agrees.
pub fn set_intervals(problem: &Problem, result: &mut FitResult, intervals: &[[Interval; 2]]) {
    let (weights, dof) = (problem.options().weights, result.statistics.dof);
    for estimate in result.estimates.iter_mut().filter(|estimate| estimate.free) {
        let found = problem.free().iter().position(|&free| free == estimate.parameter).and_then(|j| intervals.get(j));
        set_interval(estimate, found.copied().unwrap_or([Interval::OPEN; 2]), weights, dof);
    }
    for tie in problem.ties() {
        let of = result.estimate(tie.to).copied().map(|of| of.of_tied(tie));
        let tied = result.estimates.iter_mut().find(|estimate| estimate.parameter == tie.parameter);
        tied.into_iter().zip(of).for_each(|(estimate, of)| *estimate = of);
    }
}

/// Sets the intervals of one estimate.
pub(crate) fn set_interval(estimate: &mut Estimate, [interval68, interval95]: [Interval; 2], weights: Weights, dof: usize) {
    estimate.interval68 = Some(interval68);
    estimate.interval95 = Some(interval95);
    estimate.determined = !interval68.is_open() || (dof == 0 && estimate.determined);
    estimate.std_error = estimate.std_error.filter(|&error| agrees(estimate, interval68, error, weights, dof));
}

/// Whether both ends of the interval are where the linear error expects them.
fn agrees(estimate: &Estimate, interval: Interval, error: f64, weights: Weights, dof: usize) -> bool {
    // With few degrees of freedom the variance is uncertain as well, and Student's quantile is above 1.
    let expected = error * if weights == Weights::None { f_quantile(LEVELS[0], dof).sqrt() } else { 1.0 };
    let is_near = |distance: f64| (distance - expected).abs() <= AGREEMENT * expected;
    interval.low.is_some_and(|low| is_near(estimate.value - low)) && interval.high.is_some_and(|high| is_near(high - estimate.value))
}
