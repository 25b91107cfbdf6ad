//! A least squares problem with one unknown held: the inner problem of a profile.

use crate::fit::least_squares::LeastSquares;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// The problem with the box of one unknown shrunk to a point. The solver never moves it, and the others keep their places.
pub(crate) struct Held<'a, P> {
    pub problem: &'a P,
    pub unknown: usize,
    pub value: f64,
    /// Sum of squares below which residuals are rounding.
    pub negligible: f64,
}

impl<P: LeastSquares> LeastSquares for Held<'_, P> {
    fn residual_count(&self) -> usize {
        self.problem.residual_count()
    }

    fn start(&self) -> DVector<f64> {
        let mut start = self.problem.start();
        start[self.unknown] = self.value;
        start
    }

    fn bounds_of(&self, unknown: usize) -> (f64, f64) {
        if unknown == self.unknown { (self.value, self.value) } else { self.problem.bounds_of(unknown) }
    }

    fn rows_of(&self, unknown: usize) -> Range<usize> {
        self.problem.rows_of(unknown)
    }

    fn residuals_at(&self, x: &DVector<f64>, out: &mut DVector<f64>) -> bool {
        self.problem.residuals_at(x, out)
    }

    fn jacobian_at(&self, x: &DVector<f64>, out: &mut DMatrix<f64>) -> bool {
        self.problem.jacobian_at(x, out)
    }

    fn negligible(&self) -> f64 {
        self.negligible
    }

    fn to_local(&self, x: &DVector<f64>, moving: &[usize], jacobian: &mut DMatrix<f64>) {
        self.problem.to_local(x, moving, jacobian);
    }

    fn local_bounds(&self, x: &DVector<f64>, unknown: usize) -> (f64, f64) {
        if unknown == self.unknown { (0.0, 0.0) } else { self.problem.local_bounds(x, unknown) }
    }

    fn retract(&self, x: &DVector<f64>, moving: &[usize], step: &[f64], out: &mut DVector<f64>) {
        self.problem.retract(x, moving, step, out);
    }
}
