//! The reports in the window: made in the background, shown, exported, and cases of the gallery
//! taken to the sliders.

use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tasks::benchmarks::{BenchmarkId, BenchmarkResult};
use crate::app::tests::{PATIENCE, explorer, harness, wait};
use crate::app::views::action::Action;
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::selftest::{Host, Setting};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// A report stopped after so many looks at whether to stop, which is early enough for a test.
fn part(subject: BenchmarkId, looks: usize) -> BenchmarkResult {
    let seen = AtomicUsize::new(0);
    let time = AtomicUsize::new(0);
    // A clock that is always a long repetition later.
    #[expect(clippy::cast_precision_loss, reason = "a handful of looks at the clock")]
    let clock = || 10.0 * time.fetch_add(1, Ordering::Relaxed) as f64;
    let cancelled = || seen.fetch_add(1, Ordering::Relaxed) >= looks;
    subject.run(Host { clock: &clock, cancelled: &cancelled, progress: &|_| {} })
}

/// The pane that shows a benchmark.
fn pane_of(id: BenchmarkId) -> PaneId {
    match id {
        BenchmarkId::ErrorVsTime => PaneId::ErrorVsTime,
        BenchmarkId::Stability => PaneId::Stability,
        BenchmarkId::Cost => PaneId::Cost,
    }
}

/// The window with that pane in front and a part of its report in it.
fn with_report(subject: BenchmarkId, looks: usize) -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).dock.show(pane_of(subject));
    let result = Box::new(part(subject, looks));
    explorer(&mut harness).benchmarks.take(*result, true);
    wait(&mut harness);
    harness
}

#[test]
fn a_click_on_a_stability_case_sets_the_sliders_and_undo_brings_them_back() {
    let mut harness = with_report(BenchmarkId::Stability, 0);
    let before = explorer(&mut harness).work.values();
    let row = explorer(&mut harness).benchmarks.stability.as_ref().expect("a report").report.rows[2].clone();
    let Setting::Evaluation { model, parameters, geometry } = row.setting else { panic!("evaluations come first") };
    harness.get_by_label(&row.case.to_string()).click();
    wait(&mut harness);
    let (settings, surface) = explorer(&mut harness).work.values();
    assert_eq!((surface.model, surface.parameters), (model, parameters));
    assert_eq!((settings.theta_i, settings.dphi), (geometry.theta_i().0, geometry.dphi().0));
    assert_ne!((settings, surface), before);
    explorer(&mut harness).actions.push(Action::Undo);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.values(), before);
}

#[test]
fn a_fit_of_the_gallery_opens_its_data_with_the_sliders_where_it_begins() {
    // Two fits are made.
    let mut harness = with_report(BenchmarkId::Stability, 2);
    let rows = &explorer(&mut harness).benchmarks.stability.as_ref().expect("a report").report.rows;
    let index = rows.iter().position(|row| row.brdf_error.is_none()).expect("a fit");
    let Setting::Fit { start, measurement, .. } = rows[index].setting.clone() else { panic!("a fit") };
    explorer(&mut harness).actions.push(Action::UseCase(index));
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.work.surface().parameters, start);
    assert_eq!(explorer.work.active().measurement.rows, measurement.rows);
    assert!(explorer.benchmarks.stability.is_some(), "the gallery stays");
}

#[test]
fn every_case_of_the_gallery_can_be_drawn() {
    let mut harness = with_report(BenchmarkId::Stability, 0);
    let count = explorer(&mut harness).benchmarks.stability.as_ref().expect("a report").report.rows.len();
    for index in 0..count {
        explorer(&mut harness).actions.push(Action::UseCase(index));
        wait(&mut harness);
        // Some stand outside the sliders' ranges and none outside the domain.
        assert_eq!(explorer(&mut harness).derived.fault(), None);
    }
}

#[test]
fn a_report_is_measured_in_the_background_and_can_be_stopped() {
    let mut harness = harness();
    explorer(&mut harness).dock.show(pane_of(BenchmarkId::Cost));
    wait(&mut harness);
    harness.get_by_label("Nothing is measured yet.");
    harness.get_by_label("Measure costs").click();
    harness.step();
    harness.step();
    assert!(explorer(&mut harness).jobs.benchmarks.progress().is_some());
    harness.get_by_label("Stop measuring").click();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    let shown = explorer.benchmarks.cost.as_ref().expect("what was measured so far");
    assert!(shown.is_part && shown.report.rows.len() < 19 && explorer.benchmarks.stability.is_none());
    harness.get_by_label_contains("stopped before its end");
}

#[test]
fn a_second_report_waits_for_the_first_and_can_be_called_off() {
    let mut harness = harness();
    let made = |harness: &mut Harness<'static, Option<App>>| explorer(harness).jobs.benchmarks.progress().map(|(subject, _)| subject);
    explorer(&mut harness).actions.push(Action::RunBenchmark(BenchmarkId::Cost));
    explorer(&mut harness).dock.show(PaneId::Stability);
    harness.step();
    harness.step();
    harness.get_by_label("Run all cases").click();
    for _ in 0..3 {
        harness.step();
    }
    // Side by side they would disturb each other.
    assert_eq!(made(&mut harness), Some(BenchmarkId::Cost));
    harness.get_by_label_contains("Comes after the report that is being made");
    explorer(&mut harness).actions.push(Action::CancelBenchmark);
    let begun = Instant::now();
    while made(&mut harness) != Some(BenchmarkId::Stability) {
        assert!(begun.elapsed() < PATIENCE, "the second report does not begin");
        harness.step();
    }
    // Another one behind it is called off.
    explorer(&mut harness).dock.show(PaneId::ErrorVsTime);
    explorer(&mut harness).actions.push(Action::RunBenchmark(BenchmarkId::ErrorVsTime));
    for _ in 0..3 {
        harness.step();
    }
    harness.get_by_label("Do not wait").click();
    for _ in 0..3 {
        harness.step();
    }
    explorer(&mut harness).actions.push(Action::CancelBenchmark);
    wait(&mut harness);
    let reports = &explorer(&mut harness).benchmarks;
    assert!(reports.cost.is_some() && reports.stability.is_some() && reports.error_vs_time.is_none());
}

#[test]
fn costs_are_a_table_with_bars() {
    let mut harness = with_report(BenchmarkId::Cost, 3);
    let rows = explorer(&mut harness).benchmarks.cost.as_ref().expect("a report").report.rows.clone();
    assert_eq!(rows.len(), 3);
    for row in &rows {
        harness.get_by_label(row.scene);
    }
    harness.get_by_label("left out");
}

#[test]
fn errors_against_time_are_a_table_and_diagrams() {
    let mut harness = with_report(BenchmarkId::ErrorVsTime, 5);
    harness.get_by_label("batch kernel, prepared scene");
    for page in ["Evaluation", "Along one fit", "Performance profile", "Ladder", "Along the ladder"] {
        harness.get_by_label(page).click();
        harness.run();
    }
    assert!(harness.query_by_label("worst error").is_none());
    harness.get_by_label("Table").click();
    harness.run();
    harness.get_by_label("worst error");
}

#[test]
fn the_figure_in_front_is_the_one_that_is_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = with_report(BenchmarkId::ErrorVsTime, 5);
    let title = |harness: &mut Harness<'static, Option<App>>| {
        explorer(harness).figure(pane_of(BenchmarkId::ErrorVsTime)).map(|figure| figure.title)
    };
    let first = title(&mut harness).expect("a figure");
    harness.get_by_label("Performance profile").click();
    harness.run();
    assert_ne!(title(&mut harness), Some(first));
    let path = folder.path().join("profile.svg");
    explorer(&mut harness).actions.push(Action::Export(ExportKind::Plot(pane_of(BenchmarkId::ErrorVsTime)), path.clone()));
    wait(&mut harness);
    assert!(path.exists());
}
