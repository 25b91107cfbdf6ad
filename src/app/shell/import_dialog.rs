//! The state of the dialog that asks the questions of a foreign file.

use crate::app::jobs::memo::Memo;
use crate::app::storage::import::{Origin, with_notes};
use crate::app::work::design::AngleRange;
use pbrdf::measurement::formats::{ForeignFile, ImportError, ImportOptions, Imported, Question};
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
}

/// Answers of tables by the names of their columns: a file of the same shape is offered the same.
#[derive(Default)]
pub struct ImportMemory {
    /// The last one last.
    kept: Vec<(Vec<String>, ImportOptions)>,
}

/// Shapes that are remembered.
const REMEMBERED: usize = 20;

impl ImportMemory {
    /// Keeps the answers of a table that was opened.
    pub fn keep(&mut self, import: &ImportDialog) {
        let Some(shape) = import.shape() else { return };
        self.kept.retain(|(other, _)| other != shape);
        self.kept.push((shape.to_vec(), import.options.clone()));
        if self.kept.len() > REMEMBERED {
            self.kept.remove(0);
        }
    }

    /// Offers the answers that a table of the same shape was opened with.
    pub fn recall(&self, import: &mut ImportDialog) {
        if let Some((_, options)) = import.shape().and_then(|shape| self.kept.iter().find(|(kept, _)| kept == shape)) {
            import.options = options.clone();
        }
    }
}

impl ImportDialog {
    /// The names of the columns, of a table.
    fn shape(&self) -> Option<&[String]> {
        self.questions.iter().find_map(|question| match question {
            Question::Columns(sample) => Some(&sample.header[..]),
            _ => None,
        })
    }

    pub fn new(origin: Origin, file: Arc<dyn ForeignFile>) -> Self {
        let questions = file.questions();
        let options = ImportOptions::offered(&questions);
        let slices = Slices { theta_i: AngleRange::new(15.0, 75.0, 15.0), theta_r: AngleRange::new(-80.0, 80.0, 5.0) };
        Self { origin, file, questions, options, slices, preview: Memo::default(), error: None }
    }

    /// Before each frame: the preview of the options.
    pub fn refresh(&mut self) {
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
