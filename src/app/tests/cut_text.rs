//! Text against its room: in every pane, at the sizes of a small window, a projector and a large screen, in both
//! languages, no text is cut, lies over another or runs out of the window.

use crate::app::shell::app::App;
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::tests::measurements::{files, three};
use crate::app::tests::snapshots::report;
use crate::app::tests::{edit, explorer, harness, wait};
use crate::app::text::help::Help;
use crate::app::text::i18n::{Language, translated};
use crate::app::views::action::{Action, ListAction, WindowAction};
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::pane_id::PaneId;
use crate::app::work::picture_options::{PictureCompanion, PictureOptions};
use crate::app::work::sharing::Sharing;
use egui::accesskit::Role;
use egui::epaint::{ClippedShape, TextShape};
use egui::{Key, Modifiers, Rect, Shape, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::model::Parameter;

type Window = Harness<'static, Option<App>>;

/// In points: the least window, 1366 × 768 pixels at zoom 1.5, the first size of a window, and 1920 × 1080 pixels, which
/// are 3840 × 2160 at zoom 2.
const SIZES: [Vec2; 4] = [vec2(1024.0, 640.0), vec2(1366.0 / 1.5, 512.0), vec2(1280.0, 800.0), vec2(1920.0, 1080.0)];

/// What half of the last number of a horizontal axis takes beside its plot, in points.
const NUMBER: f32 = 6.0;

/// What rounding to pixels may move, in points.
const ROUNDING: f32 = 1.0;

/// A text on the screen.
struct Written {
    text: String,
    /// Where its letters are.
    rect: Rect,
    /// What is seen of that.
    seen: Rect,
    /// What it is cut by.
    clip: Rect,
    /// Whether it ends in `…` for want of room.
    is_elided: bool,
}

/// Collects texts, line by line; what a filled shape covers is taken away, and what a dialog or a menu covers in part.
fn collect(shape: &Shape, clip: Rect, out: &mut Vec<Written>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, clip, out)),
        Shape::Rect(rect) if rect.fill.is_opaque() => {
            let cover = rect.rect.intersect(clip).expand(ROUNDING);
            let is_dialog = cover.width() > DIALOG.x && cover.height() > DIALOG.y;
            out.retain(|text| !(cover.contains_rect(text.seen) || is_dialog && cover.intersects(text.seen)));
        }
        Shape::Text(text) => lines(text, clip, out),
        _ => {}
    }
}

/// What is larger than this, in points, and filled, lies over the window.
const DIALOG: Vec2 = vec2(100.0, 60.0);

/// The lines of a text.
fn lines(text: &TextShape, clip: Rect, out: &mut Vec<Written>) {
    let last = text.galley.rows.len().saturating_sub(1);
    for (i, row) in text.galley.rows.iter().enumerate() {
        let line: String = row.glyphs.iter().map(|glyph| glyph.chr).collect();
        let at = row.visuals.mesh_bounds.translate(row.pos.to_vec2());
        let rect = if text.angle == 0.0 { at.translate(text.pos.to_vec2()) } else { text.visual_bounding_rect() };
        let seen = rect.intersect(clip);
        if seen.is_positive() && !line.trim().is_empty() {
            let is_elided = text.galley.elided && i == last;
            let text = if is_elided { text.galley.text().to_owned() } else { line };
            out.push(Written { text, rect, seen, clip, is_elided });
        }
    }
}

fn written(shapes: &[ClippedShape]) -> Vec<Written> {
    let mut out = Vec::new();
    shapes.iter().for_each(|clipped| collect(&clipped.shape, clipped.clip_rect, &mut out));
    out
}

/// Texts of all that is written, without what scrolling brings into sight.
fn faults(harness: &mut Window, size: Vec2) -> Vec<String> {
    let window = Rect::from_min_size(egui::Pos2::ZERO, size);
    let texts = written(&harness.output().shapes);
    assert!(texts.len() > 20, "{}", texts.len());
    let mut faults = Vec::new();
    let (mut across_cut, mut below_cut) = (Vec::new(), Vec::new());
    for text in &texts {
        let whole = text.clip.intersect(window).expand(ROUNDING);
        if text.is_elided && !may_be_long(&text.text, harness) {
            faults.push(format!("elided: {:?} at {}", text.text, text.rect));
        }
        let across = text.rect.left() < whole.left() || text.rect.right() > whole.right();
        let below = text.rect.bottom() > whole.bottom();
        for (is_cut, cut) in [(across, &mut across_cut), (below, &mut below_cut)] {
            if is_cut {
                cut.push(text);
            }
        }
    }
    for plot in harness.query_all_by_role(Role::Image) {
        let (rect, name) = (plot.rect(), plot.accesskit_node().label());
        // A plot in a list may lie below the window, but none at a side of it.
        if rect.width() > DIALOG.x && (rect.left() < -ROUNDING || rect.right() > size.x - NUMBER + ROUNDING) {
            faults.push(format!("at a side: {name:?} at {rect}"));
        }
    }
    for (i, one) in texts.iter().enumerate() {
        for other in &texts[i + 1..] {
            let both = one.seen.intersect(other.seen);
            if both.width() > ROUNDING && both.height() > ROUNDING {
                faults.push(format!("over another: {:?} at {} and {:?} at {}", one.text, one.seen, other.text, other.seen));
            }
        }
    }
    for (cut, way) in [(across_cut, vec2(-53.0, 0.0)), (below_cut, vec2(0.0, -53.0))] {
        let mut tried: Vec<(Rect, bool)> = Vec::new();
        for text in cut {
            let known = tried.iter().find(|(clip, _)| *clip == text.clip).map(|(_, scrolls)| *scrolls);
            let scrolls = known.unwrap_or_else(|| scrolls(harness, text, way));
            tried.push((text.clip, scrolls));
            if !scrolls {
                let edge = if way.x == 0.0 { "below" } else { "at a side" };
                faults.push(format!("cut {edge}: {:?} at {} in {}", text.text, text.rect, text.clip));
            }
        }
    }
    faults
}

/// How far off something scrolls together with a text, in points.
const NEAR: Vec2 = vec2(150.0, 250.0);

/// Whether the wheel brings a text into sight that is cut.
fn scrolls(harness: &mut Window, text: &Written, way: Vec2) -> bool {
    let turn = |harness: &mut Window, delta: Vec2| {
        harness.hover_at(text.seen.center());
        harness.run_steps(2);
        let (unit, phase, source) = (egui::MouseWheelUnit::Point, egui::TouchPhase::Move, egui::MouseWheelSource::Unknown);
        harness.event(egui::Event::MouseWheel { unit, delta, phase, source, modifiers: egui::Modifiers::NONE });
        harness.run_steps(12);
    };
    // A tooltip may cover some; whatever else lies near tells as well.
    let near = text.rect.expand2(NEAR);
    let places = |harness: &Window| -> Vec<(String, egui::Pos2)> {
        let all = written(&harness.output().shapes).into_iter().filter(|other| near.intersects(other.rect));
        all.map(|other| (other.text, other.rect.min)).collect()
    };
    let before = places(harness);
    turn(harness, way);
    let is_moved = |(text, at): &(String, egui::Pos2)| {
        let steps = before.iter().filter(|(other, _)| other == text).map(|(_, other)| *at - *other);
        let along = |step: Vec2| {
            step.dot(way.normalized()) > ROUNDING && (step - step.dot(way.normalized()) * way.normalized()).length() < ROUNDING
        };
        steps.clone().all(|step| step.length() > ROUNDING) && steps.clone().any(along)
    };
    let moved = places(harness).iter().any(is_moved);
    turn(harness, -way);
    harness.remove_cursor();
    harness.run_steps(2);
    moved
}

/// Names that users give may be of any length: longer ones than this, in letters, are cut, and whole where the pointer rests.
const NAME: usize = 25;

fn may_be_long(text: &str, harness: &mut Window) -> bool {
    text.chars().count() > NAME && explorer(harness).work.measurements().iter().any(|open| open.title() == text)
}

fn settle(harness: &mut Window, pane: PaneId) {
    if pane == PaneId::Landscape {
        // In an unoptimised build its maps take half a minute: nobody waits for them.
        harness.run_steps(4);
    } else {
        wait(harness);
    }
}

/// Puts that pane alone on screen.
fn alone(harness: &mut Window, pane: PaneId) {
    for other in PaneId::ALL.iter().copied() {
        explorer(harness).actions.push(Action::Window(WindowAction::ClosePane(other)));
    }
    explorer(harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
    settle(harness, pane);
}

const LANGUAGES: [Language; 2] = [Language::English, Language::Chinese];

/// The window in that language.
fn spoken(mut harness: Window, language: Language) -> Window {
    explorer(&mut harness).actions.push(Action::Window(WindowAction::SetLanguage(language)));
    wait(&mut harness);
    harness
}

/// What is found at all sizes, with where it was found.
fn at_all_sizes(harness: &mut Window, place: &str, found: &mut Vec<String>) {
    for size in SIZES {
        harness.set_size(size);
        wait(harness);
        found.extend(faults(harness, size).into_iter().map(|fault| format!("{place}, {} × {}: {fault}", size.x, size.y)));
    }
}

/// Looks for faults in each language, and asserts that there is none.
fn in_each_language(mut look: impl FnMut(Language, &mut Vec<String>)) {
    let mut found = Vec::new();
    for language in LANGUAGES {
        look(language, &mut found);
    }
    assert!(found.is_empty(), "{} faults\n{}", found.len(), found.join("\n"));
}

fn act(harness: &mut Window, action: Action) {
    explorer(harness).actions.push(action);
    wait(harness);
}

#[test]
fn panes() {
    in_each_language(|language, found| {
        let mut harness = spoken(harness(), language);
        act(&mut harness, Action::StartFit);
        for pane in PaneId::ALL.iter().copied() {
            alone(&mut harness, pane);
            for size in SIZES {
                harness.set_size(size);
                settle(&mut harness, pane);
                found.extend(
                    faults(&mut harness, size).into_iter().map(|fault| format!("{pane:?} {language:?} {} × {}: {fault}", size.x, size.y)),
                );
            }
        }
    });
}

#[test]
fn two_panes_and_panels() {
    in_each_language(|language, found| {
        let mut harness = spoken(harness(), language);
        at_all_sizes(&mut harness, &format!("start {language:?}"), found);
        act(&mut harness, Action::Toggle(Switch::Bounds));
        explorer(&mut harness).work.surface_mut().set_bounds(Parameter::N, 0.5, 3.0).expect("bounds");
        act(&mut harness, Action::List(ListAction::PinOtherDistribution));
        at_all_sizes(&mut harness, &format!("bounds {language:?}"), found);
        act(&mut harness, Action::CompareModels);
        alone(&mut harness, PaneId::Models);
        at_all_sizes(&mut harness, &format!("models {language:?}"), found);
    });
}

#[test]
fn panels_unfolded() {
    in_each_language(|language, found| {
        let mut harness = spoken(harness(), language);
        act(&mut harness, Action::StartFit);
        // Their titles, or how they begin, as far as they are there.
        for title in ["Options", "What these data determine", "Profile and bootstrap", "Correlations"] {
            let title = translated(title);
            harness.set_size(SIZES[3]);
            wait(&mut harness);
            let Some(heading) = harness.query_all_by_label(&title).next() else { panic!("{title}") };
            heading.click_accesskit();
            wait(&mut harness);
            at_all_sizes(&mut harness, &format!("{title} {language:?}"), found);
        }
        act(&mut harness, Action::Bootstrap);
        at_all_sizes(&mut harness, &format!("bootstrap {language:?}"), found);
        act(&mut harness, Action::Profile(Parameter::N));
        at_all_sizes(&mut harness, &format!("profile {language:?}"), found);
    });
}

#[test]
fn several_measurements() {
    in_each_language(|language, found| {
        let (harness, _folder) = three();
        let mut harness = spoken(harness, language);
        at_all_sizes(&mut harness, &format!("three {language:?}"), found);
        act(&mut harness, Action::List(ListAction::Share(Sharing::Wavelengths)));
        act(&mut harness, Action::Toggle(Switch::Bounds));
        at_all_sizes(&mut harness, &format!("shared {language:?}"), found);
    });
}

#[test]
fn lessons() {
    in_each_language(|language, found| {
        let mut harness = spoken(harness(), language);
        for lesson in 0..explorer(&mut harness).lessons.all.len() {
            for step in 0..explorer(&mut harness).lessons.all[lesson].steps.len() {
                act(&mut harness, Action::ShowStep(lesson, step));
                at_all_sizes(&mut harness, &format!("lesson {} step {} {language:?}", lesson + 1, step + 1), found);
            }
        }
    });
}

#[test]
fn presentations() {
    in_each_language(|language, found| {
        let mut harness = spoken(harness(), language);
        // The harness is in points already.
        explorer(&mut harness).window.talk.zoom = 1.0;
        act(&mut harness, Action::Window(WindowAction::Present));
        at_all_sizes(&mut harness, &format!("two {language:?}"), found);
        for pane in [PaneId::Picture, PaneId::Hemisphere] {
            act(&mut harness, Action::Window(WindowAction::ShowPane(pane)));
        }
        at_all_sizes(&mut harness, &format!("four {language:?}"), found);
        for pane in [PaneId::Dolp, PaneId::Lobes, PaneId::Hemisphere] {
            act(&mut harness, Action::Window(WindowAction::ClosePane(pane)));
        }
        at_all_sizes(&mut harness, &format!("picture {language:?}"), found);
        let halves = PictureOptions { companion: PictureCompanion::OtherDistribution, ..PictureOptions::default() };
        edit(&mut harness, Edit::SetPictureOptions(halves));
        at_all_sizes(&mut harness, &format!("halves {language:?}"), found);
    });
}

#[test]
fn presented_lessons() {
    in_each_language(|language, found| {
        let mut harness = spoken(harness(), language);
        explorer(&mut harness).window.talk.zoom = 1.0;
        for lesson in 0..explorer(&mut harness).lessons.all.len() {
            act(&mut harness, Action::ShowStep(lesson, 0));
            act(&mut harness, Action::Window(WindowAction::Present));
            assert!(explorer(&mut harness).dock.is_presented());
            at_all_sizes(&mut harness, &format!("presented lesson {} {language:?}", lesson + 1), found);
            act(&mut harness, Action::Window(WindowAction::Present));
        }
    });
}

#[test]
fn reports() {
    in_each_language(|language, found| {
        for (subject, pane) in [
            (BenchmarkId::Stability, PaneId::Stability),
            (BenchmarkId::Cost, PaneId::Cost),
            (BenchmarkId::ErrorVsTime, PaneId::ErrorVsTime),
        ] {
            let mut harness = spoken(harness(), language);
            let report = report(subject);
            explorer(&mut harness).benchmarks.take(*report.result, report.is_part);
            alone(&mut harness, pane);
            at_all_sizes(&mut harness, &format!("{pane:?} {language:?}"), found);
        }
    });
}

#[test]
fn dialogs() {
    in_each_language(|language, found| {
        for step in 0..4 {
            let mut harness = spoken(harness(), language);
            act(&mut harness, Action::Window(WindowAction::ShowTour(step)));
            at_all_sizes(&mut harness, &format!("tour {step} {language:?}"), found);
        }
        for page in [Help::FirstSteps, Help::Words, Help::About] {
            let mut harness = spoken(harness(), language);
            act(&mut harness, Action::Window(WindowAction::ShowHelp(page)));
            at_all_sizes(&mut harness, &format!("{page:?} {language:?}"), found);
        }
        let mut harness = spoken(harness(), language);
        act(&mut harness, Action::Window(WindowAction::OpenPalette));
        at_all_sizes(&mut harness, &format!("palette {language:?}"), found);
        for (name, key) in
            [("file", Key::F), ("edit", Key::E), ("measurements", Key::M), ("fit", Key::I), ("view", Key::V), ("lessons", Key::L)]
        {
            let mut harness = spoken(crate::app::tests::harness(), language);
            harness.key_press_modifiers(Modifiers::ALT, key);
            wait(&mut harness);
            at_all_sizes(&mut harness, &format!("menu {name} {language:?}"), found);
        }
        let folder = tempfile::tempdir().expect("a folder");
        let lab =
            "Messung vom 3. Mai;;;\nEinfallswinkel (°);Ausfallswinkel (°);DoLP (%);Kommentar\n30;20;8,1;a\n30;30;10,3;b\n50;40;21,9;c\n";
        let paths = files(&folder, [("lab.csv", lab)]);
        let mut harness = spoken(crate::app::tests::harness(), language);
        act(&mut harness, Action::OpenMeasurements(paths));
        assert!(explorer(&mut harness).dialogs.import.is_some());
        at_all_sizes(&mut harness, &format!("import {language:?}"), found);
    });
}
