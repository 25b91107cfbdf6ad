//! What is said about a parameter must be true: profile-likelihood intervals on data that came out wrong, and on their definition.
#![allow(clippy::expect_used, clippy::cast_precision_loss, reason = "a test fails by panicking, and its numbers of rows are small")]

use pbrdf::Fit;
use pbrdf::fit::{Edge, EstimateStatus, FitOptions, FitResult, Interval, Intervals, Loss, Observer, Starts, Weights, bootstrap, profile};
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{Model, Parameter, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution::{Cauchy, Gauss};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

const CAUCHY: Model = Model::CAUCHY;
/// Ends are refined until the rise of the objective is right to 1e-3, so that they move by half of that of their distance; held
/// fits add as much.
const END: f64 = 0.01;
/// F_{1,19} at 68.27 and 95 %, from SciPy.
const F19: [f64; 2] = [1.0548, 4.3807];

fn data(name: &str) -> Measurement {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/fits").join(name);
    Measurement::read(std::fs::File::open(path).expect("a file of the repository")).expect("a measurement")
}

fn fitted(data: &Measurement) -> FitResult {
    Fit::new(data, CAUCHY).run().expect("a valid fit")
}

fn interval68(result: &FitResult, parameter: Parameter) -> Interval {
    result[parameter].interval68.expect("a free parameter")
}

fn interval95(result: &FitResult, parameter: Parameter) -> Interval {
    result[parameter].interval95.expect("a free parameter")
}

fn near(found: Option<f64>, expected: f64, relative: f64) -> bool {
    found.is_some_and(|found| (found / expected - 1.0).abs() <= relative)
}

/// The steel angles of the paper, or a dense grid.
fn simulated(model: Model, truth: Parameters, is_dense: bool, columns: Columns, noise: [f64; 2], seed: u64) -> Measurement {
    let grid = |from: u32, to: u32, step: usize| (from..=to).step_by(step).map(f64::from).collect::<Vec<f64>>();
    let (theta_i, theta_r) = if is_dense { (grid(10, 80, 10), grid(0, 85, 5)) } else { (grid(30, 50, 10), grid(20, 60, 5)) };
    let surface = Pbrdf::new(model, truth).expect("a valid surface");
    let [noise, brdf_noise] = noise;
    Simulation { model_name: "test".to_owned(), surface, theta_i, theta_r, dphi: 180.0, columns, noise, brdf_noise, seed }
        .run()
        .expect("valid angles")
}

const STEEL: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 };

#[test]
fn exact_data_determine_what_they_are_made_from() {
    // A misfit of 1e-10 counts as rounding; the least sensitive parameter of these moves by 1e4 times that.
    const NARROW: f64 = 1e-6;
    let other = Parameters { n: 2.755, k: 7.6, sigma: 0.38, q: 2.9, ..STEEL };
    for (model, truth, is_dense) in [(CAUCHY, STEEL, false), (CAUCHY, STEEL, true), (CAUCHY, other, true), (Model::GAUSS, other, true)] {
        let result = Fit::new(&simulated(model, truth, is_dense, Columns::Dolp, [0.0; 2], 0), model).run().expect("a valid fit");
        for estimate in result.estimates.iter().filter(|estimate| estimate.free) {
            let (name, value) = (estimate.parameter, truth[estimate.parameter]);
            for Interval { low, high } in [estimate.interval68, estimate.interval95].into_iter().flatten() {
                assert!(low.is_some_and(|low| low <= value) && near(low, value, NARROW), "{name:?} from {low:?}, made from {value}");
                assert!(high.is_some_and(|high| high >= value) && near(high, value, NARROW), "{name:?} to {high:?}, made from {value}");
            }
        }
        assert!(result.undetermined().next().is_none());
    }
}

#[test]
fn the_narrow_interval_ends_where_the_wide_one_does() {
    // Aluminium at angles that tell little: a profile of many branches.
    let truth = Parameters { n: 1.24, k: 6.6, sigma: 0.3, ks: 1.0, kd: 0.1, kv: 0.1, q: 2.0, c: -0.5, sigma_v: 0.5 };
    let (theta_i, theta_r) = (vec![30.0, 40.0, 50.0, 60.0], (4..=12).map(|step| 5.0 * f64::from(step)).collect());
    let surface = Pbrdf::new(CAUCHY, truth).expect("a valid surface");
    let simulation = Simulation {
        model_name: "test".to_owned(),
        surface,
        theta_i,
        theta_r,
        dphi: 180.0,
        columns: Columns::Dolp,
        noise: 0.002,
        brdf_noise: 0.0,
        seed: 1,
    };
    let result = fitted(&simulation.run().expect("valid angles"));
    for estimate in result.estimates.iter().filter(|estimate| estimate.free) {
        let (Some(narrow), Some(wide)) = (estimate.interval68, estimate.interval95) else { continue };
        let is_within = |inner: Option<f64>, outer: Option<f64>, sign: f64| {
            outer.is_none_or(|outer| inner.is_some_and(|inner| sign * (outer - inner) >= 0.0))
        };
        assert!(
            is_within(narrow.low, wide.low, -1.0) && is_within(narrow.high, wide.high, 1.0),
            "{:?}: {narrow:?} in {wide:?}",
            estimate.parameter
        );
    }
}

#[test]
fn a_quadratic_effect_at_a_bound_has_an_upper_end() {
    let result = fitted(&data("k0.csv"));
    let k = result[Parameter::K];
    assert_eq!((k.value, k.at_bound, k.std_error), (0.0, Some(Edge::Lower), None));
    assert!(result.undetermined().all(|direction| direction.direction.iter().all(|(parameter, _)| *parameter != Parameter::K)));
    let Interval { low, high } = interval68(&result, Parameter::K);
    // By SciPy, with k held on a grid.
    assert!(low.is_none() && near(high, 0.066, 0.03), "{high:?}");
}

#[test]
fn a_weight_near_the_end_of_f64_hides_nothing() {
    let result = fitted(&data("specular_all_open.csv"));
    for parameter in [Parameter::N, Parameter::K] {
        let interval = interval68(&result, parameter);
        let width = interval.high.expect("closed") - interval.low.expect("closed");
        assert!(width < 0.02 * result[parameter].value, "{parameter:?} {interval:?}");
    }
}

#[test]
fn on_a_curved_ridge_the_interval_is_not_the_linear_error() {
    let result = fitted(&data("steel15.csv"));
    let Interval { low, high } = interval68(&result, Parameter::N);
    assert!(near(low, 0.80, 0.02) && high.is_none_or(|high| high >= 0.997), "{low:?} {high:?}");
    // The truth, n = 2.07, raises χ² by 3.7 only.
    assert!(interval95(&result, Parameter::N).contains(2.07), "{:?}", interval95(&result, Parameter::N));
    assert_eq!(result[Parameter::N].std_error, None);
    // The truth, k_d = 0.12, lies far above the value of 2e-8.
    assert!(interval68(&fitted(&data("steel1.csv")), Parameter::Kd).high.is_none_or(|high| high > 0.1));
}

#[test]
fn a_profile_stays_in_the_box_and_its_ends_are_no_chords() {
    let data = data("steel27.csv");
    let fit = Fit::new(&data, CAUCHY);
    let (problem, result) = (fit.problem().expect("a valid fit"), fit.clone().run().expect("a valid fit"));
    for parameter in [Parameter::Kv, Parameter::K] {
        let profile = profile(&problem, &result, parameter, Observer::NONE);
        let (low, high) = problem.bounds().of(parameter);
        assert!(profile.points.len() > 5 && profile.is_complete);
        assert!(profile.points.iter().all(|point| point.value >= low && point.value <= high && point.objective.is_finite()));
        assert!(profile.points.windows(2).all(|pair| pair[0].value <= pair[1].value));
        if parameter == Parameter::K {
            // A grid of 4000 held fits of SciPy.
            assert!(near(profile.interval68.high, 5.27, 0.01), "{:?}", profile.interval68.high);
        }
    }
}

#[test]
fn a_held_fit_at_an_end_meets_the_limit_and_at_an_open_side_stays_below() {
    let data = simulated(CAUCHY, Parameters { sigma: 0.67, ..STEEL }, false, Columns::Dolp, [0.005, 0.0], 5);
    let result = fitted(&data);
    assert_eq!(result.statistics.dof, 27 - result.band.uncertainty().rank);
    let smallest = result.objective.expect("data");
    for estimate in result.estimates.iter().filter(|estimate| estimate.free) {
        for (interval, level) in [(estimate.interval68, 0), (estimate.interval95, 1)] {
            let Interval { low, high } = interval.expect("intervals");
            let (lowest, highest) = estimate.parameter.range().into_inner();
            for (end, bound) in [(low, lowest), (high, highest)] {
                // A weight of exactly 0 takes its lobe away: the profile jumps there.
                if end.is_some_and(|end| (end - bound).abs() < 1e-9) {
                    continue;
                }
                let held = Fit::new(&data, CAUCHY).fix(estimate.parameter, end.unwrap_or(bound)).intervals(pbrdf::fit::Intervals::None);
                let objective = [Starts::Automatic, Starts::One]
                    .into_iter()
                    .map(|starts| held.clone().starts(starts).run().expect("a valid fit").objective.expect("data"))
                    .fold(f64::INFINITY, f64::min);
                let allowed = F19[level] / result.statistics.dof as f64 * (if result.statistics.dof == 19 { 1.0 } else { 1.03 });
                let rise = (objective / smallest - 1.0) / allowed;
                let what = format!("{:?} at level {level}: {end:?}, rise {rise}", estimate.parameter);
                if end.is_some() { assert!((rise - 1.0).abs() < 0.1, "{what}") } else { assert!(rise < 1.05, "{what}") }
            }
        }
    }
}

#[test]
fn where_data_are_many_profile_and_linear_error_agree() {
    let data = simulated(CAUCHY, STEEL, true, Columns::Dolp, [0.002, 0.0], 3);
    let result = fitted(&data);
    for estimate in result.estimates.iter().filter(|estimate| estimate.free) {
        assert!(matches!(estimate.status(), EstimateStatus::Determined(_)), "{:?}: {estimate}", estimate.parameter);
        let (inner, outer) = (estimate.interval68.expect("intervals"), estimate.interval95.expect("intervals"));
        assert!(outer.low < inner.low && inner.high < outer.high);
    }
    assert_eq!(result.course.intervals_complete, Some(true));
}

#[test]
fn the_unit_of_the_brdf_changes_nothing() {
    let unit = simulated(Model::GAUSS, STEEL, true, Columns::Brdf, [0.0, 0.02], 4);
    let fit_in = |factor: f64| {
        let mut data = unit.clone();
        for row in &mut data.rows {
            if let Some(brdf) = &mut row.brdf {
                brdf.value *= factor;
            }
        }
        let weights = [Parameter::Ks, Parameter::Kd, Parameter::Kv];
        let fit = Fit::new(&data, Model::GAUSS);
        let fit = weights
            .into_iter()
            .fold(fit, |fit, weight| fit.start(weight, factor * weight.default_value()).bound(weight, 0.0..=10.0 * factor));
        fit.run().expect("a valid fit")
    };
    let (one, tiny) = (fit_in(1.0), fit_in(1e-12));
    assert!(near(tiny.objective, one.objective.expect("data"), 1e-9));
    for (a, b) in one.estimates.iter().zip(&tiny.estimates).filter(|(a, _)| a.free) {
        let factor = if [Parameter::Ks, Parameter::Kd, Parameter::Kv].contains(&a.parameter) { 1e-12 } else { 1.0 };
        assert!((b.value / factor - a.value).abs() < 1e-6 * (1.0 + a.value.abs()), "{a:?} {b:?}");
        assert_eq!((a.determined, a.at_bound, a.std_error.is_some()), (b.determined, b.at_bound, b.std_error.is_some()), "{a:?} {b:?}");
        let high = |estimate: &pbrdf::fit::Estimate, factor: f64| estimate.interval68.expect("intervals").high.map(|high| high / factor);
        assert!(high(a, 1.0).is_none_or(|end| near(high(b, factor), end, END)), "{a:?} {b:?}");
    }
    let words = |result: &FitResult| result.undetermined().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(words(&one), words(&tiny));
}

#[test]
fn weights_far_below_their_bounds_have_intervals_too() {
    const UNIT: f64 = 1e-44;
    let data = simulated(CAUCHY, STEEL, true, Columns::Brdf, [0.0, 0.02], 5);
    let mut faint = data.clone();
    for row in &mut faint.rows {
        row.brdf.as_mut().expect("BRDF is simulated").value *= UNIT;
    }
    let run = |data: &Measurement| {
        let held = [Parameter::N, Parameter::K, Parameter::C, Parameter::SigmaV];
        held.into_iter().fold(Fit::new(data, CAUCHY), |fit, held| fit.fix(held, STEEL[held])).run().expect("a valid fit")
    };
    // The bounds of the weights are those of ever: 45 decades above the values.
    let (one, other) = (run(&data), run(&faint));
    for weight in [Parameter::Ks, Parameter::Kd, Parameter::Kv] {
        let (one, other) = (interval68(&one, weight), interval68(&other, weight));
        let is_same = |one: Option<f64>, other: Option<f64>| near(other, one.expect("a closed side") * UNIT, END);
        assert!(is_same(one.low, other.low) && is_same(one.high, other.high), "{weight:?}: {one:?} {other:?}");
    }
}

#[test]
fn dolp_and_brdf_together_are_weighted_by_their_own_variances() {
    let data = simulated(CAUCHY, STEEL, true, Columns::Both, [0.004, 0.03], 6);
    let result = fitted(&data);
    let [dolp, brdf] = result.statistics.block_weights;
    // Residuals are in units of the root of Σ Xm² of DoLP, and of the root of their number for relative ones.
    let dolps = data.rows.iter().filter_map(|row| row.dolp);
    let scale = dolps.map(|dolp| dolp.value * dolp.value).sum::<f64>().sqrt();
    let rows = (data.rows.len() as f64).sqrt();
    assert!(near(Some(scale / dolp), 0.004, 0.15), "{}", scale / dolp);
    assert!(near(Some(rows / brdf), 0.03, 0.15), "{}", rows / brdf);
    // Each residual has variance 1 then.
    assert!(near(Some(result.statistics.rss), 2.0 * data.rows.len() as f64, 1e-5), "{}", result.statistics.rss);
    // With the stated deviations instead, the same surface comes out.
    let stated = Fit::new(&data, CAUCHY).weights(Weights::Sigma).run().expect("stated deviations");
    for estimate in stated.estimates.iter().filter(|estimate| estimate.free) {
        let error = estimate.std_error.expect("determined");
        assert!((result[estimate.parameter].value - estimate.value).abs() < 0.5 * error, "{estimate:?}");
        assert!(near(result[estimate.parameter].std_error, error, 0.25), "{estimate:?}");
    }
}

#[test]
fn a_robust_loss_has_the_errors_of_its_sandwich() {
    let options = |loss| FitOptions { loss, ..FitOptions::default() };
    let mut data = simulated(CAUCHY, STEEL, true, Columns::Dolp, [0.002, 0.0], 8);
    let fit = |data: &Measurement, loss| Fit::new(data, CAUCHY).options(options(loss)).run().expect("a valid fit");
    let error = |result: &FitResult| result[Parameter::N].std_error.expect("determined");
    let plain = error(&fit(&data, Loss::Squared));
    for loss in [Loss::Huber, Loss::SoftL1] {
        // Of Gaussian noise, both losses keep 95 % of the efficiency. The sandwich takes the variance from the residuals of the few rows
        // that know n.
        let robust = error(&fit(&data, loss));
        assert!(near(Some(robust), plain, 0.6), "{loss:?}: {robust} instead of {plain}");
    }
    // Every ninth row far off: squares lose n, and the robust loss keeps its error near the plain one.
    for row in data.rows.iter_mut().step_by(9) {
        if let Some(dolp) = &mut row.dolp {
            dolp.value = (dolp.value + 0.1).min(1.0);
        }
    }
    let robust = fit(&data, Loss::Huber);
    let interval = interval95(&robust, Parameter::N);
    assert!(interval.high.expect("closed") - interval.low.expect("closed") < 8.0 * plain, "{interval:?}");
}

#[test]
fn evaluations_are_those_of_the_search_with_and_without_intervals() {
    let evaluations = |data: &Measurement, intervals| Fit::new(data, CAUCHY).intervals(intervals).run().expect("a fit").course.evaluations;
    // Of the second surface the data say little: its walks are long.
    for name in ["k0.csv", "steel15.csv"] {
        let data = data(name);
        assert_eq!(evaluations(&data, Intervals::Profile), evaluations(&data, Intervals::Linear), "{name}");
    }
}

#[test]
fn cancelled_intervals_say_that_they_are_incomplete() {
    let data = simulated(Model::full(Gauss), STEEL, false, Columns::Dolp, [0.005, 0.0], 1);
    let fit = Fit::new(&data, Model::full(Gauss)).intervals(pbrdf::fit::Intervals::Linear);
    let (problem, result) = (fit.problem().expect("a valid fit"), fit.run().expect("a valid fit"));
    let cancelled = pbrdf::fit::with_intervals(&problem, result, Observer { cancelled: &|| true, ..Observer::NONE });
    assert_eq!(cancelled.course.intervals_complete, Some(false));
    let one = profile(&problem, &cancelled, Parameter::N, Observer { cancelled: &|| true, ..Observer::NONE });
    assert!(!one.is_complete && one.interval68.is_open());
}

#[test]
fn a_bootstrap_says_how_many_replicates_it_made_and_keeps_to_the_bounds() {
    let measurement = simulated(CAUCHY, STEEL, false, Columns::Dolp, [0.005, 0.0], 1);
    let fit = Fit::new(&measurement, CAUCHY).bound(Parameter::N, 1.9..=2.2).bound(Parameter::Sigma, 0.2..=0.5);
    let (problem, result) = (fit.problem().expect("a problem"), fit.intervals(Intervals::None).run().expect("a valid fit"));
    let made = bootstrap(&problem, &result, 20, 1, Observer::NONE);
    assert_eq!((made.asked, made.replicates, made.is_complete()), (20, 20, true));
    assert_eq!(made.estimates.len(), problem.free().len());
    for estimate in &made.estimates {
        let (low, high) = problem.bounds().of(estimate.parameter);
        let [p16, p84] = [estimate.low, estimate.high];
        assert!(low <= p16 && p16 <= p84 && p84 <= high, "{estimate:?}");
    }
}

#[test]
fn a_cancelled_bootstrap_counts_what_it_made_and_nothing_that_was_cut_short() {
    let measurement = simulated(Model::SPECULAR, STEEL, false, Columns::Dolp, [0.005, 0.0], 1);
    let fit = Fit::new(&measurement, Model::SPECULAR);
    let (problem, result) = (fit.problem().expect("a problem"), fit.run().expect("a valid fit"));
    // Each descent asks now and then: some refits end before the answer changes, and most do not begin.
    let asked = AtomicUsize::new(0);
    let cancelled = || asked.fetch_add(1, Ordering::Relaxed) > 200;
    let made = bootstrap(&problem, &result, 1000, 1, Observer { cancelled: &cancelled, ..Observer::NONE });
    assert!(made.replicates > 0 && made.replicates < 200 && !made.is_complete(), "{}", made.replicates);
    let nothing = bootstrap(&problem, &result, 1000, 1, Observer { cancelled: &|| true, ..Observer::NONE });
    assert_eq!((nothing.replicates, nothing.asked, nothing.estimates.len()), (0, 1000, 0));
}

#[test]
fn distributions_of_one_surface_have_the_same_optics() {
    // The interval of n holds the truth whichever distribution is fitted: Cauchy has Gauss as its limit.
    let data = simulated(Model::full(Gauss), STEEL, true, Columns::Dolp, [0.002, 0.0], 11);
    for distribution in [Gauss, Cauchy] {
        let result = Fit::new(&data, Model::full(distribution)).run().expect("a valid fit");
        assert!(interval95(&result, Parameter::N).contains(STEEL.n), "{distribution:?}");
    }
}
