//! Tabulated metals: sources side by side, sliders that take their n and k, and finishes.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, take, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::MetalSelection;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::{FINISHES, Parameters};
use pbrdf::optics;

fn shown(metal: &str, wavelength_nm: f64) -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().metal_selection =
        MetalSelection { metal: metal.to_owned(), wavelength_nm, ..MetalSelection::default() };
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Metals)));
    wait(&mut harness);
    harness
}

fn johnson(wavelength_nm: f64) -> (f64, f64) {
    let copper = optics::metal("Cu").expect("the bundled table is whole").expect("copper");
    let index = copper.source("Johnson").expect("a source of copper").index_at(wavelength_nm).expect("within its range");
    (index.n(), index.k_m())
}

fn index(parameters: &Parameters) -> (f64, f64) {
    (parameters.n, parameters.k)
}

#[test]
fn a_source_sets_n_and_k_and_undo_brings_them_back() {
    let mut harness = shown("Cu", 650.0);
    let before = explorer(&mut harness).work.surface().parameters;
    harness.get_by_label("Set n and k of Johnson and Christy 1972").click();
    wait(&mut harness);
    let after = explorer(&mut harness).work.surface().parameters;
    assert_eq!(index(&after), johnson(650.0));
    assert_eq!(Parameters { n: before.n, k: before.k, ..after }, before, "the others stay");
    explorer(&mut harness).actions.push(Action::Undo);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters, before);
}

#[test]
fn n_and_k_follow_the_wavelength_of_the_source_that_was_set_unless_they_shall_not() {
    let mut harness = shown("Cu", 650.0);
    let label = "Wavelength";
    let press = |harness: &mut Harness<'static, Option<App>>, key| {
        harness.get_by_role_and_label(egui::accesskit::Role::Slider, label).focus();
        harness.run();
        harness.key_press(key);
        harness.run();
        wait(harness);
    };
    let before = explorer(&mut harness).work.surface().parameters;
    press(&mut harness, egui::Key::ArrowLeft);
    assert!(explorer(&mut harness).work.settings().metal_selection.wavelength_nm < 650.0);
    assert_eq!(explorer(&mut harness).work.surface().parameters, before, "nothing is followed yet");
    harness.get_by_label("Set n and k of Johnson and Christy 1972").click();
    harness.run();
    press(&mut harness, egui::Key::ArrowLeft);
    let wavelength_nm = explorer(&mut harness).work.settings().metal_selection.wavelength_nm;
    assert_eq!(index(&explorer(&mut harness).work.surface().parameters), johnson(wavelength_nm));
    harness.get_by_label("n and k follow the wavelength").click();
    harness.run();
    press(&mut harness, egui::Key::ArrowLeft);
    assert_eq!(index(&explorer(&mut harness).work.surface().parameters), johnson(wavelength_nm));
}

#[test]
fn outside_the_tabulated_range_there_is_a_word_and_no_button() {
    let mut harness = shown("Cu", 2400.0);
    assert!(harness.query_by_label("Set n and k of Johnson and Christy 1972").is_none());
    assert!(harness.query_all_by_label("outside").next().is_some());
    assert!(harness.query_by_label_contains("No source has this wavelength").is_none());
    explorer(&mut harness).work.settings_mut().metal_selection.wavelength_nm = 90.0;
    wait(&mut harness);
    assert!(harness.query_by_label_contains("No source has this wavelength").is_some());
}

#[test]
fn every_metal_is_shown_and_an_unknown_one_is_the_first() {
    let mut harness = shown("Ag", 650.0);
    let metals = optics::metals().expect("the bundled table is whole");
    for metal in metals {
        explorer(&mut harness).work.settings_mut().metal_selection.metal = metal.key.clone();
        wait(&mut harness);
        let first = &metal.sources[0];
        assert!(harness.query_all_by_label(&first.name).next().is_some(), "{}", metal.key);
    }
    explorer(&mut harness).work.settings_mut().metal_selection.metal = "unobtainium".to_owned();
    wait(&mut harness);
    assert!(harness.query_all_by_label(&metals[0].sources[0].name).next().is_some());
}

#[test]
fn a_finish_sets_the_surface_and_leaves_the_metal() {
    let mut harness = shown("Fe", 650.0);
    let before = explorer(&mut harness).work.surface().parameters;
    for finish in &FINISHES {
        harness.get_by_label(finish.name).click();
        wait(&mut harness);
        assert_eq!(explorer(&mut harness).work.surface().parameters, finish.on(before), "{}", finish.key);
    }
}

#[test]
fn the_wavelength_of_a_measurement_is_taken_over() {
    let mut harness = shown("Cu", 500.0);
    let mut measurement = explorer(&mut harness).work.active().measurement.as_ref().clone();
    for (stated, expected) in [("632.8", 632.8), ("633, 650", 632.8), ("-1", 632.8)] {
        measurement.metadata = vec![("wavelength_nm".to_owned(), stated.to_owned())];
        take(explorer(&mut harness), "mine".to_owned(), measurement.clone());
        wait(&mut harness);
        assert_eq!(explorer(&mut harness).work.settings().metal_selection.wavelength_nm, expected, "{stated}");
    }
}

#[test]
fn the_metal_that_a_measurement_names_is_looked_at() {
    let mut harness = shown("W", 650.0);
    let mut measurement = explorer(&mut harness).work.active().measurement.as_ref().clone();
    for (material, expected) in [("Al 6061", "Al"), ("Ta", "Al"), ("rolled copper", "Cu"), ("45# steel", "Cu")] {
        measurement.metadata = vec![("material".to_owned(), material.to_owned())];
        take(explorer(&mut harness), "mine".to_owned(), measurement.clone());
        wait(&mut harness);
        assert_eq!(explorer(&mut harness).work.settings().metal_selection.metal, expected, "{material}");
    }
}
