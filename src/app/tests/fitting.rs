//! Pressing Fit, and what follows.

use super::{explorer, harness, wait};
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::Parameters;

#[test]
fn pressing_fit_moves_the_sliders_to_a_better_place() {
    let mut harness = harness();
    let before = explorer(&mut harness).derived.delta_e.expect("the example has DoLP");
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    let report = &explorer.last_fit.as_ref().expect("a fit").report;
    assert_eq!(explorer.settings.parameters, report.parameters);
    assert_eq!(explorer.derived.delta_e, report.objective);
    assert!(report.objective.expect("an objective") < 0.5 * before);
}

#[test]
fn back_and_use_as_sliders_go_to_and_fro() {
    let mut harness = harness();
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    let fitted = explorer(&mut harness).settings.parameters;
    harness.get_by_label("Back").click();
    harness.run();
    assert_eq!(explorer(&mut harness).settings.parameters, Parameters::default());
    harness.get_by_label("Use as sliders").click();
    harness.run();
    assert_eq!(explorer(&mut harness).settings.parameters, fitted);
}

#[test]
fn a_start_outside_the_sliders_is_no_obstacle() {
    let mut harness = harness();
    explorer(&mut harness).settings.parameters.n = 14.0;
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.notice, None);
    assert!(explorer.last_fit.is_some());
}

#[test]
fn a_fixed_parameter_stays() {
    let mut harness = harness();
    harness.get_by_label("Fix sigma").click();
    harness.run();
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).settings.parameters.sigma, Parameters::default().sigma);
}
