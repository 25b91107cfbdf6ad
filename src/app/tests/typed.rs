//! Paths typed in the menu File, and the question before a file is replaced.

use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::Action;
use crate::app::work::pane_id::PaneId;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use std::path::Path;

type Window = Harness<'static, Option<App>>;

const OPEN: &str = "Type a path to open and press Enter:";
const SAVE: &str = "Save to a path (.csv the measurement, .json the session), Enter:";

/// Types a path into a box of the menu File, and Enter.
fn type_path(harness: &mut Window, label: &str, path: &Path) {
    harness.get_by_label("File").click();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, label).focus();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, label).type_text(&path.display().to_string());
    harness.run();
    harness.key_press(Key::Enter);
    harness.run_steps(6);
    wait(harness);
}

fn press(harness: &mut Window, button: &str) {
    harness.get_by_role_and_label(Role::Button, button).click();
    // The answer, the writing and what it has to say take some frames.
    harness.run_steps(6);
    wait(harness);
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).expect("a file")
}

#[test]
fn a_typed_path_of_a_file_that_is_there_is_asked_about_once() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let mut harness = harness();
    for (name, part) in [("mine.csv", "theta_i"), ("mine.pbrdf.json", "pbrdf-session")] {
        let path = folder.path().join(name);
        std::fs::write(&path, "precious").expect("a writable folder");
        type_path(&mut harness, SAVE, &path);
        assert_eq!(text(&path), "precious");
        harness.get_by_label(&format!("{name} exists. Replace it?"));
        press(&mut harness, "Keep");
        assert_eq!((text(&path).as_str(), explorer(&mut harness).toasts.text()), ("precious", None));
        // The path waits in its box to be changed.
        assert_eq!(explorer(&mut harness).dialogs.path_entry.save, path.display().to_string());
        explorer(&mut harness).dialogs.path_entry.save.clear();
        type_path(&mut harness, SAVE, &path);
        press(&mut harness, "Replace");
        assert!(text(&path).contains(part), "{name}");
        assert!(explorer(&mut harness).toasts.take().expect("a sentence").contains("is saved to"));
        assert_eq!(explorer(&mut harness).dialogs.path_entry.save, "");
        assert!(explorer(&mut harness).dialogs.overwrite.is_none());
    }
}

#[test]
fn enter_and_escape_keep_the_file_that_is_there() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("mine.csv");
    std::fs::write(&path, "precious").expect("a writable folder");
    let mut harness = harness();
    for key in [Key::Enter, Key::Escape] {
        explorer(&mut harness).actions.push(Action::SaveNew(path.clone()));
        wait(&mut harness);
        assert!(explorer(&mut harness).dialogs.overwrite.is_some());
        harness.key_press(key);
        harness.run();
        wait(&mut harness);
        assert!(explorer(&mut harness).dialogs.overwrite.is_none(), "{key:?}");
        assert_eq!(text(&path), "precious");
    }
}

#[test]
fn a_new_file_and_one_that_the_desktop_asked_about_are_written_without_a_question() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let mut harness = harness();
    let new = folder.path().join("new.csv");
    type_path(&mut harness, SAVE, &new);
    assert!(text(&new).contains("theta_i") && explorer(&mut harness).dialogs.path_entry.save.is_empty());
    let chosen = folder.path().join("chosen.csv");
    std::fs::write(&chosen, "old").expect("a writable folder");
    explorer(&mut harness).actions.push(Action::SaveMeasurement(chosen.clone()));
    wait(&mut harness);
    assert!(text(&chosen).contains("theta_i"));
    // A session goes on in its own file.
    let session = folder.path().join("s.pbrdf.json");
    for command in [Action::Export(ExportKind::Session, session.clone()), Action::SaveSession] {
        std::fs::write(&session, "old").expect("a writable folder");
        explorer(&mut harness).actions.push(command);
        wait(&mut harness);
        assert!(explorer(&mut harness).dialogs.overwrite.is_none() && text(&session).contains("pbrdf-session"));
    }
}

#[test]
fn a_typed_export_asks_too_and_keeps_its_path_until_it_has_served() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("curves.csv");
    std::fs::write(&path, "precious").expect("a writable folder");
    let mut harness = harness();
    let export = |harness: &mut Window| {
        harness.get_by_label("File").click();
        harness.run();
        harness.get_by_label_contains("Export").hover();
        harness.run();
        harness.get_by_label_contains("Curves as CSV").click();
        harness.run();
        wait(harness);
    };
    explorer(&mut harness).dialogs.path_entry.export = folder.path().join("curves").display().to_string();
    export(&mut harness);
    assert_eq!(text(&path), "precious");
    press(&mut harness, "Replace");
    assert!(text(&path).contains("theta_i"));
    assert_eq!(explorer(&mut harness).dialogs.path_entry.export, "");
    // Keys ask the desktop, whatever stands in the box.
    explorer(&mut harness).dialogs.path_entry.export = "/somewhere/else.html".to_owned();
    explorer(&mut harness).actions.push(Action::ChooseExport(ExportKind::Curves));
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).toasts.take().expect("a sentence").lines().count(), 1);
    assert_eq!(explorer(&mut harness).dialogs.path_entry.export, "/somewhere/else.html");
}

#[test]
fn a_path_that_could_not_be_opened_stays_to_be_mended() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let mut harness = harness();
    let path = folder.path().join("mine.csv");
    type_path(&mut harness, OPEN, &path);
    assert_eq!(explorer(&mut harness).dialogs.path_entry.open, path.display().to_string());
    assert!(explorer(&mut harness).toasts.take().expect("a sentence").contains("no such file"));
    std::fs::write(&path, "theta_i,theta_r,dolp\n30,20,0.1\n30,40,0.2\n").expect("a writable folder");
    explorer(&mut harness).dialogs.path_entry.open.clear();
    type_path(&mut harness, OPEN, &path);
    assert_eq!(
        (explorer(&mut harness).work.active().name.clone(), explorer(&mut harness).dialogs.path_entry.open.clone()),
        ("mine.csv".to_owned(), String::new())
    );
}

#[test]
fn a_path_that_ends_like_another_kind_of_file_is_refused_before_anything_is_asked_or_written() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    let all = [
        (ExportKind::Curves, "plot.svg", ".csv"),
        (ExportKind::Fitted, "report.html", ".csv"),
        (ExportKind::Session, "mine.csv", ".json"),
        (ExportKind::Report, "mine.csv", ".html or .md"),
        (ExportKind::Plot(PaneId::Dolp), "mine.csv", ".svg or .png"),
    ];
    for (what, name, ending) in all {
        for is_there in [true, false] {
            let path = folder.path().join(name);
            if is_there {
                std::fs::write(&path, "precious").expect("a writable folder");
            } else {
                std::fs::remove_file(&path).expect("a file of our own");
            }
            for command in [Action::ExportNew(what, path.clone()), Action::Export(what, path.clone())] {
                explorer(&mut harness).actions.push(command);
                wait(&mut harness);
                let said = explorer(&mut harness).toasts.take().expect("a sentence");
                assert!(said.contains(&format!("expected a name that ends in {ending}")), "{said}");
                assert!(explorer(&mut harness).dialogs.overwrite.is_none());
                assert_eq!(std::fs::read_to_string(&path).ok().as_deref(), is_there.then_some("precious"));
            }
        }
    }
}
