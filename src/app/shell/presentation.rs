//! The presentation: full screen, large, the panes of the talk over a strip with its sliders, what the
//! model says at the pointer and in the mirror direction, and the spotlight of the pointer.

use crate::app::panels;
use crate::app::panels::DirectionAngle;
use crate::app::shell::app::App;
use crate::app::shell::lesson_ui::lesson_and_panes_ui;
use crate::app::shell::readout_ui::readout_ui;
use crate::app::text::i18n::translated;
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::spec;
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use crate::app::work::talk::TalkSlider;
use egui::{CentralPanel, Color32, Frame, Mesh, Panel, Slider, Ui, ViewportCommand, vec2};
use tr::tr;

/// Begins the presentation, or ends it.
pub fn toggle(app: &mut App, ctx: &egui::Context) {
    let begins = !app.dock.is_presented();
    match (begins, app.lessons.open()) {
        (true, None) => app.dock.present(),
        // A lesson speaks of all its panes.
        (true, Some(_)) => app.dock.present_all(),
        _ => app.dock.leave_stage(),
    }
    // On a screen of small pixels nothing becomes smaller in a talk.
    ctx.set_zoom_factor(if begins { app.window.talk.zoom.max(app.window.zoom) } else { app.window.zoom });
    ctx.send_viewport_cmd(ViewportCommand::Fullscreen(begins));
}

/// The window while panes are presented.
pub fn presentation_ui(app: &mut App, ui: &mut Ui) {
    Panel::bottom("talk").show(ui, |ui| {
        ui.add_space(4.0);
        strip_ui(app, ui);
        readout_ui(&app.derived, ui);
        ui.add_space(2.0);
    });
    CentralPanel::default().frame(Frame::central_panel(ui.style()).inner_margin(2)).show(ui, |ui| lesson_and_panes_ui(app, ui));
    if app.window.talk.spotlight {
        spotlight(ui);
    }
}

/// Width of a slider, in points, as far as there is room.
const SLIDER: [f32; 2] = [70.0, 220.0];
/// What name and value of a slider take.
const BESIDE_SLIDER: f32 = 150.0;
/// What the buttons take.
const BUTTONS: f32 = 250.0;

/// The sliders of the talk, and the menus that choose them and the panes.
fn strip_ui(app: &mut App, ui: &mut Ui) {
    let sliders: Vec<TalkSlider> = sliders(app);
    #[expect(clippy::cast_precision_loss, reason = "a number of sliders")]
    let share = (ui.available_width() - BUTTONS) / sliders.len().max(1) as f32 - BESIDE_SLIDER;
    let width = share.clamp(SLIDER[0], SLIDER[1]);
    ui.horizontal_wrapped(|ui| {
        for slider in sliders {
            // Name, slider and value stay together at the end of a line.
            ui.horizontal(|ui| slider_ui(app, slider, width, ui));
            ui.add_space(8.0);
        }
        ui.menu_button(tr!("Panes"), |ui| panes_menu_ui(app, ui)).response.on_hover_text(tr!("At most four at a time"));
        ui.menu_button(tr!("Sliders"), |ui| sliders_menu_ui(app, ui)).response.on_hover_text(tr!("Those of the talk"));
        let mut spotlight = app.window.talk.spotlight;
        if ui.toggle_value(&mut spotlight, tr!("Spotlight")).on_hover_text(tr!("Dims all but the surroundings of the pointer")).changed() {
            app.actions.push(Action::Window(WindowAction::ToggleSpotlight));
        }
        if ui.button(tr!("Leave")).on_hover_text(tr!("Also with Escape or F11")).clicked() {
            app.actions.push(Action::Window(WindowAction::Present));
        }
    });
}

/// Those that were chosen, and those that the open lesson speaks of.
fn sliders(app: &App) -> Vec<TalkSlider> {
    let of_lesson = app.lessons.current().map(|(_, step)| step.sliders()).filter(|sliders| !sliders.is_empty());
    let all = of_lesson.unwrap_or_else(|| app.window.talk.sliders.clone());
    let has = app.work.surface().model.parameters();
    all.into_iter().filter(|slider| !matches!(slider, TalkSlider::Of(parameter) if !has.contains(*parameter))).collect()
}

fn panes_menu_ui(app: &mut App, ui: &mut Ui) {
    let shown = app.dock.on_screen();
    for pane in PaneId::ALL.iter().copied() {
        let is_shown = shown.contains(&pane);
        if ui.selectable_label(is_shown, translated(spec(pane).title)).on_hover_text(translated(spec(pane).tooltip)).clicked() {
            app.actions.push(Action::Window(if is_shown { WindowAction::ClosePane(pane) } else { WindowAction::ShowPane(pane) }));
        }
    }
}

fn sliders_menu_ui(app: &mut App, ui: &mut Ui) {
    for slider in TalkSlider::all() {
        let mut is_chosen = app.window.talk.sliders.contains(&slider);
        if ui.checkbox(&mut is_chosen, translated(slider.symbol())).changed() {
            app.actions.push(Action::Window(WindowAction::ChooseTalkSlider(slider)));
        }
    }
}

/// Width of a value, in points.
const VALUE: f32 = 84.0;

fn slider_ui(app: &mut App, slider: TalkSlider, width: f32, ui: &mut Ui) {
    match slider {
        TalkSlider::Of(parameter) => {
            let mut surface = app.work.surface().clone();
            let mut refusals = Vec::new();
            let range = app.lessons.ranges()[parameter].clone();
            let fit = app.work.shown_fit().map(|fit| &fit.report);
            panels::slider_ui(&mut surface, &mut refusals, range, [width, VALUE], fit, ui, parameter);
            if surface != *app.work.surface() {
                app.edits.push(Edit::SetSurface(Box::new(surface)));
            }
            refusals.into_iter().for_each(|sentence| app.toasts.error(sentence));
        }
        TalkSlider::ThetaI | TalkSlider::Dphi => {
            let (mut theta_i, mut dphi) = (app.work.settings().theta_i, app.work.settings().dphi);
            match slider {
                TalkSlider::ThetaI => panels::angle_ui(DirectionAngle::ThetaI, &mut theta_i, width, ui),
                _ => panels::angle_ui(DirectionAngle::Dphi, &mut dphi, width, ui),
            }
            if (theta_i, dphi) != (app.work.settings().theta_i, app.work.settings().dphi) {
                app.edits.push(Edit::SetDirection { theta_i, dphi });
            }
        }
        TalkSlider::Lamp | TalkSlider::Analyser => {
            let mut picture = app.work.settings().panes.picture;
            let (value, high) = if slider == TalkSlider::Lamp { (&mut picture.polar, 179.0) } else { (&mut picture.analyser, 180.0) };
            let label = panels::name_ui(ui, &translated(slider.symbol()), &tr!("Degrees, in the pane Picture"));
            ui.spacing_mut().slider_width = width;
            let slider = Slider::new(value, 0.0..=high).step_by(0.5).suffix("°").clamping(egui::SliderClamping::Never);
            ui.add(slider).labelled_by(label.id);
            if picture != app.work.settings().panes.picture {
                app.edits.push(Edit::SetPictureOptions(picture));
            }
        }
    }
}

/// Radius of the light, and of its soft edge, in points.
const LIGHT: f32 = 130.0;
const EDGE: f32 = 24.0;
/// How dark it is around it, of 255.
const DARK: u8 = 150;
/// Corners of its circle.
const CORNERS: u32 = 64;

/// Dims all but the surroundings of the pointer.
fn spotlight(ui: &Ui) {
    let Some(at) = ui.ctx().pointer_hover_pos() else { return };
    let screen = ui.ctx().content_rect();
    let far = screen.width() + screen.height();
    let mut mesh = Mesh::default();
    let dark = Color32::from_black_alpha(DARK);
    for i in 0..=CORNERS {
        #[expect(clippy::cast_precision_loss, reason = "a number of corners")]
        let angle = std::f32::consts::TAU * i as f32 / CORNERS as f32;
        let direction = vec2(angle.cos(), angle.sin());
        let mut corner = |radius: f32, color| mesh.colored_vertex(at + radius * direction, color);
        corner(LIGHT, Color32::TRANSPARENT);
        corner(LIGHT + EDGE, dark);
        corner(far, dark);
    }
    for i in 0..CORNERS {
        for ring in 0..2 {
            let [a, b] = [3 * i + ring, 3 * (i + 1) + ring];
            mesh.add_triangle(a, a + 1, b);
            mesh.add_triangle(b, a + 1, b + 1);
        }
    }
    // Over the plots, under menus and tooltips.
    let layer = egui::LayerId::new(egui::Order::Middle, egui::Id::unique("spotlight"));
    ui.ctx().layer_painter(layer).add(mesh);
}
