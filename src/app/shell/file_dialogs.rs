//! Dialogs of the desktop: what they ask for, what follows from the answer, and what is said where none can open.

use crate::app::shell::app::App;
use crate::app::shell::commands::Command;
use crate::app::storage::export::ExportKind;
use pbrdf::measurement::formats::extensions;
use std::cell::Cell;
use std::path::PathBuf;
use tr::tr;

/// What a dialog asks for.
#[derive(Debug, Clone)]
pub enum FileRequest {
    /// The measurement to open.
    Open,
    /// Where to save the measurement, with a name to begin with.
    Save(String),
    /// The session to open.
    OpenSession,
    /// Where to write an export, with a name to begin with.
    Export(ExportKind, String),
}

/// The path that was chosen, or none where the user chose none; the error is that no dialog could open.
pub type FileReply = Result<Option<PathBuf>, DialogUnavailable>;

/// Neither the desktop's portal nor zenity opened a dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DialogUnavailable;

impl App {
    /// Asks the desktop what a command needs to know.
    pub(crate) fn choose(&mut self, command: &Command) -> Result<(), String> {
        let question = match command {
            Command::ChooseMeasurement => FileRequest::Open,
            Command::ChooseSession => FileRequest::OpenSession,
            Command::ChooseSave => FileRequest::Save(self.work.document.file_name()),
            Command::ChooseExport(what) => FileRequest::Export(*what, what.file_name(self)),
            // No other one asks.
            _ => return Ok(()),
        };
        self.worker.ask(question)
    }
}

impl FileRequest {
    /// What to do with the path that was chosen.
    pub fn command(self, path: PathBuf) -> Command {
        match self {
            Self::Open => Command::OpenMeasurement(path),
            Self::OpenSession => Command::OpenSession(path),
            Self::Save(_) => Command::SaveMeasurement(path),
            Self::Export(what, _) => {
                let whole = what.with_ending(path.clone());
                // The desktop asked about the name as it was before the ending.
                if whole == path { Command::Export(what, path) } else { Command::ExportNew(what, whole) }
            }
        }
    }

    /// What is missing where no dialog opens, and where a path can be typed instead.
    pub fn without_dialog(&self) -> String {
        let instead = match self {
            Self::Open | Self::OpenSession => tr!("Type the path in the menu File, under “Type a path to open”."),
            Self::Save(_) | Self::Export(ExportKind::Session, _) => tr!("Type the path in the menu File, under “Save to a path”."),
            Self::Export(..) => tr!("Type the path in File › Export, at the end of that menu, and choose the export there again."),
        };
        let missing = tr!("No file dialog can open: there is neither a desktop portal (xdg-desktop-portal) nor the program zenity.");
        format!("{missing} {instead}")
    }
}

/// Asks in a dialog of the desktop, and waits for the answer.
pub fn ask_desktop(question: FileRequest) -> FileReply {
    // There can be another one already: then a dialog that cannot open is taken for one that was cancelled.
    let _ = log::set_logger(&LISTENER).map(|()| log::set_max_level(log::LevelFilter::Error));
    FAILED.set(false);
    let path = ask(question);
    if path.is_none() && FAILED.get() { Err(DialogUnavailable) } else { Ok(path) }
}

fn ask(question: FileRequest) -> Option<PathBuf> {
    let dialog = rfd::FileDialog::new();
    match question {
        FileRequest::Open => {
            let dialog = dialog.set_title(tr!("Open measurement")).add_filter(tr!("Measurements"), &extensions());
            dialog.add_filter(tr!("All files"), &["*"]).pick_file()
        }
        FileRequest::OpenSession => dialog.set_title(tr!("Open session")).add_filter(tr!("Sessions"), &["json"]).pick_file(),
        FileRequest::Export(what, name) => what
            .extensions()
            .iter()
            .fold(dialog.set_title(tr!("Export")).set_file_name(name), |dialog, ending| dialog.add_filter(*ending, &[*ending]))
            .save_file(),
        FileRequest::Save(name) => dialog.set_title(tr!("Save measurement as")).add_filter("CSV", &["csv"]).set_file_name(name).save_file(),
    }
}

thread_local! {
    /// Whether the last way to a dialog failed on this thread.
    static FAILED: Cell<bool> = const { Cell::new(false) };
}

/// rfd tells by its log alone whether a dialog failed or was cancelled.
struct Listener;

static LISTENER: Listener = Listener;

/// Where rfd tries zenity after the portal has failed: an error from here means that nothing is left to try.
const RFD_LOG_TARGET: &str = "rfd::backend::xdg_desktop_portal";

impl log::Log for Listener {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() == log::Level::Error && metadata.target() == RFD_LOG_TARGET
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            FAILED.set(true);
        }
    }

    fn flush(&self) {}
}
