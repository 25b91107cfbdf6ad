//! The hemisphere map: what the pointer reads, what is made when, and what is not.

use crate::app::shell::app::App;
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::views::action::{Action, ListAction, WindowAction};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::{Compared, HemisphereQuantity};
use crate::app::work::surface::Surface;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::model::Pbrdf;
use pbrdf::optics::{Facet, Geometry};

fn shown() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Hemisphere)));
    wait(&mut harness);
    harness
}

/// What the line under the map says with the pointer there.
fn reading(harness: &mut Harness<'static, Option<App>>, at: egui::Pos2) -> Option<String> {
    harness.hover_at(at);
    harness.run();
    let lines: Vec<String> =
        harness.query_all_by_label_contains("Δφ = ").filter_map(|node| node.accesskit_node().label().or(node.value())).collect();
    lines.into_iter().find(|line| line.starts_with("θr = "))
}

#[test]
fn the_map_shows_how_the_sliders_differ_from_a_pinned_surface() {
    let mut harness = shown();
    let choice = "What the map is compared to";
    assert!(harness.query_by_role_and_label(Role::ComboBox, choice).is_none(), "there is nothing to compare to");
    explorer(&mut harness).actions.push(Action::List(ListAction::PinSliders));
    explorer(&mut harness).actions.push(Action::List(ListAction::PinSliders));
    wait(&mut harness);
    let before = explorer(&mut harness).work.surface().clone();
    explorer(&mut harness).work.surface_mut().parameters.sigma *= 1.5;
    wait(&mut harness);
    harness.get_by_role_and_label(Role::ComboBox, choice).click();
    harness.run();
    let name = explorer(&mut harness).work.pinned()[1].name.clone();
    harness.get_by_label(&format!("less {name}")).click();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.settings().view_options.hemisphere_less, Some(Compared::Pin(1)));
    let rect = harness.get_by_role_and_label(Role::Image, "Map of all directions of view: DoLP").rect();
    let line = reading(&mut harness, rect.center() + egui::vec2(30.0, 10.0)).expect("a place on the disc");
    let (place, value) = line.split_once(": difference in DoLP = ").expect("a difference");
    let (theta_r, dphi) = place.split_once(", ").expect("two angles");
    let number =
        |text: &str| -> f64 { text.chars().filter(|c| c.is_ascii_digit() || *c == '.').collect::<String>().parse().expect("a number") };
    let theta_i = explorer(&mut harness).work.settings().theta_i;
    let dolp = |surface: &Surface| {
        let geometry = Geometry::new(theta_i, number(theta_r), number(dphi)).expect("angles");
        Pbrdf::new(surface.model, surface.parameters).expect("a surface").reflection(&Facet::new(geometry)).dolp
    };
    let expected = dolp(explorer(&mut harness).work.surface()) - dolp(&before);
    // Angles are read to a hundredth of a degree, DoLP to five digits.
    assert!((value.parse::<f64>().expect("a number") - expected).abs() < 2e-4 && expected != 0.0, "{line}: {expected}");
    let figure = explorer(&mut harness).figure(PaneId::Hemisphere).expect("a map");
    assert!(figure.panels[0].title.contains(&format!("less {name}")), "{}", figure.panels[0].title);
    // The place of the surface moves up, and with the surface the comparison is gone.
    edit(&mut harness, Edit::Unpin(0));
    assert_eq!(explorer(&mut harness).work.settings().view_options.hemisphere_less, Some(Compared::Pin(0)));
    edit(&mut harness, Edit::Unpin(0));
    assert_eq!(explorer(&mut harness).work.settings().view_options.hemisphere_less, None);
}

/// θr, Δφ and the value of such a line.
fn numbers(line: &str) -> [f64; 3] {
    let number = |text: &str| -> f64 {
        text.chars().filter(|c| c.is_ascii_digit() || "-.e".contains(*c)).collect::<String>().parse().expect("a number")
    };
    let (place, value) = line.split_once(": ").expect("a place and a value");
    let (theta_r, dphi) = place.split_once(", ").expect("two angles");
    let value = value.split_once("= ").expect("a value").1.replace(" sr⁻¹", "");
    [theta_r, dphi, &value].map(number)
}

#[test]
fn the_pointer_reads_what_the_model_gives_there() {
    let mut harness = shown();
    let rect = harness.get_by_role_and_label(Role::Image, "Map of all directions of view: DoLP").rect();
    for (button, quantity) in [
        ("DoLP", HemisphereQuantity::Dolp),
        ("Angle of polarisation", HemisphereQuantity::Angle),
        ("BRDF", HemisphereQuantity::Brdf),
        ("Specular share", HemisphereQuantity::SpecularShare),
    ] {
        // A tab may have the same name; it comes first.
        harness.query_all_by_role_and_label(Role::Button, button).last().expect("a choice").click();
        harness.run();
        assert_eq!(explorer(&mut harness).work.settings().view_options.hemisphere, quantity);
        let mut read = 0;
        for (right, down) in [(-60.0, -20.0), (-30.0, 40.0), (10.0, -50.0), (-80.0, 5.0)] {
            let Some(line) = reading(&mut harness, rect.center() + egui::vec2(right, down)) else { continue };
            let [theta_r, dphi, value] = numbers(&line);
            let (settings, surface) = explorer(&mut harness).work.values();
            let surface = Pbrdf::new(surface.model, surface.parameters).expect("the defaults");
            let geometry = Geometry::new(settings.theta_i, theta_r, dphi).expect("inside the disc");
            let reflection = surface.reflection(&Facet::new(geometry));
            let expected = match quantity {
                HemisphereQuantity::Dolp => reflection.dolp,
                HemisphereQuantity::Angle => {
                    let mueller = surface.mueller(geometry);
                    0.5 * libm::atan2(mueller.element(2, 0), mueller.element(1, 0)).to_degrees()
                }
                HemisphereQuantity::Brdf => reflection.brdf,
                HemisphereQuantity::SpecularShare => reflection.specular / reflection.brdf,
            };
            // Angles are read to 0.01°, over which nothing here changes by more than some
            // thousandths of itself.
            assert!((value - expected).abs() < 5e-3 * expected.abs().max(1e-2), "{line}: {expected}");
            read += 1;
        }
        assert!(read >= 3, "{read}");
    }
    assert_eq!(reading(&mut harness, rect.left_top() + egui::vec2(2.0, 2.0)), None, "outside the disc");
}

/// What happens before a frame, without the frame.
fn logic(harness: &mut Harness<'static, Option<App>>) {
    let ctx = harness.ctx.clone();
    crate::app::shell::app::logic::logic(explorer(harness), &ctx);
}

#[test]
fn the_map_follows_a_slider_and_rests_when_nothing_moves() {
    let mut harness = shown();
    let before = explorer(&mut harness).views.get::<crate::app::views::HemisphereView>().key().copied().expect("a map");
    logic(&mut harness);
    assert!(!explorer(&mut harness).views.get::<crate::app::views::HemisphereView>().is_fresh(), "an idle frame changes no texture");
    harness.get_by_role_and_label(Role::Slider, "k").set_value_accesskit(4.5);
    // The slider moves in one frame, the job begins before the next.
    harness.step();
    logic(&mut harness);
    while explorer(&mut harness).jobs.spawner.is_busy() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    logic(&mut harness);
    assert!(explorer(&mut harness).views.get::<crate::app::views::HemisphereView>().is_fresh(), "another surface, another texture");
    let after = explorer(&mut harness).views.get::<crate::app::views::HemisphereView>().key().copied().expect("a map");
    assert_eq!((before.0.k, after.0.k), (pbrdf::model::Parameters::default().k, 4.5));
    wait(&mut harness);
    logic(&mut harness);
    assert!(!explorer(&mut harness).views.get::<crate::app::views::HemisphereView>().is_fresh());
}

#[test]
fn no_map_is_made_behind_another_tab_and_none_of_values_that_are_no_surface() {
    let mut harness = harness();
    wait(&mut harness);
    assert!(explorer(&mut harness).views.get::<crate::app::views::HemisphereView>().key().is_none(), "not on screen");
    let mut harness = shown();
    explorer(&mut harness).work.surface_mut().parameters.sigma = f64::NAN;
    wait(&mut harness);
    assert!(explorer(&mut harness).views.get::<crate::app::views::HemisphereView>().key().is_none());
    assert_eq!(reading(&mut harness, egui::pos2(600.0, 250.0)), None);
}

#[test]
fn directions_measured_at_the_sliders_angle_are_marked() {
    let mut harness = shown();
    let count = explorer(&mut harness).work.active().series[0].rows.len();
    harness.get_by_label(&format!("measured: {count}"));
    explorer(&mut harness).work.settings_mut().theta_i = 13.7;
    wait(&mut harness);
    harness.get_by_label("not measured at this θi");
}
