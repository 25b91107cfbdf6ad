//! The pages of help, each in a dialog.

use crate::app::shell::app::App;
use crate::app::text::glossary::{Entry, GLOSSARY};
use crate::app::text::help::{DOI, FIRST_STEPS, Help, PAPER, TITLE};
use crate::app::text::i18n::translated;
use crate::app::views::action::{Action, WindowAction};
use egui::{Grid, Label, RichText, ScrollArea, Ui};
use std::path::Path;
use tr::tr;

/// Width of a page, and of the words on it; the height beyond which it scrolls.
const WIDTH: f32 = 620.0;
const WORD_WIDTH: f32 = 130.0;
const MEANING_WIDTH: f32 = WIDTH - WORD_WIDTH - 30.0;
const HEIGHT: f32 = 480.0;

pub fn help_ui(app: &mut App, ui: &mut Ui) {
    let Some(page) = app.dialogs.help else { return };
    let response = egui::Modal::new(egui::Id::unique("help")).show(ui.ctx(), |ui| {
        ui.set_width(WIDTH);
        ui.heading(translated(page.heading()));
        ui.separator();
        ScrollArea::vertical().max_height(HEIGHT.min(ui.ctx().content_rect().height() - 160.0)).show(ui, |ui| match page {
            Help::FirstSteps => first_steps_ui(ui),
            Help::Words => words_ui(ui),
            Help::About => about_ui(app, ui),
        });
        ui.separator();
        let close = ui.button(tr!("Close"));
        if ui.memory(|memory| memory.focused().is_none()) {
            close.request_focus();
        }
        close.clicked()
    });
    if response.inner || response.should_close() {
        app.actions.push(Action::Window(WindowAction::CloseHelp));
    }
}

fn first_steps_ui(ui: &mut Ui) {
    for (number, sentence) in (1..).zip(FIRST_STEPS) {
        ui.horizontal_top(|ui| {
            ui.weak(number.to_string());
            ui.add(Label::new(translated(sentence)).wrap());
        });
        ui.add_space(4.0);
    }
}

fn words_ui(ui: &mut Ui) {
    Grid::new("words").num_columns(2).striped(true).spacing([12.0, 6.0]).show(ui, |ui| {
        for Entry { word, meaning } in GLOSSARY {
            for (text, width) in
                [(RichText::new(translated(word)).strong(), WORD_WIDTH), (RichText::new(translated(meaning)), MEANING_WIDTH)]
            {
                ui.vertical(|ui| {
                    ui.set_width(width);
                    ui.add(Label::new(text).wrap());
                });
            }
            ui.end_row();
        }
    });
}

fn about_ui(app: &App, ui: &mut Ui) {
    let line = |ui: &mut Ui, text: String| ui.add(Label::new(text).wrap());
    line(ui, format!("{TITLE} · {}", tr!("version {}", env!("CARGO_PKG_VERSION"))));
    line(ui, tr!("Licence: MIT or Apache-2.0, at your option"));
    ui.add_space(8.0);
    line(ui, tr!("The model is that of this paper:"));
    line(ui, PAPER.to_owned());
    ui.hyperlink_to(format!("doi {DOI}"), format!("https://doi.org/{DOI}"));
    line(ui, tr!("Cite it for the model, and this program by name and version."));
    ui.add_space(8.0);
    let place = |path: Option<&Path>| path.map_or_else(|| tr!("nowhere"), |path| path.display().to_string());
    line(ui, tr!("Settings are kept in: {}", place(app.persistence.settings_path.as_deref())));
    line(ui, tr!("What was open when the window closed is kept in: {}", place(app.persistence.autosave_path.as_deref())));
}
