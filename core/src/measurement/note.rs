//! What a reader has to say besides its measurements.

/// Lines of a file, counted; the first ones by their numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LineList {
    /// How many.
    pub count: usize,
    /// The first ones, from 1.
    pub first: Vec<u64>,
}

/// Lines that a notice names.
const NAMED_LINES: usize = 5;

impl LineList {
    /// Adds a line.
    pub(crate) fn push(&mut self, line: u64) {
        self.count += 1;
        if self.first.len() < NAMED_LINES {
            self.first.push(line);
        }
    }

    /// Their numbers, with an ellipsis where there are more.
    #[must_use]
    pub fn numbers(&self) -> String {
        let numbers: Vec<String> = self.first.iter().map(u64::to_string).collect();
        let more = if self.count > self.first.len() { ", …" } else { "" };
        format!("{}{more}", numbers.join(", "))
    }
}

/// `3 rows (lines 4, 7, 9)`.
impl std::fmt::Display for LineList {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (rows, lines) = if self.count == 1 { ("row", "line") } else { ("rows", "lines") };
        write!(f, "{} {rows} ({lines} {})", self.count, self.numbers())
    }
}

/// `1 row`, `3 rows`.
fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// A notice of a reader: nothing is left out or changed silently.
#[derive(Debug, Clone, PartialEq)]
pub enum ImportNote {
    /// Columns that the measurement does not use.
    IgnoredColumns {
        /// Their names in the order of the file; empty for a column without a name.
        names: Vec<String>,
    },
    /// Cells that hold a word for "not measured", nothing, or in a masked row an impossible value.
    NotMeasured(LineList),
    /// Rows at |θr| ≥ 90°, where the model ends: no row of the measurement, but written with it, masked.
    BeyondHorizon(LineList),
    /// Rows in which every cell is empty.
    BlankRows(LineList),
    /// Lines that are neither header nor data, such as means.
    SkippedLines(LineList),
    /// Standard deviations of 0, which are none.
    ZeroSigma(LineList),
    /// DoLP of the size of its error, from a polarimeter.
    BiasedDolp(LineList),
    /// DoLP without a unit, above 1.
    TakenAsPercent {
        /// The column.
        name: String,
    },
    /// Mueller elements that exceed the first one, and so are divided by it.
    NormalisedElements,
    /// Angles of view from 180° to 360°.
    WrappedAngles,
    /// θi is negative throughout.
    NegativeIncidence,
    /// θr is negative throughout.
    AllBackscatter,
    /// Merged cells of a spreadsheet.
    FilledDown,
    /// Rows of a quantity that the measurement does not use.
    IgnoredRows {
        /// The quantity.
        name: String,
        /// How many rows.
        count: usize,
    },
    /// Depolarisation goes to the metadata.
    DepolarisationNotApplied {
        /// How many rows.
        count: usize,
    },
    /// The wavelength asked for is not in the file.
    NearestWavelength {
        /// The wavelength asked for, in nm.
        wanted_nm: f64,
        /// The wavelengths taken, ascending, in nm.
        taken_nm: Vec<f64>,
    },
    /// An angle of incidence is left out.
    NoWavelengthNear {
        /// The angle in degrees.
        theta_i: f64,
    },
    /// Grids whose angles the file does not give.
    AssumedGrids {
        /// Their names.
        names: Vec<&'static str>,
    },
    /// Geometries without a value are left out.
    NoValue {
        /// How many.
        count: usize,
    },
    /// Rows behind the sample are left out.
    Transmission {
        /// How many.
        count: usize,
    },
    /// A BRDF below 0, which is noise, is left out.
    BrdfBelowZero {
        /// How many.
        count: usize,
    },
    /// A DoLP above 1 is left out.
    DolpAboveOne {
        /// How many.
        count: usize,
    },
}

impl ImportNote {
    /// The lines that the notice is about, where it names lines.
    #[must_use]
    pub fn lines(&self) -> Option<&LineList> {
        match self {
            Self::NotMeasured(lines)
            | Self::BeyondHorizon(lines)
            | Self::BlankRows(lines)
            | Self::SkippedLines(lines)
            | Self::ZeroSigma(lines)
            | Self::BiasedDolp(lines) => Some(lines),
            _ => None,
        }
    }

    /// The notice where the wavelengths taken are not the one asked for.
    pub(crate) fn nearest(wanted_nm: Option<f64>, taken_nm: &[f64]) -> Option<Self> {
        let wanted_nm = wanted_nm.filter(|wanted| taken_nm != [*wanted])?;
        Some(Self::NearestWavelength { wanted_nm, taken_nm: taken_nm.to_vec() })
    }
}

/// As it follows the name of the file: `has no 650 nm; the nearest was taken, 649.5 nm`.
impl std::fmt::Display for ImportNote {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::IgnoredColumns { names } => {
                let named = |name: &String| if name.is_empty() { "without a name".to_owned() } else { name.clone() };
                let noun = if names.len() == 1 { "column" } else { "columns" };
                write!(f, "ignored the {noun} {}", names.iter().map(named).collect::<Vec<_>>().join(", "))
            }
            Self::NotMeasured(lines) => {
                write!(f, "{lines} without a value; kept, and masked where nothing else was measured")
            }
            Self::BeyondHorizon(lines) => write!(f, "{lines} at |θr| ≥ 90°, where the model ends; left out, and written back as masked"),
            Self::BlankRows(lines) => write!(f, "{lines} without any cell filled; skipped"),
            Self::SkippedLines(lines) => {
                let noun = if lines.count == 1 { "line that is" } else { "lines that are" };
                write!(f, "skipped {} {noun} neither header nor data: {}", lines.count, lines.numbers())
            }
            Self::ZeroSigma(lines) => write!(f, "{lines} with a standard deviation of 0, which is taken as not stated"),
            Self::BiasedDolp(lines) => {
                write!(f, "{lines} where the DoLP is of the size of its error: there noise makes it too large; nothing is subtracted")
            }
            Self::TakenAsPercent { name } => {
                write!(f, "the values of {name} are above 1 and have no unit; they are taken as percent")
            }
            Self::NormalisedElements => f.write_str("Mueller elements exceed the first one; they are taken as divided by it"),
            Self::WrappedAngles => f.write_str("angles of view above 180° are taken as 360° less"),
            Self::NegativeIncidence => {
                f.write_str("θi is negative throughout; it is taken without its sign, and a positive θr as the forward side")
            }
            Self::AllBackscatter => {
                f.write_str("all θr are negative, which is the backscatter side; if it is the forward side, use --flip")
            }
            Self::FilledDown => f.write_str("empty cells of the first columns are filled with the value above"),
            Self::IgnoredRows { name, count } => write!(f, "ignored {} of {name}", counted(*count, "row")),
            Self::DepolarisationNotApplied { count } => {
                write!(f, "depolarisation (dpolE, {}) is named in the metadata, not applied to DoLP", counted(*count, "row"))
            }
            Self::NearestWavelength { wanted_nm, taken_nm } => {
                let taken = taken_nm.iter().map(f64::to_string).collect::<Vec<_>>().join(" and ");
                write!(f, "has no {wanted_nm} nm; the nearest was taken, {taken} nm")
            }
            Self::NoWavelengthNear { theta_i } => {
                write!(f, "left out θi = {theta_i}°, which has no wavelength near the one asked for")
            }
            Self::AssumedGrids { names } => {
                write!(f, "gives no angles for {}; they are taken to be even over their whole range", names.join(", "))
            }
            Self::NoValue { count } => write!(f, "left out {} without a value", counted(*count, "direction")),
            Self::Transmission { count } => write!(f, "left out {} of transmission", counted(*count, "row")),
            Self::BrdfBelowZero { count } => write!(f, "left out {} where the BRDF is below 0", counted(*count, "row")),
            Self::DolpAboveOne { count } => write!(f, "left out the DoLP of {} where it is above 1", counted(*count, "direction")),
        }
    }
}
