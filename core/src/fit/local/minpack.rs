//! The crate `levenberg-marquardt` (MINPACK's lmder) on a problem in a box.
//!
//! Each unknown x in [a, b] becomes an angle φ with `x = a + (b − a) sin²φ`. The transform is smooth and maps onto the closed box,
//! and a step too long folds back instead of running away. An unknown without bounds is not transformed.

use crate::fit::least_squares::LeastSquares;
use crate::fit::local::recorder::Recorder;
use crate::fit::stop_reason::StopReason;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::cell::RefCell;
use std::f64::consts::FRAC_PI_2;

/// The fraction of the box that a start keeps from a bound, where dx/dφ vanishes and MINPACK would see no slope.
const START_MARGIN: f64 = 1e-3;
/// First step bound, relative to the scaled start. MINPACK's default of 100 overshoots from far starts.
const STEP_BOUND: f64 = 1.0;
/// Relative reduction of the sum of squares in a step below which progress counts as slow.
const TOLERANCE: f64 = 1e-5;

/// Minimises until progress is slow, for at most `patience` evaluations per unknown and one. Returns the best point, and why it
/// ended.
pub(crate) fn minpack_sin2<P: LeastSquares>(
    problem: &P,
    start: &DVector<f64>,
    patience: usize,
    recorder: &mut Recorder<'_>,
) -> (DVector<f64>, StopReason) {
    let boxes: Vec<(f64, f64)> = (0..start.len()).map(|j| problem.bounds_of(j)).collect();
    let angle = |j: usize| {
        let (low, high) = boxes[j];
        if !(high - low).is_finite() {
            return start[j];
        }
        let fraction = ((start[j] - low) / (high - low)).clamp(START_MARGIN, 1.0 - START_MARGIN);
        FRAC_PI_2 - libm::acos(fraction.sqrt())
    };
    let z = DVector::from_fn(start.len(), |j, _| angle(j));
    let adapter = Adapter { problem, boxes, z, best: RefCell::new((f64::INFINITY, start.clone())), recorder: RefCell::new(recorder) };
    let solver = LevenbergMarquardt::new().with_stepbound(STEP_BOUND).with_ftol(TOLERANCE).with_patience(patience);
    let (adapter, report) = solver.minimize(adapter);
    let reason = match report.termination {
        TerminationReason::Converged { .. } | TerminationReason::Orthogonal | TerminationReason::NoParameters => StopReason::Converged,
        TerminationReason::ResidualsZero => StopReason::ResidualsZero,
        TerminationReason::NoImprovementPossible(_) => StopReason::NoImprovement,
        TerminationReason::LostPatience => StopReason::EvaluationLimit,
        TerminationReason::User(_) => StopReason::Cancelled,
        TerminationReason::NoResiduals => StopReason::NoData,
        TerminationReason::Numerical(_) | TerminationReason::WrongDimensions(_) => StopReason::Numerical,
    };
    (adapter.best.into_inner().1, reason)
}

/// The problem in the angles φ.
struct Adapter<'a, 'r, 'o, P: LeastSquares> {
    problem: &'a P,
    boxes: Vec<(f64, f64)>,
    z: DVector<f64>,
    /// The best point and its sum of squares: the crate returns rejected points.
    best: RefCell<(f64, DVector<f64>)>,
    recorder: RefCell<&'r mut Recorder<'o>>,
}

impl<P: LeastSquares> Adapter<'_, '_, '_, P> {
    fn unknowns(&self) -> DVector<f64> {
        DVector::from_fn(self.z.len(), |j, _| {
            let (low, high) = self.boxes[j];
            if (high - low).is_finite() {
                let sin = libm::sin(self.z[j]);
                (low + (high - low) * sin * sin).clamp(low, high)
            } else {
                self.z[j].clamp(low, high)
            }
        })
    }
}

impl<P: LeastSquares> LeastSquaresProblem<f64, Dyn, Dyn> for Adapter<'_, '_, '_, P> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, z: &DVector<f64>) {
        self.z.copy_from(z);
    }

    fn params(&self) -> DVector<f64> {
        self.z.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let mut recorder = self.recorder.borrow_mut();
        if recorder.is_cancelled() {
            return None;
        }
        let mut residuals = DVector::zeros(self.problem.residual_count());
        let x = self.unknowns();
        let sum_of_squares = recorder.evaluate(self.problem, &x, &mut residuals);
        let mut best = self.best.borrow_mut();
        if !sum_of_squares.is_finite() {
            residuals.fill(f64::NAN);
        } else if sum_of_squares < best.0 {
            *best = (sum_of_squares, x);
        }
        Some(residuals)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let mut jacobian = DMatrix::zeros(self.problem.residual_count(), self.z.len());
        self.problem.jacobian_at(&self.unknowns(), &mut jacobian);
        for (j, &(low, high)) in self.boxes.iter().enumerate() {
            if (high - low).is_finite() {
                jacobian.column_mut(j).scale_mut((high - low) * libm::sin(2.0 * self.z[j]));
            }
        }
        Some(jacobian)
    }
}
