//! The tour of the first start: four things in four steps, each where it is; skipped with one key.

use crate::app::shell::app::App;
use crate::app::text::i18n::translated;
use crate::app::views::action::{Action, WindowAction};
use egui::{Align2, Label, Pos2, Rect, Role, Stroke, StrokeKind, Ui, WidgetInfo, vec2};
use tr::tr;

/// Where a step points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Spot {
    Parameters,
    Plots,
    Fit,
    Menus,
}

/// What is pointed at, and what is said of it.
const STEPS: [(Spot, &str, &str); 4] = [
    (
        Spot::Parameters,
        "Sliders",
        "The nine parameters of the surface. Drag one and watch: every plot follows. A value can be typed, and a double click brings it back.",
    ),
    (
        Spot::Plots,
        "Plots",
        "DoLP and the lobes against the angle of view, beside them the picture that a polarisation camera would see. A double click on a tab lets it fill the window.",
    ),
    (Spot::Fit, "Fit", "Open a file, or drop it on the window; then Fit finds the values, and says how well the data determine them."),
    (
        Spot::Menus,
        "Lessons and talks",
        "Lessons are guided experiments; your own work comes back after each. F11 presents the plots to a class. Ctrl+Shift+P finds every command.",
    ),
];

/// Width of what is said, in points.
const WIDTH: f32 = 340.0;

fn widths() -> egui::Id {
    egui::Id::unique("widths of the panels that the tour points at")
}

/// Notes how wide the panels at the left and at the right are.
pub fn note_panels(ctx: &egui::Context, panels: [f32; 2]) {
    ctx.data_mut(|data| data.insert_temp(widths(), panels));
}

/// The step that is shown, while the tour is.
pub fn tour_ui(app: &mut App, ui: &mut Ui) {
    // A talk and a page of a course have not the panels that the tour points at; under a dialog it would hold the keys.
    if app.dock.is_presented() || app.dialogs.room.embedded.is_some() || app.dialogs.is_asking() {
        return;
    }
    let Some((step, (spot, heading, text))) = app.dialogs.tour.and_then(|step| Some((step, *STEPS.get(step)?))) else { return };
    let screen = ui.ctx().content_rect();
    let panels = ui.ctx().data(|data| data.get_temp(widths())).unwrap_or_default();
    let rect = place(spot, panels, screen);
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("tour spot"));
    let accent = ui.visuals().selection.bg_fill;
    ui.ctx().layer_painter(layer).rect_stroke(rect.shrink(3.0), 6.0, Stroke::new(3.0, accent), StrokeKind::Inside);
    let at = middle(rect, screen);
    let area = egui::Area::new(egui::Id::unique("tour")).order(egui::Order::Foreground).pivot(Align2::CENTER_CENTER).fixed_pos(at);
    area.constrain_to(screen.shrink(8.0)).show(ui.ctx(), |ui| {
        let frame = egui::Frame::popup(ui.style()).inner_margin(12).stroke(Stroke::new(1.0, accent));
        frame.show(ui, |ui| {
            ui.set_width(WIDTH.min(screen.width() - 60.0));
            ui.horizontal(|ui| {
                ui.heading(translated(heading));
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.weak(format!("{}/{}", step + 1, STEPS.len())));
            });
            let text = translated(text);
            let said = ui.add(Label::new(&text).wrap());
            said.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
            ui.add_space(4.0);
            ui.horizontal(|ui| {
                let is_last = step + 1 == STEPS.len();
                let next = ui.button(if is_last { tr!("Done") } else { tr!("Next") });
                if ui.memory(|memory| memory.focused().is_none()) {
                    next.request_focus();
                }
                if next.clicked() {
                    app.actions.push(if is_last {
                        Action::Window(WindowAction::EndTour)
                    } else {
                        Action::Window(WindowAction::ShowTour(step + 1))
                    });
                }
                if step > 0 && ui.button(tr!("Previous")).clicked() {
                    app.actions.push(Action::Window(WindowAction::ShowTour(step - 1)));
                }
                if !is_last && ui.button(tr!("Skip the tour")).on_hover_text(tr!("Help shows it again")).clicked() {
                    app.actions.push(Action::Window(WindowAction::EndTour));
                }
            });
        });
    });
}

/// What a step frames.
fn place(spot: Spot, [left, right]: [f32; 2], screen: Rect) -> Rect {
    const BAR: f32 = 25.0;
    // About as far as the menus reach.
    const MENUS: f32 = 366.0;
    let body = Rect::from_min_max(screen.min + vec2(0.0, BAR), screen.max - vec2(0.0, BAR));
    match spot {
        Spot::Parameters => Rect::from_min_max(body.min, Pos2::new(body.min.x + left, body.max.y)),
        Spot::Plots => Rect::from_min_max(Pos2::new(body.min.x + left, body.min.y), Pos2::new(body.max.x - right, body.max.y)),
        // Where there is room for one panel, the fit is behind its name at the top.
        Spot::Fit if right == 0.0 => Rect::from_min_size(body.min, vec2(left, 2.0 * BAR)),
        Spot::Fit => Rect::from_min_max(Pos2::new(body.max.x - right, body.min.y), body.max),
        Spot::Menus => Rect::from_min_size(screen.min, vec2(MENUS, BAR + 2.0)),
    }
}

/// Where the words stand: beside what they speak of.
fn middle(rect: Rect, screen: Rect) -> Pos2 {
    let y = if rect.height() < 100.0 { rect.bottom() + 110.0 } else { rect.center().y };
    let x = match () {
        () if rect.width() > WIDTH + 100.0 => rect.center().x,
        () if rect.left() <= screen.left() => rect.right() + 0.5 * WIDTH + 30.0,
        () => rect.left() - 0.5 * WIDTH - 30.0,
    };
    Pos2::new(x, y)
}
