//! The window, driven headlessly by the names of its controls.

mod audit;
mod beside;
mod broken;
mod bundled_lessons;
mod commands;
mod companions;
mod cut_text;
mod dialogs;
mod files;
mod first_look;
mod fitting;
mod fixtures;
mod fuzz;
mod help;
mod hemisphere;
mod import_choices;
mod imports;
mod kept_texts;
mod kept_work;
mod landscape;
mod languages;
mod leaving;
mod lessons;
mod links;
mod masks;
mod measurements;
mod menus;
mod messages;
mod metals;
mod mueller;
mod notices;
mod options;
mod panes;
mod picture;
mod places;
mod planning;
mod posterior;
mod presenting;
mod reading;
mod reports;
mod results;
mod room;
mod scans;
mod sessions;
mod sharing;
mod sliders;
mod snapshots;
pub mod sources;
mod ties;
mod title;
mod typed;

use crate::app::shell::app::App;
use crate::app::shell::app::logic::logic;
use crate::app::shell::app::open::{begin, open};
use crate::app::shell::app::ui::ui;
use crate::app::storage::settings_file::SettingsFile;
use crate::app::views::spec;
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::pane_id::PaneId;
use egui_kittest::Harness;
use std::time::{Duration, Instant};

/// The window with the first example open, as it starts.
fn harness() -> Harness<'static, Option<App>> {
    harness_of(SettingsFile::default())
}

/// Frames in which a window comes to rest: an autosave or a job that ends asks for some more.
const STEPS: u64 = 16;

fn harness_of(stored: SettingsFile) -> Harness<'static, Option<App>> {
    let frame = move |screen: &mut egui::Ui, state: &mut Option<App>| {
        let explorer = state.get_or_insert_with(|| {
            let mut explorer = App::new(screen.ctx(), stored.clone());
            begin(&mut explorer);
            explorer
        });
        logic(explorer, &screen.ctx().clone());
        ui(explorer, screen);
    };
    let mut harness = Harness::builder().with_max_steps(STEPS).with_size(egui::vec2(1280.0, 800.0)).build_ui_state(frame, None);
    harness.run();
    harness
}

/// The panes with a plot; that of the posterior is drawn first, which has tests of its own.
fn plots() -> impl Iterator<Item = PaneId> {
    PaneId::ALL.iter().copied().filter(|pane| spec(*pane).has_figure && *pane != PaneId::Posterior)
}

fn explorer<'a>(harness: &'a mut Harness<'static, Option<App>>) -> &'a mut App {
    harness.state_mut().as_mut().expect("the first frame makes the explorer")
}

/// Puts a measurement in the place of the open one.
fn take(explorer: &mut App, name: String, measurement: pbrdf::measurement::Measurement) {
    open(explorer, OpenMeasurement::new(name, measurement));
}

/// Makes a change, as a pane does.
fn edit(harness: &mut Harness<'static, Option<App>>, edit: Edit) {
    explorer(harness).work.apply(edit);
    wait(harness);
}

/// Longer than any job of these tests takes on any machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Whether no job is on its way.
fn is_at_rest(explorer: &mut App) -> bool {
    !explorer.jobs.is_busy() && explorer.actions.is_empty()
}

/// Draws frames until no job is on its way and nothing moves: a frame of those may begin a job.
fn wait(harness: &mut Harness<'static, Option<App>>) {
    let begun = Instant::now();
    loop {
        harness.step();
        if is_at_rest(explorer(harness)) && harness.try_run().is_ok() && is_at_rest(explorer(harness)) {
            return;
        }
        assert!(begun.elapsed() < PATIENCE, "the job does not end");
        std::thread::sleep(Duration::from_millis(5));
    }
}
