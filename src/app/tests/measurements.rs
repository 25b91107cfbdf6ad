//! Several measurements: opened beside each other, closed, brought back, each with its own work.

use crate::app::shell::app::App;
use crate::app::tests::files::Dropped;
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use egui_kittest::Harness;
use pbrdf::fit::Starts;
use std::path::PathBuf;
use std::sync::Arc;

pub type Window = Harness<'static, Option<App>>;

const STEEL: &str = "45# steel (simulated)";
const BARE: &str = "theta_i,theta_r,dolp\n30,20,0.1\n30,40,0.2\n40,40,0.3\n";

pub fn order(harness: &mut Window, action: Action) {
    explorer(harness).actions.push(action);
    wait(harness);
}

/// Files of these names in a folder.
pub fn files<const N: usize>(folder: &tempfile::TempDir, contents: [(&str, &str); N]) -> Vec<PathBuf> {
    let paths = contents.map(|(name, text)| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a writable folder");
        path
    });
    paths.to_vec()
}

/// The window with three measurements open, the first of them active.
pub fn three() -> (Window, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = files(&folder, [("450.csv", BARE), ("550.csv", BARE), ("650.csv", BARE)]);
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    order(&mut harness, Action::OpenMeasurements(paths));
    (harness, folder)
}

fn names(harness: &mut Window) -> Vec<String> {
    explorer(harness).work.measurements().iter().map(|open| open.name.clone()).collect()
}

pub fn active(harness: &mut Window) -> String {
    explorer(harness).work.active().name.clone()
}

pub fn number_of(harness: &mut Window, name: &str) -> u64 {
    let open = explorer(harness).work.measurements().iter().find(|open| open.name == name).expect("an open measurement");
    open.number
}

pub fn activate(harness: &mut Window, name: &str) {
    let number = number_of(harness, name);
    edit(harness, Edit::Activate(number));
}

#[test]
fn several_files_open_in_one_step_and_one_that_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = files(&folder, [("a.csv", BARE), ("bad.csv", "theta_i,theta_r,dolp\n30,20,abc\n"), ("b.csv", BARE)]);
    let mut harness = harness();
    for path in &paths {
        harness.input_mut().dropped_files.push(Arc::new(Dropped(path.clone())));
    }
    harness.step();
    wait(&mut harness);
    assert_eq!((names(&mut harness), active(&mut harness).as_str()), (vec!["a.csv".to_owned(), "b.csv".to_owned()], "a.csv"));
    let notice = explorer(&mut harness).toasts.take().expect("a sentence");
    assert!(notice.contains("bad.csv") && notice.contains("line 2") && !notice.contains("b.csv:"), "{notice}");
    order(&mut harness, Action::Undo);
    assert_eq!(names(&mut harness), [STEEL]);
    order(&mut harness, Action::Redo);
    assert_eq!(names(&mut harness), ["a.csv", "b.csv"]);
}

#[test]
fn a_measurement_that_was_worked_on_stays_beside_the_next_and_so_does_its_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = files(&folder, [("a.csv", BARE)]);
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    edit(&mut harness, Edit::Mask { rows: vec![4], masked: true });
    order(&mut harness, Action::StartFit);
    let fitted = explorer(&mut harness).work.surface().clone();
    order(&mut harness, Action::OpenMeasurements(paths.clone()));
    order(&mut harness, Action::OpenMeasurements(paths));
    assert_eq!(names(&mut harness), [STEEL, "a.csv", "a.csv (2)"]);
    edit(&mut harness, Edit::Mask { rows: vec![0], masked: true });
    explorer(&mut harness).work.surface_mut().parameters.n = 0.5;
    harness.run();
    assert!(explorer(&mut harness).work.shown_fit().is_none());
    activate(&mut harness, STEEL);
    let work = &explorer(&mut harness).work;
    assert_eq!((work.active().mask()[..].to_vec(), work.surface()), (vec![4], &fitted));
    assert_eq!(work.shown_fit().map(|fit| fit.id), Some(1));
    activate(&mut harness, "a.csv");
    let work = &explorer(&mut harness).work;
    assert!(work.active().mask().is_empty() && work.surface().parameters.n == fitted.parameters.n);
}

#[test]
fn a_step_of_undo_leads_back_to_the_measurement_that_it_was_made_on() {
    let (mut harness, _folder) = three();
    edit(&mut harness, Edit::Mask { rows: vec![1], masked: true });
    activate(&mut harness, "650.csv");
    edit(&mut harness, Edit::Mask { rows: vec![2], masked: true });
    activate(&mut harness, "550.csv");
    order(&mut harness, Action::Undo);
    assert_eq!(active(&mut harness), "650.csv");
    assert!(explorer(&mut harness).work.active().mask().is_empty());
    order(&mut harness, Action::Undo);
    assert!(explorer(&mut harness).work.measurements().iter().all(|open| open.mask().is_empty()));
}

#[test]
fn closing_is_undone_with_masks_and_fit() {
    let (mut harness, _folder) = three();
    edit(&mut harness, Edit::Mask { rows: vec![1], masked: true });
    order(&mut harness, Action::StartFit);
    let number = number_of(&mut harness, "450.csv");
    edit(&mut harness, Edit::Close(number));
    assert_eq!((names(&mut harness), active(&mut harness).as_str()), (vec!["550.csv".to_owned(), "650.csv".to_owned()], "550.csv"));
    assert!(explorer(&mut harness).work.shown_fit().is_none());
    order(&mut harness, Action::Undo);
    assert_eq!((names(&mut harness).len(), active(&mut harness).as_str()), (3, "450.csv"));
    let work = &explorer(&mut harness).work;
    assert_eq!((work.active().mask()[..].to_vec(), work.shown_fit().map(|fit| fit.id)), (vec![1], Some(1)));
    for name in ["450.csv", "550.csv", "650.csv"] {
        let number = number_of(&mut harness, name);
        edit(&mut harness, Edit::Close(number));
    }
    assert_eq!(names(&mut harness), [""], "sliders without a measurement");
    for _ in 0..3 {
        order(&mut harness, Action::Undo);
    }
    assert_eq!(names(&mut harness).len(), 3);
}

#[test]
fn a_fit_reaches_its_own_measurement_whichever_is_active_when_it_ends() {
    let (mut harness, _folder) = three();
    explorer(&mut harness).actions.push(Action::StartFit);
    harness.step();
    let number = number_of(&mut harness, "650.csv");
    explorer(&mut harness).work.apply(Edit::Activate(number));
    wait(&mut harness);
    let before = explorer(&mut harness).work.surface().parameters;
    assert!(explorer(&mut harness).work.shown_fit().is_none());
    activate(&mut harness, "450.csv");
    let work = &explorer(&mut harness).work;
    let fit = work.shown_fit().expect("the fit");
    assert_eq!((fit.document.as_str(), work.surface().parameters), ("450.csv", fit.report.parameters));
    assert_ne!(before, fit.report.parameters);
}

#[test]
fn a_click_in_the_history_brings_back_the_measurement_of_the_fit() {
    let (mut harness, _folder) = three();
    edit(&mut harness, Edit::Mask { rows: vec![2], masked: true });
    order(&mut harness, Action::StartFit);
    let first = explorer(&mut harness).work.shown_fit().expect("a fit").report.parameters;
    activate(&mut harness, "650.csv");
    order(&mut harness, Action::StartFit);
    order(&mut harness, Action::ReturnToFit(1));
    assert_eq!((active(&mut harness).as_str(), explorer(&mut harness).work.surface().parameters), ("450.csv", first));
    let number = number_of(&mut harness, "450.csv");
    edit(&mut harness, Edit::Close(number));
    order(&mut harness, Action::ReturnToFit(1));
    let work = &explorer(&mut harness).work;
    assert_eq!((work.active().name.as_str(), work.active().mask()[..].to_vec()), ("450.csv", vec![2]));
    assert_eq!((work.surface().parameters, work.measurements().iter().count()), (first, 3));
    assert!(work.shown_fit().is_some_and(|fit| fit.generation == work.active().generation), "its mask is that of the fit");
}

#[test]
fn foreign_files_ask_one_after_the_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let table = "AOI;View;DoLP %\n30;20;10\n30;40;12\n";
    let paths = files(&folder, [("one.csv", table), ("mine.csv", BARE), ("two.csv", table), ("three.csv", table)]);
    let mut harness = harness();
    order(&mut harness, Action::OpenMeasurements(paths));
    assert_eq!(names(&mut harness), ["mine.csv"]);
    let asked = |harness: &mut Window| explorer(harness).dialogs.import.as_ref().map(|import| import.origin.name.clone());
    assert_eq!(asked(&mut harness).as_deref(), Some("one.csv"));
    explorer(&mut harness).dialogs.import.as_mut().expect("a question").alike.are_meant = false;
    order(&mut harness, Action::Import);
    assert_eq!(asked(&mut harness).as_deref(), Some("two.csv"));
    order(&mut harness, Action::CancelImport);
    order(&mut harness, Action::Import);
    assert_eq!(asked(&mut harness), None);
    assert_eq!(names(&mut harness), ["mine.csv", "one.csv", "three.csv"]);
}

#[test]
fn a_table_with_several_samples_opens_as_several_measurements() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = files(&folder, [("lab.csv", "set,theta_i,theta_r,dolp\nred,30,20,0.1\nblue,30,20,0.2\nred,30,40,0.1\n")]);
    let mut harness = harness();
    order(&mut harness, Action::OpenMeasurements(paths));
    let rows: Vec<usize> = explorer(&mut harness).work.measurements().iter().map(|open| open.measurement.rows.len()).collect();
    assert_eq!((names(&mut harness), rows), (vec!["lab.csv – red".to_owned(), "lab.csv – blue".to_owned()], vec![2, 1]));
    assert_eq!(active(&mut harness), "lab.csv – red");
}

#[test]
fn a_session_keeps_all_measurements_and_the_fit_that_each_shows() {
    let (mut source, folder) = three();
    order(&mut source, Action::StartFit);
    activate(&mut source, "650.csv");
    edit(&mut source, Edit::Mask { rows: vec![0], masked: true });
    order(&mut source, Action::StartFit);
    order(&mut source, Action::StartFit);
    order(&mut source, Action::ReturnToFit(1));
    let path = folder.path().join("work.pbrdf.json");
    order(&mut source, Action::Export(crate::app::storage::export::ExportKind::Session, path.clone()));
    let mut other = harness();
    let [more] = files(&folder, [("more.csv", BARE)]).try_into().expect("a file");
    // Files beside a session come after it, whatever their order.
    order(&mut other, Action::OpenMeasurements(vec![more, path]));
    assert_eq!(names(&mut other), ["450.csv", "550.csv", "650.csv", "more.csv"]);
    for name in ["450.csv", "550.csv", "650.csv"] {
        activate(&mut source, name);
        activate(&mut other, name);
        let shown = |harness: &mut Window| explorer(harness).work.shown_fit().map(|fit| fit.id);
        assert_eq!(shown(&mut other), shown(&mut source), "{name}");
        let (source, other) = (&explorer(&mut source).work, &explorer(&mut other).work);
        assert_eq!((other.surface(), other.active().mask()), (source.surface(), source.active().mask()), "{name}");
    }
}

#[test]
fn the_example_that_the_program_opened_gives_way_also_after_a_restart() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = files(&folder, [("a.csv", BARE)]);
    let path = folder.path().join("work.pbrdf.json");
    let mut first = harness();
    order(&mut first, Action::Export(crate::app::storage::export::ExportKind::Session, path.clone()));
    let mut second = harness();
    order(&mut second, Action::OpenMeasurements(vec![path, paths[0].clone()]));
    assert_eq!(names(&mut second), ["a.csv"]);
    order(&mut second, Action::OpenExample(1));
    order(&mut second, Action::OpenExample(2));
    assert_eq!(names(&mut second).len(), 3, "an example that was asked for stays");
}
