//! Every bundled lesson is read, and is there in both languages of the window.

use crate::app::work::lesson::{Lesson, Wording};
use std::path::Path;

fn lessons() -> Vec<(String, Lesson)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/lessons");
    let mut lessons: Vec<(String, Lesson)> = std::fs::read_dir(folder)
        .expect("the folder of the lessons")
        .map(|entry| {
            let path = entry.expect("an entry").path();
            let text = std::fs::read_to_string(&path).expect("a text file");
            let lesson = Lesson::from_text(&text).unwrap_or_else(|error| panic!("{}: {error:?}", path.display()));
            (path.display().to_string(), lesson)
        })
        .collect();
    lessons.sort_by(|a, b| a.0.cmp(&b.0));
    lessons
}

#[test]
fn there_are_a_dozen_lessons_and_each_says_what_to_watch_and_why() {
    let lessons = lessons();
    assert!(lessons.len() >= 12, "{}", lessons.len());
    for (path, lesson) in &lessons {
        assert!(!lesson.about.is_empty(), "{path}");
        for step in &lesson.steps {
            assert!(!step.watch.is_empty() && !step.why.is_empty() && !step.action.is_empty(), "{path}: {:?}", step.heading);
        }
    }
}

#[test]
fn every_lesson_is_there_in_chinese() {
    for (path, lesson) in lessons() {
        let steps = lesson.steps.iter().flat_map(|step| [&step.heading, &step.action, &step.watch, &step.why]);
        let missing: Vec<&Wording> =
            [&lesson.title, &lesson.about].into_iter().chain(steps).filter(|text| !text.is_translated("zh")).collect();
        assert!(missing.is_empty(), "{path}: {missing:?}");
    }
}
