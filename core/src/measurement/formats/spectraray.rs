//! SENTECH SpectraRay text: `; WAVELENGTH` and the angle of incidence of each column, then rows of
//! wavelength in nm, ψ and Δ in degrees for each angle.

use super::error::ImportError;
use super::format::{ForeignFile, Format};
use super::text_line::{TextLine, for_each_line};
use crate::measurement::{Ellipsometry, Expected, Progress, PsiDelta, ReadError, ReadErrorKind};

/// Bytes of a file that are looked at to recognise it.
const HEAD_BYTES: usize = 4096;

/// SENTECH SpectraRay text as a form of files.
pub(super) struct SpectraRay;

/// The words behind `; WAVELENGTH`.
fn angles_in(line: &str) -> Option<Vec<&str>> {
    let mut words = line.trim().strip_prefix(';')?.split_whitespace();
    words.next().filter(|word| word.eq_ignore_ascii_case("wavelength"))?;
    let angles: Vec<&str> = words.collect();
    (!angles.is_empty()).then_some(angles)
}

impl Format for SpectraRay {
    fn name(&self) -> &'static str {
        "SENTECH SpectraRay text"
    }

    fn help(&self) -> &'static str {
        "\
SENTECH SpectraRay text: psi and delta at the angles of its head; as Woollam text."
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["txt"]
    }

    fn sniff(&self, bytes: &[u8]) -> bool {
        String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD_BYTES)]).lines().take(20).any(|line| angles_in(line).is_some())
    }

    fn open(&self, bytes: Vec<u8>, progress: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError> {
        let mut found = Ellipsometry::default();
        let mut angles: Vec<f64> = Vec::new();
        let mut last = 1;
        for_each_line(&bytes, progress, |line| {
            last = line.number;
            if let Some(words) = angles_in(line.text) {
                angles = pairs(line, &words)?;
            } else if line.text.starts_with(';') {
                let note = line.text.trim_start_matches(';').trim().replace(char::is_control, " ");
                found.metadata.extend((!note.is_empty()).then_some(("note".to_owned(), note)));
            } else {
                found.rows.extend(rows(line, &angles)?);
            }
            Ok(())
        })?;
        if found.rows.is_empty() { Err(ReadErrorKind::NoPsi.at_line(last).into()) } else { Ok(Box::new(found)) }
    }
}

/// The angle of each pair of columns.
fn pairs(line: &TextLine<'_>, words: &[&str]) -> Result<Vec<f64>, ReadError> {
    let expected = Expected::Line("; WAVELENGTH 55.1 55.1 65.1 65.1");
    let angles: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).filter(|angle| (0.0..90.0).contains(angle)).collect();
    let is_paired = angles.len() == words.len() && angles.len().is_multiple_of(2) && angles.chunks(2).all(|pair| pair[0] == pair[1]);
    if is_paired { Ok(angles.into_iter().step_by(2).collect()) } else { Err(line.unexpected(expected)) }
}

/// The rows of one wavelength: ψ and Δ of each angle.
fn rows(line: &TextLine<'_>, angles: &[f64]) -> Result<Vec<PsiDelta>, ReadError> {
    let count = 1 + 2 * angles.len();
    if angles.is_empty() || line.cells.len() != count {
        return Err(line.error(ReadErrorKind::Numbers { found: line.cells.len(), without_sigmas: count, with_sigmas: count }));
    }
    let wavelength_nm = line.number(0, "wavelength", Expected::Wavelength, |nm| nm > 0.0)?;
    let row = |(index, &theta_i): (usize, &f64)| {
        let psi = line.number(1 + 2 * index, "psi", Expected::Psi, |psi| (0.0..=90.0).contains(&psi))?;
        let delta = line.number(2 + 2 * index, "delta", Expected::Delta, |_| true)?;
        Ok(PsiDelta { wavelength_nm, theta_i, psi, delta, sigma_psi: None, line: line.number })
    };
    angles.iter().enumerate().map(row).collect()
}
