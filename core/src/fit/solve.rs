//! The fit of a problem: multistart search and analysis, in stages where a variance or the scale of a loss is to be found first.

use crate::fit::analysis::Analysis;
use crate::fit::fit_problem::FitProblem;
use crate::fit::local::solution::LocalFit;
use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::multistart::basin::{Basin, MultistartResult};
use crate::fit::multistart::search::{Starts, multistart};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::Loss;
use crate::fit::result::FitResult;
use crate::fit::stop_reason::StopReason;

/// Rounds in which the variances of DoLP and BRDF settle, at most.
const ROUNDS: usize = 30;
/// Relative change of a weight from which variances have settled.
const SETTLED: f64 = 1e-7;
/// Sum of squares of a block, in units of its own Σ Xm², below which its variance is not estimated.
const FLOOR: f64 = 1e-20;
/// Minima that are followed while variances settle.
const FOLLOWED: usize = 6;

/// Fits from one start or many and analyses what the data determine. The seed shifts the points that starts are spread over.
///
/// A robust loss without a stated scale is fitted twice: by squares, and then with the scale of the residuals of that fit. DoLP and
/// BRDF together without stated standard deviations have two unknown variances: the fit of the sum of both ΔE is the start, then
/// each is weighted by its own, estimated in turn until they settle.
#[must_use]
pub fn fit(problem: &Problem, starts: Starts, seed: u64, observer: Observer<'_>) -> FitResult {
    solve(problem, starts, seed, observer).1.into_result(problem)
}

/// The fit of any problem: what was minimised in the end, and what is said of its minimum.
pub(crate) fn solve<P: FitProblem>(problem: &P, starts: Starts, seed: u64, observer: Observer<'_>) -> (P, Analysis<P>) {
    let options = problem.options();
    let is_squared = options.loss == Loss::Squared || options.loss_scale.is_some();
    let first = if is_squared { problem.clone() } else { problem.with_squared_loss() };
    let mut search = multistart(&first, starts, seed, observer);
    let mut fitted = first;
    if !is_squared {
        let solution = &search.basins[0].local_fit.parameters;
        fitted = problem.with_loss_scale_of(solution).starting_at(solution);
        let robust = multistart(&fitted, starts, seed, observer);
        search = MultistartResult { evaluations: search.evaluations + robust.evaluations, ..robust };
        fitted = fitted.starting_at(problem.start_point());
    }
    if problem.has_two_variances() {
        (fitted, search) = settle_variances(fitted, search, observer);
    }
    let analysis = Analysis::new(&fitted, search, (observer.clock)());
    (fitted, analysis)
}

/// Weights DoLP and BRDF by their own variances and follows the best minima until these change no more.
fn settle_variances<P: FitProblem>(
    problem: P,
    mut search: MultistartResult<P::Point>,
    observer: Observer<'_>,
) -> (P, MultistartResult<P::Point>) {
    let mut weighted = problem;
    for _ in 0..ROUNDS {
        let best = &search.basins[0].local_fit;
        if best.stop_reason == StopReason::ResidualsZero || (observer.cancelled)() {
            break;
        }
        let before = weighted.block_weights();
        #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
        let weights = weighted.block_sums(&best.parameters).map(|(sum, count)| (count as f64 / sum.max(FLOOR)).sqrt());
        if before.iter().zip(&weights).all(|(before, after)| (after / before - 1.0).abs() <= SETTLED) {
            break;
        }
        weighted = weighted.with_block_weights(weights);
        let mut followed = MultistartResult { basins: Vec::new(), evaluations: search.evaluations };
        for basin in search.basins.into_iter().take(FOLLOWED) {
            let further = fit_local(&weighted.starting_at(&basin.local_fit.parameters), Effort::Polish, observer);
            followed.evaluations += further.evaluations;
            let local_fit = LocalFit { sum_of_squares: f64::INFINITY, ..basin.local_fit };
            followed.merge(Basin { local_fit: local_fit.followed_by(further), hits: basin.hits });
        }
        search = followed;
    }
    (weighted, search)
}
