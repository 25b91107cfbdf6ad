//! The crate `levenberg-marquardt` (MINPACK's lmder) on a problem in a box.
//!
//! The unknowns are the angles φ of [`SinSquared`].

use crate::fit::least_squares::LeastSquares;
use crate::fit::local::recorder::Recorder;
use crate::fit::local::sin_squared::SinSquared;
use crate::fit::stop_reason::StopReason;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::cell::RefCell;

/// First step bound, relative to the scaled start. MINPACK's default of 100 overshoots from far starts.
const STEP_BOUND: f64 = 1.0;

/// How far MINPACK goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MinpackLimits {
    /// Evaluations per unknown and one.
    pub patience: usize,
    /// Relative reduction of the sum of squares in a step below which progress counts as slow.
    pub tolerance: f64,
}

/// Minimises until progress is slow or the patience is at its end. Returns the best point, and why it
/// ended.
pub(crate) fn minpack_sin2<P: LeastSquares>(
    problem: &P,
    start: &DVector<f64>,
    limits: MinpackLimits,
    recorder: &mut Recorder<'_>,
) -> (DVector<f64>, StopReason) {
    let boxes = SinSquared::new(problem, start.len());
    let z = boxes.angles(start);
    let adapter = Adapter { problem, boxes, z, best: RefCell::new((f64::INFINITY, start.clone())), recorder: RefCell::new(recorder) };
    let solver = LevenbergMarquardt::new().with_stepbound(STEP_BOUND).with_ftol(limits.tolerance).with_patience(limits.patience);
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
    boxes: SinSquared,
    z: DVector<f64>,
    /// The best point and its sum of squares: the crate returns rejected points.
    best: RefCell<(f64, DVector<f64>)>,
    recorder: RefCell<&'r mut Recorder<'o>>,
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
        let x = self.boxes.unknowns(&self.z);
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
        self.problem.jacobian_at(&self.boxes.unknowns(&self.z), &mut jacobian);
        self.boxes.chain(&self.z, &mut jacobian);
        Some(jacobian)
    }
}
