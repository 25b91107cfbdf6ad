//! This project's own table, read and written.
//!
//! | column | meaning |
//! |---|---|
//! | `theta_i` | degrees, 0 ≤ θi < 90 |
//! | `theta_r` | degrees, −90 < θr < 90; a negative θr is the backscatter side (θr := abs θr, Δφ := 0), allowed only where `dphi` is absent or 180 |
//! | `dphi` | degrees, any finite value; 180 where there is no such column |
//! | `dolp`, `dolp_sigma` | 0…1 (or `dolp_percent`, 0…100); standard deviation > 0 |
//! | `brdf`, `brdf_sigma` | sr⁻¹, ≥ 0; standard deviation > 0 |
//! | `masked` | 0 or 1; in a masked row θr may be 90° or more, and an impossible value is none |
//! | `set` | text: which of several measurements the row belongs to |
//! | `wavelength_nm` | vacuum wavelength in nm |
//!
//! Nothing is guessed and no row is dropped: a fault is an error that names its place.

use crate::measurement::rows::RowReader;
use crate::measurement::table::{BYTE_ORDER_MARK, separator_of};
use crate::measurement::{Measurement, Progress, Quantity, ReadError, Row, Table, unwatched};
use crate::optics::shortest;
use std::io::{self, Read, Write};

/// Names of the columns.
const COLUMNS: [&str; 11] =
    ["theta_i", "theta_r", "dphi", "dolp", "dolp_percent", "dolp_sigma", "brdf", "brdf_sigma", "masked", "set", "wavelength_nm"];

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
        read_measurements(source, false, progress).map(|mut all| all.swap_remove(0))
    }

    /// The measurements of a file: one for each value of its columns `set` and `wavelength_nm`, in
    /// the order of the file, named by `set`; one without these columns. A wavelength stands in the
    /// metadata of its measurement.
    ///
    /// ```
    /// use pbrdf::measurement::{Measurement, unwatched};
    /// let table = "set,wavelength_nm,theta_i,theta_r,dolp\na,450,40,20,0.1\na,650,40,20,0.2\n";
    /// let all = Measurement::read_sets(table.as_bytes(), &mut unwatched)?;
    /// assert_eq!((all.len(), all[1].name.as_str(), all[1].wavelength_nm()), (2, "a", Some(650.0)));
    /// # Ok::<(), pbrdf::measurement::ReadError>(())
    /// ```
    ///
    /// # Errors
    /// The first fault of the file, with its line and column, or a stop by `progress`.
    pub fn read_sets(source: impl Read, progress: Progress<'_>) -> Result<Vec<Self>, ReadError> {
        read_measurements(source, true, progress)
    }

    /// Writes the measurement in the form that [`Measurement::read`] reads back to the same values.
    ///
    /// # Errors
    /// An error of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        write_measurements(std::slice::from_ref(self), out)
    }
}

fn read_measurements(source: impl Read, split: bool, progress: Progress<'_>) -> Result<Vec<Measurement>, ReadError> {
    let table = Table::new(source)?;
    let rows = RowReader::native(&table)?;
    let ignored: Vec<String> = table.header().iter().filter(|name| !COLUMNS.contains(&name.as_str())).cloned().collect();
    rows.read(&table, &ignored, split, progress)
}

/// Writes measurements as one table that [`Measurement::read_sets`] reads back to the same values,
/// with numbers in the shortest form that reads back the same.
///
/// A column `set` tells the measurements apart where there are several or one has a name, and a
/// column `wavelength_nm` where their wavelengths differ. Metadata that not all share are written
/// with the name of the measurement in brackets.
///
/// # Errors
/// An error of `out`.
pub fn write_measurements(measurements: &[Measurement], mut out: impl Write) -> io::Result<()> {
    let layout = Layout::of(measurements);
    for (index, measurement) in measurements.iter().enumerate() {
        for entry @ (key, value) in measurement.metadata.iter().filter(|(key, _)| !(layout.wavelength && key == "wavelength_nm")) {
            let is_shared = measurements.iter().all(|other| other.metadata.contains(entry));
            if !is_shared {
                writeln!(out, "# {key} [{}]: {value}", measurement.name)?;
            } else if index == 0 {
                writeln!(out, "# {key}: {value}")?;
            }
        }
    }
    writeln!(out, "{}", layout.header().join(","))?;
    for measurement in measurements {
        let mut labels = String::new();
        if layout.set {
            labels = format!("{},", quoted(&measurement.name));
        }
        if layout.wavelength {
            labels.push_str(&measurement.wavelength_nm().map_or_else(String::new, shortest));
            labels.push(',');
        }
        for &Row { geometry, dolp, brdf, masked } in &measurement.rows {
            let angles = [geometry.theta_i(), geometry.theta_r(), geometry.dphi()].map(|angle| angle.0);
            layout.write_row(&labels, angles, [dolp, brdf], masked, &mut out)?;
        }
        for row in &measurement.beyond_horizon {
            layout.write_row(&labels, [row.theta_i, row.theta_r, row.dphi], [row.dolp, row.brdf], true, &mut out)?;
        }
    }
    out.flush()
}

/// Which columns a table has.
struct Layout {
    set: bool,
    wavelength: bool,
    /// Whether there is a DoLP and a BRDF, and their standard deviations.
    quantities: [(bool, bool); 2],
    masked: bool,
}

impl Layout {
    fn of(measurements: &[Measurement]) -> Self {
        let rows = || measurements.iter().flat_map(|measurement| &measurement.rows).map(|row| [row.dolp, row.brdf]);
        let beyond = || measurements.iter().flat_map(|measurement| &measurement.beyond_horizon).map(|row| [row.dolp, row.brdf]);
        let has = |which: usize, is_it: fn(Quantity) -> bool| rows().chain(beyond()).any(|row| row[which].is_some_and(is_it));
        let wavelengths = || measurements.iter().map(Measurement::wavelength_nm);
        Self {
            set: measurements.len() > 1 || measurements.iter().any(|measurement| !measurement.name.is_empty()),
            wavelength: wavelengths().any(|nm| nm != measurements[0].wavelength_nm()),
            quantities: [0, 1].map(|which| (has(which, |_| true), has(which, |quantity| quantity.sigma.is_some()))),
            masked: beyond().next().is_some() || measurements.iter().any(|measurement| measurement.rows.iter().any(|row| row.masked)),
        }
    }

    fn header(&self) -> Vec<&'static str> {
        let [(dolp, dolp_sigma), (brdf, brdf_sigma)] = self.quantities;
        let columns = [
            ("set", self.set),
            ("wavelength_nm", self.wavelength),
            ("theta_i", true),
            ("theta_r", true),
            ("dphi", true),
            ("dolp", dolp),
            ("dolp_sigma", dolp_sigma),
            ("brdf", brdf),
            ("brdf_sigma", brdf_sigma),
            ("masked", self.masked),
        ];
        columns.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| *name).collect()
    }

    fn write_row(
        &self,
        labels: &str,
        angles: [f64; 3],
        quantities: [Option<Quantity>; 2],
        masked: bool,
        out: &mut impl Write,
    ) -> io::Result<()> {
        let [theta_i, theta_r, dphi] = angles.map(shortest);
        write!(out, "{labels}{theta_i},{theta_r},{dphi}")?;
        for (quantity, (is_there, has_sigma)) in quantities.into_iter().zip(self.quantities) {
            if is_there {
                write!(out, ",{}", quantity.map_or_else(String::new, |quantity| shortest(quantity.value)))?;
            }
            if has_sigma {
                let sigma = quantity.and_then(|quantity| quantity.sigma);
                write!(out, ",{}", sigma.map_or_else(String::new, shortest))?;
            }
        }
        if self.masked {
            write!(out, ",{}", u8::from(masked))?;
        }
        writeln!(out)
    }
}

/// A cell in quotes where it needs them, on one line.
fn quoted(cell: &str) -> String {
    let cell = cell.replace(['\n', '\r', '\0'], " ");
    if cell.contains([',', '"', ';', '\t', '#']) || cell.trim() != cell { format!("\"{}\"", cell.replace('"', "'")) } else { cell }
}

/// Copies a table that [`Measurement::read`] accepts, with further cells at the end of its header
/// and of each row.
///
/// `lines` are those of the measurement, `cells` has a row for each of them; on other lines the cells
/// are empty. The bytes of the table stay, comments included.
///
/// # Errors
/// An error of `out`.
pub fn append_columns(input: &[u8], names: &[&str], lines: &[u64], cells: &[Vec<String>], mut out: impl Write) -> io::Result<()> {
    let (mark, text) = match input.strip_prefix(&BYTE_ORDER_MARK) {
        Some(rest) => (&input[..BYTE_ORDER_MARK.len()], rest),
        None => (&input[..0], input),
    };
    out.write_all(mark)?;
    let line_end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut delimiter = None;
    let mut rows = lines.iter().zip(cells).peekable();
    for (number, line) in (1_u64..).zip(text.split_inclusive(|&byte| byte == line_end)) {
        let end = line.iter().rposition(|byte| !matches!(byte, b'\n' | b'\r')).map_or(0, |last| last + 1);
        let first = line.iter().find(|byte| !byte.is_ascii_whitespace());
        if matches!(first, None | Some(b'#')) {
            out.write_all(line)?;
            continue;
        }
        out.write_all(&line[..end])?;
        let is_header = delimiter.is_none();
        let separator = *delimiter.get_or_insert_with(|| separator_of(line));
        let row = rows.next_if(|(line, _)| !is_header && **line == number).map(|(_, cells)| cells);
        for (index, name) in names.iter().enumerate() {
            out.write_all(&[separator])?;
            let cell = if is_header { name } else { row.and_then(|cells| cells.get(index)).map_or("", String::as_str) };
            out.write_all(cell.as_bytes())?;
        }
        out.write_all(if end == line.len() { b"\n" } else { &line[end..] })?;
    }
    out.flush()
}
