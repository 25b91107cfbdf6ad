//! The ladder beyond the nine-parameter model: Hyde's balance.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::fit::{
    Bounds, DistributionComparison, FitOptions, GaussAtFixedSigma, Observer, Problem, Starts, Verdict, Weights, fit, free_by_default,
};
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
    assert_eq!(on_cauchy.verdict(), Verdict::Closer(SlopeDistribution::Cauchy));
    assert!(on_cauchy.ratio() > 1.1 && on_cauchy.aicc_gain.is_some_and(|gain| gain > 10.0), "{on_cauchy:?}");
    assert!(on_cauchy.to_string().starts_with("Cauchy wins over Gauss: ΔE ") && on_cauchy.to_string().contains("essentially no support"));
    let held = held.expect("σ is free");
    for (_, sum) in [held.equal_sigma, held.equal_median] {
        // The free fit ends within its tolerance of the minimum.
        assert!(sum >= on_cauchy.gauss * (1.0 - 1e-6), "{held:?}");
    }
    let (on_gauss, _) = contest(SlopeDistribution::Gauss, 0.002);
    // Cauchy tends to Gauss for large q: that AICc is lower for Gauss is the price of a parameter.
    assert!(on_gauss.aicc_gain.is_some_and(|gain| gain < 0.0) && !matches!(on_gauss.verdict(), Verdict::Closer(_)), "{on_gauss:?}");
}

#[test]
fn the_price_of_a_parameter_is_no_evidence_and_gauss_wins_by_no_bound_of_q() {
    let says = |comparison: DistributionComparison, verdict: Verdict, words: &str| {
        let text = comparison.to_string();
        assert_eq!(comparison.verdict(), verdict, "{comparison:?}");
        assert!(text.contains(words) && text.matches(". ").count() == 0 && text.ends_with('.'), "{text}");
        assert_eq!(text.contains("wins"), matches!(verdict, Verdict::Closer(_)), "{text}");
    };
    let near = DistributionComparison {
        gauss: 2.561_8e-3,
        cauchy: 2.561_799e-3,
        aicc_gain: Some(-4.6),
        is_delta_e: true,
        is_nested: true,
        is_exact: false,
    };
    says(near, Verdict::Alike, "alike (ΔE 2.5618e-3): no evidence for a heavier tail; Gauss needs one parameter less");
    let by_a_bound = DistributionComparison { cauchy: near.gauss * 1.0002, ..near };
    says(by_a_bound, Verdict::Alike, "no evidence");
    let far_by_a_bound = DistributionComparison { cauchy: near.gauss * 2.0, aicc_gain: Some(-100.0), ..near };
    says(far_by_a_bound, Verdict::Bounded, "(ΔE 2.0000 times smaller): no evidence");
    let costly = DistributionComparison { cauchy: 2.5e-3, ..near };
    says(costly, Verdict::NotWorthIt, "(ΔE 1.0247 times smaller) by too little for its additional parameter (AICc lower by 4.6 for Gauss)");
    let worth_it = DistributionComparison { cauchy: 2e-3, aicc_gain: Some(4.6), ..near };
    says(worth_it, Verdict::Closer(SlopeDistribution::Cauchy), "AICc lower by 4.6 for Cauchy: considerable evidence");
    // With q held, neither is a special case of the other.
    let with_q_held = DistributionComparison { is_nested: false, ..far_by_a_bound };
    says(with_q_held, Verdict::Closer(SlopeDistribution::Gauss), "Gauss wins over Cauchy: ΔE 2.0000 times smaller");
    let exact = DistributionComparison { gauss: 3e-32, cauchy: 1e-33, aicc_gain: Some(90.0), is_exact: true, ..near };
    says(exact, Verdict::Exact, "both meet these data to the last digits: there is no winner");
}

#[test]
fn two_models_that_meet_the_data_have_no_winner() {
    // DoLP of mirror facets is that of Fresnel, whatever their slopes.
    let measurement = simulated(Model::SPECULAR, STEEL, Columns::Dolp, 0.0);
    let fits = SlopeDistribution::ALL.map(|distribution| {
        let model = Model { distribution, ..Model::SPECULAR };
        let free = free_by_default(model, &measurement, &FitOptions::default());
        let problem = Problem::new(&measurement, model, STEEL, free, Bounds::default(), FitOptions::default()).expect("a problem");
        fit(&problem, Starts::Automatic, 1, Observer::NONE)
    });
    let comparison = DistributionComparison::new(&fits[0], &fits[1]).expect("finite sums");
    assert_eq!(comparison.verdict(), Verdict::Exact, "{comparison:?}");
}

#[test]
fn the_measure_is_called_delta_e_only_where_it_is_delta_e_as_the_fits_say_it() {
    let measurement = simulated(Model::full(SlopeDistribution::Cauchy), STEEL, Columns::Both, 0.01);
    for (weights, is_delta_e) in [(Weights::None, true), (Weights::Sigma, false)] {
        let options = FitOptions { weights, ..FitOptions::default() };
        let fits = SlopeDistribution::ALL.map(|distribution| {
            let model = Model::full(distribution);
            let free = free_by_default(model, &measurement, &options);
            let problem = Problem::new(&measurement, model, STEEL, free, Bounds::default(), options).expect("a problem");
            fit(&problem, Starts::One, 1, Observer::NONE)
        });
        let comparison = DistributionComparison::new(&fits[0], &fits[1]).expect("finite sums");
        assert_eq!(comparison.is_delta_e, is_delta_e);
        // Without weights, each fit weighted DoLP and BRDF by variances of its own: its sum is N whatever it is worth.
        let said = fits.map(|fit| if is_delta_e { fit.objective.expect("measured values") } else { fit.statistics.rss });
        assert_eq!([comparison.gauss, comparison.cauchy], said);
        assert_eq!(comparison.to_string().contains("ΔE"), is_delta_e);
    }
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
