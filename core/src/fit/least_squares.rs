//! What the solver solves: a sum of squared residuals of some unknowns in a box.

use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// A sum of squares to be minimised over a box, `Σ rᵢ(x)²` with low ≤ x ≤ high.
///
/// A problem may know that its sum of squares has curved valleys. It then offers *local coordinates* at a point x in which they are
/// straight: `to_local`, `local_bounds` and `retract` (a retraction of manifold optimisation) describe a step in them. They concern
/// the moving unknowns alone; the others are held, most of them on a bound.
pub trait LeastSquares {
    /// Number of residuals.
    fn residual_count(&self) -> usize;

    /// The start; its length is the number of unknowns.
    fn start(&self) -> DVector<f64>;

    /// Lower and upper bound of an unknown; infinite where there is none.
    fn bounds_of(&self, unknown: usize) -> (f64, f64);

    /// Writes the residuals; false where one is not a finite number.
    fn residuals_at(&self, x: &DVector<f64>, out: &mut DVector<f64>) -> bool;

    /// Writes the derivatives of the residuals (rows) by the unknowns (columns); false where one is not a finite number.
    fn jacobian_at(&self, x: &DVector<f64>, out: &mut DMatrix<f64>) -> bool;

    /// The residuals that an unknown has a part in; by default all of them. In the other rows its column of the Jacobian is 0.
    ///
    /// Unknowns with equal parts stand side by side, those with a part in all residuals last.
    fn rows_of(&self, _unknown: usize) -> Range<usize> {
        0..self.residual_count()
    }

    /// The objective that a trace shows: by default the sum of squares itself.
    fn objective_at(&self, sum_of_squares: f64, _x: &DVector<f64>) -> f64 {
        sum_of_squares
    }

    /// Sum of squares below which residuals are rounding.
    fn negligible(&self) -> f64 {
        0.0
    }

    /// Turns the derivatives by the moving unknowns into those by their local coordinates at x.
    fn to_local(&self, _x: &DVector<f64>, _moving: &[usize], _jacobian: &mut DMatrix<f64>) {}

    /// The least and the largest step of a moving unknown's local coordinate at x that stay in the box.
    fn local_bounds(&self, x: &DVector<f64>, unknown: usize) -> (f64, f64) {
        let (low, high) = self.bounds_of(unknown);
        (low - x[unknown], high - x[unknown])
    }

    /// The coordinate of an unknown by itself in which steps are even, such as a logarithm; by default the unknown itself.
    fn straight(&self, _unknown: usize, value: f64) -> f64 {
        value
    }

    /// The value of an unknown, given its [`Self::straight`] coordinate.
    fn at_straight(&self, _unknown: usize, coordinate: f64) -> f64 {
        coordinate
    }

    /// Writes the point that a step in the local coordinates leads to from x.
    fn retract(&self, x: &DVector<f64>, moving: &[usize], step: &[f64], out: &mut DVector<f64>) {
        out.copy_from(x);
        for (&unknown, step) in moving.iter().zip(step) {
            out[unknown] += step;
        }
    }
}
