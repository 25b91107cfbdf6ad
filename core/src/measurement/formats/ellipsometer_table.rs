//! Ψ and Δ under a header: Accurion EP4, and the short forms of others.
//!
//! The header names wavelength, angle of incidence, Psi and Delta in any order, with or without `#`;
//! a row of units may stand under it. Tabs or blanks part the cells; in a table of tabs a column
//! without a name between wavelength and Psi is the angle of incidence, as EP4 writes it.

use super::error::ImportError;
use super::format::{ForeignFile, Format};
use super::wavelength_unit::WavelengthUnit;
use crate::measurement::{ColumnPlace, Ellipsometry, Expected, Progress, PsiDelta, ReadError, ReadErrorKind, is_not_measured, quote};

/// Lines in which the header stands.
const HEAD_LINES: usize = 8;
/// Lines between two reports of progress.
const LINES_PER_REPORT: usize = 4096;

/// A table of ψ and Δ as a form of files.
pub(super) struct EllipsometerTable;

/// Which column is what.
#[derive(Debug, Clone, Copy)]
struct Header {
    row: usize,
    by_tabs: bool,
    wavelength: usize,
    theta_i: usize,
    psi: usize,
    delta: usize,
    unit: Option<WavelengthUnit>,
}

fn cells(line: &str, by_tabs: bool) -> Vec<&str> {
    let line = line.trim_start_matches('#');
    if by_tabs { line.split('\t').map(str::trim).collect() } else { line.split_whitespace().collect() }
}

impl Header {
    fn find(text: &str) -> Option<Self> {
        text.lines().take(HEAD_LINES).enumerate().find_map(|(row, line)| Self::of(row, line))
    }

    fn of(row: usize, line: &str) -> Option<Self> {
        let by_tabs = line.trim().contains('\t');
        let names: Vec<String> = cells(line, by_tabs).iter().map(|name| name.to_lowercase()).collect();
        let stem = |name: &str| name.split(['(', '[', '/']).next().unwrap_or_default().trim().to_owned();
        let find = |known: &[&str]| names.iter().position(|name| known.contains(&stem(name).as_str()));
        let wavelength = find(&["lambda", "wavelength", "wl", "nm", "λ", "wellenlänge", "angstroms", "ev"])?;
        let (psi, delta) = (find(&["psi", "ψ"])?, find(&["delta", "δ", "del"])?);
        let unnamed = || names.iter().position(String::is_empty).filter(|&column| by_tabs && column > wavelength && column < psi);
        let theta_i = find(&["aoi", "angle", "theta", "angle of incidence", "θ", "phi"]).or_else(unnamed)?;
        let unit = names[wavelength].split(['(', '[', ')', ']', '/', ' ']).find_map(WavelengthUnit::from_word);
        Some(Self { row, by_tabs, wavelength, theta_i, psi, delta, unit })
    }
}

fn text_of(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n")
}

impl Format for EllipsometerTable {
    fn name(&self) -> &'static str {
        "a table of psi and delta (Accurion EP4 and others)"
    }

    fn help(&self) -> &'static str {
        "\
Tables of psi and delta whose header names wavelength, angle, Psi and Delta (Accurion EP4, short WVASE): as Woollam text."
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["dat", "txt"]
    }

    fn sniff(&self, bytes: &[u8]) -> bool {
        !super::woollam::is_woollam(bytes) && Header::find(&text_of(&bytes[..bytes.len().min(4096)])).is_some()
    }

    fn open(&self, bytes: Vec<u8>, progress: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError> {
        let text = text_of(&bytes);
        let Some(mut header) = Header::find(&text) else { return Err(ReadErrorKind::NoPsi.anywhere().into()) };
        let mut found = Ellipsometry::default();
        let mut without_psi = 0;
        let lines = text.lines().count();
        for (row, line) in text.lines().enumerate() {
            if row % LINES_PER_REPORT == 0 {
                #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress bar")]
                let share = row as f64 / lines as f64;
                if progress(share).is_break() {
                    return Err(ReadErrorKind::Cancelled.anywhere().into());
                }
            }
            let names = cells(line, header.by_tabs);
            if row < header.row && !line.trim().is_empty() {
                found.metadata.push(("note".to_owned(), quote(line.trim()).replace(char::is_control, " ")));
            } else if row > header.row && names.iter().any(|cell| !cell.is_empty()) {
                let unit = names.get(header.wavelength).and_then(|word| WavelengthUnit::from_word(word));
                if found.rows.is_empty() && unit.is_some() {
                    header.unit = unit;
                } else if !line.starts_with('#') {
                    // A zone of the nulling ellipsometer that failed.
                    if names.get(header.psi).is_some_and(|psi| is_not_measured(psi)) {
                        without_psi += 1;
                    } else {
                        found.rows.push(header.row_of(row as u64 + 1, &names)?);
                    }
                }
            }
        }
        if without_psi > 0 {
            found.ignored.push(("psi without a value".to_owned(), without_psi));
        }
        if found.rows.is_empty() { Err(ReadErrorKind::NoPsi.at_line(lines as u64).into()) } else { Ok(Box::new(found)) }
    }
}

impl Header {
    fn row_of(&self, line: u64, cells: &[&str]) -> Result<PsiDelta, ReadError> {
        let number = |column: usize, name: &str, expected: Expected, is_allowed: fn(f64) -> bool| {
            let found = cells.get(column).copied().unwrap_or_default();
            let number: Option<f64> = found.replace(',', ".").parse().ok();
            number.filter(|&number| number.is_finite() && is_allowed(number)).ok_or_else(|| {
                let column = Some(ColumnPlace { number: column + 1, name: name.to_owned() });
                ReadError { line: Some(line), column, kind: ReadErrorKind::NotANumber { found: quote(found), expected } }
            })
        };
        let wavelength = number(self.wavelength, "wavelength", Expected::Wavelength, |stated| stated > 0.0)?;
        Ok(PsiDelta {
            wavelength_nm: self.unit.unwrap_or(WavelengthUnit::Nm(1.0)).nm(wavelength),
            theta_i: number(self.theta_i, "aoi", Expected::ThetaI, |aoi| (0.0..90.0).contains(&aoi))?,
            psi: number(self.psi, "psi", Expected::Psi, |psi| (0.0..=90.0).contains(&psi))?,
            delta: number(self.delta, "delta", Expected::Delta, |_| true)?,
            sigma_psi: None,
            line,
        })
    }
}
