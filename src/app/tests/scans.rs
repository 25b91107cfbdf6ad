//! Profile and bootstrap of a finished fit.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, take, wait};
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::Parameter;

/// A fit with k_d alone free: determined, and quick to scan.
fn fitted() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    let locked = explorer(&mut harness).work.surface().model.parameters().without(Parameter::Kd).without(Parameter::K);
    explorer(&mut harness).work.surface_mut().locked = locked;
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    harness.get_by_label("Profile and bootstrap").click_accesskit();
    harness.run();
    harness
}

#[test]
fn a_profile_is_scanned_and_its_interval_told() {
    let mut harness = fitted();
    harness.get_by_label("Scan").click();
    harness.step();
    wait(&mut harness);
    let fit = explorer(&mut harness).work.shown_fit().cloned().expect("a fit");
    let error = fit.report.estimates.iter().find(|estimate| estimate.parameter == Parameter::K).and_then(|estimate| estimate.std_error);
    let profile = explorer(&mut harness).work.diagnostics().profile.as_ref().expect("a profile");
    let [(low, high), (lower, higher)] = profile.intervals.map(|interval| (interval.low.expect("an end"), interval.high.expect("an end")));
    // The same walks make the table and the curve.
    let estimate = fit.report[Parameter::K];
    assert_eq!([estimate.interval68, estimate.interval95].map(|interval| interval.expect("intervals")), profile.intervals);
    assert!(lower < low && high < higher && profile.limits[0] < profile.limits[1]);
    assert_eq!(profile.parameter, Parameter::K);
    // With two parameters on clean data the interval is nearly the symmetric one.
    let half = 0.5 * (high - low) / error.expect("k is determined");
    assert!((0.8..1.25).contains(&half), "{half}");
    assert!(profile.points.iter().all(|[_, gain]| *gain >= -1e-9 * fit.report.statistics.rss));
    harness.get_by_label_contains("k, 95 %: ");
    // Another fit has another profile.
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    assert!(explorer(&mut harness).work.diagnostics().profile.is_none());
}

#[test]
fn a_bootstrap_stands_beside_the_standard_errors() {
    let mut harness = fitted();
    harness.get_by_label("Bootstrap").click_accesskit();
    harness.step();
    wait(&mut harness);
    let fit = explorer(&mut harness).work.shown_fit().cloned().expect("a fit");
    let scatter = &explorer(&mut harness).work.diagnostics().scatter.as_ref().expect("a bootstrap");
    assert_eq!((scatter.replicates, scatter.asked), (200, 200));
    assert_eq!(scatter.estimates.len(), 2);
    for scatter in &scatter.estimates {
        let estimate = fit.report.estimates.iter().find(|estimate| estimate.parameter == scatter.parameter).expect("an estimate");
        let ratio = scatter.std_error / estimate.std_error.expect("determined");
        // 200 data sets know their own scatter to 5 %, and 27 residuals theirs to 15 %.
        assert!((0.6..1.6).contains(&ratio), "{ratio}");
    }
    harness.get_by_label("± boot");
    harness.get_by_label("200 data sets fitted, each from several starts");
}

#[test]
fn a_scan_is_stopped_and_one_of_another_fit_is_dropped() {
    let mut harness = fitted();
    explorer(&mut harness).work.apply(Edit::SetReplicates(100_000));
    harness.get_by_label("Bootstrap").click_accesskit();
    harness.step();
    harness.step();
    harness.get_by_label("Stop the scan").click_accesskit();
    harness.step();
    wait(&mut harness);
    let stopped = explorer(&mut harness).work.diagnostics().scatter.as_ref().expect("what was there is kept");
    assert!(stopped.replicates < stopped.asked && stopped.asked == 100_000, "{}", stopped.replicates);
    explorer(&mut harness).actions.push(Action::Bootstrap);
    harness.step();
    let rows = (*explorer(&mut harness).work.active().measurement).clone();
    take(explorer(&mut harness), "another".to_owned(), rows);
    wait(&mut harness);
    assert!(explorer(&mut harness).work.diagnostics().scatter.is_none());
}
