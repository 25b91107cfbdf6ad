//! File dialogs: what a command asks for, and what follows from the answer.

use crate::app::storage::export::ExportKind;
use crate::app::tasks::file_request::FileRequest;
use crate::app::views::action::Action;
use crate::app::work::open_measurement::OpenMeasurement;
use std::path::PathBuf;
use tr::tr;

/// What a command asks the user for.
pub fn request_for(document: &OpenMeasurement, command: &Action) -> Option<FileRequest> {
    match command {
        Action::ChooseMeasurement => Some(FileRequest::Open),
        Action::ChooseFolder => Some(FileRequest::OpenFolder),
        Action::ChooseSession => Some(FileRequest::OpenSession),
        Action::ChooseSave => Some(FileRequest::Save(document.file_name())),
        Action::ChooseExport(kind) => Some(FileRequest::Export(*kind, kind.file_name(document))),
        _ => None,
    }
}

/// The command that uses the chosen paths.
pub fn command_for(request: &FileRequest, mut paths: Vec<PathBuf>) -> Option<Action> {
    if matches!(request, FileRequest::Open) {
        return (!paths.is_empty()).then_some(Action::OpenMeasurements(paths));
    }
    let path = paths.pop()?;
    Some(match request {
        FileRequest::Open | FileRequest::OpenFolder => Action::OpenMeasurements(vec![path]),
        FileRequest::OpenSession => Action::OpenSession(path),
        FileRequest::Save(_) => Action::SaveMeasurement(path),
        FileRequest::Export(kind, _) => {
            let complete = kind.with_ending(path.clone());
            // The desktop asked about the name without the extension.
            if complete == path { Action::Export(*kind, path) } else { Action::ExportNew(*kind, complete) }
        }
    })
}

/// What is missing where no dialog opens, and where the user can type a path instead.
pub fn unavailable_text(request: &FileRequest) -> String {
    let instead = match request {
        FileRequest::Open | FileRequest::OpenFolder | FileRequest::OpenSession => {
            tr!("Type the path in the menu File, under “Type a path to open”.")
        }
        FileRequest::Save(_) | FileRequest::Export(ExportKind::Session, _) => {
            tr!("Type the path in the menu File, under “Save to a path”.")
        }
        FileRequest::Export(..) => tr!("Type the path in File › Export, at the end of that menu, and choose the export there again."),
    };
    let missing = tr!("No file dialog can open: there is neither a desktop portal (xdg-desktop-portal) nor the program zenity.");
    format!("{missing} {instead}")
}
