//! Bands around fitted curves, and plans of measurements.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

use nalgebra::{DMatrix, DVector};
use pbrdf::fit::{
    Bounds, BrdfResiduals, Design, EstimateStatus, FitOptions, NoiseModel, Observer, PredictionBand, Problem, Starts, StopReason,
    Uncertainty, Weights, fit, free_by_default,
};
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{GeometrySet, Model, Parameter, ParameterSet, Parameters, Pbrdf};
use pbrdf::optics::{Facet, Geometry, SlopeDistribution};

const TRUTH: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 };

fn grid(from: i32, to: i32, step: usize) -> Vec<f64> {
    (from..=to).step_by(step).map(f64::from).collect()
}

fn simulation(theta_i: Vec<f64>, columns: Columns, noise: f64, seed: u64) -> Simulation {
    Simulation {
        model_name: "test".to_owned(),
        surface: Pbrdf::new(Model::full(SlopeDistribution::Cauchy), TRUTH).expect("a valid surface"),
        theta_i,
        theta_r: grid(0, 85, 5),
        dphi: 180.0,
        columns,
        noise,
        brdf_noise: noise,
        seed,
    }
}

fn measured(theta_i: Vec<f64>, columns: Columns, noise: f64, seed: u64) -> Measurement {
    simulation(theta_i, columns, noise, seed).run().expect("valid angles")
}

fn problem(measurement: &Measurement, free: ParameterSet, choices: FitOptions) -> Problem {
    Problem::new(measurement, Model::full(SlopeDistribution::Cauchy), TRUTH, free, Bounds::default(), choices).expect("a valid problem")
}

fn band(problem: &Problem) -> PredictionBand {
    let sum = problem.sum_of_squares(&TRUTH).expect("a finite sum");
    PredictionBand::new(problem, &TRUTH, Uncertainty::at(problem, &TRUTH, sum, ParameterSet::EMPTY))
}

fn set(parameters: impl IntoIterator<Item = Parameter>) -> ParameterSet {
    parameters.into_iter().collect()
}

fn facets(theta_i: f64) -> Vec<Facet> {
    let at = |theta_r: f64| Geometry::new(theta_i, theta_r, 180.0).expect("a valid geometry");
    GeometrySet::new(grid(0, 88, 4).into_iter().map(at)).facets().to_vec()
}

/// The BRDF is linear in k_s, k_d and k_v: there the band is the textbook's `s √(xᵀ(XᵀX)⁻¹x)`.
#[test]
fn the_band_of_a_linear_fit_is_that_of_linear_regression() {
    let weights = [Parameter::Ks, Parameter::Kd, Parameter::Kv];
    let measurement = measured(grid(20, 60, 20), Columns::Brdf, 0.05, 4);
    let problem = problem(&measurement, set(weights), FitOptions { brdf_residuals: BrdfResiduals::Absolute, ..FitOptions::default() });
    let report = fit(&problem, Starts::One, 0, Observer::NONE);
    let unit = |weight: Parameter| {
        let mut alone = Parameters { ks: 0.0, kd: 0.0, kv: 0.0, ..TRUTH };
        alone[weight] = 1.0;
        Pbrdf::new(Model::full(SlopeDistribution::Cauchy), alone).expect("a valid surface")
    };
    let units = weights.map(unit);
    let rows: Vec<Facet> = measurement.rows.iter().map(|row| Facet::new(row.geometry)).collect();
    let x = DMatrix::from_fn(rows.len(), 3, |i, j| units[j].reflection(&rows[i]).brdf);
    let y = DVector::from_fn(rows.len(), |i, _| measurement.rows[i].brdf.expect("a measured BRDF").value);
    let inverse = (x.transpose() * &x).try_inverse().expect("three different columns");
    let beta = &inverse * (x.transpose() * &y);
    let variance = (&y - &x * beta).norm_squared() / f64::from(u32::try_from(rows.len()).expect("a few rows") - 3);
    for (facet, found) in facets(45.0).iter().zip(report.band.brdf(&facets(45.0))) {
        let at = DVector::from_fn(3, |j, _| units[j].reflection(facet).brdf);
        let expected = (variance * (at.transpose() * &inverse * &at)[0]).sqrt();
        // The fit ends within some 1e-8 of the solution, and the normal equations have a condition of some 1e4.
        assert!((found.expect("a determined curve") / expected - 1.0).abs() < 1e-6, "{found:?} {expected}");
    }
}

#[test]
fn a_curve_is_determined_where_its_parameters_are_not() {
    let measurement = measured(grid(10, 80, 10), Columns::Dolp, 0.002, 4);
    let default = set(Parameter::ALL).without(Parameter::Ks);
    let held = band(&problem(&measurement, default, FitOptions::default()));
    let all_free = band(&problem(&measurement, set(Parameter::ALL), FitOptions::default()));
    assert_eq!(all_free.uncertainty().standard_error(Parameter::Kd), None);
    // k_s, k_d, k_v together leave DoLP as it is: holding k_s changes nothing of it…
    for (one, other) in held.dolp(&facets(40.0)).into_iter().zip(all_free.dolp(&facets(40.0))) {
        let (one, other) = (one.expect("a determined curve"), other.expect("a determined curve"));
        // The pseudo-inverse loses what the condition of some 1e3 squared takes.
        assert!((one - other).abs() <= 1e-7 * one.max(1e-6), "{one} {other}");
    }
    // …but moves the BRDF, which DoLP alone leaves open.
    assert!(all_free.brdf(&facets(40.0)).iter().all(Option::is_none));
    assert!(held.brdf(&facets(40.0)).iter().all(Option::is_some));
}

#[test]
fn without_a_degree_of_freedom_there_is_no_band_and_the_estimates_say_why() {
    let mut measurement = measured(vec![50.0], Columns::Dolp, 0.002, 4);
    measurement.rows.drain(..10);
    measurement.rows.truncate(2);
    let problem = problem(&measurement, set([Parameter::N, Parameter::K]), FitOptions::default());
    let report = fit(&problem, Starts::One, 0, Observer::NONE);
    let standing = |parameter| report.estimates.iter().find(|estimate| estimate.parameter == parameter).expect("of the model").status();
    assert_eq!(
        (report.statistics.dof, standing(Parameter::N), standing(Parameter::Kd)),
        (0, EstimateStatus::UncertaintyUnknown, EstimateStatus::Fixed)
    );
    assert!(report.band.dolp(&facets(50.0)).iter().all(Option::is_none));
}

#[test]
fn a_plan_predicts_what_the_weighted_problem_says() {
    let simulation = simulation(grid(10, 80, 10), Columns::Dolp, 0.005, 1);
    let measurement = simulation.run().expect("valid angles");
    let model = simulation.surface.model();
    let choices = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
    let problem = problem(&measurement, free_by_default(model, &measurement, &choices), choices);
    let expected = Uncertainty::at(&problem, &TRUTH, 0.0, ParameterSet::EMPTY);
    let noise = NoiseModel { dolp: Some(0.005), brdf: None };
    let plan = Design::new(model, TRUTH, simulation.geometries().expect("valid angles"), noise);
    let prediction = plan.predict().expect("a valid plan");
    assert_eq!((prediction.rank, prediction.condition), (8, expected.condition));
    for (parameter, error) in &prediction.errors {
        assert_eq!(*error, expected.standard_error(*parameter), "{parameter:?}");
    }
    // Twice the noise is twice the error; with a BRDF k_s is to be found too.
    let twice = Design { noise: NoiseModel { dolp: Some(0.01), ..noise }, ..plan.clone() }.predict().expect("a valid plan");
    for (one, two) in prediction.errors.iter().zip(&twice.errors) {
        let (one, two) = (one.1.expect("determined"), two.1.expect("determined"));
        assert!((two / one - 2.0).abs() < 1e-9, "{one} {two}");
    }
    let both = Design::new(model, TRUTH, plan.geometries, NoiseModel { brdf: Some(0.02), ..noise });
    assert!(both.free.contains(Parameter::Ks) && both.predict().expect("a valid plan").undetermined.is_empty());
}

#[test]
fn a_plan_without_angles_or_without_a_surface_has_a_typed_answer() {
    let noise = NoiseModel { dolp: Some(0.005), brdf: None };
    let model = Model::full(SlopeDistribution::Cauchy);
    let nowhere = Design::new(model, TRUTH, Vec::new(), noise);
    let nothing = Design { free: set([Parameter::N]), ..nowhere.clone() }.predict().expect("an answer");
    assert_eq!((nothing.rank, nothing.errors), (0, vec![(Parameter::N, None)]));
    assert!(Design::new(model, Parameters { sigma: -1.0, ..TRUTH }, Vec::new(), noise).predict().is_err());
}

/// Shares within one and two standard errors of the curve, as of the parameters: see tests/calibration.rs. Slow:
/// `cargo test --release --test bands -- --ignored --nocapture`.
#[test]
#[ignore = "takes half a minute in a release build"]
fn the_true_curve_lies_within_the_band_as_often_as_it_should() {
    let data_sets = 2000;
    let free = set(Parameter::ALL).without(Parameter::Ks);
    let facets = facets(45.0);
    let truth: Vec<f64> = facets.iter().map(|facet| simulation(Vec::new(), Columns::Dolp, 0.0, 0).surface.dolp(facet)).collect();
    let (mut within, mut total) = (vec![[0_u32; 2]; facets.len()], 0_u32);
    for seed in 0..data_sets {
        let measurement = measured(grid(10, 80, 10), Columns::Dolp, 0.002, seed);
        let report = fit(&problem(&measurement, free, FitOptions::default()), Starts::One, 0, Observer::NONE);
        // A curve at the edge of the box has no normal distribution around it.
        if report.stop_reason != StopReason::Converged || report.estimates.iter().any(|estimate| estimate.at_bound.is_some()) {
            continue;
        }
        total += 1;
        let surface = Pbrdf::new(report.model, report.parameters).expect("fitted values");
        for (((facet, truth), error), within) in facets.iter().zip(&truth).zip(report.band.dolp(&facets)).zip(&mut within) {
            let off = (surface.dolp(facet) - truth).abs() / error.expect("a determined curve");
            within[0] += u32::from(off <= 1.0);
            within[1] += u32::from(off <= 2.0);
        }
    }
    for (facet, within) in facets.iter().zip(&within) {
        let share = |k: usize| 100.0 * f64::from(within[k]) / f64::from(total);
        println!("θr = {:>4.0}° within 1σ {:.1} %, within 2σ {:.1} % of {total}", facet.theta_r.to_degrees(), share(0), share(1));
        assert!((64.0..=72.0).contains(&share(0)) && (93.0..=97.5).contains(&share(1)), "{within:?}");
    }
}
