//! What helps against an error of reading.

/// Advice that goes with an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hint {
    /// The file has another form: `import` turns it into a measurement.
    Import,
    /// Numbers up to 100 are no DoLP, but may be percent.
    NameDolpPercent,
    /// A cell of a value that was not measured is empty.
    LeaveEmpty,
    /// Save as plain text.
    SaveAsUtf8,
    /// Decimal point or decimal comma, and no thousands separators.
    OneDecimalMark,
    /// Decimal commas need another separator between the cells.
    SeparateBySemicolons,
}

impl std::fmt::Display for Hint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Import => "a file of another form becomes a measurement by the command import",
            Self::NameDolpPercent => "if the column holds percent, name it dolp_percent, or map it as dolp=COLUMN:percent",
            Self::LeaveEmpty => "leave the cell empty where nothing was measured",
            Self::SaveAsUtf8 => "save the file as CSV in UTF-8",
            Self::OneDecimalMark => "write numbers with one decimal mark and without thousands separators",
            Self::SeparateBySemicolons => "if commas are decimal marks, separate the cells by semicolons",
        })
    }
}
