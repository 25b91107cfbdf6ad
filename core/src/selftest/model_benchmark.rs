//! Every model of the ladder on the same data: what each added term buys and costs.

use crate::fit::{Observer, Problem, Starts, fit};
use crate::measurement::Measurement;
use crate::model::{GeometrySet, PRESETS, Parameters, Pbrdf, Preset};
use crate::selftest::benchmark_problem::{SEED, problem, simulate, truth};
use crate::selftest::benchmark_run::{BenchmarkRun, BenchmarkSize, SMALLEST_SIZE, Task, TraceStep, typical};
use crate::selftest::benchmark_solver::Solver;
use crate::selftest::error_vs_time::{ErrorVsTime, TaskKind};
use crate::selftest::method::BenchmarkMethod;
use crate::selftest::{Host, quantile};

/// Steel under dense angles with noise, and the same without.
struct Data {
    measured: Measurement,
    exact: Vec<f64>,
    scene: GeometrySet,
}

/// A row for each model, from many starts; its errors are those of its DoLP against the noise-free one. And the way of each from the defaults.
pub(crate) fn run(extent: BenchmarkSize, host: Host<'_>) -> (Vec<ErrorVsTime>, Vec<(BenchmarkMethod, Vec<TraceStep>)>) {
    let (mut rows, mut curves) = (Vec::new(), Vec::new());
    let Some(full) = Preset::from_key("cauchy") else { return (rows, curves) };
    let (measured, exact) = (simulate(full, true, 0.005), simulate(full, true, 0.0));
    let scene = GeometrySet::new(exact.rows.iter().map(|row| row.geometry));
    let data = Data { measured, exact: exact.rows.iter().map(|row| row.dolp.map_or(0.0, |dolp| dolp.value)).collect(), scene };
    let truth = truth();
    for (done, preset) in (0_u32..).zip(&PRESETS) {
        if (host.cancelled)() {
            break;
        }
        let Some(problem) = problem(preset, &data.measured, Parameters::default()) else { continue };
        rows.extend(row(preset, &problem, &data, extent, host));
        let task = Task { problem: &problem, truth: Some(&truth).filter(|_| preset.model == full.model) };
        let ways: Vec<BenchmarkRun> = (0..extent.repetitions).map(|_| Solver::One.run(&task, host)).collect();
        curves.push((BenchmarkMethod::Model(preset.key), typical(&ways).steps));
        (host.progress)(0.7 + 0.03 * f64::from(done));
    }
    (rows, curves)
}

fn row(preset: &Preset, problem: &Problem, data: &Data, extent: BenchmarkSize, host: Host<'_>) -> Option<ErrorVsTime> {
    let clock = host.clock;
    let mut parameters = Parameters::default();
    let mut once = || {
        let begun = clock();
        let watch = Observer { clock: &|| clock() - begun, cancelled: host.cancelled, progress: &|_| {} };
        parameters = fit(problem, Starts::Automatic, SEED, watch).parameters;
        BenchmarkRun { elapsed_ms: clock() - begun, ..BenchmarkRun::begun(problem) }
    };
    let run = typical(&(0..extent.repetitions_of_many).map(|_| once()).collect::<Vec<_>>());
    let surface = Pbrdf::new(preset.model, parameters).ok()?;
    let errors = data.exact.iter().zip(data.scene.reflections(&surface)).filter(|(truth, _)| **truth > SMALLEST_SIZE);
    let mut errors: Vec<f64> = errors.map(|(truth, model)| (model.dolp - truth).abs() / truth).collect();
    errors.sort_by(f64::total_cmp);
    Some(ErrorVsTime {
        task: TaskKind::Fit,
        method: BenchmarkMethod::Model(preset.key),
        time: run.elapsed_ms,
        spread: run.spread,
        worst_relative_error: quantile(&errors, 1.0),
        median_relative_error: quantile(&errors, 0.5),
        success_rate: None,
    })
}
