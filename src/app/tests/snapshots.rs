//! Exported figures as pictures, against those that somebody looked at and committed.
//!
//! Fonts are outlines of our own and the renderer runs on the processor, so that pictures hardly
//! differ from machine to machine.
//! `UPDATE_SNAPSHOTS=1 cargo test snapshots` writes them anew: look at each before you commit it.

use crate::app::shell::app::App;
use crate::app::tasks::benchmarks::{BenchmarkId, FinishedBenchmark};
use crate::app::tests::languages::is_english;
use crate::app::tests::{explorer, harness, plots, wait};
use crate::app::text::i18n::Language;
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use crate::figure::{Figure, Image};
use egui_kittest::Harness;
use pbrdf::model::{Parameter, ParameterSet};
use pbrdf::optics::metals;
use pbrdf::selftest::Host;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Resolution of the pictures: words can be read, and a file has some kilobytes.
const DPI: f64 = 60.0;
/// Between neighbouring shades.
const SHADE: u8 = 17;
/// What a colour may differ by, of 255: less than two shades, so that none counts that was just
/// rounded the other way.
const LITTLE: u8 = 32;
/// Share of pixels that may differ by more: the last places of sums are not the same on every
/// processor. A word of a legend is more.
const SHARE: f64 = 5e-4;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src/app/tests/snapshots")
}

/// A figure at that resolution, in few colours so that its file is small.
#[derive(Debug, PartialEq)]
struct Picture {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl Picture {
    fn new(figure: &Figure) -> Self {
        let Image { width, height, rgba } = figure.image(DPI).expect("a picture");
        let rgb = rgba
            .chunks_exact(4)
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .map(|byte| byte.saturating_add(SHADE / 2) / SHADE * SHADE);
        Self { width, height, rgb: rgb.collect() }
    }

    fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::High);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&self.rgb).expect("all pixels");
        writer.finish().expect("an end");
        bytes
    }

    fn read(bytes: &[u8]) -> Option<Self> {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().ok()?;
        let mut rgb = vec![0; reader.output_buffer_size()?];
        let info = reader.next_frame(&mut rgb).ok()?;
        Some(Self { width: info.width, height: info.height, rgb })
    }

    /// Share of pixels that differ by more than a little; all of them where the sizes do.
    fn differing(&self, other: &Self) -> f64 {
        if (self.width, self.height) != (other.width, other.height) {
            return 1.0;
        }
        let pixels = || self.rgb.chunks_exact(3).zip(other.rgb.chunks_exact(3));
        let differ = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > LITTLE);
        #[expect(clippy::cast_precision_loss, reason = "numbers of pixels")]
        let share = pixels().filter(differ).count() as f64 / pixels().count() as f64;
        share
    }
}

/// What is wrong with a figure's picture, in a sentence; where it is asked for, the picture is
/// replaced instead.
fn compare(folder: &Path, name: &str, figure: &Figure, update: bool) -> Option<String> {
    let path = folder.join(format!("{name}.png"));
    let new = Picture::new(figure);
    let old = std::fs::read(&path).ok().and_then(|bytes| Picture::read(&bytes));
    let share = old.as_ref().map_or(1.0, |old| old.differing(&new));
    if share <= SHARE {
        return None;
    }
    let path = if update { path } else { folder.join(format!("{name}.new.png")) };
    std::fs::write(&path, new.png()).expect("a writable folder");
    let was = if old.is_some() { format!("{:.2} % of the pixels differ", 100.0 * share) } else { "there is no picture of it".to_owned() };
    (!update).then(|| format!("{name}: {was}; the new one is {}, UPDATE_SNAPSHOTS=1 puts it in the place of the old", path.display()))
}

fn order(harness: &mut Harness<'static, Option<App>>, command: Action) {
    explorer(harness).actions.push(command);
    wait(harness);
}

/// The example with noise after a fit that its points determine.
fn fitted() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    order(&mut harness, Action::OpenExample(1));
    let free = [Parameter::N, Parameter::K, Parameter::Kd];
    explorer(&mut harness).work.surface_mut().locked = free.into_iter().fold(ParameterSet::ALL, ParameterSet::without);
    order(&mut harness, Action::StartFit);
    harness
}

/// The reports by a clock that goes on by a long repetition whenever it is looked at; of the first
/// the evaluations alone, since the others take long.
pub(super) fn report(subject: BenchmarkId) -> FinishedBenchmark {
    let (looks, asked) = (AtomicU32::new(0), AtomicU32::new(0));
    let clock = || 10.0 * f64::from(looks.fetch_add(1, Ordering::Relaxed));
    let methods = 5;
    let cancelled = || subject == BenchmarkId::ErrorVsTime && asked.fetch_add(1, Ordering::Relaxed) >= methods;
    let result = Box::new(subject.run(Host { clock: &clock, cancelled: &cancelled, progress: &|_| {} }));
    FinishedBenchmark { result, is_part: false }
}

/// The figures of all plots.
fn figures(harness: &mut Harness<'static, Option<App>>) -> Vec<(PaneId, Figure)> {
    for subject in BenchmarkId::ALL {
        let report = report(subject);
        explorer(harness).benchmarks.take(*report.result, report.is_part);
    }
    let mut shown = |pane: PaneId| {
        if !explorer(harness).dock.is_on_screen(pane) {
            order(harness, Action::Window(WindowAction::ShowPane(pane)));
        }
        wait(harness);
        (pane, explorer(harness).figure(pane).expect("a plot"))
    };
    plots().map(&mut shown).collect()
}

#[test]
fn every_exported_plot_looks_as_it_did() {
    let update = std::env::var_os("UPDATE_SNAPSHOTS").is_some();
    let figures = figures(&mut fitted());
    let wrong: Vec<String> = figures.iter().filter_map(|(pane, figure)| compare(&folder(), pane.key(), figure, update)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_exported_plot_is_in_chinese_where_the_window_is() {
    let mut harness = fitted();
    order(&mut harness, Action::Window(WindowAction::SetLanguage(Language::Chinese)));
    let mut left = Vec::new();
    for (pane, figure) in figures(&mut harness) {
        let svg = figure.svg();
        assert!(!svg.contains("<text"), "{pane:?}: a letter that the fonts lack");
        let svg = roxmltree::Document::parse(&svg).expect("XML");
        let words = svg.descendants().filter_map(|node| node.attribute("aria-label"));
        // Who measured a metal stays.
        let sources = || metals().expect("the bundled table").iter().flat_map(|metal| &metal.sources);
        let words = words.map(|word| sources().fold(word.to_owned(), |word, source| word.replace(&source.name, "")));
        left.extend(words.filter(|word| is_english(word)).map(|word| format!("{pane:?}: {word}")));
    }
    assert!(left.is_empty(), "{}", left.join("\n"));
}

#[test]
fn another_picture_is_noticed_and_laid_beside_the_old_one() {
    let harness = &mut harness();
    let there = tempfile::tempdir().expect("a folder");
    let mut plot = explorer(harness).figure(PaneId::Dolp).expect("a plot");
    assert!(compare(there.path(), "dolp", &plot, false).expect("a sentence").contains("no picture"));
    assert_eq!(compare(there.path(), "dolp", &plot, true), None);
    assert_eq!(compare(there.path(), "dolp", &plot, false), None, "the picture that was just written");
    // One word less, of all that is drawn.
    plot.panels[0].y.label.clear();
    let sentence = compare(there.path(), "dolp", &plot, false).expect("a sentence");
    assert!(sentence.contains("% of the pixels differ") && sentence.contains("dolp.new.png"), "{sentence}");
    assert!(there.path().join("dolp.new.png").exists());
}
