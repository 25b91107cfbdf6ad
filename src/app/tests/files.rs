//! Opening files, good and bad, and the settings file.

use crate::app::storage::settings_file;
use crate::app::storage::settings_file::{SavedSettings, SettingsFile};
use crate::app::tests::{explorer, harness, harness_of, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::layout::Layout;
use crate::app::work::open_measurement::EXAMPLES;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::{Settings, Theme, WindowSettings};
use crate::app::work::surface::Surface;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::{Parameter, Parameters};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Debug)]
pub struct Dropped(pub PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn file(folder: &tempfile::TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("a writable folder for temporary files");
    path
}

#[test]
fn a_folder_opens_as_a_series_in_the_order_of_its_numbers() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    for (name, text) in
        [("1000 nm.csv", "theta_i,theta_r,dolp\n35,20,0.5\n"), ("450 nm.csv", "theta_i,theta_r,dolp\n35,20,0.4\n"), ("notes.md", "x")]
    {
        file(&folder, name, text);
    }
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::OpenMeasurements(vec![folder.path().to_owned()]));
    wait(&mut harness);
    let names = |harness: &mut egui_kittest::Harness<'static, Option<crate::app::shell::app::App>>| -> Vec<String> {
        explorer(harness).work.measurements().iter().map(|open| open.name.clone()).collect()
    };
    assert_eq!(names(&mut harness), ["450 nm.csv", "1000 nm.csv"]);
    let empty = tempfile::tempdir().expect("a folder");
    explorer(&mut harness).actions.push(Action::OpenMeasurements(vec![empty.path().to_owned()]));
    wait(&mut harness);
    let said = explorer(&mut harness).toasts.take().expect("a sentence");
    assert!(said.contains("no measurement in this folder"), "{said}");
    assert_eq!(names(&mut harness).len(), 2);
}

#[test]
fn a_dropped_file_is_opened() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = file(&folder, "mine.csv", "theta_i,theta_r,brdf\n35,20,0.5\n35,-20,0.25\n");
    let mut harness = harness();
    harness.input_mut().dropped_files.push(Arc::new(Dropped(path)));
    harness.step();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    assert_eq!((explorer.work.active().name.as_str(), explorer.work.active().measurement.rows.len()), ("mine.csv", 2));
    assert_eq!(explorer.work.settings().theta_i, 35.0);
    assert!(!explorer.work.surface().locked.contains(Parameter::Ks), "a BRDF can determine k_s");
    assert!(explorer.work.active().has_backscatter());
}

#[test]
fn a_bad_file_says_why_and_leaves_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = file(&folder, "bad.csv", "theta_i,theta_r,dolp\n30,20,0.1\n30,25,abc\n");
    let mut harness = harness();
    let rows = explorer(&mut harness).work.active().measurement.rows.clone();
    for (command, expected) in [
        (Action::OpenMeasurements(vec![path]), "line 3, column 3 (dolp)"),
        // All that there is in the folder.
        (Action::OpenMeasurements(vec![folder.path().to_owned()]), "line 3, column 3 (dolp)"),
        (Action::OpenMeasurements(vec![folder.path().join("none.csv")]), "no such file"),
    ] {
        explorer(&mut harness).actions.push(command);
        wait(&mut harness);
        let explorer = explorer(&mut harness);
        let notice = explorer.toasts.text().expect("a notice");
        assert!(notice.contains(expected), "{notice}");
        assert_eq!(explorer.work.active().measurement.rows, rows);
    }
    while explorer(&mut harness).toasts.text().is_some() {
        harness.query_all_by_label("Dismiss").next().expect("a button for each").click();
        harness.run();
    }
    assert_eq!(explorer(&mut harness).toasts.text(), None);
}

#[test]
fn a_path_can_be_typed_into_the_menu_after_a_click() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = file(&folder, "typed.csv", "theta_i,theta_r,dolp\n30,20,0.1\n30,40,0.2\n");
    let mut harness = harness();
    harness.get_by_label("File").click();
    harness.run_steps(8);
    let label = "Type a path to open and press Enter:";
    let field = harness.get_by_role_and_label(egui::accesskit::Role::TextInput, label).rect().center();
    harness.hover_at(field);
    harness.run_steps(8);
    harness.drag_at(field);
    harness.run_steps(8);
    harness.drop_at(field);
    harness.run_steps(8);
    harness.get_by_role_and_label(egui::accesskit::Role::TextInput, label).type_text(&path.display().to_string());
    harness.run_steps(8);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(8);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.active().name, "typed.csv");
}

#[test]
fn every_example_opens_and_says_that_it_is_simulated() {
    let mut harness = harness();
    for (index, example) in EXAMPLES.iter().enumerate() {
        explorer(&mut harness).actions.push(Action::OpenExample(index));
        wait(&mut harness);
        let explorer = explorer(&mut harness);
        assert_eq!((explorer.work.active().name.as_str(), explorer.toasts.text()), (example.name, None));
        assert!(explorer.work.active().description().contains("simulated"));
        assert!(explorer.derived.delta_e().is_some());
    }
}

#[test]
fn a_second_notice_does_not_hide_the_first() {
    let mut harness = harness();
    explorer(&mut harness).toasts.error("first".to_owned());
    explorer(&mut harness).toasts.error("second".to_owned());
    assert_eq!(explorer(&mut harness).toasts.text().as_deref(), Some("first\nsecond"));
}

#[test]
fn lobes_over_many_decades_are_shown_on_a_logarithmic_axis() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = file(&folder, "peak.csv", "theta_i,theta_r,brdf\n35,35,5000\n35,-20,0.25\n");
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::OpenMeasurements(vec![path]));
    wait(&mut harness);
    assert!(explorer(&mut harness).work.settings().log_brdf);
}

#[test]
fn settings_survive_a_restart() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("new").join("settings.json");
    let surface = Surface { parameters: Parameters { n: 0.3, q: 41.5, ..Parameters::default() }, ..Surface::default() };
    let settings = SavedSettings { settings: Settings { log_brdf: true, ..Settings::default() }, surface };
    let mut window = WindowSettings { theme: Theme::Dark, ..WindowSettings::default() };
    window.remember(&path);
    let settings = SettingsFile { settings, layout: Layout::Pane(PaneId::Dolp), window };
    settings_file::save(&path, &settings).expect("a writable folder");
    assert_eq!(settings_file::load_from(&path), (settings, None));
}

#[test]
fn sliders_that_are_no_surface_survive_a_restart_too() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("settings.json");
    let surface = Surface { parameters: Parameters { n: 0.0, k: 0.0, ..Parameters::default() }, ..Surface::default() };
    let settings = SavedSettings { surface, ..SavedSettings::default() };
    let settings = SettingsFile { settings, ..SettingsFile::default() };
    settings_file::save(&path, &settings).expect("a writable folder");
    assert_eq!(settings_file::load_from(&path), (settings, None));
}

#[test]
fn damaged_settings_are_set_aside() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    for (damage, place) in [
        ("", "line 1"),
        ("{", "line 1"),
        ("{\"settings\": {\"theta_i\": \"x\"}}", "line 1 column 28"),
        ("{\"settings\": {\"theta_i\": 95}}", "settings.theta_i"),
        ("{\"settings\": {\"parameters\": {\"q\": 0.5}}}", "parameters"),
        ("{\"window\": {\"size\": [0, 0]}}", "window.size"),
        ("\u{0}\u{1}", "line 1"),
    ] {
        let path = file(&folder, "settings.json", damage);
        let (settings, notice) = settings_file::load_from(&path);
        assert_eq!(settings, SettingsFile::default());
        let notice = notice.expect("a notice");
        assert!(notice.contains("damaged") && notice.contains(place), "{damage:?}: {notice}");
        assert!(!path.exists());
        assert_eq!(std::fs::read_to_string(folder.path().join("settings.damaged.json")).expect("what was damaged is kept"), damage);
    }
}

#[test]
fn the_window_fits_its_contents_in_both_themes() {
    for theme in [Theme::Light, Theme::Dark] {
        let settings = Settings { log_brdf: true, show_backscatter: true, ..Settings::default() };
        let mut harness =
            harness_of(SettingsFile { settings: SavedSettings { settings, ..SavedSettings::default() }, ..SettingsFile::default() });
        explorer(&mut harness).actions.push(Action::Window(WindowAction::SetTheme(theme)));
        harness.run();
        assert!(explorer(&mut harness).derived.fault().is_none());
    }
}
