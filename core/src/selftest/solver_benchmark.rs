//! Fits against time: the same problems from the same starts by several solvers. The yardstick is in [`crate::selftest::reference_lm`], the ladder of models
//! on the same data in [`crate::selftest::model_benchmark`].

use crate::fit::{Bounds, Effort, FitOptions, LeastSquares, Observer, Problem, Starts, fit, free_by_default, minimise};
use crate::measurement::{Columns, Measurement, Simulation};
use crate::model::{Parameters, Pbrdf, Preset};
use crate::selftest::accuracy_vs_time::{ErrorVsTime, TaskKind};
use crate::selftest::method::BenchmarkMethod;
use crate::selftest::reference_lm::levenberg_marquardt;
use crate::selftest::{Host, Timing, model_benchmark, quantile};
use nalgebra::{DMatrix, DVector};
use std::cell::RefCell;

/// One improvement along a fit: elapsed milliseconds, objective, distance to the truth.
pub(crate) type TraceStep = [f64; 3];

/// What the fits of the report come to.
#[derive(Default)]
pub(crate) struct SolverBenchmark {
    pub rows: Vec<ErrorVsTime>,
    /// Along one fit, by method.
    pub curves: Vec<(BenchmarkMethod, Vec<TraceStep>)>,
    /// Along one fit from the defaults, by model of the ladder.
    pub ladder: Vec<(BenchmarkMethod, Vec<TraceStep>)>,
    /// Dolan and Moré's profiles, Math. Program. 91, 201 (2002): by method, the share of problems solved within a multiple of the
    /// fastest method's time.
    pub profiles: Vec<(BenchmarkMethod, Vec<[f64; 2]>)>,
}

/// How a problem is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Method {
    /// The yardstick from one start.
    Marquardt { analytic: bool, scaled: bool },
    /// This program from one start.
    One,
    /// This program from the starts of its own choice.
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

/// How much is fitted, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BenchmarkSize {
    /// Starts of each problem.
    pub starts: u32,
    /// Repetitions of a fit from one start, after one that warms up.
    pub repetitions: usize,
    /// Repetitions of a fit from many starts.
    pub repetitions_of_many: usize,
}

impl BenchmarkSize {
    /// That of the report. Times of a build with debug assertions say little: there one repetition has to do.
    pub(crate) const WHOLE: Self = if cfg!(debug_assertions) {
        Self { starts: 5, repetitions: 1, repetitions_of_many: 1 }
    } else {
        Self { starts: 5, repetitions: 5, repetitions_of_many: 3 }
    };
}

pub(crate) const SEED: u64 = 20_211_129;
/// A fit has succeeded within this of the best objective known: relative, or absolute where data have no noise.
const SAME: f64 = 1e-6;
const EXACT: f64 = 1e-20;
/// Parameters smaller than this are compared as if they had this size.
pub(crate) const SMALLEST_SIZE: f64 = 1e-3;

impl Method {
    /// Its name in the report, where so many starts are taken one after the other.
    fn named(self, starts: u32) -> BenchmarkMethod {
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
    fn repeated(self, task: &Task<'_>, extent: BenchmarkSize, surroundings: Host<'_>) -> Run {
        let repetitions = self.repetitions(extent);
        if repetitions > 1 && self != Self::Many {
            // Warms caches and branches up; a fit from many starts is long enough to do so itself.
            _ = self.run(task, surroundings);
        }
        typical(&(0..repetitions).map(|_| self.run(task, surroundings)).collect::<Vec<_>>())
    }

    pub(crate) fn run(self, task: &Task<'_>, surroundings: Host<'_>) -> Run {
        let begun = (surroundings.clock)();
        let clock = || (surroundings.clock)() - begun;
        let log = RefCell::new(Trace { clock: &clock, truth: task.truth, run: Run::begun(task.problem) });
        match self {
            Self::Marquardt { analytic, scaled } => {
                levenberg_marquardt(task, analytic, scaled, &log);
            }
            Self::One => {
                let watch = Observer { clock: &|| 0.0, cancelled: surroundings.cancelled, progress: &|_| {} };
                _ = minimise(&Recorded { problem: task.problem, log: &log }, Effort::Thorough, watch);
            }
            Self::Many => {
                let clock = surroundings.clock;
                let watch = Observer { clock: &|| clock() - begun, cancelled: surroundings.cancelled, progress: &|_| {} };
                let report = fit(task.problem, Starts::Automatic, SEED, watch);
                let mut log = log.borrow_mut();
                log.run.steps = report.course.trace.iter().map(|point| [point.elapsed_ms, point.objective, f64::NAN]).collect();
                log.run.parameters = report.parameters;
                log.run.objective = objective(task.problem, &report.parameters);
            }
        }
        let elapsed_ms = clock();
        let run = log.borrow().run.clone();
        Run { elapsed_ms, ..run }
    }
}

/// ΔE of Eq. (18), which is the sum of squares for DoLP alone.
fn objective(problem: &Problem, parameters: &Parameters) -> f64 {
    problem.sum_of_squares(parameters).unwrap_or(f64::INFINITY)
}

/// A problem with its truth.
pub(crate) struct Task<'a> {
    pub problem: &'a Problem,
    /// None where the model is not that of the data.
    pub truth: Option<&'a Parameters>,
}

/// What came of one fit.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    pub elapsed_ms: f64,
    /// Half the distance between the quartiles of its repetitions over their median.
    pub spread: f64,
    /// ΔE.
    pub objective: f64,
    pub parameters: Parameters,
    pub steps: Vec<TraceStep>,
}

impl Run {
    pub(crate) fn begun(problem: &Problem) -> Self {
        Self { elapsed_ms: 0.0, spread: f64::NAN, objective: f64::INFINITY, parameters: *Problem::start(problem), steps: Vec::new() }
    }
}

/// Notes improvements.
pub(crate) struct Trace<'a> {
    pub clock: &'a dyn Fn() -> f64,
    pub truth: Option<&'a Parameters>,
    pub run: Run,
}

impl Trace<'_> {
    pub(crate) fn note(&mut self, problem: &Problem, parameters: Parameters, residuals: &DVector<f64>) {
        let objective = residuals.norm_squared();
        if objective < self.run.objective {
            let distance = self.truth.map_or(f64::NAN, |truth| distance(problem, &parameters, truth));
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

/// Angles that determine all parameters of a fit to DoLP, and those of the paper's steel, which do not.
fn angles_of(dense: bool) -> (Vec<f64>, Vec<f64>) {
    let steps = |count: u32, first: f64, step: f64| (0..count).map(|i| first + step * f64::from(i)).collect();
    if dense { (steps(8, 10.0, 10.0), steps(18, 0.0, 5.0)) } else { (steps(3, 30.0, 10.0), steps(9, 20.0, 5.0)) }
}

/// 45# steel.
pub(crate) fn truth() -> Parameters {
    Parameters { n: 2.07, k: 2.9, sigma: 0.25, ks: 1.0, kd: 0.12, kv: 0.15, q: 1.8, c: -0.4, sigma_v: 0.6 }
}

pub(crate) fn simulate(preset: &Preset, dense: bool, noise: f64) -> Measurement {
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

pub(crate) fn problem(preset: &Preset, measurement: &Measurement, start: Parameters) -> Option<Problem> {
    let choices = FitOptions { dolp_only: preset.dolp_only, ..FitOptions::default() };
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

fn instances(starts: u32) -> Vec<Instance> {
    let mut instances = Vec::new();
    for preset in ["gauss", "cauchy"].iter().filter_map(|key| Preset::from_key(key)) {
        for (dense, noise) in [(true, 0.0), (true, 0.005), (false, 0.0), (false, 0.005)] {
            let measurement = simulate(preset, dense, noise);
            let Some(problem) = problem(preset, &measurement, Parameters::default()) else { continue };
            let best = fit(&problem, Starts::Automatic, SEED, Observer::NONE).parameters;
            let best = objective(&problem, &best);
            for i in 0..starts {
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

impl SolverBenchmark {
    /// Runs it; what there is when it is cancelled.
    pub(crate) fn run(extent: BenchmarkSize, surroundings: Host<'_>) -> Self {
        let mut race = Self::default();
        let truth = truth();
        let mut instances = instances(extent.starts);
        // By method, and by instance; the starts of a problem follow each other.
        let mut all: Vec<(BenchmarkMethod, Vec<Run>)> = Vec::new();
        for (done, method) in (0_u32..).zip(METHODS) {
            let mut runs = Vec::new();
            for instance in &mut instances {
                if (surroundings.cancelled)() {
                    return race;
                }
                let task = Task { problem: &instance.problem, truth: Some(&truth) };
                let run = method.repeated(&task, extent, surroundings);
                instance.best = instance.best.min(run.objective);
                runs.push(run);
            }
            let pooled = matches!(method, Method::Marquardt { .. }).then(|| (method.named(extent.starts), together(&runs, extent.starts)));
            all.push((method.named(1), runs));
            all.extend(pooled);
            (surroundings.progress)(0.1 + 0.1 * f64::from(done));
        }
        race.rows = all.iter().map(|(name, runs)| row(*name, runs, &instances, &truth)).collect();
        let times: Vec<Vec<f64>> = all.iter().map(|(_, runs)| times_of_success(runs, &instances)).collect();
        race.profiles = all.iter().zip(profiles(&times)).map(|((name, _), profile)| (*name, profile)).collect();
        race.curves = all.into_iter().filter_map(|(name, mut runs)| Some((name, runs.drain(..).next()?.steps))).collect();
        let (rows, curves) = model_benchmark::run(extent, surroundings);
        race.rows.extend(rows);
        race.ladder = curves;
        race
    }
}

/// The repetitions of one fit as one: they take the same steps, at the median of their times.
pub(crate) fn typical(repeated: &[Run]) -> Run {
    let times = Timing::from_repetitions(repeated.iter().map(|run| run.elapsed_ms * 1e6).collect());
    let mut typical = repeated[0].clone();
    for (i, step) in typical.steps.iter_mut().enumerate() {
        step[0] = median(repeated.iter().filter_map(|run| Some(run.steps.get(i)?[0])).collect());
    }
    Run { elapsed_ms: times.median_ns * 1e-6, spread: times.spread, ..typical }
}

/// All starts of each problem as one fit, the best of them, one after the other; given once for each of them.
fn together(runs: &[Run], starts: u32) -> Vec<Run> {
    let of_problem = |runs: &[Run]| {
        let mut whole = Run { steps: Vec::new(), elapsed_ms: 0.0, objective: f64::INFINITY, ..runs[0].clone() };
        for run in runs {
            for &[elapsed_ms, objective, distance] in &run.steps {
                if objective < whole.steps.last().map_or(f64::INFINITY, |step| step[1]) {
                    whole.steps.push([whole.elapsed_ms + elapsed_ms, objective, distance]);
                }
            }
            if run.objective < whole.objective {
                (whole.objective, whole.parameters) = (run.objective, run.parameters);
            }
            whole.elapsed_ms += run.elapsed_ms;
            whole.spread = whole.spread.max(run.spread);
        }
        vec![whole; runs.len()]
    };
    runs.chunks(starts as usize).flat_map(of_problem).collect()
}

fn has_succeeded(run: &Run, instance: &Instance) -> bool {
    run.objective <= (instance.best * (1.0 + SAME)).max(instance.best + EXACT)
}

/// Times of the fits that succeeded; infinite for the others.
fn times_of_success(runs: &[Run], instances: &[Instance]) -> Vec<f64> {
    let time = |(run, instance): (&Run, &Instance)| if has_succeeded(run, instance) { run.elapsed_ms } else { f64::INFINITY };
    runs.iter().zip(instances).map(time).collect()
}

fn row(method: BenchmarkMethod, runs: &[Run], instances: &[Instance], truth: &Parameters) -> ErrorVsTime {
    let told = runs.iter().zip(instances).filter(|(_, instance)| instance.tells_the_truth);
    let mut distances: Vec<f64> = told.map(|(run, instance)| distance(&instance.problem, &run.parameters, truth)).collect();
    distances.sort_by(f64::total_cmp);
    let succeeded = runs.iter().zip(instances).filter(|(run, instance)| has_succeeded(run, instance)).count();
    #[expect(clippy::cast_precision_loss, reason = "numbers of fits")]
    let rate = succeeded as f64 / runs.len() as f64;
    ErrorVsTime {
        task: TaskKind::Fit,
        method,
        time: median(runs.iter().map(|run| run.elapsed_ms).collect()),
        spread: median(runs.iter().map(|run| run.spread).collect()),
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

#[cfg(test)]
mod tests {
    use super::{METHODS, Method, Run, Task, instances, profiles, together, truth, typical};
    use crate::selftest::Host;

    const NONE: Host<'static> = Host { clock: &|| 0.0, cancelled: &|| false, progress: &|_| {} };

    #[test]
    fn a_method_that_solves_half_of_all_at_twice_the_time_has_that_profile() {
        let profiles = profiles(&[vec![1.0, 2.0], vec![2.0, f64::INFINITY]]);
        assert_eq!(profiles, [vec![[1.0, 0.5], [1.0, 1.0]], vec![[2.0, 0.5]]]);
    }

    fn run(elapsed_ms: f64, objectives: [f64; 2]) -> Run {
        let problem = instances(1).swap_remove(0).problem;
        let steps = vec![[0.5 * elapsed_ms, objectives[0], 1.0], [elapsed_ms, objectives[1], 1.0]];
        Run { elapsed_ms, objective: objectives[1], steps, ..Run::begun(&problem) }
    }

    #[test]
    fn starts_of_a_problem_together_take_the_sum_of_their_times_and_keep_the_best() {
        let whole = together(&[run(2.0, [9.0, 4.0]), run(6.0, [7.0, 3.0]), run(1.0, [8.0, 5.0])], 2);
        let summary: Vec<_> = whole.iter().map(|run| (run.elapsed_ms, run.objective)).collect();
        assert_eq!(summary, [(8.0, 3.0), (8.0, 3.0), (1.0, 5.0)]);
        // The second start's first step is worse than what there is.
        assert_eq!(whole[0].steps, [[1.0, 9.0, 1.0], [2.0, 4.0, 1.0], [8.0, 3.0, 1.0]]);
    }

    #[test]
    fn repetitions_count_by_their_median() {
        let typical = typical(&[run(2.0, [9.0, 4.0]), run(40.0, [9.0, 4.0]), run(3.0, [9.0, 4.0])]);
        assert_eq!((typical.elapsed_ms, typical.steps[0][0]), (3.0, 1.5));
    }

    #[test]
    fn every_method_brings_the_objective_down() {
        let instance = instances(1).swap_remove(0);
        let truth = truth();
        let task = Task { problem: &instance.problem, truth: Some(&truth) };
        for method in METHODS {
            let run = method.run(&task, NONE);
            let first = run.steps.first().expect("a first evaluation")[1];
            assert!(run.objective < 0.01 * first, "{}: {first} to {}", method.named(1), run.objective);
            assert!(run.steps.windows(2).all(|pair| pair[1][1] < pair[0][1]), "{}", method.named(1));
        }
        let run = Method::One.run(&task, NONE);
        assert!(run.objective <= 1e-20, "{}", run.objective);
    }

    #[test]
    fn the_last_step_of_a_way_has_the_objective_of_eq_18() {
        let instance = instances(1).swap_remove(1);
        let task = Task { problem: &instance.problem, truth: None };
        for method in METHODS {
            let run = method.run(&task, NONE);
            let (last, delta_e) = (run.steps.last().expect("a step")[1], instance.problem.delta_e(&run.parameters).expect("data"));
            // The noisy minimum is flat: the two are sums of the same squares.
            assert!(
                (last / delta_e - 1.0).abs() < 1e-9 && run.objective == last || method == Method::Many,
                "{}: {last} {delta_e}",
                method.named(1)
            );
            assert!((run.objective / delta_e - 1.0).abs() < 1e-9, "{}: {} {delta_e}", method.named(1), run.objective);
        }
    }
}
