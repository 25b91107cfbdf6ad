//! Fits on simulated data: they find the truth, stay in the box, and say how they ended.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use nalgebra::{DMatrix, DVector};
use pbrdf::fit::{
    Bounds, BrdfResiduals, Edge, EstimateStatus, FitOptions, Loss, Observer, Problem, Starts, StopReason, Weights, fit, free_by_default,
};
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{DolpFormula, Model, Parameter, ParameterSet, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;
use pbrdf::optics::SlopeDistribution::{Cauchy, Gauss};
use std::sync::atomic::{AtomicUsize, Ordering};

const TRUTH: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.25, q: 2.2, c: -0.4, sigma_v: 0.6 };
/// What "returns the truth" means: some nine digits less than f64 has, room for the condition of eight parameters.
const TRUE_TO: f64 = 1e-6;

fn grid(from: i32, to: i32, step: usize) -> Vec<f64> {
    (from..=to).step_by(step).map(f64::from).collect()
}

fn dense(distribution: SlopeDistribution, truth: Parameters, columns: Columns) -> Measurement {
    simulate(distribution, truth, columns, grid(10, 80, 10), grid(0, 85, 5), 0.0)
}

fn simulate(
    distribution: SlopeDistribution,
    truth: Parameters,
    columns: Columns,
    theta_i: Vec<f64>,
    theta_r: Vec<f64>,
    noise: f64,
) -> Measurement {
    let surface = Pbrdf::new(Model::full(distribution), truth).expect("a valid surface");
    Simulation { model_name: "test".to_owned(), surface, theta_i, theta_r, dphi: 180.0, columns, noise, brdf_noise: noise, seed: 7 }
        .run()
        .expect("valid angles")
}

fn problem(measurement: &Measurement, distribution: SlopeDistribution, start: Parameters) -> Problem {
    let model = Model::full(distribution);
    let free = free_by_default(model, measurement, &FitOptions::default());
    Problem::new(measurement, model, start, free, Bounds::default(), FitOptions::default()).expect("a valid problem")
}

/// A point of the box from the golden-ratio (Kronecker) sequence: spread out, and the same everywhere.
fn point_in_box(i: u32) -> Parameters {
    let mut start = TRUTH;
    for (j, parameter) in (1..).zip(Parameter::ALL) {
        let root = f64::from(2 * j + 1).sqrt();
        start[parameter] = Bounds::default().at(parameter, (f64::from(i + 1) * root).fract());
    }
    start.ks = 1.0;
    start
}

fn worst_difference(a: &Parameters, b: &Parameters, of: ParameterSet) -> f64 {
    of.iter().map(|parameter| (a[parameter] - b[parameter]).abs()).fold(0.0, f64::max)
}

#[test]
fn single_runs_from_far_starts_return_the_truth() {
    for distribution in [Gauss, Cauchy] {
        let measurement = dense(distribution, TRUTH, Columns::Dolp);
        let reached = (0..20)
            .filter(|&i| {
                let problem = problem(&measurement, distribution, point_in_box(i));
                let free: ParameterSet = problem.free().iter().copied().collect();
                let report = fit(&problem, Starts::One, 0, Observer::NONE);
                worst_difference(&report.parameters, &TRUTH, free) < TRUE_TO
            })
            .count();
        assert!(reached >= 19, "{distribution:?}: {reached} of 20");
    }
}

#[test]
fn with_a_brdf_all_nine_parameters_are_found() {
    let measurement = dense(Cauchy, Parameters { ks: 1.7, ..TRUTH }, Columns::Both);
    let report = fit(&problem(&measurement, Cauchy, Parameters::default()), Starts::One, 0, Observer::NONE);
    assert!(worst_difference(&report.parameters, &Parameters { ks: 1.7, ..TRUTH }, ParameterSet::ALL) < TRUE_TO, "{:?}", report.parameters);
    assert_eq!(report.stop_reason, StopReason::ResidualsZero);
}

#[test]
fn a_free_k_s_is_undetermined_by_dolp_alone() {
    let measurement = dense(Gauss, TRUTH, Columns::Dolp);
    let model = Model::full(Gauss);
    let problem = Problem::new(&measurement, model, Parameters::default(), model.parameters(), Bounds::default(), FitOptions::default())
        .expect("a valid problem");
    let report = fit(&problem, Starts::One, 0, Observer::NONE);
    assert_eq!(report.stop_reason, StopReason::Underdetermined);
    let open: Vec<Parameter> = report.undetermined[0].direction.iter().map(|(parameter, _)| *parameter).collect();
    assert_eq!(open, [Parameter::Ks, Parameter::Kd, Parameter::Kv]);
    for estimate in &report.estimates {
        assert_eq!(estimate.std_error.is_none(), open.contains(&estimate.parameter), "{:?}", estimate.parameter);
    }
}

#[test]
fn a_minimum_on_the_edge_is_put_on_the_edge() {
    let measurement = dense(Gauss, Parameters { kv: 0.0, ..TRUTH }, Columns::Dolp);
    let mut bounds = Bounds::default();
    bounds.set(Parameter::Kd, 0.2, 10.0).expect("bounds in order");
    let model = Model::full(Gauss);
    let free: ParameterSet = [Parameter::N, Parameter::K, Parameter::Sigma, Parameter::Kd].into_iter().collect();
    let start = Parameters { kv: 0.0, kd: 0.5, c: TRUTH.c, ..Parameters::default() };
    let problem = Problem::new(&measurement, model, start, free, bounds, FitOptions::default()).expect("a valid problem");
    let report = fit(&problem, Starts::One, 0, Observer::NONE);
    let kd = report.estimates.iter().find(|estimate| estimate.parameter == Parameter::Kd).expect("kd is there");
    assert_eq!((kd.value, kd.at_bound, kd.std_error), (0.2, Some(Edge::Lower), None));
}

#[test]
fn a_cancelled_fit_keeps_the_best_so_far() {
    let measurement = dense(Cauchy, TRUTH, Columns::Dolp);
    let problem = problem(&measurement, Cauchy, Parameters::default());
    let asked = AtomicUsize::new(0);
    let cancelled = || asked.fetch_add(1, Ordering::Relaxed) >= 6;
    let report = fit(&problem, Starts::One, 0, Observer { cancelled: &cancelled, ..Observer::NONE });
    assert_eq!(report.stop_reason, StopReason::Cancelled);
    let best = report.course.trace.iter().map(|point| point.objective).fold(f64::INFINITY, f64::min);
    // The trace holds sums in another order than ΔE is summed in.
    assert!((report.objective.expect("an objective") / best - 1.0).abs() < 1e-12);
    assert!(report.objective < report.start_objective);
}

#[test]
fn a_fit_cancelled_before_it_began_returns_its_start() {
    let measurement = dense(Cauchy, TRUTH, Columns::Dolp);
    let problem = problem(&measurement, Cauchy, Parameters::default());
    for starts in [Starts::One, Starts::Automatic, Starts::Exactly(8), Starts::Exactly(200)] {
        let report = fit(&problem, starts, 1, Observer { cancelled: &|| true, ..Observer::NONE });
        assert_eq!(report.stop_reason, StopReason::Cancelled, "{starts:?}");
        assert!(report.objective <= report.start_objective, "{starts:?}");
    }
}

#[test]
fn the_trace_falls_and_ends_at_the_objective() {
    let measurement = simulate(Cauchy, TRUTH, Columns::Dolp, grid(30, 50, 10), grid(20, 60, 5), 0.005);
    let report = fit(&problem(&measurement, Cauchy, Parameters::default()), Starts::One, 0, Observer::NONE);
    assert!(report.course.trace.windows(2).all(|pair| pair[1].objective < pair[0].objective && pair[1].evaluations > pair[0].evaluations));
    let last = report.course.trace.last().expect("a trace").objective;
    // The trace holds sums in another order than ΔE is summed in.
    assert!((report.objective.expect("an objective") / last - 1.0).abs() < 1e-12);
}

#[test]
fn the_path_leads_from_the_winning_start_to_the_solution_and_lies_on_the_trace() {
    let noisy = simulate(Cauchy, TRUTH, Columns::Dolp, grid(10, 80, 10), grid(0, 85, 5), 0.01);
    for (starts, choices) in [
        (Starts::One, FitOptions::default()),
        (Starts::Automatic, FitOptions::default()),
        (Starts::One, FitOptions { loss: Loss::Huber, ..FitOptions::default() }),
    ] {
        let start = point_in_box(3);
        let free = free_by_default(Model::full(Cauchy), &noisy, &choices);
        let problem = Problem::new(&noisy, Model::full(Cauchy), start, free, Bounds::default(), choices).expect("a valid problem");
        let report = fit(&problem, starts, 1, Observer::NONE);
        assert_eq!(report.course.path.len(), report.course.trace.len());
        for (point, parameters) in report.course.trace.iter().zip(&report.course.path) {
            let objective = problem.delta_e(parameters).expect("a surface");
            // Between the batch kernel or the solver's coordinates and this lies rounding alone.
            assert!((objective - point.objective).abs() <= 1e-9 * objective, "{objective:e} {:e}", point.objective);
        }
        if starts == Starts::One && choices.loss == Loss::Squared {
            assert_eq!(report.course.path[0], start);
        }
        let best = report.course.minima.first().expect("a minimum");
        assert!(worst_difference(&best.parameters, &report.parameters, ParameterSet::ALL) < TRUE_TO);
    }
}

#[test]
fn nothing_to_fit_is_said() {
    let mut measurement = dense(Gauss, TRUTH, Columns::Dolp);
    measurement.rows.iter_mut().for_each(|row| row.masked = true);
    let report = fit(&problem(&measurement, Gauss, Parameters::default()), Starts::One, 0, Observer::NONE);
    assert_eq!((report.stop_reason, report.objective), (StopReason::NoData, None));
    assert!(report.estimates.iter().all(|estimate| estimate.std_error.is_none()));
}

#[test]
fn fewer_points_than_parameters_are_underdetermined() {
    let measurement = simulate(Cauchy, TRUTH, Columns::Dolp, vec![40.0], vec![20.0, 40.0, 60.0], 0.0);
    let report = fit(&problem(&measurement, Cauchy, Parameters::default()), Starts::One, 0, Observer::NONE);
    assert_eq!(report.stop_reason, StopReason::Underdetermined);
    assert!(!report.undetermined.is_empty());
}

#[test]
fn all_dolp_zero_has_no_relative_objective() {
    let mut measurement = dense(Gauss, TRUTH, Columns::Dolp);
    measurement.rows.iter_mut().filter_map(|row| row.dolp.as_mut()).for_each(|dolp| dolp.value = 0.0);
    let report = fit(&problem(&measurement, Gauss, Parameters::default()), Starts::One, 0, Observer::NONE);
    assert_eq!(report.objective, None);
    assert!(report.statistics.rss.is_finite());
}

#[test]
fn a_robust_loss_spares_outliers() {
    let mut measurement = simulate(Gauss, TRUTH, Columns::Dolp, grid(10, 80, 10), grid(0, 85, 5), 0.001);
    for row in measurement.rows.iter_mut().step_by(11) {
        if let Some(dolp) = &mut row.dolp {
            dolp.value = (dolp.value + 0.3).min(1.0);
        }
    }
    let model = Model::full(Gauss);
    let free: ParameterSet = [Parameter::N, Parameter::K].into_iter().collect();
    let off = |loss: Loss| {
        let choices = FitOptions { loss, ..FitOptions::default() };
        let problem =
            Problem::new(&measurement, model, Parameters { n: 2.5, ..TRUTH }, free, Bounds::default(), choices).expect("a valid problem");
        let report = fit(&problem, Starts::Automatic, 1, Observer::NONE);
        (report.parameters.n - TRUTH.n).abs() + (report.parameters.k - TRUTH.k).abs()
    };
    let linear = off(Loss::Squared);
    // A tenth of the points is off by 0.3 and the rest by 0.001: sparing them gains an order of magnitude.
    for loss in [Loss::Huber, Loss::SoftL1] {
        assert!(off(loss) < 0.1 * linear, "{loss:?}: {} against {linear}", off(loss));
    }
}

#[test]
fn the_jacobian_of_every_kind_of_residual_is_its_derivative() {
    let measurement = simulate(Cauchy, TRUTH, Columns::Both, grid(20, 60, 20), grid(0, 80, 20), 0.01);
    let at = Parameters { n: 1.7, k: 2.4, sigma: 0.4, ks: 1.3, ..TRUTH };
    let mut all = Vec::new();
    for weights in [Weights::None, Weights::Sigma] {
        for brdf_residuals in [BrdfResiduals::Absolute, BrdfResiduals::Relative, BrdfResiduals::Log] {
            for loss in [Loss::Squared, Loss::Huber, Loss::SoftL1] {
                for formula in [DolpFormula::Consistent, DolpFormula::AsPrinted] {
                    let choices = FitOptions { weights, brdf_residuals, loss, loss_scale: Some(0.05), ..FitOptions::default() };
                    all.push((Model::full(Cauchy).with_dolp_formula(formula), choices));
                }
            }
        }
    }
    for (model, choices) in all {
        let problem = Problem::new(&measurement, model, at, model.parameters(), Bounds::default(), choices).expect("a valid problem");
        let mut jacobian = DMatrix::zeros(problem.len(), Parameter::COUNT);
        assert!(problem.jacobian(&at, &mut jacobian));
        for (j, parameter) in Parameter::ALL.into_iter().enumerate() {
            let residuals = |offset: f64| {
                let mut moved = at;
                moved[parameter] += offset;
                let mut residuals = DVector::zeros(problem.len());
                assert!(problem.residuals(&moved, &mut residuals));
                residuals
            };
            let h = 1e-5 * at[parameter].abs();
            let numeric = (residuals(h) - residuals(-h)) / (2.0 * h);
            let difference = (&numeric - jacobian.column(j)).amax();
            // A central difference with a relative step of 1e-5 keeps some nine digits; where a loss bends sharply it keeps fewer.
            let bar = if choices.loss == Loss::Squared { 1e-7 } else { 1e-4 };
            assert!(difference <= bar * (1.0 + numeric.amax()), "{choices:?} {parameter:?}: {difference:e} of {:e}", numeric.amax());
        }
    }
}

#[test]
fn degenerate_data_end_in_a_typed_answer() {
    let one = |theta_r: &[f64], dolp: f64| -> Measurement {
        let text: String = theta_r.iter().map(|theta_r| format!("40,{theta_r},{dolp}\n")).collect();
        let text = format!("theta_i,theta_r,dolp\n{text}");
        pbrdf::measurement::Measurement::read(text.as_bytes()).expect("a good table")
    };
    let angles = grid(0, 80, 5);
    for (name, measurement) in [
        ("one point", one(&[30.0], 0.1)),
        ("the same point again and again", one(&[30.0; 20], 0.1)),
        ("constant data", one(&angles, 0.1)),
        ("all zero", one(&angles, 0.0)),
        ("above any Fresnel limit", one(&angles, 1.0)),
    ] {
        for distribution in [Gauss, Cauchy] {
            let report = fit(&problem(&measurement, distribution, Parameters::default()), Starts::Automatic, 1, Observer::NONE);
            assert!(report.statistics.rss.is_finite(), "{name}");
            for estimate in &report.estimates {
                assert!(estimate.value.is_finite() && estimate.std_error.is_none_or(f64::is_finite), "{name}: {estimate:?}");
            }
            if name.contains("point") {
                assert_eq!(report.stop_reason, StopReason::Underdetermined, "{name}");
                assert!(report.estimates.iter().all(|estimate| estimate.std_error.is_none()), "{name}");
            }
        }
    }
}

#[test]
fn a_parameter_without_effect_is_open_and_not_at_a_bound() {
    let truth = Parameters { kd: 0.0, kv: 0.2, c: -0.3, ..Parameters::default() };
    let surface = Pbrdf::new(Model::full(Cauchy), truth).expect("a valid surface");
    let simulation = Simulation {
        model_name: "test".to_owned(),
        surface,
        theta_i: vec![30.0, 50.0],
        theta_r: grid(0, 80, 5),
        dphi: 180.0,
        columns: Columns::Dolp,
        noise: 0.002,
        brdf_noise: 0.0,
        seed: 2,
    };
    let measurement = simulation.run().expect("valid angles");
    let report = fit(&problem(&measurement, Cauchy, Parameters::default()), Starts::Automatic, 1, Observer::NONE);
    let estimate = |parameter| report.estimates.iter().find(|estimate| estimate.parameter == parameter).expect("a parameter of the model");
    assert_eq!(estimate(Parameter::Kd).at_bound, Some(Edge::Lower));
    // With k_d = 0 there is no lobe for c to shape: wherever the search left it, it goes back to its start.
    let c = estimate(Parameter::C);
    assert_eq!((c.value, c.at_bound, c.status()), (Parameters::default().c, None, EstimateStatus::Undetermined));
}

#[test]
fn any_number_of_starts_can_be_asked_for_and_given_up() {
    let data = simulate(Cauchy, TRUTH, Columns::Dolp, vec![30.0, 60.0], grid(0, 80, 20), 0.0);
    let evaluations = AtomicUsize::new(0);
    let cancelled = || evaluations.fetch_add(1, Ordering::Relaxed) > 20;
    let watch = Observer { cancelled: &cancelled, ..Observer::NONE };
    let report = fit(&problem(&data, Cauchy, Parameters::default()), Starts::Exactly(usize::MAX), 1, watch);
    assert_eq!(report.stop_reason, StopReason::Cancelled);
    assert!(report.objective.is_some_and(f64::is_finite));
}

#[test]
fn a_start_whose_radiance_overflows_ends_the_fit_and_not_the_program() {
    let data = simulate(Gauss, TRUTH, Columns::Brdf, vec![30.0, 60.0], grid(0, 80, 20), 0.0);
    // (cos θi cos θr)^c is 1e1060 at 60° and 80°.
    let start = Parameters { c: -1e3, ..TRUTH };
    let mut bounds = Bounds::default();
    bounds.set(Parameter::C, -1e3, 0.0).expect("bounds in the domain");
    let model = Model::full(Gauss);
    let problem = Problem::new(&data, model, start, model.parameters(), bounds, FitOptions::default()).expect("a valid problem");
    let report = fit(&problem, Starts::One, 0, Observer::NONE);
    assert_eq!(report.stop_reason, StopReason::Numerical);
    assert!(report.correlations.parameters.is_empty() && report.estimates.iter().all(|estimate| estimate.std_error.is_none()));
}
