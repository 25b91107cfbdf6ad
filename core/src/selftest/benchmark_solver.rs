//! The solvers that benchmarks compare: the reference Levenberg–Marquardt and this program.

use crate::fit::{Effort, LeastSquares, Observer, Problem, Starts, fit, minimise};
use crate::selftest::Host;
use crate::selftest::benchmark_problem::{SEED, objective};
use crate::selftest::benchmark_run::{BenchmarkRun, BenchmarkSize, Task, Trace, typical};
use crate::selftest::method::BenchmarkMethod;
use crate::selftest::reference_lm::levenberg_marquardt;
use nalgebra::{DMatrix, DVector};
use std::cell::RefCell;

/// How a problem is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Solver {
    /// The yardstick from one start.
    Marquardt { analytic: bool, scaled: bool },
    /// This program from one start.
    One,
    /// This program from the starts of its own choice.
    Many,
}

/// All solvers, in the order of the report.
pub(crate) const SOLVERS: [Solver; 6] = [
    Solver::Marquardt { analytic: false, scaled: false },
    Solver::Marquardt { analytic: false, scaled: true },
    Solver::Marquardt { analytic: true, scaled: false },
    Solver::Marquardt { analytic: true, scaled: true },
    Solver::One,
    Solver::Many,
];

impl Solver {
    /// Its name in the report, where so many starts are taken one after the other.
    pub(crate) fn named(self, starts: u32) -> BenchmarkMethod {
        match self {
            Self::Marquardt { analytic, scaled } => BenchmarkMethod::LevenbergMarquardt { analytic, scaled, starts },
            Self::One => BenchmarkMethod::OneStart,
            Self::Many => BenchmarkMethod::ManyStarts,
        }
    }

    fn repetitions(self, extent: BenchmarkSize) -> usize {
        if self == Self::Many { extent.repetitions_of_many } else { extent.repetitions }
    }

    /// Runs it as often as it is to be repeated.
    pub(crate) fn repeated(self, task: &Task<'_>, extent: BenchmarkSize, host: Host<'_>) -> BenchmarkRun {
        let repetitions = self.repetitions(extent);
        if repetitions > 1 && self != Self::Many {
            // Warms caches and branches up; a fit from many starts is long enough to do so itself.
            _ = self.run(task, host);
        }
        typical(&(0..repetitions).map(|_| self.run(task, host)).collect::<Vec<_>>())
    }

    pub(crate) fn run(self, task: &Task<'_>, host: Host<'_>) -> BenchmarkRun {
        let begun = (host.clock)();
        let clock = || (host.clock)() - begun;
        let log = RefCell::new(Trace { clock: &clock, truth: task.truth, run: BenchmarkRun::begun(task.problem) });
        match self {
            Self::Marquardt { analytic, scaled } => {
                levenberg_marquardt(task, analytic, scaled, &log);
            }
            Self::One => {
                let watch = Observer { clock: &|| 0.0, cancelled: host.cancelled, progress: &|_| {} };
                _ = minimise(&Recorded { problem: task.problem, log: &log }, Effort::Thorough, watch);
            }
            Self::Many => {
                let clock = host.clock;
                let watch = Observer { clock: &|| clock() - begun, cancelled: host.cancelled, progress: &|_| {} };
                let report = fit(task.problem, Starts::Automatic, SEED, watch);
                let mut log = log.borrow_mut();
                log.run.steps = report.course.trace.iter().map(|point| [point.elapsed_ms, point.objective, f64::NAN]).collect();
                log.run.parameters = report.parameters;
                log.run.objective = objective(task.problem, &report.parameters);
            }
        }
        let elapsed_ms = clock();
        let run = log.borrow().run.clone();
        BenchmarkRun { elapsed_ms, ..run }
    }
}

/// The program's own problem, its evaluations noted.
struct Recorded<'a, 'b> {
    problem: &'a Problem,
    log: &'a RefCell<Trace<'b>>,
}

impl LeastSquares for Recorded<'_, '_> {
    fn residual_count(&self) -> usize {
        self.problem.residual_count()
    }

    fn start(&self) -> DVector<f64> {
        LeastSquares::start(self.problem)
    }

    fn bounds_of(&self, unknown: usize) -> (f64, f64) {
        self.problem.bounds_of(unknown)
    }

    fn residuals_at(&self, x: &DVector<f64>, out: &mut DVector<f64>) -> bool {
        let is_finite = self.problem.residuals_at(x, out);
        if is_finite {
            self.log.borrow_mut().note(self.problem, self.problem.parameters_at(x), out);
        }
        is_finite
    }

    fn jacobian_at(&self, x: &DVector<f64>, out: &mut DMatrix<f64>) -> bool {
        self.problem.jacobian_at(x, out)
    }

    fn objective_at(&self, sum_of_squares: f64, x: &DVector<f64>) -> f64 {
        self.problem.objective_at(sum_of_squares, x)
    }

    fn negligible(&self) -> f64 {
        self.problem.negligible()
    }

    fn to_local(&self, x: &DVector<f64>, moving: &[usize], jacobian: &mut DMatrix<f64>) {
        self.problem.to_local(x, moving, jacobian);
    }

    fn local_bounds(&self, x: &DVector<f64>, unknown: usize) -> (f64, f64) {
        self.problem.local_bounds(x, unknown)
    }

    fn retract(&self, x: &DVector<f64>, moving: &[usize], step: &[f64], out: &mut DVector<f64>) {
        self.problem.retract(x, moving, step, out);
    }
}

#[cfg(test)]
mod tests {
    use super::{SOLVERS, Solver, Task};
    use crate::selftest::Host;
    use crate::selftest::benchmark_problem::{instances, truth};

    const NONE: Host<'static> = Host { clock: &|| 0.0, cancelled: &|| false, progress: &|_| {} };

    #[test]
    fn every_solver_brings_the_objective_down() {
        let instance = instances(1).swap_remove(0);
        let truth = truth();
        let task = Task { problem: &instance.problem, truth: Some(&truth) };
        for solver in SOLVERS {
            let run = solver.run(&task, NONE);
            let first = run.steps.first().expect("a first evaluation")[1];
            assert!(run.objective < 0.01 * first, "{}: {first} to {}", solver.named(1), run.objective);
            assert!(run.steps.windows(2).all(|pair| pair[1][1] < pair[0][1]), "{}", solver.named(1));
        }
        let run = Solver::One.run(&task, NONE);
        assert!(run.objective <= 1e-20, "{}", run.objective);
    }

    #[test]
    fn the_last_step_of_a_way_has_the_objective_of_eq_18() {
        let instance = instances(1).swap_remove(1);
        let task = Task { problem: &instance.problem, truth: None };
        for solver in SOLVERS {
            let run = solver.run(&task, NONE);
            let (last, delta_e) = (run.steps.last().expect("a step")[1], instance.problem.delta_e(&run.parameters).expect("data"));
            // The noisy minimum is flat: the two are sums of the same squares.
            assert!(
                (last / delta_e - 1.0).abs() < 1e-9 && run.objective == last || solver == Solver::Many,
                "{}: {last} {delta_e}",
                solver.named(1)
            );
            assert!((run.objective / delta_e - 1.0).abs() < 1e-9, "{}: {} {delta_e}", solver.named(1), run.objective);
        }
    }
}
