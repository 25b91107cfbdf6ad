//! What helps against an error of reading.

/// Advice that goes with an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hint {
    /// The file has another form: `import` turns it into a measurement.
    Import,
    /// Numbers up to 100 are no DoLP, but may be percent.
    NameDolpPercent,
    /// A number not far above 1 may be a small percentage, or noise.
    PercentOrLeaveOut,
    /// One decimal mark, or `--thousands` with that separator.
    NameThousands(char),
    /// A row that is to be left out is a comment.
    LeaveOut,
    /// Save as plain text.
    SaveAsUtf8,
    /// Decimal commas need another separator between the cells.
    SeparateBySemicolons,
}

impl std::fmt::Display for Hint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Self::NameThousands(separator) = self {
            return write!(f, "write one decimal mark, or name the thousands separator: import FILE --thousands {separator}");
        }
        f.write_str(match self {
            Self::Import => "a file of another form becomes a measurement by the command import",
            Self::NameDolpPercent => "if the column holds percent, name it dolp_percent, or map it as dolp=COLUMN:percent",
            Self::PercentOrLeaveOut => {
                "if the column holds percent, name it dolp_percent, or map it as dolp=COLUMN:percent; \
                 a row with # before it, or with 1 in a column masked, is left out"
            }
            Self::NameThousands(_) => "write one decimal mark, or name the thousands separator",
            Self::LeaveOut => "a row with # before it, or with 1 in a column masked, is left out",
            Self::SaveAsUtf8 => "save the file as CSV in UTF-8",
            Self::SeparateBySemicolons => "if commas are decimal marks, separate the cells by semicolons",
        })
    }
}
