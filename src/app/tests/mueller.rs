//! The Mueller matrix: the numbers at the chosen θr, and how it is chosen.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::model::Pbrdf;
use pbrdf::optics::{Geometry, Mueller};

fn shown() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Mueller)));
    wait(&mut harness);
    harness
}

/// What is said of the table.
fn spoken(harness: &Harness<'static, Option<App>>) -> String {
    harness.get_by_label_contains("Mueller matrix over m00").accesskit_node().label().expect("found by it")
}

/// The sixteen numbers of it.
fn numbers(spoken: &str) -> Vec<f64> {
    let (_, table) = spoken.split_once(": ").expect("a title and a table");
    table.split([' ', ';']).filter(|text| !text.is_empty()).map(|text| text.replace('−', "-").parse().expect("a number")).collect()
}

fn expected(explorer: &App, theta_r: f64, dphi: f64) -> Mueller {
    let (settings, surface) = (explorer.work.settings(), explorer.work.surface());
    let surface = Pbrdf::new(surface.model, surface.parameters).expect("the defaults");
    surface.mueller(Geometry::new(settings.theta_i, theta_r, dphi).expect("angles"))
}

fn assert_shows(harness: &mut Harness<'static, Option<App>>, theta_r: f64, dphi: f64) {
    let spoken = spoken(harness);
    assert!(spoken.contains(&format!("θr = {theta_r:.1}°")), "{spoken}");
    let matrix = expected(explorer(harness), theta_r, dphi);
    for (element, shown) in numbers(&spoken).into_iter().enumerate() {
        let value = matrix.element(element / 4, element % 4) / matrix.element(0, 0);
        // Three decimals are shown.
        assert!((shown - value).abs() <= 5.1e-4, "{element}: {shown} {value}");
    }
}

#[test]
fn the_table_holds_the_model_at_the_mirror_and_at_a_typed_angle() {
    let mut harness = shown();
    let theta_i = explorer(&mut harness).work.settings().theta_i;
    assert_shows(&mut harness, theta_i, 180.0);
    harness.get_by_role_and_label(Role::SpinButton, "θr").set_value_accesskit(62.5);
    harness.run();
    assert_shows(&mut harness, 62.5, 180.0);
}

#[test]
fn it_follows_the_sliders_out_of_the_plane_of_incidence() {
    let mut harness = shown();
    harness.get_by_role_and_label(Role::SpinButton, "θr").set_value_accesskit(50.0);
    harness.run();
    let m20 = |harness: &Harness<'static, Option<App>>| numbers(&spoken(harness))[8];
    assert_eq!(m20(&harness), 0.0, "in the plane nothing is turned");
    explorer(&mut harness).work.settings_mut().dphi = 120.0;
    explorer(&mut harness).work.surface_mut().parameters.k = 6.0;
    harness.run();
    assert_shows(&mut harness, 50.0, 120.0);
    assert!(m20(&harness).abs() > 0.01);
    // The other side of that plane.
    explorer(&mut harness).work.settings_mut().show_backscatter = true;
    harness.run();
    harness.get_by_role_and_label(Role::SpinButton, "θr").set_value_accesskit(-20.0);
    harness.run();
    let spoken = spoken(&harness);
    assert!(spoken.contains("θr = -20.0°"), "{spoken}");
    let matrix = expected(explorer(&mut harness), 20.0, -60.0);
    assert!((numbers(&spoken)[1] - matrix.element(0, 1) / matrix.element(0, 0)).abs() <= 5.1e-4);
}

#[test]
fn the_pointer_over_the_curves_chooses_the_angle_and_it_stays() {
    let mut harness = shown();
    let rect = harness.get_by_label_contains("Mueller matrix over m00").rect();
    let before = spoken(&harness);
    harness.hover_at(rect.left_center() + egui::vec2(60.0, -20.0));
    harness.run();
    let after = spoken(&harness);
    assert_ne!(before, after);
    harness.hover_at(egui::pos2(100.0, 700.0));
    harness.run();
    assert_eq!(spoken(&harness), after);
}
