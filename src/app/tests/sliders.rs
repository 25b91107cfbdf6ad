//! Sliders and switches.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, wait};
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::{Diffuse, Parameter, Parameters};

#[test]
fn every_parameter_has_a_slider_and_a_typed_value_of_its_name() {
    let harness = harness();
    for parameter in Parameter::ALL {
        harness.get_by_role_and_label(Role::Slider, parameter.symbol());
        harness.get_by_role_and_label(Role::SpinButton, parameter.symbol());
    }
}

#[test]
fn moving_a_slider_moves_the_curves() {
    let mut harness = harness();
    let before = explorer(&mut harness).derived.curves.get().expect("curves").series[0].clone();
    harness.get_by_role_and_label(Role::Slider, "k").set_value_accesskit(4.5);
    harness.run();
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.work.surface().parameters.k, 4.5);
    assert_ne!(explorer.derived.curves.get().expect("curves").series[0], before);
}

#[test]
fn arrow_keys_step_a_slider() {
    let mut harness = harness();
    harness.get_by_role_and_label(Role::Slider, "k").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowRight);
    harness.run();
    assert!(explorer(&mut harness).work.surface().parameters.k > Parameters::default().k);
}

#[test]
fn a_lobe_that_is_off_hides_its_sliders() {
    let mut harness = harness();
    for switch in ["Diffuse lobe", "Volume lobe", "Gauss"] {
        harness.get_by_label(switch).click();
        harness.run();
    }
    let hidden = [Parameter::Kd, Parameter::C, Parameter::Kv, Parameter::SigmaV, Parameter::Q];
    for parameter in Parameter::ALL {
        let there = harness.query_by_role_and_label(Role::Slider, parameter.symbol()).is_some();
        assert_eq!(there, !hidden.contains(&parameter), "{parameter:?}");
    }
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.work.surface().model.diffuse, Diffuse::Absent);
    let own = &explorer.derived.curves.get().expect("curves").own;
    assert!(own.diffuse.is_empty() && own.volume.is_empty());
}

/// Types into the box of n.
fn type_n(harness: &mut Harness<'static, Option<App>>, text: &str) {
    harness.get_by_role_and_label(Role::SpinButton, "n").focus();
    harness.run();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run();
}

#[test]
fn a_function_key_takes_the_value_that_is_being_typed_and_does_what_it_does() {
    let mut harness = harness();
    type_n(&mut harness, "1.7");
    harness.key_press(egui::Key::F1);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 1.7);
    assert!(explorer(&mut harness).dialogs.help.take().is_some());
    wait(&mut harness);
    type_n(&mut harness, "1.8");
    harness.key_press(egui::Key::F5);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.fit_history().len(), 1);
}

#[test]
fn a_refused_value_is_quoted_as_it_was_typed() {
    let mut harness = harness();
    type_n(&mut harness, "1e308");
    harness.key_press(egui::Key::Enter);
    wait(&mut harness);
    let notice = explorer(&mut harness).toasts.take().expect("n has an end");
    assert_eq!(notice, "n: found \"1e308\", expected a number from 0 to 1e10.");
    assert_eq!(explorer(&mut harness).work.surface().parameters, Parameters::default());
}

#[test]
fn a_value_outside_its_slider_is_kept() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters = Parameters { n: 25.0, q: 300.0, c: -1.5, ..Parameters::default() };
    harness.run();
    harness.run();
    let parameters = explorer(&mut harness).work.surface().parameters;
    assert_eq!((parameters.n, parameters.q, parameters.c), (25.0, 300.0, -1.5));
}

#[test]
fn reset_brings_back_the_default() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters.sigma = 1.0;
    harness.run();
    harness.get_by_label("Reset sigma").click();
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().parameters, Parameters::default());
}

#[test]
fn what_is_derived_is_not_made_anew_without_need() {
    let mut harness = harness();
    let curve = explorer(&mut harness).derived.curves.get().expect("curves").own.dolp[0].as_ptr();
    harness.hover_at(egui::pos2(600.0, 200.0));
    harness.run();
    assert_eq!(explorer(&mut harness).derived.curves.get().expect("curves").own.dolp[0].as_ptr(), curve);
}

/// Clicks twice at the middle of a node.
fn double_click(harness: &mut egui_kittest::Harness<'static, Option<crate::app::shell::app::App>>, at: egui::Pos2) {
    for _ in 0..2 {
        for pressed in [true, false] {
            let button = egui::PointerButton::Primary;
            harness.input_mut().events.push(egui::Event::PointerMoved(at));
            harness.input_mut().events.push(egui::Event::PointerButton { pos: at, button, pressed, modifiers: egui::Modifiers::NONE });
        }
    }
    harness.run();
}

#[test]
fn a_double_click_on_a_slider_or_its_name_resets_it() {
    for role in [Role::Slider, Role::Label] {
        let mut harness = harness();
        explorer(&mut harness).work.surface_mut().parameters.k = 9.0;
        harness.run();
        let at = harness.get_by_role_and_label(role, "k").rect().center();
        double_click(&mut harness, at);
        assert_eq!(explorer(&mut harness).work.surface().parameters, Parameters::default(), "{role:?}");
    }
}

#[test]
fn arrow_keys_step_a_logarithmic_slider_away_from_zero_and_back() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters.kd = 0.0;
    harness.run();
    harness.get_by_role_and_label(Role::Slider, "k_d").focus();
    harness.run();
    let mut before = 0.0;
    for _ in 0..3 {
        harness.key_press(egui::Key::ArrowRight);
        harness.run();
        let kd = explorer(&mut harness).work.surface().parameters.kd;
        assert!(kd > before, "{kd}");
        before = kd;
    }
    for _ in 0..6 {
        harness.key_press(egui::Key::ArrowLeft);
        harness.run();
    }
    assert_eq!(explorer(&mut harness).work.surface().parameters.kd, 0.0);
}

#[test]
fn tooltips_of_sliders_cover_no_row_of_the_panel() {
    for name in ["n", "σ_v", "θi"] {
        let mut harness = harness();
        let slider = harness.get_all_by_role_and_label(Role::Slider, name).next().expect("a slider").rect();
        let panel = harness.get_by_role_and_label(Role::Button, "Reset n").rect().right();
        harness.hover_at(slider.center());
        let tooltips = |harness: &Harness<'static, Option<App>>| {
            let tooltip = |layer: &egui::LayerId| layer.order == egui::Order::Tooltip;
            let layers: Vec<egui::LayerId> = harness.ctx.memory(|memory| memory.areas().visible_layer_ids().into_iter().collect());
            let layers = layers.into_iter().filter(tooltip);
            layers.filter_map(|layer| harness.ctx.memory(|memory| memory.area_rect(layer.id))).collect::<Vec<_>>()
        };
        // It comes when the pointer has rested.
        for _ in 0..60 {
            harness.step();
        }
        let rects = tooltips(&harness);
        assert_eq!(rects.len(), 1, "{name}: {rects:?}");
        assert!(rects[0].left() >= panel && rects[0].top() <= slider.bottom() && rects[0].bottom() >= slider.top(), "{name}: {rects:?}");
        // After a drag the plots are looked at: no text until the pointer has left.
        harness.drag_at(slider.center());
        harness.step();
        harness.hover_at(slider.center() + egui::vec2(10.0, 0.0));
        harness.step();
        harness.drop_at(slider.center() + egui::vec2(10.0, 0.0));
        for _ in 0..60 {
            harness.step();
        }
        assert_eq!(tooltips(&harness), [], "{name}");
    }
}

#[test]
fn a_dragged_slider_takes_arrow_keys_and_right_and_left_come_back_exactly() {
    let mut harness = harness();
    let slider = harness.get_by_role_and_label(Role::Slider, "k").rect();
    harness.drag_at(slider.center());
    harness.run();
    harness.hover_at(slider.center() + egui::vec2(7.0, 0.0));
    harness.run();
    harness.drop_at(slider.center() + egui::vec2(7.0, 0.0));
    harness.run();
    let k = 2.345_678_901_234_5;
    explorer(&mut harness).work.surface_mut().parameters.k = k;
    harness.run();
    harness.key_press(egui::Key::ArrowRight);
    harness.run();
    assert!((explorer(&mut harness).work.surface().parameters.k - k - 0.1).abs() < 1e-8);
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::ArrowRight);
    harness.run();
    assert!((explorer(&mut harness).work.surface().parameters.k - k - 0.11).abs() < 1e-8);
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::ArrowLeft);
    harness.key_press(egui::Key::ArrowLeft);
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().parameters.k, k);
}
