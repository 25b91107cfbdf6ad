//! The desktop: threads, the clock of the system, folders by the desktop's conventions, dialogs of
//! the desktop.

use crate::app::platform::file_dialog::{Arrival, DialogUnavailable, FileDialog, FileFilter, PathPurpose};
use std::cell::Cell;
use std::io;
use std::path::PathBuf;
use std::time::SystemTime;

/// The clock of the window and of its jobs.
pub use std::time::Instant;

/// Whether the window is in a page: there files are gone at the next start, and nothing is measured.
pub const IS_PAGE: bool = false;

/// Whether what points at the window is a finger: on a desktop a pointer does.
pub fn has_fingers() -> bool {
    false
}

/// What the user's environment says about the language, such as `zh_CN.UTF-8`.
pub fn language() -> Option<String> {
    let said = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    ["LC_ALL", "LC_MESSAGES", "LANG"].into_iter().find_map(said)
}

/// Where a dropped file is.
pub fn receive(file: &std::sync::Arc<dyn egui::DroppedFile + Send + Sync>) -> Option<PathBuf> {
    Some(file.path().to_owned())
}

/// What came apart from the window's own events: nothing on a desktop.
pub fn arrivals() -> Vec<Arrival> {
    Vec::new()
}

/// The address of the page that shows the window: none on a desktop.
pub fn page() -> Option<String> {
    None
}

/// Runs work on a thread of its own.
///
/// # Errors
/// The system refuses a thread.
pub fn spawn(name: &str, body: impl FnOnce() + Send + 'static) -> io::Result<()> {
    std::thread::Builder::new().name(name.to_owned()).spawn(body).map(drop)
}

fn folders(app: &str) -> Option<directories::ProjectDirs> {
    directories::ProjectDirs::from("", "", app)
}

/// The user's folder for settings of a program; `None` where the user has no home.
pub fn config_folder(app: &str) -> Option<PathBuf> {
    folders(app).map(|folders| folders.config_dir().to_owned())
}

/// The user's folder for data of a program that may be shared between machines.
pub fn data_folder(app: &str) -> Option<PathBuf> {
    folders(app).map(|folders| folders.data_dir().to_owned())
}

/// The user's folder for data of a program that stay on this machine.
pub fn local_data_folder(app: &str) -> Option<PathBuf> {
    folders(app).map(|folders| folders.data_local_dir().to_owned())
}

/// Date and time to the minute in the time zone of the machine; empty outside the years that clocks
/// can show.
pub fn local_time(at: SystemTime) -> String {
    let zoned = jiff::Timestamp::try_from(at).map(|at| at.to_zoned_datetime(jiff::tz::TimeZone::system()));
    zoned.map_or_else(|_| String::new(), |at| at.strftime("%Y-%m-%d %H:%M").to_string())
}

/// Shows a dialog and waits for the answer; empty where the user cancels.
///
/// # Errors
/// No dialog can open.
pub fn show_file_dialog(dialog: FileDialog) -> Result<Vec<PathBuf>, DialogUnavailable> {
    // A program has one logger. Where another one is installed, a dialog that cannot open counts as
    // cancelled.
    let _ = log::set_logger(&RFD_LOG).map(|()| log::set_max_level(log::LevelFilter::Error));
    DIALOG_FAILED.set(false);
    let FileDialog { title, purpose, filters } = dialog;
    let dialog = filters
        .iter()
        .fold(rfd::FileDialog::new().set_title(title), |dialog, FileFilter { name, extensions }| dialog.add_filter(name, extensions));
    let paths: Vec<PathBuf> = match purpose {
        PathPurpose::Open => dialog.pick_file().into_iter().collect(),
        PathPurpose::OpenSeveral => dialog.pick_files().unwrap_or_default(),
        PathPurpose::OpenFolder => dialog.pick_folder().into_iter().collect(),
        PathPurpose::Save { suggested_name } => dialog.set_file_name(suggested_name).save_file().into_iter().collect(),
    };
    if paths.is_empty() && DIALOG_FAILED.get() { Err(DialogUnavailable) } else { Ok(paths) }
}

thread_local! {
    /// Whether rfd's last way to a dialog failed on this thread.
    static DIALOG_FAILED: Cell<bool> = const { Cell::new(false) };
}

/// rfd returns `None` both where the user cancels and where no dialog opens; only its log tells
/// which.
struct RfdLog;

static RFD_LOG: RfdLog = RfdLog;

/// The module of rfd that tries zenity after the portal has failed. An error from this module means
/// that no way is left; the test
/// `a_dialog_that_cannot_open_is_told_from_one_that_is_cancelled` fails where a new version of rfd logs otherwise.
const RFD_LOG_TARGET: &str = "rfd::backend::xdg_desktop_portal";

impl log::Log for RfdLog {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() == log::Level::Error && metadata.target() == RFD_LOG_TARGET
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            DIALOG_FAILED.set(true);
        }
    }

    fn flush(&self) {}
}
