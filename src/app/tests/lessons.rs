//! Lessons: every step of every one is shown, and sets what it says.

use crate::app::shell::app::App;
use crate::app::shell::app::autosave::{resume, save_on_exit, save_settings};
use crate::app::shell::app::job_results::dialog_answered;
use crate::app::shell::app::open::read_lessons;
use crate::app::storage::export::ExportKind;
use crate::app::storage::session::Session;
use crate::app::storage::settings_file;
use crate::app::tasks::file_request::FileRequest;
use crate::app::tasks::files::DialogAnswer;
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::text::i18n::Language;
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::edit::Edit;
use crate::app::work::layout::Layout;
use crate::app::work::open_measurement::{EXAMPLES, Mask};
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::measurement::Row;
use pbrdf::model::{Parameter, Parameters, Preset};

#[test]
fn every_step_of_every_lesson_is_shown() {
    let mut harness = harness();
    for lesson in 0..explorer(&mut harness).lessons.all.len() {
        for step in 0..explorer(&mut harness).lessons.all[lesson].steps.len() {
            explorer(&mut harness).actions.push(Action::ShowStep(lesson, step));
            wait(&mut harness);
            let heading = explorer(&mut harness).lessons.all[lesson].steps[step].heading.in_language("en").to_owned();
            assert!(harness.query_all_by_label_contains(&heading).next().is_some(), "{heading}");
            assert_eq!(explorer(&mut harness).toasts.text(), None, "{heading}");
            // Between the plots and the lower edge of the window.
            let (buttons, text) = (harness.get_by_label("Set up again").rect(), harness.get_by_label("Watch").rect());
            assert!(buttons.top() > 560.0 && text.top() > buttons.bottom() && text.bottom() < 700.0, "{heading}: {buttons} {text}");
            for name in explorer(&mut harness).lessons.all[lesson].steps[step].panes.clone() {
                let pane = PaneId::try_from(name.clone()).unwrap_or_else(|error| panic!("{heading}: {error}"));
                assert!(explorer(&mut harness).dock.is_on_screen(pane), "{heading}: {name}");
            }
        }
    }
}

#[test]
fn a_lesson_sets_the_sliders_and_goes_on_at_a_click() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::ShowStep(0, 0));
    harness.run();
    let (settings, surface) = explorer(&mut harness).work.values();
    assert_eq!((surface.parameters.n, surface.parameters.k, settings.theta_i), (1.5, 0.0, 56.3));
    assert_eq!(Some(surface.model), Preset::from_key("fresnel").map(|preset| preset.model));
    harness.get_by_label("Next step").click();
    harness.run();
    assert_eq!(explorer(&mut harness).lessons.open(), Some((0, 1)));
    harness.get_by_label("Close lesson").click();
    harness.run();
    assert_eq!(explorer(&mut harness).lessons.open(), None);
}

#[test]
fn a_presenters_remote_goes_through_the_steps_of_a_lesson() {
    let mut harness = harness();
    harness.key_press(egui::Key::PageDown);
    harness.run();
    assert_eq!(explorer(&mut harness).lessons.open(), None);
    explorer(&mut harness).actions.push(Action::ShowStep(0, 0));
    harness.run();
    let last = explorer(&mut harness).lessons.all[0].steps.len() - 1;
    for (key, step) in [(egui::Key::PageUp, 0), (egui::Key::PageDown, 1), (egui::Key::PageUp, 0)] {
        harness.key_press(key);
        harness.run();
        assert_eq!(explorer(&mut harness).lessons.open(), Some((0, step)), "{key:?}");
    }
    explorer(&mut harness).actions.push(Action::ShowStep(0, last));
    harness.run();
    harness.key_press(egui::Key::PageDown);
    harness.run();
    assert_eq!(explorer(&mut harness).lessons.open(), Some((0, last)), "only Done and Close lesson end it");
}

#[test]
fn the_buttons_of_a_lesson_stand_in_a_line() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::ShowStep(0, 0));
    wait(&mut harness);
    let next = harness.get_by_label("Next step").rect();
    for name in ["Previous step", "Set up again", "Close lesson", "Keep this"] {
        let button = harness.get_by_label(name).rect();
        assert_eq!((button.top(), button.bottom()), (next.top(), next.bottom()), "{name}");
    }
}

#[test]
fn the_last_lesson_of_the_menu_is_seen_without_scrolling() {
    let mut harness = harness();
    let last = explorer(&mut harness).lessons.all.last().expect("lessons").title.in_language("en").to_owned();
    harness.get_by_label("Lessons").click();
    harness.run();
    harness.get_by_label_contains(&last).click();
    wait(&mut harness);
    assert!(explorer(&mut harness).lessons.current().is_some(), "{last}");
}

#[test]
fn lessons_speak_chinese() {
    let mut harness = harness();
    explorer(&mut harness).window.language = Language::Chinese;
    explorer(&mut harness).actions.push(Action::ShowStep(0, 0));
    harness.run();
    assert!(harness.query_by_label_contains("透明表面").is_some());
    assert!(harness.query_by_label("下一步").is_some());
}

#[test]
fn a_damaged_lesson_is_named_and_the_window_goes_on() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    std::fs::write(folder.path().join("bad.txt"), "title: Mine\nstep: One\nset: n=x\n").expect("a file");
    std::fs::write(folder.path().join("good.txt"), "title: Mine\nstep: My own step\nset: n=1.75\n").expect("a file");
    std::fs::write(folder.path().join("latin.txt"), b"title: \xff\n").expect("a file");
    let mut harness = harness();
    let before = explorer(&mut harness).work.values();
    read_lessons(explorer(&mut harness), Some(folder.path()));
    harness.run();
    let notice = explorer(&mut harness).toasts.text().expect("a sentence");
    for part in ["bad.txt is no lesson: line 3", "latin.txt is no lesson: "] {
        assert!(notice.contains(part), "{notice}");
    }
    assert_eq!(explorer(&mut harness).work.values(), before);
    let last = explorer(&mut harness).lessons.all.len() - 1;
    explorer(&mut harness).actions.push(Action::ShowStep(last, 0));
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 1.75);
    assert!(harness.query_all_by_label_contains("My own step").next().is_some());
}

fn order(harness: &mut Harness<'static, Option<App>>, command: Action) {
    explorer(harness).actions.push(command);
    wait(harness);
}

/// The lesson that opens an example and asks for a fit.
const WITH_EXAMPLE: usize = 6;

/// What must come back.
#[derive(Debug, PartialEq)]
struct Work {
    settings: (Settings, Surface),
    rows: Vec<Row>,
    mask: Mask,
    fits: Vec<usize>,
    shown: Option<usize>,
    layout: Option<Layout>,
}

fn work(explorer: &App) -> Work {
    Work {
        settings: explorer.work.values(),
        rows: explorer.work.active().measurement.rows.clone(),
        mask: explorer.work.active().mask().clone(),
        fits: explorer.work.fit_history().iter().map(|fit| fit.id).collect(),
        shown: explorer.work.shown_fit().map(|fit| fit.id),
        layout: explorer.dock.layout(),
    }
}

/// A window that somebody worked in.
fn worked_in() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    order(&mut harness, Action::OpenExample(1));
    edit(&mut harness, Edit::Mask { rows: vec![2, 7], masked: true });
    explorer(&mut harness).work.settings_mut().starts = pbrdf::fit::Starts::One;
    order(&mut harness, Action::StartFit);
    order(&mut harness, Action::Window(WindowAction::ClosePane(PaneId::Lobes)));
    explorer(&mut harness).work.surface_mut().parameters.k = 4.25;
    harness.run();
    harness
}

/// Moves everything that a lesson can move.
fn go_through_a_lesson(harness: &mut Harness<'static, Option<App>>) {
    order(harness, Action::ShowStep(WITH_EXAMPLE, 0));
    edit(harness, Edit::Mask { rows: vec![1], masked: true });
    explorer(harness).work.settings_mut().starts = pbrdf::fit::Starts::One;
    order(harness, Action::StartFit);
    order(harness, Action::Window(WindowAction::ClosePane(PaneId::Dolp)));
    // Into another lesson and back.
    order(harness, Action::ShowStep(0, 0));
    explorer(harness).work.surface_mut().parameters.k = 1.5;
    order(harness, Action::ShowStep(WITH_EXAMPLE, 0));
}

#[test]
fn closing_a_lesson_brings_everything_back() {
    for button in ["Close lesson", "Done"] {
        let mut harness = worked_in();
        let before = work(explorer(&mut harness));
        go_through_a_lesson(&mut harness);
        assert_ne!(work(explorer(&mut harness)), before);
        assert!(harness.query_by_label_contains("Your own work comes back").is_some());
        while button == "Done" && harness.query_by_label("Next step").is_some() {
            harness.get_by_label("Next step").click();
            wait(&mut harness);
        }
        harness.get_by_label(button).click();
        wait(&mut harness);
        assert_eq!(work(explorer(&mut harness)), before, "{button}");
        assert_eq!(explorer(&mut harness).lessons.open(), None);
        // Undo goes on where it was.
        order(&mut harness, Action::Undo);
        assert_ne!(explorer(&mut harness).work.surface().parameters.k, 4.25);
        order(&mut harness, Action::Redo);
        assert_eq!(work(explorer(&mut harness)), before, "{button}");
    }
}

/// What a step sets up: settings, data, mask, panes.
fn set_up(explorer: &App) -> ((Settings, Surface), String, Vec<Row>, Mask, Option<Layout>) {
    let Work { settings, rows, mask, layout, .. } = work(explorer);
    (settings, explorer.work.active().name.clone(), rows, mask, layout)
}

#[test]
fn a_step_is_set_up_alike_whichever_way_one_comes_to_it() {
    let mut harness = worked_in();
    for lesson in 0..explorer(&mut harness).lessons.all.len() {
        let count = explorer(&mut harness).lessons.all[lesson].steps.len();
        let mut forward = Vec::new();
        for step in 0..count {
            order(&mut harness, Action::ShowStep(lesson, step));
            forward.push(set_up(explorer(&mut harness)));
        }
        // What a user moves, switches and opens on the way.
        let open = explorer(&mut harness);
        open.work.surface_mut().parameters.sigma = 1.75;
        let settings = open.work.settings_mut();
        (settings.view_options.facets_equal_median, settings.metal_selection.wavelength_nm) = (true, 333.0);
        order(&mut harness, Action::Window(WindowAction::ClosePane(PaneId::Dolp)));
        for (step, forward) in forward.iter().enumerate().rev() {
            order(&mut harness, Action::ShowStep(lesson, step));
            assert_eq!(&set_up(explorer(&mut harness)), forward, "lesson {lesson}, step {step}");
        }
        // Straight to the last one, the lesson not yet begun.
        order(&mut harness, Action::CloseLesson);
        order(&mut harness, Action::ShowStep(lesson, count - 1));
        assert_eq!(Some(&set_up(explorer(&mut harness))), forward.last(), "lesson {lesson}");
    }
}

#[test]
fn undo_leads_to_the_step_before_whichever_way_one_came() {
    let mut harness = harness();
    // "Quite another metal, the same curve", reached from behind.
    order(&mut harness, Action::ShowStep(2, 3));
    order(&mut harness, Action::ShowStep(2, 1));
    let k = |harness: &mut Harness<'static, Option<App>>| explorer(harness).work.surface().parameters.k;
    assert_eq!(k(&mut harness), 10.0054);
    order(&mut harness, Action::Undo);
    assert_eq!(k(&mut harness), 6.6);
    order(&mut harness, Action::Redo);
    assert_eq!(k(&mut harness), 10.0054);
}

#[test]
fn a_lesson_has_a_measurement_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    std::fs::write(
        folder.path().join("mine.txt"),
        "title: Mine\nstep: One\nset: k=3\nstep: Two\nexample: none\nmetal: Cu\nwavelength: 450\n",
    )
    .expect("a file");
    let mut harness = worked_in();
    let before = work(explorer(&mut harness));
    read_lessons(explorer(&mut harness), Some(folder.path()));
    let last = explorer(&mut harness).lessons.all.len() - 1;
    order(&mut harness, Action::ShowStep(last, 0));
    assert_eq!(explorer(&mut harness).work.active().name, EXAMPLES[0].name);
    assert_eq!(explorer(&mut harness).work.active().mask().len(), 0);
    order(&mut harness, Action::ShowStep(last, 1));
    assert!(explorer(&mut harness).work.active().measurement.rows.is_empty());
    assert!(harness.query_by_label("No measurement: curves alone").is_some());
    let tabulated = &explorer(&mut harness).work.settings().metal_selection;
    assert_eq!((tabulated.metal.as_str(), tabulated.wavelength_nm), ("Cu", 450.0));
    order(&mut harness, Action::CloseLesson);
    assert_eq!(work(explorer(&mut harness)), before);
}

#[test]
fn an_example_that_is_still_being_read_is_no_guest_of_the_own_work() {
    let mut harness = worked_in();
    let before = work(explorer(&mut harness));
    explorer(&mut harness).actions.extend([Action::ShowStep(0, 0), Action::OpenExample(2), Action::CloseLesson]);
    wait(&mut harness);
    assert_eq!(work(explorer(&mut harness)), before);
}

#[test]
fn what_a_lesson_shows_can_be_kept_and_undone() {
    let mut harness = worked_in();
    let before = explorer(&mut harness).work.values();
    order(&mut harness, Action::ShowStep(0, 0));
    harness.get_by_label("Keep this").click();
    wait(&mut harness);
    assert_eq!((explorer(&mut harness).lessons.open(), explorer(&mut harness).work.surface().parameters.n), (None, 1.5));
    order(&mut harness, Action::CloseLesson);
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 1.5, "there is nothing to go back to any more");
    order(&mut harness, Action::Undo);
    assert_eq!(explorer(&mut harness).work.values(), before);
}

#[test]
fn a_lesson_in_progress_and_the_own_work_under_it_come_back_at_the_next_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let (working, settings) = (folder.path().join("working.pbrdf.json"), folder.path().join("settings.json"));
    let mut first = worked_in();
    let before = work(explorer(&mut first));
    go_through_a_lesson(&mut first);
    let crashed = explorer(&mut first);
    (crashed.persistence.autosave_path, crashed.persistence.settings_path) = (Some(working.clone()), Some(settings.clone()));
    save_on_exit(crashed);
    save_settings(crashed);
    let lesson = (work(crashed), crashed.lessons.open());
    let kept = settings_file::load_from(&settings).0.settings;
    assert_eq!((kept.settings, kept.surface), before.settings);
    let mut second = harness();
    resume(explorer(&mut second), working);
    wait(&mut second);
    // Fits are numbered anew.
    let without_numbers = |work: Work| Work { fits: vec![0; work.fits.len()], shown: work.shown.map(|_| 0), ..work };
    let again = explorer(&mut second);
    assert_eq!((without_numbers(work(again)), again.lessons.open()), (without_numbers(lesson.0), lesson.1));
    assert!(second.query_by_label_contains("Your own work comes back").is_some());
    order(&mut second, Action::CloseLesson);
    let after = work(explorer(&mut second));
    assert_eq!((after.settings, after.rows, after.mask, after.layout), (before.settings, before.rows, before.mask, before.layout));
    assert_eq!((after.fits.len(), after.shown.is_some()), (before.fits.len(), before.shown.is_some()));
    assert_eq!(explorer(&mut second).lessons.open(), None);
}

#[test]
fn saving_in_a_lesson_leaves_the_file_of_the_own_session_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("own.pbrdf.json");
    let mut harness = worked_in();
    order(&mut harness, Action::Export(ExportKind::Session, path.clone()));
    order(&mut harness, Action::ShowStep(0, 0));
    // Asks where to; nobody answers.
    order(&mut harness, Action::SaveSession);
    let k = |path: &std::path::Path| {
        Session::read(&std::fs::read_to_string(path).expect("a file")).expect("a session").settings.surface.parameters.k
    };
    assert_eq!(k(&path), 4.25);
    // Into a file of its own it saves what is shown.
    let other = folder.path().join("lesson.pbrdf.json");
    order(&mut harness, Action::Export(ExportKind::Session, other.clone()));
    assert_eq!(k(&other), 0.0);
    order(&mut harness, Action::CloseLesson);
    explorer(&mut harness).work.surface_mut().parameters.k = 4.5;
    order(&mut harness, Action::SaveSession);
    assert_eq!((k(&path), k(&other)), (4.5, 0.0));
}

#[test]
fn a_session_opened_in_a_lesson_ends_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("own.pbrdf.json");
    let mut harness = worked_in();
    order(&mut harness, Action::Export(ExportKind::Session, path.clone()));
    let before = work(explorer(&mut harness)).settings;
    order(&mut harness, Action::ShowStep(0, 0));
    order(&mut harness, Action::OpenSession(path));
    assert_eq!(explorer(&mut harness).lessons.open(), None);
    order(&mut harness, Action::CloseLesson);
    assert_eq!(explorer(&mut harness).work.values(), before);
}

#[test]
fn a_session_that_is_still_being_read_does_not_replace_what_a_closed_lesson_gives_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("own.pbrdf.json");
    let mut harness = worked_in();
    order(&mut harness, Action::Export(ExportKind::Session, path.clone()));
    explorer(&mut harness).work.surface_mut().parameters.k = 4.5;
    order(&mut harness, Action::ShowStep(0, 0));
    explorer(&mut harness).actions.extend([Action::OpenSession(path), Action::CloseLesson]);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters.k, 4.5);
}

#[test]
fn a_file_opened_in_a_lesson_ends_it_and_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.csv");
    std::fs::write(&path, "theta_i,theta_r,dolp\n30,20,0.1\n30,40,0.2\n").expect("a file");
    let mut harness = worked_in();
    order(&mut harness, Action::ShowStep(0, 0));
    order(&mut harness, Action::OpenMeasurements(vec![path]));
    let notice = explorer(&mut harness).toasts.text().expect("a sentence");
    assert!(notice.contains("The lesson has ended") && notice.contains("mine.csv"), "{notice}");
    assert_eq!((explorer(&mut harness).lessons.open(), explorer(&mut harness).work.surface().parameters.k), (None, 4.25));
    order(&mut harness, Action::CloseLesson);
    assert_eq!(explorer(&mut harness).work.active().name, "mine.csv");
}

#[test]
fn a_mask_set_in_a_lesson_is_not_taken_for_one_set_after_it() {
    let mut harness = worked_in();
    order(&mut harness, Action::ShowStep(0, 0));
    edit(&mut harness, Edit::Mask { rows: vec![1], masked: true });
    let in_lesson = explorer(&mut harness).work.active().generation;
    order(&mut harness, Action::CloseLesson);
    edit(&mut harness, Edit::Mask { rows: vec![5], masked: true });
    assert_ne!(explorer(&mut harness).work.active().generation, in_lesson);
}

#[test]
fn a_lesson_begins_with_the_defaults_whatever_was_set() {
    let mut harness = worked_in();
    assert!(explorer(&mut harness).work.shown_fit().is_some());
    let settings = explorer(&mut harness).work.settings_mut();
    (settings.refit_live, settings.show_limit) = (true, false);
    explorer(&mut harness).work.surface_mut().parameters.sigma = 2.0;
    harness.run();
    order(&mut harness, Action::ShowStep(0, 0));
    let (settings, surface) = explorer(&mut harness).work.values();
    assert_eq!((settings.refit_live, settings.show_limit, surface.parameters.sigma), (false, true, Parameters::default().sigma));
    assert!(explorer(&mut harness).work.shown_fit().is_none(), "no curve of a fit among those of the lesson");
}

#[test]
fn a_step_states_the_ends_of_a_slider() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    std::fs::write(folder.path().join("mine.txt"), "title: Mine\nstep: One\nset: k=3\nrange: k=1..3\nstep: Two\nset: k=3\n")
        .expect("a file");
    let mut harness = harness();
    read_lessons(explorer(&mut harness), Some(folder.path()));
    let last = explorer(&mut harness).lessons.all.len() - 1;
    let reach = |harness: &mut Harness<'static, Option<App>>| {
        let slider = harness.get_all_by_role_and_label(egui::accesskit::Role::Slider, "k").next().expect("a slider");
        (slider.accesskit_node().min_numeric_value(), slider.accesskit_node().max_numeric_value())
    };
    let own = Parameter::K.range();
    let own = (Some(*own.start()), Some(*own.end()));
    assert_eq!(reach(&mut harness), own);
    order(&mut harness, Action::ShowStep(last, 0));
    assert_eq!(reach(&mut harness), (Some(1.0), Some(3.0)));
    order(&mut harness, Action::ShowStep(last, 1));
    assert_eq!(reach(&mut harness), own);
    order(&mut harness, Action::ShowStep(last, 0));
    order(&mut harness, Action::CloseLesson);
    assert_eq!(reach(&mut harness), own);
}

/// A table with names of its own, which the window asks about.
fn foreign(folder: &std::path::Path) -> std::path::PathBuf {
    let path = folder.join("foreign.csv");
    std::fs::write(&path, "a,b,c\n30,20,0.1\n30,40,0.2\n").expect("a writable folder");
    path
}

#[test]
fn no_lesson_begins_under_a_question() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::OpenMeasurements(vec![foreign(folder.path())]));
    wait(&mut harness);
    assert!(explorer(&mut harness).dialogs.import.is_some());
    explorer(&mut harness).actions.push(Action::ShowStep(0, 0));
    wait(&mut harness);
    let state = explorer(&mut harness);
    assert!(state.lessons.open().is_none() && state.dialogs.import.is_some());
    assert!(state.toasts.take().is_some_and(|text| text.contains("being chosen")));
    // Nor does a key open anything over the question.
    harness.key_press_modifiers(egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::P);
    harness.run();
    assert!(!explorer(&mut harness).dialogs.palette.is_open);
}

#[test]
fn an_answer_is_about_the_work_it_was_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("own.pbrdf.json");
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters.k = 4.5;
    wait(&mut harness);
    // The lesson is asked for in the very frame in which the answer comes.
    let request = FileRequest::Export(ExportKind::Session, String::new());
    explorer(&mut harness).actions.push(Action::ShowStep(0, 0));
    dialog_answered(explorer(&mut harness), DialogAnswer { request, reply: Ok(vec![path.clone()]) });
    wait(&mut harness);
    let text = std::fs::read_to_string(&path).expect("a file");
    assert_eq!(Session::read(&text).expect("a session").settings.surface.parameters.k, 4.5);
}

#[test]
fn what_was_said_before_a_session_is_opened_is_still_there_after() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("working.pbrdf.json");
    let mut harness = harness();
    let mut bytes = Vec::new();
    Session::of(&explorer(&mut harness).work).write(&mut bytes).expect("memory takes everything");
    std::fs::write(&path, bytes).expect("a writable folder");
    let state = explorer(&mut harness);
    state.toasts.error("The settings are damaged.".to_owned());
    state.toasts.load_error("other.csv: no such file.".to_owned());
    resume(state, path);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).toasts.take().as_deref(), Some("The settings are damaged."));
}
