//! What plots show beside the active measurement: other measurements, chosen angles of incidence,
//! pinned surfaces.

use crate::app::plots::Polyline;
use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tests::measurements::{active, number_of, order, three};
use crate::app::tests::{edit, explorer, harness, take, wait};
use crate::app::views::action::{Action, ListAction};
use crate::app::views::curves::{ModelCurves, axis_values};
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::MeasurementStyle;
use crate::app::work::pane_id::PaneId;
use crate::figure::Rgb;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::measurement::{Measurement, Quantity, Row};
use pbrdf::model::Parameters;
use pbrdf::optics::Geometry;
use std::collections::BTreeSet;

type Window = Harness<'static, Option<App>>;

/// The names in the figure of a pane, which comes to the front.
fn legend(harness: &mut Window, pane: PaneId) -> BTreeSet<String> {
    explorer(harness).dock.show(pane);
    wait(harness);
    let figure = explorer(harness).figure(pane).expect("a figure");
    figure.panels.iter().flat_map(|panel| &panel.series).map(|series| series.name.clone()).collect()
}

fn set_style(harness: &mut Window, name: &str, change: impl Fn(&mut MeasurementStyle)) {
    let number = number_of(harness, name);
    let mut style = explorer(harness).work.measurements().get(number).expect("it is open").style;
    change(&mut style);
    edit(harness, Edit::SetMeasurementStyle { number, style });
}

#[test]
fn shown_measurements_are_in_the_plots_and_in_their_legends() {
    let (mut harness, _folder) = three();
    set_style(&mut harness, "550.csv", |style| style.shown = false);
    for pane in [PaneId::Dolp, PaneId::ResidualsAgainstAngle] {
        let names = legend(&mut harness, pane);
        assert!(names.contains("650.csv") && names.contains("θi = 30°"), "{pane:?}: {names:?}");
        assert!(!names.contains("550.csv") && !names.contains("450.csv"), "{pane:?}: {names:?}");
    }
    harness.get_by_role_and_label(Role::CheckBox, "Show 550.csv").click();
    harness.run();
    assert!(legend(&mut harness, PaneId::Dolp).contains("550.csv"));
    // Those without a BRDF are not among the lobes.
    assert!(!legend(&mut harness, PaneId::Lobes).contains("550.csv"));
    order(&mut harness, Action::OpenExample(2));
    assert_eq!(active(&mut harness), "Aluminium 650 nm (simulated)");
    let lobes = legend(&mut harness, PaneId::Lobes);
    assert!(!lobes.contains("Aluminium 650 nm (simulated)"), "{lobes:?}");
    let number = number_of(&mut harness, "450.csv");
    edit(&mut harness, Edit::Activate(number));
    assert!(legend(&mut harness, PaneId::Lobes).contains("Aluminium 650 nm (simulated)"));
}

/// 17 angles of incidence.
fn dense() -> Measurement {
    let rows = (1..=17_u32).flat_map(|i| (0..5_u32).map(move |j| (f64::from(i) * 5.0, f64::from(j) * 15.0)));
    let row = |(theta_i, theta_r)| Row {
        geometry: Geometry::new(theta_i, theta_r, 180.0).expect("a geometry"),
        dolp: Some(Quantity { value: 0.1, sigma: None }),
        brdf: None,
        masked: false,
    };
    Measurement { rows: rows.map(row).collect(), ..Measurement::default() }
}

#[test]
fn any_angle_of_incidence_can_be_drawn() {
    let mut harness = harness();
    take(explorer(&mut harness), "dense".to_owned(), dense());
    wait(&mut harness);
    let drawn = |harness: &mut Window| -> Vec<String> {
        let marks = explorer(harness).derived.marks.get().expect("marks");
        marks.series.iter().map(|series| series.name.clone()).collect()
    };
    let first = drawn(&mut harness);
    assert_eq!((first.len(), first[0].as_str(), first[11].as_str()), (12, "θi = 5°", "θi = 85°"));
    harness.get_by_label("12 of 17 angles of incidence are drawn").click();
    harness.run();
    // In the menu, which lies over the plot with its entry.
    harness.query_all_by_role_and_label(Role::CheckBox, "θi = 5°").next().expect("a tick box").click();
    harness.run();
    assert_eq!(drawn(&mut harness), first[1..]);
    harness.get_by_label("All").click();
    harness.run();
    assert_eq!(drawn(&mut harness).len(), 17);
    let inks: BTreeSet<(u8, u8, u8)> = explorer(&mut harness)
        .derived
        .marks
        .get()
        .expect("marks")
        .series
        .iter()
        .map(|series| (series.ink.0, series.ink.1, series.ink.2))
        .collect();
    assert_eq!(inks.len(), 17, "each has a colour of its own");
    assert!(harness.query_by_label_contains("angles of incidence are drawn").is_none());
    let number = explorer(&mut harness).work.active().number;
    edit(&mut harness, Edit::SetDrawnSeries { number, drawn: vec![16].into() });
    assert_eq!(drawn(&mut harness), ["θi = 85°"]);
    order(&mut harness, Action::Undo);
    assert_eq!(drawn(&mut harness).len(), 17);
}

#[test]
fn a_pinned_surface_is_drawn_in_every_plot_until_it_is_hidden_or_removed() {
    let mut harness = harness();
    harness.get_by_role_and_label(Role::Button, "Pin").click();
    harness.run();
    let name = explorer(&mut harness).work.pinned()[0].name.clone();
    // The sliders move on.
    let mut surface = explorer(&mut harness).work.surface().clone();
    let before = surface.parameters;
    surface.parameters.n = 0.5;
    edit(&mut harness, Edit::SetSurface(Box::new(surface)));
    let panes = [PaneId::Dolp, PaneId::Lobes, PaneId::PolarLobes, PaneId::Facets, PaneId::ResidualsAgainstAngle];
    for pane in panes {
        assert!(legend(&mut harness, pane).contains(&name), "{pane:?}");
    }
    harness.get_by_role_and_label(Role::CheckBox, &format!("Show {name}")).click();
    harness.run();
    for pane in panes {
        assert!(!legend(&mut harness, pane).contains(&name), "{pane:?}");
    }
    edit(&mut harness, Edit::UsePin(0));
    assert_eq!(explorer(&mut harness).work.surface().parameters, before);
    edit(&mut harness, Edit::Unpin(0));
    assert!(explorer(&mut harness).work.pinned().is_empty());
    order(&mut harness, Action::Undo);
    assert_eq!(explorer(&mut harness).work.pinned().len(), 1);
}

#[test]
fn gauss_beside_cauchy_at_equal_median_slope_is_one_click() {
    let mut harness = harness();
    harness.get_by_role_and_label(Role::Button, "Pin Gauss").click();
    harness.run();
    let work = &explorer(&mut harness).work;
    let (pin, surface) = (&work.pinned()[0], work.surface());
    let median =
        |model: pbrdf::model::Model, parameters: &pbrdf::model::Parameters| model.distribution.median_slope(parameters.sigma, parameters.q);
    assert_ne!(pin.model.distribution, surface.model.distribution);
    let ratio = median(pin.model, &pin.parameters) / median(surface.model, &surface.parameters);
    // Two products and a quotient.
    assert!((ratio - 1.0).abs() < 8.0 * f64::EPSILON, "{ratio}");
}

#[test]
fn fits_and_rows_of_the_comparison_are_pinned_and_a_session_keeps_them() {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = pbrdf::fit::Starts::One;
    order(&mut harness, Action::StartFit);
    harness.get_by_label("Pin this fit").click();
    wait(&mut harness);
    order(&mut harness, Action::CompareModels);
    let row = explorer(&mut harness).work.model_comparison()[1].preset.name;
    harness.get_by_role_and_label(Role::Button, &format!("Pin {row}")).click();
    wait(&mut harness);
    order(&mut harness, Action::List(ListAction::PinFit));
    let pins = explorer(&mut harness).work.pinned().to_vec();
    assert!(pins[0].name.starts_with("Fit 1: ") && pins[1].name == row && pins[2].name == format!("{} (2)", pins[0].name), "{pins:?}");
    let mut colors: BTreeSet<usize> = pins.iter().map(|pin| pin.color).collect();
    colors.insert(explorer(&mut harness).work.active().style.color);
    assert_eq!(colors.len(), 4, "no two have the same colour");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("work.pbrdf.json");
    order(&mut harness, Action::Export(ExportKind::Session, path.clone()));
    let mut other = self::harness();
    order(&mut other, Action::OpenMeasurements(vec![path]));
    assert_eq!(explorer(&mut other).work.pinned(), pins);
    order(&mut other, Action::List(ListAction::UnpinAll));
    assert!(explorer(&mut other).work.pinned().is_empty());
}

#[test]
fn measurements_are_chosen_named_moved_and_closed_by_keys() {
    let (mut harness, _folder) = three();
    let press = |harness: &mut Window, modifiers: egui::Modifiers, key: Key| {
        harness.key_press_modifiers(modifiers, key);
        wait(harness);
    };
    press(&mut harness, egui::Modifiers::COMMAND, Key::PageUp);
    assert_eq!(active(&mut harness), "650.csv");
    press(&mut harness, egui::Modifiers::COMMAND, Key::PageDown);
    press(&mut harness, egui::Modifiers::ALT, Key::ArrowDown);
    let names =
        |harness: &mut Window| -> Vec<String> { explorer(harness).work.measurements().iter().map(|open| open.name.clone()).collect() };
    assert_eq!(names(&mut harness), ["550.csv", "450.csv", "650.csv"]);
    press(&mut harness, egui::Modifiers::NONE, Key::F2);
    let field = harness.get_by_role_and_label(Role::TextInput, "Name of the measurement");
    field.type_text(" blue");
    harness.run();
    press(&mut harness, egui::Modifiers::NONE, Key::Enter);
    assert_eq!(active(&mut harness), "450.csv blue");
    press(&mut harness, egui::Modifiers::COMMAND, Key::W);
    assert_eq!((names(&mut harness), active(&mut harness).as_str()), (vec!["550.csv".to_owned(), "650.csv".to_owned()], "650.csv"));
    // By pointer: a click on a name, and the menu beside it.
    harness.get_by_role_and_label(Role::Button, "550.csv").click();
    wait(&mut harness);
    assert_eq!(active(&mut harness), "550.csv");
    harness.get_by_label("Actions for 650.csv").click();
    harness.run();
    harness.get_by_label("Move up").click();
    wait(&mut harness);
    assert_eq!(names(&mut harness), ["650.csv", "550.csv"]);
}

#[test]
fn a_measurement_has_the_colour_that_was_chosen_for_it() {
    let (mut harness, _folder) = three();
    set_style(&mut harness, "650.csv", |style| style.color = 2);
    let figure = explorer(&mut harness).figure(PaneId::Dolp).expect("a figure");
    let color = figure.panels[0].series.iter().find(|series| series.name == "650.csv").expect("its curve").color;
    assert_eq!(color, Some(Rgb(0, 128, 92)));
}

#[test]
fn the_fresnel_limit_leaves_the_axis_to_data_and_model() {
    let mut harness = harness();
    // Little polarisation: the limit is many times as high.
    let mut surface = explorer(&mut harness).work.surface().clone();
    surface.parameters = Parameters { ks: 0.02, kd: 1.0, ..surface.parameters };
    let mut measurement = dense();
    measurement.rows.iter_mut().for_each(|row| row.dolp = Some(Quantity { value: 0.02, sigma: None }));
    take(explorer(&mut harness), "copper".to_owned(), measurement);
    edit(&mut harness, Edit::SetSurface(Box::new(surface)));
    let derived = &explorer(&mut harness).derived;
    let highest = |curve: fn(&ModelCurves) -> &Polyline| {
        let curves = derived.curves.get().expect("curves").all();
        curves.flat_map(|curves| axis_values(curve(curves))).fold(0.0, f64::max)
    };
    let (model, limit) = (highest(|curves| &curves.dolp), highest(|curves| &curves.limit));
    assert!(limit > 5.0 * model.max(0.02), "{limit} {model}");
    let high = explorer(&mut harness).views.get::<crate::app::views::DolpView>().range().expect("an axis").high;
    // A quarter more for the limit, and the next round number, which is half as much again at most.
    assert!(high <= 1.25 * 1.04 * 1.7 * model.max(0.02), "{high} {model}");
    assert!(legend(&mut harness, PaneId::Dolp).contains("Fresnel limit"), "its lower part is drawn");
}
