//! Draws from the posterior, the weakest direction, and planned readings.

use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tests::languages::written;
use crate::app::tests::{explorer, harness, take, wait};
use crate::app::views::action::{Action, InquiryAction, WindowAction};
use crate::app::work::design::{AngleRange, DesignGoal};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::fit::posterior::Prior;
use pbrdf::fit::{GeodesicEnd, GeodesicWay};
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters, Pbrdf};
use pbrdf::{Measurement, fit::Loss};

type Window = Harness<'static, Option<App>>;

fn order(harness: &mut Window, action: Action) {
    explorer(harness).actions.push(action);
    wait(harness);
}

fn click_at(harness: &mut Window, at: egui::Pos2) {
    harness.hover_at(at);
    harness.run();
    harness.drag_at(at);
    harness.run();
    harness.drop_at(at);
    wait(harness);
}

/// The example, few draws of few parameters.
fn ready() -> Window {
    let mut harness = harness();
    let free = [Parameter::N, Parameter::K, Parameter::Kd];
    explorer(&mut harness).work.surface_mut().locked = free.into_iter().fold(ParameterSet::ALL, ParameterSet::without);
    explorer(&mut harness).work.settings_mut().panes.posterior.draws = 120;
    harness
}

fn drawn() -> Window {
    let mut harness = ready();
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    harness
}

#[test]
fn draws_are_shown_and_a_click_takes_the_sliders_there() {
    let mut harness = drawn();
    let posterior = explorer(&mut harness).work.posterior().expect("draws").clone();
    assert_eq!((posterior.draws.len(), posterior.is_complete, posterior.summaries.len()), (480, true, 3));
    assert!(explorer(&mut harness).dock.is_on_screen(PaneId::Posterior));
    let figure = explorer(&mut harness).figure(PaneId::Posterior).expect("a corner plot");
    let blank = figure.panels.iter().filter(|panel| panel.is_blank()).count();
    assert_eq!((figure.panels.len(), blank), (9, 3));
    assert!(figure.svg().contains("<svg"));
    harness.get_by_label_contains("480 draws of 27 values");

    let before = explorer(&mut harness).work.surface().parameters;
    let plot = harness.get_by_label_contains("Plot: every free parameter").rect();
    // The panel of n and k_d.
    click_at(&mut harness, plot.min + plot.size() * egui::vec2(0.3, 0.75));
    let after = explorer(&mut harness).work.surface().parameters;
    assert_ne!(before, after);
    assert!(posterior.draws.draws().any(|draw| draw.parameters[0] == after), "{after:?} was not drawn");
    order(&mut harness, Action::Undo);
    assert_eq!(explorer(&mut harness).work.surface().parameters, before);
}

#[test]
fn the_same_seed_gives_the_same_draws_and_priors_are_kept_to() {
    let values = |harness: &mut Window| -> Vec<f64> {
        let drawn = explorer(harness).work.posterior().expect("draws").clone();
        drawn.draws.draws().map(|draw| draw.unknowns[0]).collect()
    };
    let mut harness = drawn();
    let first = values(&mut harness);
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    assert_eq!(values(&mut harness), first);
    let mut options = explorer(&mut harness).work.settings().panes.posterior.clone();
    options.set_prior(Parameter::N, Prior::Uniform { low: 1.9, high: 2.1 });
    explorer(&mut harness).work.apply(Edit::SetPosteriorOptions(options.clone()));
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    assert!(values(&mut harness).iter().all(|n| (1.9..=2.1).contains(n)));
    options.set_prior(Parameter::N, Prior::Uniform { low: 1.9, high: 2100.0 });
    explorer(&mut harness).work.apply(Edit::SetPosteriorOptions(options));
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    assert!(written(&harness).iter().any(|text| text.contains("the prior of n lies outside its bounds")));
}

#[test]
fn what_makes_no_posterior_is_told() {
    let mut harness = ready();
    explorer(&mut harness).work.settings_mut().fit_options.loss = Loss::Huber;
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    assert!(written(&harness).iter().any(|text| text.contains("its likelihood is Gaussian")));
    explorer(&mut harness).work.settings_mut().fit_options.loss = Loss::Squared;
    explorer(&mut harness).work.surface_mut().locked = ParameterSet::ALL;
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    assert!(written(&harness).iter().any(|text| text.contains("no parameter is free: there is nothing to draw")));
    assert!(explorer(&mut harness).work.posterior().is_none());
}

#[test]
fn stopped_draws_are_kept() {
    let mut harness = ready();
    explorer(&mut harness).work.settings_mut().panes.posterior.draws = 100_000;
    explorer(&mut harness).actions.push(Action::Inquire(InquiryAction::DrawPosterior));
    let begun = std::time::Instant::now();
    loop {
        harness.step();
        let drawing = explorer(&mut harness).jobs.posteriors.draw.job().and_then(crate::app::jobs::job::Job::progress);
        if drawing.is_some_and(|drawing| drawing.drawn.is_some()) {
            break;
        }
        assert!(begun.elapsed() < super::PATIENCE, "no draw comes");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    order(&mut harness, Action::Inquire(InquiryAction::CancelPosterior));
    let posterior = explorer(&mut harness).work.posterior().expect("draws").clone();
    assert!(!posterior.is_complete && !posterior.draws.is_empty());
    harness.get_by_label("It was stopped before its end.");
}

#[test]
fn draws_leave_as_a_table_and_stand_in_the_report() {
    let mut harness = drawn();
    order(&mut harness, Action::StartFit);
    let folder = tempfile::tempdir().expect("a folder");
    for (kind, name) in [(ExportKind::Draws, "draws.csv"), (ExportKind::Report, "report.html")] {
        order(&mut harness, Action::Export(kind, folder.path().join(name)));
    }
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("a file");
    let table = text("draws.csv");
    assert_eq!((table.lines().next(), table.lines().count()), (Some("n,k,kd,log_posterior,chain"), 481));
    let report = text("report.html");
    assert!(report.contains("<h2>Posterior</h2>") && report.contains("480 draws by a no-U-turn sampler"));
}

fn simulated(name: &str, n: f64) -> Measurement {
    let simulation = Simulation {
        model_name: String::new(),
        surface: Pbrdf::new(Model::SPECULAR, Parameters { n, ..Parameters::default() }).expect("a surface"),
        theta_i: vec![30.0, 50.0, 70.0],
        theta_r: vec![20.0, 40.0, 60.0, 70.0],
        dphi: 180.0,
        columns: Columns::Dolp,
        noise: 0.005,
        brdf_noise: 0.0,
        seed: 3,
    };
    Measurement { name: name.to_owned(), ..simulation.run().expect("valid angles") }
}

/// Two measurements with their own n; k is shared.
fn two() -> Window {
    let mut harness = harness();
    for (name, n) in [("blue", 1.5), ("red", 2.0)] {
        take(explorer(&mut harness), name.to_owned(), simulated(name, n));
    }
    let first = explorer(&mut harness).work.measurements().iter().next().expect("an example").number;
    if explorer(&mut harness).work.measurements().iter().count() > 2 {
        explorer(&mut harness).work.apply(Edit::Close(first));
    }
    explorer(&mut harness).work.apply(Edit::SetModel(Model::SPECULAR));
    explorer(&mut harness).work.apply(Edit::Share(ParameterSet::EMPTY.with(Parameter::K)));
    let free = [Parameter::N, Parameter::K];
    let locked = free.into_iter().fold(ParameterSet::ALL, ParameterSet::without);
    let numbers: Vec<u64> = explorer(&mut harness).work.measurements().iter().map(|open| open.number).collect();
    for number in numbers {
        explorer(&mut harness).work.apply(Edit::Activate(number));
        let mut surface = explorer(&mut harness).work.surface().clone();
        (surface.locked, surface.model) = (locked, Model::SPECULAR);
        explorer(&mut harness).work.apply(Edit::SetSurface(Box::new(surface)));
    }
    explorer(&mut harness).work.settings_mut().panes.posterior.draws = 120;
    wait(&mut harness);
    harness
}

#[test]
fn several_measurements_have_one_posterior_and_a_draw_moves_the_sliders_of_each() {
    let mut harness = two();
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    let drawn = explorer(&mut harness).work.posterior().expect("draws").clone();
    let names: Vec<String> = drawn.draws.parameters.iter().map(|name| pbrdf::fit::UnknownName::key(name).into_owned()).collect();
    assert_eq!((names.len(), drawn.from.numbers.len()), (3, 2), "{names:?}");
    let draw = drawn.draws.draws().nth(7).expect("a draw");
    let values: Vec<(u64, Parameters)> = drawn.from.numbers.iter().copied().zip(draw.parameters.iter().copied()).collect();
    explorer(&mut harness).work.apply(Edit::UseDraw(values.clone()));
    for (number, parameters) in values {
        assert_eq!(explorer(&mut harness).work.measurements().get(number).expect("open").surface.parameters, parameters);
        explorer(&mut harness).work.apply(Edit::Activate(number));
        assert!(explorer(&mut harness).work.posterior().is_some());
    }
}

#[test]
fn names_along_a_low_corner_plot_do_not_overlap() {
    let mut harness = two();
    harness.set_size(egui::vec2(1024.0, 400.0));
    order(&mut harness, Action::Inquire(InquiryAction::DrawPosterior));
    let upright = |shape: &egui::epaint::ClippedShape| match &shape.shape {
        egui::Shape::Text(text) if text.angle != 0.0 => Some((text.galley.text().to_owned(), text.visual_bounding_rect())),
        _ => None,
    };
    let mut names: Vec<_> = harness.output().shapes.iter().filter_map(upright).filter(|(name, _)| name.starts_with('n')).collect();
    names.sort_by(|(_, a), (_, b)| a.top().total_cmp(&b.top()));
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(names[0].1.bottom() <= names[1].1.top(), "{names:?}");
}

#[test]
fn sliders_walk_to_a_bound_in_one_step_of_undo_and_escape_takes_them_back() {
    let mut harness = harness();
    order(&mut harness, Action::StartFit);
    let fitted = explorer(&mut harness).work.surface().parameters;
    order(&mut harness, Action::Inquire(InquiryAction::Walk(GeodesicWay::Nearer)));
    let (walk, walked) = explorer(&mut harness).work.walk().expect("a way").clone();
    assert_eq!(walked, 1.0);
    let there = explorer(&mut harness).work.surface().parameters;
    if let GeodesicEnd::Bound { unknown, value, .. } = &walk.geodesic.end {
        assert_eq!(there[unknown.parameter], *value);
    }
    assert_ne!(there, fitted);
    assert!(walk.rise(1.0).expect("a rise") <= 1.0 + 1e-9, "the data allow it");
    order(&mut harness, Action::Undo);
    assert_eq!(explorer(&mut harness).work.surface().parameters, fitted);

    explorer(&mut harness).actions.push(Action::Inquire(InquiryAction::Walk(GeodesicWay::Farther)));
    let begun = std::time::Instant::now();
    while explorer(&mut harness).work.walk().is_none_or(|(walk, walked)| walk.way == GeodesicWay::Nearer || *walked < 0.2) {
        harness.step();
        assert!(begun.elapsed() < super::PATIENCE, "nothing moves");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(explorer(&mut harness).jobs.fits.walking_since.is_some());
    harness.key_press(egui::Key::Escape);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters, fitted);
    assert!(explorer(&mut harness).jobs.fits.walking_since.is_none());
}

#[test]
fn readings_are_chosen_and_what_cannot_be_reached_is_said() {
    let mut harness = harness();
    let mut design = explorer(&mut harness).work.settings().design.clone();
    design.theta_i = vec![AngleRange::new(20.0, 60.0, 20.0)];
    design.theta_r = vec![AngleRange::new(0.0, 60.0, 10.0)];
    (design.count, design.goal, design.counts_given, design.noise) = (12, DesignGoal::Index, false, 0.05);
    explorer(&mut harness).work.apply(Edit::SetDesign(design));
    order(&mut harness, Action::Window(WindowAction::ShowPane(PaneId::Planner)));
    harness.get_by_label("Choose for me").click_accesskit();
    wait(&mut harness);
    let design = explorer(&mut harness).work.settings().design.clone();
    assert_eq!(design.readings.len(), 12);
    harness.get_by_label_contains("12 readings tell");
    // Both angles at most 60° and much noise: n stays open, whatever is chosen.
    harness.get_by_label_contains("No choice of 12 of these angles brings n below ±");
    let folder = tempfile::tempdir().expect("a folder");
    order(&mut harness, Action::Export(ExportKind::Plan, folder.path().join("plan.csv")));
    let plan = std::fs::read_to_string(folder.path().join("plan.csv")).expect("a plan");
    assert_eq!((plan.lines().count(), plan.lines().next()), (13, Some("theta_i,theta_r,dphi,dolp")));
    // A click takes a reading out, or adds one.
    let map = harness.get_by_label_contains("Map: what the next reading would gain").rect();
    assert!(map.width() > 150.0, "{map:?}");
    click_at(&mut harness, map.center());
    assert!(explorer(&mut harness).work.settings().design.readings.len().abs_diff(12) == 1);
    assert!(explorer(&mut harness).figure(PaneId::Planner).is_some());
}
