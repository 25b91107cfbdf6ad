//! The audit: findings of the sliders' surface, with verdicts and reasons, in both languages.

use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::{Audit, Check, Diffuse, Pbrdf};

fn shown() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Audit)));
    wait(&mut harness);
    harness
}

#[test]
fn every_finding_has_its_number_verdict_and_reason() {
    let mut harness = shown();
    let surface = explorer(&mut harness).work.surface().clone();
    let audit = Audit::new(&Pbrdf::new(surface.model, surface.parameters).expect("the defaults"));
    assert_eq!(explorer(&mut harness).views.get::<crate::app::views::AuditView>().audit(), Some(&audit));
    for finding in &audit.findings {
        assert!(harness.query_all_by_label(finding.why()).next().is_some(), "{:?}", finding.check);
    }
    let passed = audit.findings.iter().filter(|finding| finding.pass).count();
    assert_eq!(harness.query_all_by_label("✓ pass").count(), passed);
    assert_eq!(harness.query_all_by_label("✗ fail").count(), audit.findings.len() - passed);
    let volume = audit.finding(Check::VolumeReciprocity).expect("the model has a volume lobe");
    assert!(!volume.pass);
    harness.get_by_label(&crate::app::text::numbers::short(volume.value));
    let reflectance = audit.finding(Check::Reflectance).expect("always there");
    harness.get_by_label(&format!("{:.4}", reflectance.value));
}

#[test]
fn findings_stand_below_each_other_in_narrow_and_wide_panes() {
    let mut harness = shown();
    for size in [egui::vec2(1280.0, 800.0), egui::vec2(1920.0, 1080.0)] {
        harness.set_size(size);
        wait(&mut harness);
        let audit = explorer(&mut harness).views.get::<crate::app::views::AuditView>().audit().expect("an audit").clone();
        let sentences = audit.findings.iter().map(pbrdf::model::Finding::why);
        let rects: Vec<egui::Rect> = sentences.map(|why| harness.get_by_label(why).rect()).collect();
        for pair in rects.windows(2) {
            assert!(pair[0].bottom() < pair[1].top() && pair[0].left() == pair[1].left(), "{size}: {pair:?}");
            assert!(pair[0].width() > 150.0, "{size}: {pair:?}");
        }
    }
}

#[test]
fn a_surface_that_shines_is_warned_of_and_terms_that_are_absent_are_not_judged() {
    let mut harness = shown();
    explorer(&mut harness).work.surface_mut().parameters.kd = 1.5;
    wait(&mut harness);
    harness.get_by_label_contains("More light leaves than falls on the surface from θi = 0° on.");
    let surface = explorer(&mut harness).work.surface_mut();
    surface.parameters.kd = 0.1;
    surface.model.diffuse = Diffuse::Absent;
    surface.model.volume = false;
    wait(&mut harness);
    harness.get_by_label("Reflectance into all directions, by terms");
    assert!(harness.query_by_label("Reciprocity: volume lobe").is_none());
    assert!(harness.query_by_label("Reciprocity: diffuse lobe").is_none());
}

#[test]
fn nothing_is_audited_behind_another_tab_or_without_a_surface() {
    let mut harness = harness();
    wait(&mut harness);
    assert!(explorer(&mut harness).views.get::<crate::app::views::AuditView>().audit().is_none());
    let mut harness = shown();
    explorer(&mut harness).work.surface_mut().parameters.q = f64::NAN;
    wait(&mut harness);
    assert!(explorer(&mut harness).views.get::<crate::app::views::AuditView>().audit().is_none());
}
