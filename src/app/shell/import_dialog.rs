//! The state of the dialog that asks the questions of a foreign file.

use crate::app::jobs::memo::Memo;
use crate::app::shell::app::App;
use crate::app::storage::import::{Origin, with_notes};
use crate::app::text::localized::Localized;
use crate::app::work::design::Span;
use crate::app::work::document::Document;
use pbrdf::measurement::formats::{ForeignFile, ImportError, ImportOptions, Imported, Question};
use std::sync::Arc;
use tr::tr;

/// Ranges of angles to slice at, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slices {
    pub theta_i: Span,
    /// Negative is the backscatter side.
    pub theta_r: Span,
}

/// The file that is asked about.
pub struct ImportDialog {
    pub origin: Origin,
    pub file: Arc<dyn ForeignFile>,
    pub questions: Vec<Question>,
    pub options: ImportOptions,
    pub slices: Slices,
    /// The first rows that the options lead to, or why there are none.
    pub preview: Memo<ImportOptions, Result<Imported, ImportError>>,
    /// Why the whole file could not be read with these options.
    pub error: Option<ImportError>,
}

impl ImportDialog {
    pub fn new(origin: Origin, file: Arc<dyn ForeignFile>) -> Self {
        let questions = file.questions();
        let options = ImportOptions::offered(&questions);
        let slices = Slices { theta_i: Span::new(15.0, 75.0, 15.0), theta_r: Span::new(-80.0, 80.0, 5.0) };
        Self { origin, file, questions, options, slices, preview: Memo::default(), error: None }
    }
}

impl App {
    /// Before each frame: the preview of the options.
    pub(crate) fn refresh_import(&mut self) {
        let Some(ImportDialog { file, questions, options, slices, preview, error, .. }) = &mut self.import else { return };
        if questions.iter().any(|question| matches!(question, Question::Directions)) {
            (options.theta_i, options.theta_r) = (slices.theta_i.angles().collect(), slices.theta_r.angles().collect());
        }
        if preview.key() != Some(options) {
            *error = None;
        }
        preview.refresh(options.clone(), |options| file.preview(options).map(|imported| with_notes(&**file, imported)));
    }

    /// Reads the whole file with the options.
    pub(crate) fn start_import(&mut self) -> Result<(), String> {
        match &self.import {
            Some(import) => self.jobs.files.import(Arc::clone(&import.file), import.options.clone()),
            None => Ok(()),
        }
    }

    /// Closes the dialog; the open measurement stays.
    pub(crate) fn cancel_import(&mut self) {
        if self.import.take().is_some() {
            self.jobs.files.abandon_load();
        }
    }

    pub(crate) fn imported(&mut self, result: Result<Imported, ImportError>) {
        match (result, self.import.take()) {
            (Ok(mut imported), Some(import)) => {
                let name = import.origin.name.replace(char::is_control, " ");
                imported.measurement.metadata.push(("imported_from".to_owned(), name));
                self.loaded(import.origin, imported);
            }
            (Err(error), Some(import)) => self.import = Some(ImportDialog { error: Some(error), ..import }),
            // The dialog was closed meanwhile.
            (_, None) => {}
        }
    }

    /// Replaces the open measurement by one that was read.
    pub(crate) fn loaded(&mut self, origin: Origin, imported: Imported) {
        let Origin { name, path, sha256 } = origin;
        self.notices.dismiss_load_errors();
        // A file is the user's own work, and takes the place of what was set aside.
        if path.is_some() && self.lessons.open.is_some() {
            self.close_lesson();
            self.say(tr!("The lesson has ended, because {} was opened.", name));
        }
        if let Some(path) = &path {
            self.typed.served(path);
            self.window.remember(path);
        }
        let about = imported.notes.iter().map(Localized::localized).collect::<Vec<_>>().join(" ");
        if !about.is_empty() {
            self.say(format!("{name}: {about}"));
        }
        self.open(Document::new(name, imported.measurement).of_file(sha256));
        self.work.session_file = None;
    }
}
