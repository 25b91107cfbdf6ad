//! From one start to a minimum, by two solvers.
//!
//! - [`crate::fit::local::bounded_lm`], Levenberg–Marquardt in a box with geodesic acceleration, is fast, follows curved valleys
//!   and ends exactly on bounds. From a far start it may run into a bound before it meets the minimum.
//! - [`crate::fit::local::minpack`], the crate `levenberg-marquardt` under a sin² transform, never quite reaches a bound, so it
//!   passes by. It makes the first steps from each of many starts, and a second attempt where the bounded solver alone fails.

use crate::fit::fit_problem::FitProblem;
use crate::fit::least_squares::LeastSquares;
use crate::fit::local::bounded_lm::{BoundedLm, GRADIENT_TOLERANCE, Limits};
use crate::fit::local::minpack::{MinpackLimits, minpack_sin2};
use crate::fit::local::recorder::Recorder;
use crate::fit::local::solution::{LocalFit, Solution};
use crate::fit::observer::Observer;
use crate::fit::stop_reason::StopReason;
use nalgebra::DVector;

/// How far a descent is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Effort {
    /// To the minimum: the bounded solver, then MINPACK and the bounded solver again where the first fails or ends on a bound or a plateau.
    Thorough,
    /// From a far start until another start is worth more: MINPACK until progress is slow, then the bounded solver.
    Coarse,
    /// The same with more of MINPACK: another way down, which may end in another minimum.
    Careful,
    /// From near a minimum to the minimum: the bounded solver alone.
    Polish,
    /// The same, to be given up where the way is long.
    Refine,
    /// A few steps of MINPACK.
    Probe,
}

/// Steps of the bounded solver. A step with its acceleration takes two evaluations, so that with nine unknowns this limit and that
/// of evaluations meet.
const STEPS: usize = 2000;
/// Evaluations of the bounded solver per unknown and one; MINPACK's own limit with analytic derivatives is 100.
const PATIENCE: usize = 400;
/// The same for one start among many; a good one of them is followed further by [`Effort::Polish`].
const COARSE_PATIENCE: usize = 50;
/// Square of the relative offset at which such a start has shown its minimum.
const COARSE_TOLERANCE: f64 = 1e-8;
/// The same for MINPACK, whose creeping along curved valleys is left to the bounded solver.
const MINPACK: MinpackLimits = MinpackLimits { patience: 30, tolerance: 1e-5 };
/// The same for one start among many, which is handed over earlier.
const COARSE_MINPACK: MinpackLimits = MinpackLimits { tolerance: 1e-2, ..MINPACK };
/// The same, handed over less early: another way down, which may end in another minimum.
const CAREFUL_MINPACK: MinpackLimits = MinpackLimits { tolerance: 1e-3, ..MINPACK };
/// The same for a probe: ten evaluations with nine unknowns, enough to rank starts.
const PROBE: MinpackLimits = MinpackLimits { patience: 1, ..CAREFUL_MINPACK };

/// To the minimum, not refined.
pub(crate) const LIMITS: Limits =
    Limits { steps: STEPS, evaluations: usize::MAX, refine: false, tolerance: GRADIENT_TOLERANCE, target: f64::NEG_INFINITY };

/// Fits from the start of the problem.
#[must_use]
pub fn fit_local<P: FitProblem>(problem: &P, effort: Effort, observer: Observer<'_>) -> LocalFit<P::Point> {
    let Solution { x, sum_of_squares, stop_reason, evaluations, trace, path } = minimise(problem, effort, observer);
    let path = path.iter().map(|x| problem.point_at(x)).collect();
    LocalFit { parameters: problem.point_at(&x), sum_of_squares, stop_reason, evaluations, trace, path }
}

/// Minimises a sum of squares from its start.
#[must_use]
pub fn minimise<P: LeastSquares>(problem: &P, effort: Effort, observer: Observer<'_>) -> Solution {
    let start = problem.start();
    let mut recorder = Recorder::new(&start, observer);
    if problem.residual_count() == 0 {
        return recorder.into_solution(StopReason::NoData);
    }
    let n = start.len();
    if n == 0 {
        recorder.evaluate(problem, &start, &mut DVector::zeros(problem.residual_count()));
        return recorder.into_solution(StopReason::Converged);
    }
    let thorough = Limits { evaluations: PATIENCE * (n + 1), refine: true, ..LIMITS };
    let stop = match effort {
        Effort::Probe => minpack_sin2(problem, &start, PROBE, &mut recorder).1,
        Effort::Coarse => coarse(problem, &start, COARSE_MINPACK, &mut recorder),
        Effort::Careful => coarse(problem, &start, CAREFUL_MINPACK, &mut recorder),
        Effort::Polish => BoundedLm::new(problem, &start).run(thorough, &mut recorder),
        Effort::Refine => BoundedLm::new(problem, &start).run(Limits { evaluations: COARSE_PATIENCE * (n + 1), ..thorough }, &mut recorder),
        Effort::Thorough => self::thorough(problem, &start, thorough, &mut recorder),
    };
    recorder.into_solution(stop)
}

/// MINPACK until progress stalls, then the bounded Levenberg–Marquardt.
fn coarse<P: LeastSquares>(problem: &P, start: &DVector<f64>, minpack: MinpackLimits, recorder: &mut Recorder<'_>) -> StopReason {
    let (from, stop) = minpack_sin2(problem, start, minpack, recorder);
    if stop == StopReason::Cancelled {
        return stop;
    }
    let limits = Limits { evaluations: COARSE_PATIENCE * (start.len() + 1), tolerance: COARSE_TOLERANCE, ..LIMITS };
    BoundedLm::new(problem, &from).run(limits, recorder)
}

/// The bounded Levenberg–Marquardt; where it fails, ends on a bound or where an unknown changes nothing, once more from the point that
/// MINPACK reaches from the same start.
fn thorough<P: LeastSquares>(problem: &P, start: &DVector<f64>, limits: Limits, recorder: &mut Recorder<'_>) -> StopReason {
    let mut solver = BoundedLm::new(problem, start);
    let first = solver.run(limits, recorder);
    let is_done = match first {
        StopReason::ResidualsZero | StopReason::Cancelled => true,
        StopReason::Converged => is_inside(problem, recorder.best()) && solver.moves_all(),
        _ => false,
    };
    if is_done {
        return first;
    }
    let (from, stop) = minpack_sin2(problem, start, MINPACK, recorder);
    if stop == StopReason::Cancelled {
        return stop;
    }
    let before = recorder.sum_of_squares();
    let second = BoundedLm::new(problem, &from).run(limits, recorder);
    if recorder.sum_of_squares() < before || second == StopReason::Cancelled { second } else { first }
}

/// Whether no unknown lies on a bound.
fn is_inside<P: LeastSquares>(problem: &P, x: &DVector<f64>) -> bool {
    x.iter().enumerate().all(|(j, &value)| {
        let (low, high) = problem.bounds_of(j);
        value > low && value < high
    })
}
