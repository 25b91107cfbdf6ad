//! Bounds, choices and the history of fits.

use crate::app::shell::app::App;
use crate::app::storage::settings_file::{SavedSettings, SettingsFile};
use crate::app::tests::{explorer, harness, take, wait};
use crate::app::views::action::Action;
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::fit::{Loss, Starts, Weights};
use pbrdf::model::{DolpFormula, Parameter};

fn fit(harness: &mut Harness<'static, Option<App>>) {
    explorer(harness).actions.push(Action::StartFit);
    wait(harness);
}

/// Chooses an entry of a list by its name.
fn choose(harness: &mut Harness<'static, Option<App>>, list: &str, entry: &str) {
    harness.get_by_role_and_label(Role::ComboBox, list).click();
    harness.run();
    harness.get_by_label(entry).click();
    harness.run();
}

#[test]
fn bounds_are_edited_under_the_slider_and_hold_in_a_fit() {
    let mut harness = harness();
    assert!(harness.query_by_label("Upper bound of n").is_none(), "the first look is without bounds");
    harness.get_by_label("Bounds and ties").click();
    harness.run();
    harness.get_by_label("Upper bound of n").set_value_accesskit(1.5);
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().bounds, [(Parameter::N, 0.01, 1.5)]);
    fit(&mut harness);
    let report = &explorer(&mut harness).work.shown_fit().expect("a fit").report;
    let n = report.estimates.iter().find(|estimate| estimate.parameter == Parameter::N).expect("n is of the model");
    assert!(n.value <= 1.5, "{}", n.value);
    // These angles leave n to wander: without the bound it goes elsewhere.
    assert_eq!(n.at_bound.is_some(), n.value == 1.5);
    harness.get_by_label("Reset bounds of n").click();
    harness.run();
    assert!(explorer(&mut harness).work.surface().bounds.is_empty());
}

#[test]
fn bounds_that_are_none_are_refused_with_a_sentence() {
    let mut harness = harness();
    harness.get_by_label("Bounds and ties").click();
    harness.run();
    for (field, value, expected) in [
        ("Lower bound of k", 25.0, "lower one must be below"),
        ("Lower bound of sigma", -1.0, "expected a number from 1e-30 to 1e30"),
        ("Lower bound of q", 1.0, "expected a number from 1.000000000001 to 1e12"),
    ] {
        harness.get_by_label(field).set_value_accesskit(value);
        harness.run();
        let explorer = explorer(&mut harness);
        let notice = explorer.toasts.take().expect("a sentence");
        assert!(notice.contains(expected), "{notice}");
        assert!(explorer.work.surface().bounds.is_empty());
    }
}

#[test]
fn bounds_hold_while_refitting_and_comparing() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().set_bounds(Parameter::K, 2.0, 2.5).expect("sound bounds");
    explorer(&mut harness).work.settings_mut().refit_live = true;
    harness.step();
    wait(&mut harness);
    let k = explorer(&mut harness).work.surface().parameters.k;
    assert!((2.0..=2.5).contains(&k), "{k}");
    explorer(&mut harness).actions.push(Action::CompareModels);
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    assert!(!explorer.work.model_comparison().is_empty());
    for rung in explorer.work.model_comparison() {
        let k = rung.report().expect("a fit").parameters.k;
        assert!((2.0..=2.5).contains(&k), "{}: {k}", rung.preset.key);
    }
}

#[test]
fn options_reach_the_fit() {
    let mut harness = harness();
    harness.get_by_label("Options").click();
    harness.run();
    choose(&mut harness, "Weights", "1/σ: χ²");
    choose(&mut harness, "Loss", "Huber");
    choose(&mut harness, "Starts", "one, from the sliders");
    fit(&mut harness);
    let explorer = explorer(&mut harness);
    let settings = &explorer.work.settings();
    assert_eq!((settings.fit_options.weights, settings.fit_options.loss, settings.starts), (Weights::Sigma, Loss::Huber, Starts::One));
    let report = &explorer.work.shown_fit().expect("a fit").report;
    assert_eq!(report.course.minima.iter().map(|minimum| minimum.hits).sum::<usize>(), 1);
    assert!(report.statistics.chi2.is_some() && !report.statistics.minimises_delta_e);
    harness.get_by_label_contains("over σ, Huber loss");
    harness.get_by_label("χ²/dof");
}

#[test]
fn eq17_as_printed_frees_ks_and_divides_the_curve_by_it() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters.ks = 0.5;
    harness.run();
    let consistent = explorer(&mut harness).derived.curves.get().expect("curves").own.dolp[40][1];
    harness.get_by_label("Options").click();
    harness.run();
    choose(&mut harness, "Eq. (17)", "as printed");
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.work.surface().model.dolp_formula, DolpFormula::AsPrinted);
    assert!(explorer.free().contains(Parameter::Ks));
    assert_eq!(explorer.derived.curves.get().expect("curves").own.dolp[40][1], consistent / 0.5);
    harness.get_by_label("Default options").click();
    harness.run();
    assert!(!self::explorer(&mut harness).free().contains(Parameter::Ks));
}

#[test]
fn weights_without_standard_deviations_are_a_sentence() {
    let mut harness = harness();
    let explorer = explorer(&mut harness);
    let mut measurement = (*explorer.work.active().measurement).clone();
    measurement.rows[3].dolp = measurement.rows[3].dolp.map(|dolp| pbrdf::measurement::Quantity { sigma: None, ..dolp });
    take(explorer, "bare".to_owned(), measurement);
    explorer.work.settings_mut().fit_options.weights = Weights::Sigma;
    explorer.actions.push(Action::StartFit);
    harness.run();
    let notice = self::explorer(&mut harness).toasts.text().expect("a sentence");
    assert!(notice.contains("The fit cannot begin") && notice.contains("dolp_sigma"), "{notice}");
}

#[test]
fn a_click_in_the_history_returns_to_a_fit() {
    let mut harness = harness();
    fit(&mut harness);
    let first = explorer(&mut harness).work.surface().parameters;
    explorer(&mut harness).work.surface_mut().set_bounds(Parameter::K, 1.0, 1.5).expect("sound bounds");
    fit(&mut harness);
    assert_ne!(explorer(&mut harness).work.surface().parameters, first);
    harness.get_by_label("History of fits (2)").click_accesskit();
    // The list unfolds, while the intervals of the fit are being found.
    harness.run_steps(30);
    harness.get_by_label("1. 45# steel (simulated) · cauchy").click_accesskit();
    harness.run();
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.work.surface().parameters, first);
    assert_eq!(explorer.work.shown_fit().expect("a fit").report.parameters, first);
}

#[test]
fn settings_with_bounds_and_choices_survive_a_restart_and_nonsense_does_not() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("settings.json");
    let mut settings = Settings { starts: Starts::Exactly(12), seed: 7, ..Settings::default() };
    settings.fit_options.loss = Loss::SoftL1;
    settings.fit_options.loss_scale = Some(0.02);
    let mut surface = Surface::default();
    surface.set_bounds(Parameter::C, -2.0, 0.5).expect("sound bounds");
    let settings = SettingsFile { settings: SavedSettings { settings, surface }, ..SettingsFile::default() };
    crate::app::storage::settings_file::save(&path, &settings).expect("a writable folder");
    assert_eq!(crate::app::storage::settings_file::load_from(&path), (settings, None));
    std::fs::write(&path, "{\"settings\": {\"bounds\": [[\"N\", 3.0, 1.0]]}}").expect("a writable folder");
    let (SettingsFile { settings, .. }, notice) = crate::app::storage::settings_file::load_from(&path);
    assert_eq!(settings, SavedSettings::default());
    assert!(notice.expect("a notice").contains("damaged"));
}
