//! Unknowns in a box as angles without bounds: `x = a + (b − a) sin²φ` for x in [a, b].
//!
//! The map is smooth and onto the closed box, and a step too long folds back instead of running away. An unknown without bounds
//! stays itself.

use crate::fit::least_squares::LeastSquares;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::FRAC_PI_2;

/// The fraction of the box that a start keeps from a bound, where dx/dφ vanishes and MINPACK would see no slope.
const START_MARGIN: f64 = 1e-3;

/// The boxes of the unknowns.
pub(crate) struct SinSquared(Vec<(f64, f64)>);

impl SinSquared {
    pub(crate) fn new(problem: &impl LeastSquares, unknowns: usize) -> Self {
        Self((0..unknowns).map(|j| problem.bounds_of(j)).collect())
    }

    fn is_bounded(&self, j: usize) -> bool {
        let (low, high) = self.0[j];
        (high - low).is_finite()
    }

    /// φ of a start, a little inside the box.
    pub(crate) fn angles(&self, start: &DVector<f64>) -> DVector<f64> {
        let angle = |j: usize| {
            if !self.is_bounded(j) {
                return start[j];
            }
            let (low, high) = self.0[j];
            let fraction = ((start[j] - low) / (high - low)).clamp(START_MARGIN, 1.0 - START_MARGIN);
            FRAC_PI_2 - libm::acos(fraction.sqrt())
        };
        DVector::from_fn(start.len(), |j, _| angle(j))
    }

    /// The unknowns at φ.
    pub(crate) fn unknowns(&self, phi: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(phi.len(), |j, _| {
            let (low, high) = self.0[j];
            if self.is_bounded(j) {
                let sin = libm::sin(phi[j]);
                (low + (high - low) * sin * sin).clamp(low, high)
            } else {
                phi[j].clamp(low, high)
            }
        })
    }

    /// Turns derivatives by the unknowns into derivatives by φ.
    pub(crate) fn chain(&self, phi: &DVector<f64>, jacobian: &mut DMatrix<f64>) {
        for (j, &(low, high)) in self.0.iter().enumerate() {
            if self.is_bounded(j) {
                jacobian.column_mut(j).scale_mut((high - low) * libm::sin(2.0 * phi[j]));
            }
        }
    }
}
