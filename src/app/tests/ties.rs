//! Ties between parameters, the range of angles, and weights of measurements.

use crate::app::storage::export::ExportKind;
use crate::app::tests::measurements::{Window, order};
use crate::app::tests::sharing::{shown, values, wavelengths};
use crate::app::tests::{edit, explorer, harness};
use crate::app::views::action::{Action, ListAction};
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::pane_id::PaneId;
use crate::app::work::sharing::Sharing;
use crate::app::work::surface::Surface;
use egui_kittest::kittest::Queryable as _;
use pbrdf::fit::{FitOptions, FitRange, Starts, Tie, TieError};
use pbrdf::model::Parameter::{K, Kd, Kv, N};
use pbrdf::model::{Parameter, Parameters};

/// The active surface with a tie.
fn tied(harness: &mut Window, tie: Tie) -> Result<Surface, TieError> {
    let mut surface = explorer(harness).work.surface().clone();
    surface.set_tie(tie.parameter, Some(tie)).map(|()| surface)
}

fn tie(harness: &mut Window, parameter: Parameter, factor: f64, to: Parameter) {
    let surface = tied(harness, Tie { parameter, factor, to }).expect("a tie");
    edit(harness, Edit::SetSurface(Box::new(surface)));
}

#[test]
fn a_tied_slider_follows_and_is_no_unknown_of_the_fit() {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    tie(&mut harness, Kv, 2.0, Kd);
    harness.get_by_label("Free: n, k, σ, k_d, q, c, σ_v");
    harness.get_by_label("= 2 k_d");
    edit(&mut harness, Edit::SetParameters(Parameters { kd: 0.25, kv: 9.0, ..Parameters::default() }));
    assert_eq!(values(&mut harness, Kv), [0.5]);
    order(&mut harness, Action::StartFit);
    let Parameters { kd, kv, .. } = explorer(&mut harness).work.surface().parameters;
    assert_eq!(kv, 2.0 * kd);
    order(&mut harness, Action::Undo);
    assert_eq!(values(&mut harness, Kv), [0.5]);
}

#[test]
fn a_tie_is_chosen_beside_the_bounds_and_a_circle_is_refused_in_a_sentence() {
    let mut harness = harness();
    edit(&mut harness, Edit::SetSwitch(Switch::Bounds, true));
    tie(&mut harness, K, 1.5, N);
    harness.get_by_label("Factor of the tie of k");
    harness.get_by_label("Tie of n").click();
    harness.run();
    harness.get_by_label("= k").click();
    harness.run();
    let notice = explorer(&mut harness).toasts.take().expect("a sentence");
    assert_eq!(notice, "The ties stay as they are: n → k → n is a circle.");
    assert_eq!(explorer(&mut harness).work.surface().ties, [Tie { parameter: K, factor: 1.5, to: N }]);
    harness.get_by_label("Tie of k").click();
    harness.run();
    harness.get_by_label("not tied").click();
    harness.run();
    assert!(explorer(&mut harness).work.surface().ties.is_empty());
}

#[test]
fn a_joint_fit_and_its_session_keep_ties_range_and_weights() {
    let (mut source, folder) = wavelengths();
    tie(&mut source, K, 1.4, N);
    tie(&mut source, Kv, 1.5, Kd);
    assert!(explorer(&mut source).work.measurements().iter().all(|open| open.surface.ties.len() == 2), "ties are those of all surfaces");
    let range = Some(FitRange { theta_i: [0.0, 70.0], theta_r: [-90.0, 90.0] });
    edit(&mut source, Edit::SetFitOptions(FitOptions { range, ..FitOptions::default() }));
    let number = explorer(&mut source).work.active().number;
    edit(&mut source, Edit::SetWeight { number, weight: 2.0 });
    order(&mut source, Action::StartFit);
    let (n, k) = (values(&mut source, N), values(&mut source, K));
    assert!(n.iter().zip(&k).all(|(n, k)| *k == 1.4 * n) && n[0] != n[1], "{n:?} {k:?}");
    let before = shown(&mut source).joint.expect("a joint fit").of;
    assert_eq!(before.problem.parts().iter().map(pbrdf::fit::Problem::len).collect::<Vec<_>>(), [15; 3], "20 rows, 5 of them at 75°");
    assert!(before.problem.own().contains(K) && !before.problem.own().contains(Kv));
    assert_eq!(before.problem.parts()[0].emphasis(), 1.5, "2 of the mean 4/3");
    let path = folder.path().join("work.pbrdf.json");
    order(&mut source, Action::Export(ExportKind::Session, path.clone()));
    let mut other = harness();
    order(&mut other, Action::OpenSession(path));
    let after = shown(&mut other).joint.expect("a joint fit").of;
    for ((name, after), (same, before)) in after.result.estimates().zip(before.result.estimates()) {
        assert_eq!((name, after.value, after.interval68), (same, before.value, before.interval68));
    }
    let (source, other) = (&explorer(&mut source).work, &explorer(&mut other).work);
    assert_eq!((other.settings().fit_options, other.active().weight), (source.settings().fit_options, 2.0));
    assert_eq!(other.surface(), source.surface());
}

#[test]
fn the_report_of_a_joint_fit_is_about_all_measurements() {
    let (mut harness, folder) = wavelengths();
    order(&mut harness, Action::StartFit);
    let path = folder.path().join("fit.html");
    order(&mut harness, Action::Export(ExportKind::Report, path.clone()));
    let text = std::fs::read_to_string(path).expect("the report");
    for part in ["blue.csv", "green.csv", "red.csv", "Each measurement has its own"] {
        assert!(text.contains(part), "{part}");
    }
}

#[test]
fn options_offer_range_and_weights_where_they_mean_something() {
    let (mut harness, _folder) = wavelengths();
    harness.get_by_label_contains("Options").click();
    harness.run();
    harness.get_by_label("Weight of red.csv");
    harness.get_by_label("only a range").click();
    harness.run();
    harness.get_by_label("θr from");
    assert_eq!(explorer(&mut harness).work.settings().fit_options.range, Some(FitRange::default()));
    order(&mut harness, Action::List(ListAction::Share(Sharing::Samples)));
    assert!(harness.query_by_label("Weight of red.csv").is_none());
}

#[test]
fn rows_outside_the_range_of_a_fit_are_drawn_faintly_and_have_no_residuals() {
    let mut harness = harness();
    harness.run();
    let points = |harness: &mut Window| -> (usize, usize) {
        let explorer = explorer(harness);
        let marks = explorer.derived.marks.get().expect("points");
        marks.series.iter().fold((0, 0), |(used, outside), marks| (used + marks.dolp.used.len(), outside + marks.dolp.outside.len()))
    };
    let all = explorer(&mut harness).work.active().measurement.rows.len();
    assert_eq!(points(&mut harness), (all, 0));
    let range = Some(FitRange { theta_i: [35.0, 90.0], theta_r: [-90.0, 40.0] });
    let fit_options = FitOptions { range, ..explorer(&mut harness).work.settings().fit_options };
    edit(&mut harness, Edit::SetFitOptions(fit_options));
    let rows = &explorer(&mut harness).work.active().measurement.rows;
    let inside = rows.iter().filter(|row| row.geometry.theta_i().0 >= 35.0 && row.geometry.theta_r().0 <= 40.0).count();
    assert!(0 < inside && inside < all);
    assert_eq!(points(&mut harness), (inside, all - inside));
    let figure = explorer(&mut harness).figure(PaneId::Dolp).expect("a figure");
    let names: Vec<&str> = figure.panels[0].series.iter().map(|series| &*series.name).collect();
    assert!(names.contains(&"outside the range of the fit"), "{names:?}");
}
