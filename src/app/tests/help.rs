//! The pages of help.

use crate::app::tests::{explorer, harness};
use crate::app::text::glossary::{Entry, GLOSSARY};
use crate::app::text::help::{DOI, Help};
use crate::app::views::action::{Action, WindowAction};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

#[test]
fn the_menu_and_the_palette_show_each_page_and_escape_leaves_it() {
    let mut harness = harness();
    let pages = [
        ("First steps…", Help::FirstSteps, "tick “fixed” beside every value"),
        ("Words…", Help::Words, "Degree of linear polarisation of what is reflected"),
        ("About pbrdf-explorer…", Help::About, DOI),
    ];
    for (name, page, part) in pages {
        harness.get_by_label("Help").click();
        harness.run();
        harness.get_by_label_contains(name).click();
        harness.run();
        assert_eq!(explorer(&mut harness).dialogs.help, Some(page));
        harness.get_by_label_contains(part);
        harness.key_press(Key::Escape);
        harness.run();
        assert_eq!(explorer(&mut harness).dialogs.help, None, "{name}");
        harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
        harness.run();
        harness.get_by_label("Find a command").type_text(name.trim_end_matches('…'));
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(explorer(&mut harness).dialogs.help, Some(page));
        // Its button has the focus.
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(explorer(&mut harness).dialogs.help, None, "{name}");
    }
}

#[test]
fn about_names_version_licence_paper_and_where_things_are_kept() {
    let mut harness = harness();
    explorer(&mut harness).persistence.settings_path = Some("/somewhere/settings.json".into());
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowHelp(Help::About)));
    harness.run();
    let version = format!("version {}", env!("CARGO_PKG_VERSION"));
    for part in [version.as_str(), "MIT or Apache-2.0", "Acta Optica Sinica 41(11)", "/somewhere/settings.json", "is kept in: nowhere"] {
        harness.get_by_label_contains(part);
    }
    // Nothing is written there by this test.
    explorer(&mut harness).persistence.settings_path = None;
}

#[test]
fn every_word_is_told_once() {
    for (i, Entry { word, meaning }) in GLOSSARY.iter().enumerate() {
        assert!(meaning.ends_with('.') && GLOSSARY[..i].iter().all(|other| other.word != *word), "{word}");
    }
    let all: String = GLOSSARY.iter().map(|entry| format!("{} ", entry.word)).collect();
    for asked in
        ["DoLP", "ΔE", "θi", "θr", "Δφ", "open", "undetermined", "at bound", "limit", "mask", "ghost", "cases", "Fresnel limit", "lobes"]
    {
        assert!(all.contains(asked), "{asked}");
    }
}
