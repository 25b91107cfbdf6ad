//! Ties between parameters, ranges of angles, and weights of measurements.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::Parameter::{K, Kd, Kv, N, Q, Sigma};
use pbrdf::fit::{FitRange, Intervals, JointFit, Starts};
use pbrdf::model::{Parameters, Pbrdf};
use pbrdf::optics::{Facet, Geometry};
use pbrdf::{Fit, Measurement, Model};

/// Relative difference of values that two ways to the same minimum may leave; the solver stops at 1e-8 and better.
const SAME: f64 = 1e-5;

fn is_same(one: f64, other: f64) -> bool {
    (one - other).abs() <= SAME * other.abs()
}

/// DoLP of a surface at θi and signed θr, with noise that is the same everywhere.
fn measured(parameters: Parameters, phase: f64) -> Measurement {
    let surface = Pbrdf::new(Model::CAUCHY, parameters).expect("a surface");
    let mut table = String::from("theta_i,theta_r,dphi,dolp\n");
    for theta_i in [20.0, 35.0, 50.0, 65.0, 75.0] {
        for theta_r in [-60.0_f64, -40.0, -10.0, 10.0, 25.0, 40.0, 55.0, 70.0, 80.0] {
            let dphi = if theta_r < 0.0 { 0.0 } else { 180.0 };
            let dolp = surface.dolp(&Facet::new(Geometry::new(theta_i, theta_r.abs(), dphi).expect("angles")));
            let noise = 0.003 * libm::sin(phase + 12.9898 * theta_i + 78.233 * theta_r);
            table += &format!("{theta_i},{},{dphi},{}\n", theta_r.abs(), (dolp + noise).clamp(0.0, 1.0));
        }
    }
    Measurement::read(table.as_bytes()).expect("a measurement")
}

fn surface(n: f64, k: f64) -> Parameters {
    Parameters { n, k, sigma: 0.35, kd: 0.1, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6, ..Parameters::default() }
}

#[test]
fn a_tied_parameter_is_the_other_one_times_the_factor_and_no_unknown() {
    let data = measured(surface(2.0, 3.0), 0.0);
    let fit = Fit::new(&data, Model::CAUCHY).tie(Kv, 2.0, Kd).fix(Q, 2.2);
    let problem = fit.problem().expect("a problem");
    assert!(!problem.free().contains(&Kv) && problem.free().contains(&Kd));
    let result = fit.run().expect("a fit");
    assert_eq!(result.parameters.kv, 2.0 * result.parameters.kd);
    let (kd, kv) = (result[Kd], result[Kv]);
    let [one, other] = [kd, kv].map(|estimate| estimate.interval68.expect("an interval"));
    assert_eq!((kv.value, one.low.map(|low| 2.0 * low), one.high.map(|high| 2.0 * high)), (2.0 * kd.value, other.low, other.high));
    // The minimum is that of a search over k_v with k_d held at the half of it.
    let held = |kv: f64| {
        let fit = Fit::new(&data, Model::CAUCHY).fix(Kv, kv).fix(Kd, 0.5 * kv).fix(Q, 2.2).start_at_rest(&result.parameters);
        fit.objective.expect("ΔE")
    };
    let best = result.objective.expect("ΔE");
    assert!(is_same(held(kv.value), best));
    assert!(held(1.02 * kv.value) > best && held(0.98 * kv.value) > best);
}

/// The fit from those values of what is free.
trait FromThere {
    fn start_at_rest(self, parameters: &Parameters) -> pbrdf::fit::FitResult;
}

impl FromThere for Fit<'_> {
    fn start_at_rest(self, parameters: &Parameters) -> pbrdf::fit::FitResult {
        let fit = [N, K, Sigma, pbrdf::Parameter::C, pbrdf::Parameter::SigmaV].into_iter();
        let fit = fit.fold(self, |fit, parameter| fit.start(parameter, parameters[parameter]));
        fit.starts(Starts::One).intervals(Intervals::None).run().expect("a fit")
    }
}

#[test]
fn the_jacobian_of_a_tied_problem_is_that_of_its_residuals() {
    let data = measured(surface(2.0, 3.0), 0.0);
    let problem = Fit::new(&data, Model::CAUCHY).tie(Kv, 2.0, Kd).tie(K, 1.5, N).problem().expect("a problem");
    let at = *problem.start();
    let (_, jacobian) = problem.linearised(&at).expect("finite");
    for (column, &parameter) in problem.free().iter().enumerate() {
        let h = 1e-6 * at[parameter].abs().max(0.1);
        let [below, above] = [-h, h].map(|step| {
            let mut there = at;
            there[parameter] += step;
            problem.linearised(&there).expect("finite").0
        });
        let difference = (above - below) / (2.0 * h);
        // A central difference is exact to about h² and to rounding over h.
        let distance = (&difference - jacobian.column(column)).norm();
        assert!(distance <= 1e-6 * difference.norm().max(1e-3), "{parameter:?}: {distance}");
    }
}

#[test]
fn the_box_of_what_others_are_tied_to_leaves_them_in_theirs() {
    let data = measured(surface(2.0, 3.0), 0.0);
    let problem = Fit::new(&data, Model::CAUCHY).tie(K, -2.0, N).problem();
    assert_eq!(problem.expect_err("k is not negative").to_string(), "k = -2 × n lies outside its bounds whatever n is within its own");
    let problem = Fit::new(&data, Model::CAUCHY).bound(K, 1.0..=3.0).tie(K, 2.0, N).problem().expect("a problem");
    assert_eq!((problem.bounds().of(N), problem.start().n, problem.start().k), ((0.5, 1.5), 1.5, 3.0));
}

#[test]
fn a_tied_parameter_of_a_joint_fit_is_own_where_the_other_one_is() {
    let [red, blue] = [(2.0, 3.0, 0.0), (1.6, 2.4, 1.0)].map(|(n, k, phase)| measured(surface(n, k), phase));
    let fit = JointFit::new([&red, &blue], Model::CAUCHY).own([N]).tie(K, 1.5, N).tie(Kv, 2.0, Kd).starts(Starts::One);
    let result = fit.intervals(Intervals::Linear).run().expect("a fit");
    for set in &result.sets {
        assert_eq!((set.parameters.k, set.parameters.kv), (1.5 * set.parameters.n, 2.0 * set.parameters.kd));
        let own: Vec<_> = set.own.iter().map(|estimate| (estimate.parameter, estimate.value)).collect();
        assert_eq!(own, [(N, set.parameters.n), (K, set.parameters.k)]);
    }
    assert!(result.uncertainty.determined.iter().all(|unknown| unknown.parameter != K && unknown.parameter != Kv));
}

#[test]
fn a_range_fits_what_a_mask_of_the_rest_does() {
    let data = measured(surface(2.0, 3.0), 0.0);
    let range = FitRange { theta_i: [30.0, 70.0], theta_r: [-20.0, 60.0] };
    let mut masked = data.clone();
    for row in &mut masked.rows {
        let signed = if row.geometry.dphi().0 == 0.0 { -row.geometry.theta_r().0 } else { row.geometry.theta_r().0 };
        row.masked = !(30.0..=70.0).contains(&row.geometry.theta_i().0) || !(-20.0..=60.0).contains(&signed);
    }
    let of = |fit: Fit<'_>| fit.starts(Starts::One).intervals(Intervals::Linear).run().expect("a fit");
    let (within, unmasked) = (of(Fit::new(&data, Model::CAUCHY).range(range)), of(Fit::new(&masked, Model::CAUCHY)));
    assert_eq!((within.parameters, within.objective, within.statistics), (unmasked.parameters, unmasked.objective, unmasked.statistics));
    assert_ne!(within.objective, of(Fit::new(&data, Model::CAUCHY)).objective);
}

#[test]
fn a_measurement_of_weight_two_counts_as_if_it_had_been_made_twice() {
    let [red, blue] = [(2.0, 3.0, 0.0), (2.1, 3.1, 1.0)].map(|(n, k, phase)| measured(surface(n, k), phase));
    let of = |fit: JointFit<'_>| fit.starts(Starts::One).intervals(Intervals::Linear).run().expect("a fit");
    let weighted = of(JointFit::new([&red, &blue], Model::CAUCHY).weights([2.0, 1.0]));
    let twice = of(JointFit::new([&red, &blue, &red], Model::CAUCHY).named(["red", "blue", "red again"]));
    let same_weights = of(JointFit::new([&red, &blue], Model::CAUCHY).weights([3.0, 3.0]));
    let plain = of(JointFit::new([&red, &blue], Model::CAUCHY));
    // Values that the data leave open may differ by more: the curves are what is compared.
    for (one, other) in [(&weighted, &twice), (&same_weights, &plain)] {
        for (set, other) in one.sets.iter().zip(&other.sets) {
            let (one, other) = (set.objective.expect("ΔE"), other.objective.expect("ΔE"));
            assert!(is_same(one, other), "{one} {other}");
        }
    }
    assert!(!is_same(weighted.sets[0].objective.expect("ΔE"), plain.sets[0].objective.expect("ΔE")));
    assert!(!weighted.statistics.minimises_delta_e && plain.statistics.minimises_delta_e);
    let error = JointFit::new([&red, &blue], Model::CAUCHY).weights([0.0]).run().expect_err("no weight");
    assert_eq!(error.to_string(), "the weight of 1 is 0: expected a number above 0");
}
