//! The angle planner, and models beside each other.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, take, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::measurement::Columns;
use pbrdf::model::{Parameter, Preset};

fn planner() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Planner)));
    wait(&mut harness);
    harness
}

/// Predicted errors of n with the measured and with the planned angles.
fn errors_of_n(harness: &mut Harness<'static, Option<App>>) -> [Option<f64>; 2] {
    let predictions = explorer(harness).views.get::<crate::app::views::PlannerView>().predictions.get().expect("the planner is on screen");
    [0, 1].map(|i| predictions[i].as_ref().expect("a prediction").error_of(Parameter::N))
}

#[test]
fn planned_angles_are_compared_with_the_measured_ones_and_follow_the_sliders() {
    let mut harness = planner();
    let [now, planned] = errors_of_n(&mut harness);
    // The paper's angles leave n more open than half its own size; dense ones do not.
    assert!(now.expect("determined, badly") > 1.0 && planned.expect("determined") < 0.5);
    harness.get_by_label("With the measured angles there stays open:");
    harness.get_by_role_and_label(Role::Slider, "k").set_value_accesskit(4.5);
    harness.run();
    assert_ne!(errors_of_n(&mut harness)[1], planned);
}

#[test]
fn angles_are_added_and_removed() {
    let mut harness = planner();
    harness.get_by_label("add θi").click_accesskit();
    harness.run();
    assert_eq!(explorer(&mut harness).work.settings().design.counts().0, 9);
    harness.get_by_label("θi 2 from").set_value_accesskit(25.0);
    harness.run();
    assert_eq!(explorer(&mut harness).work.settings().design.theta_i[1].from, 25.0);
    for name in ["Remove θi 2", "Remove θi 1"] {
        harness.get_by_label(name).click_accesskit();
        harness.run();
    }
    assert_eq!(explorer(&mut harness).work.settings().design.counts().0, 0);
    harness.get_by_label_contains("There is no angle");
}

#[test]
fn the_measured_angles_taken_over_predict_what_is_now() {
    let mut harness = planner();
    harness.get_by_label("As measured").click_accesskit();
    harness.run();
    assert_eq!(explorer(&mut harness).work.settings().design.counts(), (3, 9));
    let [now, planned] = errors_of_n(&mut harness).map(|error| error.expect("determined"));
    assert!((now / planned - 1.0).abs() < 1e-6, "{now} {planned}");
}

#[test]
fn a_planned_brdf_lets_ks_be_free() {
    let mut harness = planner();
    let free = |harness: &mut Harness<'static, Option<App>>| {
        let predictions =
            explorer(harness).views.get::<crate::app::views::PlannerView>().predictions.get().expect("the planner is on screen");
        let planned = predictions[1].as_ref().expect("a prediction");
        planned.errors.iter().any(|(parameter, _)| *parameter == Parameter::Ks)
    };
    assert!(!free(&mut harness));
    explorer(&mut harness).work.settings_mut().design.columns = Columns::Both;
    harness.run();
    assert!(free(&mut harness));
    harness.get_by_role_and_label(Role::SpinButton, "Noise of BRDF");
}

#[test]
fn models_stand_beside_each_other_and_one_is_taken_over() {
    let mut harness = harness();
    harness.get_by_label("Models").click();
    harness.run();
    harness.get_by_label("Fit all models").click();
    harness.step();
    wait(&mut harness);
    harness.get_by_label_contains("Cauchy against Gauss (all terms)");
    harness.get_by_label("Starts and where they led").click();
    harness.run();
    harness.get_by_role_and_label(Role::Button, "two components, Minnaert diffuse (Zhu)").click_accesskit();
    harness.run();
    let explorer = explorer(&mut harness);
    let preset = Preset::from_key("minnaert").expect("a preset");
    let rung = explorer.work.model_comparison().iter().find(|rung| rung.preset.key == "minnaert").expect("a rung");
    assert_eq!(explorer.work.surface().model, preset.model);
    assert_eq!(explorer.work.surface().parameters, rung.report().expect("a fit").parameters);
}

#[test]
fn a_model_that_cannot_be_fitted_says_why() {
    let mut harness = harness();
    let mut measurement = (*explorer(&mut harness).work.active().measurement).clone();
    measurement.rows.iter_mut().for_each(|row| row.brdf = row.dolp.take());
    take(explorer(&mut harness), "lobes".to_owned(), measurement);
    harness.get_by_label("Models").click();
    harness.run();
    harness.get_by_label("Fit all models").click();
    harness.step();
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    let skipped: Vec<&str> =
        explorer.work.model_comparison().iter().filter(|rung| rung.result.is_err()).map(|rung| rung.preset.key).collect();
    assert_eq!(skipped, ["fresnel"]);
    harness.get_by_label_contains("skipped: the model predicts DoLP only");
}
