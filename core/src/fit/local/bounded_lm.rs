//! Levenberg–Marquardt in a box with geodesic acceleration.
//!
//! Each step minimises `‖J d + r‖² + λ ‖D d‖²` over the steps that stay in the box, D being the norms of the columns of J. Unknowns
//! on a bound do not move where the objective falls outwards (an active set). Where the residuals are curved along the step d, the
//! geodesic acceleration, half of their second derivative along d fitted by the same matrix, is added to it (Transtrum and Sethna,
//! arXiv:1201.5885). In a curved valley such a step follows the geodesic and goes several times as far.
//!
//! The minimum is reached where the undamped linear problem promises no further reduction, `‖Qᵀ r‖² ≤ ε ‖r‖²`: the relative offset
//! of Bates and Watts (Technometrics 23, 179 (1981)), which is free of units. λ follows Nielsen (IMM-REP-1999-05, DTU).

use crate::fit::least_squares::LeastSquares;
use crate::fit::local::qr::{Buffers, Damped};
use crate::fit::local::recorder::Recorder;
use crate::fit::local::tall_qr::{TallQr, dot};
use crate::fit::stop_reason::StopReason;
use nalgebra::{DMatrix, DVector};
use std::collections::VecDeque;
use std::ops::Range;

/// Square of the relative offset at which the sum of squares is at its minimum to every digit that matters.
pub(crate) const GRADIENT_TOLERANCE: f64 = 1e-12;
/// Steps that refine the unknowns at the end, where the sum of squares is down to rounding.
const REFINEMENT_STEPS: usize = 40;
/// Each of them must multiply the square of the relative offset by no more than this.
const REFINEMENT_CONTRACTION: f64 = 0.7;
/// Relative change of the sum of squares that is rounding.
const ROUNDING: f64 = 1e-11;
/// First damping: starts are mostly poor, but a good one is to be left by nearly full steps.
const FIRST_DAMPING: f64 = 1e-2;
/// Damping beyond which steps are lost in rounding.
const MAX_DAMPING: f64 = 1e16;
/// Damping below which there is none in f64.
const MIN_DAMPING: f64 = 1e-18;
/// Part of a step at which the curvature along it is measured, as Transtrum and Sethna recommend.
const DIFFERENCE_STEP: f64 = 0.1;
/// Largest ratio of acceleration to step (their α): beyond, the step is too long for its curvature.
const MAX_ACCELERATION_RATIO: f64 = 0.75;
/// An unknown is insensitive if it cannot change the residuals by more than this fraction of their norm when it crosses its whole
/// box: its column of the Jacobian is rounding.
const INSENSITIVE: f64 = 1e-10;
/// Predicted relative reduction below which the curvature is lost in rounding and is not measured.
const ACCELERATION_THRESHOLD: f64 = 1e-8;

/// Steps over which the pace of a minimisation is measured.
const PACE_STEPS: usize = 10;

/// How far a minimisation goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Steps taken.
    pub steps: usize,
    /// Residual evaluations.
    pub evaluations: usize,
    /// Whether the unknowns are refined at the end.
    pub refine: bool,
    /// Square of the relative offset at which the minimum is reached.
    pub tolerance: f64,
    /// Sum of squares that is low enough. Where it is finite, a minimisation that is too slow to get there ends early.
    pub target: f64,
}

/// A point, its residuals and the sum of their squares.
struct Point {
    x: DVector<f64>,
    residuals: DVector<f64>,
    sum_of_squares: f64,
}

/// The solver on a problem, with its buffers.
pub(crate) struct BoundedLm<'a, P: LeastSquares> {
    problem: &'a P,
    /// The box.
    bounds: Vec<(f64, f64)>,
    /// The rows of each unknown.
    rows: Vec<Range<usize>>,
    current: Point,
    trial: Point,
    jacobian: DMatrix<f64>,
    /// The unknowns that move: those inside, or pulled inwards from a bound, that are not insensitive.
    moving: Vec<usize>,
    /// D.
    scale: Vec<f64>,
    /// R and Qᵀr.
    qr: TallQr,
    /// The second derivative of the residuals along a step.
    second: Vec<f64>,
    /// The least and the largest step of each moving unknown.
    step_bounds: Vec<(f64, f64)>,
    step: Vec<f64>,
    acceleration: Vec<f64>,
    buffers: Buffers,
    damping: f64,
}

/// Sums of squares of the last steps, and the evaluations until each.
#[derive(Default)]
struct Pace(VecDeque<(f64, usize)>);

impl Pace {
    /// Whether the target lies below what so many more evaluations reach at the pace of the last steps.
    #[expect(clippy::cast_precision_loss, reason = "numbers of evaluations")]
    fn is_too_slow(&mut self, sum_of_squares: f64, evaluations: usize, last: usize, target: f64) -> bool {
        self.0.push_back((sum_of_squares, evaluations));
        if self.0.len() <= PACE_STEPS {
            return false;
        }
        let before = self.0.pop_front();
        before.is_some_and(|(sum, since)| {
            let pace = (sum - sum_of_squares) / (evaluations - since) as f64;
            sum_of_squares - target > pace * last.saturating_sub(evaluations) as f64
        })
    }
}

/// What came of the attempt to leave a point.
enum StepOutcome {
    /// The current point is a better one.
    Improved,
    /// No step improves the sum of squares.
    Stalled,
    /// A limit or a cancel.
    Stopped(StopReason),
}

impl<'a, P: LeastSquares> BoundedLm<'a, P> {
    pub(crate) fn new(problem: &'a P, start: &DVector<f64>) -> Self {
        let (m, n) = (problem.residual_count(), start.len());
        let point = |x: DVector<f64>| Point { x, residuals: DVector::zeros(m), sum_of_squares: f64::INFINITY };
        let bounds: Vec<(f64, f64)> = (0..n).map(|j| problem.bounds_of(j)).collect();
        let inside = DVector::from_fn(n, |j, _| start[j].clamp(bounds[j].0, bounds[j].1));
        Self {
            problem,
            current: point(inside.clone()),
            trial: point(inside),
            jacobian: DMatrix::zeros(m, n),
            moving: Vec::with_capacity(n),
            scale: Vec::with_capacity(n),
            qr: TallQr::default(),
            second: Vec::with_capacity(m),
            step_bounds: Vec::with_capacity(n),
            step: Vec::with_capacity(n),
            acceleration: Vec::with_capacity(n),
            buffers: Buffers::default(),
            damping: FIRST_DAMPING,
            rows: (0..n).map(|j| problem.rows_of(j)).collect(),
            bounds,
        }
    }

    /// Whether every unknown moved in the last step: none was held by a bound, and none was without any effect, as on a plateau.
    pub(crate) fn moves_all(&self) -> bool {
        self.moving.len() == self.bounds.len()
    }

    /// Minimises until the minimum or a limit is reached, or no step improves.
    pub(crate) fn run(&mut self, limits: Limits, recorder: &mut Recorder<'_>) -> StopReason {
        self.current.sum_of_squares = recorder.evaluate(self.problem, &self.current.x, &mut self.current.residuals);
        if recorder.is_cancelled() {
            return StopReason::Cancelled;
        }
        if !self.current.sum_of_squares.is_finite() {
            return StopReason::Numerical;
        }
        let last = recorder.evaluations().saturating_add(limits.evaluations);
        let mut pace = Pace::default();
        for _ in 0..limits.steps {
            if self.current.sum_of_squares <= self.problem.negligible() {
                return StopReason::ResidualsZero;
            }
            if self.current.sum_of_squares <= limits.target {
                return StopReason::Converged;
            }
            if !self.linearise() {
                return StopReason::Numerical;
            }
            let offset = self.offset();
            if offset <= limits.tolerance * self.current.sum_of_squares {
                if limits.refine {
                    return self.refine(recorder);
                }
                return StopReason::Converged;
            }
            let evaluations = recorder.evaluations();
            if limits.target.is_finite() && pace.is_too_slow(self.current.sum_of_squares, evaluations, last, limits.target) {
                return StopReason::NoImprovement;
            }
            match self.advance(last, recorder) {
                StepOutcome::Improved => {}
                StepOutcome::Stalled => return StopReason::NoImprovement,
                StepOutcome::Stopped(reason) => return reason,
            }
        }
        StopReason::EvaluationLimit
    }

    /// Writes Jacobian, moving unknowns and factorisation at the current point; false where a derivative is not finite.
    fn linearise(&mut self) -> bool {
        let Self { problem, current, jacobian, moving, scale, qr, step_bounds, rows, .. } = self;
        if !problem.jacobian_at(&current.x, jacobian) {
            return false;
        }
        let bounds = &self.bounds;
        moving.clear();
        moving.extend((0..current.x.len()).filter(|&j| {
            let (low, high) = bounds[j];
            let (at_low, at_high) = (current.x[j] <= low, current.x[j] >= high);
            if !at_low && !at_high {
                return true;
            }
            let slope = dot(part(jacobian, j, &rows[j]), &current.residuals.as_slice()[rows[j].clone()]);
            !((at_low && slope >= 0.0) || (at_high && slope <= 0.0))
        }));
        problem.to_local(&current.x, moving, jacobian);
        let insensitive = INSENSITIVE * current.residuals.norm();
        moving.retain(|&j| {
            let (low, high) = problem.local_bounds(&current.x, j);
            let column = part(jacobian, j, &rows[j]);
            dot(column, column).sqrt() * (high - low) > insensitive
        });
        qr.reduce_blocks(jacobian, moving, &current.residuals, rows);
        // The norm of a column of R is that of the column of J.
        let norm = |j: usize| (0..=j).map(|i| qr.r(i, j) * qr.r(i, j)).sum::<f64>().sqrt();
        scale.clear();
        scale.extend((0..moving.len()).map(|j| norm(j).max(f64::MIN_POSITIVE)));
        step_bounds.clear();
        step_bounds.extend(moving.iter().map(|&j| problem.local_bounds(&current.x, j)));
        true
    }

    /// ‖Qᵀ r‖², the reduction that the undamped linear problem predicts: the relative offset, squared, times ‖r‖².
    fn offset(&self) -> f64 {
        self.qr.rotated().iter().map(|c| c * c).sum()
    }

    /// Takes a step that reduces the sum of squares, raising the damping until there is one.
    fn advance(&mut self, last: usize, recorder: &mut Recorder<'_>) -> StepOutcome {
        let mut growth = 2.0;
        while self.damping < MAX_DAMPING {
            if recorder.is_cancelled() {
                return StepOutcome::Stopped(StopReason::Cancelled);
            }
            if recorder.evaluations() >= last {
                return StepOutcome::Stopped(StopReason::EvaluationLimit);
            }
            let predicted = self.damped_step();
            if predicted.is_nan() || predicted <= f64::EPSILON * self.current.sum_of_squares {
                return StepOutcome::Stalled;
            }
            let is_too_long = predicted > ACCELERATION_THRESHOLD * self.current.sum_of_squares && self.geodesic_acceleration(recorder);
            if !is_too_long {
                self.try_step(recorder);
                let ratio = (self.current.sum_of_squares - self.trial.sum_of_squares) / predicted;
                if ratio > 0.0 {
                    std::mem::swap(&mut self.current, &mut self.trial);
                    let x = 2.0 * ratio - 1.0;
                    self.damping = (self.damping * (1.0 - x * x * x).clamp(0.1, 2.0)).max(MIN_DAMPING);
                    return StepOutcome::Improved;
                }
            }
            self.damping *= growth;
            growth *= 2.0;
        }
        StepOutcome::Stalled
    }

    /// Writes the damped step; returns the reduction that it predicts.
    fn damped_step(&mut self) -> f64 {
        let Self { qr, scale, damping, step_bounds, step, buffers, moving, .. } = self;
        step.clear();
        step.resize(moving.len(), 0.0);
        let damped = Damped { qr, scale, damping: *damping };
        damped.solve_within(qr.rotated(), step_bounds, step, buffers);
        damped.reduction(qr.rotated(), step)
    }

    /// Adds the geodesic acceleration to the step; true if the step is too long for its curvature.
    fn geodesic_acceleration(&mut self, recorder: &mut Recorder<'_>) -> bool {
        let Self { problem, current, trial, jacobian, moving, scale, qr, step, acceleration, second, buffers, damping, rows, .. } = self;
        acceleration.clear();
        acceleration.extend(step.iter().map(|d| DIFFERENCE_STEP * d));
        problem.retract(&current.x, moving, acceleration, &mut trial.x);
        confine(&self.bounds, &mut trial.x);
        recorder.evaluate(*problem, &trial.x, &mut trial.residuals);
        // Half of the second derivative: ((r(x + h d) − r(x))/h − J d)/h.
        second.clear();
        let differences = trial.residuals.iter().zip(current.residuals.iter());
        second.extend(differences.map(|(there, here)| (there - here) / (DIFFERENCE_STEP * DIFFERENCE_STEP)));
        for (&j, d) in moving.iter().zip(step.iter()) {
            let along = d / DIFFERENCE_STEP;
            second[rows[j].clone()].iter_mut().zip(part(jacobian, j, &rows[j])).for_each(|(s, slope)| *s -= along * slope);
        }
        acceleration.clear();
        acceleration.extend(moving.iter().map(|&j| dot(part(jacobian, j, &rows[j]), &second[rows[j].clone()])));
        if acceleration.iter().any(|x| !x.is_finite()) {
            return true;
        }
        qr.solve_transposed(acceleration);
        let damped = Damped { qr, scale, damping: *damping };
        let right = acceleration.clone();
        damped.resolve_with_rhs(&right, acceleration, buffers);
        let size = |d: &[f64]| d.iter().zip(scale.iter()).map(|(d, s)| (d * s) * (d * s)).sum::<f64>().sqrt();
        if 2.0 * size(acceleration) > MAX_ACCELERATION_RATIO * size(step) {
            return true;
        }
        step.iter_mut().zip(acceleration.iter()).for_each(|(d, a)| *d += a);
        false
    }

    /// Evaluates the residuals where the step leads.
    fn try_step(&mut self, recorder: &mut Recorder<'_>) {
        let Self { problem, current, trial, moving, step, .. } = self;
        problem.retract(&current.x, moving, step, &mut trial.x);
        confine(&self.bounds, &mut trial.x);
        trial.sum_of_squares = recorder.evaluate(*problem, &trial.x, &mut trial.residuals);
    }

    /// Undamped (Gauss–Newton) steps as long as they bring the offset down: the sum of squares is rounding by now.
    fn refine(&mut self, recorder: &mut Recorder<'_>) -> StopReason {
        let smallest = self.current.sum_of_squares;
        for _ in 0..REFINEMENT_STEPS {
            let offset = self.offset();
            self.damping = 0.0;
            if offset == 0.0 || !self.damped_step().is_finite() || recorder.is_cancelled() {
                break;
            }
            self.try_step(recorder);
            if self.trial.sum_of_squares > smallest * (1.0 + ROUNDING) {
                break;
            }
            std::mem::swap(&mut self.current, &mut self.trial);
            if !self.linearise() || self.offset() > REFINEMENT_CONTRACTION * offset {
                std::mem::swap(&mut self.current, &mut self.trial);
                break;
            }
        }
        recorder.accept(&self.current.x, self.current.sum_of_squares, ROUNDING);
        StopReason::Converged
    }
}

/// Those rows of a column.
fn part<'m>(jacobian: &'m DMatrix<f64>, column: usize, rows: &Range<usize>) -> &'m [f64] {
    let first = column * jacobian.nrows();
    &jacobian.as_slice()[first + rows.start..first + rows.end]
}

/// Clamps to the box what rounding took out of it.
fn confine(bounds: &[(f64, f64)], x: &mut DVector<f64>) {
    for (value, (low, high)) in x.iter_mut().zip(bounds) {
        *value = value.clamp(*low, *high);
    }
}

#[cfg(test)]
mod tests {
    use crate::fit::local::bounded_lm::{BoundedLm, Limits};
    use crate::fit::local::recorder::Recorder;
    use crate::fit::local::solver::LIMITS;
    use crate::fit::{Effort, LeastSquares, Observer, StopReason, minimise};
    use nalgebra::{DMatrix, DVector, dvector};

    /// Rosenbrock's valley, 10(y − x²) and 1 − x, in a box.
    struct Valley {
        bounds: [(f64, f64); 2],
    }

    impl LeastSquares for Valley {
        fn residual_count(&self) -> usize {
            2
        }

        fn start(&self) -> DVector<f64> {
            dvector![-1.2, 1.0]
        }

        fn bounds_of(&self, unknown: usize) -> (f64, f64) {
            self.bounds[unknown]
        }

        fn residuals_at(&self, x: &DVector<f64>, out: &mut DVector<f64>) -> bool {
            out[0] = 10.0 * (x[1] - x[0] * x[0]);
            out[1] = 1.0 - x[0];
            true
        }

        fn jacobian_at(&self, x: &DVector<f64>, out: &mut DMatrix<f64>) -> bool {
            out.copy_from_slice(&[-20.0 * x[0], -1.0, 10.0, 0.0]);
            true
        }
    }

    const ANYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

    #[test]
    fn it_follows_a_curved_valley_to_the_minimum() {
        let found = minimise(&Valley { bounds: [ANYWHERE; 2] }, Effort::Polish, Observer::NONE);
        assert!((found.x - dvector![1.0, 1.0]).amax() < 1e-12, "{:?}", found.stop_reason);
        // A step takes two evaluations; without acceleration it would be thousands.
        assert!(found.evaluations < 100, "{}", found.evaluations);
    }

    #[test]
    fn it_ends_exactly_on_the_bound_that_stops_it() {
        let found = minimise(&Valley { bounds: [(-2.0, 0.5), ANYWHERE] }, Effort::Polish, Observer::NONE);
        // On x = ½ the valley floor is y = ¼, and 1 − x is left over.
        assert_eq!((found.x[0], found.stop_reason), (0.5, StopReason::Converged));
        assert!((found.x[1] - 0.25).abs() < 1e-9 && (found.sum_of_squares - 0.25).abs() < 1e-12);
    }

    #[test]
    fn a_start_outside_the_box_is_put_inside() {
        let found = minimise(&Valley { bounds: [(0.0, 2.0), (0.0, 2.0)] }, Effort::Polish, Observer::NONE);
        assert!((found.x - dvector![1.0, 1.0]).amax() < 1e-9);
    }

    /// A residual that falls as 1/x for ever, above a floor.
    struct Creep;

    impl LeastSquares for Creep {
        fn residual_count(&self) -> usize {
            2
        }

        fn start(&self) -> DVector<f64> {
            dvector![1.0]
        }

        fn bounds_of(&self, _unknown: usize) -> (f64, f64) {
            (1.0, f64::INFINITY)
        }

        fn residuals_at(&self, x: &DVector<f64>, out: &mut DVector<f64>) -> bool {
            out[0] = 1.0 / x[0];
            out[1] = 1.0;
            true
        }

        fn jacobian_at(&self, x: &DVector<f64>, out: &mut DMatrix<f64>) -> bool {
            out.copy_from_slice(&[-1.0 / (x[0] * x[0]), 0.0]);
            true
        }
    }

    #[test]
    fn a_target_out_of_reach_is_given_up_and_one_within_is_met() {
        let run = |target: f64| {
            let start = Creep.start();
            let mut recorder = Recorder::new(&start, Observer::NONE);
            let reason = BoundedLm::new(&Creep, &start).run(Limits { evaluations: 200, target, ..LIMITS }, &mut recorder);
            (reason, recorder.evaluations(), recorder.sum_of_squares())
        };
        let (reason, evaluations, _) = run(0.5);
        assert!(reason == StopReason::NoImprovement && evaluations < 100, "{reason:?} after {evaluations}");
        let (reason, evaluations, sum_of_squares) = run(1.0001);
        assert!(reason == StopReason::Converged && sum_of_squares <= 1.0001, "{reason:?} after {evaluations}: {sum_of_squares}");
    }
}
