//! Choices of the import dialog: sheet, thousands separator, answers kept for tables of the same shape, other files with the same answers.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::edit::Edit;
use crate::app::work::settings::WindowSettings;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::measurement::Mapping;
use std::path::{Path, PathBuf};

type Window = Harness<'static, Option<App>>;

fn open(harness: &mut Window, paths: Vec<PathBuf>) {
    explorer(harness).actions.push(Action::OpenMeasurements(paths));
    wait(harness);
}

fn folder_of(files: &[(&str, &str)]) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |(name, text): &(&str, &str)| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a writable folder");
        path
    };
    let paths = files.iter().map(write).collect();
    (folder, paths)
}

/// Chooses an item of a list by its name.
fn choose(harness: &mut Window, list: &str, item: &str) {
    harness.get_by_role_and_label(Role::ComboBox, list).click();
    harness.run();
    harness.query_all_by_role_and_label(Role::Button, item).last().expect("an item").click();
    wait(harness);
}

fn press_open(harness: &mut Window) {
    harness.query_all_by_role_and_label(Role::Button, "Open").last().expect("a button").click();
    wait(harness);
}

/// The names of the measurements that are open.
fn names(harness: &mut Window) -> Vec<String> {
    explorer(harness).work.measurements().iter().map(|open| open.name.clone()).collect()
}

fn dolp_of_first_row(harness: &mut Window) -> f64 {
    explorer(harness).work.active().measurement.rows[0].dolp.expect("a DoLP").value
}

/// Reads the percent of a column that is called neither DoLP nor percent.
fn correct(harness: &mut Window) {
    let columns = Mapping::from_text("theta_i=1,theta_r=2,dolp=3:percent").expect("a mapping");
    explorer(harness).dialogs.import.as_mut().expect("a question").options.columns = columns;
    harness.run();
}

#[test]
fn the_sheet_of_a_workbook_is_chosen() {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("core/tests/data/workbooks/steel.xlsx");
    let mut harness = harness();
    open(&mut harness, vec![book]);
    // The first sheet holds words alone.
    assert_eq!(explorer(&mut harness).dialogs.import.as_ref().expect("a question").options.table.sheet.as_deref(), Some("data"));
    harness.get_by_label_contains("as they will be");
    choose(&mut harness, "Sheet", "notes");
    assert!(harness.query_by_label_contains("This cannot be opened yet").is_some());
    assert!(harness.query_all_by_role_and_label(Role::Button, "Open").last().expect("a button").accesskit_node().is_disabled());
    choose(&mut harness, "Sheet", "data");
    press_open(&mut harness);
    assert_eq!(names(&mut harness), ["steel.xlsx"]);
    assert_eq!(explorer(&mut harness).work.active().measurement.rows.len(), 8);
}

#[test]
fn thousands_that_are_separated_are_asked_about_and_read() {
    let brdf = "theta_i;theta_r;brdf\n30;20;87,3\n30;30;1.234\n30;32;540,1\n";
    let (_folder, paths) = folder_of(&[("steel.csv", brdf)]);
    let mut harness = harness();
    open(&mut harness, paths);
    assert!(harness.query_by_label_contains("or choose “.” as what separates thousands").is_some());
    choose(&mut harness, "Thousands", "1.234");
    press_open(&mut harness);
    let rows = &explorer(&mut harness).work.active().measurement.rows;
    assert_eq!(rows.iter().filter_map(|row| Some(row.brdf?.value)).collect::<Vec<_>>(), [87.3, 1234.0, 540.1]);
}

#[test]
fn the_answers_are_offered_for_the_next_table_of_the_same_shape_after_a_restart_too() {
    let (_folder, paths) = folder_of(&[("a.csv", "x,y,z\n30,20,12\n30,40,14\n"), ("b.txt", "x,y,z\n50,20,17\n50,40,18\n")]);
    let mut harness = harness();
    open(&mut harness, paths[..1].to_vec());
    correct(&mut harness);
    press_open(&mut harness);
    let window = serde_json::to_string(&explorer(&mut harness).window).expect("JSON");
    let mut harness = self::harness();
    explorer(&mut harness).window = serde_json::from_str::<WindowSettings>(&window).expect("settings");
    open(&mut harness, paths[1..].to_vec());
    harness.get_by_label("Read as you read a table of this shape before.");
    harness.get_by_label("Back to the guess").click();
    harness.run();
    assert!(harness.query_by_label_contains("This cannot be opened yet").is_some(), "nothing of it is guessed");
    correct(&mut harness);
    press_open(&mut harness);
    assert_eq!(dolp_of_first_row(&mut harness), 0.17);
}

#[test]
fn other_files_of_the_folder_open_with_the_same_answers_where_that_is_asked_for() {
    let files = [
        ("a 9.csv", "x,y,z\n30,20,12\n30,40,14\n"),
        ("a 10.csv", "x,y,z\n40,20,13\n40,40,15\n"),
        ("b.csv", "x,y,z\n50,20,17\n50,40,18\n"),
        ("other.csv", "x,y,z,w\n50,20,17,1\n50,40,18,1\n"),
        ("own.csv", "theta_i,theta_r,dolp\n30,20,0.5\n"),
    ];
    for asked in [false, true] {
        let (_folder, paths) = folder_of(&files);
        let mut harness = harness();
        open(&mut harness, paths[..1].to_vec());
        correct(&mut harness);
        let also = harness.get_by_label("also apply to the other 2 files of this folder");
        if asked {
            also.click();
            harness.run();
        }
        press_open(&mut harness);
        let expected: &[&str] = if asked { &["a 9.csv", "a 10.csv", "b.csv"] } else { &["a 9.csv"] };
        assert_eq!(names(&mut harness), expected);
        if asked {
            let number = crate::app::tests::measurements::number_of(&mut harness, "b.csv");
            explorer(&mut harness).work.apply(Edit::Activate(number));
            assert_eq!(dolp_of_first_row(&mut harness), 0.17);
            assert_eq!(explorer(&mut harness).work.active().measurement.metadata("imported_from"), Some("b.csv"));
        }
    }
}

#[test]
fn the_tour_of_the_first_start_waits_until_a_table_is_answered() {
    let (_folder, paths) = folder_of(&[("a.csv", "AOI,View,DoLP %\n30,20,12\n30,40,14\n"), ("b.csv", "AOI,View,DoLP %\n40,20,12\n")]);
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowTour(0)));
    wait(&mut harness);
    assert!(harness.query_by_label("Skip the tour").is_some());
    open(&mut harness, paths);
    harness.get_by_label("also apply to the other file opened with it");
    assert!(harness.query_by_label("Skip the tour").is_none(), "it would lie over the dialog, and hold the key Enter");
    harness.key_press(egui::Key::Enter);
    wait(&mut harness);
    assert_eq!(names(&mut harness), ["a.csv", "b.csv"]);
    assert!(harness.query_by_label("Skip the tour").is_some());
}

#[test]
fn files_of_one_shape_that_are_opened_together_need_one_answer() {
    let table = |theta_i: u8| format!("AOI,View,DoLP %\n{theta_i},20,12\n{theta_i},40,14\n");
    let tables = [table(30), table(40), table(50)];
    let (_folder, mut paths) = folder_of(&[("a.csv", &tables[0]), ("b.csv", &tables[1]), ("c.csv", &tables[2])]);
    let (_other, others) = folder_of(&[("d.csv", "inc,view,dolp\n30,20,0.1\n30,40,0.2\n")]);
    paths.extend(others);
    let mut harness = harness();
    open(&mut harness, paths);
    harness.get_by_label("also apply to the other 2 files opened with it");
    harness.key_press(egui::Key::Enter);
    wait(&mut harness);
    harness.get_by_label("Import d.csv");
    harness.key_press(egui::Key::Enter);
    wait(&mut harness);
    let mut names = names(&mut harness);
    names.sort();
    assert_eq!(names, ["a.csv", "b.csv", "c.csv", "d.csv"]);
    assert!(explorer(&mut harness).dialogs.import.is_none());
}
