//! Which angles to measure: against reference designs, against what was asked for, and against fits.
//!
//! Slow ones: `cargo test --release --test angles -- --ignored --nocapture`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "numbers of draws and fits")]

use pbrdf::fit::posterior::{Posterior, PosteriorSettings};
use pbrdf::fit::{
    AngleChoice, AngleChoiceError, Bounds, CandidateGrid, ChosenAngles, Design, DesignCriterion, DesignPrediction, FitOptions, NoiseModel,
    Observer, Problem, Starts, Weights, choose, fit, free_by_default, next_gains,
};
use pbrdf::measurement::{Measurement, Quantity, Row};
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters, Pbrdf, Preset};
use pbrdf::optics::{Facet, Geometry};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};
use serde_json::Value;
use std::path::Path;

const STEEL: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.67, ks: 1.0, kd: 0.12, kv: 0.25, q: 2.2, c: -0.4, sigma_v: 0.6 };
const COPPER: Parameters = Parameters { n: 0.4, k: 2.95, sigma: 0.3, ks: 1.0, kd: 0.1, kv: 0.1, q: 2.0, c: -0.5, sigma_v: 0.5 };

fn range(text: &str) -> Vec<f64> {
    let parts: Vec<f64> = text.split(':').map(|part| part.parse().expect("a number")).collect();
    let count = ((parts[1] - parts[0]) / parts[2]).round() as usize;
    (0..=count).map(|i| parts[0] + i as f64 * parts[2]).collect()
}

fn grid(theta_i: &str, theta_r: &str) -> CandidateGrid {
    CandidateGrid::new(&range(theta_i), &range(theta_r), &[180.0]).expect("a grid")
}

fn request(model: Model, surface: Parameters, grid: CandidateGrid, count: usize, criterion: DesignCriterion) -> AngleChoice {
    let noise = NoiseModel { dolp: Some(0.005), brdf: None };
    let free = model.dolp_parameters().without(Parameter::Ks);
    AngleChoice { model, surfaces: vec![surface], noise, free, grid, given: Vec::new(), count, repeats: false, criterion }
}

fn chosen(choice: &AngleChoice) -> ChosenAngles {
    choose(choice, Observer::NONE, &|_| {}).expect("angles")
}

fn geometries(angles: &ChosenAngles) -> Vec<Geometry> {
    let repeated = angles.angles.iter().flat_map(|&(angles, times)| std::iter::repeat_n(angles, times));
    let of = |[theta_i, theta_r, dphi]: [f64; 3]| {
        if theta_r < 0.0 { Geometry::in_plane(theta_i, theta_r) } else { Geometry::new(theta_i, theta_r, dphi) }
    };
    repeated.map(|angles| of(angles).expect("angles in range")).collect()
}

fn predicted(choice: &AngleChoice, angles: &ChosenAngles) -> DesignPrediction {
    let design = Design { free: choice.free, ..Design::new(choice.model, choice.surfaces[0], geometries(angles), choice.noise) };
    design.predict().expect("a prediction")
}

/// The sum of the relative variances of n and k.
fn relative_variances(choice: &AngleChoice, angles: &ChosenAngles) -> f64 {
    let errors = predicted(choice, angles).errors;
    let of = |parameter| {
        let error = errors.iter().find(|(other, _)| *other == parameter).and_then(|(_, error)| *error).expect("determined");
        (error / choice.surfaces[0][parameter].max(0.1)).powi(2)
    };
    of(Parameter::N) + of(Parameter::K)
}

#[test]
fn d_optimal_angles_are_as_good_as_the_reference() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/designs/reference.json");
    let text = std::fs::read_to_string(path).expect("a table of the repository");
    for case in serde_json::from_str::<Vec<Value>>(&text).expect("cases") {
        let text = |key: &str| case[key].as_str().expect("a text");
        let preset = Preset::from_key(text("model")).expect("a model");
        let mut surface = Parameters::default();
        for parameter in Parameter::ALL {
            surface[parameter] = case["truth"][parameter.key()].as_f64().expect("a number");
        }
        let count = case["choose"].as_u64().expect("a count") as usize;
        let choice = request(preset.model, surface, grid(text("theta_i"), text("theta_r")), count, DesignCriterion::Determinant);
        let angles = chosen(&choice);
        let reference = case["log_det"].as_f64().expect("a number");
        // The reference is an exchange from 60 beginnings; 0.02 is a hundredth of the standard error of one of eight parameters.
        assert!(angles.value > reference - 0.02, "{}: {} instead of {reference}", text("name"), angles.value);
        assert_eq!(angles.angles.len(), count, "each once");
        assert!(angles.efficiency > 0.0 && angles.efficiency < 1.0);
        // Rounding of the two ways to the same number: singular values span four decades.
        let value = log_det(&choice, &geometries(&angles));
        assert!((angles.value - value).abs() < 1e-6, "{}: {} instead of {value}", text("name"), angles.value);
    }
}

/// ln det of unit noise by its definition.
fn log_det(choice: &AngleChoice, geometries: &[Geometry]) -> f64 {
    let surface = Pbrdf::new(choice.model, choice.surfaces[0]).expect("a surface");
    let free: Vec<Parameter> = choice.free.iter().collect();
    let rows = geometries.iter().flat_map(|&geometry| {
        let (_, gradient) = surface.reflection_and_gradient(&Facet::new(geometry), pbrdf::model::GradientRequest::ALL);
        free.iter().map(|&parameter| gradient.dolp[parameter] * choice.surfaces[0][parameter].abs().max(0.1)).collect::<Vec<_>>()
    });
    let jacobian = nalgebra::DMatrix::from_row_iterator(geometries.len(), free.len(), rows.collect::<Vec<_>>());
    2.0 * jacobian.singular_values().iter().map(|&value| libm::log(value)).sum::<f64>()
}

#[test]
fn angles_for_n_and_k_determine_them_better() {
    let cases = [(Model::CAUCHY, STEEL, 27), (Model::CAUCHY, COPPER, 12), (Model::GAUSS, STEEL, 9)];
    for (model, surface, count) in cases {
        let grid = grid("20:80:10", "0:80:10");
        let all = request(model, surface, grid.clone(), count, DesignCriterion::Determinant);
        let two = request(model, surface, grid, count, DesignCriterion::Variances(vec![Parameter::N, Parameter::K]));
        let (of_all, of_two) = (chosen(&all), chosen(&two));
        let (worse, better) = (relative_variances(&all, &of_all), relative_variances(&two, &of_two));
        assert!(better < worse, "{model:?} {count}: {better} instead of {worse}");
        assert!((better / of_two.value - 1.0).abs() < 1e-6, "{better} and {}", of_two.value);
    }
}

#[test]
fn what_is_given_and_repeats_count() {
    let alone = request(Model::CAUCHY, STEEL, grid("20:80:10", "0:80:10"), 10, DesignCriterion::Determinant);
    let first = chosen(&alone);
    let row = |geometry| Row { geometry, dolp: Some(Quantity { value: 0.1, sigma: Some(0.005) }), brdf: None, masked: false };
    let more = AngleChoice { given: geometries(&first).into_iter().map(row).collect(), ..alone.clone() };
    assert!(chosen(&more).value > first.value + 1.0, "twice the readings");
    let often = AngleChoice { count: 40, repeats: true, grid: grid("30:70:40", "0:80:10"), ..alone };
    let angles = chosen(&often);
    assert_eq!(angles.angles.iter().map(|(_, times)| times).sum::<usize>(), 40);
    assert!(angles.angles.iter().any(|(_, times)| *times > 1));
}

#[test]
fn a_rival_is_fitted_as_well_as_it_can_be() {
    let criterion = DesignCriterion::Discrimination { rival: Model::GAUSS, fixed: ParameterSet::EMPTY };
    let choice = request(Model::CAUCHY, STEEL, grid("20:80:15", "0:80:20"), 12, criterion);
    let angles = chosen(&choice);
    let surface = Pbrdf::new(choice.model, STEEL).expect("a surface");
    let chi2 = |geometries: Vec<Geometry>| {
        let row = |geometry: Geometry| {
            let value = surface.dolp(&Facet::new(geometry));
            Row { geometry, dolp: Some(Quantity { value, sigma: Some(0.005) }), brdf: None, masked: false }
        };
        let measurement = Measurement { rows: geometries.into_iter().map(row).collect(), ..Measurement::default() };
        let options = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
        let free = free_by_default(Model::GAUSS, &measurement, &options);
        let problem = Problem::new(&measurement, Model::GAUSS, STEEL, free, Bounds::default(), options).expect("a problem");
        fit(&problem, Starts::Automatic, 3, Observer::NONE).statistics.chi2.expect("stated errors")
    };
    let best = chi2(geometries(&angles));
    // Both are minima to the tolerance of the solver.
    assert!((angles.value / best - 1.0).abs() < 1e-3, "{} instead of {best}", angles.value);
    let d = chosen(&AngleChoice { criterion: DesignCriterion::Determinant, ..choice });
    assert!(chi2(geometries(&d)) < best);
}

#[test]
fn what_cannot_be_chosen_is_said() {
    let grid = || grid("20:80:10", "0:80:10");
    let choice = request(Model::CAUCHY, STEEL, grid(), 27, DesignCriterion::Determinant);
    let refused = |choice: &AngleChoice| choose(choice, Observer::NONE, &|_| {}).expect_err("no angles");
    let (few, many) = (AngleChoice { count: 7, ..choice.clone() }, AngleChoice { count: 64, ..choice.clone() });
    assert_eq!(refused(&few), AngleChoiceError::TooFewReadings { values: 7, parameters: 8 });
    assert_eq!(refused(&many), AngleChoiceError::TooFewCandidates { candidates: 63, count: 64 });
    let ratios = AngleChoice { free: choice.free.with(Parameter::Ks), ..choice.clone() };
    assert!(matches!(refused(&ratios), AngleChoiceError::Undetermined { parameters } if parameters.contains(&Parameter::Ks)));
    let held = AngleChoice { criterion: DesignCriterion::Variances(vec![Parameter::Ks]), ..choice.clone() };
    assert_eq!(refused(&held), AngleChoiceError::NotFree { parameter: Parameter::Ks });
    let own = DesignCriterion::Discrimination { rival: Model::CAUCHY, fixed: ParameterSet::EMPTY };
    assert_eq!(refused(&AngleChoice { criterion: own, ..choice.clone() }), AngleChoiceError::SameModel);
    let cancelled = Observer { cancelled: &|| true, ..Observer::NONE };
    assert_eq!(choose(&choice, cancelled, &|_| {}).expect_err("cancelled"), AngleChoiceError::Cancelled);
}

/// A measurement of a surface, its noise from a seed and not clipped, with its standard deviation stated.
fn measured(surface: &Pbrdf, geometries: &[Geometry], noise: f64, seed: u64) -> Measurement {
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut uniform = || ((generator.next_u64() >> 11) + 1) as f64 / 9_007_199_254_740_992.0;
    let rows = geometries.iter().map(|&geometry| {
        let deviate = (-2.0 * libm::log(uniform())).sqrt() * libm::cos(std::f64::consts::TAU * uniform());
        let value = surface.dolp(&Facet::new(geometry)) + noise * deviate;
        Row { geometry, dolp: Some(Quantity { value, sigma: Some(noise) }), brdf: None, masked: false }
    });
    Measurement { rows: rows.collect(), ..Measurement::default() }
}

/// χ² of the best fit of a model near a start, and the fit.
fn fitted(model: Model, measurement: &Measurement, start: Parameters, starts: Starts) -> (f64, Parameters) {
    let options = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
    let free = free_by_default(model, measurement, &options);
    let problem = Problem::new(measurement, model, start, free, Bounds::default(), options).expect("a problem");
    let result = fit(&problem, starts, 1, Observer::NONE);
    (result.statistics.chi2.expect("stated errors"), result.parameters)
}

/// At noise 0.001 the problem is linear: fits scatter as predicted. 200 fits tell a standard deviation within 5 %: four of those.
/// At 0.005 it is not, and the figures are printed only.
#[test]
#[ignore = "400 fits"]
fn fits_at_chosen_angles_scatter_as_predicted() {
    for noise in [0.001, 0.005] {
        let grid = grid("10:80:5", "0:85:5");
        let noise_model = NoiseModel { dolp: Some(noise), brdf: None };
        let choice = AngleChoice { noise: noise_model, ..request(Model::CAUCHY, STEEL, grid, 27, DesignCriterion::Determinant) };
        let angles = chosen(&choice);
        let (prediction, places) = (predicted(&choice, &angles), geometries(&angles));
        let surface = Pbrdf::new(Model::CAUCHY, STEEL).expect("a surface");
        let fits: Vec<Parameters> =
            (0..200).map(|seed| fitted(Model::CAUCHY, &measured(&surface, &places, noise, seed), STEEL, Starts::One).1).collect();
        for &(parameter, error) in &prediction.errors {
            let values: Vec<f64> = fits.iter().map(|fit| fit[parameter]).collect();
            let mean = values.iter().sum::<f64>() / 200.0;
            let scatter = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 199.0).sqrt();
            let error = error.expect("determined");
            let is_determined = prediction.determined.contains(parameter);
            println!(
                "noise {noise} {:<8} predicted {error:.5} scatter {scatter:.5} ratio {:.3} {is_determined}",
                parameter.key(),
                scatter / error
            );
            assert!(noise > 0.001 || !is_determined || (scatter / error - 1.0).abs() < 0.2, "{parameter:?}");
        }
    }
}

/// An exchange of its own, with inverses formed anew, from many beginnings.
fn long_search(choice: &AngleChoice, beginnings: u64) -> f64 {
    let surface = Pbrdf::new(choice.model, choice.surfaces[0]).expect("a surface");
    let free: Vec<Parameter> = choice.free.iter().collect();
    let rows: Vec<nalgebra::DVector<f64>> = (0..choice.grid.len())
        .map(|candidate| {
            let facet = Facet::new(choice.grid.geometry(candidate).expect("a geometry"));
            let (_, gradient) = surface.reflection_and_gradient(&facet, pbrdf::model::GradientRequest::ALL);
            let of = |&parameter: &Parameter| gradient.dolp[parameter] * choice.surfaces[0][parameter].abs().max(0.1);
            nalgebra::DVector::from_iterator(free.len(), free.iter().map(of))
        })
        .collect();
    // Columns of one length: the determinant of the scales is added at the end.
    let lengths: Vec<f64> = (0..free.len()).map(|j| rows.iter().map(|row| row[j] * row[j]).sum::<f64>().sqrt()).collect();
    let rows: Vec<nalgebra::DVector<f64>> =
        rows.iter().map(|row| nalgebra::DVector::from_fn(free.len(), |j, _| row[j] / lengths[j])).collect();
    let information = |set: &[usize]| {
        let ridge = nalgebra::DMatrix::identity(free.len(), free.len()) * 1e-13;
        set.iter().fold(ridge, |sum, &candidate| sum + &rows[candidate] * rows[candidate].transpose())
    };
    let mut best = f64::NEG_INFINITY;
    for seed in 0..beginnings {
        let mut generator = Pcg64::seed_from_u64(1000 + seed);
        let mut set: Vec<usize> = Vec::new();
        while set.len() < choice.count {
            let candidate = (generator.next_u64() % choice.grid.len() as u64) as usize;
            if !set.contains(&candidate) {
                set.push(candidate);
            }
        }
        loop {
            let mut gained = false;
            for place in 0..set.len() {
                let without: Vec<usize> = set.iter().copied().filter(|&candidate| candidate != set[place]).collect();
                let Some(inverse) = information(&without).try_inverse() else { continue };
                let worth = |candidate: usize| (rows[candidate].transpose() * &inverse * &rows[candidate])[0];
                let candidates = (0..choice.grid.len()).filter(|candidate| !without.contains(candidate));
                let other = candidates.max_by(|&a, &b| worth(a).total_cmp(&worth(b))).expect("candidates");
                if worth(other) > worth(set[place]) * (1.0 + 1e-9) {
                    set[place] = other;
                    gained = true;
                }
            }
            if !gained {
                break;
            }
        }
        let det = information(&set).symmetric_eigenvalues().iter().map(|&value| libm::log(value)).sum::<f64>();
        best = best.max(det + 2.0 * lengths.iter().map(|&length| libm::log(length)).sum::<f64>());
    }
    best
}

#[test]
#[ignore = "a long search for each of many problems"]
fn chosen_angles_are_those_of_a_long_search() {
    let rough = Parameters { n: 1.24, k: 6.6, sigma: 0.25, kd: 0.05, kv: 0.02, q: 3.0, c: -0.7, sigma_v: 0.9, ..STEEL };
    let glass = Parameters { n: 1.5, k: 0.05, sigma: 0.4, kd: 0.02, kv: 0.1, q: 1.6, c: -0.2, sigma_v: 0.35, ..STEEL };
    let models = [(Model::CAUCHY, 27), (Model::GAUSS, 14), (Model::GAUSS, 40), (Model::CAUCHY, 9)];
    for surface in [STEEL, COPPER, rough, glass] {
        for (model, count) in models {
            for (theta_i, theta_r) in [("10:80:10", "-80:80:10"), ("20:70:5", "0:75:5"), ("5:85:8", "2:86:7")] {
                let d = request(model, surface, grid(theta_i, theta_r), count, DesignCriterion::Determinant);
                let c = AngleChoice { criterion: DesignCriterion::Variances(vec![Parameter::N, Parameter::K]), ..d.clone() };
                let (of_d, of_c, reference) = (chosen(&d), chosen(&c), long_search(&d, 40));
                let gap = reference - of_d.value;
                let ratio = of_c.value / relative_variances(&d, &of_d);
                println!(
                    "n {:.2} {count:>2} {theta_i} {theta_r}: ln det {:.4}, {gap:+.4} behind; c over d {ratio:.3}",
                    surface.n, of_d.value
                );
                assert!(gap < 0.02 && ratio < 1.0);
            }
        }
    }
}

#[test]
#[ignore = "a fit for each exchange"]
fn the_rival_is_told_as_well_as_by_a_long_search() {
    for (surface, model, rival) in
        [(STEEL, Model::CAUCHY, Model::GAUSS), (COPPER, Model::CAUCHY, Model::GAUSS), (STEEL, Model::GAUSS, Model::CAUCHY)]
    {
        let criterion = DesignCriterion::Discrimination { rival, fixed: ParameterSet::EMPTY };
        let choice = request(model, surface, grid("20:80:12", "0:80:16"), 12, criterion);
        let angles = chosen(&choice);
        let truth = Pbrdf::new(model, surface).expect("a surface");
        let t = |set: &[usize], start: Parameters, starts: Starts| {
            let places: Vec<Geometry> = set.iter().map(|&candidate| choice.grid.geometry(candidate).expect("a geometry")).collect();
            let mut measurement = measured(&truth, &places, 0.005, 1);
            for row in &mut measurement.rows {
                row.dolp = row.dolp.map(|dolp| Quantity { value: truth.dolp(&Facet::new(row.geometry)), ..dolp });
            }
            fitted(rival, &measurement, start, starts)
        };
        let mut best: f64 = 0.0;
        for seed in 0..6 {
            let mut generator = Pcg64::seed_from_u64(seed);
            let mut set: Vec<usize> = (0..choice.grid.len()).collect();
            set.sort_by_cached_key(|_| generator.next_u64());
            set.truncate(choice.count);
            let (mut value, mut start) = t(&set, surface, Starts::Exactly(12));
            loop {
                let mut gained = false;
                for place in 0..set.len() {
                    for candidate in 0..choice.grid.len() {
                        let mut other = set.clone();
                        other[place] = candidate;
                        if set.contains(&candidate) || t(&other, start, Starts::One).0 <= value * (1.0 + 1e-6) {
                            continue;
                        }
                        // A fit from one start may miss the best one: a gain must hold from several.
                        let thorough = t(&other, start, Starts::Exactly(12));
                        if thorough.0 > value * (1.0 + 1e-6) {
                            (value, start) = thorough;
                            set = other;
                            gained = true;
                        }
                    }
                }
                if !gained {
                    break;
                }
            }
            best = best.max(value);
        }
        println!(
            "n {:.2} {} from {}: T {:.4}, of a long search {best:.4}",
            surface.n,
            model.distribution.key(),
            rival.distribution.key(),
            angles.value
        );
        assert!(angles.value >= 0.95 * best, "{} instead of {best}", angles.value);
    }
}

#[test]
#[ignore = "draws from a posterior, and averages over them"]
fn a_plan_for_many_surfaces_is_better_at_the_worst_of_them() {
    let places = geometries_of(&[30.0, 40.0, 50.0], &range("20:60:5"));
    let surface = Pbrdf::new(Model::CAUCHY, STEEL).expect("a surface");
    for seed in 1..=3 {
        let measurement = measured(&surface, &places, 0.005, seed);
        let options = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
        let free = free_by_default(Model::CAUCHY, &measurement, &options);
        let problem = Problem::new(&measurement, Model::CAUCHY, STEEL, free, Bounds::default(), options).expect("a problem");
        let posterior = Posterior::new(&problem, &[], PosteriorSettings::default()).expect("a posterior");
        let minima: Vec<Parameters> =
            fit(&problem, Starts::Automatic, 1, Observer::NONE).course.minima.iter().map(|minimum| minimum.parameters).collect();
        let sample = posterior.run(&minima, Observer::NONE, &mut |_, _| {}).expect("draws");
        let draws: Vec<Parameters> = sample.draws().map(|draw| draw.parameters).collect();
        let mut mean = STEEL;
        for &parameter in &sample.parameters {
            mean[parameter] = sample.summary(&parameter).mean;
        }
        let local = request(Model::CAUCHY, mean, grid("10:80:5", "0:85:5"), 27, DesignCriterion::Determinant);
        let averaged = AngleChoice { surfaces: draws.clone(), ..local.clone() };
        // Other draws than those that the plan is averaged over.
        let truths: Vec<Parameters> = draws.iter().skip(160).step_by(draws.len() / 50).copied().take(50).collect();
        let at_truths = |angles: &ChosenAngles| {
            let places = geometries(angles);
            let mut values: Vec<f64> =
                truths.iter().map(|&truth| log_det(&AngleChoice { surfaces: vec![truth], ..local.clone() }, &places)).collect();
            values.sort_by(f64::total_cmp);
            [values[0], values[2], values[25]]
        };
        let (of_local, of_average) = (at_truths(&chosen(&local)), at_truths(&chosen(&averaged)));
        println!("data {seed}: ln det at the worst, third worst and median truth: local {of_local:.3?}, averaged {of_average:.3?}");
        assert!(of_average[0] > of_local[0]);
    }
}

fn geometries_of(theta_i: &[f64], theta_r: &[f64]) -> Vec<Geometry> {
    pbrdf::measurement::grid_geometries(theta_i, theta_r, 180.0).expect("angles in range")
}

/// What is measured as rows without a value: their noise is that of the plan.
fn planned(geometries: &[Geometry]) -> Vec<Row> {
    let dolp = Some(Quantity { value: 0.0, sigma: None });
    geometries.iter().map(|&geometry| Row { geometry, dolp, brdf: None, masked: false }).collect()
}

#[test]
fn the_next_gain_is_what_the_errors_say() {
    let grid = grid("20:70:10", "0:80:10");
    let choice = request(Model::CAUCHY, STEEL, grid, 14, DesignCriterion::Determinant);
    let first = geometries(&chosen(&choice));
    let given = planned(&first);
    let by_criterion = |criterion| {
        let choice = AngleChoice { given: given.clone(), criterion, ..choice.clone() };
        next_gains(&choice, Observer::NONE).expect("gains")
    };
    let (of_all, of_two) =
        (by_criterion(DesignCriterion::Determinant), by_criterion(DesignCriterion::Variances(vec![Parameter::N, Parameter::K])));
    let errors = |geometries: Vec<Geometry>| {
        let design = Design { free: choice.free, ..Design::new(choice.model, STEEL, geometries, choice.noise) };
        let errors = design.predict().expect("a prediction").errors;
        let relative = |name| {
            let error = errors.iter().find(|(other, _)| *other == name).and_then(|(_, error)| *error).expect("determined");
            (error / STEEL[name]).powi(2)
        };
        relative(Parameter::N) + relative(Parameter::K)
    };
    let before = errors(first.clone());
    for candidate in (0..choice.grid.len()).step_by(7) {
        let after = errors(first.iter().copied().chain([choice.grid.geometry(candidate).expect("a candidate")]).collect());
        // What is there before any reading is 1e-9 of all; the given readings tell 1e-4 of it in their weakest direction.
        assert!(
            (of_two[candidate] - libm::log(before / after)).abs() < 1e-3,
            "{candidate}: {} {}",
            of_two[candidate],
            libm::log(before / after)
        );
        assert!(of_all[candidate] >= 0.0);
    }
    // The reading that gains most by the determinant is the one that a choice of one more takes.
    let one = AngleChoice { given, count: 1, ..choice.clone() };
    let taken = chosen(&one).angles[0].0;
    let best = (0..of_all.len()).max_by(|&a, &b| of_all[a].total_cmp(&of_all[b])).expect("candidates");
    assert_eq!(choice.grid.angles(best), taken);
}

#[test]
fn the_next_reading_that_tells_models_apart_is_where_they_differ_most() {
    let rival = DesignCriterion::Discrimination { rival: Model::GAUSS, fixed: ParameterSet::EMPTY.with(Parameter::Ks) };
    let choice = request(Model::CAUCHY, STEEL, grid("20:80:20", "0:80:20"), 20, rival);
    let gains = next_gains(&choice, Observer::NONE).expect("gains");
    let all = chosen(&choice);
    // Of all candidates the sum of squares is T of all.
    assert!(
        (gains.iter().sum::<f64>() / all.of_all_candidates - 1.0).abs() < 0.02,
        "{} {}",
        gains.iter().sum::<f64>(),
        all.of_all_candidates
    );
    let same = AngleChoice { criterion: DesignCriterion::Discrimination { rival: Model::CAUCHY, fixed: ParameterSet::EMPTY }, ..choice };
    assert_eq!(next_gains(&same, Observer::NONE), Err(AngleChoiceError::SameModel));
}
