//! The ladder beyond the nine-parameter model: Hyde's balance.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::fit::{Bounds, DistributionComparison, FitOptions, GaussAtFixedSigma, Observer, Problem, Starts, fit, free_by_default};
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{Diffuse, DolpFormula, GradientRequest, Model, PRESETS, Parameter, ParameterSet, Parameters, Pbrdf, Preset};
use pbrdf::optics::{Facet, Geometry, SlopeDistribution};

const STEEL: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.25, q: 2.2, c: -0.4, sigma_v: 0.6 };

fn hyde() -> Model {
    Preset::from_key("hyde").expect("a preset").model
}

fn facet(theta_i: f64, theta_r: f64, dphi: f64) -> Facet {
    Facet::new(Geometry::new(theta_i, theta_r, dphi).expect("a valid geometry"))
}

fn simulated(model: Model, truth: Parameters, columns: Columns, noise: f64) -> Measurement {
    let grid = |from: i32, to: i32, step: usize| (from..=to).step_by(step).map(f64::from).collect();
    let surface = Pbrdf::new(model, truth).expect("a valid surface");
    let (theta_i, theta_r) = (grid(10, 80, 10), grid(0, 85, 5));
    Simulation { model_name: "test".to_owned(), surface, theta_i, theta_r, dphi: 180.0, columns, noise, brdf_noise: noise, seed: 3 }
        .run()
        .expect("valid angles")
}

#[test]
fn hydes_term_is_the_same_in_all_directions_of_view_and_scales_with_k_s() {
    let dark = |ks: f64, theta_r: f64, dphi: f64| {
        Pbrdf::new(hyde(), Parameters { ks, ..STEEL }).expect("a surface").reflection(&facet(40.0, theta_r, dphi)).diffuse
    };
    let one = dark(1.0, 10.0, 180.0);
    // 1 − ρ of some tenths, over π.
    assert!((0.02..0.1).contains(&one), "{one}");
    assert_eq!(dark(1.0, 70.0, 30.0), one);
    assert_eq!(dark(0.0, 70.0, 30.0), 0.0);
    assert!((dark(3.0, 70.0, 30.0) / (3.0 * one) - 1.0).abs() < 4.0 * f64::EPSILON);
}

#[test]
fn k_s_cancels_from_hydes_dolp() {
    let at = |ks: f64| {
        Pbrdf::new(hyde(), Parameters { ks, ..STEEL })
            .expect("a surface")
            .reflection_and_gradient(&facet(50.0, 30.0, 180.0), GradientRequest::ALL)
    };
    let ((one, gradient), (two, _)) = (at(1.0), at(2.0));
    assert_eq!(one.dolp, two.dolp);
    assert_eq!(gradient.dolp[Parameter::Ks], 0.0);
}

#[test]
fn derivatives_of_hydes_term_are_those_of_its_values() {
    // A central difference of this step is good to about its square and the rounding over it.
    let (step, tolerance) = (1e-5, 1e-6);
    for distribution in [SlopeDistribution::Gauss, SlopeDistribution::Cauchy] {
        for volume in [false, true] {
            let model = Model { distribution, volume, ..hyde() };
            for (theta_i, theta_r, sigma) in [(10.0, 30.0, 0.2), (50.0, 40.0, 0.5), (75.0, 60.0, 0.1), (80.0, 20.0, 0.9)] {
                let here = Parameters { sigma, ks: 1.3, ..STEEL };
                let facet = facet(theta_i, theta_r, 150.0);
                let (_, gradient) = Pbrdf::new(model, here).expect("a surface").reflection_and_gradient(&facet, GradientRequest::ALL);
                for parameter in Parameter::ALL {
                    let moved = |by: f64| {
                        let mut there = here;
                        there[parameter] *= 1.0 + by;
                        Pbrdf::new(model, there).expect("a surface").reflection(&facet)
                    };
                    let (up, down) = (moved(step), moved(-step));
                    let width = 2.0 * step * here[parameter];
                    for (analytic, numeric, size) in [
                        (gradient.brdf[parameter], (up.brdf - down.brdf) / width, up.brdf),
                        (gradient.dolp[parameter], (up.dolp - down.dolp) / width, up.dolp),
                    ] {
                        let scale = numeric.abs().max(1e-3 * size / here[parameter].abs());
                        assert!(
                            (analytic - numeric).abs() <= tolerance * scale,
                            "{model:?} {parameter:?} at {theta_i}: {analytic} {numeric}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn hyde_is_fitted_by_index_and_slope_and_with_a_brdf_by_k_s_too() {
    let names = |measurement: &Measurement| free_by_default(hyde(), measurement, &FitOptions::default());
    let by_dolp = simulated(hyde(), STEEL, Columns::Dolp, 0.0);
    let by_both = simulated(hyde(), Parameters { ks: 0.7, ..STEEL }, Columns::Both, 0.0);
    let expected: ParameterSet = [Parameter::N, Parameter::K, Parameter::Sigma].into_iter().collect();
    assert_eq!((names(&by_dolp), names(&by_both)), (expected, expected.with(Parameter::Ks)));
    for (measurement, ks) in [(by_dolp, 1.0), (by_both, 0.7)] {
        let free = names(&measurement);
        let problem =
            Problem::new(&measurement, hyde(), Parameters::default(), free, Bounds::default(), FitOptions::default()).expect("a problem");
        let report = fit(&problem, Starts::Automatic, 1, Observer::NONE);
        for parameter in free {
            let truth = Parameters { ks, ..STEEL }[parameter];
            // Noise-free, and four parameters at most: nine digits less than f64 has.
            assert!((report.parameters[parameter] - truth).abs() < 1e-6, "{parameter:?}: {}", report.parameters[parameter]);
        }
        assert!(report.undetermined.is_empty());
    }
}

#[test]
fn without_a_specular_lobe_there_is_no_balance_to_carry() {
    let surface = Pbrdf::new(Model { specular: false, diffuse: Diffuse::Hyde, ..hyde() }, STEEL).expect("a surface");
    assert_eq!(surface.reflection(&facet(30.0, 30.0, 180.0)).brdf, 0.0);
    assert!(surface.model().parameters().is_empty());
}

/// Gauss and Cauchy on the same rows.
fn contest(truth: SlopeDistribution, noise: f64) -> (DistributionComparison, Option<GaussAtFixedSigma>) {
    let measurement = simulated(Model::full(truth), STEEL, Columns::Dolp, noise);
    let [(problem, gauss), (_, cauchy)] = SlopeDistribution::ALL.map(|distribution| {
        let model = Model::full(distribution);
        let free = free_by_default(model, &measurement, &FitOptions::default());
        let problem = Problem::new(&measurement, model, STEEL, free, Bounds::default(), FitOptions::default()).expect("a problem");
        let report = fit(&problem, Starts::One, 1, Observer::NONE);
        (problem, report)
    });
    (DistributionComparison::new(&gauss, &cauchy).expect("finite sums"), GaussAtFixedSigma::new(&problem, &gauss, &cauchy, Observer::NONE))
}

#[test]
fn the_distribution_that_made_the_data_wins_and_a_held_gauss_is_no_better_than_a_free_one() {
    let (on_cauchy, held) = contest(SlopeDistribution::Cauchy, 0.002);
    assert_eq!(on_cauchy.winner(), Some(SlopeDistribution::Cauchy));
    assert!(on_cauchy.ratio() > 1.1 && on_cauchy.aicc_gain.is_some_and(|gain| gain > 10.0), "{on_cauchy:?}");
    assert!(on_cauchy.to_string().starts_with("Cauchy wins over Gauss: ΔE ") && on_cauchy.to_string().contains("essentially no support"));
    let held = held.expect("σ is free");
    for (_, sum) in [held.equal_sigma, held.equal_median] {
        // The free fit ends within its tolerance of the minimum.
        assert!(sum >= on_cauchy.gauss * (1.0 - 1e-6), "{held:?}");
    }
    let (on_gauss, _) = contest(SlopeDistribution::Gauss, 0.002);
    // Cauchy tends to Gauss for large q: it is not beaten by much, but it has a parameter more to answer for.
    assert!(on_gauss.aicc_gain.is_some_and(|gain| gain < 0.0), "{on_gauss:?}");
}

#[test]
fn no_distribution_wins_against_the_evidence() {
    let near = DistributionComparison { gauss: 2.561_8e-3, cauchy: 2.561_799e-3, aicc_gain: Some(-4.6), is_delta_e: true };
    assert!(near.winner().is_none() && near.to_string().contains("alike") && !near.to_string().contains("wins"), "{}", near.to_string());
    let costly = DistributionComparison { cauchy: 2.5e-3, ..near };
    assert!(
        costly.to_string().starts_with("Cauchy comes nearer than Gauss") && costly.to_string().contains("lower by 4.6 for Gauss"),
        "{}",
        costly.to_string()
    );
}

#[test]
fn dolp_depends_on_the_parameters_that_each_model_says_and_on_no_others() {
    // What cancels leaves rounding behind.
    const NOTHING: f64 = 1e-12;
    let parameters = Parameters { n: 1.6, k: 2.4, sigma: 0.4, ks: 0.8, kd: 0.2, kv: 0.3, q: 2.4, c: -0.3, sigma_v: 0.7 };
    let formulas = [DolpFormula::Consistent, DolpFormula::AsPrinted];
    let models = PRESETS.iter().flat_map(|preset| formulas.map(|formula| (preset, preset.model.with_dolp_formula(formula))));
    for (preset, model) in models {
        let surface = Pbrdf::new(model, parameters).expect("a valid surface");
        let facets = [(20.0, 65.0), (60.0, 10.0), (75.0, 40.0)].map(|(theta_i, theta_r)| facet(theta_i, theta_r, 180.0));
        let gradients = facets.map(|facet| surface.reflection_and_gradient(&facet, GradientRequest::ALL).1.dolp);
        for parameter in Parameter::ALL {
            let is_felt = gradients.iter().any(|gradient| gradient[parameter].abs() > NOTHING);
            assert_eq!(is_felt, model.dolp_parameters().contains(parameter), "{}: {}", preset.key, parameter.key());
        }
    }
}

#[test]
fn dolp_as_printed_is_the_consistent_one_over_k_s() {
    // A dozen roundings, of values and of each term of a derivative.
    const ROUNDING: f64 = 1e-14;
    let parameters = Parameters { n: 1.6, k: 2.4, sigma: 0.4, ks: 0.3, kd: 0.2, kv: 0.3, q: 2.4, c: -0.3, sigma_v: 0.7 };
    let with_hyde = Model { volume: true, ..hyde() };
    for model in PRESETS.iter().map(|preset| preset.model).chain([with_hyde]) {
        for (theta_i, theta_r) in [(20.0, 65.0), (60.0, 10.0), (75.0, 40.0)] {
            let [consistent, printed] = [DolpFormula::Consistent, DolpFormula::AsPrinted].map(|formula| {
                let surface = Pbrdf::new(model.with_dolp_formula(formula), parameters).expect("a valid surface");
                let facet = facet(theta_i, theta_r, 180.0);
                assert_eq!(surface.dolp(&facet), surface.reflection(&facet).dolp);
                surface.reflection_and_gradient(&facet, GradientRequest::ALL)
            });
            let dolp = consistent.0.dolp / parameters.ks;
            assert!((printed.0.dolp / dolp - 1.0).abs() < ROUNDING, "{model:?}");
            for parameter in Parameter::ALL {
                let by_ks = if parameter == Parameter::Ks { dolp / parameters.ks } else { 0.0 };
                let of_consistent = consistent.1.dolp[parameter] / parameters.ks;
                let error = (printed.1.dolp[parameter] - (of_consistent - by_ks)).abs();
                assert!(error <= ROUNDING * (of_consistent.abs() + by_ks), "{model:?} {parameter:?}: {error:e}");
            }
        }
    }
}

#[test]
fn dolp_as_printed_has_a_limit_at_k_s_of_0() {
    let model = Model::full(SlopeDistribution::Cauchy).with_dolp_formula(DolpFormula::AsPrinted);
    let at = |ks: f64| {
        let surface = Pbrdf::new(model, Parameters { ks, ..STEEL }).expect("a valid surface");
        surface.reflection_and_gradient(&facet(40.0, 60.0, 180.0), GradientRequest::ALL)
    };
    let ((here, gradient), (near, _)) = (at(0.0), at(1e-9));
    // The slope is of the order of 1.
    assert!(here.dolp > 1.0 && (here.dolp - near.dolp).abs() < 1e-7, "{here:?} {near:?}");
    let by_difference = (near.dolp - here.dolp) / 1e-9;
    assert!((gradient.dolp[Parameter::Ks] / by_difference - 1.0).abs() < 1e-5, "{gradient:?} {by_difference}");
}
