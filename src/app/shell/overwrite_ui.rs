//! The question before a file is replaced.

use crate::app::shell::app::App;
use crate::app::shell::dialogs::Dialogs;
use crate::app::views::action::Action;
use egui::{Label, RichText, Ui};
use tr::tr;

/// Width of the dialog.
const WIDTH: f32 = 420.0;

pub fn overwrite_ui(app: &mut App, ui: &mut Ui) {
    let App { dialogs: Dialogs { overwrite: Some(overwrite), .. }, actions, .. } = app else { return };
    let name = overwrite.path.file_name().unwrap_or_default().to_string_lossy();
    let response = egui::Modal::new(egui::Id::unique("replace")).show(ui.ctx(), |ui| {
        ui.set_width(WIDTH);
        ui.add(Label::new(RichText::new(tr!("{} exists. Replace it?", name)).strong()).wrap());
        ui.add(Label::new(RichText::new(overwrite.path.display().to_string()).weak()).wrap());
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            if ui.button(tr!("Replace")).clicked() {
                actions.push(Action::Replace);
            }
            let keep = ui.button(tr!("Keep")).on_hover_text(tr!("The file stays as it is, and nothing is written"));
            if keep.clicked() {
                actions.push(Action::KeepFile);
            }
            // Enter, with which the path was typed, must not answer by itself what cannot be taken
            // back.
            if ui.memory(|memory| memory.focused().is_none()) {
                keep.request_focus();
            }
        });
    });
    if response.should_close() {
        actions.push(Action::KeepFile);
    }
}
