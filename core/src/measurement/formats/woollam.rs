//! Woollam's ellipsometry text (WVASE, its short form, CompleteEASE).
//!
//! Head: sample, `VASEmethod[…]`, `Original[…]`, then the unit of the wavelength on a line of its
//! own; or, in the short form, the line `nm aoi Psi Delta` alone. Rows, split by tabs or blanks,
//! angles in degrees:
//!
//! - `wavelength aoi psi delta [sigma_psi sigma_delta]`, in CompleteEASE with `E` before them
//! - `dpolE wavelength aoi percent [sigma]`: depolarisation, kept but not applied
//! - other quantities (`uR`, `pT`, …): counted and named, but not used

use super::error::ImportError;
use super::format::{ForeignFile, Format};
use super::imported::Imported;
use super::question::{ImportOptions, Question};
use super::text_line::{TextLine, for_each_line};
use super::wavelength_unit::WavelengthUnit;
use crate::measurement::note::ImportNote;
use crate::measurement::{Depolarisation, Ellipsometry, Expected, Progress, PsiDelta, ReadError, ReadErrorKind, SpecularDolp, unwatched};
use std::io::Read;

/// More lines than any known head has.
const HEAD_LINES: u64 = 20;
/// Whether bytes look like Woollam's text: a line with a unit among the first lines.
#[must_use]
pub fn is_woollam(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(4096)];
    let text = String::from_utf8_lossy(start);
    let mut head = text.lines().take(5);
    head.any(|line| line.starts_with("VASEmethod[") || unit_of(line).is_some()) || is_bare(&text, bytes.len() <= start.len())
}

/// Rows at least of a table without a head that are taken for Woollam's.
const BARE_ROWS: usize = 3;

/// Whether a text is rows of wavelength in nm, angle of incidence, ψ and Δ, without a head: values
/// that are no angles, ascending at one angle, decide.
fn is_bare(text: &str, is_whole: bool) -> bool {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    let lines = &lines[..lines.len() - usize::from(!is_whole && !lines.is_empty())];
    let rows: Option<Vec<[f64; 4]>> = lines
        .iter()
        .map(|line| {
            let numbers: Option<Vec<f64>> = line.split_whitespace().map(|cell| cell.parse().ok()).collect();
            numbers.and_then(|numbers| numbers.try_into().ok())
        })
        .collect();
    let is_row = |[nm, aoi, psi, delta]: &[f64; 4]| {
        (150.0..5000.0).contains(nm) && (15.0..90.0).contains(aoi) && (0.0..=90.0).contains(psi) && (-180.0..=360.0).contains(delta)
    };
    rows.is_some_and(|rows| {
        let ascends = rows.windows(2).all(|pair| pair[0][1] != pair[1][1] || pair[0][0] < pair[1][0]);
        rows.len() >= BARE_ROWS && rows.iter().all(is_row) && ascends && text.contains('\t')
    })
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
        let mut found = Self::default();
        let mut unit = None;
        let mut last = 1;
        for_each_line(&bytes, progress, |line| {
            last = line.number;
            match unit {
                None => unit = found.add_head(line)?,
                Some(unit) => found.add_row(line, unit)?,
            }
            Ok(())
        })?;
        if unit.is_none() {
            let missing = ReadErrorKind::Unexpected { found: String::new(), expected: Expected::WavelengthUnit };
            let kind = if bytes.iter().all(u8::is_ascii_whitespace) { ReadErrorKind::EmptyText } else { missing };
            return Err(kind.anywhere());
        }
        if found.rows.is_empty() {
            return Err(ReadErrorKind::NoPsi.at_line(last));
        }
        Ok(found)
    }

    /// Takes in a line of the head; returns the unit, once it comes.
    fn add_head(&mut self, line: &TextLine<'_>) -> Result<Option<WavelengthUnit>, ReadError> {
        // A control character would break the line of metadata in a file of this project.
        let mut add = |key: &str, value: &str| self.metadata.push((key.to_owned(), value.replace(char::is_control, " ")));
        let bracketed = |name: &str| line.text.strip_prefix(name)?.strip_prefix('[').map(|rest| rest.trim_end_matches(']'));
        if let Some(unit) = unit_of(line.text) {
            return Ok(Some(unit));
        } else if let Some(method) = bracketed("VASEmethod") {
            add("method", method);
        } else if let Some(original) = bracketed("Original") {
            add("original", original);
        } else if line.number == 1 && line.cells.len() == 4 && line.cells.iter().all(|cell| cell.parse::<f64>().is_ok()) {
            // Without a head the wavelength is in nm.
            let unit = WavelengthUnit::Nm(1.0);
            add("note", "no head: columns taken as wavelength in nm, angle, psi, delta");
            self.add_row(line, unit)?;
            return Ok(Some(unit));
        } else if line.number == 1 {
            add("sample", line.text);
        } else if line.number > HEAD_LINES || line.cells.iter().take(3).all(|cell| cell.parse::<f64>().is_ok()) {
            return Err(line.unexpected(Expected::WavelengthUnit));
        } else {
            add("note", line.text);
        }
        Ok(None)
    }

    /// Takes in a line of numbers.
    fn add_row(&mut self, line: &TextLine<'_>, unit: WavelengthUnit) -> Result<(), ReadError> {
        let tag = line.cells[0];
        if tag.parse::<f64>().is_ok() {
            self.rows.push(psi_delta(line, 0, unit)?);
        } else if tag == "E" {
            self.rows.push(psi_delta(line, 1, unit)?);
        } else if tag.eq_ignore_ascii_case("dpolE") {
            self.depolarisation.push(depolarisation(line, unit)?);
        } else if is_quantity(tag) && line.cells.len() >= 4 {
            match self.ignored.iter_mut().find(|(name, _)| name == tag) {
                Some((_, count)) => *count += 1,
                None => self.ignored.push((tag.to_owned(), 1)),
            }
        } else {
            return Err(line.unexpected(Expected::WoollamRow));
        }
        Ok(())
    }
}

fn psi_delta(line: &TextLine<'_>, first: usize, unit: WavelengthUnit) -> Result<PsiDelta, ReadError> {
    let numbers = line.cells.len() - first;
    if numbers != 4 && numbers != 6 {
        return Err(line.error(ReadErrorKind::Numbers { found: numbers, without_sigmas: 4, with_sigmas: 6 }));
    }
    let wavelength_nm = wavelength(line, first, unit)?;
    let theta_i = line.number(first + 1, "aoi", Expected::ThetaI, |aoi| (0.0..90.0).contains(&aoi))?;
    let psi = line.number(first + 2, "psi", Expected::Psi, |psi| (0.0..=90.0).contains(&psi))?;
    let delta = line.number(first + 3, "delta", Expected::Delta, |_| true)?;
    let mut sigma_psi = None;
    if numbers == 6 {
        let sigma = line.number(first + 4, "sigma_psi", Expected::SigmaOrZero, |sigma| sigma >= 0.0)?;
        sigma_psi = Some(sigma).filter(|&sigma| sigma > 0.0);
        line.number(first + 5, "sigma_delta", Expected::SigmaOrZero, |sigma| sigma >= 0.0)?;
    }
    Ok(PsiDelta { wavelength_nm, theta_i, psi, delta, sigma_psi, line: line.number })
}

fn depolarisation(line: &TextLine<'_>, unit: WavelengthUnit) -> Result<Depolarisation, ReadError> {
    let numbers = line.cells.len() - 1;
    if numbers != 3 && numbers != 4 {
        return Err(line.error(ReadErrorKind::Numbers { found: numbers, without_sigmas: 3, with_sigmas: 4 }));
    }
    Ok(Depolarisation {
        wavelength_nm: wavelength(line, 1, unit)?,
        theta_i: line.number(2, "aoi", Expected::ThetaI, |aoi| (0.0..90.0).contains(&aoi))?,
        percent: line.number(3, "depolarisation", Expected::Depolarisation, |_| true)?,
    })
}

/// The wavelength of a row in nm.
fn wavelength(line: &TextLine<'_>, cell: usize, unit: WavelengthUnit) -> Result<f64, ReadError> {
    let stated = line.number(cell, "wavelength", Expected::Wavelength, |stated| stated > 0.0)?;
    let nm = unit.nm(stated);
    if nm.is_normal() { Ok(nm) } else { Err(line.cell_error(cell, "wavelength", Expected::Wavelength)) }
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
        "Ellipsometry: ψ at each angle becomes the specular DoLP |cos 2ψ| at θr = θi."
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
        Ok(Imported::one(measurement, nearest.into_iter().chain(left_out).collect()))
    }
}
