//! Pressing Fit, and what follows.

use crate::app::shell::app::App;
use crate::app::tests::{PATIENCE, edit, explorer, harness, take, wait};
use crate::app::text::numbers::significant;
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::fit_problem;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::fit::{FitOptions, Starts, Weights};
use pbrdf::measurement::Quantity;
use pbrdf::model::{Parameter, ParameterSet, Parameters};
use std::time::Instant;

#[test]
fn pressing_fit_moves_the_sliders_to_a_better_place() {
    let mut harness = harness();
    let before = explorer(&mut harness).derived.delta_e().expect("the example has DoLP");
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    let report = &explorer.work.shown_fit().expect("a fit").report;
    assert_eq!(explorer.work.surface().parameters, report.parameters);
    assert_eq!(explorer.derived.delta_e(), report.objective);
    assert!(report.objective.expect("an objective") < 0.5 * before);
}

#[test]
fn back_and_use_as_sliders_go_to_and_fro() {
    let mut harness = harness();
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    let fitted = explorer(&mut harness).work.surface().parameters;
    assert!(harness.get_by_label("Use as sliders").accesskit_node().is_disabled(), "the sliders are the fit's");
    harness.get_by_label("Back to before the fit").click();
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().parameters, Parameters::default());
    let model = explorer(&mut harness).work.surface().model;
    explorer(&mut harness).work.surface_mut().model.volume = false;
    harness.run();
    harness.get_by_label("Use as sliders").click();
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().parameters, fitted);
    assert_eq!(explorer(&mut harness).work.surface().model, model, "the values belong to the model of the fit");
}

#[test]
fn a_start_outside_the_sliders_is_no_obstacle() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters.n = 14.0;
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.toasts.text(), None);
    assert!(explorer.work.shown_fit().is_some());
}

#[test]
fn undo_and_redo_step_through_fits_and_drags() {
    let mut harness = harness();
    harness.get_by_role_and_label(egui::accesskit::Role::Slider, "k").set_value_accesskit(4.5);
    harness.run();
    let moved = explorer(&mut harness).work.surface().parameters;
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    let fitted = explorer(&mut harness).work.surface().parameters;
    for (modifiers, expected) in [
        (egui::Modifiers::COMMAND, moved),
        (egui::Modifiers::COMMAND, Parameters::default()),
        (egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, moved),
        (egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, fitted),
    ] {
        harness.key_press_modifiers(modifiers, egui::Key::Z);
        harness.run();
        assert_eq!(explorer(&mut harness).work.surface().parameters, expected);
    }
}

#[test]
fn refitting_while_dragging_keeps_what_is_fixed_and_fits_the_rest() {
    let mut harness = harness();
    harness.get_by_label("Fix n").click();
    harness.run();
    harness.get_by_label("keep refitting while I drag").click();
    harness.step();
    wait(&mut harness);
    harness.get_by_role_and_label(egui::accesskit::Role::Slider, "n").set_value_accesskit(3.0);
    harness.step();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.work.surface().parameters.n, 3.0);
    assert!(explorer.derived.delta_e().expect("the example has DoLP") < 2e-3);
}

#[test]
fn a_dragged_slider_stays_where_the_pointer_is_while_the_others_are_refitted() {
    let mut harness = harness();
    let slider = harness.get_by_role_and_label(Role::Slider, "n").rect().center();
    let places = [12.0, -9.0, 20.0, 3.0].map(|right| slider + egui::vec2(right, 0.0));
    // What the pointer says, without any fit.
    let mut drag = |is_live: bool| -> Vec<Parameters> {
        explorer(&mut harness).work.surface_mut().parameters = Parameters::default();
        explorer(&mut harness).work.settings_mut().refit_live = is_live;
        wait(&mut harness);
        harness.drag_at(slider);
        let at = |place: &egui::Pos2| {
            harness.hover_at(*place);
            harness.step();
            wait(&mut harness);
            let explorer = explorer(&mut harness);
            let (surface, measurement) = (explorer.work.surface(), &explorer.work.active().measurement);
            let shown = surface.parameters;
            let problem = fit_problem(surface, measurement, surface.model, ParameterSet::EMPTY, FitOptions::default()).expect("a problem");
            assert_eq!(explorer.derived.delta_e(), problem.delta_e(&shown), "ΔE is that of the values");
            assert_eq!(explorer.derived.curves.key().expect("curves").parameters, shown, "and so are the curves");
            let text = harness.get_by_role_and_label(Role::SpinButton, "n").accesskit_node().value();
            assert_eq!(text, Some(significant(shown.n)), "and so is the number in the box");
            shown
        };
        let shown = places.iter().map(at).collect();
        harness.drop_at(places[3]);
        harness.run();
        shown
    };
    let (alone, live) = (drag(false), drag(true));
    for (alone, live) in alone.iter().zip(&live) {
        assert_eq!(alone.n, live.n);
        assert!(Parameters { n: live.n, ..Parameters::default() } != *live, "the others are fitted");
    }
}

/// Draws frames until the fit is there and its intervals are on their way.
fn fit_alone(harness: &mut Harness<'static, Option<App>>) {
    explorer(harness).actions.push(Action::StartFit);
    let begun = Instant::now();
    while !explorer(harness).jobs.fits.intervals.is_running() {
        assert!(begun.elapsed() < PATIENCE, "no intervals are being found");
        harness.step();
    }
}

#[test]
fn intervals_follow_a_fit_and_can_be_stopped_and_found_after_all() {
    let mut harness = harness();
    fit_alone(&mut harness);
    let linear = explorer(&mut harness).work.shown_fit().expect("a fit").report.clone();
    assert!(linear.course.intervals_complete.is_none() && linear.estimates.iter().all(|estimate| estimate.interval68.is_none()));
    harness.get_by_label("Finding the intervals…");
    explorer(&mut harness).actions.push(Action::CancelIntervals);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.shown_fit().expect("a fit").report, linear, "a part of the intervals says nothing");
    harness.get_by_label("Find the intervals").click();
    harness.step();
    wait(&mut harness);
    let report = explorer(&mut harness).work.shown_fit().expect("a fit").report.clone();
    assert_eq!(report.course.intervals_complete, Some(true));
    for estimate in report.estimates.iter().filter(|estimate| estimate.free) {
        let interval = estimate.interval68.expect("an interval");
        assert!(interval.contains(estimate.value));
        if estimate.determined {
            harness.get_all_by_label_contains(&estimate.uncertainty_text().expect("a text")).next().expect("its uncertainty is shown");
        }
    }
    let line = harness.get_by_label("Converged").rect().height();
    for text in harness.get_all_by_label("not determined") {
        assert!(text.rect().height() < 1.5 * line, "it stands in one line");
    }
    // Of 27 noisy values for eight parameters some say nothing.
    harness.get_by_label_contains("• not determined: ");
    assert!(harness.query_by_label_contains("standard error above half").is_none());
    harness.get_by_label_contains(" in the best basin");
    let history = explorer(&mut harness).work.fit_history().get(0, 0).expect("the fit").report.clone();
    assert_eq!(history, report);
}

#[test]
fn sliders_follow_a_better_minimum_unless_they_were_moved() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    let fit = explorer(&mut harness).work.shown_fit().cloned().expect("a fit");
    let better = |n: f64| {
        let mut report = Box::new(fit.report.clone());
        report.parameters.n = n;
        Edit::SetFitReport { id: fit.id, report }
    };
    edit(&mut harness, better(1.25));
    let work = &explorer(&mut harness).work;
    assert_eq!((work.surface().parameters.n, work.shown_fit().expect("a fit").report.parameters.n), (1.25, 1.25));
    // The sliders are those of the fit: one step of undo for both.
    edit(&mut harness, Edit::Undo);
    assert_eq!(explorer(&mut harness).work.surface().parameters, Parameters::default());
    edit(&mut harness, better(1.5));
    let work = &explorer(&mut harness).work;
    assert_eq!((work.surface().parameters, work.shown_fit().expect("a fit").report.parameters.n), (Parameters::default(), 1.5));
}

#[test]
fn what_the_data_determine_is_told_before_a_fit_and_only_if_asked() {
    let mut harness = harness();
    assert!(explorer(&mut harness).derived.outlook().is_none());
    harness.get_by_label("What these data determine").click();
    harness.run();
    let outlook = explorer(&mut harness).derived.outlook().expect("an outlook");
    assert!(outlook.from_stated);
    let error = |parameter| outlook.errors.iter().find(|(other, _)| *other == parameter).and_then(|(_, error)| *error);
    // The paper's angles leave n more open than half its own size: that is not determined.
    assert_eq!(error(Parameter::N), None);
    harness.get_all_by_label("not determined").next().expect("it says so");
    let parameters = explorer(&mut harness).work.surface().model.parameters();
    explorer(&mut harness).work.surface_mut().locked = parameters.without(Parameter::N);
    harness.run();
    let alone = explorer(&mut harness).derived.outlook().expect("an outlook").errors.clone();
    assert!(matches!(alone[..], [(Parameter::N, Some(error))] if error < 0.5), "all others known, n is: {alone:?}");
}

#[test]
fn a_fit_of_the_measurement_before_does_not_reach_the_one_after() {
    let mut harness = harness();
    for command in [Action::StartFit, Action::CompareModels] {
        explorer(&mut harness).actions.push(command);
    }
    harness.step();
    // The new measurement arrives while both jobs are on their way.
    let rows = (*explorer(&mut harness).work.active().measurement).clone();
    take(explorer(&mut harness), "another".to_owned(), rows);
    wait(&mut harness);
    std::thread::sleep(std::time::Duration::from_millis(300));
    harness.run();
    let explorer = explorer(&mut harness);
    assert!(explorer.work.shown_fit().is_none() && explorer.work.model_comparison().is_empty());
    assert_eq!(explorer.work.surface().parameters, Parameters::default());
}

#[test]
fn comparing_models_lists_the_ladder() {
    let mut harness = harness();
    harness.get_by_label("Compare models").click();
    harness.step();
    wait(&mut harness);
    let models: Vec<&str> = explorer(&mut harness).work.model_comparison().iter().map(|rung| rung.preset.key).collect();
    assert_eq!(models.len(), pbrdf::model::PRESETS.len());
    // The pane with the results came to the front, with the names of the list of models.
    let name = "two components, Minnaert diffuse (Zhu)";
    harness.get_all_by_label_contains(name).next().expect("a row of the comparison");
    assert!(harness.query_all_by_label_contains("★").count() == 1, "the best is marked");
}

#[test]
fn a_fixed_parameter_stays() {
    let mut harness = harness();
    harness.get_by_label("Fix sigma").click();
    harness.run();
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters.sigma, Parameters::default().sigma);
}

#[test]
fn a_fit_has_a_band_that_can_be_hidden_and_goes_with_its_measurement() {
    let mut harness = harness();
    let bands = |harness: &mut egui_kittest::Harness<'static, Option<crate::app::shell::app::App>>| {
        explorer(harness).views.get::<crate::app::views::DolpView>().band.get().cloned().unwrap_or_default()
    };
    assert!(bands(&mut harness).is_empty());
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    let around = bands(&mut harness);
    assert_eq!(around.len(), 3);
    for [_, low, high] in around.iter().flatten() {
        assert!(low.is_nan() || (*low <= *high && *low >= 0.0), "{low} {high}");
    }
    // Where the points lie the curve is known better than a single point, whose noise is 0.005.
    let [_, low, high] = *around[0].iter().find(|[x, ..]| *x == 40.0).expect("a direction at 40°");
    let error = 0.5 * (high - low);
    assert!((1e-4..5e-3).contains(&error), "{error}");
    explorer(&mut harness).work.settings_mut().show_band = false;
    harness.run();
    assert!(bands(&mut harness).is_empty());
    explorer(&mut harness).work.settings_mut().show_band = true;
    let rows = (*explorer(&mut harness).work.active().measurement).clone();
    take(explorer(&mut harness), "another".to_owned(), rows);
    wait(&mut harness);
    assert!(bands(&mut harness).is_empty());
}

#[test]
fn measured_lobes_have_a_band_of_their_own() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::OpenExample(2));
    wait(&mut harness);
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    for log in [false, true] {
        explorer(&mut harness).work.settings_mut().log_brdf = log;
        harness.run();
        let explorer = explorer(&mut harness);
        assert!(explorer.work.active().measurement.has_brdf());
        let bands = explorer.views.get::<crate::app::views::LobesView>().band.get().expect("the lobes are on screen");
        assert!(bands.iter().flatten().any(|[_, low, _]| low.is_finite()), "log {log}");
    }
}

#[test]
fn fewer_values_than_free_parameters_are_said_before_and_after_a_fit() {
    let mut harness = harness();
    let mut few = explorer(&mut harness).work.active().measurement.as_ref().clone();
    assert!(harness.query_by_label_contains("measured values cannot determine").is_none());
    few.rows.truncate(3);
    take(explorer(&mut harness), "few.csv".to_owned(), few);
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    harness.run();
    let said = "3 measured values cannot determine 8 free parameters";
    assert_eq!(harness.query_all_by_label_contains(said).count(), 1);
    harness.get_by_label("Fit").click();
    harness.step();
    wait(&mut harness);
    assert_eq!(harness.query_all_by_label_contains(said).count(), 2);
    // With all but three fixed it is no longer true of the next fit.
    explorer(&mut harness).work.surface_mut().locked =
        [Parameter::N, Parameter::K, Parameter::Sigma].into_iter().fold(ParameterSet::ALL, ParameterSet::without);
    harness.run();
    assert_eq!(harness.query_all_by_label_contains(said).count(), 1);
}

#[test]
fn stated_standard_deviations_are_offered_as_weights() {
    let mut harness = harness();
    let offer = "Weight by the stated standard deviations";
    harness.get_by_label(offer).click();
    harness.run();
    assert_eq!(explorer(&mut harness).work.settings().fit_options.weights, Weights::Sigma);
    harness.get_by_label(offer).click();
    harness.run();
    assert_eq!(explorer(&mut harness).work.settings().fit_options.weights, Weights::None);
    let mut bare = explorer(&mut harness).work.active().measurement.as_ref().clone();
    bare.rows[4].dolp = bare.rows[4].dolp.map(|quantity| Quantity { sigma: None, ..quantity });
    take(explorer(&mut harness), "bare.csv".to_owned(), bare);
    harness.run();
    assert!(harness.query_by_label(offer).is_none(), "one value has none");
    explorer(&mut harness).work.apply(Edit::Mask { rows: vec![4], masked: true });
    harness.run();
    assert!(harness.query_by_label(offer).is_some(), "and is masked now");
}

#[test]
fn the_last_fit_stays_in_view_where_the_sliders_or_the_model_have_left_it() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    let has_ghost = |harness: &mut egui_kittest::Harness<'static, Option<crate::app::shell::app::App>>| {
        explorer(harness).derived.companions.iter().any(|companion| companion.look.name == "last fit")
    };
    assert!(!has_ghost(&mut harness), "the sliders are the fit's");
    // The same values, without the diffuse and the volume lobe.
    explorer(&mut harness).actions.push(Action::UseModel("specular"));
    wait(&mut harness);
    assert!(has_ghost(&mut harness));
    // A fit far above the curves of the sliders is on the axis too.
    explorer(&mut harness).actions.push(Action::UseFit);
    wait(&mut harness);
    let high = |harness: &mut egui_kittest::Harness<'static, Option<crate::app::shell::app::App>>| {
        explorer(harness).views.get::<crate::app::views::DolpView>().range().expect("an axis").high
    };
    explorer(&mut harness).work.settings_mut().show_limit = false;
    wait(&mut harness);
    let fitted = high(&mut harness);
    explorer(&mut harness).work.surface_mut().parameters.kd = 10.0;
    wait(&mut harness);
    assert!(high(&mut harness) >= fitted);
}
