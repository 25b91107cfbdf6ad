//! Menus under the pointer and by keys.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness};
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

fn click(harness: &mut Harness<'static, Option<App>>, title: &str) {
    let at = harness.get_by_label(title).rect().center();
    harness.hover_at(at);
    harness.run();
    harness.drag_at(at);
    harness.run();
    harness.drop_at(at);
    harness.run();
}

#[test]
fn a_click_on_the_title_of_a_menu_that_opened_under_the_pointer_leaves_it_open() {
    let mut harness = harness();
    let is_open = |harness: &Harness<'static, Option<App>>| harness.query_by_label_contains("Copy parameters").is_some();
    click(&mut harness, "File");
    assert!(harness.query_by_label_contains("Open measurement").is_some());
    // Under the pointer alone, beside an open menu, and then clicked.
    click(&mut harness, "Edit");
    assert!(is_open(&harness) && harness.query_by_label_contains("Open measurement").is_none());
    click(&mut harness, "Edit");
    assert!(!is_open(&harness), "the next click closes it");
    click(&mut harness, "Edit");
    assert!(is_open(&harness));
    click(&mut harness, "Edit");
    assert!(!is_open(&harness), "and so does a second one on a menu that was opened by a click");
    // Where no menu is open the pointer opens none, and orders go on.
    let file = harness.get_by_label("File").rect().center();
    harness.hover_at(file);
    harness.run();
    assert!(harness.query_by_label_contains("Open measurement").is_none());
    click(&mut harness, "View");
    harness.get_by_label("Logarithmic lobes").click();
    harness.run();
    assert!(explorer(&mut harness).work.settings().log_brdf && harness.query_by_label("Logarithmic lobes").is_none());
}

#[test]
fn alt_and_a_letter_open_a_menu_and_close_it_again() {
    let mut harness = harness();
    for (letter, item) in [(Key::F, "Open measurement"), (Key::E, "Copy parameters"), (Key::V, "Logarithmic lobes")] {
        for is_open in [true, false] {
            harness.key_press_modifiers(Modifiers::ALT, letter);
            harness.run();
            assert_eq!(harness.query_by_label_contains(item).is_some(), is_open, "{letter:?}");
        }
    }
}
