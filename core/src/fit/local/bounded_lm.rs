//! Levenberg–Marquardt in a box with geodesic acceleration.
//!
//! Each step minimises `‖J d + r‖² + λ ‖D d‖²` over the steps that stay in the box; unknowns that rest on an edge with the objective falling
//! outwards do not move. D holds the norms of the columns of J. Where the straight step d meets the curvature of the residuals, half of
//! their second derivative along d is fitted away too (Transtrum and Sethna, arXiv:1201.5885): in a curved valley such a step follows the
//! geodesic_acceleration, and goes several times as far.
//!
//! It ends where the undamped linear problem promises no further fall: `‖Qᵀ r‖² ≤ ε ‖r‖²`, the relative offset of Bates and Watts
//! (Technometrics 23, 179 (1981)), which knows no unit.

use crate::fit::least_squares::LeastSquares;
use crate::fit::local::qr::{Damped, Qr, Workspace};
use crate::fit::local::solver::{Recorder, StopReason};
use nalgebra::{DMatrix, DVector};

/// Relative offset, squared, at which the minimum is reached for every purpose of the objective.
const GRADIENT_TOLERANCE: f64 = 1e-12;
/// Steps at the end that sharpen the unknowns, not the objective, which is down to rounding by then.
const SHARPENING: usize = 40;
/// Each must make the relative offset, squared, smaller by this factor.
const SHARPER: f64 = 0.7;
/// What rounding may add to the sum of squares, as a fraction.
const ROUNDING: f64 = 1e-11;
/// First damping.
const FIRST_DAMPING: f64 = 1e-2;
/// Damping beyond which steps are lost in rounding, and below which there is none.
const MOST_DAMPING: f64 = 1e16;
const LEAST_DAMPING: f64 = 1e-18;
/// Part of a step at which the curvature along it is measured.
const PROBE: f64 = 0.1;
/// The acceleration may be this fraction of the step; beyond, the step is too long for its curvature.
const MAX_ACCELERATION_RATIO: f64 = 0.75;
/// An unknown that could not change the residuals by more than this fraction of their size if it crossed its whole box is idle: what its
/// column says is rounding.
const INSENSITIVE: f64 = 1e-10;
/// Promised relative falls below this are too small to measure a curvature by.
const STRAIGHT: f64 = 1e-8;

/// How far a walk goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Steps taken.
    pub steps: usize,
    /// Residual evaluations.
    pub evaluations: usize,
    /// Whether the unknowns are sharpened at the end.
    pub sharpen: bool,
}

/// A point with what is known there.
struct Point {
    x: DVector<f64>,
    residuals: DVector<f64>,
    sum_of_squares: f64,
}

/// A walk through a problem, with its buffers.
pub(crate) struct BoundedLm<'a, P: LeastSquares> {
    problem: &'a P,
    here: Point,
    there: Point,
    jacobian: DMatrix<f64>,
    moving: Vec<usize>,
    scale: Vec<f64>,
    qr: Qr,
    /// Qᵀ r.
    rotated: Vec<f64>,
    ends: Vec<(f64, f64)>,
    step: Vec<f64>,
    acceleration: Vec<f64>,
    space: Workspace,
    damping: f64,
    bounds: Vec<(f64, f64)>,
}

/// What came of trying to leave a point.
enum Try {
    Better,
    Stalled,
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
            here: point(inside.clone()),
            there: point(inside),
            jacobian: DMatrix::zeros(m, n),
            moving: Vec::with_capacity(n),
            scale: Vec::with_capacity(n),
            qr: Qr::default(),
            rotated: Vec::with_capacity(m.max(n)),
            ends: Vec::with_capacity(n),
            step: Vec::with_capacity(n),
            acceleration: Vec::with_capacity(n),
            space: Workspace::default(),
            damping: FIRST_DAMPING,
            bounds,
        }
    }

    /// Goes on until it is there, or cannot.
    pub(crate) fn run(&mut self, limits: Limits, log: &mut Recorder<'_>) -> StopReason {
        self.here.sum_of_squares = log.evaluate(self.problem, &self.here.x, &mut self.here.residuals);
        if log.is_cancelled() {
            return StopReason::Cancelled;
        }
        if !self.here.sum_of_squares.is_finite() {
            return StopReason::Numerical;
        }
        let last = log.evaluations().saturating_add(limits.evaluations);
        for _ in 0..limits.steps {
            if self.here.sum_of_squares <= self.problem.negligible() {
                return StopReason::ResidualsZero;
            }
            if !self.linearise() {
                return StopReason::Numerical;
            }
            let offset = self.offset();
            if offset <= GRADIENT_TOLERANCE * self.here.sum_of_squares {
                if limits.sharpen {
                    return self.sharpen(log);
                }
                return StopReason::Converged;
            }
            match self.advance(last, log) {
                Try::Better => {}
                Try::Stalled => return StopReason::NoImprovement,
                Try::Stopped(reason) => return reason,
            }
        }
        StopReason::EvaluationLimit
    }

    /// Derivatives, moving unknowns and factorisation where it is.
    fn linearise(&mut self) -> bool {
        let Self { problem, here, jacobian, moving, scale, qr, rotated, ends, .. } = self;
        if !problem.jacobian_at(&here.x, jacobian) {
            return false;
        }
        let bounds = &self.bounds;
        moving.clear();
        moving.extend((0..here.x.len()).filter(|&j| {
            let (low, high) = bounds[j];
            let (at_low, at_high) = (here.x[j] <= low, here.x[j] >= high);
            if !at_low && !at_high {
                return true;
            }
            let slope = jacobian.column(j).dot(&here.residuals);
            !((at_low && slope >= 0.0) || (at_high && slope <= 0.0))
        }));
        problem.to_local(&here.x, moving, jacobian);
        let idle = INSENSITIVE * here.residuals.norm();
        moving.retain(|&j| {
            let (low, high) = problem.local_bounds(&here.x, j);
            jacobian.column(j).norm() * (high - low) > idle
        });
        let m = jacobian.nrows();
        qr.factorise(m, moving.len(), |a| {
            let rows = m.max(moving.len());
            for (column, &j) in a.chunks_exact_mut(rows).zip(moving.iter()) {
                column[..m].copy_from_slice(&jacobian.as_slice()[j * m..(j + 1) * m]);
            }
        });
        scale.clear();
        scale.extend(moving.iter().map(|&j| jacobian.column(j).norm().max(f64::MIN_POSITIVE)));
        ends.clear();
        ends.extend(moving.iter().map(|&j| problem.local_bounds(&here.x, j)));
        rotated.clear();
        rotated.extend_from_slice(here.residuals.as_slice());
        rotated.resize(qr.rows(), 0.0);
        qr.transposed_times(rotated);
        true
    }

    /// The fall that the undamped linear problem promises.
    fn offset(&self) -> f64 {
        self.rotated[..self.moving.len()].iter().map(|c| c * c).sum()
    }

    /// Takes a step that makes the sum of squares smaller.
    fn advance(&mut self, last: usize, log: &mut Recorder<'_>) -> Try {
        let mut growth = 2.0;
        while self.damping < MOST_DAMPING {
            if log.is_cancelled() {
                return Try::Stopped(StopReason::Cancelled);
            }
            if log.evaluations() >= last {
                return Try::Stopped(StopReason::EvaluationLimit);
            }
            let promised = self.damped_step();
            if promised.is_nan() || promised <= f64::EPSILON * self.here.sum_of_squares {
                return Try::Stalled;
            }
            let bent = promised > STRAIGHT * self.here.sum_of_squares && self.geodesic_acceleration(log);
            if !bent {
                self.try_step(log);
                let ratio = (self.here.sum_of_squares - self.there.sum_of_squares) / promised;
                if ratio > 0.0 {
                    std::mem::swap(&mut self.here, &mut self.there);
                    let x = 2.0 * ratio - 1.0;
                    self.damping = (self.damping * (1.0 - x * x * x).clamp(0.1, 2.0)).max(LEAST_DAMPING);
                    return Try::Better;
                }
            }
            self.damping *= growth;
            growth *= 2.0;
        }
        Try::Stalled
    }

    /// The damped step; what it promises.
    fn damped_step(&mut self) -> f64 {
        let Self { qr, scale, damping, rotated, ends, step, space, moving, .. } = self;
        step.clear();
        step.resize(moving.len(), 0.0);
        let damped = Damped { qr, scale, damping: *damping };
        damped.solve_within(rotated, ends, step, space);
        damped.reduction(rotated, step)
    }

    /// Adds the acceleration to the step; true if the step is too long for it.
    fn geodesic_acceleration(&mut self, log: &mut Recorder<'_>) -> bool {
        let Self { problem, here, there, jacobian, moving, scale, qr, step, acceleration, space, damping, .. } = self;
        acceleration.clear();
        acceleration.extend(step.iter().map(|d| PROBE * d));
        problem.retract(&here.x, moving, acceleration, &mut there.x);
        confine(&self.bounds, &mut there.x);
        log.evaluate(*problem, &there.x, &mut there.residuals);
        let mut second: Vec<f64> = (0..here.residuals.len())
            .map(|i| {
                let along: f64 = moving.iter().zip(step.iter()).map(|(&j, d)| jacobian[(i, j)] * d).sum();
                // Half of the second derivative.
                ((there.residuals[i] - here.residuals[i]) / PROBE - along) / PROBE
            })
            .collect();
        if second.iter().any(|x| !x.is_finite()) {
            return true;
        }
        second.resize(qr.rows(), 0.0);
        qr.transposed_times(&mut second);
        let damped = Damped { qr, scale, damping: *damping };
        damped.resolve_with_rhs(&second, acceleration, space);
        let size = |d: &[f64]| d.iter().zip(scale.iter()).map(|(d, s)| (d * s) * (d * s)).sum::<f64>().sqrt();
        if 2.0 * size(acceleration) > MAX_ACCELERATION_RATIO * size(step) {
            return true;
        }
        step.iter_mut().zip(acceleration.iter()).for_each(|(d, a)| *d += a);
        false
    }

    fn try_step(&mut self, log: &mut Recorder<'_>) {
        let Self { problem, here, there, moving, step, .. } = self;
        problem.retract(&here.x, moving, step, &mut there.x);
        confine(&self.bounds, &mut there.x);
        there.sum_of_squares = log.evaluate(*problem, &there.x, &mut there.residuals);
    }

    /// Undamped steps as long as they bring the offset down: the sum of squares no longer tells.
    fn sharpen(&mut self, log: &mut Recorder<'_>) -> StopReason {
        let smallest = self.here.sum_of_squares;
        for _ in 0..SHARPENING {
            let offset = self.offset();
            self.damping = 0.0;
            if offset == 0.0 || !self.damped_step().is_finite() || log.is_cancelled() {
                break;
            }
            self.try_step(log);
            if self.there.sum_of_squares > smallest * (1.0 + ROUNDING) {
                break;
            }
            std::mem::swap(&mut self.here, &mut self.there);
            if !self.linearise() || self.offset() > SHARPER * offset {
                std::mem::swap(&mut self.here, &mut self.there);
                break;
            }
        }
        log.settle(&self.here.x, self.here.sum_of_squares, ROUNDING);
        StopReason::Converged
    }
}

/// Puts what strayed by rounding back into the box.
fn confine(bounds: &[(f64, f64)], x: &mut DVector<f64>) {
    for (value, (low, high)) in x.iter_mut().zip(bounds) {
        *value = value.clamp(*low, *high);
    }
}

#[cfg(test)]
mod tests {
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
    fn it_follows_a_curved_valley_to_its_end() {
        let found = minimise(&Valley { bounds: [ANYWHERE; 2] }, Effort::Finish, Observer::NONE);
        assert!((found.x - dvector![1.0, 1.0]).amax() < 1e-12, "{:?}", found.stop_reason);
        // A step takes two evaluations; without a way of following the bend it would be thousands.
        assert!(found.evaluations < 100, "{}", found.evaluations);
    }

    #[test]
    fn it_ends_exactly_on_the_edge_that_stops_it() {
        let found = minimise(&Valley { bounds: [(-2.0, 0.5), ANYWHERE] }, Effort::Finish, Observer::NONE);
        // On x = ½ the valley floor is y = ¼, and 1 − x is left over.
        assert_eq!((found.x[0], found.stop_reason), (0.5, StopReason::Converged));
        assert!((found.x[1] - 0.25).abs() < 1e-9 && (found.sum_of_squares - 0.25).abs() < 1e-12);
    }

    #[test]
    fn a_start_outside_the_box_is_put_inside() {
        let found = minimise(&Valley { bounds: [(0.0, 2.0), (0.0, 2.0)] }, Effort::Finish, Observer::NONE);
        assert!((found.x - dvector![1.0, 1.0]).amax() < 1e-9);
    }
}
