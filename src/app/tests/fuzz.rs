//! The window's own readers against damaged files: no input panics, what is accepted keeps its
//! promises, and every view can show it.
//!
//! A second per reader in a normal run, beside showing the samples. Ten minutes each:
//!
//! ```sh
//! PBRDF_FUZZ_SECONDS=600 cargo test --release --bin pbrdf-explorer fuzz -- --nocapture
//! ```
//!
//! A job that panics ends no test; its message is in the output.

#[path = "../../../core/tests/common/damage.rs"]
mod damage;

use crate::app::shell::app::App;
use crate::app::shell::app::link::link_read;
use crate::app::shell::app::session::session_read;
use crate::app::shell::docking::Dock;
use crate::app::shell::lessons::Lessons;
use crate::app::storage::import;
use crate::app::storage::import::Loaded;
use crate::app::storage::saved_fit::SavedMeasurement;
use crate::app::storage::session::Session;
use crate::app::storage::session_file::OpenedSession;
use crate::app::storage::settings_file;
use crate::app::storage::settings_file::{SavedSettings, SettingsFile};
use crate::app::storage::share_link::{OpenedLink, SharedWork};
use crate::app::tests::{explorer, take, wait};
use crate::app::text::i18n::Language;
use crate::app::views::action::Action;
use crate::app::work::layout::Layout;
use crate::app::work::lesson::Lesson;
use crate::app::work::pane_id::PaneId;
use crate::app::work::parameter_text;
use crate::app::work::settings::{Settings, Theme, WindowSettings};
use crate::app::work::surface::{Surface, can_be_set};
use crate::files::packed::{pack, unpack};
use damage::{fuzz, texts};
use egui_kittest::Harness;
use pbrdf::measurement::Measurement;
use pbrdf::measurement::formats::{ImportError, ImportOptions, Imported};
use pbrdf::model::{Parameter, ParameterSet, Parameters};
use std::ops::ControlFlow;
use std::path::Path;

const TABLE: &str = "# material: steel\n# wavelength_nm: 650\ntheta_i,theta_r,dolp,dolp_sigma,brdf,masked\n30,20,0.1,0.01,2,0\n30,25,0.2,,1e-3,1\n30,-20,0,0.02,0.5,0\n40,20,0.3,0.01,,0\n40,30,0.4,0.01,1,0\n40,50,0.5,0.01,3,0\n";

fn read_table(bytes: &[u8]) -> Option<Measurement> {
    Measurement::read(bytes).ok()
}

/// A window that draws a box for what its fonts lack, as the program does; other tests fail there.
fn harness() -> Harness<'static, Option<App>> {
    let harness = crate::app::tests::harness();
    harness.ctx.set_missing_glyph_policy(egui::MissingGlyphPolicy::Tofu);
    harness
}

/// A window with that small table open, and a fit of it.
fn small() -> Harness<'static, Option<App>> {
    let mut harness = harness();
    let table = read_table(TABLE.as_bytes()).expect("a table");
    take(explorer(&mut harness), "small.csv".to_owned(), table);
    explorer(&mut harness).actions.push(Action::StartFit);
    wait(&mut harness);
    assert!(explorer(&mut harness).work.shown_fit().is_some());
    harness
}

fn text(session: &Session) -> Vec<u8> {
    let mut bytes = Vec::new();
    session.write(&mut bytes).expect("memory takes everything");
    bytes
}

/// The session of [`small`], with bounds of its own.
fn session() -> Session {
    let mut harness = small();
    let explorer = explorer(&mut harness);
    explorer.work.surface_mut().set_bounds(Parameter::N, 0.5, 8.0).expect("sound bounds");
    Session::of(&explorer.work)
}

fn opened(bytes: &[u8]) -> Option<OpenedSession> {
    Some(OpenedSession::new(Session::read(std::str::from_utf8(bytes).ok()?).ok()?))
}

#[test]
fn sessions() {
    let whole = session();
    let bare = Session { measurements: Vec::new(), fits: Vec::new(), layout: Layout::Pane(PaneId::ALL[0]), ..whole.clone() };
    fuzz("session", &[text(&whole), text(&bare)], |bytes| {
        let Some(opened) = opened(bytes) else { return false };
        let Session { settings, layout, measurements, fits, .. } = &opened.session;
        let again = Session::read(&String::from_utf8(text(&opened.session)).expect("JSON")).expect("what was written");
        assert_eq!((&again.settings, &again.layout, &again.fits), (settings, layout, fits));
        // Numbers of lines and ignored columns are those of the new table.
        let data = |saved: &[SavedMeasurement]| -> Vec<_> {
            saved.iter().map(|saved| (saved.name.clone(), saved.is_open, saved.measurement.rows.clone())).collect()
        };
        assert_eq!(data(&again.measurements), data(measurements));
        true
    });
}

#[test]
fn sessions_in_every_view() {
    let whole = session();
    let samples: Vec<Vec<u8>> = PaneId::ALL.iter().map(|pane| text(&Session { layout: Layout::Pane(*pane), ..whole.clone() })).collect();
    let mut harness = harness();
    fuzz("session-in-views", &samples, |bytes| {
        let Some(opened) = opened(bytes) else { return false };
        session_read(explorer(&mut harness), Path::new("some.pbrdf.json"), Ok(Box::new(opened)));
        wait(&mut harness);
        true
    });
}

/// The letters of a link have a checksum: what they hold is damaged as well.
#[test]
fn links() {
    let shared = |lesson| SharedWork { language: Language::English, lesson, work: session() };
    let links = [None, Some(("Ratios only".to_owned(), 1))].map(|lesson| shared(lesson).fragment().expect("memory takes everything").text);
    let letters = |link: &str| link.split_once('.').map(|(_, letters)| letters.to_owned()).expect("a link");
    let held = links.iter().map(|link| unpack(&letters(link), 1 << 24).expect("a sound link"));
    let mut samples: Vec<Vec<u8>> = held.collect();
    samples.extend(links.iter().map(|link| link.clone().into_bytes()));
    let mut harness = harness();
    fuzz("link", &samples, |bytes| {
        let text = String::from_utf8_lossy(bytes);
        let text = if text.starts_with('#') { text.into_owned() } else { format!("https://a.test/b#pbrdf1.{}", pack(bytes)) };
        let Ok(opened) = OpenedLink::read(&text) else { return false };
        link_read(explorer(&mut harness), Ok(Box::new(opened)));
        wait(&mut harness);
        true
    });
}

#[test]
fn settings() {
    let other = SettingsFile {
        settings: SavedSettings {
            settings: Settings { log_brdf: true, show_bounds: true, ..Settings::default() },
            surface: Surface { bounds: vec![(Parameter::K, 0.0, 5.0)], ..Surface::default() },
        },
        layout: Layout::Pane(PaneId::ALL[1]),
        window: WindowSettings { theme: Theme::Dark, ..WindowSettings::default() },
    };
    let samples = [SettingsFile::default(), other].map(|stored| serde_json::to_vec_pretty(&stored).expect("JSON"));
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let [path, copy] = ["settings.json", "copy.json"].map(|name| folder.path().join(name));
    let mut harness = harness();
    fuzz("settings", &samples, |bytes| {
        std::fs::write(&path, bytes).expect("a writable folder for temporary files");
        let (stored, notice) = settings_file::load_from(&path);
        if notice.is_some() {
            assert_eq!(stored, SettingsFile::default());
            return false;
        }
        settings_file::save(&copy, &stored).expect("a writable folder for temporary files");
        assert_eq!(settings_file::load_from(&copy), (stored.clone(), None));
        let explorer = explorer(&mut harness);
        explorer.dock = Dock::new(&stored.layout);
        *explorer.work.settings_mut() = stored.settings.settings;
        *explorer.work.surface_mut() = stored.settings.surface;
        explorer.window = stored.window;
        wait(&mut harness);
        true
    });
}

#[test]
fn tables_in_the_window() {
    let mut harness = harness();
    let samples =
        [TABLE, "theta_i;theta_r;dphi;dolp_percent\n30,5;20;90;12,5\n40;20;90;0\n", "theta_i,theta_r,brdf\n30,20,1\n30,30,1e-9\n"];
    fuzz("table-in-the-window", &texts(&samples), |bytes| {
        let Some(measurement) = read_table(bytes) else { return false };
        take(explorer(&mut harness), "damaged.csv".to_owned(), measurement);
        wait(&mut harness);
        true
    });
}

#[test]
fn foreign_files() {
    let samples = [
        "AOI,View (rad),DoLP %,err\n30,0.3,12.5,0.1\n40,-0.2,1,1\n",
        "sample\nVASEmethod[x]\nnm\n600\t55\t43\t150\t0.01\t0.02\n600\t65\t42\t140\n650\t55\t43.5\t151\n650\t65\t42.5\t141\ndpolE\t650\t55\t1.5\n",
        "nm\taoi\tPsi\tDelta\n650\t65\t42\t140\n650\t70\t41\t130\n",
        TABLE,
    ];
    let samples: Vec<Vec<u8>> = texts(&samples).into_iter().chain([crate::app::tests::imports::tensor()]).collect();
    fuzz("foreign", &samples, |bytes| {
        let go_on = &mut |_| ControlFlow::Continue(());
        let Ok(arrived) = import::read(bytes.to_vec(), "fuzz", None, go_on) else { return false };
        if let Loaded::Foreign(file) = arrived {
            let options = ImportOptions {
                theta_i: ImportOptions::offered_theta_i(),
                theta_r: vec![-30.0, 0.0, 45.0],
                ..ImportOptions::offered(&file.questions())
            };
            let said = |result: Result<Imported, ImportError>| result.map_err(|error| error.to_string());
            let (preview, whole) = (said(file.preview(&options)), said(file.import(&options, go_on)));
            assert!(!file.preview_is_whole() || preview == whole);
        }
        true
    });
}

#[test]
fn pasted_parameters() {
    let samples =
        ["n=2.07, k=2.9, sigma=0.3, ks=1, kd=0.1, kv=0.2, q=2.5, c=-0.25, sigma_v=0.5", "n: 2,07; k: 2,9", "{\"σ\": 0.5 rad, σ_v = 1e-3}"];
    fuzz("pasted", &texts(&samples), |bytes| {
        let Ok(parameters) = parameter_text::read(&String::from_utf8_lossy(bytes), Parameters::default()) else { return false };
        assert_eq!(can_be_set(&parameters, ParameterSet::ALL), Ok(()));
        assert_eq!(parameter_text::read(&parameter_text::text(&parameters), Parameters::default()), Ok(parameters));
        true
    });
}

#[test]
fn lessons_in_the_window() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/lessons");
    let mut paths: Vec<_> = std::fs::read_dir(folder).expect("bundled lessons").map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let samples: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("a bundled lesson")).collect();
    let mut harness = harness();
    fuzz("lesson-in-the-window", &samples, |bytes| {
        let Ok(lesson) = Lesson::from_text(&String::from_utf8_lossy(bytes)) else { return false };
        let steps = lesson.steps.len();
        explorer(&mut harness).lessons = Lessons { all: vec![lesson], ..Default::default() };
        for step in 0..steps {
            explorer(&mut harness).actions.push(Action::ShowStep(0, step));
            wait(&mut harness);
        }
        true
    });
}

#[test]
fn bundled_lessons() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/lessons");
    let mut paths: Vec<_> = std::fs::read_dir(folder).expect("bundled lessons").map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let samples: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("a bundled lesson")).collect();
    fuzz("lessons", &samples, |bytes| Lesson::from_text(&String::from_utf8_lossy(bytes)).is_ok());
}
