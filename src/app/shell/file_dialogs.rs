//! File dialogs: what a command asks for, and what follows from the answer.

use crate::app::shell::commands::Command;
use crate::app::storage::export::ExportKind;
use crate::app::tasks::file_request::FileRequest;
use crate::app::work::document::Document;
use std::path::PathBuf;
use tr::tr;

/// What a command asks the user for.
pub fn request_for(document: &Document, command: &Command) -> Option<FileRequest> {
    match command {
        Command::ChooseMeasurement => Some(FileRequest::Open),
        Command::ChooseSession => Some(FileRequest::OpenSession),
        Command::ChooseSave => Some(FileRequest::Save(document.file_name())),
        Command::ChooseExport(kind) => Some(FileRequest::Export(*kind, kind.file_name(document))),
        _ => None,
    }
}

/// The command that uses the chosen path.
pub fn command_for(request: FileRequest, path: PathBuf) -> Command {
    match request {
        FileRequest::Open => Command::OpenMeasurement(path),
        FileRequest::OpenSession => Command::OpenSession(path),
        FileRequest::Save(_) => Command::SaveMeasurement(path),
        FileRequest::Export(kind, _) => {
            let complete = kind.with_ending(path.clone());
            // The desktop asked about the name without the extension.
            if complete == path { Command::Export(kind, path) } else { Command::ExportNew(kind, complete) }
        }
    }
}

/// What is missing where no dialog opens, and where the user can type a path instead.
pub fn unavailable_text(request: &FileRequest) -> String {
    let instead = match request {
        FileRequest::Open | FileRequest::OpenSession => tr!("Type the path in the menu File, under “Type a path to open”."),
        FileRequest::Save(_) | FileRequest::Export(ExportKind::Session, _) => {
            tr!("Type the path in the menu File, under “Save to a path”.")
        }
        FileRequest::Export(..) => tr!("Type the path in File › Export, at the end of that menu, and choose the export there again."),
    };
    let missing = tr!("No file dialog can open: there is neither a desktop portal (xdg-desktop-portal) nor the program zenity.");
    format!("{missing} {instead}")
}
