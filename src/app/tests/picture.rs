//! The pane Picture: what it shows, what the pointer does on it, and when nothing is made.

use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::{PickedDirection, PictureView};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use crate::app::work::picture_options::{PictureCompanion, PictureOptions};
use crate::report::PictureQuantity;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::{Lamp, Pbrdf};
use pbrdf::optics::Facet;

fn shown() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Picture)));
    wait(&mut harness);
    harness
}

fn rect(harness: &Harness<'static, Option<App>>) -> egui::Rect {
    harness.get_by_role_and_label(Role::Image, "Picture: Radiance").rect()
}

fn picture(harness: &mut Harness<'static, Option<App>>) -> PictureOptions {
    explorer(harness).work.settings().panes.picture
}

#[test]
fn a_pixel_is_what_the_model_says_and_a_click_takes_its_angles() {
    let mut harness = shown();
    let rect = rect(&harness);
    // A quarter to the right of the middle and a quarter down.
    let at = rect.center() + 0.25 * rect.size() * 0.5;
    harness.hover_at(at);
    harness.run();
    harness.get_by_label_contains("S0 = ");
    let surface = explorer(&mut harness).work.surface().clone();
    let surface = Pbrdf::new(surface.model, surface.parameters).expect("the defaults");
    let options = picture(&mut harness);
    let scene = explorer(&mut harness).views.get::<PictureView>().scene().expect("a picture").clone();
    let (row, column) = (320, 320);
    let lamp = Lamp::new(options.polar, options.azimuth).expect("a direction");
    let geometry = lamp.geometry(scene.picture.normal(row, column).expect("a surface")).expect("lit");
    let expected = surface.reflection(&Facet::new(geometry)).brdf * geometry.theta_i().cos();
    let found = scene.image.at(row, column).expect("a surface").0[0];
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    harness.drag_at(at);
    harness.drop_at(at);
    wait(&mut harness);
    let settings = explorer(&mut harness).work.settings().clone();
    // One pixel of the screen more or less.
    assert!((settings.theta_i - geometry.theta_i().0).abs() < 1.0, "{} {geometry:?}", settings.theta_i);
    assert_eq!(settings.panes.picture.polar, options.polar, "a click leaves the lamp where it is");
}

#[test]
fn the_lamp_is_dragged_and_the_picture_follows() {
    let mut harness = shown();
    let rect = rect(&harness);
    harness.drag_at(rect.center());
    harness.step();
    let side = 0.5 * rect.width();
    // The highlight half-way to the right: its facets tilt by 30°, the lamp by 60°.
    harness.hover_at(rect.center() + egui::vec2(0.5 * side, 0.0));
    harness.step();
    harness.step();
    harness.drop_at(rect.center() + egui::vec2(0.5 * side, 0.0));
    wait(&mut harness);
    let options = picture(&mut harness);
    assert!((options.polar - 60.0).abs() < 2.0 && options.azimuth.abs() < 2.0, "{options:?}");
    let lamp = explorer(&mut harness).views.get::<PictureView>().scene().and_then(|scene| scene.key.lamp).expect("a lamp");
    assert_eq!((lamp.polar().0, lamp.azimuth().0), (options.polar, options.azimuth));
    harness.step();
    assert!(!explorer(&mut harness).views.get::<PictureView>().is_running(), "no work when idle");
}

#[test]
fn two_surfaces_stand_side_by_side_and_pictures_are_exported() {
    let mut harness = shown();
    let options = PictureOptions {
        companion: PictureCompanion::OtherDistribution,
        quantity: PictureQuantity::Dolp,
        sky: true,
        ..PictureOptions::default()
    };
    edit(&mut harness, Edit::SetPictureOptions(options));
    let scene = explorer(&mut harness).views.get::<PictureView>().scene().expect("a picture").clone();
    assert!(scene.other.is_some_and(|other| other != scene.image));
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["a.exr", "a.png", "a.csv"] {
        let path = folder.path().join(name);
        ExportKind::Picture.snapshot(&explorer(&mut harness).work, None).expect("a picture")(&path).expect("a file");
        assert!(std::fs::metadata(&path).expect("a file").len() > 1000, "{name}");
    }
    assert!(ExportKind::Picture.check(std::path::Path::new("a.svg")).is_err());
    // A pin that is gone leaves the sliders alone.
    edit(&mut harness, Edit::SetPictureOptions(PictureOptions { companion: PictureCompanion::Pinned(3), ..options }));
    let scene = explorer(&mut harness).views.get::<PictureView>().scene().expect("a picture").clone();
    assert_eq!(scene.other, None);
}

#[test]
fn no_picture_is_made_of_values_that_are_no_surface_and_damaged_settings_are_refused() {
    let mut harness = shown();
    explorer(&mut harness).work.surface_mut().parameters.sigma = f64::NAN;
    wait(&mut harness);
    assert!(explorer(&mut harness).views.get::<PictureView>().scene().is_none());
    let mut settings = explorer(&mut harness).work.settings().clone();
    assert!(settings.validate().is_ok());
    settings.panes.picture.polar = 200.0;
    assert!(settings.validate().is_err());
}

#[test]
fn a_picked_direction_is_marked_in_every_plot_against_the_angle_of_view() {
    let mut harness = harness();
    let picked = PickedDirection { theta_i: 40.0, theta_r: 25.0, dphi: 180.0 };
    explorer(&mut harness).work.apply(Edit::SetDirection { theta_i: picked.theta_i, dphi: picked.dphi });
    explorer(&mut harness).actions.push(Action::MarkDirection(picked));
    let panes = [
        PaneId::Dolp,
        PaneId::Lobes,
        PaneId::PolarLobes,
        PaneId::Facets,
        PaneId::Hemisphere,
        PaneId::ResidualsAgainstAngle,
        PaneId::Planner,
    ];
    for pane in panes {
        explorer(&mut harness).actions.push(Action::Window(WindowAction::FillWindow(pane)));
        wait(&mut harness);
        let figure = explorer(&mut harness).figure(pane).unwrap_or_else(|| panic!("{pane:?}: no figure"));
        assert!(figure.panels.iter().flat_map(|panel| &panel.series).any(|series| series.name == "pixel of the picture"), "{pane:?}");
        explorer(&mut harness).actions.push(Action::Window(WindowAction::FillWindow(pane)));
        wait(&mut harness);
    }
    explorer(&mut harness).actions.push(Action::Window(WindowAction::FillWindow(PaneId::Mueller)));
    wait(&mut harness);
    let figure = explorer(&mut harness).figure(PaneId::Mueller).expect("a figure");
    assert!(figure.panels[0].title.contains("θr = 25.0°"), "{}", figure.panels[0].title);
}

#[test]
fn two_halves_are_presented_with_their_names_in_five_steps() {
    let mut harness = harness();
    // 1366 × 768 pixels at zoom 1.5, as the program starts for the first time.
    harness.set_size(egui::vec2(1366.0 / 1.5, 512.0));
    explorer(&mut harness).window.talk.zoom = 1.0;
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowTour(0)));
    wait(&mut harness);
    harness.key_press(egui::Key::Escape);
    wait(&mut harness);
    for (role, name) in [(Role::Tab, "Picture"), (Role::ComboBox, "Beside it"), (Role::Button, "Gauss, equal median slope")] {
        harness.get_by_role_and_label(role, name).click();
        wait(&mut harness);
    }
    harness.key_press(egui::Key::F11);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).dock.on_screen(), [PaneId::Picture]);
    assert!(1.5 * rect(&harness).height() >= 350.0, "{}", rect(&harness));
    let drawn = |name: &str| {
        harness.output().shapes.iter().any(|clipped| matches!(&clipped.shape, egui::Shape::Text(text) if text.galley.text() == name))
    };
    assert!(drawn("Cauchy") && drawn("Gauss"));
}
