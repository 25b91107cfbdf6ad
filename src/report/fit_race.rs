//! Fits against time: the same problems from the same starts by several solvers, and the ladder of models on the same data.
//!
//! The yardstick is MINPACK's Levenberg–Marquardt (the crate `levenberg-marquardt`) on angles φ with `p = low + (high − low) sin²φ`, which keep a
//! parameter in its box: with derivatives of the core or forward differences of its residuals, and with or without MINPACK's scaling by
//! the columns of the Jacobian.

use super::error_vs_time::{ErrorVsTime, TaskKind};
use super::{Surroundings, quantile};
use crate::fit::{Bounds, Choices, Effort, LeastSquares, Problem, Starts, Watch, fit, free_by_default, minimise};
use crate::measurement::{Columns, Measurement, Simulation};
use crate::model::{PRESETS, Parameters, Pbrdf, Preset, Scene};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::cell::RefCell;

/// One improvement along a fit: elapsed milliseconds, objective, distance to the truth.
pub(super) type Step = [f64; 3];

/// What the fits of the report come to.
#[derive(Default)]
pub(super) struct Race {
    pub rows: Vec<ErrorVsTime>,
    /// Along one fit, by method.
    pub curves: Vec<(String, Vec<Step>)>,
    /// Dolan and Moré's profiles, Math. Program. 91, 201 (2002): by method, the share of problems solved within a multiple of the
    /// fastest method's time.
    pub profiles: Vec<(String, Vec<[f64; 2]>)>,
}

/// How a problem is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Method {
    Marquardt { analytic: bool, scaled: bool },
    One,
    Many,
}

const METHODS: [Method; 6] = [
    Method::Marquardt { analytic: false, scaled: false },
    Method::Marquardt { analytic: false, scaled: true },
    Method::Marquardt { analytic: true, scaled: false },
    Method::Marquardt { analytic: true, scaled: true },
    Method::One,
    Method::Many,
];

/// What the names of the ladder's rows begin with.
pub(super) const LADDER: &str = "model ";

/// Starts of each problem, and repetitions of each fit.
const STARTS: u32 = 5;
const REPETITIONS: usize = 3;
const SEED: u64 = 20_211_129;
/// A fit has succeeded within this of the best objective known: relative, or absolute where data have no noise.
const SAME: f64 = 1e-6;
const EXACT: f64 = 1e-20;
/// Evaluations that Levenberg–Marquardt is allowed per parameter and one.
const PATIENCE: usize = 100;
/// The fraction of the box that a start keeps from an edge, where the slope by φ vanishes.
const MARGIN: f64 = 1e-3;
/// Step of a forward difference, √ε, relative to φ or to this.
const DIFFERENCE: f64 = 1.490_116_119_384_765_6e-8;
const SMALLEST_ANGLE: f64 = 1e-2;
/// Parameters smaller than this are compared as if they had this size.
const SMALLEST_SIZE: f64 = 1e-3;

impl Method {
    fn name(self) -> String {
        match self {
            Self::Marquardt { analytic, scaled } => format!(
                "Levenberg–Marquardt, {} Jacobian, {}",
                if analytic { "analytic" } else { "finite-difference" },
                if scaled { "scaled" } else { "unscaled" }
            ),
            Self::One => "this program, one start".to_owned(),
            Self::Many => "this program, many starts".to_owned(),
        }
    }

    fn run(self, task: &Task<'_>, surroundings: Surroundings<'_>) -> Run {
        let begun = (surroundings.clock)();
        let clock = || (surroundings.clock)() - begun;
        let log = RefCell::new(Log { clock: &clock, truth: task.truth, run: Run::begun(task.problem) });
        match self {
            Self::Marquardt { analytic, scaled } => {
                let adapter = Adapter { task, phi: angles(task.problem), analytic, log: &log };
                let solver = LevenbergMarquardt::new().with_patience(PATIENCE).with_scale_diag(scaled);
                _ = solver.minimize(adapter);
            }
            Self::One => {
                let watch = Watch { clock: &|| 0.0, cancelled: surroundings.cancelled, progress: &|_| {} };
                _ = minimise(&Recorded { problem: task.problem, log: &log }, Effort::Full, watch);
            }
            Self::Many => {
                let clock = surroundings.clock;
                let watch = Watch { clock: &|| clock() - begun, cancelled: surroundings.cancelled, progress: &|_| {} };
                let report = fit(task.problem, Starts::Automatic, SEED, watch);
                let mut log = log.borrow_mut();
                log.run.steps = report.trace.iter().map(|point| [point.elapsed_ms, point.objective, f64::NAN]).collect();
                log.run.parameters = report.parameters;
                log.run.objective = task.problem.sum_of_squares(&report.parameters).unwrap_or(f64::INFINITY);
            }
        }
        let elapsed_ms = clock();
        let run = log.borrow().run.clone();
        Run { elapsed_ms, ..run }
    }
}

/// A problem with its truth.
struct Task<'a> {
    problem: &'a Problem,
    truth: &'a Parameters,
}

/// What came of one fit.
#[derive(Debug, Clone)]
struct Run {
    elapsed_ms: f64,
    objective: f64,
    parameters: Parameters,
    steps: Vec<Step>,
}

impl Run {
    fn begun(problem: &Problem) -> Self {
        Self { elapsed_ms: 0.0, objective: f64::INFINITY, parameters: *Problem::start(problem), steps: Vec::new() }
    }
}

/// Notes improvements.
struct Log<'a> {
    clock: &'a dyn Fn() -> f64,
    truth: &'a Parameters,
    run: Run,
}

impl Log<'_> {
    fn note(&mut self, problem: &Problem, parameters: Parameters, residuals: &DVector<f64>) {
        let objective = residuals.norm_squared();
        if objective < self.run.objective {
            let distance = distance(problem, &parameters, self.truth);
            self.run.steps.push([(self.clock)(), objective, distance]);
            (self.run.objective, self.run.parameters) = (objective, parameters);
        }
    }
}

/// The largest relative distance of a free parameter from its true value.
fn distance(problem: &Problem, parameters: &Parameters, truth: &Parameters) -> f64 {
    let of = |&parameter: &_| (parameters[parameter] - truth[parameter]).abs() / truth[parameter].abs().max(SMALLEST_SIZE);
    problem.free().iter().map(of).fold(0.0, f64::max)
}

/// The program's own problem, its evaluations noted.
struct Recorded<'a, 'b> {
    problem: &'a Problem,
    log: &'a RefCell<Log<'b>>,
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
            let mut parameters = *Problem::start(self.problem);
            for (&parameter, value) in self.problem.free().iter().zip(x.iter()) {
                parameters[parameter] = *value;
            }
            self.log.borrow_mut().note(self.problem, parameters, out);
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

    fn straighten(&self, x: &DVector<f64>, moving: &[usize], jacobian: &mut DMatrix<f64>) {
        self.problem.straighten(x, moving, jacobian);
    }

    fn reach(&self, x: &DVector<f64>, unknown: usize) -> (f64, f64) {
        self.problem.reach(x, unknown)
    }

    fn advance(&self, x: &DVector<f64>, moving: &[usize], step: &[f64], out: &mut DVector<f64>) {
        self.problem.advance(x, moving, step, out);
    }
}

/// The problem as MINPACK's solver takes it.
struct Adapter<'a, 'b> {
    task: &'a Task<'a>,
    phi: DVector<f64>,
    analytic: bool,
    log: &'a RefCell<Log<'b>>,
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

/// Angles that determine all parameters of a fit to DoLP, and those of the paper's steel, which do not.
fn angles_of(dense: bool) -> (Vec<f64>, Vec<f64>) {
    let steps = |count: u32, first: f64, step: f64| (0..count).map(|i| first + step * f64::from(i)).collect();
    if dense { (steps(8, 10.0, 10.0), steps(18, 0.0, 5.0)) } else { (steps(3, 30.0, 10.0), steps(9, 20.0, 5.0)) }
}

/// 45# steel.
fn truth() -> Parameters {
    Parameters { n: 2.07, k: 2.9, sigma: 0.25, ks: 1.0, kd: 0.12, kv: 0.15, q: 1.8, c: -0.4, sigma_v: 0.6 }
}

fn simulate(preset: &Preset, dense: bool, noise: f64) -> Measurement {
    let (theta_i, theta_r) = angles_of(dense);
    let surface = Pbrdf::new(preset.model, truth()).ok();
    let simulation = surface.map(|surface| Simulation {
        model_name: preset.key.to_owned(),
        surface,
        theta_i,
        theta_r,
        dphi: 180.0,
        columns: Columns::Dolp,
        noise,
        brdf_noise: 0.0,
        seed: SEED,
    });
    simulation.and_then(|simulation| simulation.run().ok()).unwrap_or_default()
}

fn problem(preset: &Preset, measurement: &Measurement, start: Parameters) -> Option<Problem> {
    let choices = Choices { dolp_only: preset.dolp_only, ..Choices::default() };
    let free = free_by_default(preset.model, measurement, &choices);
    Problem::new(measurement, preset.model, start, free, Bounds::default(), choices).ok()
}

/// The defaults, and points spread over the inner part of the box.
fn start(i: u32, problem: &Problem) -> Parameters {
    let mut start = Parameters::default();
    if i > 0 {
        for (&parameter, prime) in problem.free().iter().zip([2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0_f64]) {
            let fraction = (f64::from(i) * prime.sqrt()).fract();
            start[parameter] = problem.bounds().spread(parameter, 0.15 + 0.7 * fraction);
        }
    }
    start
}

/// A problem from one of its starts.
struct Instance {
    problem: Problem,
    /// Whether its data determine the parameters to the last digits.
    tells_the_truth: bool,
    /// Objective of the best fit known.
    best: f64,
}

fn instances() -> Vec<Instance> {
    let mut instances = Vec::new();
    for preset in ["gauss", "cauchy"].iter().filter_map(|key| Preset::from_key(key)) {
        for (dense, noise) in [(true, 0.0), (true, 0.005), (false, 0.0), (false, 0.005)] {
            let measurement = simulate(preset, dense, noise);
            let Some(problem) = problem(preset, &measurement, Parameters::default()) else { continue };
            let best = fit(&problem, Starts::Automatic, SEED, Watch::NOBODY).parameters;
            let best = problem.sum_of_squares(&best).unwrap_or(f64::INFINITY);
            for i in 0..STARTS {
                let start = start(i, &problem);
                instances.push(Instance { problem: problem.with_start(start), tells_the_truth: dense && noise == 0.0, best });
            }
        }
    }
    instances
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

impl Race {
    /// Runs it; what there is when it is cancelled.
    pub(super) fn run(surroundings: Surroundings<'_>) -> Self {
        let mut race = Self::default();
        let truth = truth();
        let mut instances = instances();
        // Times of successful fits by method and instance; infinite without success.
        let mut times: Vec<Vec<f64>> = Vec::new();
        let mut all: Vec<Vec<Run>> = Vec::new();
        for (done, method) in (0_u32..).zip(METHODS) {
            let mut runs = Vec::new();
            for instance in &mut instances {
                if (surroundings.cancelled)() {
                    return race;
                }
                let task = Task { problem: &instance.problem, truth: &truth };
                let repeated: Vec<Run> = (0..REPETITIONS).map(|_| method.run(&task, surroundings)).collect();
                let run = typical(&repeated);
                instance.best = instance.best.min(run.objective);
                runs.push(run);
            }
            race.curves.push((method.name(), runs[0].steps.clone()));
            all.push(runs);
            (surroundings.progress)(0.1 + 0.1 * f64::from(done));
        }
        for (method, runs) in METHODS.into_iter().zip(&all) {
            let succeeded = |(run, instance): (&Run, &Instance)| run.objective <= (instance.best * (1.0 + SAME)).max(instance.best + EXACT);
            let success: Vec<bool> = runs.iter().zip(&instances).map(succeeded).collect();
            times.push(runs.iter().zip(&success).map(|(run, &ok)| if ok { run.elapsed_ms } else { f64::INFINITY }).collect());
            race.rows.push(row(method, runs, &instances, &success, &truth));
        }
        race.profiles = METHODS.into_iter().zip(profiles(&times)).map(|(method, profile)| (method.name(), profile)).collect();
        race.rows.extend(ladder(surroundings));
        race
    }
}

/// The repetitions of one fit as one: they take the same steps, at the median of their times.
fn typical(repeated: &[Run]) -> Run {
    let times = repeated.iter().map(|run| run.elapsed_ms).collect();
    let mut typical = repeated[0].clone();
    for (i, step) in typical.steps.iter_mut().enumerate() {
        step[0] = median(repeated.iter().filter_map(|run| Some(run.steps.get(i)?[0])).collect());
    }
    Run { elapsed_ms: median(times), ..typical }
}

fn row(method: Method, runs: &[Run], instances: &[Instance], success: &[bool], truth: &Parameters) -> ErrorVsTime {
    let told = runs.iter().zip(instances).filter(|(_, instance)| instance.tells_the_truth);
    let mut distances: Vec<f64> = told.map(|(run, instance)| distance(&instance.problem, &run.parameters, truth)).collect();
    distances.sort_by(f64::total_cmp);
    let mut times: Vec<f64> = runs.iter().map(|run| run.elapsed_ms).collect();
    times.sort_by(f64::total_cmp);
    #[expect(clippy::cast_precision_loss, reason = "numbers of fits")]
    let rate = success.iter().filter(|ok| **ok).count() as f64 / success.len() as f64;
    ErrorVsTime {
        task: TaskKind::Fit,
        method: method.name(),
        time: quantile(&times, 0.5),
        spread: 0.5 * (quantile(&times, 0.75) - quantile(&times, 0.25)) / quantile(&times, 0.5),
        worst_relative_error: quantile(&distances, 1.0),
        median_relative_error: quantile(&distances, 0.5),
        success_rate: Some(rate),
    }
}

/// For each method the share of instances solved within a multiple of the fastest time, in steps.
fn profiles(times: &[Vec<f64>]) -> Vec<Vec<[f64; 2]>> {
    let count = times.first().map_or(0, Vec::len);
    let fastest: Vec<f64> = (0..count).map(|i| times.iter().map(|of| of[i]).fold(f64::INFINITY, f64::min)).collect();
    let of = |method: &Vec<f64>| {
        let mut ratios: Vec<f64> = method.iter().zip(&fastest).map(|(time, best)| time / best).filter(|ratio| ratio.is_finite()).collect();
        ratios.sort_by(f64::total_cmp);
        #[expect(clippy::cast_precision_loss, reason = "a number of instances")]
        let share = |solved: usize| solved as f64 / count as f64;
        ratios.iter().enumerate().map(|(i, &ratio)| [ratio, share(i + 1)]).collect()
    };
    times.iter().map(of).collect()
}

/// Every model of the ladder on the same data: steel under dense angles with noise. Errors are those of its DoLP against the noise-free one.
fn ladder(surroundings: Surroundings<'_>) -> Vec<ErrorVsTime> {
    let Some(full) = Preset::from_key("cauchy") else { return Vec::new() };
    let (measurement, exact) = (simulate(full, true, 0.005), simulate(full, true, 0.0));
    let scene = Scene::new(exact.rows.iter().map(|row| row.geometry));
    let mut rows = Vec::new();
    for preset in &PRESETS {
        if (surroundings.cancelled)() {
            break;
        }
        let Some(problem) = problem(preset, &measurement, Parameters::default()) else { continue };
        let clock = surroundings.clock;
        let begun = clock();
        let watch = Watch { clock: &|| clock() - begun, cancelled: surroundings.cancelled, progress: &|_| {} };
        let report = fit(&problem, Starts::Automatic, SEED, watch);
        let time = clock() - begun;
        let Ok(surface) = Pbrdf::new(preset.model, report.parameters) else { continue };
        let truths = exact.rows.iter().map(|row| row.dolp.map_or(0.0, |dolp| dolp.value));
        let errors = truths.zip(scene.reflections(&surface)).filter(|(truth, _)| *truth > SMALLEST_SIZE);
        let mut errors: Vec<f64> = errors.map(|(truth, model)| (model.dolp - truth).abs() / truth).collect();
        errors.sort_by(f64::total_cmp);
        rows.push(ErrorVsTime {
            task: TaskKind::Fit,
            method: format!("{LADDER}{}", preset.key),
            time,
            spread: f64::NAN,
            worst_relative_error: quantile(&errors, 1.0),
            median_relative_error: quantile(&errors, 0.5),
            success_rate: None,
        });
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::{DIFFERENCE, Log, Method, Run, Task, angles, instances, profiles, truth};
    use crate::report::Surroundings;
    use levenberg_marquardt::LeastSquaresProblem as _;
    use std::cell::RefCell;

    #[test]
    fn a_method_that_solves_half_of_all_at_twice_the_time_has_that_profile() {
        let profiles = profiles(&[vec![1.0, 2.0], vec![2.0, f64::INFINITY]]);
        assert_eq!(profiles, [vec![[1.0, 0.5], [1.0, 1.0]], vec![[2.0, 0.5]]]);
    }

    #[test]
    fn both_jacobians_of_the_yardstick_agree() {
        let instance = instances().swap_remove(0);
        let truth = truth();
        let task = Task { problem: &instance.problem, truth: &truth };
        let log = RefCell::new(Log { clock: &|| 0.0, truth: &truth, run: Run::begun(task.problem) });
        let adapter = |analytic| super::Adapter { task: &task, phi: angles(task.problem), analytic, log: &log };
        let (analytic, differences) = (adapter(true).jacobian().expect("a matrix"), adapter(false).jacobian().expect("a matrix"));
        // Forward differences are good to √ε times the curvature.
        let bar = 100.0 * DIFFERENCE * analytic.amax();
        assert!((&analytic - &differences).amax() < bar, "{analytic} {differences}");
    }

    #[test]
    fn every_method_brings_the_objective_down() {
        let instance = instances().swap_remove(0);
        let truth = truth();
        let task = Task { problem: &instance.problem, truth: &truth };
        let surroundings = Surroundings { clock: &|| 0.0, cancelled: &|| false, progress: &|_| {} };
        for method in super::METHODS {
            let run = method.run(&task, surroundings);
            let first = run.steps.first().expect("a first evaluation")[1];
            assert!(run.objective < 0.01 * first, "{}: {first} to {}", method.name(), run.objective);
            assert!(run.steps.windows(2).all(|pair| pair[1][1] < pair[0][1]), "{}", method.name());
        }
        let run = Method::One.run(&task, surroundings);
        assert!(run.objective <= 1e-20, "{}", run.objective);
    }
}
