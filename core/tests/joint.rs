//! Fits of several measurements: reference problems, invariances, what is shared and what is own.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

use pbrdf::fit::{Interval, Intervals, JointError, JointFit, JointResult, Observer, Starts, UnknownName};
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::model::{Model, Parameter, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;
use pbrdf::{Fit, Measurement};
use std::path::Path;

/// Two descents to one minimum agree in the objective to this fraction.
const SAME: f64 = 1e-6;

/// A problem of the reference set: simulated data, best objective of SciPy's `least_squares` from 32 starts.
struct Reference {
    files: &'static [&'static str],
    distribution: SlopeDistribution,
    own: &'static [Parameter],
    objective: f64,
}

const REFERENCES: [Reference; 4] = [
    Reference {
        files: &["j00_a", "j00_b"],
        distribution: SlopeDistribution::Cauchy,
        own: &[Parameter::N, Parameter::K],
        // Without noise: rounding.
        objective: 1e-20,
    },
    Reference {
        files: &["j02_a", "j02_b"],
        distribution: SlopeDistribution::Cauchy,
        own: &[Parameter::Sigma, Parameter::Kd, Parameter::Kv],
        objective: 0.000_141_213_819_679_554_35,
    },
    Reference {
        files: &["j03_a", "j03_b", "j03_c"],
        distribution: SlopeDistribution::Gauss,
        own: &[Parameter::N, Parameter::K],
        objective: 0.000_292_180_132_610_690_8,
    },
    Reference {
        files: &["j05_a", "j05_b", "j05_c"],
        distribution: SlopeDistribution::Gauss,
        own: &[Parameter::Sigma, Parameter::Kd, Parameter::Kv],
        objective: 0.002_040_505_746_340_862_6,
    },
];

fn read(name: &str) -> Measurement {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/joint").join(format!("{name}.csv"));
    let bytes = std::fs::read(path).expect("a file of the reference set");
    Measurement { name: name.to_owned(), ..Measurement::read(&bytes[..]).expect("a measurement") }
}

fn result_of(fit: &JointFit<'_>) -> JointResult {
    fit.clone().intervals(Intervals::Linear).run().expect("a valid fit")
}

#[test]
fn the_best_minimum_known_is_found() {
    for Reference { files, distribution, own, objective } in REFERENCES {
        let data: Vec<Measurement> = files.iter().map(|name| read(name)).collect();
        let result = result_of(&JointFit::new(&data, Model::full(distribution)).own(own.iter().copied()));
        let found = result.objective.expect("measured values above 0");
        assert!(found <= objective * (1.0 + SAME), "{files:?}: {found:e} instead of {objective:e}");
        assert!(result.sets.iter().all(|set| set.own.iter().map(|estimate| estimate.parameter).eq(own.iter().copied())));
        assert!(result.shared.iter().all(|estimate| !own.contains(&estimate.parameter)));
    }
}

#[test]
fn without_own_parameters_several_measurements_are_one_with_all_rows() {
    let data = ["j03_a", "j03_b", "j03_c"].map(read);
    let rows = data.iter().flat_map(|measurement| measurement.rows.iter().copied());
    let whole = Measurement { rows: rows.collect(), ..Measurement::default() };
    let joint = JointFit::new(&data, Model::GAUSS).run().expect("a valid fit");
    let one = Fit::new(&whole, Model::GAUSS).run().expect("a valid fit");
    let (together, alone) = (joint.objective.expect("values"), one.objective.expect("values"));
    assert!((together / alone - 1.0).abs() <= SAME, "{together:e} {alone:e}");
    assert_eq!((joint.statistics.dof, joint.shared.len()), (one.statistics.dof, one.estimates.len()));
    for (shared, estimate) in joint.shared.iter().zip(&one.estimates) {
        assert_eq!((shared.parameter, shared.free, shared.determined), (estimate.parameter, estimate.free, estimate.determined));
    }
}

#[test]
fn with_all_parameters_own_several_measurements_are_separate_fits() {
    let data = ["j02_a", "j02_b"].map(read);
    let joint = result_of(&JointFit::new(&data, Model::CAUCHY).own(Parameter::ALL));
    assert!(joint.shared.is_empty());
    for (set, measurement) in joint.sets.iter().zip(&data) {
        let alone = Fit::new(measurement, Model::CAUCHY).intervals(Intervals::Linear).run().expect("a valid fit");
        let (together, apart) = (set.objective.expect("values"), alone.objective.expect("values"));
        assert!((together / apart - 1.0).abs() <= SAME, "{together:e} {apart:e}");
    }
}

#[test]
fn names_say_which_measurement_an_own_parameter_belongs_to() {
    let data = ["j03_a", "j03_b"].map(read);
    let fit = JointFit::new(&data, Model::GAUSS).named(["blue", "red"]).own([Parameter::N]);
    let problem = fit.problem().expect("a valid fit");
    let names: Vec<String> = problem.unknowns().iter().map(|unknown| unknown.key().into_owned()).collect();
    assert_eq!(names, ["n@blue", "n@red", "k", "sigma", "kd", "kv", "c", "sigma_v"]);
    let error = |fit: &JointFit<'_>| fit.problem().expect_err("no fit");
    assert_eq!(error(&fit.clone().named(["red", "red"])), JointError::NameTwice("red".to_owned()));
    assert_eq!(error(&fit.clone().own([Parameter::Q])), JointError::OwnOfNone(Parameter::Q), "Gauss has no q");
    let shared = fit.clone().only("red", |fit| fit.fix(Parameter::K, 3.5)).expect("a measurement of that name");
    assert!(matches!(error(&shared), JointError::SharedDiffers { parameter: Parameter::K, .. }));
    assert!(matches!(fit.clone().only("green", |fit| fit), Err(JointError::UnknownName { .. })));
    let own = fit.only("red", |fit| fit.fix(Parameter::N, 1.2)).expect("a measurement of that name");
    let result = result_of(&own.starts(Starts::One));
    assert_eq!((result.sets[1].own[0].value, result.sets[1].own[0].free, result.sets[0].own[0].free), (1.2, false, true));
}

const TRUTH: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 0.8, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 };

fn simulated(surface: Parameters, columns: Columns, noise: f64, seed: u64) -> Measurement {
    Simulation {
        model_name: "test".to_owned(),
        surface: Pbrdf::new(Model::CAUCHY, surface).expect("a valid surface"),
        theta_i: (1..9).map(|i| f64::from(10 * i)).collect(),
        theta_r: (0..18).map(|i| f64::from(5 * i)).collect(),
        dphi: 180.0,
        columns,
        noise,
        brdf_noise: noise,
        seed,
    }
    .run()
    .expect("valid angles")
}

#[test]
fn a_brdf_of_one_measurement_determines_a_shared_ks_for_all() {
    let (dolp, both) = (simulated(TRUTH, Columns::Dolp, 0.002, 1), simulated(TRUTH, Columns::Both, 0.002, 2));
    let fit = JointFit::new([&dolp, &both], Model::CAUCHY).own([Parameter::N, Parameter::K]).start(Parameter::Ks, 1.0);
    let result = result_of(&fit);
    let ks = result.shared.iter().find(|estimate| estimate.parameter == Parameter::Ks).expect("the model has it");
    assert!(ks.free && (ks.value - TRUTH.ks).abs() < 5.0 * ks.std_error.expect("determined"), "{ks:?}");
    // An own k_s stays where its measurement has none.
    let own = result_of(&JointFit::new([&dolp, &both], Model::CAUCHY).own([Parameter::Ks, Parameter::Kd, Parameter::Kv]));
    let free = |set: usize| own.estimate(set, Parameter::Ks).is_some_and(|estimate| estimate.free);
    assert_eq!((free(0), free(1), own.sets[0].parameters.ks), (false, true, 1.0));
}

#[test]
fn a_cancelled_fit_returns_its_start() {
    let data = ["j03_a", "j03_b"].map(read);
    let observer = Observer { cancelled: &|| true, ..Observer::NONE };
    let result = JointFit::new(&data, Model::GAUSS).own([Parameter::N]).observe(observer).run().expect("a valid fit");
    assert_eq!(result.stop_reason, pbrdf::fit::StopReason::Cancelled);
}

/// Joint intervals at 68.3 % are shorter on average than the separate ones for what is shared, and hold the truth as often as they say.
#[test]
#[ignore = "takes minutes in a release build"]
fn joint_intervals_are_shorter_and_calibrated() {
    const DRAWS: u64 = 100;
    /// Draws whose measurements are fitted alone, too: one interval alone may be short by chance.
    const ALONE: u64 = 10;
    let wavelengths = [TRUTH, Parameters { n: 1.6, k: 2.4, ..TRUTH }, Parameters { n: 2.6, k: 3.6, ..TRUTH }];
    let wavelengths = wavelengths.map(|surface| Parameters { ks: 1.0, ..surface });
    let shared = [Parameter::Sigma, Parameter::Kd, Parameter::Kv, Parameter::Q, Parameter::C, Parameter::SigmaV];
    let length = |interval: Interval| interval.high.zip(interval.low).map_or(f64::INFINITY, |(high, low)| high - low);
    let mut covered = [0_u32; 6];
    // Sums over the draws that are fitted alone, too: joint, and of each measurement.
    let (mut joint_lengths, mut alone_lengths) = ([0.0; 6], [[0.0; 6]; 3]);
    let mut own_covered = 0;
    for draw in 0..DRAWS {
        let data: Vec<Measurement> =
            wavelengths.iter().zip(0..).map(|(surface, i)| simulated(*surface, Columns::Dolp, 0.005, 3 * draw + i)).collect();
        let result = JointFit::new(&data, Model::CAUCHY).own([Parameter::N, Parameter::K]).run().expect("a valid fit");
        for (i, parameter) in shared.into_iter().enumerate() {
            let interval = result.estimate(0, parameter).and_then(|estimate| estimate.interval68).expect("an interval");
            covered[i] += u32::from(interval.contains(wavelengths[0][parameter]));
            joint_lengths[i] += if draw < ALONE { length(interval) } else { 0.0 };
        }
        for (set, surface) in result.sets.iter().zip(&wavelengths) {
            own_covered += set.own.iter().filter(|own| own.interval68.is_some_and(|of| of.contains(surface[own.parameter]))).count();
        }
        for (measurement, lengths) in data.iter().zip(&mut alone_lengths).filter(|_| draw < ALONE) {
            let alone = Fit::new(measurement, Model::CAUCHY).run().expect("a valid fit");
            for (sum, parameter) in lengths.iter_mut().zip(shared) {
                *sum += length(alone[parameter].interval68.expect("an interval"));
            }
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "ten")]
    let mean = |sum: f64| sum / ALONE as f64;
    for (i, parameter) in shared.into_iter().enumerate() {
        let alone = alone_lengths.map(|lengths| mean(lengths[i]));
        println!("{:<8} {} % within, {:.4} long, alone {alone:.4?}", parameter.key(), covered[i], mean(joint_lengths[i]));
    }
    println!("own      {} % within", own_covered / 6);
    for (i, parameter) in shared.into_iter().enumerate() {
        assert!(alone_lengths.iter().all(|alone| joint_lengths[i] < alone[i]), "{parameter:?}: {joint_lengths:?} {alone_lengths:?}");
    }
    assert!(covered.iter().all(|share| (58..=78).contains(share)), "{covered:?}");
}
