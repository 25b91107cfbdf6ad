//! Sessions: saved, opened on another machine, damaged, killed while they are written.

use crate::app::shell::app::App;
use crate::app::shell::app::autosave::{resume, save_on_exit};
use crate::app::storage::export::ExportKind;
use crate::app::storage::session::Session;
use crate::app::storage::session_file::save_session;
use crate::app::storage::settings_file::load_from;
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::fit::{Loss, Starts};
use pbrdf::model::{DolpFormula, Parameter};
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};
use std::time::Duration;

fn order(harness: &mut Harness<'static, Option<App>>, command: Action) {
    explorer(harness).actions.push(command);
    wait(harness);
}

/// A window that somebody worked in.
fn worked_in() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    edit(&mut harness, Edit::Mask { rows: vec![3, 5], masked: true });
    explorer(&mut harness).work.surface_mut().set_bounds(Parameter::N, 0.5, 8.0).expect("sound bounds");
    order(&mut harness, Action::StartFit);
    order(&mut harness, Action::Window(WindowAction::ClosePane(PaneId::Lobes)));
    explorer(&mut harness).work.settings_mut().theta_i = 35.5;
    explorer(&mut harness).work.surface_mut().parameters.k = 4.25;
    harness.run();
    harness
}

fn saved(harness: &mut Harness<'static, Option<App>>, folder: &Path) -> PathBuf {
    let path = folder.join("work.pbrdf.json");
    order(harness, Action::Export(ExportKind::Session, path.clone()));
    path
}

#[test]
fn a_session_opens_with_everything_that_was_in_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut before = worked_in();
    let path = saved(&mut before, folder.path());
    let mut after = harness();
    order(&mut after, Action::OpenSession(path.clone()));
    let (before, after) = (explorer(&mut before), explorer(&mut after));
    assert_eq!(after.toasts.text(), None);
    assert_eq!(after.work.values(), before.work.values());
    assert_eq!(after.work.active().measurement.rows, before.work.active().measurement.rows);
    assert_eq!(after.work.active().measurement.metadata, before.work.active().measurement.metadata);
    assert_eq!(after.work.active().mask(), before.work.active().mask());
    assert_eq!(after.work.active().name, before.work.active().name);
    assert!(!after.dock.is_on_screen(PaneId::Lobes));
    let (old, new) = (before.work.shown_fit().expect("a fit"), after.work.shown_fit().expect("the fit again"));
    assert_eq!((old.before, old.problem.start()), (new.before, new.problem.start()));
    assert_eq!(old.problem.free(), new.problem.free());
    assert_eq!(old.report, new.report);
    assert_eq!(after.work.session_file(), Some(path.as_path()));
}

#[test]
fn a_fit_of_a_session_is_shown_as_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut before = harness();
    // One with an automatic scale of its loss, and an earlier one that is shown.
    order(&mut before, Action::StartFit);
    explorer(&mut before).work.settings_mut().fit_options.loss = Loss::Huber;
    order(&mut before, Action::StartFit);
    edit(&mut before, Edit::Mask { rows: vec![4], masked: true });
    order(&mut before, Action::ReturnToFit(1));
    let path = saved(&mut before, folder.path());
    let mut after = harness();
    order(&mut after, Action::OpenSession(path));
    for harness in [&mut before, &mut after] {
        for pane in [PaneId::Landscape, PaneId::Convergence] {
            explorer(harness).dock.show(pane);
        }
        wait(harness);
    }
    let said = |harness: &mut Harness<'static, Option<App>>| {
        let texts = ["evaluations", "in the best basin", "Winning start of", "The mask has changed"];
        texts.map(|text| {
            harness
                .query_all_by_label_contains(text)
                .map(|node| (node.accesskit_node().label(), node.accesskit_node().value()))
                .collect::<Vec<_>>()
        })
    };
    assert_eq!(said(&mut before), said(&mut after));
    assert!(after.query_by_label_contains("The mask has changed").is_some());
    assert!(after.query_by_label_contains("made no step").is_none());
    let (before, after) = (explorer(&mut before), explorer(&mut after));
    for (old, new) in before.work.fit_history().iter().zip(after.work.fit_history().iter()) {
        assert_eq!(old.report, new.report);
        assert!(old.report.course.trace.len() > 1 && old.report.course.evaluations > 1 && old.report.course.elapsed_ms > 0.0);
    }
    let shown = |explorer: &App| explorer.work.shown_fit().map(|fit| fit.id);
    assert_eq!((shown(before), shown(after)), (Some(1), Some(1)));
    let marks = |explorer: &App| {
        let marks = explorer.views.get::<crate::app::views::LandscapeView>().marks().expect("what lies on the map");
        (marks.minima.len(), marks.ways.iter().map(|way| way.points.len()).collect::<Vec<_>>())
    };
    assert_eq!(marks(before), marks(after));
    assert!(marks(after).0 >= 1 && marks(after).1.iter().all(|&steps| steps > 1));
}

#[test]
fn a_comparison_of_models_comes_back_row_by_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut before = harness();
    order(&mut before, Action::CompareModels);
    order(&mut before, Action::StartFit);
    let path = saved(&mut before, folder.path());
    let mut after = harness();
    order(&mut after, Action::OpenSession(path.clone()));
    let rows = |harness: &mut Harness<'static, Option<App>>| -> Vec<_> {
        let rows = explorer(harness).work.model_comparison().iter();
        // The way of a long fit is thinned in a file.
        rows.map(|row| (row.preset.key, row.report().map(|fit| (fit.parameters, fit.objective, fit.estimates.clone())))).collect()
    };
    assert_eq!(rows(&mut before).len(), pbrdf::model::PRESETS.len());
    assert_eq!(rows(&mut after), rows(&mut before));
    // What is no comparison is none, and takes nothing else with it: a fit of another model, none, and no number.
    let text = std::fs::read_to_string(&path).expect("the session");
    let line = text.lines().find(|line| line.contains("\"compared\":")).expect("a comparison").to_owned();
    for wrong in [line.replace("\"gauss\"", "\"cauchy\""), line.replace("],[", "0],["), line.replacen("[[", "[null,[", 1)] {
        assert_ne!(wrong, line);
        std::fs::write(&path, text.replace(&line, &wrong)).expect("a file");
        let mut damaged = harness();
        order(&mut damaged, Action::OpenSession(path.clone()));
        assert!(rows(&mut damaged).is_empty(), "{wrong}");
        assert_eq!(explorer(&mut damaged).work.fit_history().len(), explorer(&mut before).work.fit_history().len());
    }
    // A click on a row finds its fit in the history.
    edit(&mut after, Edit::UseModelFit(2));
    let work = &explorer(&mut after).work;
    assert_eq!(work.shown_fit().map(|fit| fit.id), work.model_comparison()[2].result.as_ref().ok().map(|fit| fit.id));
}

#[test]
fn a_fit_of_dolp_and_brdf_together_comes_back_with_its_weights_and_intervals() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut before = harness();
    order(&mut before, Action::OpenExample(2));
    assert!(explorer(&mut before).work.active().measurement.has_dolp() && explorer(&mut before).work.active().measurement.has_brdf());
    order(&mut before, Action::StartFit);
    let path = saved(&mut before, folder.path());
    let text = std::fs::read_to_string(&path).expect("the session");
    let opened = |text: &str| {
        std::fs::write(&path, text).expect("a file");
        let mut after = harness();
        order(&mut after, Action::OpenSession(path.clone()));
        after
    };
    let old = explorer(&mut before).work.shown_fit().expect("a fit").report.clone();
    assert!(old.statistics.block_weights != [1.0; 2] && old.course.intervals_complete == Some(true));
    assert_eq!(explorer(&mut opened(&text)).work.shown_fit().expect("the fit").report, old);
    // Versions before knew no intervals.
    let mut earlier: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    earlier["fits"][0]["account"].as_object_mut().expect("an account").remove("intervals").expect("intervals");
    let mut after = opened(&earlier.to_string());
    assert_eq!(explorer(&mut after).work.shown_fit().expect("the fit").report.course.intervals_complete, None);
    after.get_by_label("Find the intervals");
}

#[test]
fn a_session_that_does_not_tell_how_its_fit_came_about_opens() {
    let mut source = worked_in();
    let mut bytes = Vec::new();
    Session::of(&explorer(&mut source).work).write(&mut bytes).expect("memory");
    let mut old: serde_json::Value = serde_json::from_slice(&bytes).expect("JSON");
    old.as_object_mut().expect("a session").remove("shown");
    old["fits"][0].as_object_mut().expect("a fit").remove("account").expect("an account");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("old.pbrdf.json");
    std::fs::write(&path, old.to_string()).expect("a file");
    let mut other = harness();
    order(&mut other, Action::OpenSession(path.clone()));
    assert!(explorer(&mut other).work.shown_fit().is_some());
    assert!(other.query_by_label_contains("not known: from a session of an older version").is_some());
    // Saved again with another mask, and so as some files are: with an account that tells of the
    // mask alone.
    edit(&mut other, Edit::Mask { rows: vec![8], masked: true });
    order(&mut other, Action::SaveSession);
    let again: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&path).expect("the session")).expect("JSON");
    assert!(again["fits"][0]["account"].is_null());
    let mut emptied = again.clone();
    let fit = emptied["fits"][0].as_object_mut().expect("a fit");
    let masked = fit.remove("masked").expect("its mask");
    fit.insert("account".to_owned(), serde_json::json!({"evaluations": 0, "elapsed_ms": 0.0, "masked": masked, "minima": [], "way": []}));
    for text in [again, emptied] {
        std::fs::write(&path, text.to_string()).expect("a file");
        let mut third = harness();
        order(&mut third, Action::OpenSession(path.clone()));
        let third = explorer(&mut third);
        assert_eq!(third.toasts.text(), None);
        assert_eq!(third.work.shown_fit().expect("the fit").mask[..], [3, 5]);
        assert_eq!(third.work.active().mask()[..], [3, 5, 8]);
    }
    for wrong in ["evaluations", "in the best basin"] {
        assert!(other.query_by_label_contains(wrong).is_none(), "{wrong}");
    }
    explorer(&mut other).dock.show(PaneId::Convergence);
    other.run();
    assert!(other.query_by_label_contains("How this fit came about is not known").is_some());
}

#[test]
fn a_session_whose_sliders_are_no_surface_opens_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut source = harness();
    explorer(&mut source).actions.push(Action::StartFit);
    source.step();
    // While the fit runs: they are what "back" leads to.
    let parameters = &mut explorer(&mut source).work.surface_mut().parameters;
    (parameters.n, parameters.k) = (0.0, 0.0);
    wait(&mut source);
    order(&mut source, Action::UseValuesBeforeFit);
    let path = saved(&mut source, folder.path());
    let mut other = harness();
    order(&mut other, Action::OpenMeasurements(vec![path]));
    let explorer = explorer(&mut other);
    assert_eq!(explorer.toasts.text(), None);
    assert_eq!((explorer.work.surface().parameters.n, explorer.work.surface().parameters.k), (0.0, 0.0));
    assert!(explorer.work.shown_fit().is_some());
}

#[test]
fn saving_again_goes_into_the_same_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = worked_in();
    let path = saved(&mut harness, folder.path());
    explorer(&mut harness).work.surface_mut().parameters.n = 1.875;
    order(&mut harness, Action::SaveSession);
    let text = std::fs::read_to_string(&path).expect("the session");
    assert_eq!(Session::read(&text).expect("a session").settings.surface.parameters.n, 1.875);
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1, "nothing else is left behind");
}

#[test]
fn a_session_is_readable_row_by_row() {
    let mut harness = worked_in();
    let mut bytes = Vec::new();
    Session::of(&explorer(&mut harness).work).write(&mut bytes).expect("memory");
    let text = String::from_utf8(bytes).expect("text");
    assert!(text.starts_with("{\n  \"format\": \"pbrdf-session\",\n  \"version\": 3,\n"));
    assert!(text.contains("\"theta_i,theta_r,dphi,dolp,dolp_sigma,masked\",\n"));
    assert!(text.lines().all(|line| line.len() < 300));
}

#[test]
fn a_damaged_session_names_place_and_cause_and_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut source = worked_in();
    let good = std::fs::read_to_string(saved(&mut source, folder.path())).expect("the session");
    let parameter = |key: &str| {
        let at = good.find(&format!("\"{key}\": ")).expect("the key");
        good[at..].split(",\n").next().expect("its value").to_owned()
    };
    let row =
        good.lines().map(str::trim).find(|line| line.starts_with("\"30,") && line.ends_with(",0\",")).expect("a row of data").to_owned();
    let bad_angle = row.replacen("\"30,", "\"95,", 1).replacen("\"40,", "\"95,", 1).replacen("\"50,", "\"95,", 1);
    let cases = [
        (String::new(), "line 1"),
        ("{}".to_owned(), "no session"),
        ("theta_i,theta_r,dolp\n30,20,0.1\n".to_owned(), "line 1"),
        (good[..good.len() / 2].to_owned(), "line"),
        (good.replacen("\"version\": 3", "\"version\": 99", 1), "version 99"),
        (good.replacen(&parameter("sigma"), "\"sigma\": 1e999", 1), "out of range"),
        (good.replacen(&parameter("sigma"), "\"sigma\": null", 1), "settings.parameters.sigma"),
        (good.replacen(&parameter("sigma"), "\"sigma\": -3.0", 1), "settings.parameters: sigma = -3"),
        (good.replacen("\"theta_i\": 35.5", "\"theta_i\": 90.0", 1), "settings.theta_i, dphi: "),
        (good.replacen("\"wavelength_nm\": 650.0", "\"wavelength_nm\": -650.0", 1), "settings.tabulated.wavelength_nm: "),
        (good.replacen("\"from\": 10.0", "\"from\": 110.0", 1), "settings.plan: "),
        (good.replacen(&row, &bad_angle, 1), "measurement.table: line"),
        (good.replacen(&row, &row.replacen("0\",", "2\",", 1), 1), "masked"),
        (good.replacen("\"fits\": [", "\"fits\": 7, \"others\": [", 1), "fits"),
    ];
    let mut harness = harness();
    let before = explorer(&mut harness).work.values();
    let rows = explorer(&mut harness).work.active().measurement.rows.clone();
    for (text, expected) in cases {
        assert_ne!(text, good, "{expected}: the damage is there");
        let path = folder.path().join("bad.pbrdf.json");
        std::fs::write(&path, &text).expect("a writable folder");
        order(&mut harness, Action::OpenMeasurements(vec![path]));
        let explorer = explorer(&mut harness);
        let notice = explorer.toasts.take().expect("a sentence");
        assert!(notice.contains("bad.pbrdf.json: ") && notice.contains(expected) && notice.ends_with('.'), "{expected}: {notice}");
        assert_eq!((&explorer.work.values(), &explorer.work.active().measurement.rows), (&before, &rows));
    }
}

#[test]
fn a_damaged_fit_is_left_out_with_a_sentence_and_the_rest_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut source = worked_in();
    explorer(&mut source).work.settings_mut().fit_options.loss = Loss::Huber;
    order(&mut source, Action::StartFit);
    order(&mut source, Action::ReturnToFit(1));
    let good: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(saved(&mut source, folder.path())).expect("the session")).expect("JSON");
    assert_eq!(good["shown"], 1);
    let cases = [
        ("/fits/0", "7", "fit 1: a value is not as expected: invalid type"),
        ("/fits/0/account/minima/0/reached", "-1", "account.minima[0].reached: "),
        ("/fits/0/account/minima/0/reached", "18446744073709551615", "account.minima: more starts"),
        ("/fits/0/account/minima/0/at", "[0.5]", "account: a place"),
        ("/fits/0/account/minima/0/at/0", "-1.0", "n = -"),
        ("/fits/0/account/way/0/delta_e", "-1.0", "account: a time or a ΔE"),
        ("/fits/0/account/loss_scales", "[-1.0, 1.0]", "account: a scale of the loss"),
        ("/fits/0/account/loss_scales", "[1e-300, 1.0]", "account: a scale of the loss"),
        ("/fits/0/account/loss_scales", "[1.0, 1e300]", "account: a scale of the loss"),
        ("/fits/0/account/intervals/of/0/0", "[2.0, 1.0]", "account.intervals: "),
        ("/fits/0/account/intervals/of", "[]", "account.intervals: "),
        ("/fits/0/account/masked", "[5, 3]", "masked: "),
        ("/fits/0/account/masked", "[3, 3]", "masked: "),
        ("/fits/0/account/masked", "[3, 99999]", "masked: "),
    ];
    let path = folder.path().join("bad.pbrdf.json");
    for (place, value, expected) in cases {
        let mut bad = good.clone();
        let minima = bad["fits"][0]["account"]["minima"].as_array_mut().expect("minima");
        minima.push(minima[0].clone());
        *bad.pointer_mut(place).expect("the place") = serde_json::from_str(value).expect("JSON");
        std::fs::write(&path, bad.to_string()).expect("a file");
        let mut other = harness();
        order(&mut other, Action::OpenSession(path.clone()));
        let other = explorer(&mut other);
        let notice = other.toasts.take().expect("a sentence");
        assert!(notice.contains("bad.pbrdf.json is opened without") && notice.contains(expected), "{place} {value}: {notice}");
        assert_eq!(other.work.values(), explorer(&mut source).work.values());
        assert_eq!(other.work.active().mask(), explorer(&mut source).work.active().mask());
        let (fits, shown) = (other.work.fit_history().len(), other.work.shown_fit().map(|fit| fit.problem.options().loss));
        assert_eq!((fits, shown), (1, Some(Loss::Squared)), "{place}");
    }
}

#[test]
fn files_that_have_eq_17_among_the_choices_of_the_fit_keep_its_meaning() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut source = worked_in();
    explorer(&mut source).work.surface_mut().model.dolp_formula = DolpFormula::AsPrinted;
    order(&mut source, Action::StartFit);
    let mut session: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(saved(&mut source, folder.path())).expect("the session")).expect("JSON");
    for (place, formula) in [("/settings", "printed"), ("/fits/0", "printed"), ("/fits/1", "consistent")] {
        let object = session.pointer_mut(place).expect("the place");
        object["model"].as_object_mut().expect("a model").remove("dolp_formula").expect("a formula");
        object["choices"].as_object_mut().expect("choices").insert("eq17".to_owned(), formula.into());
    }
    let path = folder.path().join("earlier.pbrdf.json");
    std::fs::write(&path, session.to_string()).expect("a file");
    let mut other = harness();
    order(&mut other, Action::OpenSession(path));
    assert_eq!(explorer(&mut other).work.values(), explorer(&mut source).work.values());
    let formulas: Vec<DolpFormula> = explorer(&mut other).work.fit_history().iter().map(|fit| fit.problem.model().dolp_formula).collect();
    assert_eq!(formulas, [DolpFormula::AsPrinted, DolpFormula::Consistent]);

    let path = folder.path().join("settings.json");
    std::fs::write(&path, serde_json::json!({ "settings": session["settings"] }).to_string()).expect("a file");
    let (file, notice) = load_from(&path);
    assert_eq!((file.settings.surface, notice), (explorer(&mut source).work.surface().clone(), None));
}

#[test]
fn the_working_state_is_kept_and_comes_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("new folder/working.pbrdf.json");
    let mut first = worked_in();
    explorer(&mut first).persistence.autosave_path = Some(path.clone());
    save_on_exit(explorer(&mut first));
    let mut second = harness();
    explorer(&mut second).persistence.autosave_path = Some(path.clone());
    resume(explorer(&mut second), path.clone());
    wait(&mut second);
    assert_eq!(explorer(&mut second).work.values(), explorer(&mut first).work.values());
    assert_eq!(explorer(&mut second).work.session_file(), None, "what is kept without being asked is no session of the user's");
    // Damaged, it is set aside with a sentence.
    std::fs::write(&path, "{").expect("a writable folder");
    let mut third = harness();
    explorer(&mut third).persistence.autosave_path = Some(path.clone());
    resume(explorer(&mut third), path.clone());
    wait(&mut third);
    let notice = explorer(&mut third).toasts.take().expect("a sentence");
    assert!(notice.contains("cannot be opened") && notice.contains("line 1"), "{notice}");
    assert!(folder.path().join("new folder/working.pbrdf.damaged.json").exists());
}

#[test]
fn a_full_disk_leaves_the_old_session() {
    // /dev/full takes nothing; a folder that is not there cannot take a temporary file either.
    let mut harness = worked_in();
    let session = Session::of(&explorer(&mut harness).work);
    if Path::new("/dev/full").exists() {
        assert!(save_session(Path::new("/dev/full"), &session).expect_err("no room").contains("cannot be written"));
    }
    order(&mut harness, Action::Export(ExportKind::Session, PathBuf::from("/dev/null/x.pbrdf.json")));
    assert!(explorer(&mut harness).toasts.take().expect("a sentence").contains("cannot be written"));
}

/// How often a saving process is killed.
const KILLS: u32 = 100;
/// Tells the process that is killed where to save.
const SAVE_TO: &str = "PBRDF_TEST_SAVE_TO";

/// The process that is killed: saves two states in turn until then.
#[test]
fn saver() {
    let Some(path) = std::env::var_os(SAVE_TO).map(PathBuf::from) else { return };
    let text = std::fs::read_to_string(&path).expect("the state before");
    let mut session = Session::read(&text).expect("a session");
    for turn in 0_u32.. {
        session.settings.surface.parameters.n = if turn % 2 == 0 { 2.0 } else { 3.0 };
        save_session(&path, &session).expect("a place to save");
    }
}

#[test]
fn a_process_killed_while_saving_leaves_the_old_or_the_new_state() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut source = worked_in();
    let path = saved(&mut source, folder.path());
    let program = std::env::current_exe().expect("this test");
    let mut seen = [0_u32; 2];
    for kill in 0..KILLS {
        let mut child = Process::new(&program)
            .args(["app::tests::sessions::saver", "--exact"])
            .env(SAVE_TO, &path)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("this test again");
        // From before the first save to some tens of saves, at moments that nothing ties to the
        // writing.
        std::thread::sleep(Duration::from_micros(u64::from(kill * 7919 % 60_000)));
        child.kill().expect("a running process");
        child.wait().expect("its end");
        let text = std::fs::read_to_string(&path).expect("a file");
        let session = Session::read(&text).unwrap_or_else(|error| panic!("kill {kill}: {error:?}"));
        match session.settings.surface.parameters.n {
            2.0 => seen[0] += 1,
            3.0 => seen[1] += 1,
            // The state before the first save of all.
            _ => {}
        }
        assert_eq!(session.measurements[0].measurement.rows, explorer(&mut source).work.active().measurement.rows);
    }
    assert!(seen.iter().all(|&times| times > 0), "both states were seen, {seen:?}: the kills met a process at work");
}

#[test]
fn fits_of_a_measurement_that_is_no_longer_open_come_back_with_their_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let working = folder.path().join("working.pbrdf.json");
    let mut first = harness();
    explorer(&mut first).work.settings_mut().starts = Starts::One;
    order(&mut first, Action::OpenExample(1));
    edit(&mut first, Edit::Mask { rows: vec![3], masked: true });
    order(&mut first, Action::StartFit);
    order(&mut first, Action::OpenExample(2));
    order(&mut first, Action::StartFit);
    explorer(&mut first).persistence.autosave_path = Some(working.clone());
    save_on_exit(explorer(&mut first));
    let mut second = harness();
    resume(explorer(&mut second), working);
    wait(&mut second);
    let (first, second) = (&explorer(&mut first).work, &explorer(&mut second).work);
    assert_eq!(second.active().name, first.active().name);
    assert_eq!((first.fit_history().len(), second.fit_history().len()), (2, 2));
    for (old, new) in first.fit_history().iter().zip(second.fit_history().iter()) {
        assert_eq!((&new.document, &new.mask, &new.data.rows), (&old.document, &old.mask, &old.data.rows));
        assert_eq!(new.report.parameters, old.report.parameters);
        assert_eq!(new.number == second.active().number, old.number == first.active().number);
    }
}
