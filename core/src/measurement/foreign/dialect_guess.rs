//! How the cells of a text are separated and its numbers written, by scored alternatives.

use super::dialect::{Decimal, Dialect, Separator};
use super::grid::{CellGrid, split};
use super::number::ReadCell;
use crate::measurement::ReadError;

/// The separators that are tried; the first of equal ones wins.
const SEPARATORS: [Separator; 7] = [
    Separator::Character('\t'),
    Separator::Character(';'),
    Separator::Character(','),
    Separator::Character('|'),
    Separator::Character('，'),
    Separator::Blanks { least: 2 },
    Separator::Blanks { least: 1 },
];

/// Lines that are looked at: so many from the beginning, and as many spread over the rest.
const SAMPLE: usize = 400;

/// The dialect in which most lines are rows of numbers of one length.
pub(crate) fn guess(text: &str, thousands: Option<char>) -> Dialect {
    if let Some(separator) = stated_separator(text) {
        let decimals = [Decimal::Point, Decimal::Comma].map(|decimal| Dialect { separator, decimal, thousands });
        return best(text, &decimals);
    }
    let mut all = Vec::new();
    for separator in SEPARATORS {
        // A comma can't be both.
        let decimals: &[Decimal] =
            if separator == Separator::Character(',') { &[Decimal::Point] } else { &[Decimal::Point, Decimal::Comma] };
        all.extend(decimals.iter().map(|&decimal| Dialect { separator, decimal, thousands }));
    }
    best(text, &all)
}

/// The separator that a first line `sep=;` states.
fn stated_separator(text: &str) -> Option<Separator> {
    let mut letters = text.lines().next()?.trim_matches('"').strip_prefix("sep=")?.chars();
    letters.next().map(Separator::Character)
}

fn best(text: &str, dialects: &[Dialect]) -> Dialect {
    let lines = sample(text);
    let mut best = (0.0, dialects[0]);
    for &dialect in dialects {
        let score = score(&lines, dialect);
        // A later one has to be clearly better.
        if score > 1.05 * best.0 {
            best = (score, dialect);
        }
    }
    // Columns parted by two blanks or more may hold names of several words.
    let wide = Dialect { separator: Separator::Blanks { least: 2 }, ..best.1 };
    if best.1.separator == (Separator::Blanks { least: 1 }) && dialects.contains(&wide) && is_even(&lines, wide) { wide } else { best.1 }
}

/// Whether all rows of numbers have three cells or more, and the same number of them.
fn is_even(lines: &[&str], dialect: Dialect) -> bool {
    let mut cells = Vec::new();
    let mut lengths = lines.iter().filter_map(|line| {
        cells.clear();
        split(line, dialect.separator, &mut cells);
        let numbers = cells.iter().filter(|cell| ReadCell::new(cell, dialect).is_number()).count();
        (numbers >= 2).then_some(cells.len())
    });
    lengths.next().is_some_and(|first| first >= 3 && lengths.all(|length| length == first))
}

/// The first lines, and lines spread over the rest.
fn sample(text: &str) -> Vec<&str> {
    let mut lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).take(SAMPLE).collect();
    if lines.len() == SAMPLE {
        let step = text.len() / SAMPLE;
        for start in (1..SAMPLE).map(|part| part * step) {
            let start = (start..text.len()).find(|&start| text.is_char_boundary(start)).unwrap_or(text.len());
            lines.extend(text[start..].lines().nth(1).filter(|line| !line.trim().is_empty()));
        }
    }
    lines
}

/// Numbers in rows of the most frequent length; a cell that is text in such a row counts against.
fn score(lines: &[&str], dialect: Dialect) -> f64 {
    let mut lengths: Vec<(usize, f64)> = Vec::new();
    let mut cells = Vec::new();
    for line in lines {
        if line.len() > 1 << 16 {
            continue;
        }
        cells.clear();
        split(line, dialect.separator, &mut cells);
        let numbers = cells.iter().filter(|cell| ReadCell::new(cell, dialect).is_number()).count();
        let texts = cells.iter().filter(|cell| matches!(ReadCell::new(cell, dialect), ReadCell::Text(_))).count();
        if numbers < 2 || texts > numbers {
            continue;
        }
        #[expect(clippy::cast_precision_loss, reason = "numbers of cells")]
        let worth = numbers as f64 - 0.5 * texts as f64;
        match lengths.iter_mut().find(|(length, _)| *length == cells.len()) {
            Some((_, sum)) => *sum += worth,
            None => lengths.push((cells.len(), worth)),
        }
    }
    // Rows of other lengths count a little: blocks may have several.
    let all: f64 = lengths.iter().map(|(_, worth)| worth).sum();
    lengths.iter().map(|(_, worth)| *worth).fold(0.0, f64::max) + 0.1 * all
}

/// Splits a text into cells.
///
/// # Errors
/// A cell is longer than any of a measurement.
pub(crate) fn cells_of(text: String, thousands: Option<char>) -> Result<CellGrid, ReadError> {
    let dialect = guess(&text, thousands);
    CellGrid::new(text, dialect)
}

#[cfg(test)]
mod tests {
    use super::guess;

    #[test]
    fn the_notation_with_most_numbers_wins() {
        for (text, expected) in [
            ("a;b;c\n30;20;0,0369\n30;25;0,0491\n", "semicolons, decimal comma"),
            ("a,b,c\n30,20,0.0369\n30,25,0.0491\n", "commas, decimal point"),
            ("a b c\n30 20 0,0369\n", "blanks, decimal comma"),
            ("a\tb\n30\t0.5\n", "tabs, decimal point"),
            ("view angle   DoLP x\n30.5   0.1\n", "two blanks or more, decimal point"),
            ("sep=;\na;b\n1,5;2,5\n", "semicolons, decimal comma"),
            ("| a | b |\n|---|---|\n| 1 | 2.5 |\n", "bars, decimal point"),
            ("a,b,\"x; y\"\n30,20,\"p; q\"\n", "commas, decimal point"),
            ("theta_i;theta_r;brdf\n30;20;87,3\n30;28;532,5\n30;30;1.234\n30;32;540,1\n", "semicolons, decimal comma"),
        ] {
            assert_eq!(guess(text, None).to_string(), expected, "{text}");
        }
    }
}
