//! Panes: each opens, what is not on screen is not computed, and the layout survives a restart.

use super::{explorer, harness, harness_of, wait};
use crate::app::command::Command;
use crate::app::panes::{PANES, Pane};
use crate::app::state::{Settings, Stored, WindowSettings};
use egui_kittest::kittest::Queryable as _;

#[test]
fn every_pane_opens_alone_and_beside_the_others() {
    for entry in &PANES {
        let mut harness = harness();
        for other in PANES.iter().filter(|other| other.pane != entry.pane) {
            explorer(&mut harness).commands.push(Command::ClosePane(other.pane));
        }
        wait(&mut harness);
        if !explorer(&mut harness).panes.is_on_screen(entry.pane) {
            explorer(&mut harness).commands.push(Command::TogglePane(entry.pane));
        }
        wait(&mut harness);
        assert_eq!(explorer(&mut harness).panes.on_screen(), [entry.pane]);
        harness.get_by_label(entry.title);
        explorer(&mut harness).commands.push(Command::ResetLayout);
        wait(&mut harness);
        if !explorer(&mut harness).panes.is_on_screen(entry.pane) {
            explorer(&mut harness).commands.push(Command::TogglePane(entry.pane));
            wait(&mut harness);
        }
        assert!(explorer(&mut harness).panes.is_on_screen(entry.pane), "{}", entry.title);
    }
}

#[test]
fn every_show_menu_opens() {
    for entry in PANES.iter().filter(|entry| entry.options.is_some()) {
        let mut harness = harness();
        if !explorer(&mut harness).panes.is_on_screen(entry.pane) {
            explorer(&mut harness).commands.push(Command::TogglePane(entry.pane));
            wait(&mut harness);
        }
        harness.get_by_label(&format!("Show in {}", entry.title)).click();
        wait(&mut harness);
    }
}

#[test]
fn what_is_not_on_screen_is_not_computed() {
    let mut harness = harness();
    for entry in &PANES {
        explorer(&mut harness).commands.push(Command::ClosePane(entry.pane));
    }
    harness.run();
    let before = explorer(&mut harness).derived.curves.key().cloned();
    explorer(&mut harness).settings.parameters.k = 4.5;
    harness.run();
    assert_eq!(explorer(&mut harness).derived.curves.key().cloned(), before);
    harness.get_by_label("All panes are closed. The View menu opens them again.");
    explorer(&mut harness).commands.push(Command::TogglePane(Pane::Lobes));
    harness.run();
    assert_ne!(explorer(&mut harness).derived.curves.key().cloned(), before);
}

#[test]
fn a_closed_pane_stays_closed_after_a_restart() {
    let mut harness = harness();
    explorer(&mut harness).commands.push(Command::ClosePane(Pane::Lobes));
    harness.run();
    let window: WindowSettings = explorer(&mut harness).window.clone();
    let text = serde_json::to_string(&Stored { settings: Settings::default(), window }).expect("settings are JSON");
    let mut again = harness_of(serde_json::from_str(&text).expect("what was written is read"));
    assert!(!explorer(&mut again).panes.is_on_screen(Pane::Lobes));
    assert!(explorer(&mut again).panes.is_on_screen(Pane::Dolp));
}
