//! Draws from the posterior: diagnostics against ArviZ, and that the draws are what the seed says.
//!
//! Slow: `cargo test --release --test posterior -- --ignored --nocapture`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "numbers of draws and fits")]

use pbrdf::fit::posterior::{
    Posterior, PosteriorError, PosteriorProblem, PosteriorSample, PosteriorSettings, Prior, PriorError, convergence,
};
use pbrdf::fit::{FitOptions, JointFit, JointUnknown, Observer, Starts, UnknownName as _, Weights, fit};
use pbrdf::measurement::{Columns, Quantity, Row, Simulation, grid_geometries};
use pbrdf::model::{Model, Parameter, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use pbrdf::{Fit, Measurement};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};
use std::collections::HashMap;
use std::path::Path;

const TRUTH: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 };

fn records(name: &str) -> Vec<HashMap<String, String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/posterior").join(name);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).expect("a table of the repository");
    reader.deserialize().map(|record| record.expect("a whole row")).collect()
}

#[test]
fn diagnostics_are_those_of_arviz() {
    // Quantiles of ArviZ fall between draws by another rule, and normal scores by another rational: both far below this.
    const NEAR: f64 = 1e-3;
    let draws = records("diagnostics_draws.csv");
    for expected in records("diagnostics.csv") {
        let name = &expected["name"];
        let mut chains = vec![Vec::new(); 4];
        for row in &draws {
            chains[row["chain"].parse::<usize>().expect("a chain")].push(row[name].parse::<f64>().expect("a number"));
        }
        let found = convergence(&chains).expect("draws enough");
        for (key, value) in [("rhat", found.rhat), ("ess_bulk", found.ess_bulk), ("ess_tail", found.ess_tail)] {
            let reference: f64 = expected[key].parse().expect("a number");
            assert!((value / reference - 1.0).abs() < NEAR, "{name} {key}: {value} instead of {reference}");
        }
    }
}

fn measurement(columns: Columns) -> Measurement {
    let simulation = Simulation {
        model_name: "test".to_owned(),
        surface: Pbrdf::new(Model::GAUSS, TRUTH).expect("a surface"),
        theta_i: vec![20.0, 40.0, 60.0, 75.0],
        theta_r: (0..8).map(|i| f64::from(10 * i)).collect(),
        dphi: 180.0,
        columns,
        noise: 0.003,
        brdf_noise: 0.03,
        seed: 5,
    };
    simulation.run().expect("valid angles")
}

fn drawn(columns: Columns, weights: Weights, priors: &[(Parameter, Prior)], settings: PosteriorSettings) -> PosteriorSample {
    let data = measurement(columns);
    let problem =
        Fit::new(&data, Model::GAUSS).options(FitOptions { weights, ..FitOptions::default() }).problem().expect("a valid problem");
    let priors: Vec<(JointUnknown, Prior)> = priors.iter().map(|&(parameter, prior)| (parameter.into(), prior)).collect();
    let posterior = Posterior::new(&problem, &priors, settings).expect("a posterior");
    let start = fit(posterior.problem(), Starts::One, 1, Observer::NONE).parameters;
    posterior.run(&[start], Observer::NONE, &mut |_, _| {}).expect("draws")
}

#[test]
fn draws_hold_the_truth_and_the_noise() {
    for (columns, weights) in [(Columns::Dolp, Weights::Sigma), (Columns::Dolp, Weights::None), (Columns::Both, Weights::None)] {
        let settings = PosteriorSettings { draws: 400, ..PosteriorSettings::default() };
        let sample = drawn(columns, weights, &[], settings);
        for &parameter in &sample.parameters {
            let summary = sample.summary(&parameter);
            // Of some twenty intervals, one beyond four standard deviations is one in a thousand.
            assert!((summary.mean - TRUTH[parameter]).abs() < 4.0 * summary.sd, "{columns:?} {weights:?} {parameter:?}: {summary:?}");
            let convergence = summary.convergence.expect("draws enough");
            assert!(convergence.rhat < 1.05, "{columns:?} {weights:?} {parameter:?}: {convergence:?}");
        }
        let noise = sample.noise;
        assert_eq!(noise[0].is_some(), weights == Weights::None);
        // 32 values tell a standard deviation within 13 %: four of those.
        for (noise, truth) in noise.iter().zip([0.003, 0.03]) {
            assert!(noise.is_none_or(|noise| (noise.q50 / truth - 1.0).abs() < 0.5), "{noise:?} instead of {truth}");
        }
        assert!(sample.log_evidence.expect("an evidence").std_error < 0.2, "{:?}", sample.log_evidence);
    }
}

/// Of each free parameter, mean and standard deviation.
fn moments<P: PosteriorProblem>(problem: &P, start: P::Point) -> Vec<(String, f64, f64)> {
    let settings = PosteriorSettings { draws: 600, ..PosteriorSettings::default() };
    let posterior = Posterior::new(problem, &[], settings).expect("a posterior");
    let sample = posterior.run(&[start], Observer::NONE, &mut |_, _| {}).expect("draws");
    let of = |name: &P::Name| {
        let summary = sample.summary(name);
        assert!(summary.convergence.expect("draws enough").rhat < 1.05, "{name:?}: {summary:?}");
        (name.key().into_owned(), summary.mean, summary.sd)
    };
    sample.parameters.iter().map(of).collect()
}

/// Means differ by less than a third of a standard deviation: with 200 effective draws each has an error of 0.07.
fn assert_near(one: &(String, f64, f64), other: &(String, f64, f64)) {
    assert!((one.1 - other.1).abs() < 0.33 * one.2.min(other.2) && (one.2 / other.2 - 1.0).abs() < 0.3, "{one:?} {other:?}");
}

#[test]
fn several_measurements_share_or_own() {
    let options = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
    let data = measurement(Columns::Dolp);
    let halves: [Measurement; 2] = [0, 1].map(|half| {
        let rows = data.rows.iter().skip(half).step_by(2).copied().collect();
        Measurement { name: format!("{half}"), rows, lines: Vec::new(), ..data.clone() }
    });
    let joint = || JointFit::new(&halves, Model::GAUSS).options(options);
    // All shared: as one measurement with all rows.
    let problem = Fit::new(&data, Model::GAUSS).options(options).problem().expect("a valid problem");
    let start = fit(&problem, Starts::One, 1, Observer::NONE).parameters;
    let together = moments(&problem, start);
    let shared = moments(&joint().problem().expect("a valid problem"), vec![start; 2]);
    together.iter().zip(&shared).for_each(|(one, other)| assert_near(one, other));
    // All own: each by itself.
    let apart = joint().own(Model::GAUSS.parameters().iter()).problem().expect("a valid problem");
    let own = moments(&apart, vec![start; 2]);
    for half in &halves {
        let problem = Fit::new(half, Model::GAUSS).options(options).problem().expect("a valid problem");
        for (name, mean, sd) in moments(&problem, start) {
            let key = format!("{name}@{}", half.name);
            let other = own.iter().find(|(other, ..)| *other == key).expect("an own parameter");
            assert_near(&(name, mean, sd), other);
        }
    }
}

#[test]
fn a_weight_counts_rows_so_often_and_ties_hold_in_every_draw() {
    let options = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
    let data = measurement(Columns::Dolp);
    let half = |name: &str, half: usize, times: usize| {
        let rows: Vec<Row> = data.rows.iter().skip(half).step_by(2).copied().collect();
        Measurement { name: name.to_owned(), rows: rows.repeat(times), lines: Vec::new(), ..data.clone() }
    };
    // One half three times: weights 3 and 1, which are divided by their mean over the rows, 2.
    let (three, one) = (half("three", 0, 3), half("one", 1, 1));
    let repeated = JointFit::new([&three, &one], Model::GAUSS).options(options);
    let (single, one) = (half("three", 0, 1), half("one", 1, 1));
    let weighted = JointFit::new([&single, &one], Model::GAUSS).options(options).weights([3.0, 1.0]).problem().expect("a valid problem");
    let repeated = repeated.problem().expect("a valid problem");
    // By χ² the weighted problem is the repeated one with χ² halved: standard deviations are √2 times as large.
    let (by_weight, by_rows) = (moments(&weighted, vec![TRUTH; 2]), moments(&repeated, vec![TRUTH; 2]));
    let n = |of: &[(String, f64, f64)]| of.iter().find(|(name, ..)| name == "n").map(|(_, mean, sd)| (*mean, *sd)).expect("n is free");
    let ((mean, sd), (of_rows, sd_of_rows)) = (n(&by_weight), n(&by_rows));
    assert!(
        (mean - of_rows).abs() < 0.33 * sd_of_rows && (sd / sd_of_rows / 2.0_f64.sqrt() - 1.0).abs() < 0.3,
        "{by_weight:?} {by_rows:?}"
    );

    let tied = JointFit::new([&single, &one], Model::GAUSS).own([Parameter::N]).options(options);
    let tied = tied.each(|fit| fit.tie(Parameter::K, 1.4, Parameter::N).tie(Parameter::Kv, 1.5, Parameter::Kd));
    let tied = tied.problem().expect("a valid problem");
    let settings = PosteriorSettings { draws: 200, ..PosteriorSettings::default() };
    let posterior = Posterior::new(&tied, &[], settings).expect("a posterior");
    let sample = posterior.run(&[vec![TRUTH; 2]], Observer::NONE, &mut |_, _| {}).expect("draws");
    assert!(sample.parameters.iter().all(|name| ![Parameter::K, Parameter::Kv].contains(&name.parameter)));
    for parameters in sample.draws().flat_map(|draw| &draw.parameters) {
        assert_eq!((parameters.k, parameters.kv), (1.4 * parameters.n, 1.5 * parameters.kd));
    }
}

#[test]
fn a_prior_may_be_of_one_measurement_alone() {
    let data = measurement(Columns::Dolp);
    let [one, other] = ["one", "other"].map(|name| Measurement { name: name.to_owned(), ..data.clone() });
    let problem = JointFit::new([&one, &other], Model::GAUSS).own([Parameter::N]).problem().expect("a valid problem");
    let of = |set: Option<&str>| JointUnknown { parameter: Parameter::N, set: set.map(Into::into) };
    let (wide, narrow) = (Prior::Normal { mean: 2.0, sd: 0.5 }, Prior::Normal { mean: 2.2, sd: 0.001 });
    let settings = PosteriorSettings { draws: 300, ..PosteriorSettings::default() };
    let posterior = Posterior::new(&problem, &[(of(None), wide), (of(Some("other")), narrow)], settings).expect("a posterior");
    let sample = posterior.run(&[vec![TRUTH; 2]], Observer::NONE, &mut |_, _| {}).expect("draws");
    let [free, held] = ["one", "other"].map(|set| sample.summary(&of(Some(set))));
    assert!((held.mean - 2.2).abs() < 0.001 && held.sd < 0.0015 && free.sd > 0.003, "{held:?} {free:?}");
    let nobody = Posterior::new(&problem, &[(of(Some("nobody")), wide)], settings);
    assert!(matches!(nobody, Err(PosteriorError::Prior(PriorError::NotFree { .. }))), "{nobody:?}");
}

#[test]
fn a_narrow_prior_holds_its_parameter() {
    let settings = PosteriorSettings { draws: 300, ..PosteriorSettings::default() };
    let prior = Prior::Normal { mean: 2.2, sd: 0.001 };
    let uniform = Prior::Uniform { low: 2.0, high: 4.0 };
    let sample = drawn(Columns::Dolp, Weights::Sigma, &[(Parameter::N, prior), (Parameter::K, uniform)], settings);
    let (n, k) = (sample.summary(&Parameter::N), sample.summary(&Parameter::K));
    assert!((n.mean - 2.2).abs() < 0.001 && n.sd < 0.0015, "{n:?}");
    assert!(sample.draws().all(|draw| (2.0..=4.0).contains(&draw.parameters.k)), "{k:?}");
}

#[test]
fn the_seed_decides_and_a_cancelled_run_keeps_what_there_is() {
    let settings = PosteriorSettings { draws: 100, chains: 2, seed: 9 };
    let run = |seed| drawn(Columns::Dolp, Weights::None, &[], PosteriorSettings { seed, ..settings }).chains;
    assert_eq!(run(9), run(9));
    assert_ne!(run(9), run(10));

    let data = measurement(Columns::Dolp);
    let problem = Fit::new(&data, Model::GAUSS).problem().expect("a valid problem");
    let posterior = Posterior::new(&problem, &[], PosteriorSettings { draws: 2000, ..settings }).expect("a posterior");
    let done = std::sync::atomic::AtomicBool::new(false);
    let cancelled = || done.load(std::sync::atomic::Ordering::Relaxed);
    let observer = Observer { cancelled: &cancelled, ..Observer::NONE };
    let mut stop = |_: f64, sample: &dyn Fn() -> PosteriorSample| {
        if sample().len() >= 500 {
            done.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    };
    let start = fit(posterior.problem(), Starts::One, 1, Observer::NONE).parameters;
    let sample = posterior.run(&[start], observer, &mut stop).expect("draws");
    assert!((500..4000).contains(&sample.len()), "{}", sample.len());
    assert!(sample.chains[0].len() == sample.chains[1].len());
}

/// Simulation-based calibration (Talts et al., arXiv:1804.06788): the rank of the truth among draws of its posterior is uniform.
#[test]
#[ignore = "200 posteriors"]
fn ranks_of_the_truth_are_uniform() {
    const TRUTHS: u64 = 200;
    const RANKS: usize = 100;
    const BINS: usize = 10;
    // Quantile of χ² with nine degrees of freedom at 0.999.
    const LARGEST: f64 = 27.88;
    let ranges = [
        (Parameter::N, 0.4, 4.0),
        (Parameter::K, 1.0, 6.0),
        (Parameter::Sigma, 0.1, 0.7),
        (Parameter::Kd, 0.0, 0.4),
        (Parameter::Kv, 0.0, 0.5),
        (Parameter::Q, 1.3, 6.0),
        (Parameter::C, -0.9, -0.1),
        (Parameter::SigmaV, 0.2, 1.2),
    ];
    let geometries =
        grid_geometries(&[15.0, 30.0, 45.0, 60.0, 75.0], &[0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0], 180.0).expect("valid angles");
    let mut ranks: HashMap<Parameter, Vec<usize>> = HashMap::new();
    let (mut divergences, mut largest_rhat) = (0, 0.0_f64);
    for seed in 0..TRUTHS {
        let mut generator = Pcg64::seed_from_u64(seed);
        let mut uniform = || ((generator.next_u64() >> 11) + 1) as f64 / 9_007_199_254_740_992.0;
        let mut truth = TRUTH;
        for (parameter, low, high) in ranges {
            truth[parameter] = low + (high - low) * uniform();
        }
        let surface = Pbrdf::new(Model::CAUCHY, truth).expect("a surface");
        // Not clipped at 0: the likelihood is Gaussian.
        let rows = geometries.iter().map(|&geometry| {
            let deviate = (-2.0 * libm::log(uniform())).sqrt() * libm::cos(std::f64::consts::TAU * uniform());
            let value = surface.dolp(&Facet::new(geometry)) + 0.005 * deviate;
            Row { geometry, dolp: Some(Quantity { value, sigma: Some(0.005) }), brdf: None, masked: false }
        });
        let data = Measurement { rows: rows.collect(), ..Measurement::default() };
        let options = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
        let problem = Fit::new(&data, Model::CAUCHY).options(options).problem().expect("a valid problem");
        let priors = ranges.map(|(parameter, low, high)| (parameter.into(), Prior::Uniform { low, high }));
        let settings = PosteriorSettings { draws: 1000, chains: 2, seed };
        let posterior = Posterior::new(&problem, &priors, settings).expect("a posterior");
        let start = fit(&posterior.problem().with_start(truth), Starts::One, 1, Observer::NONE).parameters;
        let sample = posterior.run(&[start], Observer::NONE, &mut |_, _| {}).expect("draws");
        divergences += sample.divergences;
        for (parameter, ..) in ranges {
            let summary = sample.summary(&parameter);
            largest_rhat = largest_rhat.max(summary.convergence.expect("draws enough").rhat);
            let thinned = sample.draws().step_by(sample.len() / (RANKS - 1)).take(RANKS - 1);
            let rank = thinned.filter(|draw| draw.parameters[parameter] < truth[parameter]).count();
            ranks.entry(parameter).or_default().push(rank);
        }
    }
    println!("{divergences} of {} transitions diverged; largest R̂ {largest_rhat:.3}", TRUTHS * 2000);
    for (parameter, ..) in ranges {
        let mut bins = [0_u32; BINS];
        ranks[&parameter].iter().for_each(|rank| bins[rank * BINS / RANKS] += 1);
        let expected = TRUTHS as f64 / BINS as f64;
        let chi2: f64 = bins.iter().map(|&count| (f64::from(count) - expected).powi(2) / expected).sum();
        println!("{:<8} {bins:?} χ² {chi2:.1}", parameter.key());
        assert!(chi2 < LARGEST, "{parameter:?}: {chi2}");
    }
}
