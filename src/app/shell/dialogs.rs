//! What lies over the window: command palette, help, questions about files; and the paths typed by
//! hand.

use crate::app::panels::{MeasurementPanel, PinnedPanel};
use crate::app::shell::import_dialog::ImportDialog;
use crate::app::shell::path_entry::PathEntry;
use crate::app::shell::room::Room;
use crate::app::text::help::Help;
use crate::app::views::action::Action;
use std::collections::VecDeque;
use std::path::PathBuf;

/// The dialogs that are open.
#[derive(Default)]
pub struct Dialogs {
    pub palette: Palette,
    /// The page of help.
    pub help: Option<Help>,
    /// A foreign file that waits for answers.
    pub import: Option<ImportDialog>,
    /// Those that ask after it.
    pub imports_waiting: VecDeque<ImportDialog>,
    /// A file that is asked about before it is replaced.
    pub overwrite: Option<OverwritePrompt>,
    pub path_entry: PathEntry,
    pub lists: Lists,
    /// The step of the tour that is shown.
    pub tour: Option<usize>,
    pub room: Room,
    /// What a key asks for while a value is being typed: the field gives its value first.
    pub after_typing: Option<Action>,
}

/// The lists above the sliders, with the names that are being typed.
#[derive(Default)]
pub struct Lists {
    pub measurements: MeasurementPanel,
    pub pinned: PinnedPanel,
}

/// What the command palette keeps while it is open.
#[derive(Debug, Default)]
pub struct Palette {
    pub is_open: bool,
    pub filter: String,
    pub chosen: usize,
}

/// A file that is there, and what would be written in its place.
#[derive(Debug)]
pub struct OverwritePrompt {
    pub path: PathBuf,
    pub command: Action,
}

impl Dialogs {
    /// Whether one of them covers the window and has the keys.
    pub fn is_asking(&self) -> bool {
        self.palette.is_open || self.help.is_some() || self.import.is_some() || self.overwrite.is_some()
    }
}

impl Palette {
    /// Opens it empty.
    pub fn open(&mut self) {
        *self = Self { is_open: true, ..Self::default() };
    }
}
