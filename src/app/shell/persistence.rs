//! Which files keep settings and work without being asked, and what of both they hold.

use crate::app::platform::Instant;
use crate::app::storage::kept_work::{KeptWork, WorkFile, WorkFolder};
use crate::app::work::settings::WindowSettings;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long work rests before it is written.
pub const SAVE_AFTER: Duration = Duration::from_millis(1500);

/// The files of the program itself, with the revisions that they hold.
#[derive(Default)]
pub struct Persistence {
    /// Where the settings go; nowhere in tests.
    pub settings_path: Option<PathBuf>,
    /// The revision of the user's own work, and the window, as the settings file holds them.
    pub saved_settings: Option<(u64, WindowSettings)>,
    pub settings_dirty_since: Option<Instant>,
    /// Where the working state goes; nowhere in tests.
    pub autosave_path: Option<PathBuf>,
    pub autosaved_revision: Option<AutosaveRevision>,
    pub autosave_dirty_since: Option<Instant>,
    /// The work of earlier runs; nowhere in tests.
    pub work_folder: Option<WorkFolder>,
    /// The file of this run, and before the first change that which it goes on with.
    pub work_files: Vec<WorkFile>,
    /// The work that is being read because it was open last.
    pub resuming: Option<PathBuf>,
    /// What can be opened of earlier runs, the newest first.
    pub kept: Vec<KeptWork>,
    /// The revision of the user's own work that the file of the session holds.
    pub saved_session: Option<u64>,
    /// The title of the window.
    pub title: String,
}

/// Revisions of the user's own work, and of that of the lesson over it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AutosaveRevision {
    pub own: u64,
    pub lesson: Option<u64>,
}

impl Persistence {
    /// Whether a path is that of work that is kept without being asked.
    pub fn is_kept(&self, path: &Path) -> bool {
        self.resuming.as_deref() == Some(path) || self.kept.iter().any(|work| work.path == path)
    }
}
