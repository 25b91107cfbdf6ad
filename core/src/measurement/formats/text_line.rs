//! Text files of numbers split by white space: what the readers of instruments share.

use crate::measurement::table::BYTE_ORDER_MARK;
use crate::measurement::{ColumnPlace, Expected, Progress, ReadError, ReadErrorKind};

/// Lines between two reports of progress.
const LINES_PER_REPORT: u64 = 4096;
/// Letters of a line that a message quotes.
const QUOTED: usize = 40;

/// A line that is not empty.
pub(super) struct TextLine<'a> {
    /// Its number, from 1.
    pub(super) number: u64,
    /// Its words.
    pub(super) cells: Vec<&'a str>,
    /// The line without white space around it.
    pub(super) text: &'a str,
}

/// Hands every line that is not empty to `visit` and reports to `progress`. Bytes that are no UTF-8
/// become U+FFFD: names of samples may have any encoding.
///
/// # Errors
/// The text is UTF-16 or has a NUL byte, an error of `visit`, or a stop by `progress`.
pub(super) fn for_each_line(
    bytes: &[u8],
    progress: Progress<'_>,
    mut visit: impl FnMut(&TextLine<'_>) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(ReadErrorKind::Utf16.anywhere());
    }
    // A lone carriage return ended the lines of old Macs.
    let line_end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let text = bytes.strip_prefix(&BYTE_ORDER_MARK).unwrap_or(bytes);
    let mut done = 0;
    for (number, line) in (1_u64..).zip(text.split(|&byte| byte == line_end)) {
        done += line.len() + 1;
        if number.is_multiple_of(LINES_PER_REPORT) {
            #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress bar")]
            let share = (done as f64 / text.len() as f64).min(1.0);
            if progress(share).is_break() {
                return Err(ReadErrorKind::Cancelled.anywhere());
            }
        }
        if line.contains(&0) {
            return Err(ReadErrorKind::Nul.at_line(number));
        }
        let line = String::from_utf8_lossy(line);
        let line = TextLine { number, cells: line.split_whitespace().collect(), text: line.trim() };
        if !line.cells.is_empty() {
            visit(&line)?;
        }
    }
    Ok(())
}

impl TextLine<'_> {
    /// A cell as a finite number that is allowed; `name` and `expected` are for the message.
    pub(super) fn number(&self, cell: usize, name: &str, expected: Expected, is_allowed: impl Fn(f64) -> bool) -> Result<f64, ReadError> {
        let number =
            self.cells.get(cell).and_then(|text| text.parse().ok()).filter(|&number: &f64| number.is_finite() && is_allowed(number));
        number.ok_or_else(|| self.cell_error(cell, name, expected))
    }

    /// An error at a cell.
    pub(super) fn cell_error(&self, cell: usize, name: &str, expected: Expected) -> ReadError {
        let found = self.cells.get(cell).map_or_else(String::new, |text| (*text).to_owned());
        let column = Some(ColumnPlace { number: cell + 1, name: name.to_owned() });
        ReadError { line: Some(self.number), column, kind: ReadErrorKind::NotANumber { found, expected } }
    }

    /// An error of the line as a whole, which quotes its beginning.
    pub(super) fn unexpected(&self, expected: Expected) -> ReadError {
        self.error(ReadErrorKind::Unexpected { found: self.text.chars().take(QUOTED).collect(), expected })
    }

    /// An error of the line as a whole.
    pub(super) fn error(&self, kind: ReadErrorKind) -> ReadError {
        kind.at_line(self.number)
    }
}
