//! The reference solver of the benchmarks: MINPACK's Levenberg–Marquardt (the crate `levenberg-marquardt`) on angles φ with
//! `p = low + (high − low) sin²φ`, which keep a parameter in its box.
//!
//! Its Jacobian is that of the core or made of forward differences, and it works with or without MINPACK's scaling by the columns of the
//! Jacobian.

use crate::fit::{LeastSquares, SinSquared};
use crate::selftest::benchmark_run::{Task, Trace};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::cell::RefCell;

/// Evaluations that it is allowed per parameter and one.
const PATIENCE: usize = 100;
/// Step of a forward difference, √ε, relative to φ or to this.
const DIFFERENCE: f64 = 1.490_116_119_384_765_6e-8;
const SMALLEST_ANGLE: f64 = 1e-2;

/// Runs it from the problem's start; what it finds goes into the log.
pub(crate) fn levenberg_marquardt(task: &Task<'_>, analytic: bool, scaled: bool, log: &RefCell<Trace<'_>>) {
    let adapter = Adapter::new(task, analytic, log);
    let solver = LevenbergMarquardt::new().with_patience(PATIENCE).with_scale_diag(scaled);
    _ = solver.minimize(adapter);
}

/// The problem as MINPACK's solver takes it.
struct Adapter<'a, 'b> {
    task: &'a Task<'a>,
    boxes: SinSquared,
    phi: DVector<f64>,
    analytic: bool,
    log: &'a RefCell<Trace<'b>>,
}

impl<'a, 'b> Adapter<'a, 'b> {
    fn new(task: &'a Task<'a>, analytic: bool, log: &'a RefCell<Trace<'b>>) -> Self {
        let start = LeastSquares::start(task.problem);
        let boxes = SinSquared::new(task.problem, start.len());
        Self { task, phi: boxes.angles(&start), boxes, analytic, log }
    }

    fn residuals_of(&self, phi: &DVector<f64>) -> DVector<f64> {
        let mut residuals = DVector::zeros(self.task.problem.len());
        if !self.task.problem.residuals_at(&self.boxes.unknowns(phi), &mut residuals) {
            residuals.fill(f64::NAN);
        }
        residuals
    }

    /// Forward differences.
    fn differences(&self) -> DMatrix<f64> {
        let here = self.residuals_of(&self.phi);
        let mut jacobian = DMatrix::zeros(here.len(), self.phi.len());
        for j in 0..self.phi.len() {
            let mut moved = self.phi.clone();
            moved[j] += DIFFERENCE * moved[j].abs().max(SMALLEST_ANGLE);
            let step = moved[j] - self.phi[j];
            jacobian.set_column(j, &((self.residuals_of(&moved) - &here) / step));
        }
        jacobian
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Adapter<'_, '_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, phi: &DVector<f64>) {
        self.phi.copy_from(phi);
    }

    fn params(&self) -> DVector<f64> {
        self.phi.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let residuals = self.residuals_of(&self.phi);
        let parameters = self.task.problem.parameters_at(&self.boxes.unknowns(&self.phi));
        self.log.borrow_mut().note(self.task.problem, parameters, &residuals);
        Some(residuals)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        if !self.analytic {
            return Some(self.differences());
        }
        let problem = self.task.problem;
        let mut jacobian = DMatrix::zeros(problem.len(), self.phi.len());
        problem.jacobian_at(&self.boxes.unknowns(&self.phi), &mut jacobian);
        self.boxes.chain(&self.phi, &mut jacobian);
        Some(jacobian)
    }
}

#[cfg(test)]
mod tests {
    use super::{Adapter, DIFFERENCE};
    use crate::model::{Parameters, Preset};
    use crate::selftest::benchmark_problem::{problem, simulate};
    use crate::selftest::benchmark_run::{BenchmarkRun, Task, Trace};
    use levenberg_marquardt::LeastSquaresProblem as _;
    use std::cell::RefCell;

    #[test]
    fn both_jacobians_agree() {
        let preset = Preset::from_key("gauss").expect("a preset");
        let problem = problem(preset, &simulate(preset, true, 0.0), Parameters::default()).expect("a problem");
        let task = Task { problem: &problem, truth: None };
        let log = RefCell::new(Trace { clock: &|| 0.0, truth: None, run: BenchmarkRun::begun(&problem) });
        let adapter = |analytic| Adapter::new(&task, analytic, &log);
        let (analytic, differences) = (adapter(true).jacobian().expect("a matrix"), adapter(false).jacobian().expect("a matrix"));
        // Forward differences are good to √ε times the curvature.
        let bar = 100.0 * DIFFERENCE * analytic.amax();
        assert!((&analytic - &differences).amax() < bar, "{analytic} {differences}");
    }
}
