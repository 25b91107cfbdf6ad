//! Writes measurements, and columns beside the ones a file already has.

use crate::measurement::table::{BYTE_ORDER_MARK, separator_of};
use crate::measurement::{Measurement, Quantity, Row};
use std::io::{self, Write};

/// A number with the 17 significant digits that give back the same f64.
#[must_use]
pub fn exact(number: f64) -> String {
    // Adding 0 turns -0 into 0.
    format!("{:.16e}", number + 0.0)
}

/// Name, whether it is there, whether with standard deviations, and where it stands in a row.
type Block = (&'static str, bool, bool, fn(&Row) -> Option<Quantity>);

/// Writes a measurement in the form that [`crate::measurement::read()`] reads back to the same values.
///
/// Angles and standard deviations are written as the shortest text that reads back the same, measured values with 17 digits.
pub fn write(measurement: &Measurement, mut out: impl Write) -> io::Result<()> {
    for (key, value) in &measurement.metadata {
        writeln!(out, "# {key}: {value}")?;
    }
    let has_sigma =
        |of: fn(&Row) -> Option<Quantity>| measurement.rows.iter().any(|row| of(row).is_some_and(|quantity| quantity.sigma.is_some()));
    let quantities: [Block; 2] = [
        ("dolp", measurement.has_dolp(), has_sigma(|row| row.dolp), |row| row.dolp),
        ("brdf", measurement.has_brdf(), has_sigma(|row| row.brdf), |row| row.brdf),
    ];
    let has_mask = measurement.rows.iter().any(|row| row.masked);
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
    for row in &measurement.rows {
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

/// Copies a table that [`crate::measurement::read()`] accepts, with further cells at the end of its header and of each row.
///
/// `cells` has as many rows as the table; what was there stays byte for byte, comments included.
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
