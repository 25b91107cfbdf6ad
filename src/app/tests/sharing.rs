//! Shared and own parameters of several measurements.

use crate::app::storage::export::ExportKind;
use crate::app::storage::session::Session;
use crate::app::tests::measurements::{Window, activate, files, number_of, order, three};
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::views::action::{Action, ListAction};
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::sharing::Sharing;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use pbrdf::fit::{Intervals, JointFit, Starts};
use pbrdf::measurement::{Measurement, unwatched};
use pbrdf::model::{Model, PRESETS, Parameter, ParameterSet, Parameters, Pbrdf};
use pbrdf::optics::{Facet, Geometry};

fn shared(harness: &mut Window) -> ParameterSet {
    explorer(harness).work.measurements().shared()
}

/// A parameter of all surfaces, in the order of the list.
pub fn values(harness: &mut Window, parameter: Parameter) -> Vec<f64> {
    explorer(harness).work.measurements().iter().map(|open| open.surface.parameters[parameter]).collect()
}

#[test]
fn the_column_of_shared_and_own_is_there_from_the_second_measurement_on() {
    let mut alone = harness();
    alone.run();
    assert!(alone.query_by_label("Share sigma").is_none() && alone.query_by_label("Measurements of").is_none());
    let (mut harness, _folder) = three();
    assert_eq!(shared(&mut harness), ParameterSet::EMPTY, "files that say nothing are of different samples");
    harness.get_by_label("Share sigma").click();
    harness.run();
    assert_eq!(shared(&mut harness), ParameterSet::EMPTY.with(Parameter::Sigma));
    edit(&mut harness, Edit::SetParameters(Parameters { sigma: 0.125, n: 1.25, ..Parameters::default() }));
    let n = Parameters::default().n;
    assert_eq!((values(&mut harness, Parameter::Sigma), values(&mut harness, Parameter::N)), (vec![0.125; 3], vec![1.25, n, n]));
    activate(&mut harness, "650.csv");
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, n, "the sliders show the surface of the active measurement");
    harness.get_by_label("Share sigma").click();
    harness.run();
    edit(&mut harness, Edit::SetParameters(Parameters { sigma: 0.5, ..Parameters::default() }));
    assert_eq!(values(&mut harness, Parameter::Sigma), [0.125, 0.125, 0.5]);
    for name in ["550.csv", "650.csv"] {
        let number = number_of(&mut harness, name);
        edit(&mut harness, Edit::Close(number));
    }
    assert!(harness.query_by_label("Share sigma").is_none());
}

#[test]
fn presets_share_what_they_say_and_undo_takes_them_back_on_every_surface() {
    let (mut harness, _folder) = three();
    edit(&mut harness, Edit::SetParameters(Parameters { sigma: 0.125, n: 1.25, ..Parameters::default() }));
    let before = values(&mut harness, Parameter::Sigma);
    for sharing in [Sharing::Wavelengths, Sharing::OneDataSet, Sharing::Samples] {
        order(&mut harness, Action::List(ListAction::Share(sharing)));
        assert_eq!(shared(&mut harness), sharing.shared());
        harness.get_by_role_and_label(Role::ComboBox, "Measurements of");
    }
    assert_eq!((values(&mut harness, Parameter::Sigma), values(&mut harness, Parameter::N)), (vec![0.125; 3], vec![1.25; 3]));
    for _ in 0..3 {
        order(&mut harness, Action::Undo);
    }
    assert_eq!((values(&mut harness, Parameter::Sigma), shared(&mut harness)), (before, ParameterSet::EMPTY));
}

const PLATE: &str = "# material: plate\n# wavelength_nm: 450\ntheta_i,theta_r,dolp\n30,20,0.1\n30,40,0.2\n";

#[test]
fn one_material_at_several_wavelengths_opens_with_its_own_n_and_k() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = files(&folder, [("a.csv", PLATE), ("b.csv", &PLATE.replace("450", "650")), ("c.csv", &PLATE.replace("plate", "disc"))]);
    let mut harness = harness();
    order(&mut harness, Action::OpenMeasurements(paths[..2].to_vec()));
    assert_eq!(Sharing::of(shared(&mut harness)), Some(Sharing::Wavelengths));
    order(&mut harness, Action::OpenMeasurements(paths[2..].to_vec()));
    assert_eq!(Sharing::of(shared(&mut harness)), Some(Sharing::Samples), "another material is another sample");
    order(&mut harness, Action::Undo);
    assert_eq!(Sharing::of(shared(&mut harness)), Some(Sharing::Wavelengths));
}

#[test]
fn a_shared_k_s_is_free_where_any_measurement_has_a_brdf_and_an_own_one_where_its_own_has() {
    let folder = tempfile::tempdir().expect("a folder");
    let brdf = "theta_i,theta_r,dolp,brdf\n30,20,0.1,0.3\n30,40,0.2,0.2\n";
    let paths = files(&folder, [("a.csv", brdf), ("b.csv", PLATE)]);
    let mut harness = harness();
    order(&mut harness, Action::OpenMeasurements(paths));
    let fixed = |harness: &mut Window| -> Vec<bool> {
        explorer(harness).work.measurements().iter().map(|open| open.surface.locked.contains(Parameter::Ks)).collect()
    };
    assert_eq!(fixed(&mut harness), [false, true]);
    activate(&mut harness, "b.csv");
    order(&mut harness, Action::List(ListAction::Share(Sharing::OneDataSet)));
    assert_eq!(fixed(&mut harness), [false, false]);
    order(&mut harness, Action::List(ListAction::Share(Sharing::Samples)));
    assert_eq!(fixed(&mut harness), [false, true]);
}

#[test]
fn a_session_keeps_what_is_shared() {
    let (mut source, folder) = three();
    order(&mut source, Action::List(ListAction::Share(Sharing::Wavelengths)));
    let path = folder.path().join("work.pbrdf.json");
    order(&mut source, Action::Export(ExportKind::Session, path.clone()));
    let mut other = harness();
    order(&mut other, Action::OpenSession(path));
    assert_eq!(Sharing::of(shared(&mut other)), Some(Sharing::Wavelengths));
    edit(&mut other, Edit::SetParameters(Parameters { sigma: 0.125, n: 1.25, ..Parameters::default() }));
    assert_eq!(values(&mut other, Parameter::Sigma), [0.125; 3]);
}

/// Three simulated wavelengths of one sample, without noise.
pub fn wavelengths() -> (Window, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let text = |nm: u32, n: f64, k: f64| -> String {
        let surface = Parameters { n, k, sigma: 0.35, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6, ..Parameters::default() };
        let surface = Pbrdf::new(Model::CAUCHY, surface).expect("a surface");
        let angles = [20.0, 40.0, 60.0, 75.0].into_iter().flat_map(|i| [5.0, 25.0, 45.0, 60.0, 75.0].map(|r| (i, r)));
        let row = |(i, r)| {
            let dolp = surface.dolp(&Facet::new(Geometry::new(i, r, 180.0).expect("angles")));
            // Noise that is the same on every machine.
            let noise = 0.004 * libm::sin(f64::from(nm) * 12.9898 + i * 78.233 + r * 37.719);
            format!("{i},{r},{}\n", (dolp + noise).clamp(0.0, 1.0))
        };
        let rows: String = angles.map(row).collect();
        format!("# material: plate\n# wavelength_nm: {nm}\ntheta_i,theta_r,dolp\n{rows}")
    };
    let [blue, green, red] = [(450, 1.6, 2.4), (550, 2.07, 2.9), (650, 2.6, 3.6)].map(|(nm, n, k)| text(nm, n, k));
    let paths = files(&folder, [("blue.csv", &blue), ("green.csv", &green), ("red.csv", &red)]);
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    order(&mut harness, Action::OpenMeasurements(paths));
    (harness, folder)
}

pub fn shown(harness: &mut Window) -> FitEntry {
    FitEntry::clone(explorer(harness).work.shown_fit().expect("a fit"))
}

#[test]
fn fit_fits_all_measurements_together_where_they_share_something() {
    let (mut harness, _folder) = wavelengths();
    harness.get_by_label_contains("3 measurements together. Free and shared: σ, k_d, k_v, q, c, σ_v; own: n, k");
    harness.get_by_role_and_label(Role::Button, "Fit").click();
    wait(&mut harness);
    let sigma = values(&mut harness, Parameter::Sigma);
    let n = values(&mut harness, Parameter::N);
    assert!(sigma.iter().all(|value| *value == sigma[0]) && n[0] < n[1] && n[1] < n[2], "{sigma:?} {n:?}");
    let fit = shown(&mut harness);
    let part = fit.joint.clone().expect("a joint fit");
    assert_eq!((part.of.result.sets.len(), part.set, explorer(&mut harness).work.fit_history().len()), (3, 0, 1));
    // The core's own joint fit of the same data ends at the same minimum.
    let data: Vec<_> = explorer(&mut harness).work.measurements().iter().map(|open| open.measurement.clone()).collect();
    let alone = JointFit::new(data.iter().map(|data| &**data), Model::CAUCHY).own([Parameter::N, Parameter::K]);
    let expected = alone.starts(Starts::One).intervals(Intervals::Linear).run().expect("a fit");
    let (found, expected) = (part.of.result.objective.expect("ΔE"), expected.objective.expect("ΔE"));
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    // The panel shows the active measurement's parameters, the shared ones apart, with intervals.
    assert_eq!(fit.report.parameters.n, n[0]);
    assert_eq!(fit.report.course.intervals_complete, Some(true));
    harness.get_by_label("3 measurements");
    harness.get_by_label_contains("History of fits (1)").click_accesskit();
    harness.run();
    harness.get_by_label_contains("3 together");
    activate(&mut harness, "red.csv");
    assert_eq!((shown(&mut harness).id, shown(&mut harness).report.parameters.n), (fit.id, n[2]));
    order(&mut harness, Action::Undo);
    assert_eq!(values(&mut harness, Parameter::Sigma), [Parameters::default().sigma; 3]);
    order(&mut harness, Action::ReturnToFit(0));
    assert_eq!((values(&mut harness, Parameter::Sigma), values(&mut harness, Parameter::N)), (sigma, n));
}

#[test]
fn a_joint_fit_comes_back_with_its_session_and_after_a_measurement_was_closed() {
    let (mut source, folder) = wavelengths();
    order(&mut source, Action::StartFit);
    let number = number_of(&mut source, "green.csv");
    edit(&mut source, Edit::Close(number));
    let path = folder.path().join("work.pbrdf.json");
    order(&mut source, Action::Export(ExportKind::Session, path.clone()));
    let mut other = harness();
    order(&mut other, Action::OpenSession(path));
    let before = shown(&mut source).joint.expect("a joint fit").of;
    let after = shown(&mut other).joint.expect("a joint fit").of;
    assert_eq!(after.result.describe_undetermined(), before.result.describe_undetermined());
    for ((name, after), (same, before)) in after.result.estimates().zip(before.result.estimates()) {
        assert_eq!((name, after.value, after.interval68, after.interval95), (same, before.value, before.interval68, before.interval95));
    }
    assert_eq!(after.result.course.minima, before.result.course.minima);
    order(&mut other, Action::List(ListAction::Share(Sharing::Samples)));
    order(&mut other, Action::ReturnToFit(0));
    assert_eq!((values(&mut other, Parameter::N).len(), Sharing::of(shared(&mut other))), (3, Some(Sharing::Wavelengths)));
    order(&mut other, Action::StartFit);
    assert_eq!(explorer(&mut other).work.fit_history().len(), 2);
}

#[test]
fn different_samples_are_fitted_one_by_one_by_a_command() {
    let (mut harness, _folder) = wavelengths();
    order(&mut harness, Action::List(ListAction::Share(Sharing::Samples)));
    harness.get_by_label("Fit each").click();
    wait(&mut harness);
    let work = &explorer(&mut harness).work;
    let fits: Vec<(String, bool)> = work.fit_history().iter().map(|fit| (fit.document.clone(), fit.joint.is_none())).collect();
    assert_eq!(fits, [("red.csv".to_owned(), true), ("green.csv".to_owned(), true), ("blue.csv".to_owned(), true)]);
    for open in work.measurements().iter() {
        let fit = work.shown_fit_of(open.number).expect("a fit of each");
        assert_eq!((fit.report.parameters, fit.report.course.intervals_complete), (open.surface.parameters, Some(true)));
    }
}

#[test]
fn names_that_are_the_same_are_refused_in_a_sentence() {
    let (mut harness, _folder) = wavelengths();
    let number = number_of(&mut harness, "red.csv");
    edit(&mut harness, Edit::RenameMeasurement { number, name: "blue.csv".to_owned() });
    order(&mut harness, Action::StartFit);
    let notice = explorer(&mut harness).toasts.take().expect("a sentence");
    assert!(notice.contains("two measurements are called blue.csv"), "{notice}");
}

#[test]
fn a_live_refit_of_several_holds_what_moved_and_fits_the_rest_of_all() {
    let (mut harness, _folder) = wavelengths();
    order(&mut harness, Action::StartFit);
    let before = values(&mut harness, Parameter::N);
    edit(&mut harness, Edit::SetSwitch(Switch::RefitLive, true));
    let parameters = Parameters { sigma: 0.5, ..explorer(&mut harness).work.surface().parameters };
    edit(&mut harness, Edit::SetParameters(parameters));
    let after = values(&mut harness, Parameter::N);
    assert_eq!(values(&mut harness, Parameter::Sigma), [0.5; 3]);
    assert!(after.iter().zip(&before).all(|(after, before)| after != before), "{after:?} {before:?}");
}

#[test]
fn what_the_data_determine_is_that_of_all_together() {
    let (mut harness, _folder) = wavelengths();
    order(&mut harness, Action::StartFit);
    harness.get_by_label("What these data determine").click();
    wait(&mut harness);
    let error = |harness: &mut Window| -> f64 {
        let outlook = explorer(harness).derived.outlook().expect("an outlook");
        let error = outlook.errors.iter().find(|(parameter, _)| *parameter == Parameter::C).expect("c is free");
        error.1.unwrap_or(f64::INFINITY)
    };
    let together = error(&mut harness);
    order(&mut harness, Action::List(ListAction::Share(Sharing::Samples)));
    assert!(together < error(&mut harness), "{together}");
}

#[test]
fn a_bootstrap_of_a_joint_fit_is_about_the_parameters_of_the_active_measurement() {
    let (mut harness, _folder) = wavelengths();
    order(&mut harness, Action::StartFit);
    edit(&mut harness, Edit::SetReplicates(10));
    order(&mut harness, Action::Bootstrap);
    let scatter = explorer(&mut harness).work.diagnostics().scatter.clone().expect("a bootstrap");
    let mut parameters: Vec<Parameter> = scatter.estimates.iter().map(|estimate| estimate.parameter).collect();
    parameters.sort_by_key(|parameter| *parameter as usize);
    let free = Model::CAUCHY.parameters().without(Parameter::Ks);
    assert_eq!((scatter.replicates, parameters), (10, free.iter().collect::<Vec<_>>()));
}

#[test]
fn the_profile_of_a_shared_parameter_is_that_of_all_together() {
    let (mut harness, _folder) = wavelengths();
    order(&mut harness, Action::StartFit);
    order(&mut harness, Action::Profile(Parameter::Sigma));
    let interval = shown(&mut harness).report[Parameter::Sigma].interval68.expect("an interval");
    let profile = explorer(&mut harness).work.diagnostics().profile.as_ref().expect("a profile");
    // Both walks end where the limit is met to a thousandth of the step.
    let [found, _] = profile.intervals;
    let is_near = |one: Option<f64>, other: Option<f64>| one.zip(other).is_some_and(|(one, other)| (one - other).abs() < 1e-4);
    assert!(is_near(found.low, interval.low) && is_near(found.high, interval.high), "{found:?} {interval:?}");
}

#[test]
fn models_are_compared_on_all_measurements_together_where_they_share_something() {
    let (mut harness, _folder) = wavelengths();
    order(&mut harness, Action::CompareModels);
    let work = &explorer(&mut harness).work;
    let numbers: Vec<u64> = work.measurements().iter().map(|open| open.number).collect();
    assert_eq!(work.fit_history().len(), PRESETS.len(), "a joint fit of each model");
    let rows = work.model_comparison();
    assert_eq!(rows.iter().map(|row| row.preset.key).collect::<Vec<_>>(), PRESETS.map(|preset| preset.key));
    for row in rows {
        let fit = row.result.as_ref().expect("a fit");
        let part = fit.joint.as_ref().expect("a joint fit");
        assert_eq!((part.of.result.sets.len(), row.objective()), (3, part.of.result.objective));
    }
    // A model that holds another one as a special case is never worse.
    let delta_e = |key: &str| rows.iter().find(|row| row.preset.key == key).and_then(ModelFit::objective).expect("a ΔE");
    assert!(delta_e("cauchy") <= delta_e("specular") * (1.0 + 1e-9));
    let row = rows.iter().position(|row| row.preset.key == "specular-gauss").expect("a row");
    // Every measurement has its part, and a click on a row takes the values of all.
    activate(&mut harness, "green.csv");
    edit(&mut harness, Edit::UseModelFit(row));
    let work = &explorer(&mut harness).work;
    for number in numbers {
        let open = work.measurements().get(number).expect("it is open");
        let shown = work.shown_fit_of(number).expect("its fit");
        assert_eq!((shown.preset().map(|preset| preset.key), shown.number), (Some("specular-gauss"), number));
        assert_eq!((open.surface.model, open.surface.parameters), (shown.report.model, shown.report.parameters));
    }
    let columns = explorer(&mut harness).results().expect("a table").columns.len();
    assert_eq!(columns, 3 * PRESETS.len());
    // In a session each measurement has its part of every row.
    let session = Session::of(&explorer(&mut harness).work).to_json().expect("memory takes everything");
    let session = Session::read(&session).expect("a session");
    let fits = session.fits.iter().map(|fit| fit.restore(&session.measurements)).collect();
    let again = session.into_work(fits);
    for open in again.measurements().iter() {
        let rows = again.model_comparison_of(open.number);
        assert_eq!(rows.iter().map(|row| row.preset.key).collect::<Vec<_>>(), PRESETS.map(|preset| preset.key));
        assert!(rows.iter().all(|row| row.result.as_ref().is_ok_and(|fit| fit.number == open.number)));
    }
}

#[test]
fn the_table_of_a_joint_fit_holds_all_its_measurements() {
    let (mut harness, folder) = wavelengths();
    order(&mut harness, Action::StartFit);
    let path = folder.path().join("fit.csv");
    order(&mut harness, Action::Export(ExportKind::Fitted, path.clone()));
    let text = std::fs::read_to_string(&path).expect("the export wrote it");
    let fit = shown(&mut harness);
    let joint = fit.joint.expect("a joint fit");
    for part in &joint.of.result.sets {
        assert!(text.contains(&format!("# fitted_n@{}: {}; ", part.name, part.parameters.n)), "{} in {text}", part.name);
    }
    assert!(text.contains(&format!("# fitted_sigma: {}; ", joint.of.result.sets[0].parameters.sigma)));
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let header = "set,wavelength_nm,theta_i,theta_r,dphi,dolp,dolp_model,dolp_residual,brdf_model,brdf_residual";
    assert_eq!((rows[0], rows.len()), (header, 1 + 3 * 20));
    // Read again it is three measurements.
    let again = Measurement::read_sets(text.as_bytes(), &mut unwatched).expect("a measurement");
    assert_eq!(again.iter().map(|set| set.rows.len()).collect::<Vec<_>>(), [20; 3]);
}
