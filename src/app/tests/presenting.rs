//! Presentation, panels that hide, and the room that plots have.

use crate::app::shell::app::App;
use crate::app::shell::app::logic::logic;
use crate::app::shell::app::open::begin;
use crate::app::shell::app::ui::ui;
use crate::app::storage::settings_file::SettingsFile;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::SidePanel;
use crate::app::work::talk::TalkSlider;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

type Window = Harness<'static, Option<App>>;

/// The window in that size, in points.
fn sized(width: f32, height: f32) -> Window {
    let frame = |screen: &mut egui::Ui, state: &mut Option<App>| {
        let explorer = state.get_or_insert_with(|| {
            let mut explorer = App::new(screen.ctx(), SettingsFile::default());
            begin(&mut explorer);
            explorer
        });
        logic(explorer, &screen.ctx().clone());
        ui(explorer, screen);
    };
    let mut harness = Harness::builder().with_size(vec2(width, height)).build_ui_state(frame, None);
    wait(&mut harness);
    harness
}

fn plot(harness: &Window, name: &str) -> Rect {
    harness.get_by_role_and_label(Role::Image, name).rect()
}

fn act(harness: &mut Window, action: Action) {
    explorer(harness).actions.push(action);
    wait(harness);
}

#[test]
fn a_presentation_shows_the_panes_of_the_screen_without_panels_and_ends_with_escape() {
    let mut harness = harness();
    let before = explorer(&mut harness).dock.open();
    harness.key_press(Key::F11);
    wait(&mut harness);
    assert!(explorer(&mut harness).dock.is_presented());
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Dolp, PaneId::Lobes]);
    assert!(harness.query_by_label("File").is_none() && harness.query_by_label("Reset all parameters").is_none());
    // σ and θi are in the strip; others are chosen.
    harness.get_by_role_and_label(Role::Slider, "σ");
    assert!(harness.query_by_role_and_label(Role::Slider, "n").is_none());
    act(&mut harness, Action::Window(WindowAction::ChooseTalkSlider(TalkSlider::Of(pbrdf::model::Parameter::N))));
    harness.get_by_role_and_label(Role::Slider, "n").set_value_accesskit(1.5);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 1.5);
    // Four at most: the fifth takes the place of the last.
    for pane in [PaneId::Picture, PaneId::Facets, PaneId::PolarLobes] {
        act(&mut harness, Action::Window(WindowAction::ShowPane(pane)));
    }
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Dolp, PaneId::Lobes, PaneId::Picture, PaneId::PolarLobes]);
    for pane in [PaneId::Dolp, PaneId::Lobes, PaneId::Picture, PaneId::PolarLobes] {
        act(&mut harness, Action::Window(WindowAction::ClosePane(pane)));
    }
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::PolarLobes], "one stays");
    harness.key_press(Key::Escape);
    wait(&mut harness);
    assert!(!explorer(&mut harness).dock.is_presented());
    let open = explorer(&mut harness).dock.open();
    assert!(before.iter().all(|pane| open.contains(pane)), "nothing was closed: {open:?}");
    harness.get_by_label("Reset all parameters");
}

#[test]
fn titles_of_vertical_axes_are_whole_in_a_presentation() {
    let mut harness = sized(1280.0, 720.0);
    harness.key_press(Key::F11);
    wait(&mut harness);
    act(&mut harness, Action::Window(WindowAction::ShowPane(PaneId::Landscape)));
    let mut titles = 0;
    for clipped in &harness.output().shapes {
        let egui::Shape::Text(text) = &clipped.shape else { continue };
        if text.angle != 0.0 {
            titles += 1;
            let place = text.visual_bounding_rect();
            assert!(clipped.clip_rect.contains_rect(place), "{}: {place:?} in {:?}", text.galley.text(), clipped.clip_rect);
        }
    }
    assert!(titles >= 3, "{titles}");
}

#[test]
fn the_read_out_says_what_the_model_says_in_the_mirror_direction() {
    let mut harness = harness();
    act(&mut harness, Action::Window(WindowAction::Present));
    let surface = pbrdf::model::Pbrdf::new(explorer(&mut harness).work.surface().model, explorer(&mut harness).work.surface().parameters);
    let facet = pbrdf::optics::Facet::new(pbrdf::optics::Geometry::new(40.0, 40.0, 180.0).expect("a geometry"));
    let dolp = surface.expect("a surface").dolp(&facet);
    harness.get_by_label_contains(&format!("θr = θi = 40°: DoLP = {dolp:.4}"));
    // At the pointer as well.
    harness.hover_at(plot(&harness, "Plot: DoLP against θr").center());
    wait(&mut harness);
    harness.get_by_label_contains("Pointer θr = ");
}

#[test]
fn a_pane_fills_the_window_and_all_is_back_where_it_was() {
    let mut harness = harness();
    let before = explorer(&mut harness).dock.on_screen();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::M);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Dolp]);
    assert!(plot(&harness, "Plot: DoLP against θr").width() > 1100.0);
    harness.get_by_role_and_label(Role::Tab, "Data table").click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Data]);
    harness.get_by_label("Back").click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).dock.on_screen(), [before[0], PaneId::Data]);
    // A pane that fills the window and is closed gives it back.
    act(&mut harness, Action::Window(WindowAction::FillWindow(PaneId::Dolp)));
    act(&mut harness, Action::Window(WindowAction::ClosePane(PaneId::Dolp)));
    assert!(!explorer(&mut harness).dock.is_filled());
}

#[test]
fn panels_hide_and_come_back() {
    let mut harness = harness();
    for (key, panel, label) in [(Key::B, SidePanel::Parameters, "Reset all parameters"), (Key::J, SidePanel::Fit, "Compare models")] {
        let width = plot(&harness, "Plot: DoLP against θr").width();
        harness.key_press_modifiers(Modifiers::COMMAND, key);
        wait(&mut harness);
        assert!(harness.query_by_label(label).is_none());
        assert!(plot(&harness, "Plot: DoLP against θr").width() > width + 200.0);
        act(&mut harness, Action::Window(WindowAction::TogglePanel(panel)));
        harness.get_by_label(label);
    }
}

/// The sizes of the issue in points: 1024 × 640, 1366 × 768 with zoom 1, 1.5 and 2, 1920 × 1080,
/// 3840 × 2160 with zoom 2.
const SIZES: [(f32, f32); 6] =
    [(1024.0, 640.0), (1366.0, 768.0), (1366.0 / 1.5, 512.0), (683.0, 384.0), (1920.0, 1080.0), (1920.0, 1080.0)];

#[test]
fn plots_have_half_of_the_window_at_any_size() {
    for (width, height) in SIZES {
        let mut harness = sized(width, height);
        for _ in 0..2 {
            let dolp = plot(&harness, "Plot: DoLP against θr");
            // The pane around it has the numbers and the title of the axis as well.
            assert!(dolp.width() + 92.0 >= 0.5 * width, "{width} × {height}: {dolp:?}");
            assert!(dolp.height() >= 140.0, "{width} × {height}: {dolp:?}");
            act(&mut harness, Action::StartFit);
        }
    }
}

#[test]
fn a_class_sees_plots_of_600_by_350_pixels_at_zoom_1_5() {
    let mut harness = sized(1366.0 / 1.5, 512.0);
    let pixels = |harness: &Window| 1.5 * plot(harness, "Plot: DoLP against θr").size();
    let size = pixels(&harness);
    assert!(size.x >= 600.0 && size.y >= 350.0, "{size:?}");
    // The harness is in points already.
    explorer(&mut harness).window.talk.zoom = 1.0;
    // What is seen is presented: in so low a window one pane.
    act(&mut harness, Action::Window(WindowAction::Present));
    let size = pixels(&harness);
    assert!(size.x >= 1190.0 && size.y >= 350.0, "{size:?}");
    act(&mut harness, Action::Window(WindowAction::ShowPane(PaneId::Lobes)));
    let size = pixels(&harness);
    assert!(size.x >= 500.0 && size.y >= 350.0, "two panes: {size:?}");
}

#[test]
fn in_a_talk_the_picture_has_the_room_of_its_controls_which_are_in_its_menu() {
    let mut harness = sized(1366.0 / 1.5, 512.0);
    explorer(&mut harness).window.talk.zoom = 1.0;
    act(&mut harness, Action::Window(WindowAction::ShowPane(PaneId::Picture)));
    harness.get_by_label("Relief");
    assert!(harness.query_by_label("Show in Picture").is_none(), "nothing is there twice");
    act(&mut harness, Action::Window(WindowAction::Present));
    act(&mut harness, Action::Window(WindowAction::ShowPane(PaneId::Lobes)));
    assert!(harness.query_by_label("Relief").is_none());
    let sphere = plot(&harness, "Picture: Radiance");
    assert!(sphere.height() > 300.0, "{sphere:?}");
    harness.get_by_label("Show in Picture").click();
    wait(&mut harness);
    harness.get_by_label("Relief").click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.settings().panes.picture.shape, pbrdf::model::Shape::Relief);
}

#[test]
fn nothing_is_smaller_in_a_talk_than_in_the_window() {
    let mut harness = sized(3840.0, 2160.0);
    harness.ctx.set_zoom_factor(2.0);
    wait(&mut harness);
    act(&mut harness, Action::Window(WindowAction::Present));
    assert_eq!(harness.ctx.zoom_factor(), 2.0);
    act(&mut harness, Action::Window(WindowAction::Present));
    assert_eq!(harness.ctx.zoom_factor(), 2.0);
}

#[test]
fn the_text_of_a_lesson_folds_and_plots_have_its_room() {
    let mut harness = harness();
    act(&mut harness, Action::ShowStep(0, 0));
    let before = plot(&harness, "Plot: DoLP against θr").height();
    assert!(harness.query_by_label("Watch").is_some());
    harness.get_by_label("Only the plots, without the text").click();
    wait(&mut harness);
    assert!(harness.query_by_label("Watch").is_none());
    assert!(plot(&harness, "Plot: DoLP against θr").height() > before + 20.0);
    harness.get_by_label("Next step");
    harness.get_by_label("Show the text").click();
    wait(&mut harness);
    assert_eq!(plot(&harness, "Plot: DoLP against θr").height(), before);
}

#[test]
fn icons_of_the_menu_bar_order_what_they_say() {
    let mut harness = harness();
    let before = explorer(&mut harness).work.surface().parameters;
    harness.get_by_role_and_label(Role::Slider, "n").set_value_accesskit(1.5);
    wait(&mut harness);
    harness.get_by_label("Undo the last step").click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters, before);
    harness.get_by_label("Redo the last step").click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 1.5);
    harness.get_by_label("Panel of fits beside the plots").click();
    wait(&mut harness);
    assert!(!explorer(&mut harness).window.panels.fit);
    harness.get_by_label_contains("Presentation (F11)").click();
    wait(&mut harness);
    assert!(explorer(&mut harness).dock.is_presented());
}

#[test]
fn in_a_low_window_one_pane_is_seen_at_a_time() {
    let mut harness = sized(1366.0, 480.0);
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Dolp]);
    harness.get_by_role_and_label(Role::Tab, "Lobes").click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Lobes]);
    harness.set_size(vec2(1366.0, 768.0));
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Dolp, PaneId::Lobes]);
}

#[test]
fn residuals_follow_the_plot_above_them() {
    let mut harness = harness();
    let seen = |harness: &mut Window| explorer(harness).views.get::<crate::app::views::DolpView>().seen();
    let [above, strip] = seen(&mut harness);
    assert_eq!(above, strip);
    let at = plot(&harness, "Plot: DoLP against θr").center();
    harness.drag_at(at);
    harness.run();
    harness.hover_at(at + vec2(-80.0, 0.0));
    harness.run();
    harness.drop_at(at + vec2(-80.0, 0.0));
    wait(&mut harness);
    let [moved, strip] = seen(&mut harness);
    assert!(moved != above, "{moved:?}");
    assert_eq!(moved, strip);
}
