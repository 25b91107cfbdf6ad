//! How a table of text is written: what separates its cells, and what its decimal sign is.

/// What stands between the cells of a workbook: ASCII's unit separator.
pub(crate) const UNIT_SEPARATOR: char = '\u{1f}';

/// What separates cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Separator {
    /// A character.
    Character(char),
    /// White space of that many characters or more, or a tab.
    Blanks {
        /// How many.
        least: usize,
    },
}

/// The decimal mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decimal {
    /// 0.5
    Point,
    /// 0,5
    Comma,
}

/// How cells are separated and numbers written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    /// What separates cells.
    pub separator: Separator,
    /// The decimal mark, one for the whole file.
    pub decimal: Decimal,
    /// What separates thousands, where the user says so.
    pub thousands: Option<char>,
}

/// As the guess is told: `semicolons, decimal comma`.
impl std::fmt::Display for Dialect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self.separator {
            Separator::Character(';') => "semicolons",
            Separator::Character('\t') => "tabs",
            Separator::Character(',') => "commas",
            Separator::Character('|') => "bars",
            Separator::Character(_) => "cells of a workbook",
            Separator::Blanks { least: 1 } => "blanks",
            Separator::Blanks { .. } => "two blanks or more",
        })?;
        f.write_str(if self.decimal == Decimal::Comma { ", decimal comma" } else { ", decimal point" })
    }
}
