//! Which angles to measure: against reference designs, against what was asked for, and against fits.
//!
//! Slow ones: `cargo test --release --test angles -- --ignored --nocapture`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

use pbrdf::fit::{
    AngleChoice, AngleChoiceError, Bounds, CandidateGrid, ChosenAngles, Design, DesignCriterion, DesignPrediction, FitOptions, NoiseModel,
    Observer, Problem, Starts, Weights, choose, fit, free_by_default,
};
use pbrdf::measurement::{Measurement, Quantity, Row};
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters, Pbrdf, Preset};
use pbrdf::optics::{Facet, Geometry};
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
    2.0 * jacobian.singular_values().iter().map(|value| value.ln()).sum::<f64>()
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
