//! Where things stand in the window: nothing that is wanted lies outside, and nothing jumps.

use crate::app::shell::app::App;
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::spec;
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

fn order(harness: &mut Harness<'static, Option<App>>, command: Action) {
    explorer(harness).actions.push(command);
    wait(harness);
}

/// Where a plot lies.
fn plot(harness: &Harness<'static, Option<App>>, name: &str) -> egui::Rect {
    harness.get_by_label(name).rect()
}

/// Beside the panels at either side, the arrows and the menu in that line there is room for tabs.
fn bar(harness: &Harness<'static, Option<App>>, tab: egui::Rect) -> egui::Rangef {
    let beside = |label: &str| {
        let rects = harness.query_all_by_label_contains(label).map(|node| node.rect());
        rects.filter(|rect| rect.y_range().contains(tab.center().y)).collect::<Vec<_>>()
    };
    let sliders = harness.get_by_role_and_label(egui::accesskit::Role::Button, "Reset n").rect().right();
    let left = beside("Scroll tabs left").iter().map(egui::Rect::right).fold(sliders, f32::max);
    let right = ["Scroll tabs right", "Show in "].into_iter().flat_map(beside);
    let panel = harness.get_by_role_and_label(egui::accesskit::Role::Button, "Fit").rect().left();
    egui::Rangef::new(left, right.map(|rect| rect.left()).fold(panel, f32::min))
}

#[test]
fn the_tab_of_a_pane_that_is_shown_is_in_view() {
    let mut harness = harness();
    // From the first to the last and back, so that bars are scrolled to either side.
    for &pane in PaneId::ALL.iter().chain(PaneId::ALL.iter().rev()) {
        if !explorer(&mut harness).dock.is_on_screen(pane) {
            order(&mut harness, Action::Window(WindowAction::ShowPane(pane)));
        }
        let tab = harness.query_all_by_label(spec(pane).title).next().expect("a tab").rect();
        let bar = bar(&harness, tab);
        assert!(bar.contains(tab.left()) && bar.contains(tab.right()), "{}: {tab} outside {bar:?}", spec(pane).title);
    }
}

#[test]
fn the_plot_of_dolp_stays_where_it_is_when_nothing_is_left_to_miss() {
    let mut harness = harness();
    let [before, strip] = ["Plot: DoLP against θr", "Plot: residuals of DoLP against θr"].map(|name| plot(&harness, name));
    let rows = (0..explorer(&mut harness).work.active().measurement.rows.len()).collect();
    edit(&mut harness, Edit::Mask { rows, masked: true });
    assert_eq!(plot(&harness, "Plot: DoLP against θr"), before);
    assert_eq!(plot(&harness, "Plot: residuals of DoLP against θr"), strip);
}

#[test]
fn a_measurement_without_dolp_has_no_strip_under_it() {
    let mut harness = harness();
    let mut measurement = (*explorer(&mut harness).work.active().measurement).clone();
    for row in &mut measurement.rows {
        (row.brdf, row.dolp) = (row.dolp, None);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("brdf.csv");
    let mut bytes = Vec::new();
    measurement.write(&mut bytes).expect("a table");
    std::fs::write(&path, bytes).expect("a writable folder");
    order(&mut harness, Action::OpenMeasurements(vec![path]));
    assert!(explorer(&mut harness).dock.is_on_screen(PaneId::Dolp));
    assert!(harness.query_by_label("Plot: residuals of DoLP against θr").is_none());
    // What the BRDF misses stands under the lobes, and not where no BRDF is measured.
    assert!(harness.query_by_label("Plot: relative residuals of BRDF against θr").is_some());
    assert!(self::harness().query_by_label("Plot: relative residuals of BRDF against θr").is_none());
}
