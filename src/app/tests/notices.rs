//! Sentences to the user: they move nothing, go or stay as they should, and are read out.

use crate::app::platform::DialogUnavailable;
use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::Action;
use crate::app::work::pane_id::PaneId;
use egui::accesskit::{Live, Role};
use egui::{Key, Modifiers, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

type Window = Harness<'static, Option<App>>;

fn plot(harness: &Window) -> Rect {
    harness.get_by_label("Plot: DoLP against θr").rect()
}

fn overlay(harness: &Window) -> Option<Rect> {
    harness.ctx.memory(|memory| memory.area_rect(egui::Id::unique("toasts")))
}

#[test]
fn sentences_do_not_move_the_plots_and_several_do_not_cover_them() {
    let mut harness = harness();
    let before = plot(&harness);
    explorer(&mut harness).toasts.error("The first thing went wrong.".to_owned());
    harness.run();
    assert_eq!(plot(&harness), before);
    for number in 0..30 {
        explorer(&mut harness).toasts.error(format!("{number}: {}.", "this went wrong too and takes more than a line to tell ".repeat(4)));
    }
    harness.run();
    assert_eq!(plot(&harness), before);
    let shown = overlay(&harness).expect("sentences");
    assert!(shown.height() < 130.0 && shown.width() < 700.0, "{shown:?}");
    assert!(harness.ctx.content_rect().contains_rect(shown));
    // The newest is in sight, the oldest are gone.
    let newest = harness.get_by_label_contains("29: this went wrong").rect();
    assert!(shown.expand(1.0).contains_rect(newest), "{shown:?} {newest:?}");
    assert!(harness.query_by_label_contains("The first thing").is_none());
}

#[test]
fn what_is_left_sinks_to_the_place_of_what_went() {
    let mut harness = harness();
    explorer(&mut harness).toasts.error("It failed.".to_owned());
    harness.run();
    let place = |harness: &Window| harness.get_by_label("It failed.").rect();
    let alone = place(&harness);
    explorer(&mut harness).toasts.info("It is done.".to_owned());
    harness.run();
    while explorer(&mut harness).toasts.iter().count() > 1 {
        harness.step();
    }
    // Nothing else wakes the window then: it has to be asked for.
    let root = &harness.output().viewport_output[&egui::ViewportId::ROOT];
    assert!(root.repaint_delay.is_zero() || place(&harness) == alone, "{:?}", root.repaint_delay);
    harness.run();
    assert_eq!(place(&harness), alone);
}

#[test]
fn a_missing_curve_does_not_move_the_plots_either() {
    let mut harness = harness();
    let before = plot(&harness);
    let parameters = &mut explorer(&mut harness).work.surface_mut().parameters;
    (parameters.n, parameters.k) = (0.0, 0.0);
    harness.run();
    harness.get_by_label_contains("There is no curve");
    assert_eq!(plot(&harness).min, before.min);
}

#[test]
fn a_success_goes_by_itself_and_a_failure_stays() {
    let mut harness = harness();
    explorer(&mut harness).toasts.info("It is done.".to_owned());
    explorer(&mut harness).toasts.error("It failed.".to_owned());
    harness.run();
    assert_eq!(explorer(&mut harness).toasts.text().as_deref(), Some("It is done.\nIt failed."));
    for (sentence, live) in [("It is done.", Live::Polite), ("It failed.", Live::Assertive)] {
        assert_eq!(harness.get_by_label(sentence).accesskit_node().live(), live, "{sentence}");
    }
    // A step of these tests is a quarter of a second.
    harness.run_steps(40);
    assert_eq!(explorer(&mut harness).toasts.text().as_deref(), Some("It failed."));
}

#[test]
fn escape_dismisses_sentences_after_what_lies_above_them() {
    let mut harness = harness();
    explorer(&mut harness).toasts.error("It failed.".to_owned());
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
    harness.run();
    harness.key_press(Key::Escape);
    harness.run();
    assert!(!explorer(&mut harness).dialogs.palette.is_open && !explorer(&mut harness).toasts.is_empty());
    harness.get_by_label("File").click();
    harness.run();
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.query_by_label_contains("Open measurement").is_none() && !explorer(&mut harness).toasts.is_empty());
    harness.key_press(Key::Escape);
    harness.run();
    assert!(explorer(&mut harness).toasts.is_empty());
    assert_eq!(overlay(&harness).filter(|_| harness.query_by_role_and_label(Role::Button, "Dismiss").is_some()), None);
}

#[test]
fn where_no_dialog_opens_it_is_said_what_is_missing_and_where_to_type() {
    let mut harness = harness();
    explorer(&mut harness).jobs.files.ask = |_| Err(DialogUnavailable);
    for (command, place) in [
        (Action::ChooseMeasurement, "under “Type a path to open”"),
        (Action::ChooseSession, "under “Type a path to open”"),
        (Action::ChooseSave, "under “Save to a path”"),
        (Action::SaveSession, "under “Save to a path”"),
        (Action::ChooseExport(ExportKind::Plot(PaneId::Dolp)), "File › Export"),
    ] {
        explorer(&mut harness).actions.push(command);
        wait(&mut harness);
        let sentence = explorer(&mut harness).toasts.take().expect("a sentence");
        assert!(sentence.contains("xdg-desktop-portal") && sentence.contains("zenity") && sentence.contains(place), "{sentence}");
    }
    // A dialog that was cancelled needs no word.
    explorer(&mut harness).jobs.files.ask = |_| Ok(Vec::new());
    explorer(&mut harness).actions.push(Action::ChooseMeasurement);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).toasts.text(), None);
    // The boxes are there.
    harness.get_by_label("File").click();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, "Type a path to open and press Enter:");
    harness.get_by_role_and_label(Role::TextInput, "Save to a path (.csv the measurement, .json the session), Enter:");
}
