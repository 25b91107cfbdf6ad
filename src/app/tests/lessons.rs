//! Lessons: every step of every one is shown, and sets what it says.

use super::{explorer, harness, wait};
use crate::app::command::Command;
use crate::app::language::Language;
use crate::app::panes::Pane;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::Preset;

#[test]
fn every_step_of_every_lesson_is_shown() {
    let mut harness = harness();
    for lesson in 0..explorer(&mut harness).lessons.all.len() {
        for step in 0..explorer(&mut harness).lessons.all[lesson].steps.len() {
            explorer(&mut harness).commands.push(Command::ShowStep(lesson, step));
            wait(&mut harness);
            let heading = explorer(&mut harness).lessons.all[lesson].steps[step].heading.in_language("en").to_owned();
            assert!(harness.query_all_by_label_contains(&heading).next().is_some(), "{heading}");
            assert_eq!(explorer(&mut harness).notice, None, "{heading}");
            for name in explorer(&mut harness).lessons.all[lesson].steps[step].panes.clone() {
                let pane = Pane::try_from(name.clone()).unwrap_or_else(|error| panic!("{heading}: {error}"));
                assert!(explorer(&mut harness).panes.is_on_screen(pane), "{heading}: {name}");
            }
        }
    }
}

#[test]
fn a_lesson_sets_the_sliders_and_goes_on_at_a_click() {
    let mut harness = harness();
    explorer(&mut harness).commands.push(Command::ShowStep(0, 0));
    harness.run();
    let settings = &explorer(&mut harness).settings;
    assert_eq!((settings.parameters.n, settings.parameters.k, settings.theta_i), (1.5, 0.0, 56.3));
    assert_eq!(Some(settings.model), Preset::from_key("fresnel").map(|preset| preset.model));
    harness.get_by_label("Next step").click();
    harness.run();
    assert_eq!(explorer(&mut harness).lessons.open, Some((0, 1)));
    harness.get_by_label("Close lesson").click();
    harness.run();
    assert_eq!(explorer(&mut harness).lessons.open, None);
}

#[test]
fn lessons_speak_chinese() {
    let mut harness = harness();
    explorer(&mut harness).window.language = Language::Chinese;
    explorer(&mut harness).commands.push(Command::ShowStep(0, 0));
    harness.run();
    assert!(harness.query_by_label_contains("透明表面").is_some());
    assert!(harness.query_by_label("下一步").is_some());
}

#[test]
fn a_damaged_lesson_is_named_and_the_window_goes_on() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    std::fs::write(folder.path().join("bad.txt"), "title: Mine\nstep: One\nset: n=x\n").expect("a file");
    std::fs::write(folder.path().join("good.txt"), "title: Mine\nstep: My own step\nset: n=1.75\n").expect("a file");
    std::fs::write(folder.path().join("latin.txt"), b"title: \xff\n").expect("a file");
    let mut harness = harness();
    let before = explorer(&mut harness).settings.clone();
    explorer(&mut harness).read_lessons(Some(folder.path()));
    harness.run();
    let notice = explorer(&mut harness).notice.clone().expect("a sentence");
    for part in ["bad.txt is no lesson: line 3", "latin.txt is no lesson: "] {
        assert!(notice.contains(part), "{notice}");
    }
    assert_eq!(explorer(&mut harness).settings, before);
    let last = explorer(&mut harness).lessons.all.len() - 1;
    explorer(&mut harness).commands.push(Command::ShowStep(last, 0));
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).settings.parameters.n, 1.75);
    assert!(harness.query_all_by_label_contains("My own step").next().is_some());
}
