//! Fits against time: the same problems from the same starts by several solvers.

use crate::model::Parameters;
use crate::selftest::benchmark_problem::{Instance, instances, truth};
use crate::selftest::benchmark_run::{BenchmarkRun, BenchmarkSize, Task, TraceStep, distance, median};
use crate::selftest::benchmark_solver::{SOLVERS, Solver};
use crate::selftest::error_vs_time::{ErrorVsTime, TaskKind};
use crate::selftest::method::BenchmarkMethod;
use crate::selftest::{Host, quantile};

/// What the fits of the report come to.
#[derive(Default)]
pub(crate) struct SolverBenchmark {
    pub rows: Vec<ErrorVsTime>,
    /// Along one fit, by method.
    pub curves: Vec<(BenchmarkMethod, Vec<TraceStep>)>,
    /// Dolan and Moré's profiles, Math. Program. 91, 201 (2002): by method, the share of problems solved within a multiple of the
    /// fastest method's time.
    pub profiles: Vec<(BenchmarkMethod, Vec<[f64; 2]>)>,
}

/// A fit has succeeded within this of the best objective known: relative, or absolute where data have no noise.
const SAME: f64 = 1e-6;
const EXACT: f64 = 1e-20;
impl SolverBenchmark {
    /// Runs it; what there is when it is cancelled.
    pub(crate) fn run(extent: BenchmarkSize, host: Host<'_>) -> Self {
        let mut benchmark = Self::default();
        let truth = truth();
        let mut instances = instances(extent.starts);
        // By method, and by instance; the starts of a problem follow each other.
        let mut all: Vec<(BenchmarkMethod, Vec<BenchmarkRun>)> = Vec::new();
        for (done, solver) in (0_u32..).zip(SOLVERS) {
            let mut runs = Vec::new();
            for instance in &mut instances {
                if (host.cancelled)() {
                    return benchmark;
                }
                let task = Task { problem: &instance.problem, truth: Some(&truth) };
                let run = solver.repeated(&task, extent, host);
                instance.best = instance.best.min(run.objective);
                runs.push(run);
            }
            let pooled = matches!(solver, Solver::Marquardt { .. }).then(|| (solver.named(extent.starts), together(&runs, extent.starts)));
            all.push((solver.named(1), runs));
            all.extend(pooled);
            (host.progress)(0.1 + 0.1 * f64::from(done));
        }
        benchmark.rows = all.iter().map(|(name, runs)| row(*name, runs, &instances, &truth)).collect();
        let times: Vec<Vec<f64>> = all.iter().map(|(_, runs)| times_of_success(runs, &instances)).collect();
        benchmark.profiles = all.iter().zip(profiles(&times)).map(|((name, _), profile)| (*name, profile)).collect();
        benchmark.curves = all.into_iter().filter_map(|(name, mut runs)| Some((name, runs.drain(..).next()?.steps))).collect();
        benchmark
    }
}

/// All starts of each problem as one fit, the best of them, one after the other; given once for each of them.
fn together(runs: &[BenchmarkRun], starts: u32) -> Vec<BenchmarkRun> {
    let of_problem = |runs: &[BenchmarkRun]| {
        let mut whole = BenchmarkRun { steps: Vec::new(), elapsed_ms: 0.0, objective: f64::INFINITY, ..runs[0].clone() };
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

fn has_succeeded(run: &BenchmarkRun, instance: &Instance) -> bool {
    run.objective <= (instance.best * (1.0 + SAME)).max(instance.best + EXACT)
}

/// Times of the fits that succeeded; infinite for the others.
fn times_of_success(runs: &[BenchmarkRun], instances: &[Instance]) -> Vec<f64> {
    let time = |(run, instance): (&BenchmarkRun, &Instance)| if has_succeeded(run, instance) { run.elapsed_ms } else { f64::INFINITY };
    runs.iter().zip(instances).map(time).collect()
}

fn row(method: BenchmarkMethod, runs: &[BenchmarkRun], instances: &[Instance], truth: &Parameters) -> ErrorVsTime {
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
    use super::{BenchmarkRun, instances, profiles, together};

    #[test]
    fn a_method_that_solves_half_of_all_at_twice_the_time_has_that_profile() {
        let profiles = profiles(&[vec![1.0, 2.0], vec![2.0, f64::INFINITY]]);
        assert_eq!(profiles, [vec![[1.0, 0.5], [1.0, 1.0]], vec![[2.0, 0.5]]]);
    }

    fn run(elapsed_ms: f64, objectives: [f64; 2]) -> BenchmarkRun {
        let problem = instances(1).swap_remove(0).problem;
        let steps = vec![[0.5 * elapsed_ms, objectives[0], 1.0], [elapsed_ms, objectives[1], 1.0]];
        BenchmarkRun { elapsed_ms, objective: objectives[1], steps, ..BenchmarkRun::begun(&problem) }
    }

    #[test]
    fn starts_of_a_problem_together_take_the_sum_of_their_times_and_keep_the_best() {
        let whole = together(&[run(2.0, [9.0, 4.0]), run(6.0, [7.0, 3.0]), run(1.0, [8.0, 5.0])], 2);
        let summary: Vec<_> = whole.iter().map(|run| (run.elapsed_ms, run.objective)).collect();
        assert_eq!(summary, [(8.0, 3.0), (8.0, 3.0), (1.0, 5.0)]);
        // The second start's first step is worse than what there is.
        assert_eq!(whole[0].steps, [[1.0, 9.0, 1.0], [2.0, 4.0, 1.0], [8.0, 3.0, 1.0]]);
    }
}
