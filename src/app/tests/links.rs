//! A work as a link.

use crate::app::shell::app::App;
use crate::app::shell::app::link::shared_work;
use crate::app::storage::session::Session;
use crate::app::storage::share_link::{LeftOut, LinkError, SharedWork, is_link};
use crate::app::tests::{edit, explorer, harness, take, wait};
use crate::app::text::i18n::Language;
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use egui_kittest::Harness;
use pbrdf::measurement::Measurement;
use pbrdf::model::{ParameterSet, Parameters};

type Window = Harness<'static, Option<App>>;

fn order(harness: &mut Window, action: Action) {
    explorer(harness).actions.push(action);
    wait(harness);
}

/// What is on the clipboard after "Copy link".
fn copied(harness: &mut Window) -> String {
    explorer(harness).actions.push(Action::CopyLink);
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    wait(harness);
    copied.expect("a link")
}

/// The work as a session holds it.
fn text(explorer: &App) -> String {
    Session::of(&explorer.work).to_json().expect("memory takes everything")
}

#[test]
fn the_links_of_all_lessons_open_the_same_step_over_the_users_own_work() {
    let mut window = harness();
    let mut other = harness();
    edit(&mut other, Edit::SetParameters(Parameters { n: 3.25, ..Parameters::default() }));
    let own = text(explorer(&mut other));
    let lessons: Vec<usize> = explorer(&mut window).lessons.all.iter().map(|lesson| lesson.steps.len()).collect();
    for (lesson, steps) in lessons.into_iter().enumerate() {
        order(&mut window, Action::ShowStep(lesson, steps - 1));
        edit(&mut window, Edit::SetParameters(Parameters { sigma: 0.123, ..Parameters::default() }));
        let link = copied(&mut window);
        order(&mut other, Action::OpenLink(link));
        assert_eq!(explorer(&mut other).lessons.open(), Some((lesson, steps - 1)));
        assert_eq!(text(explorer(&mut other)), text(explorer(&mut window)));
    }
    order(&mut other, Action::CloseLesson);
    assert_eq!(text(explorer(&mut other)), own);
}

#[test]
fn a_joint_fit_of_three_measurements_comes_back_to_the_bit() {
    let mut window = harness();
    for (name, sigma) in [("one.csv", 0.2), ("two.csv", 0.3), ("three.csv", 0.4)] {
        let rows: String = (20..60).step_by(5).map(|theta| format!("45,{theta},{},0.01\n", sigma * f64::from(theta) / 60.0)).collect();
        let table = Measurement::read(format!("theta_i,theta_r,dolp,dolp_sigma\n{rows}").as_bytes()).expect("a table");
        take(explorer(&mut window), name.to_owned(), table);
    }
    edit(&mut window, Edit::Share(ParameterSet::ALL));
    order(&mut window, Action::StartFit);
    assert_eq!(explorer(&mut window).work.fit_history().parts(1).count(), 3);
    let link = copied(&mut window);
    assert!(is_link(&link) && link.len() < 32_100, "{}", link.len());
    let mut other = harness();
    order(&mut other, Action::PasteParameters(format!("look: {link} there")));
    assert_eq!(text(explorer(&mut other)), text(explorer(&mut window)));
}

#[test]
fn a_link_has_the_language_and_keeps_the_users_own_work() {
    let mut window = harness();
    explorer(&mut window).window.language = Language::Chinese;
    let link = copied(&mut window);
    let mut other = harness();
    order(&mut other, Action::OpenLink(link));
    assert_eq!(explorer(&mut other).window.language, Language::Chinese);
}

#[test]
fn what_is_damaged_or_too_new_is_refused_and_changes_nothing() {
    let mut window = harness();
    let link = copied(&mut window);
    let (address, letters) = link.split_once("#pbrdf1.").expect("a link");
    assert!(matches!(SharedWork::read("n=2"), Err(LinkError::NoLink)));
    assert!(matches!(SharedWork::read(&format!("{address}#pbrdf2.{letters}")), Err(LinkError::Version { found: 2 })));
    for damaged in [&letters[..letters.len() / 2], &letters.replacen('a', "b", 1), "", "!"] {
        assert!(matches!(SharedWork::read(&format!("{address}#pbrdf1.{damaged}")), Err(LinkError::Damaged)), "{damaged}");
    }
    let before = text(explorer(&mut window));
    order(&mut window, Action::OpenLink(format!("{address}#pbrdf7.{letters}")));
    assert_eq!(text(explorer(&mut window)), before);
    assert!(explorer(&mut window).toasts.iter().any(|toast| toast.text.contains("newer release")));
}

#[test]
fn what_is_too_long_goes_without_fits_and_then_without_measurements() {
    let mut window = harness();
    let mut shared = shared_work(explorer(&mut window));
    assert_eq!(shared.fragment().expect("a link").left_out, LeftOut::Nothing);
    let row = |i: u32| format!("{},{},{}\n", 10.0 + f64::from(i).sqrt() / 7.0, 30.0 + f64::from(i).cbrt(), f64::from(i).sqrt().fract());
    let table: String = (0..5000).map(row).collect();
    let measurement = Measurement::read(format!("theta_i,theta_r,dolp\n{table}").as_bytes()).expect("a table");
    take(explorer(&mut window), "long.csv".to_owned(), measurement);
    shared = shared_work(explorer(&mut window));
    let fragment = shared.fragment().expect("a link");
    assert_eq!(fragment.left_out, LeftOut::FitsAndMeasurements);
    let read = SharedWork::read(&fragment.text).expect("a link");
    assert!(read.work.measurements.is_empty());
    assert_eq!(read.work.settings.surface, shared.work.settings.surface);
}
