//! Woollam's ellipsometry text (WVASE, its short form, CompleteEASE).
//!
//! Head: sample, `VASEmethod[…]`, `Original[…]`, then the unit of the wavelength on a line of its own; or,
//! in the short form, the line `nm aoi Psi Delta` alone. Rows, split by tabs or blanks, angles in degrees:
//!
//! - `wavelength aoi psi delta [sigma_psi sigma_delta]`, in CompleteEASE with `E` before them
//! - `dpolE wavelength aoi percent [sigma]`: depolarisation, kept but not applied
//! - other quantities (`uR`, `pT`, …): counted and named, but not used

use super::error::ImportError;
use super::format::{ForeignFile, Format, Imported};
use super::note::ImportNote;
use super::question::{ImportOptions, Question};
use crate::measurement::table::BYTE_ORDER_MARK;
use crate::measurement::{
    ColumnPlace, Depolarisation, Ellipsometry, Expected, Progress, PsiDelta, ReadError, ReadErrorKind, SpecularDolp, unwatched,
};
use std::io::Read;

/// Longer than any head that was seen.
const HEAD_LINES: u64 = 20;
/// Lines between two reports of progress.
const LINES_PER_REPORT: u64 = 4096;
/// nm times eV: h c/e in the SI since 2019.
const NM_EV: f64 = 1_239.841_984_332_002_6;

/// The unit of the wavelengths of a file.
#[derive(Debug, Clone, Copy)]
enum WavelengthUnit {
    Nm(f64),
    Ev,
    PerCm,
}

impl WavelengthUnit {
    fn from_word(word: &str) -> Option<Self> {
        match word.to_ascii_lowercase().as_str() {
            "nm" | "nanometers" => Some(Self::Nm(1.0)),
            "angstroms" | "angstrom" => Some(Self::Nm(0.1)),
            "um" | "microns" | "micrometers" => Some(Self::Nm(1000.0)),
            "ev" => Some(Self::Ev),
            "1/cm" | "cm-1" => Some(Self::PerCm),
            _ => None,
        }
    }

    fn nm(self, value: f64) -> f64 {
        match self {
            Self::Nm(factor) => value * factor,
            Self::Ev => NM_EV / value,
            Self::PerCm => 1e7 / value,
        }
    }
}

/// Whether bytes look like Woollam's text: a line with a unit among the first lines.
#[must_use]
pub fn is_woollam(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(4096)];
    let text = String::from_utf8_lossy(start);
    let mut head = text.lines().take(5);
    head.any(|line| line.starts_with("VASEmethod[") || unit_of(line).is_some())
}

/// The unit, if this is the unit line: the unit alone, or before the names of the short form.
fn unit_of(line: &str) -> Option<WavelengthUnit> {
    let mut words = line.split_whitespace();
    let unit = WavelengthUnit::from_word(words.next()?)?;
    let is_unit_line = words.next().is_none_or(|word| word.eq_ignore_ascii_case("aoi"));
    is_unit_line.then_some(unit)
}

impl Ellipsometry {
    /// Reads Woollam's text.
    ///
    /// # Errors
    /// The first fault of the file, with its line and column.
    pub fn read(source: impl Read) -> Result<Self, ReadError> {
        Self::read_with(source, &mut unwatched)
    }

    /// Like [`Ellipsometry::read`], with reports to `progress`, which may stop the reading.
    ///
    /// # Errors
    /// The first fault of the file, with its line and column, or a stop.
    pub fn read_with(mut source: impl Read, progress: Progress<'_>) -> Result<Self, ReadError> {
        let mut bytes = Vec::new();
        source.read_to_end(&mut bytes).map_err(|error| ReadErrorKind::Io(error).anywhere())?;
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            return Err(ReadErrorKind::Utf16.anywhere());
        }
        // A lone carriage return ended the lines of old Macs.
        let line_end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        let text = bytes.strip_prefix(&BYTE_ORDER_MARK).unwrap_or(&bytes);
        let mut found = Self::default();
        let mut unit = None;
        let mut done = 0;
        let mut last = 1;
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
            // The name of the sample may have any encoding.
            let line = String::from_utf8_lossy(line);
            let line = Line { number, cells: line.split_whitespace().collect(), text: line.trim() };
            if line.cells.is_empty() {
                continue;
            }
            last = number;
            match unit {
                None => unit = line.head(&mut found)?,
                Some(unit) => line.row(unit, &mut found)?,
            }
        }
        if unit.is_none() {
            let kind = if bytes.iter().all(u8::is_ascii_whitespace) { ReadErrorKind::EmptyText } else { missing_unit(String::new()) };
            return Err(kind.anywhere());
        }
        if found.rows.is_empty() {
            return Err(ReadErrorKind::NoPsi.at_line(last));
        }
        Ok(found)
    }
}

fn missing_unit(found: String) -> ReadErrorKind {
    ReadErrorKind::Unexpected { found, expected: Expected::WavelengthUnit }
}

/// A line that is not empty.
struct Line<'a> {
    number: u64,
    cells: Vec<&'a str>,
    text: &'a str,
}

impl Line<'_> {
    /// Takes in a line of the head; the unit, once it comes.
    fn head(&self, found: &mut Ellipsometry) -> Result<Option<WavelengthUnit>, ReadError> {
        // A control character would break the line of metadata in a file of this project.
        let mut add = |key: &str, value: &str| found.metadata.push((key.to_owned(), value.replace(char::is_control, " ")));
        let bracketed = |name: &str| self.text.strip_prefix(name)?.strip_prefix('[').map(|rest| rest.trim_end_matches(']'));
        if let Some(unit) = unit_of(self.text) {
            return Ok(Some(unit));
        } else if let Some(method) = bracketed("VASEmethod") {
            add("method", method);
        } else if let Some(original) = bracketed("Original") {
            add("original", original);
        } else if self.number == 1 {
            add("sample", self.text);
        } else if self.number > HEAD_LINES || self.cells.iter().take(3).all(|cell| cell.parse::<f64>().is_ok()) {
            return Err(self.error(missing_unit(self.text.chars().take(40).collect())));
        } else {
            add("note", self.text);
        }
        Ok(None)
    }

    fn row(&self, unit: WavelengthUnit, found: &mut Ellipsometry) -> Result<(), ReadError> {
        let tag = self.cells[0];
        if tag.parse::<f64>().is_ok() {
            found.rows.push(self.psi_delta(0, unit)?);
        } else if tag == "E" {
            found.rows.push(self.psi_delta(1, unit)?);
        } else if tag.eq_ignore_ascii_case("dpolE") {
            found.depolarisation.push(self.depolarisation(unit)?);
        } else if is_quantity(tag) && self.cells.len() >= 4 {
            match found.ignored.iter_mut().find(|(name, _)| name == tag) {
                Some((_, count)) => *count += 1,
                None => found.ignored.push((tag.to_owned(), 1)),
            }
        } else {
            let found = self.text.chars().take(40).collect();
            return Err(self.error(ReadErrorKind::Unexpected { found, expected: Expected::WoollamRow }));
        }
        Ok(())
    }

    fn psi_delta(&self, first: usize, unit: WavelengthUnit) -> Result<PsiDelta, ReadError> {
        let numbers = self.cells.len() - first;
        if numbers != 4 && numbers != 6 {
            return Err(self.error(ReadErrorKind::Numbers { found: numbers, without_sigmas: 4, with_sigmas: 6 }));
        }
        let wavelength_nm = self.wavelength(first, unit)?;
        let theta_i = self.number(first + 1, "aoi", Expected::ThetaI, |aoi| (0.0..90.0).contains(&aoi))?;
        let psi = self.number(first + 2, "psi", Expected::Psi, |psi| (0.0..=90.0).contains(&psi))?;
        let delta = self.number(first + 3, "delta", Expected::Delta, |_| true)?;
        let mut sigma_psi = None;
        if numbers == 6 {
            sigma_psi =
                Some(self.number(first + 4, "sigma_psi", Expected::SigmaOrZero, |sigma| sigma >= 0.0)?).filter(|&sigma| sigma > 0.0);
            self.number(first + 5, "sigma_delta", Expected::SigmaOrZero, |sigma| sigma >= 0.0)?;
        }
        Ok(PsiDelta { wavelength_nm, theta_i, psi, delta, sigma_psi, line: self.number })
    }

    fn depolarisation(&self, unit: WavelengthUnit) -> Result<Depolarisation, ReadError> {
        let numbers = self.cells.len() - 1;
        if numbers != 3 && numbers != 4 {
            return Err(self.error(ReadErrorKind::Numbers { found: numbers, without_sigmas: 3, with_sigmas: 4 }));
        }
        Ok(Depolarisation {
            wavelength_nm: self.wavelength(1, unit)?,
            theta_i: self.number(2, "aoi", Expected::ThetaI, |aoi| (0.0..90.0).contains(&aoi))?,
            percent: self.number(3, "depolarisation", Expected::Depolarisation, |_| true)?,
        })
    }

    fn wavelength(&self, cell: usize, unit: WavelengthUnit) -> Result<f64, ReadError> {
        let stated = self.number(cell, "wavelength", Expected::Wavelength, |stated| stated > 0.0)?;
        let nm = unit.nm(stated);
        if nm.is_normal() { Ok(nm) } else { Err(self.cell_error(cell, "wavelength", Expected::Wavelength)) }
    }

    /// A finite number that is allowed.
    fn number(&self, cell: usize, name: &str, expected: Expected, is_allowed: impl Fn(f64) -> bool) -> Result<f64, ReadError> {
        let number = self.cells[cell].parse().ok().filter(|&number: &f64| number.is_finite() && is_allowed(number));
        number.ok_or_else(|| self.cell_error(cell, name, expected))
    }

    fn cell_error(&self, cell: usize, name: &str, expected: Expected) -> ReadError {
        let kind = ReadErrorKind::NotANumber { found: self.cells[cell].to_owned(), expected };
        ReadError { line: Some(self.number), column: Some(ColumnPlace { number: cell + 1, name: name.to_owned() }), kind }
    }

    fn error(&self, kind: ReadErrorKind) -> ReadError {
        kind.at_line(self.number)
    }
}

/// A short name, such as uR, pT or mm12.
fn is_quantity(tag: &str) -> bool {
    tag.len() <= 8 && tag.starts_with(|c: char| c.is_ascii_alphabetic()) && tag.chars().all(|c| c.is_ascii_alphanumeric())
}

/// Woollam's ellipsometry text as a form of files.
pub(super) struct Woollam;

impl Format for Woollam {
    fn name(&self) -> &'static str {
        "Woollam ellipsometry text"
    }

    fn help(&self) -> &'static str {
        "\
Woollam text (WVASE, its short form, CompleteEASE): psi at several angles becomes specular DoLP = |cos 2 psi| at theta_r = theta_i,
with dolp_sigma where the file states sigma_psi. Depolarisation rows are named in the metadata and not applied."
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["dat"]
    }

    fn sniff(&self, bytes: &[u8]) -> bool {
        is_woollam(bytes)
    }

    fn open(&self, bytes: Vec<u8>, progress: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError> {
        Ok(Box::new(Ellipsometry::read_with(&bytes[..], progress)?))
    }
}

impl ForeignFile for Ellipsometry {
    fn summary(&self) -> &'static str {
        "Woollam ellipsometry: ψ at each angle becomes the specular DoLP |cos 2ψ| at θr = θi."
    }

    fn questions(&self) -> Vec<Question> {
        let available_nm = self.wavelengths_nm();
        if available_nm.len() == 1 { Vec::new() } else { vec![Question::Wavelength { available_nm }] }
    }

    fn notes(&self) -> Vec<ImportNote> {
        let ignored = self.ignored.iter().map(|(name, count)| ImportNote::IgnoredRows { name: name.clone(), count: *count });
        let count = self.depolarisation.len();
        ignored.chain((count > 0).then_some(ImportNote::DepolarisationNotApplied { count })).collect()
    }

    fn import(&self, options: &ImportOptions, _: Progress<'_>) -> Result<Imported, ImportError> {
        let SpecularDolp { measurement, wavelengths_nm, left_out } = self.specular_dolp(options.wavelength_nm)?;
        let nearest = ImportNote::nearest(options.wavelength_nm, &wavelengths_nm);
        let left_out = left_out.into_iter().map(|theta_i| ImportNote::NoWavelengthNear { theta_i });
        Ok(Imported { measurement, notes: nearest.into_iter().chain(left_out).collect() })
    }
}
