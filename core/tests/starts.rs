//! Does the default fit find the best minimum known? On 96 simulated problems, against SciPy's best of 24 starts. Slow:
//! `cargo test --release --test starts -- --ignored --nocapture`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

mod common;
#[path = "common/fit_problems.rs"]
mod fit_problems;

use fit_problems::{Case, cases};
use pbrdf::fit::{Observer, Starts, fit, with_intervals};
use std::path::Path;

/// The set that the reference was made for: its seed, and surfaces for each layout, noise and distribution.
const SET: (u64, u64) = (2026, 4);
/// The bar: as good as the best known within this fraction, or below this objective, where rounding begins.
const FACTOR: f64 = 1.0 + 1e-6;
const ABSOLUTE: f64 = 1e-20;

fn objective_of_default_fit(case: &Case) -> f64 {
    let problem = case.problem();
    with_intervals(&problem, fit(&problem, Starts::Automatic, 1, Observer::NONE), Observer::NONE).objective.expect("data with light")
}

#[test]
#[ignore = "takes half a minute in a release build"]
fn the_default_fit_is_as_good_as_the_best_known() {
    let problems = cases(SET.0, SET.1);
    let mut behind = Vec::new();
    let reference = common::table("fit_problems.csv");
    for row in &reference {
        let case = problems.iter().find(|case| case.name == row.text("problem")).expect("a problem of the set");
        let (found, known) = (objective_of_default_fit(case), row.number("objective"));
        println!("{:32} {found:.9e} {:+.1e}", case.name, found / known - 1.0);
        if found > known * FACTOR && found > ABSOLUTE {
            behind.push(case.name.as_str());
        }
    }
    assert!(behind.is_empty(), "of {} problems these are behind: {behind:?}", reference.len());
}

#[test]
#[ignore = "writes the data for assets/reference/make_fit_problems.py"]
fn write_the_problems() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/fit_problems");
    std::fs::create_dir_all(&folder).expect("a folder");
    for case in cases(SET.0, SET.1) {
        let rows = case.measurement.rows.iter().map(|row| {
            let dolp = row.dolp.expect("DoLP is simulated").value;
            format!("{},{},{},{dolp:.16e}\n", row.geometry.theta_i().0, row.geometry.theta_r().0, row.geometry.dphi().0)
        });
        let text: String = std::iter::once("theta_i,theta_r,dphi,dolp\n".to_owned()).chain(rows).collect();
        std::fs::write(folder.join(format!("{}.csv", case.name)), text).expect("a writable folder");
    }
}
