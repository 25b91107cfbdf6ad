//! No model of the ladder ends above a special case of itself, and a fit heeds the further starts that it is given.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::Fit;
use pbrdf::fit::{
    Bounds, FitOptions, FitResult, Intervals, Observer, Problem, Starts, Weights, fit, fit_ladder, free_by_default, special_cases_first,
};
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{Model, PRESETS, Parameter, Parameters, Pbrdf, Preset};

const STEEL: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 };

/// The special case and the model that has more terms.
const NESTED: [(&str, &str); 7] = [
    ("specular-gauss", "lambert"),
    ("lambert", "minnaert"),
    ("lambert", "three-component"),
    ("specular-gauss", "gauss"),
    ("minnaert", "gauss"),
    ("three-component", "gauss"),
    ("specular", "cauchy"),
];
/// What is special where DoLP alone is measured: that of mirror facets is that of Fresnel.
const NESTED_BY_DOLP: [(&str, &str); 3] = [("fresnel", "lambert"), ("priest-germer", "gauss"), ("specular-gauss", "cauchy")];

/// Both models do the same sums in another order: far above rounding, far below what data can tell.
const SAME: f64 = 1e-9;

/// The steel angles of the paper.
fn measurement(columns: Columns, seed: u64) -> Measurement {
    let surface = Pbrdf::new(Model::CAUCHY, STEEL).expect("a valid surface");
    let theta_r = (20..=60).step_by(5).map(f64::from).collect();
    let (theta_i, dphi) = (vec![30.0, 40.0, 50.0], 180.0);
    Simulation { model_name: "cauchy".to_owned(), surface, theta_i, theta_r, dphi, columns, noise: 0.005, brdf_noise: 0.02, seed }
        .run()
        .expect("valid angles")
}

/// The fits of all presets that predict what is measured, by their keys.
fn ladder(measurement: &Measurement, options: FitOptions, starts: Starts, seed: u64) -> Vec<(&'static str, FitResult)> {
    let problems = problems(measurement, options);
    let posed: Vec<Option<&Problem>> = problems.iter().map(Option::as_ref).collect();
    let fits = fit_ladder(&posed, |_, problem| Some(fit(problem, starts, seed, Observer::NONE)));
    PRESETS.iter().zip(fits).filter_map(|(preset, fit)| Some((preset.key, fit?))).collect()
}

/// The problem of each preset that predicts what is measured.
fn problems(measurement: &Measurement, options: FitOptions) -> Vec<Option<Problem>> {
    let of = |preset: &Preset| {
        let options = FitOptions { dolp_only: preset.dolp_only, ..options };
        let free = free_by_default(preset.model, measurement, &options);
        Problem::new(measurement, preset.model, Parameters::default(), free, Bounds::default(), options).ok()
    };
    PRESETS.iter().map(of).collect()
}

#[test]
fn a_ladder_that_is_stopped_keeps_what_it_has() {
    let problems = problems(&measurement(Columns::Brdf, 1), FitOptions::default());
    let posed: Vec<Option<&Problem>> = problems.iter().map(Option::as_ref).collect();
    let mut order = Vec::new();
    let fits = fit_ladder(&posed, |place, problem| {
        order.push(place);
        (order.len() <= 3).then(|| fit(problem, Starts::One, 1, Observer::NONE))
    });
    assert!(problems.iter().any(Option::is_none), "a model of DoLP alone predicts no BRDF");
    let fitted: Vec<usize> = (0..fits.len()).filter(|&place| fits[place].is_some()).collect();
    let mut first = order[..3].to_vec();
    first.sort_unstable();
    assert_eq!((order.len(), fitted), (4, first));
}

#[test]
fn no_model_ends_above_a_special_case_of_itself() {
    let sets = [(Columns::Dolp, Weights::None), (Columns::Brdf, Weights::None), (Columns::Both, Weights::Sigma)];
    for (columns, weights) in sets {
        // The search by itself misses some special cases on these draws, a single start most.
        for (starts, seeds) in [(Starts::One, 1..=6), (Starts::Automatic, 1..=2)] {
            for seed in seeds {
                let fits = ladder(&measurement(columns, seed), FitOptions { weights, ..FitOptions::default() }, starts, seed);
                let sum = |key: &str| fits.iter().find(|(of, _)| *of == key).map(|(_, fit)| fit.statistics.rss);
                let by_dolp = NESTED_BY_DOLP.iter().filter(|_| matches!(columns, Columns::Dolp));
                for (special, general) in NESTED.iter().chain(by_dolp) {
                    let (Some(special_sum), Some(sum)) = (sum(special), sum(general)) else { panic!("{special}, {general} are fitted") };
                    assert!(
                        sum <= special_sum * (1.0 + SAME),
                        "{columns:?} {starts:?} {seed}: {general} {sum:e} above {special} {special_sum:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn cauchy_starts_also_at_the_gauss_that_it_tends_to() {
    let measurement = measurement(Columns::Dolp, 3);
    let fits = ladder(&measurement, FitOptions::default(), Starts::Automatic, 1);
    let (_, gauss) = fits.iter().find(|(key, _)| *key == "gauss").expect("a fit");
    let (_, cauchy) = fits.iter().find(|(key, _)| *key == "cauchy").expect("a fit");
    // At q = 20, its bound, Cauchy is Gauss to a few per cent of its slopes, which DoLP of noise 0.005 hardly tells.
    const NEARLY: f64 = 1.01;
    assert!(cauchy.statistics.rss <= gauss.statistics.rss * NEARLY, "{:e} {:e}", cauchy.statistics.rss, gauss.statistics.rss);
}

#[test]
fn every_special_case_is_fitted_before_what_contains_it() {
    let models = PRESETS.map(|preset| preset.model);
    let order: Vec<&str> = special_cases_first(&models).into_iter().map(|index| PRESETS[index].key).collect();
    let place = |key: &str| order.iter().position(|of| *of == key).expect("a preset");
    for (special, general) in NESTED.iter().chain(&NESTED_BY_DOLP) {
        assert!(place(special) < place(general), "{order:?}");
    }
}

#[test]
fn a_fit_ends_above_none_of_its_further_starts_and_keeps_to_bounds_and_what_is_fixed() {
    let measurement = measurement(Columns::Dolp, 1);
    let model = Preset::from_key("lambert").expect("a preset").model;
    let known = Fit::new(&measurement, model).fix(Parameter::K, 2.9).intervals(Intervals::None);
    let best = known.clone().run().expect("a valid fit");
    // From here alone a single descent ends elsewhere, or not at all: no step is taken beyond a start that is the best.
    let far = Parameters { n: 0.2, sigma: 2.0, kd: 9.0, ..best.parameters };
    let single = known.clone().start_at(far).fix(Parameter::K, 2.9).starts(Starts::One);
    let found = single.clone().start_also_at(Parameters { k: 0.5, ..best.parameters }).run().expect("a valid fit");
    assert!(found.statistics.rss <= best.statistics.rss * (1.0 + SAME), "{:e} {:e}", found.statistics.rss, best.statistics.rss);
    assert_eq!(found.parameters.k, 2.9);
    let outside = single.bound(Parameter::N, 0.1..=1.0).start_also_at(best.parameters).run().expect("a valid fit");
    assert!((0.1..=1.0).contains(&outside.parameters.n), "{}", outside.parameters.n);
}
