//! Foreign files: each asks its questions, shows the first rows of its measurement, and leaves the
//! open measurement where it fails.

use crate::app::shell::app::App;
use crate::app::storage::import::bytes_of;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::Action;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::measurement::{Field, Mapping, TensorGrid, TensorResolution, Unit, write_tensor};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;
use std::ops::ControlFlow;
use std::path::PathBuf;

const OWN: &str = "45# steel (simulated)";

/// The window after that file was opened, and its folder.
fn opened(name: &str, contents: &[u8]) -> (Harness<'static, Option<App>>, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join(name);
    std::fs::write(&path, contents).expect("a writable folder for temporary files");
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::OpenMeasurements(vec![path]));
    wait(&mut harness);
    (harness, folder)
}

fn press(harness: &mut Harness<'static, Option<App>>, button: &str) {
    // The question lies above everything else.
    harness.query_all_by_role_and_label(egui::accesskit::Role::Button, button).last().expect("a button").click();
    wait(harness);
}

/// Name and number of rows of what is open, and whether a question is.
fn state(harness: &mut Harness<'static, Option<App>>) -> (String, usize, bool) {
    let explorer = explorer(harness);
    (explorer.work.active().name.clone(), explorer.work.active().measurement.rows.len(), explorer.dialogs.import.is_some())
}

const ELLIPSOMETRY: &str = "sample\nVASEmethod[x]\nnm\n600\t55\t43\t150\t0.01\t0.02\n600\t65\t42\t140\n650\t55\t43.5\t151\n650\t65\t42.5\t141\ndpolE\t650\t55\t1.5\n";

#[test]
fn ellipsometry_asks_for_a_wavelength_and_becomes_specular_dolp() {
    let (mut harness, _folder) = opened("al.dat", ELLIPSOMETRY.as_bytes());
    assert_eq!(state(&mut harness), (OWN.to_owned(), 27, true));
    let import = explorer(&mut harness).dialogs.import.as_mut().expect("a question");
    assert_eq!(import.options.wavelength_nm, Some(650.0));
    import.options.wavelength_nm = Some(600.0);
    harness.run();
    press(&mut harness, "Open");
    assert_eq!(state(&mut harness), ("al.dat".to_owned(), 2, false));
    let explorer = explorer(&mut harness);
    let row = explorer.work.active().measurement.rows[0];
    let expected = 86.0_f64.to_radians();
    assert!((row.dolp.expect("a DoLP").value - libm::cos(expected)).abs() < 1e-12);
    assert_eq!(explorer.work.active().measurement.metadata("imported_from"), Some("al.dat"));
    assert_eq!(explorer.work.active().wavelength_nm(), Some(600.0));
    assert!(explorer.work.active().sha256.is_some() && explorer.window.recent[0].ends_with("al.dat"));
    assert!(explorer.toasts.text().is_some_and(|notice| notice.contains("not applied to DoLP")));
}

#[test]
fn ellipsometry_at_one_wavelength_asks_nothing() {
    let (mut harness, _folder) = opened("au.txt", b"nm\taoi\tPsi\tDelta\n650\t65\t42\t140\n650\t70\t41\t130\n");
    assert_eq!(state(&mut harness), ("au.txt".to_owned(), 2, false));
}

pub(crate) fn tensor() -> Vec<u8> {
    let surface = Pbrdf::new(Model::full(SlopeDistribution::Gauss), Parameters::default()).expect("parameters in the domain");
    let grid = TensorGrid::new(&surface, TensorResolution { phi_d: 3, theta_d: 4, theta_h: 4 });
    let mut bytes = Vec::new();
    write_tensor(&surface, &grid, 546, &mut |_| ControlFlow::Continue(()), &mut bytes).expect("memory takes everything");
    bytes
}

#[test]
fn a_tensor_asks_for_its_slices() {
    let (mut harness, _folder) = opened("mine.pbsdf", &tensor());
    let import = explorer(&mut harness).dialogs.import.as_mut().expect("a question");
    let slices = &mut import.slices;
    (slices.theta_i.from, slices.theta_i.to) = (30.0, 45.0);
    (slices.theta_r.from, slices.theta_r.to, slices.theta_r.step) = (-10.0, 20.0, 10.0);
    assert_eq!((import.options.wavelength_nm, import.options.dphi), (Some(546.0), Some(180.0)));
    import.options.dphi = Some(90.0);
    harness.run();
    // Out of the plane of incidence there is no backscatter side.
    let import = explorer(&mut harness).dialogs.import.as_mut().expect("a question");
    assert_eq!(import.slices.theta_r.from, 0.0);
    press(&mut harness, "Open");
    assert_eq!(state(&mut harness), ("mine.pbsdf".to_owned(), 6, false));
    let explorer = explorer(&mut harness);
    assert!(explorer.work.active().measurement.has_brdf() && explorer.work.active().measurement.has_dolp());
    assert!(explorer.work.active().measurement.rows.iter().all(|row| row.geometry.dphi().0 == 90.0));
}

const TABLE: &str = "Sample;AOI [deg];View (rad);DoLP %;note\nsteel;30;0,5;12,5;a\nsteel;30;0,6;13;b\n";

#[test]
fn a_foreign_table_is_guessed_shown_and_opened() {
    let (mut harness, _folder) = opened("theirs.csv", TABLE.as_bytes());
    assert_eq!(state(&mut harness), (OWN.to_owned(), 27, true));
    harness.get_by_label("The first of 2 rows as they will be:");
    press(&mut harness, "Open");
    assert_eq!(state(&mut harness), ("theirs.csv".to_owned(), 2, false));
    let row = explorer(&mut harness).work.active().measurement.rows[0];
    let (theta_r, dolp) = (row.geometry.theta_r().0, row.dolp.expect("a DoLP").value);
    assert!((theta_r - 0.5_f64.to_degrees()).abs() < 1e-12 && (dolp - 0.125).abs() < 1e-15);
    assert!(explorer(&mut harness).toasts.text().is_some_and(|notice| notice.contains("note")));
}

#[test]
fn columns_without_a_guess_are_named_by_hand() {
    let (mut harness, _folder) = opened("letters.csv", b"a,b,c\n30,20,12\n30,40,14\n");
    assert_eq!(mapping(&mut harness), Mapping::default());
    assert!(harness.query_by_label_contains("This cannot be opened yet: ").is_some());
    assert!(harness.get_by_role_and_label(egui::accesskit::Role::Button, "Open").accesskit_node().is_disabled());
    for (column, meaning) in [("a", "θi, angle of incidence"), ("b", "θr, angle of view"), ("c", "DoLP")] {
        harness.get_by_role_and_label(egui::accesskit::Role::ComboBox, column).click();
        harness.run();
        // The list lies above everything that has the same name.
        harness.query_all_by_role_and_label(egui::accesskit::Role::Button, meaning).last().expect("a meaning").click();
        harness.run();
    }
    assert_eq!(mapping(&mut harness).to_string(), "theta_i=1,theta_r=2,dolp=3");
    assert!(harness.query_by_label_contains("expected").is_some(), "a DoLP of 12 is none");
    harness.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Unit of c").click();
    harness.run();
    harness.get_by_label("percent").click();
    harness.run();
    assert_eq!(mapping(&mut harness).find(Field::Dolp).map(|column| column.unit), Some(Unit::Percent));
    press(&mut harness, "Open");
    assert_eq!(state(&mut harness), ("letters.csv".to_owned(), 2, false));
}

fn mapping(harness: &mut Harness<'static, Option<App>>) -> Mapping {
    explorer(harness).dialogs.import.as_ref().expect("a question").options.columns.clone()
}

#[test]
fn a_table_at_a_single_angle_of_incidence_is_opened_with_a_constant() {
    let (mut harness, _folder) = opened("single.csv", b"view,dolp\n20,0.1\n25,0.2\n");
    assert!(harness.get_by_role_and_label(egui::accesskit::Role::Button, "Open").accesskit_node().is_disabled());
    harness.get_by_role_and_label(egui::accesskit::Role::CheckBox, "θi").click();
    harness.run();
    assert_eq!(mapping(&mut harness).theta_i, Some(45.0));
    press(&mut harness, "Open");
    assert_eq!(state(&mut harness), ("single.csv".to_owned(), 2, false));
    assert_eq!(explorer(&mut harness).work.active().measurement.incidence_angles(), [45.0]);
    // Stated beside the numbers, it is offered.
    let (mut harness, _folder) = opened("stated.csv", b"# angle of incidence: 30 deg\n# by JL\nview,dolp,sd\n20,0.1,0.01\n");
    assert_eq!((mapping(&mut harness).theta_i, mapping(&mut harness).to_string().as_str()), (Some(30.0), "theta_r=1,dolp=2,dolp_sigma=3"));
    press(&mut harness, "Open");
    let measurement = &explorer(&mut harness).work.active().measurement;
    assert_eq!((measurement.incidence_angles(), measurement.metadata("comment")), (vec![30.0], Some("by JL")));
    assert_eq!(measurement.rows[0].dolp.and_then(|dolp| dolp.sigma), Some(0.01));
}

#[test]
fn a_table_without_a_header_offers_numbered_columns() {
    let (mut harness, _folder) = opened("bare.csv", b"30,20,0.1\n30,25,0.2\n");
    let columns = Mapping::from_text("theta_i=1,theta_r=2,dolp=3").expect("a mapping");
    explorer(&mut harness).dialogs.import.as_mut().expect("a question").options.columns = columns;
    harness.run();
    press(&mut harness, "Open");
    assert_eq!(state(&mut harness), ("bare.csv".to_owned(), 2, false));
}

#[test]
fn a_table_without_anything_measured_is_asked_about_with_that_reason() {
    let (harness, _folder) = opened("angles.csv", b"inc,view\n30,20\n");
    assert!(
        harness.query_by_label_contains("cannot be opened yet").is_some() || harness.query_by_label_contains("cannot be read so").is_some()
    );
}

#[test]
fn the_question_stays_where_it_is_and_as_large_as_it_is() {
    let area = |harness: &Harness<'static, Option<App>>| {
        harness.ctx.memory(|memory| memory.area_rect(egui::Id::unique("import"))).expect("a question")
    };
    // Nothing is guessed; then what is chosen fails, with a long sentence; then it succeeds, with
    // rows.
    let (mut harness, _folder) = opened("letters.csv", b"a,b,c,d\n30,20,12,1\n30,40,14,1\n");
    let before = area(&harness);
    for text in [
        "theta_i=1",
        "theta_i=1,theta_r=2,dolp=3,brdf=4",
        "theta_i=1,theta_r=2:radians,dolp=3:percent",
        "theta_i=1,theta_r=2,dolp=3:percent,brdf=4",
    ] {
        explorer(&mut harness).dialogs.import.as_mut().expect("a question").options.columns = Mapping::from_text(text).expect("a mapping");
        harness.run();
        assert_eq!(area(&harness), before, "{text}");
    }
    assert!(harness.query_by_label_contains("as they will be").is_some());
    let (mut harness, _folder) = opened("mine.pbsdf", &tensor());
    let before = area(&harness);
    let import = explorer(&mut harness).dialogs.import.as_mut().expect("a question");
    (import.slices.theta_i.from, import.slices.theta_i.to, import.options.dphi) = (30.0, 30.0, Some(90.0));
    harness.run();
    assert_eq!(area(&harness), before);
    assert!(harness.ctx.content_rect().contains_rect(before));
}

#[test]
fn a_fault_beyond_the_first_rows_keeps_the_question_and_what_is_open() {
    let mut table = String::from("AOI,View,DoLP\n");
    (0..10_000).for_each(|_| table.push_str("30,20,0.125\n"));
    table.push_str("30,20,oops\n");
    let (mut harness, _folder) = opened("long.csv", table.as_bytes());
    harness.get_by_label("The first rows as they will be:");
    press(&mut harness, "Open");
    assert_eq!(state(&mut harness), (OWN.to_owned(), 27, true));
    assert!(harness.query_by_label_contains("line 10002, column 3 (DoLP)").is_some());
    press(&mut harness, "Cancel");
    assert_eq!(state(&mut harness), (OWN.to_owned(), 27, false));
}

#[test]
fn escape_leaves_the_question() {
    let (mut harness, _folder) = opened("theirs.csv", TABLE.as_bytes());
    harness.key_press(egui::Key::Escape);
    wait(&mut harness);
    assert_eq!(state(&mut harness), (OWN.to_owned(), 27, false));
}

#[test]
fn damaged_files_are_refused_with_a_sentence() {
    let mut short = tensor();
    short.truncate(200);
    for (name, contents, part) in [
        ("bad.dat", &b"sample\nVASEmethod[x]\nnm\n600\t95\t43\t150\n"[..], "line 4, column 2 (aoi)"),
        ("bad.pbsdf", &short[..], "the file ends early"),
        ("bad.csv", b"theta_i,theta_r\n30,20\n", "neither dolp nor brdf"),
        ("prose.txt", b"Dear reader, this is a letter.\nYours\n", "theta_i"),
        ("empty.dat", b"", "empty"),
    ] {
        let (mut harness, _folder) = opened(name, contents);
        assert_eq!(state(&mut harness), (OWN.to_owned(), 27, false), "{name}");
        let notice = explorer(&mut harness).toasts.text().expect("a notice");
        assert!(notice.contains(part) && notice.contains(name), "{notice}");
    }
}

#[test]
fn reading_can_be_stopped_in_the_middle_of_a_large_file() {
    let bytes = vec![b'x'; 3 << 20];
    let mut told = Vec::new();
    let error = bytes_of(&bytes[..], Some(3 << 20), &mut |done| {
        told.push(done);
        if told.len() == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(error.expect_err("stopped").to_string(), "reading was cancelled");
    assert_eq!(told, [1.0 / 3.0, 2.0 / 3.0]);
    let whole = bytes_of(&bytes[..], None, &mut |_| ControlFlow::Continue(())).expect("all of it");
    assert!(whole == bytes);
}

#[test]
fn the_command_line_opens_foreign_files_too() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path: PathBuf = folder.path().join("al.dat");
    std::fs::write(&path, ELLIPSOMETRY).expect("a writable folder for temporary files");
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::OpenMeasurements(vec![path]));
    wait(&mut harness);
    assert!(explorer(&mut harness).dialogs.import.is_some());
}

#[test]
fn enter_opens_a_table_whose_columns_are_guessed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("lab.csv");
    std::fs::write(&path, "inc,view,dolp\n30,20,0.1\n30,40,0.2\n40,40,0.3\n").expect("a writable folder");
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::OpenMeasurements(vec![path]));
    wait(&mut harness);
    harness.get_by_label_contains("The columns are taken as follows");
    harness.key_press(egui::Key::Enter);
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    assert!(explorer.dialogs.import.is_none());
    assert_eq!(explorer.work.active().measurement.rows.len(), 3);
}
