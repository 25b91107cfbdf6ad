//! Workbooks: the cells of a sheet as a grid.

use super::contained::contained;
use super::dialect::{Decimal, Dialect, Separator, UNIT_SEPARATOR};
use super::grid::CellGrid;
use super::layout::report;
use super::{old_workbook, open_document};
use crate::measurement::formats::ImportError;
use crate::measurement::{Progress, ReadErrorKind};
use calamine::{Cell, Data, DataRef, Reader as _, Sheets, open_workbook_auto_from_rs};
use std::io::Cursor;

/// Rows and columns that a sheet of a workbook may have.
const MOST_ROWS: usize = 1 << 20;
const MOST_COLUMNS: usize = 1 << 14;
/// Cells of the rows that hold any, empty ones included; more are no table of measurements.
const MOST_CELLS: usize = 100_000_000;

/// The cells of a sheet, the first without a name; its name, and the names of all.
///
/// # Errors
/// The workbook is damaged, the sheet is not there or empty, or `progress` stops the reading.
pub(crate) fn sheet_of(
    bytes: Vec<u8>,
    sheet: Option<&str>,
    thousands: Option<char>,
    progress: Progress<'_>,
) -> Result<(CellGrid, String, Vec<String>), ImportError> {
    let opened = contained(|| opened(bytes, sheet));
    let OpenedSheet { cells, name, names } = opened.unwrap_or_else(|| Err(damaged(&"its cells cannot be followed")))?;
    let columns = cells.iter().map(|cell| cell.column + 1).max().unwrap_or(0);
    let rows = cells.last().map_or(0, |cell| cell.row + 1);
    if rows > MOST_ROWS || columns > MOST_COLUMNS {
        return Err(ImportError::Workbook { reason: format!("the sheet claims {rows} rows of {columns} columns") });
    }
    let filled_rows = cells.chunk_by(|one, other| one.row == other.row);
    let count = filled_rows.clone().count();
    if count.saturating_mul(columns) > MOST_CELLS {
        return Err(ImportError::Workbook { reason: format!("the sheet has {count} rows of {columns} columns") });
    }
    let mut text = String::new();
    let mut written = 0;
    for (index, row) in filled_rows.enumerate() {
        if index % super::layout::ROWS_PER_REPORT == 0 {
            report(progress, 0.2, index, count)?;
        }
        // Rows without a cell are empty lines.
        text.extend(std::iter::repeat_n('\n', row[0].row - written));
        written = row[0].row + 1;
        push_row(&mut text, row, columns);
    }
    if text.trim_matches(|letter: char| letter.is_whitespace() || letter == UNIT_SEPARATOR).is_empty() {
        return Err(ReadErrorKind::EmptyText.anywhere().into());
    }
    let dialect = Dialect { thousands, ..decimal_of(&text) };
    Ok((CellGrid::new(text, dialect)?, name, names))
}

/// A sheet of a workbook.
struct OpenedSheet {
    cells: Vec<FilledCell>,
    name: String,
    /// The names of all sheets.
    names: Vec<String>,
}

fn opened(bytes: Vec<u8>, sheet: Option<&str>) -> Result<OpenedSheet, ImportError> {
    if old_workbook::is_old_workbook(&bytes) {
        old_workbook::check(&bytes).map_err(|reason| damaged(&reason))?;
    } else if open_document::is_open_document(&bytes) {
        open_document::check(&bytes).map_err(|reason| damaged(&reason))?;
    }
    let mut workbook: Sheets<Cursor<Vec<u8>>> = open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
    let names = workbook.sheet_names();
    let name = match sheet {
        Some(wanted) => names.iter().find(|name| *name == wanted).cloned(),
        None => names.first().cloned(),
    };
    let name = name.ok_or_else(|| ImportError::NoSheet { wanted: sheet.unwrap_or("?").to_owned(), names: names.clone() })?;
    Ok(OpenedSheet { cells: filled_cells(&mut workbook, &name)?, name, names })
}

/// A cell that is not empty, and where it stands, from 0.
struct FilledCell {
    row: usize,
    column: usize,
    value: Data,
}

impl FilledCell {
    fn new((row, column): (u32, u32), value: Data) -> Option<Self> {
        (value != Data::Empty).then_some(Self { row: row as usize, column: column as usize, value })
    }
}

/// The filled cells of a sheet, row after row. A lone cell at the far end of a sheet costs what one cell costs.
fn filled_cells(workbook: &mut Sheets<Cursor<Vec<u8>>>, name: &str) -> Result<Vec<FilledCell>, ImportError> {
    fn all<'a, E: std::fmt::Display>(
        mut next: impl FnMut() -> Result<Option<Cell<DataRef<'a>>>, E>,
        cells: &mut Vec<FilledCell>,
    ) -> Result<(), ImportError> {
        while let Some(cell) = next().map_err(|error| damaged(&error))? {
            cells.extend(FilledCell::new(cell.get_position(), cell.get_value().clone().into()));
        }
        Ok(())
    }
    let mut cells = Vec::new();
    match workbook {
        Sheets::Xlsx(workbook) => {
            let mut reader = workbook.worksheet_cells_reader(name).map_err(|error| damaged(&error))?;
            all(|| reader.next_cell(), &mut cells)?;
        }
        Sheets::Xlsb(workbook) => {
            let mut reader = workbook.worksheet_cells_reader(name).map_err(|error| damaged(&error))?;
            all(|| reader.next_cell(), &mut cells)?;
        }
        // These have at most 65,536 rows of 256 columns, and a limit of the library.
        Sheets::Xls(_) | Sheets::Ods(_) => {
            let range = workbook.worksheet_range(name).map_err(|error| damaged(&error))?;
            let (row, column) = range.start().unwrap_or_default();
            #[expect(clippy::cast_possible_truncation, reason = "a sheet has at most 2²⁰ rows and 2¹⁴ columns")]
            let place = |(r, c): (usize, usize)| (row + r as u32, column + c as u32);
            cells.extend(range.used_cells().filter_map(|(r, c, value)| FilledCell::new(place((r, c)), value.clone())));
        }
    }
    // The rows of a file may stand in any order.
    cells.sort_by_key(|cell| (cell.row, cell.column));
    cells.dedup_by_key(|cell| (cell.row, cell.column));
    Ok(cells)
}

fn damaged(error: &dyn std::fmt::Display) -> ImportError {
    ImportError::Workbook { reason: error.to_string() }
}

/// A row of a sheet as a line of so many cells.
fn push_row(text: &mut String, row: &[FilledCell], columns: usize) {
    let mut left = row;
    for column in 0..columns {
        if column > 0 {
            text.push(UNIT_SEPARATOR);
        }
        if let Some((cell, rest)) = left.split_first().filter(|(cell, _)| cell.column == column) {
            push_cell(text, &cell.value);
            left = rest;
        }
    }
    text.push('\n');
}

/// Numbers of cells have a point; text that is numbers may have a comma.
fn decimal_of(text: &str) -> Dialect {
    let with = |decimal| Dialect { separator: Separator::Character(UNIT_SEPARATOR), decimal, thousands: None };
    let is_comma = |cell: &str| cell.contains(',') && super::number::number(cell, with(Decimal::Comma)).is_some();
    let cells = || text.lines().take(2000).flat_map(|line| line.split(UNIT_SEPARATOR));
    let commas = cells().filter(|cell| is_comma(cell)).count();
    let points = cells().filter(|cell| cell.contains('.') && super::number::number(cell, with(Decimal::Point)).is_some()).count();
    with(if commas > points { Decimal::Comma } else { Decimal::Point })
}

fn push_cell(text: &mut String, cell: &Data) {
    match cell {
        Data::Empty => {}
        Data::Float(number) => text.push_str(&number.to_string()),
        Data::Int(number) => text.push_str(&number.to_string()),
        Data::Bool(is_true) => text.push(if *is_true { '1' } else { '0' }),
        Data::Error(_) => text.push_str("#N/A"),
        other => text.push_str(&other.to_string().replace(['\n', '\r', UNIT_SEPARATOR, '"'], " ")),
    }
}
