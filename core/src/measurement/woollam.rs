//! Woollam's ellipsometry text (WVASE, its short form, CompleteEASE): ψ and Δ at several angles and wavelengths.
//!
//! Head: sample, `VASEmethod[…]`, `Original[…]`, then the unit of the wavelength on a line of its own; or, in the short form, the
//! line `nm aoi Psi Delta` alone. Rows, split by tabs or blanks, angles in degrees:
//!
//! - `wavelength aoi psi delta [sigma_psi sigma_delta]`, in CompleteEASE with `E` before them
//! - `dpolE wavelength aoi percent [sigma]`: depolarisation, kept but not applied
//! - other quantities (`uR`, `pT`, …): counted and named, since nothing here uses them
//!
//! A smooth surface under unpolarised light has `DoLP = |Rs − Rp|/(Rs + Rp) = |cos 2ψ|` at θr = θi, `tan ψ = |rp/rs|`; its standard
//! deviation is `2 |sin 2ψ| σ_ψ`. ψ is that of the polarised part: a depolarisation d (in percent, `100 (1 − P²)`) would lower the
//! DoLP of what really leaves the sample to `√(1 − d/100) |cos 2ψ|`.

use crate::measurement::table::{BYTE_ORDER_MARK, Column, Progress, ReadError, ReadErrorKind};
use crate::measurement::wavelength::{WavelengthError, choose_wavelength};
use crate::measurement::{Measurement, Quantity, Row};
use crate::optics::{Degrees, Geometry};
use std::collections::HashMap;
use std::io::Read;

/// One row of ψ and Δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PsiDelta {
    /// Vacuum wavelength in nm.
    pub wavelength_nm: f64,
    /// Angle of incidence in degrees, 0 ≤ θi < 90.
    pub theta_i: f64,
    /// ψ in degrees, 0 to 90.
    pub psi: f64,
    /// Δ in degrees.
    pub delta: f64,
    /// Standard deviation of ψ in degrees, where stated and above 0.
    pub sigma_psi: Option<f64>,
    /// Line of the file.
    pub line: u64,
}

/// One row of depolarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depolarisation {
    /// Vacuum wavelength in nm.
    pub wavelength_nm: f64,
    /// Angle of incidence in degrees.
    pub theta_i: f64,
    /// In percent; noise makes it negative at times.
    pub percent: f64,
}

/// What such a file holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ellipsometry {
    /// Sample, method and original file, as far as stated.
    pub metadata: Vec<(String, String)>,
    /// ψ and Δ, in the order of the file.
    pub rows: Vec<PsiDelta>,
    /// Depolarisation, in the order of the file.
    pub depolarisation: Vec<Depolarisation>,
    /// Quantities that nothing here uses, and in how many rows.
    pub ignored: Vec<(String, usize)>,
}

/// Ellipsometry as a measurement of specular DoLP.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpecularDolp {
    /// A row per angle of incidence, at θr = θi.
    pub measurement: Measurement,
    /// The wavelengths that were taken, in nm: one, unless the angles were measured at different ones.
    pub wavelengths_nm: Vec<f64>,
    /// Angles of incidence in degrees without a wavelength near the one asked for.
    pub left_out: Vec<f64>,
}

const WAVELENGTH: &str = "a wavelength above 0";
const AOI: &str = "an angle of incidence, 0 ≤ θi < 90 degrees";
const PSI: &str = "an angle ψ from 0 to 90 degrees";
const DELTA: &str = "an angle Δ in degrees";
const SIGMA: &str = "a standard deviation of 0 or more";
const PERCENT: &str = "a depolarisation in percent";
const ROW: &str = "a row such as 650 55 43.2 160.0, or a quantity such as dpolE before its numbers";
const UNIT: &str = "a line with the unit of the wavelength, such as nm or Angstroms, before the rows";
/// Longer than any head that was seen.
const HEAD_LINES: u64 = 20;
/// Lines between two reports of progress.
const LINES_PER_REPORT: u64 = 4096;
/// nm times eV: h c/e in the SI since 2019.
const NM_EV: f64 = 1_239.841_984_332_002_6;

/// What the wavelength is stated in.
#[derive(Debug, Clone, Copy)]
enum Unit {
    Nm(f64),
    Ev,
    PerCm,
}

impl Unit {
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

/// Whether bytes look like such a file: a unit line, perhaps after a few lines of head.
#[must_use]
pub fn is_woollam(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(4096)];
    let text = String::from_utf8_lossy(start);
    let mut head = text.lines().take(5);
    head.any(|line| line.starts_with("VASEmethod[") || unit_of(line).is_some())
}

/// The unit, if this is the unit line: alone, or before the names of the short form.
fn unit_of(line: &str) -> Option<Unit> {
    let mut words = line.split_whitespace();
    let unit = Unit::from_word(words.next()?)?;
    let is_unit_line = words.next().is_none_or(|word| word.eq_ignore_ascii_case("aoi"));
    is_unit_line.then_some(unit)
}

/// Reads such a file; `progress` is told how far it is and may stop it.
pub fn read_woollam(mut source: impl Read, progress: Progress<'_>) -> Result<Ellipsometry, ReadError> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes).map_err(|error| ReadErrorKind::Io(error).anywhere())?;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(ReadErrorKind::Utf16.anywhere());
    }
    // Line ends of old: a lone carriage return.
    let line_end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let text = bytes.strip_prefix(&BYTE_ORDER_MARK).unwrap_or(&bytes);
    let mut found = Ellipsometry::default();
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
            return Err(ReadError { line: Some(number), column: None, kind: ReadErrorKind::Nul });
        }
        // Names of samples come in any encoding.
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
        return Err(ReadError { line: None, column: None, kind });
    }
    if found.rows.is_empty() {
        return Err(ReadError { line: Some(last), column: None, kind: ReadErrorKind::NoPsi });
    }
    Ok(found)
}

fn missing_unit(found: String) -> ReadErrorKind {
    ReadErrorKind::Unexpected { found, expected: UNIT }
}

/// A line that is not empty.
struct Line<'a> {
    number: u64,
    cells: Vec<&'a str>,
    text: &'a str,
}

impl Line<'_> {
    /// Takes in a line of the head; the unit, once it comes.
    fn head(&self, found: &mut Ellipsometry) -> Result<Option<Unit>, ReadError> {
        // A control character would break the line that it becomes in a measurement's file.
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

    fn row(&self, unit: Unit, found: &mut Ellipsometry) -> Result<(), ReadError> {
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
            return Err(self.error(ReadErrorKind::Unexpected { found, expected: ROW }));
        }
        Ok(())
    }

    fn psi_delta(&self, first: usize, unit: Unit) -> Result<PsiDelta, ReadError> {
        let numbers = self.cells.len() - first;
        if numbers != 4 && numbers != 6 {
            return Err(self.error(ReadErrorKind::Numbers { found: numbers, expected: "4, or 6 with standard deviations" }));
        }
        let wavelength_nm = self.wavelength(first, unit)?;
        let theta_i = self.number(first + 1, "aoi", AOI, |aoi| (0.0..90.0).contains(&aoi))?;
        let psi = self.number(first + 2, "psi", PSI, |psi| (0.0..=90.0).contains(&psi))?;
        let delta = self.number(first + 3, "delta", DELTA, |_| true)?;
        let mut sigma_psi = None;
        if numbers == 6 {
            sigma_psi = Some(self.number(first + 4, "sigma_psi", SIGMA, |sigma| sigma >= 0.0)?).filter(|&sigma| sigma > 0.0);
            self.number(first + 5, "sigma_delta", SIGMA, |sigma| sigma >= 0.0)?;
        }
        Ok(PsiDelta { wavelength_nm, theta_i, psi, delta, sigma_psi, line: self.number })
    }

    fn depolarisation(&self, unit: Unit) -> Result<Depolarisation, ReadError> {
        let numbers = self.cells.len() - 1;
        if numbers != 3 && numbers != 4 {
            return Err(self.error(ReadErrorKind::Numbers { found: numbers, expected: "3, or 4 with a standard deviation" }));
        }
        Ok(Depolarisation {
            wavelength_nm: self.wavelength(1, unit)?,
            theta_i: self.number(2, "aoi", AOI, |aoi| (0.0..90.0).contains(&aoi))?,
            percent: self.number(3, "depolarisation", PERCENT, |_| true)?,
        })
    }

    fn wavelength(&self, cell: usize, unit: Unit) -> Result<f64, ReadError> {
        let stated = self.number(cell, "wavelength", WAVELENGTH, |stated| stated > 0.0)?;
        let nm = unit.nm(stated);
        if nm.is_normal() { Ok(nm) } else { Err(self.cell_error(cell, "wavelength", WAVELENGTH)) }
    }

    /// A finite number that is allowed.
    fn number(&self, cell: usize, name: &str, expected: &'static str, is_allowed: impl Fn(f64) -> bool) -> Result<f64, ReadError> {
        let number = self.cells[cell].parse().ok().filter(|&number: &f64| number.is_finite() && is_allowed(number));
        number.ok_or_else(|| self.cell_error(cell, name, expected))
    }

    fn cell_error(&self, cell: usize, name: &str, expected: &'static str) -> ReadError {
        let kind = ReadErrorKind::NotANumber { found: self.cells[cell].to_owned(), expected };
        ReadError { line: Some(self.number), column: Some(Column { number: cell + 1, name: name.to_owned() }), kind }
    }

    fn error(&self, kind: ReadErrorKind) -> ReadError {
        ReadError { line: Some(self.number), column: None, kind }
    }
}

/// A short name, such as uR, pT or mm12.
fn is_quantity(tag: &str) -> bool {
    tag.len() <= 8 && tag.starts_with(|c: char| c.is_ascii_alphabetic()) && tag.chars().all(|c| c.is_ascii_alphanumeric())
}

impl Ellipsometry {
    /// The wavelengths of the ψ rows in nm, ascending, each once.
    #[must_use]
    pub fn wavelengths_nm(&self) -> Vec<f64> {
        let mut wavelengths: Vec<f64> = self.rows.iter().map(|row| row.wavelength_nm).collect();
        wavelengths.sort_by(f64::total_cmp);
        wavelengths.dedup();
        wavelengths
    }

    /// The specular DoLP at every angle of incidence, at the wavelength nearest to the one asked for. Without asking there has to be
    /// one wavelength only. Where no angle has a wavelength near enough, it is refused.
    pub fn specular_dolp(&self, wanted_nm: Option<f64>) -> Result<SpecularDolp, WavelengthError> {
        let wavelength_nm = choose_wavelength(&self.wavelengths_nm(), wanted_nm)?;
        let wanted_nm = wanted_nm.unwrap_or(wavelength_nm);
        let mut order: Vec<f64> = Vec::new();
        let mut by_angle: HashMap<u64, Vec<&PsiDelta>> = HashMap::new();
        for row in &self.rows {
            let own = by_angle.entry(row.theta_i.to_bits()).or_default();
            if own.is_empty() {
                order.push(row.theta_i);
            }
            own.push(row);
        }
        let mut found = SpecularDolp::default();
        for theta_i in order {
            let own = &by_angle[&theta_i.to_bits()];
            let available: Vec<f64> = own.iter().map(|row| row.wavelength_nm).collect();
            let Ok(wavelength_nm) = choose_wavelength(&available, Some(wanted_nm)) else {
                found.left_out.push(theta_i);
                continue;
            };
            found.wavelengths_nm.push(wavelength_nm);
            for row in own.iter().filter(|row| row.wavelength_nm == wavelength_nm) {
                found.measurement.rows.extend(row.specular());
                found.measurement.lines.push(row.line);
            }
        }
        if found.measurement.rows.is_empty() {
            // Between the wavelengths of all, but near those of no angle.
            return Err(WavelengthError::Outside { wanted_nm, available_nm: self.wavelengths_nm() });
        }
        found.wavelengths_nm.sort_by(f64::total_cmp);
        found.wavelengths_nm.dedup();
        found.measurement.metadata = self.metadata_at(&found.wavelengths_nm);
        Ok(found)
    }

    fn metadata_at(&self, taken_nm: &[f64]) -> Vec<(String, String)> {
        let mut metadata = self.metadata.clone();
        let wavelengths: Vec<String> = taken_nm.iter().map(f64::to_string).collect();
        metadata.push(("wavelength_nm".to_owned(), wavelengths.join(", ")));
        metadata.push(("quantity".to_owned(), "specular DoLP = |cos 2 psi| at theta_r = theta_i, from ellipsometry".to_owned()));
        let here = self.depolarisation.iter().filter(|row| taken_nm.contains(&row.wavelength_nm));
        let here: Vec<String> = here.map(|row| format!("{} % at {} degrees", row.percent, row.theta_i)).collect();
        if !here.is_empty() {
            metadata.push(("depolarisation".to_owned(), format!("{}; not applied", here.join(", "))));
        }
        metadata
    }
}

impl PsiDelta {
    /// The row of a measurement: |cos 2ψ| at θr = θi.
    fn specular(&self) -> Option<Row> {
        let (sin, cos) = Degrees(2.0 * self.psi).sin_cos();
        let sigma = self.sigma_psi.map(|sigma| 2.0 * sin.abs() * Degrees(sigma).radians()).filter(|&sigma| sigma > 0.0);
        // The angle was checked when it was read.
        let geometry = Geometry::in_plane(self.theta_i, self.theta_i).ok()?;
        Some(Row { geometry, dolp: Some(Quantity { value: cos.abs(), sigma }), brdf: None, masked: false })
    }
}
