//! The landscape: it follows the sliders, knows what lies on it, and a click puts the sliders
//! there.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::fit::Weights;
use pbrdf::model::Parameter;
use pbrdf::optics;

const HINT: &str = "A click puts both sliders there; drag to move, Ctrl+wheel to zoom.";

fn shown() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Landscape)));
    wait(&mut harness);
    harness
}

#[test]
fn it_follows_every_slider_but_its_own_two() {
    let mut harness = shown();
    harness.get_by_label(HINT);
    let before = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key().cloned().expect("a landscape");
    assert_eq!((before.across.count, before.up.count), (256, 256));
    explorer(&mut harness).work.surface_mut().parameters.n = 1.3;
    explorer(&mut harness).work.surface_mut().parameters.k = f64::NAN;
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key(), Some(&before), "n and k are its axes");
    explorer(&mut harness).work.surface_mut().parameters.sigma = 0.2;
    wait(&mut harness);
    assert_ne!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key(), Some(&before));
    assert!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().is_there());
}

#[test]
fn it_is_coarser_while_a_slider_is_dragged() {
    let mut harness = shown();
    let slider = harness.get_by_role_and_label(egui::accesskit::Role::Slider, "σ").rect();
    let at = |x: f32| slider.left_center() + egui::vec2(x, 0.0);
    harness.hover_at(at(30.0));
    harness.run();
    harness.drag_at(at(30.0));
    harness.run();
    harness.hover_at(at(50.0));
    wait(&mut harness);
    let key = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key().cloned().expect("a landscape");
    assert_eq!(key.across.count, 128);
    harness.drop_at(at(50.0));
    wait(&mut harness);
    let key = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key().cloned().expect("a landscape");
    assert_eq!(key.across.count, 256);
}

#[test]
fn nothing_is_computed_off_screen() {
    let mut harness = shown();
    let before = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key().cloned();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ClosePane(PaneId::Landscape)));
    wait(&mut harness);
    explorer(&mut harness).work.surface_mut().parameters.sigma = 0.2;
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key().cloned(), before);
}

#[test]
fn a_map_that_nobody_looks_at_is_not_finished() {
    for pane in [PaneId::Landscape, PaneId::Hemisphere] {
        let mut harness = harness();
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
        wait(&mut harness);
        let before = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key().cloned();
        explorer(&mut harness).work.surface_mut().parameters.sigma = 0.2;
        harness.step();
        let running = |harness: &mut Harness<'static, Option<App>>| {
            let views = &explorer(harness).views;
            if pane == PaneId::Landscape {
                views.get::<crate::app::views::LandscapeView>().is_running()
            } else {
                views.get::<crate::app::views::HemisphereView>().is_running()
            }
        };
        assert!(running(&mut harness), "{pane:?}");
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ClosePane(pane)));
        harness.step();
        assert!(!running(&mut harness), "{pane:?}");
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
        wait(&mut harness);
        let key = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().key().cloned();
        assert!(pane == PaneId::Hemisphere || key != before);
    }
}

#[test]
fn a_click_sets_both_sliders_in_one_step_of_undo() {
    let mut harness = shown();
    let before = explorer(&mut harness).work.surface().parameters;
    let at = harness.get_by_label(HINT).rect().left_top() + egui::vec2(250.0, -120.0);
    harness.hover_at(at);
    harness.run();
    harness.drag_at(at);
    harness.run();
    harness.drop_at(at);
    wait(&mut harness);
    harness.hover_at(at);
    harness.run();
    let after = explorer(&mut harness).work.surface().parameters;
    assert!(after.n != before.n && after.k != before.k, "{after:?}");
    // What is read under the pointer is what the click has set.
    let reading = format!("n = {}, k = {}: ΔE = ", after.n, after.k);
    assert!(harness.query_by_label_contains(&reading).is_some(), "{reading}");
    explorer(&mut harness).actions.push(Action::Undo);
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.surface().parameters, before);
}

#[test]
fn ways_minima_and_metals_lie_on_it() {
    let mut harness = shown();
    let marks = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().marks().expect("marks");
    let sources: usize = optics::metals()
        .expect("the bundled table is whole")
        .iter()
        .map(|metal| metal.sources.iter().filter(|source| source.index_at(650.0).is_ok()).count())
        .sum();
    assert_eq!((marks.ways.len(), marks.minima.len(), marks.metals.len()), (0, 0, sources));
    assert!(marks.text("metals", marks.metals.points[0]).expect("a text").starts_with("silver"));
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    let explorer = explorer(&mut harness);
    let report = &explorer.work.shown_fit().expect("a fit").report;
    let (steps, minima) = (report.course.path.len(), report.course.minima.len());
    let marks = explorer.views.get::<crate::app::views::LandscapeView>().marks().expect("marks");
    assert_eq!((marks.ways.len(), marks.ways[0].len(), marks.minima.len()), (1, steps + 1, minima.min(24)));
    assert!(marks.text("way of the last fit", marks.ways[0].points[0]).expect("a text").contains("evaluation 1"));
    assert!(marks.text("minima", marks.minima.points[0]).expect("a text").contains("minimum 1"));
    // Metals have no place where the axes are others.
    explorer.work.settings_mut().panes.landscape.up = Parameter::Kd;
    wait(&mut harness);
    assert_eq!(
        crate::app::tests::explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().marks().expect("marks").metals.len(),
        0
    );
}

#[test]
fn every_pair_of_parameters_and_every_choice_of_a_fit_is_drawn() {
    let mut harness = shown();
    for across in Parameter::ALL {
        let landscape = &mut explorer(&mut harness).work.settings_mut().panes.landscape;
        (landscape.across, landscape.up) = (across, if across == Parameter::Sigma { Parameter::Q } else { Parameter::Sigma });
        wait(&mut harness);
        assert!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().is_there(), "{}", across.key());
    }
    let landscape = &mut explorer(&mut harness).work.settings_mut().panes.landscape;
    (landscape.across, landscape.up) = (Parameter::N, Parameter::N);
    wait(&mut harness);
    harness.get_by_label("Both axes are the same parameter: choose another one for one of them.");
    explorer(&mut harness).work.settings_mut().panes.landscape.up = Parameter::K;
    explorer(&mut harness).work.settings_mut().fit_options.weights = Weights::Sigma;
    wait(&mut harness);
    assert!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().is_there());
    explorer(&mut harness).work.settings_mut().fit_options.loss = pbrdf::fit::Loss::Huber;
    wait(&mut harness);
    assert!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().is_there());
}

#[test]
fn masked_rows_have_no_landscape() {
    let mut harness = shown();
    let rows = (0..explorer(&mut harness).work.active().measurement.rows.len()).collect();
    explorer(&mut harness).work.apply(Edit::Mask { rows, masked: true });
    wait(&mut harness);
    assert!(!explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().is_there());
    assert!(harness.query_by_label_contains("No landscape").is_some());
}
