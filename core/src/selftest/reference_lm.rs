//! The yardstick of the fits: MINPACK's Levenberg–Marquardt (the crate `levenberg-marquardt`) on angles φ with
//! `p = low + (high − low) sin²φ`, which keep a parameter in its box.
//!
//! Its Jacobian is that of the core or made of forward differences, and it works with or without MINPACK's scaling by the columns of the
//! Jacobian.

use crate::fit::Problem;
use crate::model::Parameters;
use crate::selftest::solver_benchmark::{Task, Trace};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::cell::RefCell;

/// Evaluations that it is allowed per parameter and one.
const PATIENCE: usize = 100;
/// The fraction of the box that a start keeps from an edge, where the slope by φ vanishes.
const MARGIN: f64 = 1e-3;
/// TraceStep of a forward difference, √ε, relative to φ or to this.
const DIFFERENCE: f64 = 1.490_116_119_384_765_6e-8;
const SMALLEST_ANGLE: f64 = 1e-2;

/// Runs it from the problem's start; what it finds goes into the log.
pub(crate) fn levenberg_marquardt(task: &Task<'_>, analytic: bool, scaled: bool, log: &RefCell<Trace<'_>>) {
    let adapter = Adapter { task, phi: angles(task.problem), analytic, log };
    let solver = LevenbergMarquardt::new().with_patience(PATIENCE).with_scale_diag(scaled);
    _ = solver.minimize(adapter);
}

/// The problem as MINPACK's solver takes it.
struct Adapter<'a, 'b> {
    task: &'a Task<'a>,
    phi: DVector<f64>,
    analytic: bool,
    log: &'a RefCell<Trace<'b>>,
}

/// φ of a problem's start, a little inside the box.
fn angles(problem: &Problem) -> DVector<f64> {
    let free = problem.free();
    DVector::from_fn(free.len(), |j, _| {
        let (low, high) = problem.bounds().of(free[j]);
        let fraction = (Problem::start(problem)[free[j]] - low) / (high - low);
        std::f64::consts::FRAC_PI_2 - libm::acos(fraction.clamp(MARGIN, 1.0 - MARGIN).sqrt())
    })
}

impl Adapter<'_, '_> {
    fn parameters(&self, phi: &DVector<f64>) -> Parameters {
        let problem = self.task.problem;
        let mut parameters = *Problem::start(problem);
        for (&parameter, phi) in problem.free().iter().zip(phi.iter()) {
            let (low, high) = problem.bounds().of(parameter);
            let sin = libm::sin(*phi);
            parameters[parameter] = problem.bounds().clamp(parameter, low + (high - low) * sin * sin);
        }
        parameters
    }

    fn residuals_of(&self, phi: &DVector<f64>) -> DVector<f64> {
        let mut residuals = DVector::zeros(self.task.problem.len());
        if !self.task.problem.residuals(&self.parameters(phi), &mut residuals) {
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
        self.log.borrow_mut().note(self.task.problem, self.parameters(&self.phi), &residuals);
        Some(residuals)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        if !self.analytic {
            return Some(self.differences());
        }
        let problem = self.task.problem;
        let mut jacobian = DMatrix::zeros(problem.len(), self.phi.len());
        problem.jacobian(&self.parameters(&self.phi), &mut jacobian);
        for (j, &parameter) in problem.free().iter().enumerate() {
            let (low, high) = problem.bounds().of(parameter);
            jacobian.column_mut(j).scale_mut((high - low) * libm::sin(2.0 * self.phi[j]));
        }
        Some(jacobian)
    }
}

#[cfg(test)]
mod tests {
    use super::{Adapter, DIFFERENCE, angles};
    use crate::model::{Parameters, Preset};
    use crate::selftest::solver_benchmark::{Run, Task, Trace, problem, simulate};
    use levenberg_marquardt::LeastSquaresProblem as _;
    use std::cell::RefCell;

    #[test]
    fn both_jacobians_agree() {
        let preset = Preset::from_key("gauss").expect("a preset");
        let problem = problem(preset, &simulate(preset, true, 0.0), Parameters::default()).expect("a problem");
        let task = Task { problem: &problem, truth: None };
        let log = RefCell::new(Trace { clock: &|| 0.0, truth: None, run: Run::begun(&problem) });
        let adapter = |analytic| Adapter { task: &task, phi: angles(&problem), analytic, log: &log };
        let (analytic, differences) = (adapter(true).jacobian().expect("a matrix"), adapter(false).jacobian().expect("a matrix"));
        // Forward differences are good to √ε times the curvature.
        let bar = 100.0 * DIFFERENCE * analytic.amax();
        assert!((&analytic - &differences).amax() < bar, "{analytic} {differences}");
    }
}
