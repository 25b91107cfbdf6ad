//! Why a text file cannot be read, and where.

use crate::measurement::{ColumnChoice, Expected, Field, Hint};

/// A column in a message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnPlace {
    /// Number, from 1.
    pub number: usize,
    /// Name in the header; empty where the fault was found before the header was.
    pub name: String,
}

/// Why a table cannot be read, and where.
#[derive(Debug, thiserror::Error)]
#[error("{}{kind}", Place(*line, column.as_ref()))]
pub struct ReadError {
    /// Line from 1, where there is one.
    pub line: Option<u64>,
    /// Column, where there is one.
    pub column: Option<ColumnPlace>,
    /// What is wrong.
    pub kind: ReadErrorKind,
}

struct Place<'a>(Option<u64>, Option<&'a ColumnPlace>);

impl std::fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.0, self.1) {
            (Some(line), Some(column)) if column.name.is_empty() => write!(f, "line {line}, column {}: ", column.number),
            (Some(line), Some(column)) => write!(f, "line {line}, column {} ({}): ", column.number, column.name),
            (Some(line), None) => write!(f, "line {line}: "),
            _ => Ok(()),
        }
    }
}

/// What is wrong with a table.
#[derive(Debug, thiserror::Error)]
pub enum ReadErrorKind {
    /// Not a byte, or nothing but comments.
    #[error("the file is empty; expected a header and rows")]
    Empty,
    /// A header and no row.
    #[error("there is a header but no row under it")]
    HeaderOnly,
    /// The first row holds numbers.
    #[error("there is no header: found {found:?}, expected column names such as theta_i, theta_r, dolp")]
    NoHeader {
        /// First cell.
        found: String,
    },
    /// A column that has to be there.
    #[error("the column {name} is missing from the header{}", Similar(.similar.as_deref()))]
    MissingColumn {
        /// Its name.
        name: &'static str,
        /// A column that differs in capitals alone.
        similar: Option<String>,
    },
    /// Neither quantity.
    #[error("neither dolp nor brdf is in the header; at least one is needed; the columns are {names}", names = .names.join(", "))]
    NoQuantity {
        /// The names in the header.
        names: Vec<String>,
    },
    /// The same column twice, or two names for one quantity.
    #[error("the column stands for the same quantity as column {first}; only one is allowed")]
    RepeatedColumn {
        /// Number of the first one, from 1.
        first: usize,
    },
    /// A row of another length than the header.
    #[error("the row has {found} cells; expected {expected}, as in the header")]
    RowLength {
        /// Its number of cells.
        found: usize,
        /// That of the header.
        expected: usize,
        /// What separates the cells.
        separator: char,
    },
    /// A cell that has to be filled.
    #[error("the cell is empty; expected {expected}")]
    EmptyCell {
        /// What was expected.
        expected: Expected,
    },
    /// No row measures anything.
    #[error("no row has a value of DoLP or BRDF")]
    NoData,
    /// Text in place of a number.
    #[error("found {found:?}, expected {expected}")]
    NotANumber {
        /// The cell.
        found: String,
        /// What was expected.
        expected: Expected,
    },
    /// Both decimal marks in one column.
    #[error(
        "found {found:?} where line {other_line} has {other:?}: it is {} with a decimal mark and {} with a thousands separator",
        readings(.found).0, readings(.found).1
    )]
    TwoDecimalMarks {
        /// The cell.
        found: String,
        /// An earlier cell of the column, with the other mark.
        other: String,
        /// Its line.
        other_line: u64,
    },
    /// A number outside its range, infinite, or not a number at all.
    #[error("found {found}, expected {expected}")]
    OutOfRange {
        /// The cell.
        found: String,
        /// What was expected.
        expected: Expected,
    },
    /// A negative θr where Δφ says another side.
    #[error("found {found} with dphi = {dphi}: a negative theta_r is the backscatter side, allowed only where dphi is absent or 180")]
    NegativeThetaR {
        /// The cell.
        found: String,
        /// Δφ of the row in degrees.
        dphi: f64,
    },
    /// Nothing but white space, where a header is not what is missing.
    #[error("the file is empty")]
    EmptyText,
    /// A line that is not of the kind its place asks for.
    #[error("found {found:?}, expected {expected}")]
    Unexpected {
        /// What stands there.
        found: String,
        /// What was expected.
        expected: Expected,
    },
    /// A row with too few or too many numbers.
    #[error("the row has {found} numbers; expected {expected}", expected = RowNumbers(*.without_sigmas, *.with_sigmas))]
    Numbers {
        /// How many.
        found: usize,
        /// How many there are without standard deviations.
        without_sigmas: usize,
        /// How many there are with standard deviations.
        with_sigmas: usize,
    },
    /// Ellipsometry without a row of ψ and Δ.
    #[error("there is no row of psi and delta")]
    NoPsi,
    /// No row looks like data.
    #[error("no row of numbers was found; expected at least two columns of numbers")]
    NoNumbers,
    /// A cell that is too long for any measurement.
    #[error("the cell has {bytes} bytes; no cell of a measurement is so long")]
    LongCell {
        /// Its length.
        bytes: usize,
    },
    /// A number with the exponent of Fortran.
    #[error("found {found:?}, a number with the exponent of Fortran's double precision; write it with e in place of D")]
    FortranExponent {
        /// The cell.
        found: String,
    },
    /// A column that a mapping names and the table lacks.
    #[error("there is no column {found} for {field}; the columns are {names}", names = .names.join(", "))]
    UnknownColumn {
        /// What it is for.
        field: Field,
        /// Its name or number.
        found: ColumnChoice,
        /// The names in the header.
        names: Vec<String>,
    },
    /// A NUL byte.
    #[error("found a NUL byte; expected plain text (UTF-8)")]
    Nul,
    /// UTF-16 by its byte order mark.
    #[error("the file is UTF-16; expected plain text (UTF-8)")]
    Utf16,
    /// A quote that its line does not close.
    #[error("a quote is not closed on its line")]
    UnclosedQuote,
    /// Stopped on request.
    #[error("reading was cancelled")]
    Cancelled,
    /// The source failed.
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

struct Similar<'a>(Option<&'a str>);

impl std::fmt::Display for Similar<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.map_or(Ok(()), |found| write!(f, "; found {found:?}, but names are lower case"))
    }
}

struct RowNumbers(usize, usize);

impl std::fmt::Display for RowNumbers {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self(without, with) = self;
        let sigmas = if with - without == 1 { "a standard deviation" } else { "standard deviations" };
        write!(f, "{without}, or {with} with {sigmas}")
    }
}

impl ReadErrorKind {
    /// An error at no particular place.
    pub(crate) fn anywhere(self) -> ReadError {
        ReadError { line: None, column: None, kind: self }
    }

    /// An error of a line as a whole.
    pub(crate) fn at_line(self, line: u64) -> ReadError {
        ReadError { line: Some(line), column: None, kind: self }
    }
}

/// Words for "not measured", in small letters.
const NOT_MEASURED: [&str; 13] = ["", "nan", "na", "n/a", "n.a.", "#n/a", "#div/0!", "-", "--", "–", "—", "null", "none"];

/// Whether a cell is empty or holds a word for "not measured".
#[must_use]
pub fn is_not_measured(cell: &str) -> bool {
    // Longer than any of the words: not worth the small letters.
    cell.len() <= 8 && NOT_MEASURED.contains(&cell.trim().to_lowercase().as_str())
}

/// Characters of a cell that a message quotes.
const QUOTED: usize = 80;

/// The beginning of a cell, for a message.
#[must_use]
pub fn quote(cell: &str) -> String {
    match cell.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("{}…", &cell[..end]),
        None => cell.to_owned(),
    }
}

/// How a number with one decimal mark or thousands separator reads as either.
pub(crate) fn readings(number: &str) -> (String, String) {
    (number.replace(',', "."), number.replace([',', '.'], ""))
}

impl ReadError {
    /// Whether a table fails as a table of another laboratory would.
    #[must_use]
    pub fn may_be_foreign(&self) -> bool {
        matches!(
            self.kind,
            ReadErrorKind::MissingColumn { .. }
                | ReadErrorKind::NoQuantity { .. }
                | ReadErrorKind::NoHeader { .. }
                | ReadErrorKind::Utf16
                | ReadErrorKind::UnclosedQuote
        )
    }

    /// What helps, where something does.
    #[must_use]
    pub fn hint(&self) -> Option<Hint> {
        match &self.kind {
            ReadErrorKind::MissingColumn { similar: None, .. } | ReadErrorKind::NoQuantity { .. } | ReadErrorKind::NoHeader { .. } => {
                Some(Hint::Import)
            }
            ReadErrorKind::RowLength { found, expected, separator: ',' } if found > expected => Some(Hint::SeparateBySemicolons),
            ReadErrorKind::NotANumber { found, expected } | ReadErrorKind::OutOfRange { found, expected } => cell_hint(found, *expected),
            ReadErrorKind::TwoDecimalMarks { found, .. } => first_mark(found).map(Hint::NameThousands),
            ReadErrorKind::Nul | ReadErrorKind::Utf16 => Some(Hint::SaveAsUtf8),
            _ => None,
        }
    }
}

/// Above this value a DoLP is percent rather than noise around 1.
const PERCENT_FROM: f64 = 2.0;

/// What helps where a cell is not what was expected.
fn cell_hint(found: &str, expected: Expected) -> Option<Hint> {
    let number = found.replace(',', ".").parse::<f64>().ok().filter(|number| number.is_finite());
    match (expected, number) {
        (Expected::Dolp, Some(PERCENT_FROM..=100.0)) => Some(Hint::NameDolpPercent),
        (Expected::Dolp, Some(number)) if number > 1.0 && number < PERCENT_FROM => Some(Hint::PercentOrLeaveOut),
        (Expected::Dolp | Expected::DolpPercent | Expected::Brdf, Some(_)) => Some(Hint::LeaveOut),
        _ if found.contains(',') && found.contains('.') => first_mark(found).map(Hint::NameThousands),
        _ => None,
    }
}

/// The first comma or point of a number: of two marks the one between thousands.
fn first_mark(number: &str) -> Option<char> {
    number.chars().find(|letter| matches!(letter, ',' | '.'))
}
