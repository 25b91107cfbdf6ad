//! Work is never lost: at the next start, with a file, beside another window, after a crash, under a
//! session that is opened.

use crate::app::shell::app::App;
use crate::app::shell::app::autosave::{keep_work, save_on_exit, work_title};
use crate::app::shell::app::title::title;
use crate::app::shell::commands;
use crate::app::shell::commands::Menu;
use crate::app::storage::export::ExportKind;
use crate::app::storage::kept_work::{KeptWork, WorkFolder};
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use egui_kittest::Harness;
use std::path::{Path, PathBuf};

type Window = Harness<'static, Option<App>>;

/// A window of a machine whose earlier work lies in that folder.
fn start(folder: &Path, with_files: bool) -> Window {
    let mut window = harness();
    keep_work(explorer(&mut window), WorkFolder::new(folder.join("work")), with_files);
    wait(&mut window);
    window
}

fn order(window: &mut Window, action: Action) {
    explorer(window).actions.push(action);
    wait(window);
}

/// The user closes it.
fn close(mut window: Window) {
    save_on_exit(explorer(&mut window));
}

fn names(window: &mut Window) -> Vec<String> {
    explorer(window).work.measurements().iter().map(|open| open.name.clone()).collect()
}

/// The measurements of what *File › Recent* offers of earlier runs.
fn recent(window: &mut Window) -> Vec<Vec<String>> {
    let app = explorer(window);
    let offered = commands::items(app).into_iter().filter(|item| item.menu == Menu::Recent && item.text.starts_with("Work of 20"));
    assert_eq!(offered.count(), app.persistence.kept.len());
    app.persistence.kept.iter().map(|work| work.names.clone()).collect()
}

fn file(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, "theta_i,theta_r,dolp\n30,10,0.1\n30,20,0.2\n").expect("a file");
    path
}

#[test]
fn work_whose_names_are_not_known_is_called_by_its_time() {
    let of = |names: &[&str]| {
        let names = names.iter().map(|&name| name.to_owned()).collect();
        work_title(&KeptWork { path: PathBuf::new(), changed: std::time::SystemTime::UNIX_EPOCH, names, fits: 0 })
    };
    assert!(of(&["a.csv", "b.csv"]).ends_with(": a.csv, b.csv"));
    assert!(of(&[]).ends_with(|last: char| last.is_ascii_digit()), "{}", of(&[]));
}

#[test]
fn a_start_with_a_file_keeps_the_work_of_before_and_gives_it_back() {
    let place = tempfile::tempdir().expect("a folder");
    let mut yesterday = start(place.path(), false);
    order(&mut yesterday, Action::OpenExample(1));
    edit(&mut yesterday, Edit::Mask { rows: vec![3, 5], masked: true });
    order(&mut yesterday, Action::StartFit);
    let (work, values) = (names(&mut yesterday), explorer(&mut yesterday).work.values());
    close(yesterday);

    let mut today = start(place.path(), true);
    order(&mut today, Action::OpenMeasurements(vec![file(place.path(), "other.csv")]));
    assert_eq!(names(&mut today), ["other.csv"]);
    assert_eq!(recent(&mut today), std::slice::from_ref(&work));
    let said = explorer(&mut today).toasts.take().expect("where it is");
    assert!(said.contains("File › Recent › Work of 20"), "{said}");
    let kept = explorer(&mut today).persistence.kept[0].path.clone();
    order(&mut today, Action::OpenSession(kept));
    assert_eq!((names(&mut today), explorer(&mut today).work.values()), (work, values));
    assert_eq!(explorer(&mut today).work.fit_history().len(), 1);
    assert_eq!(explorer(&mut today).work.session_file(), None);
    assert!(recent(&mut today).contains(&vec!["other.csv".to_owned()]), "what was open before is kept in its turn");
    assert!(explorer(&mut today).window.recent.iter().all(|path| !path.starts_with(place.path().join("work"))));
}

#[test]
fn two_windows_have_two_states() {
    let place = tempfile::tempdir().expect("a folder");
    let mut one = start(place.path(), false);
    order(&mut one, Action::OpenExample(1));
    let mut other = start(place.path(), false);
    assert!(recent(&mut other).is_empty(), "what another window shows is its own");
    order(&mut other, Action::OpenExample(2));
    let (of_one, of_other) = (names(&mut one), names(&mut other));
    assert_ne!(of_one, of_other);
    close(other);
    close(one);
    let mut next = start(place.path(), false);
    assert_eq!(names(&mut next), of_one, "the one that was closed last");
    assert_eq!(recent(&mut next), [of_one, of_other]);
}

#[test]
fn a_crash_loses_no_more_than_a_moment() {
    let place = tempfile::tempdir().expect("a folder");
    let mut crashed = start(place.path(), false);
    order(&mut crashed, Action::OpenExample(1));
    explorer(&mut crashed).persistence.autosave_dirty_since = std::time::Instant::now().checked_sub(std::time::Duration::from_secs(60));
    wait(&mut crashed);
    let work = names(&mut crashed);
    drop(crashed);
    let mut next = start(place.path(), false);
    assert_eq!(names(&mut next), work);
}

#[test]
fn a_session_that_is_opened_discards_nothing() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path().join("steel.pbrdf.json");
    let mut window = start(place.path(), false);
    order(&mut window, Action::Export(ExportKind::Session, path.clone()));
    order(&mut window, Action::OpenExample(1));
    let work = names(&mut window);
    order(&mut window, Action::OpenSession(path.clone()));
    assert_ne!(names(&mut window), work);
    assert_eq!(recent(&mut window), [work]);
    close(window);
    // The session and its mark come back.
    let mut next = start(place.path(), false);
    assert_eq!(explorer(&mut next).work.session_file(), Some(path.as_path()));
    assert_eq!(title(explorer(&mut next)), "steel – pBRDF explorer");
    explorer(&mut next).work.surface_mut().parameters.k = 4.25;
    close(next);
    let mut third = start(place.path(), false);
    assert_eq!(title(explorer(&mut third)), "*steel – pBRDF explorer");
}

#[test]
fn the_work_under_a_lesson_is_kept_where_the_lesson_takes_its_place() {
    let place = tempfile::tempdir().expect("a folder");
    let mut window = start(place.path(), false);
    order(&mut window, Action::OpenExample(1));
    let work = names(&mut window);
    order(&mut window, Action::ShowStep(0, 0));
    order(&mut window, Action::KeepLesson);
    assert_eq!(recent(&mut window), [work]);
}

#[test]
fn a_window_that_nothing_was_done_in_leaves_nothing() {
    let place = tempfile::tempdir().expect("a folder");
    close(start(place.path(), false));
    let mut next = start(place.path(), false);
    assert!(recent(&mut next).is_empty());
    // What was gone on with and not touched stays as it is.
    order(&mut next, Action::OpenExample(1));
    close(next);
    close(start(place.path(), false));
    assert_eq!(recent(&mut start(place.path(), false)).len(), 1);
}
