//! One frame: menus, panels, panes, and what lies over them.

use crate::app::panels;
use crate::app::shell::app::App;
use crate::app::shell::app::arrange::adapt;
use crate::app::shell::command_palette::palette_ui;
use crate::app::shell::help_ui::help_ui;
use crate::app::shell::import_ui::import_ui;
use crate::app::shell::lesson_ui::{lesson_and_panes_ui, lesson_ui, low_lesson_ui};
use crate::app::shell::menu_bar::menu_ui;
use crate::app::shell::overwrite_ui::overwrite_ui;
use crate::app::shell::presentation::presentation_ui;
use crate::app::shell::room::{Below, Embedded};
use crate::app::shell::status_bar::status_ui;
use crate::app::shell::tour::{note_panels, tour_ui};
use crate::app::views::follow_f6;
use crate::app::work::settings::SidePanel;
use egui::{Align, CentralPanel, Frame, Layout, Panel, Role, ScrollArea, Ui, UiBuilder, WidgetInfo};
use tr::tr;

/// One frame.
pub fn ui(app: &mut App, ui: &mut Ui) {
    adapt(app, ui.ctx().content_rect().size());
    let room = &app.dialogs.room;
    if let Some(Embedded { panes, has_sliders }) = room.embedded.clone() {
        low_lesson_ui(app, ui);
        if has_sliders {
            Panel::left("parameters").exact_size(PARAMETERS).resizable(false).show(ui, |ui| parameters_ui(app, ui));
        }
        if !panes.is_empty() {
            middle_ui(app, ui);
        }
    } else if app.dock.is_presented() {
        presentation_ui(app, ui);
    } else if room.is_small {
        small_ui(app, ui);
    } else {
        Panel::top("menu").show(ui, |ui| menu_ui(app, ui));
        Panel::bottom("status").show(ui, |ui| status_ui(app, ui));
        low_lesson_ui(app, ui);
        side_panels_ui(app, ui);
        middle_ui(app, ui);
    }
    palette_ui(app, ui);
    import_ui(app, ui);
    overwrite_ui(app, ui);
    help_ui(app, ui);
    tour_ui(app, ui);
    follow_f6(ui.ctx());
    app.apply_edits();
}

/// The open lesson and the panes.
fn middle_ui(app: &mut App, ui: &mut Ui) {
    CentralPanel::default().frame(Frame::central_panel(ui.style()).inner_margin(2)).show(ui, |ui| lesson_and_panes_ui(app, ui));
}

/// Width of a small screen, in points, from which sliders stand beside the pane if the screen is wider than high.
const BESIDE: f32 = 640.0;

/// One pane, and beside or below it the sliders, the fit or a lesson.
fn small_ui(app: &mut App, ui: &mut Ui) {
    app.dialogs.room.follow(app.lessons.open());
    let size = ui.ctx().content_rect().size();
    let is_beside = size.x >= BESIDE && size.x > size.y;
    Panel::top("menu").show(ui, |ui| {
        let row = ui.available_rect_before_wrap();
        menu_ui(app, ui);
        if is_beside {
            let row = row.with_max_y(ui.min_rect().bottom());
            ui.scope_builder(UiBuilder::new().max_rect(row).layout(Layout::right_to_left(Align::Center)), |ui| choice_ui(app, ui));
        }
    });
    if is_beside {
        if app.dialogs.room.below != Below::Nothing {
            Panel::right("beside").exact_size(PARAMETERS.min(0.45 * size.x)).resizable(false).show(ui, |ui| below_ui(app, ui));
        }
    } else {
        if app.dialogs.room.below != Below::Nothing {
            Panel::bottom("below").exact_size(0.45 * ui.available_height()).resizable(false).show(ui, |ui| below_ui(app, ui));
        }
        Panel::bottom("choice").show(ui, |ui| ui.horizontal(|ui| choice_ui(app, ui)));
    }
    middle_ui(app, ui);
}

/// What a small screen shows besides the pane.
fn below_ui(app: &mut App, ui: &mut Ui) {
    match app.dialogs.room.below {
        Below::Sliders => parameters_ui(app, ui),
        Below::Measurements => {
            ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| lists_ui(app, ui));
        }
        Below::Fit => panels::fit_ui(&mut app.split().0, ui),
        Below::Lesson => lesson_ui(app, ui),
        Below::Nothing => {}
    }
}

/// The choice of that, from either end of a line.
fn choice_ui(app: &mut App, ui: &mut Ui) {
    let lesson = app.lessons.open().map(|_| (Below::Lesson, tr!("Lesson")));
    let sides = [
        (Below::Sliders, tr!("Sliders")),
        (Below::Measurements, tr!("Measurements")),
        (Below::Fit, tr!("Fit")),
        (Below::Nothing, tr!("Pane alone")),
    ];
    let mut sides: Vec<(Below, String)> = lesson.into_iter().chain(sides).collect();
    if ui.layout().prefer_right_to_left() {
        sides.reverse();
    }
    for (side, name) in sides {
        ui.selectable_value(&mut app.dialogs.room.below, side, name);
    }
}

/// Widths in points: what the panels have by themselves and at least. Where both at their least leave the plots less than half of the
/// window, one panel is seen at a time.
const PARAMETERS: f32 = 366.0;
const FIT: f32 = 320.0;
const SIDE: f32 = 332.0;
const LEAST_PARAMETERS: f32 = 290.0;
/// With a column of what measurements share.
const LEAST_SHARING: f32 = 320.0;
const LEAST_FIT: f32 = 280.0;
/// What the frames of a panel take besides.
const FRAME: f32 = 20.0;

/// The panels beside the plots, which have half of the window at least.
fn side_panels_ui(app: &mut App, ui: &mut Ui) {
    if app.dock.is_filled() {
        return;
    }
    let width = ui.ctx().content_rect().width();
    let half = 0.5 * width;
    // A lesson without data has nothing to fit.
    let has_fit = app.window.panels.fit && (app.lessons.session.is_none() || app.work.measurements().has_rows());
    let has_parameters = app.window.panels.parameters;
    let least = if app.work.measurements().measured().nth(1).is_some() { LEAST_SHARING } else { LEAST_PARAMETERS };
    if half < least + LEAST_FIT + 2.0 * FRAME {
        if has_parameters || has_fit {
            let panel = Panel::left("side").resizable(false).exact_size(SIDE.min(half - FRAME));
            let side = panel.show(ui, |ui| {
                let is_fit = if has_parameters && has_fit { front_ui(app, ui) == SidePanel::Fit } else { has_fit };
                if is_fit { panels::fit_ui(&mut app.split().0, ui) } else { parameters_ui(app, ui) }
            });
            note_panels(ui.ctx(), [side.response.rect.width(), 0.0]);
        }
        return;
    }
    let (mut left, mut right) = (0.0, 0.0);
    if has_parameters {
        let most = half - FRAME - if has_fit { LEAST_FIT + FRAME } else { 0.0 };
        // What the fit has by itself is left to it, as far as the sliders can do without.
        let usual = if has_fit { (half - FIT - 2.0 * FRAME).clamp(least, PARAMETERS) } else { PARAMETERS.min(most) };
        let panel = Panel::left("parameters").default_size(usual).size_range(usual..=most.max(usual));
        left = panel.show(ui, |ui| parameters_ui(app, ui)).response.rect.width();
    }
    if has_fit {
        let most = (half - left - FRAME).max(LEAST_FIT);
        let panel = Panel::right("fit").default_size(FIT.min(most)).size_range(FIT.min(most)..=most);
        right = panel.show(ui, |ui| panels::fit_ui(&mut app.split().0, ui)).response.rect.width();
    }
    note_panels(ui.ctx(), [left, right]);
}

/// Which of the two panels is seen.
fn front_ui(app: &mut App, ui: &mut Ui) -> SidePanel {
    let front = &mut app.window.panels.front;
    ui.horizontal(|ui| {
        for (panel, name) in [(SidePanel::Parameters, tr!("Parameters")), (SidePanel::Fit, tr!("Fitting"))] {
            let button = ui.selectable_label(*front == panel, &name);
            button.widget_info(|| WidgetInfo::selected(Role::Tab, true, *front == panel, &name));
            if button.clicked() {
                *front = panel;
            }
        }
    });
    *front
}

/// The open measurements and the pinned surfaces.
fn lists_ui(app: &mut App, ui: &mut Ui) {
    let (mut cx, lists) = app.split_lists();
    lists.measurements.ui(&mut cx, ui);
    lists.pinned.ui(&mut cx, ui);
}

fn parameters_ui(app: &mut App, ui: &mut Ui) {
    let has_lists = app.work.measurements().has_rows() || !app.work.pinned().is_empty();
    if has_lists && !app.dialogs.room.is_small {
        Panel::top("measurements").show(ui, |ui| lists_ui(app, ui));
    }
    let mut refusals = Vec::new();
    let ranges = app.lessons.ranges();
    panels::parameters_ui(&mut app.split().0, &mut refusals, &ranges, ui);
    refusals.into_iter().for_each(|sentence| app.toasts.error(sentence));
}
