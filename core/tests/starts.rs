//! Does the default fit find the best minimum known? On 96 simulated problems of DoLP and 60 of BRDF alone, against
//! SciPy's best of 24 starts. Slow:
//! `cargo test --release --test starts -- --ignored --nocapture`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

mod common;
#[path = "common/fit_problems.rs"]
mod fit_problems;

use fit_problems::{Case, brdf_cases, cases};
use pbrdf::fit::{FitResult, Observer, Starts, fit, with_intervals};
use pbrdf::measurement::Row;
use std::path::Path;

/// The set that the reference was made for: its seed, and surfaces for each layout, noise and distribution.
const SET: (u64, u64) = (2026, 4);
/// The bar: as good as the best known within this fraction, or below this objective, where rounding begins.
const FACTOR: f64 = 1.0 + 1e-6;
const ABSOLUTE: f64 = 1e-20;

/// The seed of the problems of BRDF alone, and surfaces for each layout, noise and distribution.
const BRDF_SET: (u64, u64) = (3, 2);

/// The default fit, with its intervals: what they find counts.
fn default_fit(case: &Case) -> FitResult {
    let problem = case.problem();
    with_intervals(&problem, fit(&problem, Starts::Automatic, 1, Observer::NONE), Observer::NONE)
}

/// Asserts that what the default fit minimises is nowhere above the reference.
fn is_nowhere_behind(reference: &str, problems: &[Case], minimised: impl Fn(&FitResult) -> f64) {
    let mut behind = Vec::new();
    let reference = common::table(reference);
    for row in &reference {
        let case = problems.iter().find(|case| case.name == row.text("problem")).expect("a problem of the set");
        let (found, known) = (minimised(&default_fit(case)), row.number("objective"));
        println!("{:32} {found:.9e} {:+.1e}", case.name, found / known - 1.0);
        if found > known * FACTOR && found > ABSOLUTE {
            behind.push(case.name.as_str());
        }
    }
    assert!(behind.is_empty(), "of {} problems these are behind: {behind:?}", reference.len());
}

#[test]
#[ignore = "takes half a minute in a release build"]
fn the_default_fit_is_as_good_as_the_best_known() {
    is_nowhere_behind("fit_problems.csv", &cases(SET.0, SET.1), |result| result.objective.expect("data with light"));
}

#[test]
#[ignore = "takes half a minute in a release build"]
fn the_default_fit_of_brdf_alone_is_as_good_as_the_best_known() {
    is_nowhere_behind("brdf_problems.csv", &brdf_cases(BRDF_SET.0, BRDF_SET.1), |result| result.statistics.rss);
}

#[test]
#[ignore = "takes some minutes in a release build"]
fn the_default_fit_of_brdf_alone_is_as_good_as_four_thousand_starts() {
    let behind: Vec<String> = brdf_cases(BRDF_SET.0, BRDF_SET.1)
        .into_iter()
        .filter(|case| {
            let many = fit(&case.problem(), Starts::Exactly(4000), 1, Observer::NONE).statistics.rss;
            default_fit(case).statistics.rss > many * FACTOR
        })
        .map(|case| case.name)
        .collect();
    assert!(behind.is_empty(), "{behind:?}");
}

#[test]
#[ignore = "writes the data for assets/reference/make_fit_problems.py"]
fn write_the_problems() {
    write("target/fit_problems", "dolp", &cases(SET.0, SET.1), |row| row.dolp.as_ref().map(|dolp| dolp.value));
    write("target/brdf_problems", "brdf", &brdf_cases(BRDF_SET.0, BRDF_SET.1), |row| row.brdf.as_ref().map(|brdf| brdf.value));
}

fn write(folder: &str, column: &str, cases: &[Case], value: impl Fn(&Row) -> Option<f64>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    for case in cases {
        let rows = case.measurement.rows.iter().map(|row| {
            let measured = value(row).expect("the column is simulated");
            format!("{},{},{},{measured:.16e}\n", row.geometry.theta_i().0, row.geometry.theta_r().0, row.geometry.dphi().0)
        });
        let text: String = std::iter::once(format!("theta_i,theta_r,dphi,{column}\n")).chain(rows).collect();
        std::fs::write(folder.join(format!("{}.csv", case.name)), text).expect("a writable folder");
    }
}
