//! Profile-likelihood intervals of a fit, and the profile of one parameter as a curve.
//!
//! A parameter is held, all others are fitted again. The interval holds the values at which the sum of squares S stays below
//! `S_min (1 + F_{1,dof}(level)/dof)` or, where standard deviations were stated, `χ²_min + χ²₁(level)` (Bates and Watts, *Nonlinear
//! Regression Analysis*, 1988, ch. 6). Under a robust loss the rise is multiplied by the ratio of the plain to the sandwich
//! variance of the parameter.

use crate::fit::analysis::analyse;
use crate::fit::estimate::Estimate;
use crate::fit::intervals::confidence::{Profiles, profiles};
use crate::fit::intervals::interval::Interval;
use crate::fit::intervals::quantile::{chi_squared_quantile, f_quantile};
use crate::fit::intervals::walk::{Landmarks, ProfileFit};
use crate::fit::least_squares::LeastSquares;
use crate::fit::local::solution::LocalFit;
use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::multistart::basin::{Basin, MultistartResult};
use crate::fit::multistart::initial_guess::grid_minima;
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::Weights;
use crate::fit::result::FitResult;
use crate::model::{Parameter, Parameters};
use nalgebra::DVector;
use serde::Serialize;

/// The levels of the two intervals: that of one standard error, and the usual one.
pub const LEVELS: [f64; 2] = [0.682_689_492_137_085_9, 0.95];
/// A linear standard error is shown where both ends of the 68.3 % interval lie within this fraction of it.
const AGREEMENT: f64 = 0.25;
/// Sum of squares below which residuals are rounding, in the units of Eq. (18): a relative misfit of 1e-13.
const ROUNDING: f64 = 1e-26;
/// Times that a better minimum found by a profile becomes the result, at most.
const MOST_MINIMA: usize = 4;
/// Better points of a round that are followed to their minima.
const POLISHED: usize = 6;
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
pub struct Profile {
    /// Which parameter.
    pub parameter: Parameter,
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
pub fn with_intervals(problem: &Problem, mut result: FitResult, observer: Observer<'_>) -> FitResult {
    let begin = (observer.clock)();
    for round in 1..=MOST_MINIMA {
        let fitted = result.fitted(problem);
        if fitted.is_empty() || fitted.free().is_empty() {
            break;
        }
        let found = profiles_of(&fitted, &result, fitted.free(), observer);
        result.course.evaluations += found.evaluations;
        let is_settled = found.better.is_empty() || round == MOST_MINIMA || (observer.cancelled)();
        if !found.better.is_empty() {
            result = with_better_minimum(problem, result, &found.better, observer);
        }
        if is_settled {
            result.course.intervals_complete = Some(found.is_complete);
            set_intervals(&fitted, &mut result, &found.ends.into_iter().map(intervals_of).collect::<Vec<_>>());
            break;
        }
    }
    result.course.intervals_ms = (observer.clock)() - begin;
    result
}

/// Follows the profile of a free parameter of a finished fit; it ends early, with what it has, when it is cancelled.
#[must_use]
pub fn profile(problem: &Problem, result: &FitResult, parameter: Parameter, observer: Observer<'_>) -> Profile {
    let fitted = result.fitted(problem);
    let found = profiles_of(&fitted, result, &[parameter], observer);
    let Some(unknown) = fitted.free().iter().position(|&free| free == parameter) else {
        let [interval68, interval95] = [Interval::OPEN; 2];
        return Profile { parameter, points: Vec::new(), interval68, interval95, limits: [f64::INFINITY; 2], is_complete: true };
    };
    let sum_of_squares = fitted.sum_of_squares(&result.parameters).unwrap_or(f64::NAN);
    let limits = rises(&fitted, result, sum_of_squares, parameter).map(|rise| (sum_of_squares + rise) * fitted.rss_scale());
    let point = |fit: &ProfileFit| ProfilePoint {
        value: fit.x[unknown],
        objective: fitted.objective(fit.sum_of_squares, &fitted.parameters_at(&fit.x)),
        rss: fit.sum_of_squares * fitted.rss_scale(),
    };
    let [interval68, interval95] = intervals_of(found.ends[unknown]);
    let points = found.points[unknown].iter().map(point).collect();
    Profile { parameter, points, interval68, interval95, limits, is_complete: found.is_complete }
}

fn unknowns_at(problem: &Problem, parameters: &Parameters) -> DVector<f64> {
    LeastSquares::start(&problem.with_start(*parameters))
}

fn profiles_of(problem: &Problem, result: &FitResult, of: &[Parameter], observer: Observer<'_>) -> Profiles {
    let x = unknowns_at(problem, &result.parameters);
    let sum_of_squares = problem.sum_of_squares(&result.parameters).unwrap_or(f64::NAN);
    let others: Vec<DVector<f64>> =
        result.course.minima.iter().skip(1).take(OTHER_MINIMA).map(|minimum| unknowns_at(problem, &minimum.parameters)).collect();
    let elsewhere = |unknown: usize, value: f64| {
        let held = problem.free()[unknown];
        let mut start = result.parameters;
        start[held] = value;
        let rest = problem.free().iter().copied().filter(|&free| free != held).collect();
        let guesses = grid_minima(&problem.with_free(rest).with_start(start));
        guesses.into_iter().take(GUESSES).map(|guess| unknowns_at(problem, &guess.parameters)).collect()
    };
    let minimum = &ProfileFit { x, sum_of_squares };
    let landmarks = Landmarks { problem, minimum, others: &others, elsewhere: &elsewhere, observer };
    let is_wanted = |parameter: Parameter| of.contains(&parameter) && !is_idle(result, parameter);
    let unknowns: Vec<usize> = (0..problem.free().len()).filter(|&j| is_wanted(problem.free()[j])).collect();
    let errors: Vec<Option<f64>> = problem.free().iter().map(|&parameter| result.band.uncertainty().standard_error(parameter)).collect();
    let rises: Vec<[f64; 2]> = problem.free().iter().map(|&parameter| rises(problem, result, sum_of_squares, parameter)).collect();
    if !sum_of_squares.is_finite() || rises.iter().flatten().any(|rise| !rise.is_finite()) {
        // Without a degree of freedom there is no limit to cross.
        return Profiles::open(problem.free().len());
    }
    profiles(&landmarks, &unknowns, &errors, &rises)
}

/// Whether the parameter changes nothing.
fn is_idle(result: &FitResult, parameter: Parameter) -> bool {
    result.undetermined.iter().any(|undetermined| matches!(undetermined.direction[..], [(only, _)] if only == parameter))
}

/// The rises of the sum of squares at the limits of both levels.
fn rises(problem: &Problem, result: &FitResult, sum_of_squares: f64, parameter: Parameter) -> [f64; 2] {
    let inflation = result.band.uncertainty().inflation(parameter);
    LEVELS.map(|level| {
        let rise = match problem.options().weights {
            Weights::Sigma => chi_squared_quantile(level),
            #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
            Weights::None => sum_of_squares.max(ROUNDING) * f_quantile(level, result.statistics.dof) / result.statistics.dof as f64,
        };
        inflation * rise
    })
}

/// The same fit from the better points.
fn with_better_minimum(problem: &Problem, result: FitResult, better: &[ProfileFit], observer: Observer<'_>) -> FitResult {
    let fitted = result.fitted(problem);
    let polished = |fit: &ProfileFit| fit_local(&fitted.with_start(fitted.parameters_at(&fit.x)), Effort::Polish, observer);
    let followed: Vec<LocalFit> = better.iter().take(POLISHED).map(polished).collect();
    let course = result.course;
    let known = |parameters: Parameters| LocalFit {
        parameters,
        sum_of_squares: fitted.sum_of_squares(&parameters).unwrap_or(f64::INFINITY),
        stop_reason: result.stop_reason,
        evaluations: 0,
        trace: Vec::new(),
        path: Vec::new(),
    };
    let evaluations = followed.iter().map(|further| further.evaluations).sum::<usize>();
    let mut found = MultistartResult { basins: Vec::new(), evaluations: course.evaluations + evaluations };
    let before = LocalFit { trace: course.trace, path: course.path, evaluations: course.evaluations, ..known(result.parameters) };
    for further in followed {
        found.merge(Basin { local_fit: before.clone().followed_by(further), hits: 1 });
    }
    for minimum in course.minima {
        found.merge(Basin { local_fit: known(minimum.parameters), hits: minimum.hits });
    }
    analyse(&fitted, found, course.elapsed_ms)
}

/// The intervals at both levels between the ends below and above the minimum.
fn intervals_of([low, high]: [[Option<f64>; 2]; 2]) -> [Interval; 2] {
    [0, 1].map(|level| Interval { low: low[level], high: high[level] })
}

/// Sets intervals at 68.3 and 95 % that were found before, one pair for each free parameter of the problem; a linear standard error
/// stays only where it agrees.
pub fn set_intervals(problem: &Problem, result: &mut FitResult, intervals: &[[Interval; 2]]) {
    let dof = result.statistics.dof;
    for estimate in result.estimates.iter_mut().filter(|estimate| estimate.free) {
        let found = problem.free().iter().position(|&free| free == estimate.parameter).and_then(|j| intervals.get(j));
        let [interval68, interval95] = found.copied().unwrap_or([Interval::OPEN; 2]);
        estimate.interval68 = Some(interval68);
        estimate.interval95 = Some(interval95);
        estimate.determined = !interval68.is_open() || (dof == 0 && estimate.determined);
        estimate.std_error = estimate.std_error.filter(|&error| agrees(estimate, interval68, error, problem.options().weights, dof));
    }
}

/// Whether both ends of the interval are where the linear error expects them.
fn agrees(estimate: &Estimate, interval: Interval, error: f64, weights: Weights, dof: usize) -> bool {
    // With few degrees of freedom the variance is uncertain as well, and Student's quantile is above 1.
    let expected = error * if weights == Weights::None { f_quantile(LEVELS[0], dof).sqrt() } else { 1.0 };
    let is_near = |distance: f64| (distance - expected).abs() <= AGREEMENT * expected;
    interval.low.is_some_and(|low| is_near(estimate.value - low)) && interval.high.is_some_and(|high| is_near(high - estimate.value))
}
