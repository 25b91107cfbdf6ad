//! Masks and the data table.

use crate::app::plots::Range;
use crate::app::shell::app::App;
use crate::app::tests::{explorer, harness, take, wait};
use crate::app::text::i18n::Language;
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::measurement::{Measurement, Quantity, Row};
use pbrdf::optics::Geometry;

/// The window with the table in the middle.
fn table() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    harness.get_by_label("Data table").click();
    // The rows that are seen are known after a frame, and what the model gives in them after
    // another.
    harness.run();
    harness
}

fn masked(harness: &mut Harness<'static, Option<App>>) -> Vec<usize> {
    explorer(harness).work.active().mask().to_vec()
}

#[test]
fn a_row_is_masked_in_the_table_and_counts_no_more() {
    let mut harness = table();
    let before = explorer(&mut harness).derived.delta_e();
    harness.get_by_label("Mask row 3").click();
    harness.run();
    assert_eq!(masked(&mut harness), [2]);
    let explorer = explorer(&mut harness);
    assert_ne!(explorer.derived.delta_e(), before);
    assert_eq!(
        explorer.views.get::<crate::app::views::DolpView>().residuals.of_series.get().into_iter().flatten().map(Vec::len).sum::<usize>(),
        26
    );
    assert_eq!(explorer.derived.marks.get().expect("marks").series.iter().map(|marks| marks.dolp.masked.len()).sum::<usize>(), 1);
    assert!(explorer.work.active().description().contains("27 rows, 1 masked"));
}

#[test]
fn a_series_is_masked_as_a_whole_and_back() {
    let mut harness = table();
    harness.get_by_label("Series (3)").click();
    harness.run();
    harness.get_by_role_and_label(Role::CheckBox, "mask θi = 30°: 0 of 9 rows masked").click();
    harness.run();
    assert_eq!(masked(&mut harness), (0..9).collect::<Vec<_>>());
    harness.get_by_role_and_label(Role::CheckBox, "mask θi = 30°: 9 of 9 rows masked").click();
    harness.run();
    assert!(masked(&mut harness).is_empty());
}

#[test]
fn masks_survive_fits_and_are_undone() {
    let mut harness = table();
    explorer(&mut harness).work.apply(Edit::Mask { rows: vec![0, 5, 7], masked: true });
    harness.run();
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    assert_eq!(masked(&mut harness), [0, 5, 7]);
    assert_eq!(explorer(&mut harness).work.shown_fit().expect("a fit").problem.len(), 24);
    for expected in [vec![0, 5, 7], vec![]] {
        explorer(&mut harness).actions.push(Action::Undo);
        harness.run();
        assert_eq!(masked(&mut harness), expected);
    }
    explorer(&mut harness).actions.push(Action::Redo);
    harness.run();
    assert_eq!(masked(&mut harness), [0, 5, 7]);
}

#[test]
fn a_measurement_with_everything_masked_is_no_disaster() {
    let mut harness = table();
    explorer(&mut harness).work.apply(Edit::Mask { rows: (0..27).collect(), masked: true });
    harness.run();
    assert_eq!(explorer(&mut harness).derived.delta_e(), None);
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    let report = &explorer(&mut harness).work.shown_fit().expect("an answer").report;
    assert_eq!(report.stop_reason, pbrdf::fit::StopReason::NoData);
}

#[test]
fn masks_are_saved_and_read_back() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("masked.csv");
    std::fs::write(&path, "what was there before").expect("a writable folder");
    let mut harness = table();
    explorer(&mut harness).work.apply(Edit::Mask { rows: vec![1, 26], masked: true });
    explorer(&mut harness).actions.push(Action::SaveMeasurement(path.clone()));
    wait(&mut harness);
    let text = std::fs::read(&path).expect("a file");
    let read = pbrdf::measurement::Measurement::read(text.as_slice()).expect("a measurement");
    let explorer = explorer(&mut harness);
    assert_eq!(read.rows, explorer.work.active().measurement.rows);
    assert_eq!(read.metadata, explorer.work.active().measurement.metadata);
    assert_eq!(read.rows.iter().filter(|row| row.masked).count(), 2);
    assert!(explorer.toasts.text().is_some_and(|notice| notice.contains("saved")));

    explorer.actions.push(Action::SaveMeasurement(folder.path().join("no such folder").join("x.csv")));
    wait(&mut harness);
    assert!(self::explorer(&mut harness).toasts.text().is_some_and(|notice| notice.contains("cannot be written")));
}

#[test]
fn a_million_rows_scroll_and_only_the_seen_ones_are_evaluated() {
    let rows = (0..1_000_000_u32).map(|i| Row {
        geometry: Geometry::new(f64::from(i % 8) * 10.0, f64::from(i % 89), 180.0).expect("a geometry"),
        dolp: Some(Quantity { value: f64::from(i % 1000) / 1000.0, sigma: None }),
        brdf: None,
        masked: false,
    });
    let measurement = Measurement { rows: rows.collect(), ..Measurement::default() };
    let mut harness = table();
    take(explorer(&mut harness), "long".to_owned(), measurement);
    assert!(explorer(&mut harness).dock.is_on_screen(PaneId::Data));
    harness.run();
    harness.get_by_label("Mask row 1");
    let middle = harness.get_by_label("Mask row 4").rect().center();
    harness.hover_at(middle);
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::vec2(0.0, -1e9),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: egui::Modifiers::NONE,
    });
    // A long wheel is spread over frames.
    for _ in 0..40 {
        harness.step();
    }
    harness.get_by_label("Mask row 1000000");
    let view = explorer(&mut harness).views.get::<crate::app::views::DataView>();
    let (_, _, _, seen) = view.predicted.key().expect("what is seen is evaluated");
    assert_eq!(seen.end, 1_000_000);
    assert!(seen.len() < 100, "{seen:?}");
    assert_eq!(view.predicted.get().map(Vec::len), Some(seen.len()));
}

/// Clicks there with those keys held.
fn click_with(harness: &mut Harness<'static, Option<App>>, at: egui::Pos2, modifiers: egui::Modifiers) {
    harness.event(egui::Event::ModifiersChanged(modifiers));
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false] {
        harness.event(egui::Event::PointerButton { pos: at, button: egui::PointerButton::Primary, pressed, modifiers });
        harness.step();
    }
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::NONE));
    harness.step();
}

#[test]
fn a_click_with_ctrl_masks_the_point_under_it_and_with_shift_its_series() {
    let mut harness = harness();
    // Points are 5° apart, which is less than three times the distance that a click may miss them
    // by.
    let places = [650.0, 660.0, 670.0_f32].into_iter().flat_map(|x| (8..38_u16).map(move |y| egui::pos2(x, 10.0 * f32::from(y))));
    let hit = places.into_iter().find(|&at| {
        click_with(&mut harness, at, egui::Modifiers::COMMAND);
        !masked(&mut harness).is_empty()
    });
    let hit = hit.expect("a point");
    let one = masked(&mut harness);
    assert_eq!(one.len(), 1);
    // A plain click leaves it, a second one with the key takes it back.
    click_with(&mut harness, hit, egui::Modifiers::NONE);
    assert_eq!(masked(&mut harness), one);
    click_with(&mut harness, hit, egui::Modifiers::COMMAND);
    assert!(masked(&mut harness).is_empty());
    click_with(&mut harness, hit, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT);
    let series = masked(&mut harness);
    assert!(series.len() == 9 && series.contains(&one[0]), "{series:?}");
}

/// Where that point of the lobes is on the screen.
fn place_in_lobes(harness: &mut Harness<'static, Option<App>>, theta_r: f64, brdf: f64) -> egui::Pos2 {
    let rect = harness.get_by_label("Plot: BRDF against θr").rect();
    let App { work, derived, views, .. } = explorer(harness);
    let (x, y) = (derived.curves.key().expect("curves").x(), views.get::<crate::app::views::LobesView>().range().expect("curves"));
    let value = if work.settings().log_brdf { libm::log10(brdf) } else { brdf };
    let share = |range: Range, value: f64| (value - range.low) / (range.high - range.low);
    #[expect(clippy::cast_possible_truncation, reason = "a place on the screen")]
    let [across, up] = [share(x, theta_r), share(y, value)].map(|share| share as f32);
    rect.left_bottom() + egui::vec2(across * rect.width(), -up * rect.height())
}

#[test]
fn points_of_a_hidden_series_cannot_be_clicked() {
    let mut harness = harness();
    // Its names are those of the lobes, too.
    explorer(&mut harness).actions.extend([Action::OpenExample(2), Action::Window(WindowAction::ClosePane(PaneId::Dolp))]);
    wait(&mut harness);
    let series = explorer(&mut harness).work.active().series[0].clone();
    let mark = &series.brdf[series.brdf.len() / 2];
    let at = place_in_lobes(&mut harness, mark.theta_r, mark.quantity.value);
    let is_masked = |harness: &mut Harness<'static, Option<App>>| {
        let rows = masked(harness);
        explorer(harness).work.apply(Edit::Mask { rows: rows.clone(), masked: false });
        harness.run();
        rows.iter().any(|row| series.rows.contains(row))
    };
    click_with(&mut harness, at, egui::Modifiers::COMMAND);
    assert!(is_masked(&mut harness), "{at:?}");
    harness.get_by_role_and_label(Role::CheckBox, &series.name()).click();
    harness.run();
    click_with(&mut harness, at, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT);
    assert!(!is_masked(&mut harness), "what is not drawn");
}

#[test]
fn a_lobe_that_is_hidden_stays_so_in_another_language() {
    let mut harness = harness();
    let is_shown = |harness: &Harness<'static, Option<App>>, name: &str| {
        harness.get_by_role_and_label(Role::CheckBox, name).accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    harness.get_by_role_and_label(Role::CheckBox, "total").click();
    harness.run();
    assert!(!is_shown(&harness, "total") && is_shown(&harness, "specular"));
    explorer(&mut harness).actions.push(Action::Window(WindowAction::SetLanguage(Language::Chinese)));
    harness.run_steps(3);
    assert!(!is_shown(&harness, "总和") && is_shown(&harness, "镜面"));
}

#[test]
fn a_mask_changed_after_a_fit_is_told() {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    assert!(harness.query_by_label("The mask has changed since this fit.").is_none());
    explorer(&mut harness).work.apply(Edit::Mask { rows: vec![4], masked: true });
    harness.run();
    harness.get_by_label("The mask has changed since this fit.");
}
