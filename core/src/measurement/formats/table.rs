//! Tables of other laboratories: by the guess of their columns, or by a mapping.

use super::error::ImportError;
use super::format::ForeignFile;
use super::imported::Imported;
use super::question::{ImportOptions, Question, TableSample};
use crate::measurement::foreign::{LabTable, RowKind, TableGuess, TableOptions};
use crate::measurement::{ColumnChoice, Field, MappedColumn, Mapping, Progress, ReadError, ReadErrorKind, unwatched};
use std::borrow::Cow;
use std::sync::Arc;

/// Rows of a sample.
const SAMPLE_ROWS: usize = 5;
/// Rows of the file that a dialog shows.
const SHOWN_ROWS: usize = 60;
/// Rows of data that a preview reads.
const PREVIEW_ROWS: usize = 200;

/// A table whose columns have foreign names, or none.
pub(crate) struct ForeignTable {
    bytes: Arc<[u8]>,
    table: LabTable,
    sample: Arc<TableSample>,
}

impl ForeignTable {
    /// A table of another laboratory; of a workbook the first sheet that is one.
    ///
    /// # Errors
    /// The file is no table with two columns of numbers, or `progress` stops the reading.
    pub(crate) fn new(bytes: Vec<u8>, progress: Progress<'_>) -> Result<Self, ImportError> {
        let bytes: Arc<[u8]> = bytes.into();
        let names = match Self::with(Arc::clone(&bytes), &TableOptions::default(), progress) {
            Err(ImportError::NoSheet { wanted, names }) if wanted.is_empty() => names,
            opened => return opened,
        };
        for sheet in names.iter().skip(1) {
            let options = TableOptions { sheet: Some(sheet.clone()), ..TableOptions::default() };
            match Self::with(Arc::clone(&bytes), &options, progress) {
                Err(ImportError::Read(ReadError { kind: ReadErrorKind::NoNumbers | ReadErrorKind::EmptyText, .. })) => {}
                opened => return opened,
            }
        }
        Err(ImportError::NoSheet { wanted: String::new(), names })
    }

    /// The same with that sheet and that thousands separator.
    fn with(bytes: Arc<[u8]>, options: &TableOptions, progress: Progress<'_>) -> Result<Self, ImportError> {
        let asked = TableOptions { sheet: options.sheet.clone(), thousands: options.thousands, ..TableOptions::default() };
        let table = LabTable::open(bytes.to_vec(), &asked, progress)?;
        let guess = table.guess(&asked)?;
        let header: Vec<String> = guess.columns[0].iter().map(|column| column.name.clone()).collect();
        let shown = table.first_rows(SHOWN_ROWS);
        let rows: Vec<Vec<String>> =
            shown.iter().filter(|row| row.kind == RowKind::Data).take(SAMPLE_ROWS).map(|row| row.cells.clone()).collect();
        let (sheet, sheets) = table.sheets().map_or((None, Vec::new()), |(sheet, all)| (Some(sheet.to_owned()), all.to_vec()));
        let (guess, table_guess) = (mapping_of(&guess), guess);
        let sample = TableSample { header, rows, shown, guess, table: table_guess, sheets, sheet, thousands: asked.thousands };
        Ok(Self { bytes, sample: Arc::new(sample), table })
    }

    /// Whether options ask for the cells as they were read.
    fn is_read_for(&self, options: &TableOptions) -> bool {
        options.thousands == self.sample.thousands && (options.sheet.is_none() || options.sheet == self.sample.sheet)
    }

    /// The table, read anew where another sheet or a thousands separator is asked for.
    fn table(&self, options: &TableOptions, progress: Progress<'_>) -> Result<Cow<'_, LabTable>, ImportError> {
        if self.is_read_for(options) {
            return Ok(Cow::Borrowed(&self.table));
        }
        LabTable::open(self.bytes.to_vec(), options, progress).map(Cow::Owned)
    }

    /// The options of the table: the columns of the guess are left to it.
    fn options(&self, options: &ImportOptions) -> TableOptions {
        let is_guess = options.columns.columns == self.sample.guess.columns || options.columns.columns.is_empty();
        let columns = Some(&options.columns).filter(|_| !is_guess);
        TableOptions { columns: columns.cloned(), theta_i: options.columns.theta_i, dphi: options.columns.dphi, ..options.table.clone() }
    }
}

/// The columns of the first block that hold one thing each.
fn mapping_of(guess: &TableGuess) -> Mapping {
    let mut mapping = Mapping { theta_i: guess.theta_i, ..Mapping::default() };
    for field in Field::all() {
        let mut columns = guess.columns[0].iter().enumerate().filter(|(_, column)| column.field == Some(field));
        if let (Some((index, column)), None) = (columns.next(), columns.next()) {
            mapping.columns.push(MappedColumn { field, column: ColumnChoice::Number(index + 1), unit: column.unit });
        }
    }
    mapping
}

impl ForeignFile for ForeignTable {
    fn summary(&self) -> &'static str {
        ""
    }

    fn questions(&self) -> Vec<Question> {
        vec![Question::Columns(Arc::clone(&self.sample))]
    }

    fn import(&self, options: &ImportOptions, progress: Progress<'_>) -> Result<Imported, ImportError> {
        let options = self.options(options);
        self.table(&options, progress)?.read(&options, progress)
    }

    fn preview(&self, options: &ImportOptions) -> Result<Imported, ImportError> {
        let options = self.options(options);
        self.table(&options, &mut unwatched)?.preview(&options, PREVIEW_ROWS)
    }

    fn reopened(&self, options: &TableOptions, progress: Progress<'_>) -> Result<Option<Box<dyn ForeignFile>>, ImportError> {
        if self.is_read_for(options) {
            return Ok(None);
        }
        Ok(Some(Box::new(Self::with(Arc::clone(&self.bytes), options, progress)?)))
    }

    fn preview_is_whole(&self) -> bool {
        self.table.data_rows() <= PREVIEW_ROWS
    }
}

impl Mapping {
    /// Reads a table whose columns the mapping names. The other columns are ignored and named. The
    /// table may be without a header.
    ///
    /// # Errors
    /// The mapping does not fit the header; else the first fault of the file, or a stop by
    /// `progress`.
    pub fn read_table(&self, bytes: &[u8], progress: Progress<'_>) -> Result<Imported, ImportError> {
        let options = TableOptions { columns: Some(self.clone()), ..TableOptions::default() };
        LabTable::open(bytes.to_vec(), &options, progress)?.read(&options, progress)
    }
}
