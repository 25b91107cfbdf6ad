//! The line under the plots, and sentences over them.

use crate::app::panels::delta_e_text;
use crate::app::plots::theme;
use crate::app::shell::app::App;
use crate::app::shell::toasts::Toasts;
use crate::app::text::explained::Explained as _;
use crate::app::text::glossary;
use crate::app::text::localized::Localized as _;
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::choice_menu_ui;
use crate::app::views::curves::Decimation;
use egui::accesskit::Live;
use egui::{Label, RichText};
use std::time::Duration;
use tr::tr;

/// Widest and highest that sentences get.
const WIDTH: f32 = 640.0;
const HEIGHT: f32 = 96.0;
/// From the upper right corner of the panes to the notices: within the first plot, under its names.
const CORNER: egui::Vec2 = egui::vec2(-16.0, 66.0);
/// What is left of a plot, where its axis has numbers and a title.
const LEFT_OF_PLOT: f32 = 110.0;

/// What is open, and ΔE of the sliders.
pub fn status_ui(app: &mut App, ui: &mut egui::Ui) {
    let App { work, derived, jobs, actions, edits, window, frame_times, .. } = app;
    let open = work.active();
    ui.horizontal(|ui| {
        ui.strong(delta_e_text(derived.delta_e())).explained(format!(
            "{}\n{}",
            tr!("Of the sliders as they stand."),
            glossary::delta_e_help()
        ));
        ui.separator();
        if let Some(done) = jobs.files.reading_fraction() {
            #[expect(clippy::cast_possible_truncation, reason = "a fraction for a progress bar")]
            ui.add(egui::ProgressBar::new(done as f32).desired_width(160.0).text(tr!("Reading…")));
            if ui.button(tr!("Cancel reading")).clicked() {
                actions.push(Action::CancelLoading);
            }
            ui.separator();
        }
        if window.show_frame_times {
            ui.label(frame_times.text());
            ui.separator();
        }
        let description = ui.add(egui::Label::new(open.description()).truncate());
        if !open.mask().is_empty() {
            description.on_hover_text(glossary::mask_help());
        }
        if let Some(left_out) = derived.marks.get().and_then(|marks| marks.left_out) {
            ui.separator();
            if matches!(left_out, Decimation::Series { .. }) {
                choice_menu_ui(left_out.text(), open, edits, ui);
            } else {
                ui.label(left_out.text());
            }
        }
    });
}

/// What there is to say, over the foot of the plots: they stay where they are.
pub fn toasts_ui(app: &mut App, ui: &egui::Ui, room: egui::Rect) {
    let App { toasts, actions, derived, .. } = app;
    let now = ui.input(|input| input.time);
    if let Some(seconds) = toasts.expire(now) {
        ui.ctx().request_repaint_after(Duration::from_secs_f64(seconds));
    }
    let fault = derived.fault().map(|fault| tr!("There is no curve: {}.", fault.localized()));
    if toasts.is_empty() && fault.is_none() {
        return;
    }
    let width = WIDTH.min(room.width() - LEFT_OF_PLOT);
    let id = egui::Id::unique("toasts");
    let before = egui::AreaState::load(ui.ctx(), id).and_then(|state| state.size);
    let area = egui::Area::new(id).order(egui::Order::Middle).pivot(egui::Align2::RIGHT_TOP);
    let area = area.fixed_pos(room.right_top() + CORNER).constrain_to(room);
    let shown = area.show(ui.ctx(), |ui| {
        let warning = theme::warning(ui.visuals().dark_mode);
        let transient = fault.is_none() && toasts.iter().all(|toast| toast.transient);
        let color = if transient { ui.visuals().widgets.noninteractive.fg_stroke.color } else { warning };
        egui::Frame::popup(ui.style()).stroke(egui::Stroke::new(1.0, color)).show(ui, |ui| {
            ui.set_width(width);
            if let Some(fault) = fault {
                ui.add(Label::new(RichText::new(fault).color(warning)).wrap());
            }
            if !toasts.is_empty() {
                sentences_ui(toasts, actions, ui);
            }
        });
    });
    if before.is_some_and(|size| size != shown.response.rect.size()) {
        // It was drawn where its size of before puts it.
        ui.ctx().request_repaint();
    }
}

/// The sentences, each with what sends it away.
fn sentences_ui(toasts: &Toasts, actions: &mut Vec<Action>, ui: &mut egui::Ui) {
    // The newest is in sight; several do not cover the window.
    egui::ScrollArea::vertical().max_height(HEIGHT).stick_to_bottom(true).auto_shrink([false, true]).show(ui, |ui| {
        for (place, toast) in toasts.iter().enumerate() {
            ui.horizontal_top(|ui| {
                let close = ui.add(egui::Button::new("×").small().frame(false)).on_hover_text(tr!("Dismiss; Escape dismisses all"));
                close.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, tr!("Dismiss")));
                if close.clicked() {
                    actions.push(Action::Window(WindowAction::DismissToast(place)));
                }
                let label = ui.add(Label::new(RichText::new(&toast.text).color(toast.color(ui.visuals()))).wrap());
                // Read out without being asked for.
                ui.ctx().accesskit_node_builder(label.id, |node| {
                    node.set_live(if toast.transient { Live::Polite } else { Live::Assertive });
                });
            });
        }
    });
}
