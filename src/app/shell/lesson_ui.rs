//! The open lesson, under the panes that it speaks of: what to move, what to watch, why.

use crate::app::shell::app::App;
use crate::app::shell::docking::panes_ui;
use crate::app::shell::icons::{Icon, icon_ui};
use crate::app::shell::readout_ui::readout_ui;
use crate::app::shell::status_bar::toasts_ui;
use crate::app::text::i18n;
use crate::app::views::action::Action;
use crate::app::work::lesson::{Step, Wording};
use egui::text::LayoutJob;
use egui::{Label, RichText, ScrollArea, TextFormat, TextStyle, Ui};
use tr::tr;

/// Height of the panel before the user changes it, as far as its text needs no more.
const HEIGHT: f32 = 172.0;
/// Below this height of the window, in points, the lesson has its whole width, so that plots have
/// most of its height.
const LOW: f32 = 600.0;
/// Share of the height of the window that the text has at most; a longer one scrolls.
const MOST: f32 = 0.4;

/// The lesson that is open, over it the panes, and notices.
pub fn lesson_and_panes_ui(app: &mut App, ui: &mut Ui) {
    // On a small screen the lesson stands where the sliders do.
    let is_apart = app.dialogs.room.is_small && app.dialogs.room.embedded.is_none();
    if app.dock.is_presented() || !(is_low(ui) || is_apart) {
        lesson_panel_ui(app, ui);
    }
    let room = ui.available_rect_before_wrap();
    let (mut cx, views, dock) = app.split();
    panes_ui(dock, views, &mut cx, ui);
    toasts_ui(app, ui, room);
}

/// The lesson that is open, over the whole width of a low window; call it before the panels at the
/// sides.
pub fn low_lesson_ui(app: &mut App, ui: &mut Ui) {
    if is_low(ui) {
        lesson_panel_ui(app, ui);
    }
}

fn is_low(ui: &Ui) -> bool {
    ui.ctx().content_rect().height() < LOW
}

/// The panel, while a lesson is open: as high as the longest text of its steps needs, so that plots
/// stay where they are.
fn lesson_panel_ui(app: &mut App, ui: &mut Ui) {
    let Some((lesson, _)) = app.lessons.current() else { return };
    let width = ui.available_width() - 16.0;
    let code = i18n::current().code();
    let text = lesson.steps.iter().map(|step| parts_height(&parts(step), code, width, ui)).fold(0.0, f32::max);
    let gap = gap(ui);
    // Of buttons and title, and of the read-out; beneath each other, buttons may need two.
    let buttons = if width > ONE_LINE { 1.0 } else { 3.0 } * (ui.spacing().interact_size.y + gap);
    let readout = ui.text_style_height(&TextStyle::Body) + gap;
    let window = ui.ctx().content_rect().height();
    if app.lessons.is_folded {
        egui::Panel::bottom("folded lesson").resizable(false).show(ui, |ui| lesson_ui(app, ui));
        return;
    }
    let needed = (buttons + readout + text).min(MOST * window).max(if is_low(ui) { 0.0 } else { HEIGHT });
    let id = egui::Id::unique(("lesson", is_low(ui)));
    let panel = egui::Panel::bottom(id).resizable(true).default_size(needed);
    panel.size_range(needed..=0.7 * window).show(ui, |ui| lesson_ui(app, ui));
}

/// Width from which the buttons stand beside the title, and what they take.
const ONE_LINE: f32 = 800.0;
const BUTTONS: f32 = 440.0;

/// The open lesson: its buttons, and the texts of the step.
pub fn lesson_ui(app: &mut App, ui: &mut Ui) {
    let App { lessons, actions, dock, derived, dialogs, .. } = app;
    // A frame in another page is there for its lesson.
    let can_leave = dialogs.room.embedded.is_none();
    let (Some((lesson, step)), Some((number, index))) = (lessons.current(), lessons.open()) else { return };
    let code = i18n::current().code();
    let count = lesson.steps.len();
    let is_wide = ui.available_width() > ONE_LINE;
    let mut is_folded = lessons.is_folded;
    ui.spacing_mut().item_spacing.y = gap(ui);
    ui.horizontal(|ui| {
        if is_wide {
            ui.allocate_ui_with_layout(
                egui::vec2(BUTTONS, ui.spacing().interact_size.y),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    buttons_ui((number, index, count), can_leave, actions, ui);
                },
            );
        }
        let rest = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(rest, egui::Layout::right_to_left(egui::Align::Center), |ui| {
            fold_ui(&mut is_folded, ui);
            ui.weak(format!("{}/{count}", index + 1));
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let heading = step.heading.in_language(code);
                let title = format!("{} · {heading}", lesson.title.in_language(code));
                let font = TextStyle::Body.resolve(ui.style());
                let width = ui.painter().layout_no_wrap(title.clone(), font, egui::Color32::PLACEHOLDER).size().x;
                let fits = width <= ui.available_width();
                let text = RichText::new(if fits { &title } else { heading }).strong();
                ui.add(Label::new(text).truncate()).on_hover_text(title);
            });
        });
    });
    if !is_wide {
        ui.horizontal_wrapped(|ui| {
            buttons_ui((number, index, count), can_leave, actions, ui);
            if can_leave {
                let promise = egui::WidgetText::from(RichText::new(tr!("Your own work comes back at the end.")).weak());
                // Beside the buttons, or as a whole beneath them.
                ui.label(promise.into_galley(ui, Some(egui::TextWrapMode::Extend), f32::INFINITY, TextStyle::Body));
            }
        });
    }
    if !dock.is_presented() {
        readout_ui(derived, ui);
    }
    if lessons.is_folded {
        lessons.is_folded = is_folded;
        return;
    }
    // A bar that is seen before the pointer comes near: text below the edge would be missed.
    ui.spacing_mut().scroll = egui::style::ScrollStyle::solid();
    ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        let parts = parts(step);
        if ui.available_width() < STACKED {
            for (heading, text) in &parts {
                ui.add(Label::new(run_in(heading, text.in_language(code), ui)).wrap());
            }
            return;
        }
        let widths = widths(&parts, code, ui.available_width());
        ui.spacing_mut().item_spacing.x = GAP;
        ui.horizontal_top(|ui| {
            for ((heading, text), width) in parts.iter().zip(widths) {
                ui.vertical(|ui| {
                    ui.set_width(width);
                    if is_low(ui) {
                        ui.add(Label::new(run_in(heading, text.in_language(code), ui)).wrap());
                    } else {
                        ui.label(RichText::new(heading).weak());
                        ui.add(Label::new(text.in_language(code)).wrap());
                    }
                });
            }
        });
    });
    lessons.is_folded = is_folded;
}

/// Takes the text away, so that plots have its room, and brings it back.
fn fold_ui(is_folded: &mut bool, ui: &mut Ui) {
    let (icon, name) =
        if *is_folded { (Icon::Unfold, tr!("Show the text")) } else { (Icon::Fold, tr!("Only the plots, without the text")) };
    if icon_ui(icon, &name, None, ui).clicked() {
        *is_folded = !*is_folded;
    }
}

/// Width below which the texts stand one under the other.
const STACKED: f32 = 480.0;

/// Between lines of the panel.
fn gap(ui: &Ui) -> f32 {
    if is_low(ui) { 2.0 } else { ui.spacing().item_spacing.y }
}

/// What to move, what to watch, and why, with their headings.
fn parts(step: &Step) -> [(String, &Wording); 3] {
    [(tr!("Move"), &step.action), (tr!("Watch"), &step.watch), (tr!("Why"), &step.why)]
}

/// Between the three, and the least share of the width that one has.
const GAP: f32 = 14.0;
const LEAST_SHARE: f32 = 0.16;

/// Widths in which the three have about the same height: as their lengths are.
fn widths(parts: &[(String, &Wording); 3], code: &str, room: f32) -> [f32; 3] {
    #[expect(clippy::cast_precision_loss, reason = "a number of letters")]
    let lengths = [0, 1, 2].map(|i| parts[i].1.in_language(code).chars().count() as f32);
    let shares = lengths.map(|length| (length / lengths.iter().sum::<f32>().max(1.0)).max(LEAST_SHARE));
    let sum: f32 = shares.iter().sum();
    shares.map(|share| (room - 2.0 * GAP) * share / sum)
}

/// A text that begins with its heading, on the same line.
fn run_in(heading: &str, text: &str, ui: &Ui) -> LayoutJob {
    let font = TextStyle::Body.resolve(ui.style());
    let mut job = LayoutJob::default();
    job.append(heading, 0.0, TextFormat::simple(font.clone(), ui.visuals().weak_text_color()));
    job.append(text, RUN_IN, TextFormat::simple(font, ui.visuals().text_color()));
    job
}

/// From the heading to the text.
const RUN_IN: f32 = 6.0;

/// Height of the three with their headings.
fn parts_height(parts: &[(String, &Wording); 3], code: &str, room: f32, ui: &Ui) -> f32 {
    // A bar of the scroll area takes its width from the text.
    let widths = widths(parts, code, room - 12.0);
    let heights = parts.iter().zip(widths).map(|((heading, part), width)| {
        let mut job = run_in(if is_low(ui) { heading } else { "" }, part.in_language(code), ui);
        job.wrap.max_width = width;
        ui.painter().layout_job(job).size().y
    });
    let heading = if is_low(ui) { 0.0 } else { ui.text_style_height(&TextStyle::Body) + gap(ui) };
    heading + gap(ui) + heights.fold(0.0, f32::max)
}

/// Forth and back in the lesson of that number, step and count of steps, and out.
fn buttons_ui((lesson, step, count): (usize, usize, usize), can_leave: bool, actions: &mut Vec<Action>, ui: &mut Ui) {
    if ui.add_enabled(step > 0, egui::Button::new(tr!("Previous step"))).clicked() {
        actions.push(Action::ShowStep(lesson, step - 1));
    }
    if ui.button(tr!("Set up again")).on_hover_text(tr!("Sliders and views as this step wants them")).clicked() {
        actions.push(Action::ShowStep(lesson, step));
    }
    let (name, command) = if step + 1 < count || !can_leave {
        (tr!("Next step"), Action::ShowStep(lesson, step + 1))
    } else {
        (tr!("Done"), Action::CloseLesson)
    };
    if ui.add_enabled(can_leave || step + 1 < count, egui::Button::new(name)).clicked() {
        actions.push(command);
    }
    if !can_leave {
        return;
    }
    if ui.button(tr!("Close lesson")).on_hover_text(tr!("Your own sliders, data, fits and panes come back")).clicked() {
        actions.push(Action::CloseLesson);
    }
    let help = tr!("Close the lesson and go on from here; your work of before is given up");
    if ui.button(tr!("Keep this")).on_hover_text(help).clicked() {
        actions.push(Action::KeepLesson);
    }
}
