//! What dialogs ask the user for.

use crate::app::platform::{DialogUnavailable, FileDialog, FileFilter, PathPurpose, show_file_dialog};
use crate::app::storage::export::ExportKind;
use pbrdf::measurement::formats::extensions;
use std::path::PathBuf;
use tr::tr;

/// What a dialog asks for.
#[derive(Debug, Clone)]
pub enum FileRequest {
    /// The measurements to open.
    Open,
    /// The folder whose measurements to open.
    OpenFolder,
    /// Where to save the measurement, with a suggested name.
    Save(String),
    /// The session to open.
    OpenSession,
    /// Where to write an export, with a suggested name.
    Export(ExportKind, String),
}

/// The chosen paths; none where the user cancels.
pub type FileReply = Result<Vec<PathBuf>, DialogUnavailable>;

/// Asks in a dialog and waits for the answer.
///
/// # Errors
/// No dialog can open.
pub fn ask_user(request: FileRequest) -> FileReply {
    show_file_dialog(dialog(request))
}

fn dialog(request: FileRequest) -> FileDialog {
    let filter = |name: String, extensions| FileFilter { name, extensions };
    match request {
        FileRequest::Open => FileDialog {
            title: tr!("Open measurements"),
            purpose: PathPurpose::OpenSeveral,
            filters: vec![filter(tr!("Measurements"), extensions()), filter(tr!("All files"), vec!["*"])],
        },
        FileRequest::OpenFolder => {
            FileDialog { title: tr!("Open a folder of measurements"), purpose: PathPurpose::OpenFolder, filters: Vec::new() }
        }
        FileRequest::OpenSession => {
            FileDialog { title: tr!("Open session"), purpose: PathPurpose::Open, filters: vec![filter(tr!("Sessions"), vec!["json"])] }
        }
        FileRequest::Export(what, suggested_name) => FileDialog {
            title: tr!("Export"),
            purpose: PathPurpose::Save { suggested_name },
            filters: what.extensions().iter().map(|&extension| filter(extension.to_owned(), vec![extension])).collect(),
        },
        FileRequest::Save(suggested_name) => FileDialog {
            title: tr!("Save measurement as"),
            purpose: PathPurpose::Save { suggested_name },
            filters: vec![filter("CSV".to_owned(), vec!["csv"])],
        },
    }
}
