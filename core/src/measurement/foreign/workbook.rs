//! Workbooks: the cells of a sheet as a grid.

use super::dialect::{Decimal, Dialect, Separator, UNIT_SEPARATOR};
use super::grid::CellGrid;
use super::layout::report;
use crate::measurement::formats::ImportError;
use crate::measurement::{Progress, ReadErrorKind};
use calamine::{Data, Reader as _, Sheets, open_workbook_auto_from_rs};
use std::io::Cursor;

/// Cells of a sheet, empty ones included; more are no table of measurements.
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
    let damaged = |error: &dyn std::fmt::Display| ImportError::Workbook { reason: error.to_string() };
    let mut workbook: Sheets<Cursor<Vec<u8>>> = open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
    let names = workbook.sheet_names();
    let name = match sheet {
        Some(wanted) => names.iter().find(|name| *name == wanted).cloned(),
        None => names.first().cloned(),
    };
    let name = name.ok_or_else(|| ImportError::NoSheet { wanted: sheet.unwrap_or("?").to_owned(), names: names.clone() })?;
    let range = workbook.worksheet_range(&name).map_err(|error| damaged(&error))?;
    let (rows, columns) = range.get_size();
    let first = range.start().map_or((0, 0), |(row, column)| (row as usize, column as usize));
    if rows.saturating_mul(columns) > MOST_CELLS {
        return Err(ImportError::Workbook { reason: format!("the sheet has {rows} rows of {columns} columns") });
    }
    let mut text = "\n".repeat(first.0);
    for (index, row) in range.rows().enumerate() {
        if index % super::layout::ROWS_PER_REPORT == 0 {
            report(progress, 0.2, index, rows)?;
        }
        for _ in 0..first.1 {
            text.push(UNIT_SEPARATOR);
        }
        for (column, cell) in row.iter().enumerate() {
            if column > 0 {
                text.push(UNIT_SEPARATOR);
            }
            push_cell(&mut text, cell);
        }
        text.push('\n');
    }
    if text.trim_matches(|letter: char| letter.is_whitespace() || letter == UNIT_SEPARATOR).is_empty() {
        return Err(ReadErrorKind::EmptyText.anywhere().into());
    }
    let dialect = Dialect { thousands, ..decimal_of(&text) };
    Ok((CellGrid::new(text, dialect)?, name, names))
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
