//! The fit of a problem: multistart search and analysis, in two stages where a robust loss has no scale yet.

use crate::fit::analysis::analyse;
use crate::fit::multistart::search::{Starts, multistart};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::Loss;
use crate::fit::result::FitResult;

/// Fits from one start or many and analyses what the data determine. The seed shifts the points that starts are spread over.
///
/// A robust loss without a stated scale is fitted twice: by squares, and then with the scale of the residuals of that fit.
#[must_use]
pub fn fit(problem: &Problem, starts: Starts, seed: u64, observer: Observer<'_>) -> FitResult {
    let options = problem.options();
    if options.loss == Loss::Squared || options.loss_scale.is_some() {
        return analyse(problem, multistart(problem, starts, seed, observer), (observer.clock)());
    }
    let squared = multistart(&problem.with_squared_loss(), starts, seed, observer);
    let solution = squared.basins[0].local_fit.parameters;
    let robust = problem.with_loss_scale_of(&solution).with_start(solution);
    let mut search = multistart(&robust, starts, seed, observer);
    search.evaluations += squared.evaluations;
    analyse(&robust.with_start(*problem.start()), search, (observer.clock)())
}
