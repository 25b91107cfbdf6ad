//! What every form of foreign file has in common.

use super::error::ImportError;
use super::imported::Imported;
use super::question::{ImportOptions, Question};
use crate::measurement::foreign::TableOptions;
use crate::measurement::note::ImportNote;
use crate::measurement::{Progress, unwatched};

/// A form of files that is recognised by its content.
pub trait Format: Sync {
    /// The form in a sentence: `Woollam ellipsometry text`.
    fn name(&self) -> &'static str;

    /// What the import makes of such a file, for the help of the command line.
    fn help(&self) -> &'static str;

    /// Usual endings of the names of such files.
    fn extensions(&self) -> &'static [&'static str];

    /// Whether bytes look like such a file.
    fn sniff(&self, bytes: &[u8]) -> bool;

    /// Reads the file as far as the questions need.
    ///
    /// # Errors
    /// The file is damaged, or `progress` stops the reading.
    fn open(&self, bytes: Vec<u8>, progress: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError>;
}

/// A foreign file in memory.
pub trait ForeignFile: Send + Sync {
    /// What the import makes of the file, in one sentence; empty where the questions say it.
    fn summary(&self) -> &'static str;

    /// What has to be told before there is a measurement.
    fn questions(&self) -> Vec<Question>;

    /// Notices that no answer changes.
    fn notes(&self) -> Vec<ImportNote> {
        Vec::new()
    }

    /// The measurement.
    ///
    /// # Errors
    /// An answer is missing or does not fit the file, the file is damaged, or `progress` stops the
    /// reading.
    fn import(&self, options: &ImportOptions, progress: Progress<'_>) -> Result<Imported, ImportError>;

    /// The first rows of the measurement, without delay.
    ///
    /// # Errors
    /// An answer is missing or does not fit the file, or the first rows are damaged.
    fn preview(&self, options: &ImportOptions) -> Result<Imported, ImportError> {
        self.import(options, &mut unwatched)
    }

    /// The same file with its cells read in another way, where the options ask for one: another sheet of a workbook, another thousands
    /// separator. Its questions may differ.
    ///
    /// # Errors
    /// There is no such sheet, it holds no table, or `progress` stops the reading.
    fn reopened(&self, _options: &TableOptions, _progress: Progress<'_>) -> Result<Option<Box<dyn ForeignFile>>, ImportError> {
        Ok(None)
    }

    /// Whether a preview holds every row.
    fn preview_is_whole(&self) -> bool {
        true
    }
}
