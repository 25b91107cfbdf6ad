//! One frame: menus, panels, panes, and what lies over them.

use crate::app::panels;
use crate::app::shell::app::App;
use crate::app::shell::command_palette::palette_ui;
use crate::app::shell::docking::panes_ui;
use crate::app::shell::help_ui::help_ui;
use crate::app::shell::import_ui::import_ui;
use crate::app::shell::lesson_ui::lesson_panel_ui;
use crate::app::shell::menu_bar::menu_ui;
use crate::app::shell::overwrite_ui::overwrite_ui;
use crate::app::shell::status_bar::{status_ui, toasts_ui};
use egui::{CentralPanel, Frame, Panel, Ui};

/// One frame.
pub fn ui(app: &mut App, ui: &mut Ui) {
    Panel::top("menu").show(ui, |ui| menu_ui(app, ui));
    Panel::bottom("status").show(ui, |ui| status_ui(app, ui));
    Panel::left("parameters").exact_size(366.0).resizable(false).show(ui, |ui| parameters_ui(app, ui));
    Panel::right("fit")
        .default_size(if ui.ctx().content_rect().width() < 1200.0 { 270.0 } else { 320.0 })
        .min_size(250.0)
        .show(ui, |ui| panels::fit_ui(&mut app.split().0, ui));
    CentralPanel::default().frame(Frame::central_panel(ui.style()).inner_margin(2)).show(ui, |ui| {
        lesson_panel_ui(app, ui);
        let room = ui.available_rect_before_wrap();
        let (mut cx, views, dock) = app.split();
        panes_ui(dock, views, &mut cx, ui);
        toasts_ui(app, ui, room);
    });
    palette_ui(app, ui);
    import_ui(app, ui);
    overwrite_ui(app, ui);
    help_ui(app, ui);
    app.apply_edits();
}

fn parameters_ui(app: &mut App, ui: &mut Ui) {
    if app.work.measurements().has_rows() || !app.work.pinned().is_empty() {
        Panel::top("measurements").show(ui, |ui| {
            let (mut cx, lists) = app.split_lists();
            lists.measurements.ui(&mut cx, ui);
            lists.pinned.ui(&mut cx, ui);
        });
    }
    let mut refusals = Vec::new();
    let ranges = app.lessons.ranges();
    panels::parameters_ui(&mut app.split().0, &mut refusals, &ranges, ui);
    refusals.into_iter().for_each(|sentence| app.toasts.error(sentence));
}
