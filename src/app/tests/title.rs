//! The title of the window, and saving under one key.

use crate::app::shell::app::title::title;
use crate::app::tests::measurements::{activate, order, three};
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::text::help::TITLE;
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use egui::{Key, Modifiers};

#[test]
fn the_title_names_the_session_and_marks_what_is_not_saved() {
    let (mut harness, folder) = three();
    assert_eq!(title(explorer(&mut harness)), format!("*450.csv and 2 more – {TITLE}"));
    let path = folder.path().join("wavelengths.pbrdf.json");
    explorer(&mut harness).jobs.files.ask = |_| Ok(Vec::new());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    wait(&mut harness);
    assert!(explorer(&mut harness).work.session_file().is_none(), "the name was asked for, and the dialog cancelled");
    order(&mut harness, Action::Export(crate::app::storage::export::ExportKind::Session, path.clone()));
    assert_eq!(title(explorer(&mut harness)), format!("wavelengths – {TITLE}"));
    edit(&mut harness, Edit::Mask { rows: vec![0], masked: true });
    assert_eq!(title(explorer(&mut harness)), format!("*wavelengths – {TITLE}"));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    wait(&mut harness);
    assert_eq!(title(explorer(&mut harness)), format!("wavelengths – {TITLE}"));
    activate(&mut harness, "650.csv");
    let mut other = self::harness();
    assert_eq!(title(explorer(&mut other)), TITLE, "nothing was done yet");
    order(&mut other, Action::OpenMeasurements(vec![path]));
    assert_eq!(title(explorer(&mut other)), format!("wavelengths – {TITLE}"));
    assert_eq!(explorer(&mut other).work.active().mask()[..], [0]);
}
