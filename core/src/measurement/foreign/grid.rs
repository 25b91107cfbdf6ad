//! Stage 2 of a foreign table: text to rows of cells, each with its line.

use super::dialect::{Dialect, Separator};
use crate::measurement::table::LONGEST_CELL;
use crate::measurement::{ColumnPlace, ReadError, ReadErrorKind};

/// Lines that a quoted cell may go on over.
const QUOTED_LINES: usize = 20;

/// Rows of cells that keep their places in the file.
#[derive(Debug, Clone)]
pub struct CellGrid {
    text: String,
    /// Where each row begins and ends in the text, and its line from 1.
    rows: Vec<(usize, usize, u64)>,
    dialect: Dialect,
}

impl CellGrid {
    /// The rows of a text, whose separator `sep=` may state.
    ///
    /// # Errors
    /// A cell is longer than any of a measurement.
    pub(crate) fn new(text: String, dialect: Dialect) -> Result<Self, ReadError> {
        let grid = Self { rows: rows_of(&text), text, dialect };
        grid.check_lengths()?;
        Ok(grid)
    }

    fn check_lengths(&self) -> Result<(), ReadError> {
        let mut cells = Vec::new();
        for row in 0..self.rows.len() {
            let (start, end, line) = self.rows[row];
            if end - start <= LONGEST_CELL {
                continue;
            }
            self.cells(row, &mut cells);
            if let Some(index) = cells.iter().position(|cell| cell.len() > LONGEST_CELL) {
                let column = Some(ColumnPlace { number: index + 1, name: String::new() });
                return Err(ReadError { line: Some(line), column, kind: ReadErrorKind::LongCell { bytes: cells[index].len() } });
            }
        }
        Ok(())
    }

    /// Number of rows, empty ones included.
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Line of a row, from 1.
    pub(crate) fn line(&self, row: usize) -> u64 {
        self.rows.get(row).map_or(0, |(_, _, line)| *line)
    }

    /// The text of a row.
    pub(crate) fn text(&self, row: usize) -> &str {
        let (start, end, _) = self.rows[row];
        &self.text[start..end]
    }

    /// How the cells are separated and their numbers are written.
    pub(crate) fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// The cells of a row, without quotes and white space around them, into `cells`.
    pub(crate) fn cells<'a>(&'a self, row: usize, cells: &mut Vec<&'a str>) {
        cells.clear();
        split(self.text(row), self.dialect.separator, cells);
    }
}

/// The rows of a text: lines, or several where a quoted cell goes on over them.
fn rows_of(text: &str) -> Vec<(usize, usize, u64)> {
    let mut rows = Vec::new();
    let (mut start, mut line) = (0, 1_u64);
    while start < text.len() {
        let line_end = |from: usize| text[from..].find('\n').map_or(text.len(), |length| from + length);
        let first_end = line_end(start);
        let mut end = first_end;
        let mut lines = 1;
        if text[start..first_end].contains('"') && is_open(&text[start..first_end]) {
            for more in 2..=QUOTED_LINES {
                if end >= text.len() || end - start > LONGEST_CELL {
                    break;
                }
                end = line_end(end + 1);
                if !is_open(&text[start..end]) {
                    lines = more as u64;
                    break;
                }
            }
            if lines == 1 {
                // Never closed: the quote is a letter.
                end = first_end;
            }
        }
        rows.push((start, end, line));
        line += lines;
        start = end + 1;
    }
    rows
}

/// Whether a quote at the beginning of a cell is not closed.
fn is_open(text: &str) -> bool {
    let mut open = false;
    let mut before = None;
    for letter in text.chars() {
        if letter == '"' {
            open = if open { false } else { !matches!(before, Some(letter) if !is_separator(letter) && letter != '"') };
        }
        before = Some(letter);
    }
    open
}

fn is_separator(letter: char) -> bool {
    matches!(letter, ',' | ';' | '\t' | '|' | ' ' | '\n' | super::dialect::UNIT_SEPARATOR)
}

/// Splits a row at a separator outside of quotes.
pub(crate) fn split<'a>(row: &'a str, separator: Separator, cells: &mut Vec<&'a str>) {
    match separator {
        Separator::Character(separator) if !row.contains('"') => cells.extend(row.split(separator).map(str::trim)),
        Separator::Character(separator) => {
            let mut rest = row;
            loop {
                let end = quoted_length(rest);
                let end = end + rest[end..].find(separator).unwrap_or(rest.len() - end);
                cells.push(unquoted(rest[..end].trim()));
                match rest.get(end + separator.len_utf8()..) {
                    Some(after) if end < rest.len() => rest = after,
                    _ => break,
                }
            }
        }
        Separator::Blanks { least } => {
            let mut rest = row.trim();
            while !rest.is_empty() {
                let quoted = quoted_length(rest);
                let end = quoted + blank_run(&rest[quoted..], least);
                cells.push(unquoted(rest[..end].trim()));
                rest = rest[end..].trim_start();
            }
        }
    }
}

/// Length of a quoted cell at the beginning of a text, white space before it included; else 0.
fn quoted_length(text: &str) -> usize {
    let indent = text.len() - text.trim_start_matches(' ').len();
    let Some(inside) = text[indent..].strip_prefix('"') else { return 0 };
    let mut from = 0;
    while let Some(quote) = inside[from..].find('"') {
        from += quote + 1;
        if inside[from..].starts_with('"') {
            from += 1;
        } else {
            return indent + 1 + from;
        }
    }
    0
}

/// Where white space of that many characters, or a tab, begins; the end of the text without.
fn blank_run(text: &str, least: usize) -> usize {
    let mut run = (0, 0);
    for (index, letter) in text.char_indices() {
        if !letter.is_whitespace() {
            run = (index + letter.len_utf8(), 0);
            continue;
        }
        run.1 += if letter == '\t' { least } else { 1 };
        if run.1 >= least {
            return run.0;
        }
    }
    text.len()
}

fn unquoted(cell: &str) -> &str {
    cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).map_or(cell, str::trim)
}

#[cfg(test)]
mod tests {
    use super::super::dialect::{Decimal, Dialect, Separator};
    use super::CellGrid;

    fn cells(text: &str, separator: Separator) -> Vec<Vec<String>> {
        let grid = CellGrid::new(text.to_owned(), Dialect { separator, decimal: Decimal::Point, thousands: None }).expect("short cells");
        let mut cells = Vec::new();
        let rows = (0..grid.len()).map(|row| {
            grid.cells(row, &mut cells);
            cells.iter().map(ToString::to_string).collect()
        });
        rows.collect()
    }

    #[test]
    fn separators_in_quotes_and_runs_of_blanks_are_no_separators() {
        let comma = Separator::Character(',');
        assert_eq!(cells("a , \"b, c\",,\"d\"\"\"", comma), [["a", "b, c", "", "d\"\""]]);
        assert_eq!(cells("5\" plate,1\nx,2", comma), [["5\" plate", "1"], ["x", "2"]]);
        assert_eq!(cells("\"DoLP\n(%)\",b\n1,2", comma), [["DoLP\n(%)", "b"], ["1", "2"]]);
        assert_eq!(cells("\"never closed,1\n2,3", comma).len(), 2);
        assert_eq!(cells("  a \"b c\"\t d ", Separator::Blanks { least: 1 }), [["a", "b c", "d"]]);
        assert_eq!(cells("view angle   DoLP\t1", Separator::Blanks { least: 2 }), [["view angle", "DoLP", "1"]]);
    }

    #[test]
    fn an_endless_cell_is_refused_with_its_place() {
        let text = format!("a,b\n1,{}\n", "x".repeat(100_000));
        let dialect = Dialect { separator: Separator::Character(','), decimal: Decimal::Point, thousands: None };
        let error = CellGrid::new(text, dialect).expect_err("a long cell").to_string();
        assert!(error.starts_with("line 2, column 2: the cell has 100000 bytes"), "{error}");
    }
}
