//! This project's own table, read and written.
//!
//! | column | meaning |
//! |---|---|
//! | `theta_i` | degrees, 0 ≤ θi < 90 |
//! | `theta_r` | degrees, −90 < θr < 90; a negative θr is the backscatter side (θr := abs θr, Δφ := 0), allowed only where `dphi` is absent or 180 |
//! | `dphi` | degrees, any finite value; 180 where there is no such column |
//! | `dolp`, `dolp_sigma` | 0…1 (or `dolp_percent`, 0…100); standard deviation > 0 |
//! | `brdf`, `brdf_sigma` | sr⁻¹, ≥ 0; standard deviation > 0 |
//! | `masked` | 0 or 1 |
//!
//! Nothing is guessed and no row is dropped: a fault is an error that names its place.

use crate::measurement::rows::RowReader;
use crate::measurement::table::{BYTE_ORDER_MARK, separator_of};
use crate::measurement::{Measurement, Progress, Quantity, ReadError, Row, Table, unwatched};
use std::io::{self, Read, Write};

/// Names of the columns.
const COLUMNS: [&str; 9] = ["theta_i", "theta_r", "dphi", "dolp", "dolp_percent", "dolp_sigma", "brdf", "brdf_sigma", "masked"];

/// Name, whether any row has it, whether any row has its standard deviation, and where it stands in
/// a row.
type Block = (&'static str, bool, bool, fn(&Row) -> Option<Quantity>);

impl Measurement {
    /// Reads a measurement in this project's own form.
    ///
    /// `theta_i`, `theta_r` and at least one of `dolp`, `dolp_percent` and `brdf` are needed;
    /// `dphi`, `dolp_sigma`, `brdf_sigma` and `masked` may be there. Angles are degrees, BRDF is
    /// sr⁻¹.
    ///
    /// ```
    /// use pbrdf::measurement::Measurement;
    /// let table = "# material: steel\ntheta_i,theta_r,dolp\n40,-20,0.05\n40,20,0.1\n";
    /// let measurement = Measurement::read(table.as_bytes())?;
    /// assert_eq!((measurement.rows.len(), measurement.metadata("material")), (2, Some("steel")));
    /// # Ok::<(), pbrdf::measurement::ReadError>(())
    /// ```
    ///
    /// # Errors
    /// The first fault of the file, with its line and column.
    pub fn read(source: impl Read) -> Result<Self, ReadError> {
        Self::read_with(source, &mut unwatched)
    }

    /// Like [`Measurement::read`], with reports to `progress`, which may stop the reading.
    ///
    /// # Errors
    /// The first fault of the file, with its line and column, or a stop.
    pub fn read_with(source: impl Read, progress: Progress<'_>) -> Result<Self, ReadError> {
        let table = Table::new(source)?;
        let rows = RowReader::native(&table)?;
        let ignored_columns = table.header().iter().filter(|name| !COLUMNS.contains(&name.as_str())).cloned().collect();
        rows.read(&table, ignored_columns, progress)
    }

    /// Writes the measurement in the form that [`Measurement::read`] reads back to the same values.
    ///
    /// Angles and standard deviations are written as the shortest text that reads back the same,
    /// measured values with 17 digits.
    ///
    /// # Errors
    /// An error of `out`.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        for (key, value) in &self.metadata {
            writeln!(out, "# {key}: {value}")?;
        }
        let has_sigma =
            |of: fn(&Row) -> Option<Quantity>| self.rows.iter().any(|row| of(row).is_some_and(|quantity| quantity.sigma.is_some()));
        let quantities: [Block; 2] = [
            ("dolp", self.has_dolp(), has_sigma(|row| row.dolp), |row| row.dolp),
            ("brdf", self.has_brdf(), has_sigma(|row| row.brdf), |row| row.brdf),
        ];
        let has_mask = self.rows.iter().any(|row| row.masked);
        let mut header = vec!["theta_i".to_owned(), "theta_r".to_owned(), "dphi".to_owned()];
        for (name, _, sigma, _) in quantities.iter().filter(|(_, present, _, _)| *present) {
            header.push((*name).to_owned());
            if *sigma {
                header.push(format!("{name}_sigma"));
            }
        }
        if has_mask {
            header.push("masked".to_owned());
        }
        writeln!(out, "{}", header.join(","))?;
        for row in &self.rows {
            let geometry = row.geometry;
            write!(out, "{},{},{}", geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0)?;
            for (_, _, sigma, of) in quantities.iter().filter(|(_, present, _, _)| *present) {
                let quantity = of(row);
                write!(out, ",{}", quantity.map_or_else(String::new, |quantity| exact(quantity.value)))?;
                if *sigma {
                    let sigma = quantity.and_then(|quantity| quantity.sigma);
                    write!(out, ",{}", sigma.map_or_else(String::new, |sigma| sigma.to_string()))?;
                }
            }
            if has_mask {
                write!(out, ",{}", u8::from(row.masked))?;
            }
            writeln!(out)?;
        }
        out.flush()
    }
}

/// A number with the 17 significant digits that give back the same f64.
#[must_use]
pub fn exact(number: f64) -> String {
    // Adding 0 turns -0 into 0.
    format!("{:.16e}", number + 0.0)
}

/// Copies a table that [`Measurement::read`] accepts, with further cells at the end of its header
/// and of each row.
///
/// `cells` has as many rows as the table. The bytes of the table stay, comments included.
///
/// # Errors
/// An error of `out`.
pub fn append_columns(input: &[u8], names: &[&str], cells: &[Vec<String>], mut out: impl Write) -> io::Result<()> {
    let (mark, text) = match input.strip_prefix(&BYTE_ORDER_MARK) {
        Some(rest) => (&input[..BYTE_ORDER_MARK.len()], rest),
        None => (&input[..0], input),
    };
    out.write_all(mark)?;
    let line_end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut delimiter = None;
    let mut rows = cells.iter();
    for line in text.split_inclusive(|&byte| byte == line_end) {
        let end = line.iter().rposition(|byte| !matches!(byte, b'\n' | b'\r')).map_or(0, |last| last + 1);
        let first = line.iter().find(|byte| !byte.is_ascii_whitespace());
        if matches!(first, None | Some(b'#')) {
            out.write_all(line)?;
            continue;
        }
        out.write_all(&line[..end])?;
        let (separator, further): (u8, Vec<&str>) = match delimiter {
            None => {
                let found = separator_of(line);
                delimiter = Some(found);
                (found, names.to_vec())
            }
            Some(found) => (found, rows.next().map(|row| row.iter().map(String::as_str).collect()).unwrap_or_default()),
        };
        for cell in further {
            out.write_all(&[separator])?;
            out.write_all(cell.as_bytes())?;
        }
        out.write_all(if end == line.len() { b"\n" } else { &line[end..] })?;
    }
    out.flush()
}
