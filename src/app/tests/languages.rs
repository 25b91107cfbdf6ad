//! Both languages: no text of the window is left in English, and every control has a name.

use crate::app::shell::app::App;
use crate::app::shell::commands::items;
use crate::app::shell::theme::install_page_fonts;
use crate::app::tests::imports::tensor;
use crate::app::tests::{explorer, harness, wait};
use crate::app::text::help::{DOI, Help, PAPER};
use crate::app::text::i18n::{Language, MISSED};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use egui::Key;
use egui::accesskit::{Action as NodeAction, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pbrdf::model::{PRESETS, Parameter, ParameterSet};
use std::collections::BTreeSet;

/// The window in Chinese after a fit and a comparison of models, so that every view has something
/// to show.
fn chinese() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    explorer(&mut harness).actions.push(Action::Window(WindowAction::SetLanguage(Language::Chinese)));
    wait(&mut harness);
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    harness
}

/// Puts that pane alone on screen.
fn alone(harness: &mut Harness<'static, Option<App>>, pane: PaneId) {
    for other in PaneId::ALL.iter().copied() {
        explorer(harness).actions.push(Action::Window(WindowAction::ClosePane(other)));
    }
    explorer(harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
    if pane == PaneId::Landscape {
        // In an unoptimised build its maps take half a minute: nobody waits for them.
        harness.run_steps(4);
    } else {
        wait(harness);
    }
}

/// What is written on the screen, and what a screen reader says besides.
pub(crate) fn written(harness: &Harness<'static, Option<App>>) -> BTreeSet<String> {
    let mut texts = BTreeSet::new();
    let mut nodes = vec![harness.root()];
    while let Some(node) = nodes.pop() {
        texts.extend(node.accesskit_node().label());
        texts.extend(node.accesskit_node().value());
        nodes.extend(node.children());
    }
    texts
}

/// Words that are the same in both languages: names of quantities, people and units, keys of
/// parameters, columns and models, of licences and this program, and two texts of the toolkit that
/// only a screen reader sees.
const SAME: &[&str] = &[
    "AVX2",
    "arctan",
    "AICc",
    "Alt",
    "PageDown",
    "PageUp",
    "Plus",
    "Minus",
    "bootstrap",
    "Down",
    "Up",
    "Apache",
    "BRDF",
    "Beckmann",
    "CSV",
    "EXR",
    "Close",
    "Ctrl",
    "Escape",
    "DoLP",
    "English",
    "GGX",
    "Germer",
    "Hagemann",
    "Hyde",
    "Lambert",
    "MIT",
    "Minnaert",
    "Priest",
    "Resize panel",
    "Scroll tabs left",
    "Scroll tabs right",
    "Thilak",
    "brdf",
    "cos",
    "dolp",
    "dpolE",
    "explorer",
    "rad",
    "sigma_v",
    "sigma",
    "theta",
    "arcsin",
    "tan",
    "sin",
    "exp",
    "Trowbridge",
    "Reitz",
    "SVG",
    "PNG",
    "tensor_file",
    "metadata",
    "txt",
    "pbsdf",
    "exr",
    "png",
    "json",
    "dat",
    "csv",
    "Woollam",
    "Torrance",
    "Sparrow",
    "Shift",
    "Mueller",
    "Marquardt",
    "Markdown",
    "LaTeX",
    "booktabs",
    "Levenberg",
    "HTML",
    "Cauchy",
];

/// Whether something in it is English: an entry of the literature, which has its year, is not
/// translated.
pub(crate) fn is_english(text: &str) -> bool {
    let has_year = text.as_bytes().windows(4).any(|digits| digits.iter().all(u8::is_ascii_digit));
    // One that is cut before its year begins with initials or its number, or stands in a bracket that does not
    // close.
    let is_cut = text.ends_with('…') && (matches!(text.as_bytes().get(1), Some(b'.' | b')')) || text.contains('（'));
    // Models go by their keys beside the name of a measurement.
    let is_key = |text: &str| PRESETS.iter().any(|preset| preset.key == text);
    let text = match text.rsplit_once(" · ").or_else(|| text.rsplit_once(", ")) {
        Some((name, key)) if is_key(key) => name,
        _ => text,
    };
    if is_key(text) {
        return false;
    }
    let rest = SAME.iter().fold(text.to_owned(), |rest, same| rest.replace(same, ""));
    let mut words = rest.split(|letter: char| !letter.is_ascii_alphabetic());
    !has_year && !is_cut && words.any(|word| word.len() > 2)
}

#[test]
fn nothing_is_left_in_english_and_no_text_is_looked_up_in_vain() {
    let mut harness = chinese();
    let mut english = BTreeSet::new();
    for pane in PaneId::ALL.iter().copied() {
        alone(&mut harness, pane);
        english.extend(written(&harness).into_iter().filter(|text| is_english(text)));
    }
    for page in [Help::FirstSteps, Help::Words, Help::About] {
        explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowHelp(page)));
        harness.run();
        // The paper, which breaks over several lines, is called as it is called.
        english
            .extend(written(&harness).into_iter().filter(|text| is_english(text) && !text.contains(DOI) && !PAPER.contains(text.trim())));
        explorer(&mut harness).actions.push(Action::Window(WindowAction::CloseHelp));
        harness.run();
    }
    let all = items(explorer(&mut harness));
    let said = all.iter().flat_map(|item| [&item.text, &item.tooltip]);
    english.extend(said.map(ToString::to_string).filter(|text| is_english(text)));
    assert!(english.is_empty(), "in English: {english:#?}");
    let missed = MISSED.with_borrow(Clone::clone);
    assert!(missed.is_empty(), "not in assets/locales/zh_CN.po: {missed:#?}");
}

/// What is in English on the screen, with the place.
fn left(harness: &Harness<'static, Option<App>>, place: &str) -> Vec<String> {
    written(harness).into_iter().filter(|text| is_english(text)).map(|text| format!("{place}: {text}")).collect()
}

fn assert_chinese(english: &[String]) {
    assert!(english.is_empty(), "{english:#?}");
    let missed = MISSED.with_borrow(Clone::clone);
    assert!(missed.is_empty(), "not in assets/locales/zh_CN.po: {missed:#?}");
}

fn click(harness: &mut Harness<'static, Option<App>>, label: &str) {
    harness.query_all_by_label(label).last().unwrap_or_else(|| panic!("there is no {label}")).click();
    harness.run();
}

fn order(harness: &mut Harness<'static, Option<App>>, command: Action) {
    explorer(harness).actions.push(command);
    wait(harness);
}

#[test]
fn menus_palette_and_lessons_are_in_chinese() {
    let mut harness = chinese();
    let mut english = Vec::new();
    for menu in ["文件", "编辑", "拟合", "视图", "课程", "帮助"] {
        // The first of that name is the title in the bar.
        harness.query_all_by_label(menu).next().expect("a menu").click();
        harness.run();
        english.extend(left(&harness, menu));
        harness.key_press(Key::Escape);
        harness.run();
    }
    order(&mut harness, Action::Window(WindowAction::OpenPalette));
    english.extend(left(&harness, "palette"));
    harness.key_press(Key::Escape);
    harness.run();
    for lesson in 0..explorer(&mut harness).lessons.all.len() {
        for step in 0..explorer(&mut harness).lessons.all[lesson].steps.len() {
            order(&mut harness, Action::ShowStep(lesson, step));
            english.extend(left(&harness, "lesson"));
        }
    }
    assert_chinese(&english);
}

#[test]
fn what_unfolds_is_in_chinese() {
    let mut harness = chinese();
    let mut english = Vec::new();
    order(&mut harness, Action::CompareModels);
    for folded in ["选项", "这些数据能确定什么", "相关系数", "剖面与自助法", "拟合历史（11）"] {
        click(&mut harness, folded);
        wait(&mut harness);
        english.extend(left(&harness, folded));
    }
    alone(&mut harness, PaneId::Models);
    click(&mut harness, "各起点及其终点");
    english.extend(left(&harness, "models"));
    alone(&mut harness, PaneId::Data);
    let series: Vec<String> = written(&harness).into_iter().filter(|text| text.starts_with("系列")).collect();
    for folded in &series {
        click(&mut harness, folded);
        english.extend(left(&harness, folded));
    }
    assert_chinese(&english);
}

/// Files that ask for a choice, or are refused.
fn foreign() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("1.dat", b"nm\n600\t55\t43\t150\n650\t55\t43.5\t151\n".to_vec()),
        ("2.pbsdf", tensor()),
        ("3.csv", b"1;2 [d];3 (rad);4 %;5\n6;30;0,5;12,5;7\n".to_vec()),
        ("4.csv", b"1,2,3\n30,20,12\n".map(|byte| if byte == b'1' { b'a' } else { byte }).to_vec()),
        ("5.csv", b"theta_i,theta_r,dolp\n95,0,0.5\n".to_vec()),
        ("6.csv", Vec::new()),
        ("7.pbsdf", b"tensor_file\0\x01\0\xff\0\0\0".to_vec()),
        ("8.txt", b"nm\n?\n".to_vec()),
    ]
}

#[test]
fn questions_and_refusals_are_in_chinese() {
    let mut harness = harness();
    order(&mut harness, Action::Window(WindowAction::SetLanguage(Language::Chinese)));
    let folder = tempfile::tempdir().expect("a folder");
    let mut english = Vec::new();
    for (name, contents) in foreign() {
        let path = folder.path().join(name);
        std::fs::write(&path, contents).expect("a file");
        order(&mut harness, Action::OpenMeasurements(vec![path]));
        // The name of the file stands in the texts.
        let all = written(&harness).into_iter().map(|text| text.replace(&folder.path().display().to_string(), ""));
        english.extend(all.filter(|text| is_english(text)).map(|text| format!("{name}: {text}")));
        harness.key_press(Key::Escape);
        harness.run();
    }
    assert_chinese(&english);
}

#[test]
fn what_stays_open_is_said_in_the_language_of_the_window() {
    let mut harness = chinese();
    let free = [Parameter::Ks, Parameter::Kd, Parameter::Kv];
    explorer(&mut harness).work.surface_mut().locked = free.into_iter().fold(ParameterSet::ALL, ParameterSet::without);
    alone(&mut harness, PaneId::Planner);
    assert!(written(&harness).contains("• k_s, k_d, k_v 一起：只有它们的比值进入 DoLP"));
}

/// Also those of a page, which are subsets.
#[test]
fn the_fonts_have_every_letter() {
    let mut harness = chinese();
    assert_every_letter(&harness);
    install_page_fonts(&harness.ctx);
    harness.step();
    assert_every_letter(&harness);
}

fn assert_every_letter(harness: &Harness<'static, Option<App>>) {
    let texts =
        [include_str!("../../../assets/locales/zh_CN.po"), include_str!("../shell/commands.rs"), include_str!("../shell/docking.rs")];
    let font = egui::FontId::proportional(14.0);
    let lacking: BTreeSet<char> = harness.ctx.fonts_mut(|fonts| {
        texts.iter().flat_map(|text| text.chars()).filter(|letter| !letter.is_ascii_control() && !fonts.has_glyph(&font, *letter)).collect()
    });
    assert!(lacking.is_empty(), "run assets/fonts/make_subset.py: {lacking:?}");
}

/// Nodes that somebody can act on and that have no name.
fn nameless(harness: &Harness<'static, Option<App>>) -> Vec<String> {
    let mut nameless = Vec::new();
    let mut nodes = vec![harness.root()];
    while let Some(node) = nodes.pop() {
        let accessible = node.accesskit_node();
        let acts = [NodeAction::Click, NodeAction::Focus].into_iter().any(|action| accessible.data().supports_action(action));
        let is_text = accessible.role() == Role::Label && accessible.value().is_some();
        let is_named = is_text || accessible.role() == Role::ScrollBar;
        if acts && !is_named && accessible.label().is_none_or(|label| label.trim().is_empty()) {
            nameless.push(format!("{:?} {:?} {:?}", accessible.role(), accessible.value(), accessible.bounding_box()));
        }
        nodes.extend(node.children());
    }
    nameless
}

#[test]
fn every_control_has_a_name() {
    let mut all = Vec::new();
    for language in Language::ALL {
        let mut harness = chinese();
        explorer(&mut harness).actions.push(Action::Window(WindowAction::SetLanguage(language)));
        wait(&mut harness);
        for pane in PaneId::ALL.iter().copied() {
            alone(&mut harness, pane);
            all.extend(nameless(&harness).into_iter().map(|node| format!("{}: {node}", pane.key())));
        }
    }
    assert!(all.is_empty(), "{all:#?}");
}
