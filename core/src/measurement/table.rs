//! Tables of cells with named columns: what the readers of text files share.
//!
//! Comma, semicolon or tab separates, told from the header; with the latter two a decimal comma is
//! understood. Lines that begin with `#` may stand anywhere; `# key: value` is metadata. Byte order
//! mark, CRLF, and any encoding inside comments are accepted. A quoted cell ends on its own line.

use crate::measurement::note::LineList;
use crate::measurement::{ColumnPlace, Expected, Progress, ReadError, ReadErrorKind, is_not_measured, quote};
use std::cell::RefCell;
use std::io::Read;

/// A table in memory whose header is read.
pub struct Table {
    bytes: Vec<u8>,
    delimiter: u8,
    header: Vec<String>,
    header_line: u64,
    metadata: Vec<(String, String)>,
    /// The first cell of each column with a decimal point or comma, where both may be decimal marks.
    decimal_marks: RefCell<Vec<Option<(u64, String)>>>,
}

/// One row of a table, which knows the names of its cells for errors.
pub struct Record<'a> {
    table: &'a Table,
    cells: &'a csv::ByteRecord,
    line: u64,
}

/// U+FEFF in UTF-8, which some programs write first.
pub(crate) const BYTE_ORDER_MARK: [u8; 3] = [0xef, 0xbb, 0xbf];

/// Bytes of a cell; a longer one is no cell of a measurement.
pub(crate) const LONGEST_CELL: usize = 1 << 16;

/// Rows between two reports of progress.
const ROWS_PER_REPORT: u64 = 4096;

impl Table {
    /// Reads the whole source, its metadata and its header.
    ///
    /// # Errors
    /// The source fails, is empty or no text, or has numbers in place of a header.
    pub fn new(source: impl Read) -> Result<Self, ReadError> {
        Self::scanned(source)?.with_header()
    }

    fn scanned(mut source: impl Read) -> Result<Self, ReadError> {
        let mut bytes = Vec::new();
        source.read_to_end(&mut bytes).map_err(|error| ReadErrorKind::Io(error).anywhere())?;
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            return Err(ReadErrorKind::Utf16.anywhere());
        }
        if bytes.starts_with(&BYTE_ORDER_MARK) {
            bytes.drain(..BYTE_ORDER_MARK.len());
        }
        if !bytes.contains(&b'\n') {
            // A lone carriage return ended the lines of old Macs.
            bytes.iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
        }
        let mut table =
            Self { delimiter: b',', header: Vec::new(), header_line: 0, metadata: Vec::new(), decimal_marks: RefCell::default(), bytes };
        table.scan()?;
        Ok(table)
    }

    /// Walks the lines once for metadata and the delimiter, and for faults that would mislead a CSV
    /// parser.
    fn scan(&mut self) -> Result<(), ReadError> {
        let Self { bytes, delimiter, metadata, .. } = self;
        let mut header_seen = false;
        for (number, line) in (1..).zip(bytes.split_mut(|&byte| byte == b'\n')) {
            let indent = line.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let is_comment = line.get(indent) == Some(&b'#');
            if is_comment {
                line[..indent].fill(b'#');
                metadata.extend(metadata_of(line));
            } else if indent == line.len() {
                // White space alone is an empty line.
                line.fill(b'\r');
            } else if !header_seen {
                header_seen = true;
                *delimiter = separator_of(line);
            }
            let at = |position: usize, kind| {
                let before = line[..position].iter().filter(|byte| *byte == delimiter).count();
                let column = (!is_comment).then(|| ColumnPlace { number: before + 1, name: String::new() });
                Err(ReadError { line: Some(number), column, kind })
            };
            if line.len() > LONGEST_CELL
                && !is_comment
                && let Some((index, cell)) = line.split(|byte| byte == delimiter).enumerate().find(|(_, cell)| cell.len() > LONGEST_CELL)
            {
                let column = Some(ColumnPlace { number: index + 1, name: String::new() });
                return Err(ReadError { line: Some(number), column, kind: ReadErrorKind::LongCell { bytes: cell.len() } });
            }
            if let Some(position) = line.iter().position(|&byte| byte == 0) {
                return at(position, ReadErrorKind::Nul);
            }
            let quotes = line.iter().filter(|&&byte| byte == b'"').count();
            if !is_comment && quotes % 2 == 1 {
                let last = line.iter().rposition(|&byte| byte == b'"').unwrap_or(0);
                return at(last, ReadErrorKind::UnclosedQuote);
            }
        }
        Ok(())
    }

    fn csv_reader(&self) -> csv::Reader<&[u8]> {
        csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .delimiter(self.delimiter)
            .trim(csv::Trim::All)
            .from_reader(&self.bytes)
    }

    fn with_header(mut self) -> Result<Self, ReadError> {
        let mut record = csv::ByteRecord::new();
        if !read_record(&mut self.csv_reader(), &mut record)? {
            return Err(ReadErrorKind::Empty.anywhere());
        }
        let header: Vec<String> = record.iter().map(|cell| String::from_utf8_lossy(cell).trim().to_owned()).collect();
        self.header_line = self.line_of(&record);
        let numbers = header.iter().filter(|cell| cell.replace(',', ".").parse::<f64>().is_ok()).count();
        // The header of a spectral table may hold wavelengths behind its names.
        let is_first = header.first().is_some_and(|cell| cell.replace(',', ".").parse::<f64>().is_ok());
        if is_first && 2 * numbers >= header.len() {
            let found = header.into_iter().next().unwrap_or_default();
            return Err(ReadErrorKind::NoHeader { found }.at_line(self.header_line));
        }
        self.header = header;
        Ok(self)
    }

    /// Names of the columns.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// `# key: value` lines, in their order.
    #[must_use]
    pub fn metadata(&self) -> &[(String, String)] {
        &self.metadata
    }

    /// Index of the column of that name, if there is one.
    ///
    /// # Errors
    /// Two columns have that name.
    pub fn find(&self, name: &str) -> Result<Option<usize>, ReadError> {
        let mut found = self.header.iter().enumerate().filter(|(_, column)| *column == name).map(|(index, _)| index);
        match (found.next(), found.next()) {
            (Some(first), Some(second)) => Err(self.repeated(first, second)),
            (first, _) => Ok(first),
        }
    }

    /// Index of a column that has to be there.
    ///
    /// # Errors
    /// No column or two columns have that name.
    pub fn require(&self, name: &'static str) -> Result<usize, ReadError> {
        self.find(name)?.ok_or_else(|| {
            let similar = self.header.iter().find(|column| column.eq_ignore_ascii_case(name)).cloned();
            self.header_error(ReadErrorKind::MissingColumn { name, similar })
        })
    }

    pub(crate) fn header_error(&self, kind: ReadErrorKind) -> ReadError {
        kind.at_line(self.header_line)
    }

    pub(crate) fn repeated(&self, first: usize, second: usize) -> ReadError {
        let kind = ReadErrorKind::RepeatedColumn { first: first + 1 };
        ReadError { line: Some(self.header_line), column: Some(self.column(second)), kind }
    }

    fn column(&self, index: usize) -> ColumnPlace {
        ColumnPlace { number: index + 1, name: quote(&self.header[index]) }
    }

    /// Line of a record from 1. The position of the CSV reader is where it began to look: before
    /// comments and empty lines, or at the line feed that ends the line before.
    fn line_of(&self, record: &csv::ByteRecord) -> u64 {
        let Some(position) = record.position() else { return 1 };
        let from = usize::try_from(position.byte()).unwrap_or(usize::MAX);
        let mut rest = self.bytes.get(from..).unwrap_or_default().split(|&byte| byte == b'\n');
        let skipped = rest.position(|line| line.first() != Some(&b'#') && line.iter().any(|&byte| byte != b'\r'));
        position.line() + skipped.map_or(0, |skipped| skipped as u64)
    }

    /// Hands every row to `visit` and reports to `progress`; returns the rows in which every cell is
    /// empty, which are skipped.
    ///
    /// # Errors
    /// A row of another length than the header, no row at all, an error of `visit`, or a stop by
    /// `progress`.
    pub fn for_each(
        &self,
        progress: Progress<'_>,
        mut visit: impl FnMut(&Record<'_>) -> Result<(), ReadError>,
    ) -> Result<LineList, ReadError> {
        let mut blank = LineList::default();
        let mut reader = self.csv_reader();
        let mut cells = csv::ByteRecord::new();
        read_record(&mut reader, &mut cells)?;
        let mut rows = 0_u64;
        while read_record(&mut reader, &mut cells)? {
            let line = self.line_of(&cells);
            if cells.iter().all(<[u8]>::is_empty) {
                blank.push(line);
                continue;
            }
            if cells.len() != self.header.len() {
                let separator = char::from(self.delimiter);
                return Err(ReadErrorKind::RowLength { found: cells.len(), expected: self.header.len(), separator }.at_line(line));
            }
            visit(&Record { table: self, cells: &cells, line })?;
            rows += 1;
            if rows.is_multiple_of(ROWS_PER_REPORT) {
                #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress bar")]
                let done = cells.position().map_or(0.0, |position| position.byte() as f64 / self.bytes.len() as f64);
                if progress(done).is_break() {
                    return Err(ReadErrorKind::Cancelled.anywhere());
                }
            }
        }
        if rows == 0 { Err(self.header_error(ReadErrorKind::HeaderOnly)) } else { Ok(blank) }
    }
}

/// Reads the next record. The source is in memory and rows may be of any length: no error is known.
fn read_record(reader: &mut csv::Reader<&[u8]>, record: &mut csv::ByteRecord) -> Result<bool, ReadError> {
    reader.read_byte_record(record).map_err(|error| ReadErrorKind::Io(std::io::Error::other(error)).anywhere())
}

/// The separator of a table with that header.
pub(crate) fn separator_of(header: &[u8]) -> u8 {
    let outside_quotes: Vec<u8> = header.split(|&byte| byte == b'"').step_by(2).flatten().copied().collect();
    [b';', b'\t', b','].into_iter().find(|byte| outside_quotes.contains(byte)).unwrap_or(b',')
}

/// Key and value of a comment line, if it has that form.
fn metadata_of(line: &[u8]) -> Option<(String, String)> {
    let text = String::from_utf8_lossy(line);
    let (key, value) = text.trim_start_matches('#').split_once(':')?;
    let key = key.trim();
    (!key.is_empty()).then(|| (key.to_owned(), value.trim().to_owned()))
}

impl Record<'_> {
    /// Line of the file, from 1.
    #[must_use]
    pub fn line(&self) -> u64 {
        self.line
    }

    /// A cell as text.
    #[must_use]
    pub fn text(&self, column: usize) -> String {
        String::from_utf8_lossy(&self.cells[column]).into_owned()
    }

    /// Whether a cell is empty.
    #[must_use]
    pub fn is_empty(&self, column: usize) -> bool {
        self.cells[column].is_empty()
    }

    /// Whether a cell is empty or holds a word for "not measured".
    #[must_use]
    pub fn is_not_measured(&self, column: usize) -> bool {
        std::str::from_utf8(&self.cells[column]).is_ok_and(is_not_measured)
    }

    /// An error at a cell of this row.
    #[must_use]
    pub fn error(&self, column: usize, kind: ReadErrorKind) -> ReadError {
        ReadError { line: Some(self.line), column: Some(self.table.column(column)), kind }
    }

    /// An error of this row as a whole.
    #[must_use]
    pub fn row_error(&self, kind: ReadErrorKind) -> ReadError {
        kind.at_line(self.line)
    }

    /// An error at a cell whose number is not allowed.
    #[must_use]
    pub fn out_of_range(&self, column: usize, expected: Expected) -> ReadError {
        self.error(column, ReadErrorKind::OutOfRange { found: quote(&self.text(column)), expected })
    }

    /// A cell as a finite number.
    ///
    /// # Errors
    /// The cell is empty, no number, or not finite; `expected` is in the message.
    pub fn number(&self, column: usize, expected: Expected) -> Result<f64, ReadError> {
        let cell = &self.cells[column];
        if cell.is_empty() {
            return Err(self.error(column, ReadErrorKind::EmptyCell { expected }));
        }
        self.check_decimal_mark(column)?;
        let number =
            self.parse(cell).ok_or_else(|| self.error(column, ReadErrorKind::NotANumber { found: quote(&self.text(column)), expected }))?;
        if number.is_finite() { Ok(number) } else { Err(self.out_of_range(column, expected)) }
    }

    /// Refuses the second decimal mark of a column: 87,3 and 1.234 leave open what the latter is.
    fn check_decimal_mark(&self, column: usize) -> Result<(), ReadError> {
        let cell = &self.cells[column];
        let mark_in = |cell: &[u8]| cell.iter().copied().find(|byte| matches!(byte, b',' | b'.'));
        let Some(mark) = mark_in(cell).filter(|_| self.table.delimiter != b',') else { return Ok(()) };
        let mut marks = self.table.decimal_marks.borrow_mut();
        if marks.len() <= column {
            marks.resize(self.cells.len(), None);
        }
        match &marks[column] {
            None => marks[column] = Some((self.line, self.text(column))),
            Some((line, other)) if mark_in(other.as_bytes()) != Some(mark) => {
                let kind = ReadErrorKind::TwoDecimalMarks { found: quote(&self.text(column)), other: quote(other), other_line: *line };
                return Err(self.error(column, kind));
            }
            Some(_) => {}
        }
        Ok(())
    }

    fn parse(&self, cell: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(cell).ok()?;
        if self.table.delimiter != b',' && text.contains(',') {
            // A decimal comma. With a point beside it the number is ambiguous.
            if text.contains('.') { None } else { text.replacen(',', ".", 1).parse().ok() }
        } else {
            text.parse().ok()
        }
    }

    /// A cell as a finite number, or none where it is empty.
    ///
    /// # Errors
    /// The cell is no number, or not finite; `expected` is in the message.
    pub fn optional(&self, column: usize, expected: Expected) -> Result<Option<f64>, ReadError> {
        if self.is_empty(column) { Ok(None) } else { self.number(column, expected).map(Some) }
    }
}
