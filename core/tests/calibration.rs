//! Are standard errors what they say? Slow: `cargo test --release --test calibration -- --ignored --nocapture`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

use pbrdf::fit::{Bounds, FitOptions, Observer, Problem, Starts, fit, free_by_default};
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::model::{Model, Parameters, Pbrdf, PerParameter};
use pbrdf::optics::SlopeDistribution;

const TRUTH: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 };
const DATA_SETS: u32 = 2000;

/// Shares of a normal distribution within one and two standard deviations are 68.3 and 95.4 %; 2,000 sets scatter by
/// 1.0 and 0.5 % (one standard deviation), the model's curvature adds its own.
#[test]
#[ignore = "takes half a minute in a release build"]
fn the_truth_lies_within_the_standard_errors_as_often_as_it_should() {
    for distribution in [SlopeDistribution::Gauss, SlopeDistribution::Cauchy] {
        let model = Model::full(distribution);
        let mut within = PerParameter::<[u32; 2]>::default();
        let mut determined = PerParameter::<u32>::default();
        for seed in 0..DATA_SETS {
            let measurement = Simulation {
                model_name: "test".to_owned(),
                surface: Pbrdf::new(model, TRUTH).expect("a valid surface"),
                theta_i: (1..9).map(|i| f64::from(10 * i)).collect(),
                theta_r: (0..18).map(|i| f64::from(5 * i)).collect(),
                dphi: 180.0,
                columns: Columns::Dolp,
                noise: 0.002,
                brdf_noise: 0.0,
                seed: u64::from(seed),
            }
            .run()
            .expect("valid angles");
            let free = free_by_default(model, &measurement, &FitOptions::default());
            let problem =
                Problem::new(&measurement, model, TRUTH, free, Bounds::default(), FitOptions::default()).expect("a valid problem");
            let report = fit(&problem, Starts::One, 0, Observer::NONE);
            for estimate in &report.estimates {
                if let Some(error) = estimate.std_error {
                    let parameter = estimate.parameter;
                    let off = (estimate.value - TRUTH[estimate.parameter]).abs() / error;
                    determined[parameter] += 1;
                    within[parameter][0] += u32::from(off <= 1.0);
                    within[parameter][1] += u32::from(off <= 2.0);
                }
            }
        }
        for parameter in free_of(model) {
            let share = |k: usize| 100.0 * f64::from(within[parameter][k]) / f64::from(determined[parameter]);
            println!(
                "{distribution:?} {:<8} within 1σ {:.1} %, within 2σ {:.1} % of {}",
                parameter.key(),
                share(0),
                share(1),
                determined[parameter]
            );
            assert!((64.0..=72.0).contains(&share(0)) && (93.0..=97.5).contains(&share(1)), "{distribution:?} {parameter:?}");
        }
    }
}

fn free_of(model: Model) -> impl Iterator<Item = pbrdf::model::Parameter> {
    model.parameters().into_iter().filter(|parameter| *parameter != pbrdf::model::Parameter::Ks)
}
