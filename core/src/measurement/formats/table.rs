//! Tables of other laboratories, read by a mapping of their columns.

use super::error::ImportError;
use super::format::{ForeignFile, Imported};
use super::question::{ImportOptions, Question, TableSample};
use crate::measurement::rows::{RowReader, place};
use crate::measurement::{Expected, Field, Mapping, Measurement, Progress, ReadError, ReadErrorKind, Table, unwatched};
use std::io::Read;
use std::sync::Arc;

/// Rows of a sample.
const SAMPLE_ROWS: usize = 5;
/// Bytes of a table that a preview reads.
const HEAD_BYTES: usize = 1 << 16;

/// A table whose columns have foreign names, or none.
pub(crate) struct ForeignTable {
    bytes: Vec<u8>,
    sample: Arc<TableSample>,
}

impl ForeignTable {
    /// A table that is none of this project's own for that reason.
    ///
    /// # Errors
    /// The reason itself, where the table has no two columns of numbers, or has this project's own
    /// names alone and no quantity among them; or the beginning cannot be read.
    pub(crate) fn new(bytes: Vec<u8>, reason: ReadError) -> Result<Self, ReadError> {
        let table = Table::foreign(head(&bytes))?;
        let header = table.header().to_vec();
        let (mut rows, mut is_numeric) = (Vec::new(), vec![false; header.len()]);
        // The import itself reports the faults of rows.
        let _ = table.for_each(&mut unwatched, |record| {
            if rows.len() < SAMPLE_ROWS {
                rows.push((0..header.len()).map(|column| record.text(column)).collect());
                for (column, is_numeric) in is_numeric.iter_mut().enumerate() {
                    *is_numeric |= record.number(column, Expected::FiniteNumber).is_ok();
                }
            }
            Ok(())
        });
        let has_own_names = header.iter().all(|name| Field::from_key(name).is_some());
        let lacks_quantity = has_own_names && matches!(reason.kind, ReadErrorKind::NoQuantity { .. });
        let is_table = header.len() > 2 || is_numeric.iter().filter(|is_numeric| **is_numeric).count() >= 2;
        if lacks_quantity || !is_table {
            return Err(reason);
        }
        let guess = Mapping::guess(&header, table.metadata());
        Ok(Self { sample: Arc::new(TableSample { header, rows, guess, reason }), bytes })
    }
}

impl ForeignFile for ForeignTable {
    fn summary(&self) -> &'static str {
        ""
    }

    fn questions(&self) -> Vec<Question> {
        vec![Question::Columns(Arc::clone(&self.sample))]
    }

    fn import(&self, options: &ImportOptions, progress: Progress<'_>) -> Result<Imported, ImportError> {
        let measurement = options.columns.read_table(&self.bytes[..], progress)?;
        Ok(Imported { measurement, notes: Vec::new() })
    }

    fn preview(&self, options: &ImportOptions) -> Result<Imported, ImportError> {
        let measurement = options.columns.read_table(head(&self.bytes), &mut unwatched)?;
        Ok(Imported { measurement, notes: Vec::new() })
    }

    fn preview_is_whole(&self) -> bool {
        self.bytes.len() <= HEAD_BYTES
    }
}

/// The first lines, whole ones.
fn head(bytes: &[u8]) -> &[u8] {
    if bytes.len() <= HEAD_BYTES {
        return bytes;
    }
    let end = bytes[..HEAD_BYTES].iter().rposition(|&byte| byte == b'\n' || byte == b'\r').unwrap_or(HEAD_BYTES);
    &bytes[..end]
}

impl Mapping {
    /// Reads a table whose columns the mapping names. The other columns are ignored and named. The
    /// table may be without a header.
    ///
    /// # Errors
    /// The mapping does not fit the header; else the first fault of the file, or a stop by
    /// `progress`.
    pub fn read_table(&self, source: impl Read, progress: Progress<'_>) -> Result<Measurement, ReadError> {
        let table = Table::foreign(source)?;
        let rows = RowReader::mapped(&table, self)?;
        let mut used = Vec::new();
        for field in Field::ALL {
            used.extend(place(self, field, &table)?.map(|(index, _)| index));
        }
        let others = (0..table.header().len()).filter(|index| !used.contains(index));
        let ignored_columns: Vec<String> = others.map(|index| table.title(index)).collect();
        rows.read(&table, &ignored_columns, false, progress).map(|mut all| all.swap_remove(0))
    }
}
