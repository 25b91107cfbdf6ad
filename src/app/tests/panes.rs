//! Panes: each opens, what is not on screen is not computed, and the layout survives a restart.

use crate::app::plots::theme;
use crate::app::shell::app::App;
use crate::app::shell::app::autosave::save_settings;
use crate::app::storage::settings_file::load_from;
use crate::app::tests::{explorer, harness, harness_of, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::spec;
use crate::app::work::pane_id::PaneId;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

#[test]
fn every_pane_opens_alone_and_beside_the_others() {
    for pane in PaneId::ALL.iter().copied() {
        let mut harness = harness();
        for other in PaneId::ALL.iter().filter(|other| **other != pane) {
            explorer(&mut harness).actions.push(Action::Window(WindowAction::ClosePane(*other)));
        }
        wait(&mut harness);
        if !explorer(&mut harness).dock.is_on_screen(pane) {
            explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
        }
        wait(&mut harness);
        assert_eq!(explorer(&mut harness).dock.on_screen(), [pane]);
        harness.get_by_label(spec(pane).title);
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ResetLayout));
        wait(&mut harness);
        if !explorer(&mut harness).dock.is_on_screen(pane) {
            explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
            wait(&mut harness);
        }
        assert!(explorer(&mut harness).dock.is_on_screen(pane), "{}", spec(pane).title);
    }
}

#[test]
fn every_show_menu_opens() {
    // That of the picture is there in a talk alone.
    for pane in PaneId::ALL.iter().copied().filter(|pane| spec(*pane).has_options && *pane != PaneId::Picture) {
        let mut harness = harness();
        if !explorer(&mut harness).dock.is_on_screen(pane) {
            explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
            wait(&mut harness);
        }
        harness.get_by_label(&format!("Show in {}", spec(pane).title)).click();
        wait(&mut harness);
    }
}

#[test]
fn what_is_not_on_screen_is_not_computed() {
    let mut harness = harness();
    for pane in PaneId::ALL.iter().copied() {
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ClosePane(pane)));
    }
    harness.run();
    let before = explorer(&mut harness).derived.curves.key().cloned();
    explorer(&mut harness).work.surface_mut().parameters.k = 4.5;
    harness.run();
    assert_eq!(explorer(&mut harness).derived.curves.key().cloned(), before);
    harness.get_by_label("All panes are closed. The View menu opens them again.");
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Lobes)));
    harness.run();
    assert_ne!(explorer(&mut harness).derived.curves.key().cloned(), before);
}

#[test]
fn a_closed_pane_stays_closed_after_a_restart() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ClosePane(PaneId::Lobes)));
    harness.run();
    let path = tempfile::tempdir().expect("a folder").keep().join("settings.json");
    explorer(&mut harness).persistence.settings_path = Some(path.clone());
    save_settings(explorer(&mut harness));
    let mut again = harness_of(load_from(&path).0);
    assert!(!explorer(&mut again).dock.is_on_screen(PaneId::Lobes));
    assert!(explorer(&mut again).dock.is_on_screen(PaneId::Dolp));
}

fn shown(pane: PaneId) -> egui_kittest::Harness<'static, Option<crate::app::shell::app::App>> {
    let mut harness = harness();
    if !explorer(&mut harness).dock.is_on_screen(pane) {
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
    }
    wait(&mut harness);
    harness
}

#[test]
fn every_option_of_every_pane_can_be_switched() {
    for (pane, options) in [
        (PaneId::Dolp, &["Specular share", "with equal σ", "with equal median slope", "Fresnel limit", "Backscatter side"][..]),
        (PaneId::Lobes, &["Logarithmic BRDF", "Filled lobes", "Times cos θr"]),
        (PaneId::PolarLobes, &["Logarithmic radius", "Filled lobes"]),
        (PaneId::Facets, &["Logarithmic densities", "Equal median slope"]),
        (PaneId::Convergence, &["Against time", "Against evaluations"]),
    ] {
        let mut harness = shown(pane);
        for option in options {
            let before = explorer(&mut harness).work.values();
            // The menu may have closed.
            if harness.query_all_by_label(options[0]).next().is_none() {
                harness.get_by_label(&format!("Show in {}", spec(pane).title)).click();
                harness.run();
            }
            // A legend may have an entry of the same name; that of the menu comes first.
            harness.query_all_by_label(option).next().expect("an option").click();
            harness.run();
            assert_ne!(explorer(&mut harness).work.values(), before, "{option}");
        }
    }
}

#[test]
fn views_draw_whatever_the_sliders_hold() {
    use pbrdf::model::{Diffuse, Parameters};
    let ordinary = Parameters::default();
    let odd = [
        Parameters { kd: 0.0, kv: 0.0, ..ordinary },
        Parameters { ks: 0.0, ..ordinary },
        Parameters { ks: 0.0, kd: 0.0, kv: 0.0, ..ordinary },
        Parameters { sigma: 1e-3, q: 20.0, ..ordinary },
        Parameters { sigma: 3.0, q: 1.0001, ..ordinary },
        Parameters { sigma: 1e-30, ..ordinary },
        Parameters { n: 0.0, k: 0.0, ..ordinary },
        Parameters { c: -40.0, ..ordinary },
    ];
    for pane in PaneId::ALL.iter().copied() {
        let mut harness = shown(pane);
        for parameters in odd {
            for logarithmic in [false, true] {
                for specular in [true, false] {
                    let surface = explorer(&mut harness).work.surface_mut();
                    surface.parameters = parameters;
                    surface.model.specular = specular;
                    surface.model.diffuse = if specular { Diffuse::Minnaert } else { Diffuse::Lambert };
                    let settings = explorer(&mut harness).work.settings_mut();
                    settings.log_brdf = logarithmic;
                    settings.view_options.polar_log = logarithmic;
                    settings.view_options.facets_log = logarithmic;
                    settings.view_options.share = true;
                    settings.view_options.filled = logarithmic;
                    settings.view_options.overlay = crate::app::work::settings::Overlay::EqualMedian;
                    wait(&mut harness);
                }
            }
        }
    }
}

#[test]
fn the_way_of_a_fit_is_drawn_after_it() {
    let mut harness = shown(PaneId::Convergence);
    harness.get_by_label("There is no fit yet: press Fit, and its way down is drawn here.");
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    assert!(harness.query_by_label("There is no fit yet: press Fit, and its way down is drawn here.").is_none());
}

#[test]
fn a_landscape_that_was_closed_and_opened_again_is_where_it_was() {
    let mut harness = shown(PaneId::Landscape);
    let before = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().seen().expect("axes");
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ClosePane(PaneId::Landscape)));
    wait(&mut harness);
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Landscape)));
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().seen(), Some(before));
}

/// Whether a curve of that colour is drawn, longer than its sample beside the name.
fn is_drawn(harness: &Harness<'static, Option<App>>, color: fn(bool) -> egui::Color32) -> bool {
    let color = egui::epaint::ColorMode::Solid(color(harness.ctx.global_style().visuals.dark_mode));
    let is_long = |path: &egui::epaint::PathShape| path.visual_bounding_rect().width() > 100.0;
    let line = |shape: &egui::Shape| matches!(shape, egui::Shape::Path(path) if path.stroke.color == color && is_long(path));
    harness.output().shapes.iter().any(|clipped| line(&clipped.shape))
}

#[test]
fn a_click_on_the_name_of_a_line_hides_it_and_another_shows_it() {
    let mut harness = harness();
    for (name, color) in [
        ("diffuse", (|dark| theme::on_screen(crate::app::views::curves::Term::Diffuse.ink(), dark)) as fn(bool) -> egui::Color32),
        ("θi = 40°", |dark| theme::series(1, dark)),
    ] {
        for expected in [true, false, true] {
            assert_eq!(is_drawn(&harness, color), expected, "{name}");
            harness.get_by_role_and_label(Role::CheckBox, name).click();
            harness.run();
        }
    }
}
