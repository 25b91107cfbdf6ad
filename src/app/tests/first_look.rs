//! What a new user meets first: tabs, the tour, notices, and the keys.

use crate::app::shell::commands::{Menu, items};
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::spec;
use crate::app::work::layout::Layout;
use crate::app::work::pane_id::PaneId;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

#[test]
fn the_first_tabs_are_those_that_most_want_and_the_menu_has_the_others() {
    let panes = Layout::default().panes();
    assert_eq!(panes, [PaneId::Dolp, PaneId::Picture, PaneId::Lobes, PaneId::Data, PaneId::Models]);
    let mut harness = harness();
    let commands = items(explorer(&mut harness));
    for pane in PaneId::ALL {
        let menu = if pane.judges_program() { Menu::Program } else { Menu::Pane };
        assert!(commands.iter().any(|command| command.menu == menu && command.text == spec(*pane).title), "{pane:?}");
    }
}

#[test]
fn choosing_a_pane_that_is_seen_leaves_it_where_it_is() {
    let mut harness = harness();
    for _ in 0..2 {
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Dolp)));
        wait(&mut harness);
        assert!(explorer(&mut harness).dock.on_screen().contains(&PaneId::Dolp));
    }
}

#[test]
fn the_tour_has_four_steps_and_is_skipped_for_good() {
    let mut harness = harness();
    assert!(harness.query_by_label("Skip the tour").is_none(), "only the first start shows it by itself");
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowTour(0)));
    wait(&mut harness);
    for (step, heading) in ["Sliders", "Plots", "Fit", "Lessons and talks"].into_iter().enumerate() {
        assert!(harness.query_all_by_label(heading).next().is_some(), "{heading}");
        assert!(harness.query_all_by_label(&format!("{}/4", step + 1)).next().is_some());
        harness.get_by_label(if step < 3 { "Next" } else { "Done" }).click();
        wait(&mut harness);
    }
    assert!(explorer(&mut harness).window.knows_tour && explorer(&mut harness).dialogs.tour.is_none());
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowTour(0)));
    wait(&mut harness);
    harness.get_by_label("Skip the tour").click();
    wait(&mut harness);
    assert!(explorer(&mut harness).dialogs.tour.is_none());
}

#[test]
fn escape_ends_the_tour_and_a_talk_is_without_it() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowTour(0)));
    wait(&mut harness);
    explorer(&mut harness).actions.push(Action::Window(WindowAction::Present));
    wait(&mut harness);
    assert!(harness.query_by_label("Skip the tour").is_none());
    // The first leaves the talk, the second the tour.
    harness.key_press(Key::Escape);
    wait(&mut harness);
    assert!(harness.query_by_label("Skip the tour").is_some());
    harness.key_press(Key::Escape);
    wait(&mut harness);
    assert!(explorer(&mut harness).window.knows_tour && explorer(&mut harness).dialogs.tour.is_none());
}

#[test]
fn every_notice_goes_by_itself_and_lies_over_no_axis() {
    let mut harness = harness();
    for text in ["One.", "Two."] {
        explorer(&mut harness).toasts.error(text.to_owned());
    }
    wait(&mut harness);
    for plot in ["Plot: DoLP against θr", "Plot: BRDF against θr"] {
        let plot = harness.get_by_role_and_label(Role::Image, plot).rect();
        for text in ["One.", "Two."] {
            let notice = harness.get_by_label(text).rect();
            // Numbers and titles of the axes are left of the plot and below it.
            let is_beside = notice.left() >= plot.left() || notice.right() < plot.left() - 72.0;
            let is_above = notice.bottom() <= plot.bottom() || notice.top() > plot.bottom() + 40.0;
            assert!(is_beside && is_above, "{notice:?} {plot:?}");
        }
    }
    harness.query_all_by_role_and_label(Role::Button, "Dismiss").next().expect("a button for each").click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).toasts.text().as_deref(), Some("Two."));
    harness.key_press(Key::Escape);
    wait(&mut harness);
    assert!(explorer(&mut harness).toasts.is_empty());
}

#[test]
fn enter_keeps_the_focus() {
    let mut harness = harness();
    let typed = harness.get_by_role_and_label(Role::SpinButton, "n");
    typed.focus();
    wait(&mut harness);
    harness.key_press(Key::Enter);
    wait(&mut harness);
    let focused = harness.ctx.memory(egui::Memory::focused);
    assert!(focused.is_some(), "the next Tab goes on from here");
}

#[test]
fn keys_that_a_field_has_no_use_for_work_while_it_is_typed_into() {
    let mut harness = harness();
    harness.get_by_role_and_label(Role::SpinButton, "n").focus();
    wait(&mut harness);
    harness.key_press(Key::Enter);
    wait(&mut harness);
    assert!(harness.ctx.text_edit_focused());
    let before = explorer(&mut harness).work.surface().clone();
    // Of the field: all of its text.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    wait(&mut harness);
    assert_eq!(*explorer(&mut harness).work.surface(), before);
    harness.key_press(Key::F11);
    wait(&mut harness);
    assert!(explorer(&mut harness).dock.is_presented());
}

#[test]
fn f10_opens_the_first_menu() {
    let mut harness = harness();
    harness.key_press(Key::F10);
    wait(&mut harness);
    assert!(harness.query_by_label_contains("Open measurements").is_some());
}

#[test]
fn the_list_of_commands_is_as_long_as_before_after_a_word_that_finds_nothing() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::OpenPalette));
    wait(&mut harness);
    let shown = |harness: &egui_kittest::Harness<'static, Option<crate::app::shell::app::App>>| {
        let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1280.0, 500.0));
        harness.query_all_by_label_contains(" › ").filter(|row| screen.contains_rect(row.rect())).count()
    };
    let before = shown(&harness);
    assert!(before > 8, "{before}");
    explorer(&mut harness).dialogs.palette.filter = "zzzz".to_owned();
    wait(&mut harness);
    explorer(&mut harness).dialogs.palette.filter.clear();
    wait(&mut harness);
    assert_eq!(shown(&harness), before);
}

#[test]
fn f6_leads_through_menus_panels_and_panes_and_back() {
    let mut harness = harness();
    let mut seen = Vec::new();
    for _ in 0..5 {
        harness.key_press(Key::F6);
        wait(&mut harness);
        seen.push(harness.ctx.memory(egui::Memory::focused).expect("a control"));
    }
    // Menus, parameters, fit, two panes: five stops, and then around.
    let distinct: std::collections::HashSet<_> = seen.iter().collect();
    assert_eq!(distinct.len(), 5, "{seen:?}");
    harness.key_press(Key::F6);
    wait(&mut harness);
    assert_eq!(harness.ctx.memory(egui::Memory::focused), Some(seen[0]));
    harness.key_press_modifiers(Modifiers::SHIFT, Key::F6);
    wait(&mut harness);
    assert_eq!(harness.ctx.memory(egui::Memory::focused), Some(seen[4]));
}
