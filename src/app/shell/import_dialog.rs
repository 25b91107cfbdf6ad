//! The state of the dialog that asks the questions of a foreign file.

use crate::app::jobs::memo::Memo;
use crate::app::storage::import::{Origin, with_notes};
use crate::app::work::design::AngleRange;
use crate::app::work::import_memory::{KeptAnswers, TableShape, sample_of};
use pbrdf::measurement::foreign::TableOptions;
use pbrdf::measurement::formats::{ForeignFile, ImportError, ImportOptions, Imported, Question};
use std::path::PathBuf;
use std::sync::Arc;

/// Ranges of angles to slice at, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slices {
    pub theta_i: AngleRange,
    /// Negative is the backscatter side.
    pub theta_r: AngleRange,
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
    /// Of a table: its shape as it was first shown, and the sheet.
    first: Option<(TableShape, Option<String>)>,
    /// The answers that a table of this shape was opened with, which are offered.
    pub recalled: Option<KeptAnswers>,
    /// The options that the cells were read for, or could not be read for, at last.
    asked_for: Option<TableOptions>,
    pub alike: AlikeFiles,
}

/// Files that the same answers may be for.
#[derive(Debug, Default)]
pub struct AlikeFiles {
    /// Of those that were opened with it.
    pub opened: Vec<PathBuf>,
    /// Of its folder.
    pub folder: Vec<PathBuf>,
    /// Whether they are opened with the same answers.
    pub are_meant: bool,
}

impl AlikeFiles {
    /// The files that may be meant: others of the folder only where none was opened with it.
    pub fn paths(&self) -> &[PathBuf] {
        if self.opened.is_empty() { &self.folder } else { &self.opened }
    }
}

impl ImportDialog {
    pub fn new(origin: Origin, file: Arc<dyn ForeignFile>) -> Self {
        let questions = file.questions();
        let options = ImportOptions::offered(&questions);
        let slices = Slices { theta_i: AngleRange::new(15.0, 75.0, 15.0), theta_r: AngleRange::new(-80.0, 80.0, 5.0) };
        let sheet = sample_of(&questions).and_then(|sample| sample.sheet.clone());
        let first = TableShape::of(&questions).map(|shape| (shape, sheet));
        let (preview, alike) = (Memo::default(), AlikeFiles::default());
        Self { origin, file, questions, options, slices, preview, error: None, first, recalled: None, asked_for: None, alike }
    }

    /// The shape of a table as it was first shown.
    pub fn shape(&self) -> Option<&TableShape> {
        self.first.as_ref().map(|(shape, _)| shape)
    }

    /// What was chosen of a table.
    pub fn answers(&self) -> Option<KeptAnswers> {
        let (shape, sheet) = self.first.as_ref()?;
        Some(KeptAnswers::new(shape.clone(), &ImportOptions::offered(&self.questions), sheet.as_deref(), &self.options))
    }

    /// Offers the answers that a table of the same shape was opened with.
    pub fn recall(&mut self, answers: Option<&KeptAnswers>) {
        if let Some((answers, options)) = answers.and_then(|answers| Some((answers, answers.of(&self.questions)?))) {
            self.options = options;
            self.recalled = Some(answers.clone());
        }
    }

    /// Goes back to what the file itself suggests.
    pub fn forget_recalled(&mut self) {
        self.recalled = None;
        let (sheet, questions) = (self.first.as_ref().and_then(|(_, sheet)| sheet.clone()), &self.questions);
        self.options = ImportOptions::offered(questions);
        (self.options.table.sheet, self.options.table.thousands) = (sheet, None);
    }

    /// The options that ask for other cells than the file was read with, another sheet or thousands separator, when they do so first.
    pub fn asks_for_other_cells(&mut self) -> Option<TableOptions> {
        let is_new = !self.is_read() && self.asked_for.as_ref() != Some(&self.options.table);
        is_new.then(|| {
            self.error = None;
            self.asked_for.insert(self.options.table.clone()).clone()
        })
    }

    /// Takes the file with its cells read as those options ask, if they still do.
    pub fn reopened(&mut self, options: &TableOptions, result: Result<Option<Box<dyn ForeignFile>>, ImportError>) {
        if self.options.table != *options {
            return;
        }
        match result {
            Ok(None) => {}
            Ok(Some(file)) => {
                self.file = Arc::from(file);
                self.questions = self.file.questions();
                let asked = std::mem::take(&mut self.options.table);
                self.options = match &self.recalled {
                    Some(answers) => answers.adapted(&self.questions),
                    None => ImportOptions::offered(&self.questions),
                };
                let TableOptions { sheet, thousands, .. } = self.options.table.clone();
                self.options.table = TableOptions { sheet, thousands, ..asked };
                self.preview = Memo::default();
            }
            Err(error) => self.error = Some(error),
        }
    }

    /// Whether the cells are as the options ask for.
    pub fn is_read(&self) -> bool {
        let table = &self.options.table;
        let is_of = |sheet: &Option<String>| table.sheet.is_none() || table.sheet == *sheet;
        sample_of(&self.questions).is_none_or(|sample| table.thousands == sample.thousands && is_of(&sample.sheet))
    }

    /// Before each frame: the preview of the options.
    pub fn refresh(&mut self) {
        if !self.is_read() {
            return;
        }
        if self.asked_for.take().is_some() {
            self.error = None;
        }
        let Self { file, questions, options, slices, preview, error, .. } = self;
        if questions.iter().any(|question| matches!(question, Question::Directions)) {
            (options.theta_i, options.theta_r) = (slices.theta_i.angles().collect(), slices.theta_r.angles().collect());
        }
        if preview.key() != Some(options) {
            *error = None;
        }
        preview.refresh(options.clone(), |options| file.preview(options).map(|imported| with_notes(&**file, imported)));
    }
}
