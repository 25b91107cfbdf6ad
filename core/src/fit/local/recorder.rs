//! Records the best point and the trace of a descent, whichever solver evaluates.

use crate::fit::least_squares::LeastSquares;
use crate::fit::local::solution::Solution;
use crate::fit::observer::{Observer, TracePoint};
use crate::fit::stop_reason::StopReason;
use nalgebra::DVector;

/// The best point, the number of evaluations and the trace. The crate `levenberg-marquardt` itself returns rejected points.
pub(crate) struct Recorder<'a> {
    observer: Observer<'a>,
    best: DVector<f64>,
    sum_of_squares: f64,
    evaluations: usize,
    trace: Vec<TracePoint>,
    path: Vec<DVector<f64>>,
}

impl<'a> Recorder<'a> {
    pub(crate) fn new(start: &DVector<f64>, observer: Observer<'a>) -> Self {
        Self { observer, best: start.clone(), sum_of_squares: f64::INFINITY, evaluations: 0, trace: Vec::new(), path: Vec::new() }
    }

    /// Residual evaluations so far.
    pub(crate) fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// The best point so far; the start before any evaluation.
    pub(crate) fn best(&self) -> &DVector<f64> {
        &self.best
    }

    /// Sum of squares at the best point; infinite before any finite one.
    pub(crate) fn sum_of_squares(&self) -> f64 {
        self.sum_of_squares
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        (self.observer.cancelled)()
    }

    /// Writes the residuals at x and returns the sum of their squares, infinite if one is not finite. Records the point if it is
    /// the best so far.
    pub(crate) fn evaluate<P: LeastSquares>(&mut self, problem: &P, x: &DVector<f64>, residuals: &mut DVector<f64>) -> f64 {
        self.evaluations += 1;
        if !problem.residuals_at(x, residuals) {
            return f64::INFINITY;
        }
        let sum_of_squares = residuals.norm_squared();
        if !sum_of_squares.is_finite() {
            return f64::INFINITY;
        }
        if sum_of_squares < self.sum_of_squares {
            self.sum_of_squares = sum_of_squares;
            self.best.copy_from(x);
            let objective = problem.objective_at(sum_of_squares, x);
            let point = TracePoint { elapsed_ms: (self.observer.clock)(), evaluations: self.evaluations, objective };
            self.trace.push(point);
            self.path.push(x.clone());
            (self.observer.progress)(point);
        }
        sum_of_squares
    }

    /// Accepts an evaluated point as the best one if its sum of squares exceeds the smallest by no more than that fraction.
    pub(crate) fn accept(&mut self, x: &DVector<f64>, sum_of_squares: f64, fraction: f64) {
        if sum_of_squares > self.sum_of_squares * (1.0 + fraction) {
            return;
        }
        self.best.copy_from(x);
        self.sum_of_squares = sum_of_squares;
    }

    pub(crate) fn into_solution(self, stop_reason: StopReason) -> Solution {
        let Self { best, sum_of_squares, evaluations, trace, path, .. } = self;
        Solution { x: best, sum_of_squares, stop_reason, evaluations, trace, path }
    }
}
