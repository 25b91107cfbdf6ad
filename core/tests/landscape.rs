//! The objective over two parameters: the same numbers as the problem's own, for every choice.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::fit::{Bounds, BrdfResiduals, FitOptions, Landscape, LandscapeAxis, Loss, Problem, Weights};
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{DolpFormula, Model, Parameter, ParameterSet, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution::Cauchy;

const TRUTH: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.25, q: 2.2, c: -0.4, sigma_v: 0.6 };

fn measurement(columns: Columns) -> Measurement {
    noisy(columns, 0.005)
}

fn noisy(columns: Columns, noise: f64) -> Measurement {
    let surface = Pbrdf::new(Model::full(Cauchy), TRUTH).expect("a valid surface");
    let angles = |from: i32| (0..9).map(|i| f64::from(from + 5 * i)).collect();
    let theta_i = vec![30.0, 40.0, 50.0];
    let simulation = Simulation {
        model_name: "test".to_owned(),
        surface,
        theta_i,
        theta_r: angles(20),
        dphi: 180.0,
        columns,
        noise,
        brdf_noise: 0.02,
        seed: 7,
    };
    simulation.run().expect("valid angles")
}

fn problem(measurement: &Measurement, choices: FitOptions) -> Problem {
    problem_of(Model::full(Cauchy), measurement, choices)
}

fn problem_of(model: Model, measurement: &Measurement, choices: FitOptions) -> Problem {
    let free = ParameterSet::ALL.without(Parameter::Ks);
    Problem::new(measurement, model, TRUTH, free, Bounds::default(), choices).expect("a valid problem")
}

fn axes() -> (LandscapeAxis, LandscapeAxis) {
    let across = LandscapeAxis { parameter: Parameter::N, low: 0.5, high: 6.0, count: 23, logarithmic: true };
    let up = LandscapeAxis { parameter: Parameter::K, low: 0.0, high: 8.0, count: 17, logarithmic: false };
    (across, up)
}

fn is_the_plain_objective(problem: &Problem) {
    let (across, up) = axes();
    let landscape = Landscape::new(problem, across, up, &|| false).expect("not cancelled");
    assert_eq!(landscape.objective.len(), across.count * up.count);
    for (row, k) in up.values().into_iter().enumerate() {
        for (column, n) in across.values().into_iter().enumerate() {
            let expected = problem.delta_e(&Parameters { n, k, ..TRUTH }).expect("a surface");
            let value = landscape.objective[row * across.count + column];
            // Residuals to 1e-13 of DoLP, squared and summed; ΔE is of the order of 1e-5 at the truth.
            assert!((value - expected).abs() <= 1e-11 * expected, "n = {n}, k = {k}: {value:e} {expected:e}");
        }
    }
}

#[test]
fn a_landscape_is_the_plain_objective() {
    let dolp = measurement(Columns::Dolp);
    let both = measurement(Columns::Both);
    let choices = FitOptions::default();
    is_the_plain_objective(&problem(&dolp, choices));
    is_the_plain_objective(&problem(&both, choices));
    is_the_plain_objective(&problem(&both, FitOptions { brdf_residuals: BrdfResiduals::Absolute, ..choices }));
    is_the_plain_objective(&problem(&both, FitOptions { brdf_residuals: BrdfResiduals::Log, ..choices }));
    is_the_plain_objective(&problem(&dolp, FitOptions { weights: Weights::Sigma, ..choices }));
    is_the_plain_objective(&problem(&dolp, FitOptions { loss: Loss::Huber, ..choices }));
    is_the_plain_objective(&problem_of(Model::full(Cauchy).with_dolp_formula(DolpFormula::AsPrinted), &dolp, choices));
}

#[test]
fn a_landscape_of_what_is_minimised_is_the_problems_own_sum_of_squares() {
    let both = measurement(Columns::Both);
    let choices = FitOptions::default();
    for choices in [
        choices,
        FitOptions { brdf_residuals: BrdfResiduals::Absolute, ..choices },
        FitOptions { brdf_residuals: BrdfResiduals::Log, ..choices },
        FitOptions { weights: Weights::Sigma, ..choices },
        FitOptions { loss: Loss::Huber, loss_scale: Some(0.01), ..choices },
        FitOptions { loss: Loss::SoftL1, loss_scale: Some(0.01), weights: Weights::Sigma, ..choices },
    ] {
        is_what_is_minimised(&problem(&both, choices), &format!("{choices:?}"));
    }
    is_what_is_minimised(&problem_of(Model::full(Cauchy).with_dolp_formula(DolpFormula::AsPrinted), &both, choices), "as printed");
}

fn is_what_is_minimised(problem: &Problem, case: &str) {
    let (across, up) = axes();
    let landscape = Landscape::minimised(problem, across, up, &|| false).expect("not cancelled");
    for (row, k) in up.values().into_iter().enumerate() {
        for (column, n) in across.values().into_iter().enumerate() {
            let expected = problem.sum_of_squares(&Parameters { n, k, ..TRUTH }).expect("a surface");
            let value = landscape.objective[row * across.count + column];
            // As for ΔE: the kernel's 1e-13, squared and summed.
            assert!((value - expected).abs() <= 1e-11 * expected, "{case} n = {n}, k = {k}: {value:e} {expected:e}");
        }
    }
}

#[test]
fn masked_rows_shape_nothing() {
    let mut masked = measurement(Columns::Dolp);
    for row in masked.rows.iter_mut().step_by(4) {
        row.masked = true;
        row.dolp.as_mut().expect("a value").value = 0.99;
    }
    let mut fewer = masked.clone();
    fewer.rows.retain(|row| !row.masked);
    let (across, up) = axes();
    let of = |measurement: &Measurement| Landscape::new(&problem(measurement, FitOptions::default()), across, up, &|| false);
    assert_eq!(of(&masked), of(&fewer));
    is_the_plain_objective(&problem(&masked, FitOptions::default()));
}

#[test]
fn the_lowest_node_is_the_truth() {
    let problem = problem(&noisy(Columns::Dolp, 0.0), FitOptions::default());
    let across = LandscapeAxis { parameter: Parameter::Kd, low: 0.0, high: 0.24, count: 13, logarithmic: false };
    let up = LandscapeAxis { parameter: Parameter::Kv, low: 0.0, high: 0.5, count: 11, logarithmic: false };
    let landscape = Landscape::new(&problem, across, up, &|| false).expect("not cancelled");
    assert_eq!(landscape.lowest(), Some((6, 5)));
}

#[test]
fn nodes_outside_the_domain_have_no_value_and_a_cancelled_landscape_is_none() {
    let problem = problem(&measurement(Columns::Dolp), FitOptions::default());
    let (across, _) = axes();
    let up = LandscapeAxis { parameter: Parameter::Sigma, low: -0.5, high: 0.5, count: 3, logarithmic: false };
    let landscape = Landscape::new(&problem, across, up, &|| false).expect("not cancelled");
    assert!(landscape.objective[..2 * across.count].iter().all(|objective| objective.is_nan()));
    assert!(landscape.objective[2 * across.count..].iter().all(|objective| objective.is_finite()));
    assert_eq!(Landscape::new(&problem, across, up, &|| true), None);
}
