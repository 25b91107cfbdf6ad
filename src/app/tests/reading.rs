//! What is whole, what the Tab key reaches and in which order, and what a screen reader says.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::Action;
use crate::app::work::pane_id::PaneId;
use egui::accesskit::Role;
use egui::{Key, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::model::Parameter;

type Window = Harness<'static, Option<App>>;

/// Every control that Tab leads to, once around.
fn stops(harness: &mut Window) -> Vec<Rect> {
    let mut seen = Vec::new();
    let mut rects = Vec::new();
    while seen.len() < 400 {
        harness.key_press(Key::Tab);
        harness.step();
        harness.step();
        let id = harness.ctx.memory(egui::Memory::focused).expect("Tab leads to a control");
        if seen.contains(&id) {
            break;
        }
        seen.push(id);
        rects.push(harness.ctx.read_response(id).expect("a control that was drawn").rect);
    }
    rects
}

/// Width of an edge between panels, and least width of a bar of tabs.
const EDGE: f32 = 8.0;
const BAR: f32 = 500.0;

#[test]
fn tab_leads_through_each_panel_in_reading_order() {
    let mut harness = harness();
    let mut stops = stops(&mut harness);
    // The edges by which panels are made wider, and the bars of tabs, which scroll, are no controls
    // of a panel.
    stops.retain(|stop| stop.width() > EDGE && stop.height() > EDGE && stop.width() < BAR);
    let left = harness.get_by_role_and_label(Role::Button, "Reset n").rect().right() + 4.0;
    let right = harness.get_by_label("Fit").rect().left() - 4.0;
    let panel = |rect: &Rect| match rect.center() {
        at if at.y < 24.0 => "menus",
        at if at.x < left => "parameters",
        at if at.x > right => "fits",
        _ => "panes",
    };
    let show: Vec<Rect> = harness.query_all_by_label_contains("Show in ").map(|node| node.rect()).collect();
    let mut order: Vec<&str> = stops.iter().map(panel).collect();
    order.dedup();
    assert_eq!(order, ["menus", "parameters", "fits", "panes"], "{stops:?}");
    for pair in stops.windows(2).filter(|pair| panel(&pair[0]) == panel(&pair[1])) {
        // The tiles draw what stands at the right end of a bar of tabs before its tabs.
        if show.iter().any(|show| show.contains_rect(pair[0])) {
            continue;
        }
        let is_in_row = (pair[0].center().y - pair[1].center().y).abs() < 8.0;
        let follows = if is_in_row { pair[1].left() >= pair[0].left() } else { pair[1].center().y > pair[0].center().y };
        assert!(follows, "{} after {} in {}", pair[1], pair[0], panel(&pair[0]));
    }
}

#[test]
fn every_control_is_reached_by_tab() {
    let mut harness = harness();
    let stops = stops(&mut harness);
    let roles = [Role::Slider, Role::SpinButton, Role::CheckBox, Role::Button, Role::ComboBox, Role::RadioButton];
    for node in harness.query_all_by(|node| roles.contains(&node.role())) {
        if !node.accesskit_node().is_disabled() {
            let at = node.rect();
            let is_reached = stops.iter().any(|stop| stop.expand(2.0).contains_rect(at) || at.expand(2.0).contains_rect(*stop));
            assert!(is_reached, "{:?} {:?} at {at}", node.accesskit_node().role(), node.accesskit_node().label());
        }
    }
}

#[test]
fn a_screen_reader_says_name_value_unit_and_interval_of_a_parameter() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::StartFit);
    harness.step();
    wait(&mut harness);
    let fit = explorer(&mut harness).work.shown_fit().expect("a fit").clone();
    for estimate in fit.report.estimates.iter().filter(|estimate| estimate.free) {
        let name = estimate.parameter.symbol();
        for role in [Role::Slider, Role::SpinButton] {
            let node = harness.get_by_role_and_label(role, name);
            let value = node.accesskit_node().value().unwrap_or_else(|| panic!("{name}: no value"));
            assert!(value.ends_with(estimate.parameter.unit()), "{name}: {value}");
            let said = node.accesskit_node().description().unwrap_or_else(|| panic!("{name}: no interval"));
            assert!(said.contains("Fitted: ") && said.contains("interval at 68.3 %: "), "{name}: {said}");
        }
    }
    let node = harness.get_by_role_and_label(Role::Slider, Parameter::SigmaV.symbol());
    assert!(node.accesskit_node().value().is_some_and(|value| value.ends_with(" rad")));
}

#[test]
fn both_panels_have_the_room_that_they_want_and_plots_half_of_the_window() {
    for (width, least) in [(1240.0, 280.0), (1280.0, 295.0), (1366.0, 305.0), (1920.0, 305.0)] {
        let mut harness = harness();
        harness.set_size(egui::vec2(width, 800.0));
        wait(&mut harness);
        let left = harness.get_by_role_and_label(Role::Button, "Reset n").rect().right();
        let fit = width - harness.get_by_label("Fit").rect().left();
        assert!(fit >= least, "{width}: {fit}");
        assert!(width - fit - left >= 0.5 * width - 16.0, "{width}: {left} {fit}");
    }
}

/// A window of 1366 × 768 pixels at zoom 1.5, in points.
const PROJECTOR: egui::Vec2 = egui::vec2(1366.0 / 1.5, 768.0 / 1.5);

#[test]
fn every_lesson_is_whole_at_a_projector() {
    let mut harness = harness();
    harness.set_size(PROJECTOR);
    wait(&mut harness);
    let window = Rect::from_min_size(egui::Pos2::ZERO, PROJECTOR);
    for lesson in 0..explorer(&mut harness).lessons.all.len() {
        for step in 0..explorer(&mut harness).lessons.all[lesson].steps.len() {
            explorer(&mut harness).actions.push(Action::ShowStep(lesson, step));
            wait(&mut harness);
            let opened = explorer(&mut harness).lessons.all[lesson].steps[step].clone();
            let status = harness.get_by_label_contains("ΔE ").rect().top();
            for text in
                [&opened.action, &opened.watch, &opened.why].map(|text| text.in_language("en")).into_iter().filter(|text| !text.is_empty())
            {
                let place = harness.get_by_label_contains(text).rect();
                assert!(window.contains_rect(place) && place.bottom() <= status, "lesson {lesson}, step {step}: {place} {text}");
            }
            for name in ["Previous step", "Set up again", "Close lesson", "Keep this"] {
                assert!(window.contains_rect(harness.get_by_label(name).rect()), "{name}");
            }
        }
    }
}

#[test]
fn plots_are_large_at_a_projector_with_a_lesson_and_without() {
    let mut harness = harness();
    harness.set_size(PROJECTOR);
    // 600 × 350 pixels.
    let least = egui::vec2(600.0, 350.0) / 1.5;
    for is_lesson in [false, true] {
        if is_lesson {
            explorer(&mut harness).actions.push(Action::ShowStep(0, 0));
        } else {
            explorer(&mut harness).dock.show(PaneId::Lobes);
        }
        wait(&mut harness);
        let plot = if is_lesson { "Plot: DoLP against θr" } else { "Plot: BRDF against θr" };
        let plot = harness.get_by_role_and_label(Role::Image, plot).rect().size();
        assert!(plot.x >= least.x && plot.y >= least.y, "{is_lesson}: {plot}");
    }
}
