//! The fits that benchmarks repeat: simulated steel, from several starts.

use crate::fit::{Bounds, FitOptions, Observer, Problem, Starts, fit, free_by_default};
use crate::measurement::{Columns, Measurement, Simulation};
use crate::model::{Parameters, Pbrdf, Preset};

/// Seed of all that is random in a benchmark.
pub(crate) const SEED: u64 = 20_211_129;

/// ΔE of Eq. (18), which is the sum of squares for DoLP alone.
pub(crate) fn objective(problem: &Problem, parameters: &Parameters) -> f64 {
    problem.sum_of_squares(parameters).unwrap_or(f64::INFINITY)
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
pub(crate) struct Instance {
    pub problem: Problem,
    /// Whether its data determine the parameters to the last digits.
    pub tells_the_truth: bool,
    /// Objective of the best fit known.
    pub best: f64,
}

/// Gauss and Cauchy, dense angles and the paper's, without and with noise, each from so many starts.
pub(crate) fn instances(starts: u32) -> Vec<Instance> {
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
