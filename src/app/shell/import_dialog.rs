//! A foreign file that waits for a choice, and what the window keeps while it is asked for.

use crate::app::jobs::memo::Memo;
use crate::app::shell::app::App;
use crate::app::storage::import::{ImportOptions, ImportResult, ImportSource};
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use std::path::PathBuf;
use tr::tr;

/// Where a measurement comes from.
#[derive(Debug, Clone)]
pub struct Origin {
    pub name: String,
    /// The file, if there is one.
    pub path: Option<PathBuf>,
    /// SHA-256 of its bytes, of a file.
    pub sha256: Option<String>,
}

/// The file that is asked about.
pub struct ImportDialog {
    pub origin: Origin,
    pub foreign: ImportSource,
    pub choice: ImportOptions,
    /// Wavelengths to choose from, in nm.
    pub wavelengths_nm: Vec<f64>,
    /// The beginning of what the choice leads to in the language of the window, or why it leads nowhere as a phrase in English.
    pub preview: Memo<(ImportOptions, Language), Result<ImportResult, String>>,
    /// Why the whole file could not be read so, as a phrase in English.
    pub error: Option<String>,
}

impl ImportDialog {
    pub fn new(origin: Origin, foreign: ImportSource) -> Self {
        let choice = foreign.first_choice();
        let wavelengths_nm = foreign.wavelengths_nm();
        Self { origin, foreign, choice, wavelengths_nm, preview: Memo::default(), error: None }
    }
}

impl App {
    /// Before each frame: what the choice leads to.
    pub(crate) fn refresh_import(&mut self) {
        let Some(ImportDialog { foreign, choice, preview, error, .. }) = &mut self.import else { return };
        if preview.key().is_none_or(|(before, _)| before != choice) {
            *error = None;
        }
        preview.refresh((choice.clone(), i18n::current()), |(choice, _)| foreign.preview(choice));
    }

    /// Reads the whole file as it was chosen.
    pub(crate) fn start_import(&mut self) -> Result<(), String> {
        match &self.import {
            Some(import) => self.worker.import(import.foreign.clone(), import.choice.clone()),
            None => Ok(()),
        }
    }

    /// Away with the question; what is open stays.
    pub(crate) fn cancel_import(&mut self) {
        if self.import.take().is_some() {
            self.worker.abandon_load();
        }
    }

    pub(crate) fn imported(&mut self, result: Result<ImportResult, String>) {
        match (result, self.import.take()) {
            (Ok(mut imported), Some(import)) => {
                let name = import.origin.name.replace(char::is_control, " ");
                imported.measurement.metadata.push(("imported_from".to_owned(), name));
                self.loaded(import.origin, imported);
            }
            (Err(reason), Some(import)) => self.import = Some(ImportDialog { error: Some(reason), ..import }),
            // The question was withdrawn meanwhile.
            (_, None) => {}
        }
    }

    /// Puts a measurement that was read in the place of the one that is open.
    pub(crate) fn loaded(&mut self, origin: Origin, imported: ImportResult) {
        let Origin { name, path, sha256 } = origin;
        self.notices.reading_succeeded();
        // A file is the user's own work, and takes the place of what was set aside.
        if path.is_some() && self.lessons.open.is_some() {
            self.close_lesson();
            self.say(tr!("The lesson has ended, because {} was opened.", name));
        }
        if let Some(path) = &path {
            self.typed.served(path);
            self.window.remember(path);
        }
        let about = imported.notices.join(" ");
        if !about.is_empty() {
            self.say(format!("{name}: {about}"));
        }
        self.take(name, imported.measurement);
        self.work.document.sha256 = sha256;
        self.work.session_file = None;
    }
}
