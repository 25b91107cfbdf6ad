//! Numbers in the cells of a foreign table, and the units written behind them.

use super::dialect::{Decimal, Dialect};
use super::vocabulary::{Measure, measure};
use crate::measurement::is_not_measured;

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ReadCell<'a> {
    /// Nothing, or a word for "not measured".
    Missing,
    /// A finite number, and the unit behind it.
    Number(f64, Option<Measure>),
    /// Anything else.
    Text(&'a str),
}

impl<'a> ReadCell<'a> {
    /// What a cell holds where numbers are written so.
    pub(crate) fn new(cell: &'a str, dialect: Dialect) -> Self {
        if let Some(number) = number(cell, dialect) {
            return Self::Number(number, None);
        }
        if is_not_measured(cell) || is_other_word(cell) {
            return Self::Missing;
        }
        // `1/sr` is a unit.
        if measure(cell).is_some() {
            return Self::Text(cell);
        }
        // A number begins with a digit, a sign or a mark.
        if !cell.starts_with(|first: char| first.is_ascii_digit() || "+-−.,".contains(first)) {
            return Self::Text(cell);
        }
        let is_part = |letter: char| letter.is_ascii_digit() || "+-−.,".contains(letter) || Some(letter) == dialect.thousands;
        let mut end = cell.find(|letter| !is_part(letter)).unwrap_or(cell.len());
        // An exponent goes on.
        if let Some(exponent) = cell[end..].strip_prefix(['e', 'E']) {
            let digits = exponent.trim_start_matches(['+', '-', '−']);
            let length = digits.len() - digits.trim_start_matches(|digit: char| digit.is_ascii_digit()).len();
            if length > 0 {
                end += 1 + exponent.len() - digits.len() + length;
            }
        }
        match (number(&cell[..end], dialect), measure(&cell[end..])) {
            (Some(number), Some(unit)) => Self::Number(number, Some(unit)),
            _ => Self::Text(cell),
        }
    }

    pub(crate) fn is_number(self) -> bool {
        matches!(self, Self::Number(..))
    }
}

/// Further words for "not measured": errors of spreadsheets in English and German, and abbreviations.
const OTHER_WORDS: [&str; 20] = [
    "#nv", "#wert!", "#value!", "#bezug!", "#ref!", "#num!", "#zahl!", "#name?", "#null!", "n.d.", "nd", "n.m.", "k.a.", "k. a.", "n. a.",
    "missing", "fehlt", "---", "未测", "无",
];

fn is_other_word(cell: &str) -> bool {
    cell.len() <= 8 && OTHER_WORDS.contains(&cell.to_lowercase().as_str())
}

/// A finite number in that notation.
pub(crate) fn number(text: &str, dialect: Dialect) -> Option<f64> {
    let text = text.trim();
    let first = text.chars().next()?;
    // Words such as inf and nan are no numbers of a table.
    if !(first.is_ascii_digit() || "+-−.,".contains(first)) {
        return None;
    }
    let plain = first != '−' && dialect.decimal == Decimal::Point && dialect.thousands.is_none();
    let number: f64 = if plain && !text.contains(['−', ',']) {
        text.parse().ok()?
    } else {
        let mut text = text.replace('−', "-");
        if let Some(separator) = dialect.thousands {
            text = without_thousands(&text, separator)?;
        }
        match dialect.decimal {
            Decimal::Point if text.contains(',') => return None,
            Decimal::Comma if text.contains('.') => return None,
            Decimal::Point => text,
            Decimal::Comma => text.replacen(',', ".", 1),
        }
        .parse()
        .ok()?
    };
    number.is_finite().then_some(number)
}

/// A number without its thousands separators, where they stand between groups of three digits.
fn without_thousands(text: &str, separator: char) -> Option<String> {
    if !text.contains(separator) {
        return Some(text.to_owned());
    }
    let whole = text.split(['.', ',', 'e', 'E']).next().filter(|_| !matches!(separator, '.' | ',')).unwrap_or_else(|| {
        let end = text.find(|letter: char| letter != separator && matches!(letter, '.' | ',' | 'e' | 'E')).unwrap_or(text.len());
        &text[..end]
    });
    let mut groups = whole.trim_start_matches(['+', '-']).split(separator);
    let first_is_sound = groups.next().is_some_and(|first| (1..=3).contains(&first.len()));
    let is_group = |group: &str| group.len() == 3 && group.bytes().all(|digit| digit.is_ascii_digit());
    (first_is_sound && groups.all(is_group) && !text[whole.len()..].contains(separator)).then(|| text.replace(separator, ""))
}

/// Whether a cell is a number with the exponent of Fortran's double precision, 1.5D-03.
pub(crate) fn has_fortran_exponent(cell: &str) -> bool {
    let Some((mantissa, exponent)) = cell.split_once(['d', 'D']) else { return false };
    let is_decimal = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b','));
    is_decimal(mantissa.trim_start_matches(['+', '-'])) && exponent.trim_start_matches(['+', '-']).parse::<u32>().is_ok()
}

#[cfg(test)]
mod tests {
    use super::super::dialect::{Decimal, Dialect, Separator};
    use super::super::vocabulary::Measure;
    use super::{ReadCell, has_fortran_exponent};

    #[test]
    fn cells_are_numbers_in_one_notation() {
        let with = |decimal, thousands| Dialect { separator: Separator::Character(';'), decimal, thousands };
        let (point, comma) = (with(Decimal::Point, None), with(Decimal::Comma, None));
        for (cell, dialect, value, unit) in [
            ("30", point, 30.0, None),
            ("−3.5e-2", point, -0.035, None),
            ("3,69 %", comma, 3.69, Some(Measure::Percent)),
            ("30°", comma, 30.0, Some(Measure::Degrees)),
            ("1,5E-03", comma, 1.5e-3, None),
            ("1.5e-3 %", point, 1.5e-3, Some(Measure::Percent)),
            ("1,234.5", with(Decimal::Point, Some(',')), 1234.5, None),
            ("1.234.567,5", with(Decimal::Comma, Some('.')), 1_234_567.5, None),
            ("12 345", with(Decimal::Point, Some(' ')), 12345.0, None),
        ] {
            assert_eq!(ReadCell::new(cell, dialect), ReadCell::Number(value, unit), "{cell}");
        }
        for (cell, dialect) in [("1.234", comma), ("1,5", point), ("inf", point), ("1e999", point), ("30 apples", point), ("-x", point)] {
            assert_eq!(ReadCell::new(cell, dialect), ReadCell::Text(cell));
        }
        assert_eq!(ReadCell::new("12,34.5", with(Decimal::Point, Some(','))), ReadCell::Text("12,34.5"));
        for missing in ["", "-", "n.a.", "NaN", "#DIV/0!", "#NV", "k.A.", "未测"] {
            assert_eq!(ReadCell::new(missing, point), ReadCell::Missing);
        }
        assert!(
            has_fortran_exponent("1.5D-03") && has_fortran_exponent("-2d+1") && !has_fortran_exponent("3rd") && !has_fortran_exponent("D")
        );
    }
}
