//! Messages of `pbrdf::measurement`.

use crate::app::text::localized::Localized;
use crate::app::text::messages::model::quoted;
use pbrdf::measurement::foreign::Doubt;
use pbrdf::measurement::formats::{ImportError, ImportNote, TensorAxis, TensorCount, TensorError, TensorErrorKind, TensorShape};
use pbrdf::measurement::{ColumnChoice, ColumnPlace, Expected, Field, Hint, LineList, ReadError, ReadErrorKind, WavelengthError};
use tr::tr;

impl Localized for Expected {
    fn localized(&self) -> String {
        match self {
            Self::Parameter(domain) => domain.localized(),
            Self::Line(example) => tr!("a line such as {}", example),
            Self::PolarAngle => tr!("an angle from the surface normal, 0 ≤ θ ≤ 180 degrees"),
            Self::FiniteNumber => tr!("a finite number"),
            Self::Index => tr!("n or k above 0"),
            Self::Distribution => tr!("gauss or cauchy"),
            Self::Angle => tr!("an angle in degrees"),
            Self::ModelThetaI => tr!("0 ≤ θi < 90 degrees"),
            Self::ModelThetaR => tr!("0 ≤ θr < 90 degrees"),
            Self::ThetaI => tr!("an angle of incidence, 0 ≤ θi < 90 degrees"),
            Self::ThetaR => tr!("an angle of view, −90 < θr < 90 degrees"),
            Self::Dphi => tr!("a finite angle in degrees"),
            Self::Dolp => tr!("a DoLP from 0 to 1"),
            Self::DolpPercent => tr!("a DoLP from 0 to 100 percent"),
            Self::Brdf => tr!("a BRDF of 0 sr⁻¹ or more"),
            Self::Sigma => tr!("a standard deviation above 0"),
            Self::Mask => tr!("0 or 1"),
            Self::Wavelength => tr!("a wavelength above 0"),
            Self::Psi => tr!("an angle ψ from 0 to 90 degrees"),
            Self::Delta => tr!("an angle Δ in degrees"),
            Self::SigmaOrZero => tr!("a standard deviation of 0 or more"),
            Self::Depolarisation => tr!("a depolarisation in percent"),
            Self::WoollamRow => tr!("a row such as 650 55 43.2 160.0, or a quantity such as dpolE before its numbers"),
            Self::WavelengthUnit => tr!("a line with the unit of the wavelength, such as nm or Angstroms, before the rows"),
        }
    }
}

impl Localized for Hint {
    fn localized(&self) -> String {
        match self {
            Self::Import => tr!("a table of another form needs at least two columns of numbers"),
            Self::NameDolpPercent => tr!("if the column holds percent, name it dolp_percent"),
            Self::PercentOrLeaveOut => {
                tr!("if the column holds percent, name it dolp_percent; a row with # before it, or with 1 in a column masked, is left out")
            }
            Self::NameThousands(separator) => {
                tr!("write one decimal mark in all cells, or choose “{}” as what separates thousands", separator)
            }
            Self::LeaveOut => tr!("a row with # before it, or with 1 in a column masked, is left out"),
            Self::SaveAsUtf8 => tr!("save the file as CSV in UTF-8"),
            Self::SeparateBySemicolons => tr!("if commas are decimal marks, separate the cells by semicolons"),
        }
    }
}

impl Localized for ReadError {
    fn localized(&self) -> String {
        let kind = self.kind.localized();
        match (self.line, &self.column) {
            (Some(line), Some(ColumnPlace { number, name })) if name.is_empty() => {
                tr!("line {0}, column {1}: {2}", line, number, kind)
            }
            (Some(line), Some(ColumnPlace { number, name })) => tr!("line {0}, column {1} ({2}): {3}", line, number, name, kind),
            (Some(line), None) => tr!("line {0}: {1}", line, kind),
            _ => kind,
        }
    }
}

impl Localized for ReadErrorKind {
    fn localized(&self) -> String {
        match self {
            Self::Empty => tr!("the file is empty; expected a header and rows"),
            Self::HeaderOnly => tr!("there is a header but no row under it"),
            Self::NoHeader { found } => {
                tr!("there is no header: found {}, expected column names such as theta_i, theta_r, dolp", quoted(found))
            }
            Self::MissingColumn { name, similar: None } => tr!("the column {} is missing from the header", name),
            Self::MissingColumn { name, similar: Some(found) } => {
                tr!("the column {0} is missing from the header; found {1}, but names are lower case", name, quoted(found))
            }
            Self::NoQuantity { names } => {
                tr!("neither dolp nor brdf is in the header; at least one is needed; the columns are {}", names.join(", "))
            }
            Self::RepeatedColumn { first } => {
                tr!("the column stands for the same quantity as column {}; only one is allowed", first)
            }
            Self::RowLength { found, expected, .. } => tr!("the row has {0} cells; expected {1}, as in the header", found, expected),
            Self::EmptyCell { expected } => tr!("the cell is empty; expected {}", expected.localized()),
            Self::NoData => tr!("no row has a value of DoLP or BRDF"),
            Self::TwoDecimalMarks { found, other, other_line } => {
                tr!("found {0} where line {1} has {2}: two decimal marks in one column", quoted(found), other_line, quoted(other))
            }
            Self::NotANumber { found, expected } | Self::Unexpected { found, expected } => {
                tr!("found {0}, expected {1}", quoted(found), expected.localized())
            }
            Self::OutOfRange { found, expected } => tr!("found {0}, expected {1}", found, expected.localized()),
            Self::NegativeThetaR { found, dphi } => tr!(
                "found {0} with dphi = {1}: a negative theta_r is the backscatter side, allowed only where dphi is absent or 180",
                found,
                dphi
            ),
            Self::EmptyText => tr!("the file is empty"),
            Self::Numbers { found, without_sigmas, with_sigmas } => {
                let sigmas = tr!("a standard deviation" | "standard deviations" % with_sigmas.saturating_sub(*without_sigmas));
                tr!("the row has {0} numbers; expected {1}, or {2} with {3}", found, without_sigmas, with_sigmas, sigmas)
            }
            Self::NoPsi => tr!("there is no row of psi and delta"),
            Self::UnknownColumn { field, found, names } => {
                tr!("there is no column {0} for {1}; the columns are {2}", found.localized(), field, names.join(", "))
            }
            Self::NoNumbers => tr!("no row of numbers was found; expected at least two columns of numbers"),
            Self::LongCell { bytes } => tr!("the cell has {} bytes; no cell of a measurement is so long", bytes),
            Self::FortranExponent { found } => {
                tr!("found {}, a number with the exponent of Fortran's double precision; write it with e in place of D", quoted(found))
            }
            Self::Nul => tr!("found a NUL byte; expected plain text (UTF-8)"),
            Self::Utf16 => tr!("the file is UTF-16; expected plain text (UTF-8)"),
            Self::UnclosedQuote => tr!("a quote is not closed on its line"),
            Self::Cancelled => tr!("reading was cancelled"),
            Self::Io(error) => error.localized(),
        }
    }
}

impl Localized for ColumnChoice {
    fn localized(&self) -> String {
        match self {
            Self::Name(name) => quoted(name),
            Self::Number(number) => tr!("number {}", number),
        }
    }
}

impl Localized for WavelengthError {
    fn localized(&self) -> String {
        match self {
            Self::NotChosen { count, available_nm } => {
                tr!("the file has {0} wavelengths, {1}; one has to be chosen", count, wavelengths(available_nm))
            }
            Self::Outside { wanted_nm, available_nm } => {
                tr!("{0} nm is outside what the file has: {1}", wanted_nm, wavelengths(available_nm))
            }
        }
    }
}

/// Up to eight wavelengths one by one, more by their ends.
fn wavelengths(available_nm: &[f64]) -> String {
    match available_nm {
        [] => tr!("none"),
        [first, .., last] if available_nm.len() > 8 => tr!("{0} to {1} nm", first, last),
        few => format!("{} nm", few.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")),
    }
}

impl Localized for TensorError {
    fn localized(&self) -> String {
        let kind = self.kind.localized();
        match (self.byte, &self.field) {
            (Some(byte), Some(field)) => tr!("byte {0}, field {1}: {2}", byte, field, kind),
            (Some(byte), None) => tr!("byte {0}: {1}", byte, kind),
            (None, Some(field)) => tr!("field {0}: {1}", field, kind),
            (None, None) => kind,
        }
    }
}

impl Localized for TensorErrorKind {
    fn localized(&self) -> String {
        match self {
            Self::NoTensor => tr!("this is no tensor file; expected it to begin with tensor_file"),
            Self::Version(major, minor) => tr!("the version is {0}.{1}; expected 1.0", major, minor),
            Self::Truncated { expected, found } => {
                tr!("the file ends early: {0} bytes were announced here, {1} are there", expected, found)
            }
            Self::TooMany { what, found, most } => tr!("{0} is {1}; expected at most {2}", what.localized(), found, most),
            Self::Missing => tr!("the field is missing"),
            Self::Type { found, expected } => tr!("the type is {0}; expected {1}", found, expected),
            Self::Shape { found, expected } => tr!("the shape is {0}; expected {1}", lengths(found), expected.localized()),
            Self::Grid { index, found, expected } => {
                tr!("entry {0} is {1}; expected ascending {2}", index, found, expected.localized())
            }
            Self::Io(error) => error.localized(),
        }
    }
}

impl Localized for TensorCount {
    fn localized(&self) -> String {
        match self {
            Self::Fields => tr!("the number of fields"),
            Self::NameLength => tr!("the length of a name"),
            Self::Dimensions => tr!("the number of dimensions"),
            Self::Angles => tr!("the number of angles"),
        }
    }
}

impl Localized for TensorShape {
    fn localized(&self) -> String {
        match self {
            Self::Angles => tr!("1 × the number of angles"),
            Self::Wavelengths => tr!("the number of wavelengths"),
            Self::Matrices(shape) => lengths(shape),
        }
    }
}

/// Lengths with × between them.
fn lengths(lengths: &[u64]) -> String {
    lengths.iter().map(u64::to_string).collect::<Vec<_>>().join(" × ")
}

impl Localized for TensorAxis {
    fn localized(&self) -> String {
        match self {
            Self::Angles => tr!("angles in radians, within ±π"),
            Self::Wavelengths => tr!("wavelengths in nm"),
        }
    }
}

impl Localized for ImportError {
    fn localized(&self) -> String {
        match self {
            Self::Read(error) => error.localized(),
            Self::Tensor(error) => error.localized(),
            Self::Wavelength(error) => error.localized(),
            Self::Geometry(error) => error.localized(),
            Self::NoValue { .. } => tr!("none of the geometries has a value"),
            Self::NoThetaI => tr!("the file does not state the angle of incidence"),
            Self::OtherFormat(other) => tr!("this is {0}, which is not read as it is; {1}", other.name, other.advice),
            Self::Workbook { reason } => tr!("the workbook cannot be read: {}", reason),
            Self::NoSheet { wanted, names } if wanted.is_empty() => {
                tr!("the first sheet holds no rows of numbers; the sheets are {}", names.join(", "))
            }
            Self::NoSheet { wanted, names } => tr!("there is no sheet {0}; the sheets are {1}", quoted(wanted), names.join(", ")),
            Self::Undecided { doubts } => doubts.iter().map(Localized::localized).collect::<Vec<_>>().join("; "),
        }
    }
}

impl Localized for Doubt {
    fn localized(&self) -> String {
        match self {
            Self::NoHeader { columns } => tr!("no row names the {} columns: choose what they are", columns),
            Self::NoAngle { field: Field::ThetaI, .. } => {
                tr!("no angle of incidence was found: choose its column, or give one angle for all rows")
            }
            Self::NoAngle { .. } => tr!("no angle of view was found: choose its column"),
            Self::NoQuantity { .. } => tr!("no column for DoLP or BRDF was found: choose it"),
            Self::WideQuantity { .. } => tr!("nothing says whether the columns are DoLP or BRDF: choose it"),
            Self::Several { field, columns } => {
                let names: Vec<&str> = columns.iter().map(|(_, name)| name.as_str()).collect();
                tr!("several columns look like {0}: {1}; choose one", field, names.join(", "))
            }
            Self::BrdfMeaning { name } => {
                tr!("the column {} may be a BRDF, a BRDF times cos θr, or a reflectance factor: choose it", quoted(name))
            }
            Self::MuellerCount => tr!("the Mueller elements may be counted from 0 or from 1: choose their columns"),
            _ => self.to_string(),
        }
    }
}

/// An error with what helps against it.
pub fn advised(error: &impl Localized, hint: Option<Hint>) -> String {
    match hint {
        Some(hint) => tr!("{0} ({1})", error.localized(), hint.localized()),
        None => error.localized(),
    }
}

/// `3 rows (lines 4, 7, 9)`.
impl Localized for LineList {
    fn localized(&self) -> String {
        tr!("one row (line {0})" | "{n} rows (lines {0})" % self.count, self.numbers())
    }
}

/// A sentence, with a capital and a full stop.
impl Localized for ImportNote {
    fn localized(&self) -> String {
        match self {
            Self::IgnoredColumns { names } => {
                let named = |name: &String| if name.is_empty() { tr!("without a name") } else { name.clone() };
                let list = names.iter().map(named).collect::<Vec<_>>().join(", ");
                if names.len() == 1 { tr!("Ignored the column {}.", list) } else { tr!("Ignored the columns {}.", list) }
            }
            Self::NotMeasured(lines) => {
                tr!("{}: without a value; kept, and masked where nothing else was measured.", lines.localized())
            }
            Self::BeyondHorizon(lines) => {
                tr!("{}: at |θr| ≥ 90°, where the model ends; left out here, and saved as masked rows.", lines.localized())
            }
            Self::BlankRows(lines) => tr!("{}: without any cell filled; skipped.", lines.localized()),
            Self::SkippedLines(lines) => tr!("{}: neither header nor data; skipped.", lines.localized()),
            Self::ZeroSigma(lines) => tr!("{}: a standard deviation of 0, which is taken as not stated.", lines.localized()),
            Self::BiasedDolp(lines) => tr!(
                "{}: the DoLP is of the size of its error; there noise makes it too large, and nothing is subtracted.",
                lines.localized()
            ),
            Self::TakenAsPercent { name } => tr!("The values of {} are above 1 and have no unit; they are taken as percent.", name),
            Self::NormalisedElements => tr!("Mueller elements exceed the first one; they are taken as divided by it."),
            Self::WrappedAngles => tr!("Angles of view above 180° are taken as 360° less."),
            Self::NegativeIncidence => {
                tr!("θi is negative throughout; it is taken without its sign, and a positive θr as the forward side.")
            }
            Self::AllBackscatter => {
                tr!("All θr are negative, which is the backscatter side; turn the sign of θr if it is the forward side.")
            }
            Self::FilledDown => tr!("Empty cells of the first columns are filled with the value above."),
            Self::IgnoredRows { name, count } => tr!("Ignored one row of {0}." | "Ignored {n} rows of {0}." % *count, name),
            Self::DepolarisationNotApplied { .. } => tr!("Depolarisation (dpolE) is named in the metadata, not applied to DoLP."),
            Self::NearestWavelength { wanted_nm, taken_nm } => {
                let taken: Vec<String> = taken_nm.iter().map(f64::to_string).collect();
                tr!("There is no {0} nm at every angle; the nearest was taken, {1} nm.", wanted_nm, taken.join(", "))
            }
            Self::NoWavelengthNear { theta_i } => tr!("Left out θi = {}°, which has no wavelength near the one asked for.", theta_i),
            Self::AssumedGrids { names } => {
                tr!("The file gives no angles for {}; they are taken to be even over their whole range.", names.join(", "))
            }
            Self::NoValue { count } => tr!("Left out one direction without a value." | "Left out {n} directions without a value." % *count),
            Self::Transmission { count } => tr!("Left out one row of transmission." | "Left out {n} rows of transmission." % *count),
            Self::BrdfBelowZero { count } => {
                tr!("Left out one row where the BRDF is below 0." | "Left out {n} rows where the BRDF is below 0." % *count)
            }
            Self::DolpAboveOne { count } => tr!("Left out the DoLP of one direction where it is above 1."
                | "Left out the DoLP of {n} directions where it is above 1." % *count),
        }
    }
}
