//! The open lesson, under the panes that it speaks of: what to move, what to watch, why.

use crate::app::shell::app::App;
use crate::app::shell::docking::panes_ui;
use crate::app::shell::readout_ui::readout_ui;
use crate::app::shell::status_bar::toasts_ui;
use crate::app::text::i18n;
use crate::app::views::action::Action;
use crate::app::work::lesson::Wording;
use egui::{Label, RichText, ScrollArea, Ui};
use tr::tr;

/// Height of the panel before the user changes it.
const HEIGHT: f32 = 172.0;

/// The lesson that is open, over it the panes, and notices.
pub fn lesson_and_panes_ui(app: &mut App, ui: &mut Ui) {
    lesson_panel_ui(app, ui);
    let room = ui.available_rect_before_wrap();
    let (mut cx, views, dock) = app.split();
    panes_ui(dock, views, &mut cx, ui);
    toasts_ui(app, ui, room);
}

/// The panel, while a lesson is open.
fn lesson_panel_ui(app: &mut App, ui: &mut Ui) {
    if app.lessons.current().is_some() {
        egui::Panel::bottom("lesson").resizable(true).default_size(HEIGHT).show(ui, |ui| lesson_ui(app, ui));
    }
}

fn lesson_ui(app: &mut App, ui: &mut Ui) {
    let App { lessons, actions, dock, derived, .. } = app;
    let (Some((lesson, step)), Some((number, index))) = (lessons.current(), lessons.open()) else { return };
    let code = i18n::current().code();
    let count = lesson.steps.len();
    ui.horizontal(|ui| {
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.weak(format!("{}/{count}", index + 1));
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let title = format!("{} · {}", lesson.title.in_language(code), step.heading.in_language(code));
                ui.add(Label::new(RichText::new(title).strong()).truncate());
            });
        });
    });
    buttons_ui(number, index, count, actions, ui);
    if !dock.is_presented() {
        readout_ui(derived, ui);
    }
    // A bar that is seen before the pointer comes near: text below the edge would be missed.
    ui.spacing_mut().scroll = egui::style::ScrollStyle::solid();
    ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        ui.columns(3, |columns| {
            for (ui, (heading, text)) in
                columns.iter_mut().zip([(tr!("Move"), &step.action), (tr!("Watch"), &step.watch), (tr!("Why"), &step.why)])
            {
                part_ui(&heading, text, code, ui);
            }
        });
    });
}

/// Forth, back, and out.
fn buttons_ui(lesson: usize, step: usize, count: usize, actions: &mut Vec<Action>, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        if ui.add_enabled(step > 0, egui::Button::new(tr!("Previous step"))).clicked() {
            actions.push(Action::ShowStep(lesson, step - 1));
        }
        if ui.button(tr!("Set up again")).on_hover_text(tr!("Sliders and views as this step wants them")).clicked() {
            actions.push(Action::ShowStep(lesson, step));
        }
        let (name, command) =
            if step + 1 < count { (tr!("Next step"), Action::ShowStep(lesson, step + 1)) } else { (tr!("Done"), Action::CloseLesson) };
        if ui.button(name).clicked() {
            actions.push(command);
        }
        if ui.button(tr!("Close lesson")).on_hover_text(tr!("Your own sliders, data, fits and panes come back")).clicked() {
            actions.push(Action::CloseLesson);
        }
        let help = tr!("Close the lesson and go on from here; your work of before is given up");
        if ui.button(tr!("Keep this")).on_hover_text(help).clicked() {
            actions.push(Action::KeepLesson);
        }
        ui.weak(tr!("Your own work comes back when you close the lesson."));
    });
}

fn part_ui(heading: &str, text: &Wording, code: &str, ui: &mut Ui) {
    // Columns are laid out justified, which would pull the letters of short lines apart.
    ui.with_layout(egui::Layout::top_down(egui::Align::Min), |ui| {
        ui.label(RichText::new(heading).weak());
        ui.add(Label::new(text.in_language(code)).wrap());
    });
}
