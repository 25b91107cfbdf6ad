//! Texts that were made while the window spoke one language, and are shown when it speaks another.

use crate::app::shell::app::App;
use crate::app::tests::languages::written;
use crate::app::tests::{explorer, harness, take, wait};
use crate::app::text::i18n::{Language, translated};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use pbrdf::fit::Starts;
use pbrdf::measurement::{Measurement, Quantity, Row};
use pbrdf::optics::Geometry;

type Window = Harness<'static, Option<App>>;

fn order(harness: &mut Window, command: Action) {
    explorer(harness).actions.push(command);
    wait(harness);
}

/// Whether that is written somewhere, before and after the window changes to Chinese.
fn is_there_in_both(harness: &mut Window, part: &str) -> [bool; 2] {
    let is_there = |harness: &Window| written(harness).iter().any(|text| text.contains(part));
    let before = is_there(harness);
    order(harness, Action::Window(WindowAction::SetLanguage(Language::Chinese)));
    harness.run_steps(3);
    [before, is_there(harness)]
}

#[test]
fn what_a_pointer_reads_on_the_landscape() {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    order(&mut harness, Action::StartFit);
    explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Landscape)));
    harness.run_steps(4);
    // In an unoptimised build its maps take half a minute: nobody waits for them.
    for (language, part) in [(Language::English, "starts that ended there"), (Language::Chinese, "到达此处的起点数")] {
        explorer(&mut harness).actions.push(Action::Window(WindowAction::SetLanguage(language)));
        harness.run_steps(4);
        let marks = explorer(&mut harness).views.get::<crate::app::views::LandscapeView>().marks().expect("marks");
        let text = marks.text(&translated("minima"), marks.minima.points[0]).expect("a minimum");
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn why_nothing_is_predicted() {
    let mut harness = harness();
    explorer(&mut harness).dock.show(PaneId::Planner);
    explorer(&mut harness).work.settings_mut().design.theta_r.clear();
    wait(&mut harness);
    assert_eq!(is_there_in_both(&mut harness, "There is no angle"), [true, false]);
}

#[test]
fn what_is_not_drawn() {
    let rows = (0..200_u32).map(|i| Row {
        geometry: Geometry::new(f64::from(i) * 0.4, 30.0, 180.0).expect("a geometry"),
        dolp: Some(Quantity { value: 0.1, sigma: None }),
        brdf: None,
        masked: false,
    });
    let mut harness = harness();
    take(explorer(&mut harness), "many".to_owned(), Measurement { rows: rows.collect(), ..Measurement::default() });
    wait(&mut harness);
    assert_eq!(is_there_in_both(&mut harness, "angles of incidence are drawn"), [true, false]);
}
