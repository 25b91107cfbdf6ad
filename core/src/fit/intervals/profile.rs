//! Profile likelihood: one parameter held on a grid, the other free parameters fitted at each value.
//!
//! The interval holds the values at which the sum of squares S exceeds its minimum by no more than one standard error would:
//! `S ≤ S_min (1 + 1/(N − rank))`, or χ²_min + 1 where standard deviations were stated (Bates and Watts, *Nonlinear Regression Analysis*, 1988, ch. 6).

use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::Weights;
use crate::fit::result::FitResult;
use crate::model::{Parameter, ParameterSet, Parameters};
use serde::Serialize;

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
    /// The scan, in ascending values.
    pub points: Vec<ProfilePoint>,
    /// Lower end of the interval; none where the data (within the scan) do not set one.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// Grid values on either side of the best one.
const STEPS: i32 = 15;
/// Standard errors that the grid covers on either side: a quadratic valley crosses the limit at one.
const REACH: f64 = 3.0;

/// Scans a free parameter of a finished fit; it ends early, with what it has, when it is cancelled.
#[must_use]
pub fn profile(problem: &Problem, report: &FitResult, parameter: Parameter, watch: Observer<'_>) -> Profile {
    let best = report.parameters[parameter];
    let (low, high) = problem.bounds().of(parameter);
    let error = report.estimate(parameter).and_then(|estimate| estimate.std_error);
    let reach = error.map_or(high - low, |error| REACH * error);
    let end = |bound: f64| if bound < best { bound.max(best - reach) } else { bound.min(best + reach) };
    let rest: ParameterSet = problem.free().iter().copied().filter(|&other| other != parameter).collect();
    let held = problem.with_free(rest);

    let mut scan = Vec::new();
    let smallest = problem.sum_of_squares(&report.parameters).unwrap_or(f64::NAN);
    for side in [end(low), end(high)] {
        let mut from = report.parameters;
        for step in 1..=STEPS {
            if (watch.cancelled)() || side == best {
                break;
            }
            from[parameter] = best + (side - best) * f64::from(step) / f64::from(STEPS);
            let descent = fit_local(&held.with_start(from), Effort::Thorough, watch);
            from = descent.parameters;
            scan.push((from[parameter], descent.sum_of_squares, from));
        }
    }
    scan.push((best, smallest, report.parameters));
    scan.sort_by(|a, b| a.0.total_cmp(&b.0));
    let limit = limit(problem, report, smallest);
    let crossing = |side: &mut dyn Iterator<Item = &(f64, f64, Parameters)>| {
        let mut inner = (best, smallest);
        for &(value, sum, _) in side {
            if sum > limit {
                return Some(inner.0 + (value - inner.0) * (limit - inner.1) / (sum - inner.1));
            }
            inner = (value, sum);
        }
        None
    };
    let (low, high) =
        (crossing(&mut scan.iter().rev().filter(|point| point.0 < best)), crossing(&mut scan.iter().filter(|point| point.0 > best)));
    let points = scan
        .iter()
        .map(|(value, sum, at)| ProfilePoint { value: *value, objective: problem.objective(*sum, at), rss: sum * problem.rss_scale() })
        .collect();
    Profile { parameter, points, low, high }
}

fn limit(problem: &Problem, report: &FitResult, smallest: f64) -> f64 {
    match problem.options().weights {
        Weights::Sigma => smallest + 1.0,
        #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
        Weights::None => smallest * (1.0 + 1.0 / report.statistics.dof.max(1) as f64),
    }
}
