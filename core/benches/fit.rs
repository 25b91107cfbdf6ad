//! How long does a fit take: from one start to the last digits, with noise (median and p90 over draws), and from many starts?
//!
//! Budgets: 0.5 ms from one start without noise, 0.5 s for 1,000 starts on two cores. `cargo bench --no-default-features --features threads --bench
//! fit`; the line under the table has the quantiles over 400 noisy sets.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a benchmark fails by panicking and tells its figures")]

use pbrdf::fit::{Bounds, Effort, FitOptions, Observer, Problem, Starts, fit, fit_local, free_by_default};
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution::Cauchy;
use pbrdf::selftest::quantile;
use std::time::Instant;

const TRUTH: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.25, q: 2.2, c: -0.4, sigma_v: 0.6 };
/// What counts as the truth found again, where there is no noise.
const EXACT: f64 = 1e-20;

fn main() {
    divan::main();
    // Not while listing or testing.
    if std::env::args().any(|argument| argument == "--bench") {
        tell_noisy_sets();
    }
}

/// How is the time of one start with noise distributed over draws of it? No budget; each set counts by the fastest of three fits, so that
/// the tail is that of the problem and not of the machine.
fn tell_noisy_sets() {
    let time = |problem: &Problem| {
        let begun = Instant::now();
        divan::black_box(fit_local(divan::black_box(problem), Effort::Thorough, Observer::NONE));
        begun.elapsed().as_secs_f64() * 1e3
    };
    let of_set = |seed| {
        let problem = steel(0.005, seed);
        (0..3).map(|_| time(&problem)).fold(f64::INFINITY, f64::min)
    };
    let mut times: Vec<f64> = (1..=400).map(of_set).collect();
    times.sort_by(f64::total_cmp);
    let [median, p90, worst] = [0.5, 0.9, 1.0].map(|fraction| quantile(&times, fraction));
    println!("one start, noise 0.005, 400 sets: median {median:.2} ms, p90 {p90:.2} ms, worst {worst:.2} ms");
}

/// 27 points of steel, eight free parameters, from the defaults.
fn steel(noise: f64, seed: u64) -> Problem {
    let measurement = Simulation {
        model_name: "cauchy".to_owned(),
        surface: Pbrdf::new(Model::full(Cauchy), TRUTH).expect("a valid surface"),
        theta_i: vec![30.0, 40.0, 50.0],
        theta_r: (4..=12).map(|i| 5.0 * f64::from(i)).collect(),
        dphi: 180.0,
        columns: Columns::Dolp,
        noise,
        brdf_noise: 0.0,
        seed,
    }
    .run()
    .expect("valid angles");
    let model = Model::full(Cauchy);
    let free = free_by_default(model, &measurement, &FitOptions::default());
    Problem::new(&measurement, model, Parameters::default(), free, Bounds::default(), FitOptions::default()).expect("a valid problem")
}

/// One start, no noise, to ΔE ≤ 1e-20: below 0.05 ms on one core (median).
#[divan::bench]
fn noise_free_to_the_last_digits(bencher: divan::Bencher<'_, '_>) {
    let problem = steel(0.0, 0);
    assert!(fit_local(&problem, Effort::Thorough, Observer::NONE).sum_of_squares <= EXACT);
    bencher.bench(|| fit_local(divan::black_box(&problem), Effort::Thorough, Observer::NONE));
}

/// One start with noise of 0.005 in DoLP, another draw for each sample: how much longer is the valley of the noisy problem? No budget; the
/// slowest samples are its tail.
#[divan::bench(sample_count = 200, sample_size = 1)]
fn noisy(bencher: divan::Bencher<'_, '_>) {
    let mut seed = 0;
    let draw = || {
        seed += 1;
        steel(0.005, seed)
    };
    bencher.with_inputs(draw).bench_local_values(|problem| fit_local(&problem, Effort::Thorough, Observer::NONE));
}

/// A thousand starts: below 0.5 s on two cores.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn a_thousand_starts(bencher: divan::Bencher<'_, '_>) {
    let problem = steel(0.005, 1);
    bencher.bench(|| fit(divan::black_box(&problem), Starts::Exactly(1000), 1, Observer::NONE));
}

/// The default fit of a noisy set, as the command line does it: well below 0.2 s on two cores.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn the_default_fit(bencher: divan::Bencher<'_, '_>) {
    let problem = steel(0.005, 1);
    bencher.bench(|| fit(divan::black_box(&problem), Starts::Automatic, 1, Observer::NONE));
}
