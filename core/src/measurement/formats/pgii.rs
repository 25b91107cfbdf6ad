//! pab pgII: text of the gonio-photometers of pab advanced technologies.
//!
//! A head of `#` lines, then rows `theta phi value`, degrees. `#incident_angle θ φ`, or `#intheta
//! θ` and `#inphi φ`, is the direction of the light; with the light at φ = 180°, φ = 0 is the
//! forward side, so that Δφ = φ − φ of the light. `#format: theta phi BSDF` (or BRDF) states the
//! BRDF, `DSF` the BRDF times cos θ; a line about a multiplication by or division by cos θ says the
//! same. Rows beyond θ = 90° on the other side of the sample are transmission. A later
//! `#incident_angle` begins the next scan.

use super::error::ImportError;
use super::format::{ForeignFile, Format};
use super::imported::Imported;
use super::question::{ImportOptions, Question};
use super::text_line::{TextLine, for_each_line};
use crate::measurement::note::ImportNote;
use crate::measurement::{Expected, Measurement, Progress, Quantity, ReadError, ReadErrorKind, Row};
use crate::optics::{Degrees, Geometry};

/// Bytes of a file that are looked at to recognise it.
const HEAD_BYTES: usize = 1 << 14;
const INCIDENCE: Expected = Expected::Line("#incident_angle 40 180");
const QUANTITY: Expected = Expected::Line("#format: theta phi BSDF");
const ROW: Expected = Expected::Line("20.00 180.00 0.188");

/// pab pgII text as a form of files.
pub(super) struct PabPgii;

impl Format for PabPgii {
    fn name(&self) -> &'static str {
        "pab pgII text"
    }

    fn help(&self) -> &'static str {
        "\
pab pgII text: BRDF on the angles of the file. Rows of transmission are left out, and DSF is divided by cos theta."
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["txt"]
    }

    fn sniff(&self, bytes: &[u8]) -> bool {
        let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD_BYTES)]);
        let lines = head.lines().map(str::trim).filter(|line| !line.is_empty());
        let mut head_lines = lines.take_while(|line| line.starts_with('#'));
        head_lines.any(|line| key_and_value(line).is_some_and(|(key, _)| key == "incident_angle" || key == "intheta"))
    }

    fn open(&self, bytes: Vec<u8>, progress: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError> {
        let mut scan = Scan::default();
        let mut last = 1;
        for_each_line(&bytes, progress, |line| {
            last = line.number;
            if line.text.starts_with('#') { scan.add_head(line) } else { scan.add_row(line) }
        })?;
        if !scan.has_rows {
            return Err(ReadErrorKind::HeaderOnly.at_line(last).into());
        }
        Ok(Box::new(scan))
    }
}

/// Key and value of a line of the head: `#incident_angle 40 180`, `#format: theta phi DSF`.
fn key_and_value(line: &str) -> Option<(&str, &str)> {
    let text = line.strip_prefix('#')?;
    let (key, value) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let key = key.strip_suffix(':').unwrap_or(key);
    (!key.is_empty()).then_some((key, value.trim()))
}

/// What the values are.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scattering {
    Brdf,
    /// BRDF times the cosine of the angle of view.
    Dsf,
}

/// A file as far as it is read.
#[derive(Debug, Default)]
struct Scan {
    measurement: Measurement,
    /// Polar angle of the light, and its azimuth, in degrees.
    incidence: (Option<f64>, f64),
    scattering: Option<Scattering>,
    has_rows: bool,
    without_value: usize,
    transmission: usize,
    below_zero: usize,
}

impl Scan {
    fn add_head(&mut self, line: &TextLine<'_>) -> Result<(), ReadError> {
        let Some((key, value)) = key_and_value(line.text) else { return Ok(()) };
        match key {
            "incident_angle" => {
                self.incidence = (Some(incidence(line)?), line.number(2, "phi", Expected::Angle, |_| true)?);
            }
            "intheta" => self.incidence.0 = Some(incidence(line)?),
            "inphi" => self.incidence.1 = line.number(1, "phi", Expected::Angle, |_| true)?,
            _ => {
                self.scattering = scattering(key, value).or(self.scattering);
                let value = value.trim_matches('"').replace(char::is_control, " ");
                match (key, value.strip_suffix("nm").map(str::trim)) {
                    ("wavelength", Some(nm)) if nm.parse::<f64>().is_ok() => self.add_metadata("wavelength_nm", nm),
                    // The names of the columns.
                    ("theta" | "datapoints_in_file" | "format", _) => {}
                    _ => self.add_metadata(key, &value),
                }
            }
        }
        Ok(())
    }

    fn add_metadata(&mut self, key: &str, value: &str) {
        self.measurement.metadata.push((key.to_owned(), value.to_owned()));
    }

    fn add_row(&mut self, line: &TextLine<'_>) -> Result<(), ReadError> {
        self.has_rows = true;
        if line.cells.len() != 3 {
            return Err(line.unexpected(ROW));
        }
        let (Some(theta_i), phi_i) = self.incidence else { return Err(line.unexpected(INCIDENCE)) };
        let Some(scattering) = self.scattering else { return Err(line.unexpected(QUANTITY)) };
        let (theta, phi) = (polar_angle(line, 0)?, line.number(1, "phi", Expected::Angle, |_| true)?);
        if line.cells[2].eq_ignore_ascii_case("nan") {
            self.without_value += 1;
            return Ok(());
        }
        let value = line.number(2, "value", Expected::FiniteNumber, |_| true)?;
        // Light from behind is measured as from before: 180° − θ is the angle from that side's
        // normal.
        let from_normal = |theta: f64| if theta_i > 90.0 { 180.0 - theta } else { theta };
        let (theta_i, theta_r) = (from_normal(theta_i), from_normal(theta));
        if theta_r >= 90.0 {
            self.transmission += 1;
            return Ok(());
        }
        if value < 0.0 {
            self.below_zero += 1;
            return Ok(());
        }
        let dphi = (phi - phi_i).rem_euclid(360.0);
        let geometry = Geometry::new(theta_i, theta_r, dphi).map_err(|_| line.cell_error(0, "theta", Expected::ThetaI))?;
        let cos = if scattering == Scattering::Dsf { Degrees(theta_r).sin_cos().1 } else { 1.0 };
        let brdf = Quantity { value: value / cos, sigma: None };
        if !brdf.value.is_finite() {
            return Err(line.cell_error(2, "value", Expected::Brdf));
        }
        self.measurement.rows.push(Row { geometry, dolp: None, brdf: Some(brdf), masked: false });
        self.measurement.lines.push(line.number);
        Ok(())
    }
}

/// An angle from the normal of the sample, 0° to 180°.
fn polar_angle(line: &TextLine<'_>, cell: usize) -> Result<f64, ReadError> {
    line.number(cell, "theta", Expected::PolarAngle, |theta| (0.0..=180.0).contains(&theta))
}

/// The polar angle of the light in a line of the head; light at 90° grazes the sample.
fn incidence(line: &TextLine<'_>) -> Result<f64, ReadError> {
    let theta = polar_angle(line, 1)?;
    if theta == 90.0 { Err(line.cell_error(1, "theta", Expected::ThetaI)) } else { Ok(theta) }
}

/// What a line of the head says of the values.
fn scattering(key: &str, value: &str) -> Option<Scattering> {
    let text = value.to_lowercase();
    let says = |words: &[&str]| words.iter().any(|words| text.contains(words));
    if says(&["not multiplied by cos", "divided by cos"]) && !says(&["not divided by cos"]) {
        return Some(Scattering::Brdf);
    }
    if says(&["multiplied by cos", "not divided by cos"]) {
        return Some(Scattering::Dsf);
    }
    let is_column = key == "theta" && text.starts_with("phi");
    match text.split_whitespace().next_back()? {
        "dsf" if key == "format" || is_column => Some(Scattering::Dsf),
        "bsdf" | "brdf" if key == "format" || is_column => Some(Scattering::Brdf),
        _ => None,
    }
}

impl ForeignFile for Scan {
    fn summary(&self) -> &'static str {
        ""
    }

    fn questions(&self) -> Vec<Question> {
        Vec::new()
    }

    fn notes(&self) -> Vec<ImportNote> {
        let counts = [
            (self.without_value, ImportNote::NoValue { count: self.without_value }),
            (self.transmission, ImportNote::Transmission { count: self.transmission }),
            (self.below_zero, ImportNote::BrdfBelowZero { count: self.below_zero }),
        ];
        counts.into_iter().filter(|(count, _)| *count > 0).map(|(_, note)| note).collect()
    }

    fn import(&self, _: &ImportOptions, _: Progress<'_>) -> Result<Imported, ImportError> {
        if self.measurement.rows.is_empty() {
            return Err(ImportError::NoValue { notes: Vec::new() });
        }
        Ok(Imported::one(self.measurement.clone(), Vec::new()))
    }
}

#[cfg(test)]
mod tests {
    use super::PabPgii;
    use crate::measurement::formats::{Format, ImportNote, ImportOptions, Imported};
    use crate::measurement::unwatched;

    fn import(text: &str) -> Result<Imported, String> {
        assert!(PabPgii.sniff(text.as_bytes()), "{text}");
        let file = PabPgii.open(text.as_bytes().to_vec(), &mut unwatched).map_err(|error| error.to_string())?;
        assert!(file.questions().is_empty());
        let imported = file.import(&ImportOptions::default(), &mut unwatched).map_err(|error| error.to_string())?;
        Ok(Imported { notes: file.notes(), ..imported })
    }

    /// θi, θr, Δφ and BRDF of the rows.
    fn rows(text: &str) -> Vec<[f64; 4]> {
        let rows = import(text).expect(text).measurements.swap_remove(0).rows;
        let angles = |row: &crate::measurement::Row| (row.geometry.theta_i().0, row.geometry.theta_r().0, row.geometry.dphi().0);
        rows.iter().map(|row| (angles(row), row.brdf.expect("a BRDF").value)).map(|((i, r, dphi), brdf)| [i, r, dphi, brdf]).collect()
    }

    #[test]
    fn the_forward_side_lies_opposite_to_the_light() {
        let head = "#sample \"plate C\"\n#wavelength 650 nm\n#incident_angle 40 180\n#intensity BRDF [1/sr], not multiplied by cos(theta)\n#theta phi value\n";
        let text = format!("{head}40.00\t0.00\t6.4e-01\n40.00\t180.00\t1.3e-01\n20 90 0.2\n");
        assert_eq!(rows(&text), [[40.0, 40.0, 180.0, 0.64], [40.0, 40.0, 0.0, 0.13], [40.0, 20.0, 270.0, 0.2]]);
        let measurement = import(&text).expect("a good file").measurements.swap_remove(0);
        assert_eq!((measurement.metadata("sample"), measurement.metadata("wavelength_nm")), (Some("plate C"), Some("650")));
        assert_eq!(measurement.lines, [6, 7, 8]);
    }

    #[test]
    fn other_heads_say_the_same() {
        let brdf = [[40.0, 60.0, 180.0, 0.5]];
        for head in [
            "#format: theta phi BSDF\n#intheta 40\n#inphi 180\n",
            "#incident_angle 40 0\n#theta phi BRDF\n",
            "#incident_angle\t40.0\t180.0\n#values divided by cos(theta)\n",
        ] {
            let phi = if head.contains("40 0\n") { 180 } else { 0 };
            assert_eq!(rows(&format!("{head}60 {phi} 0.5\n")), brdf, "{head}");
        }
        for head in ["#format: theta phi DSF\n#incident_angle 40 180\n", "#incident_angle 40 180\n#values not divided by cos(theta)\n"] {
            let found = rows(&format!("{head}60 0 0.25\n"))[0];
            assert!((found[3] - 0.5).abs() < 1e-15, "{head}: {found:?}");
        }
    }

    #[test]
    fn scans_follow_each_other_and_light_may_come_from_behind() {
        let text = "#format: theta phi BSDF\n#incident_angle 40 180\n20 0 1\n#incident_angle 150 180\n160 0 2\n20 0 3\n";
        assert_eq!(rows(text), [[40.0, 20.0, 180.0, 1.0], [30.0, 20.0, 180.0, 2.0]]);
        assert_eq!(import(text).expect("a good file").notes, [ImportNote::Transmission { count: 1 }]);
    }

    #[test]
    fn nothing_is_left_out_in_silence() {
        let text = "#format: theta phi BSDF\n#incident_angle 40 180\n20 0 nan\n90 0 1\n120 0 1\n30 0 -1e-4\n30 0 0\n";
        let notes = [ImportNote::NoValue { count: 1 }, ImportNote::Transmission { count: 2 }, ImportNote::BrdfBelowZero { count: 1 }];
        assert_eq!(import(text).expect("a good file").notes, notes);
    }

    #[test]
    fn what_does_not_fit_is_refused_with_its_place() {
        let head = "#format: theta phi BSDF\n#incident_angle 40 180\n";
        for (text, place, reason) in [
            (head.to_owned(), "line 2: ", "no row"),
            ("#incident_angle 40 180\n20 0 1\n".to_owned(), "line 2: ", "expected a line such as #format: theta phi BSDF"),
            ("#intheta x\n20 0 1\n".to_owned(), "line 1, column 2 (theta)", "found \"x\""),
            ("#incident_angle 40\n20 0 1\n".to_owned(), "line 1, column 3 (phi)", "found \"\""),
            ("#incident_angle 190 0\n20 0 1\n".to_owned(), "line 1, column 2 (theta)", "0 ≤ θ ≤ 180"),
            (format!("{head}20 0\n"), "line 3: ", "a line such as 20.00 180.00"),
            (format!("{head}20 0 1 2 3\n"), "line 3: ", "a line such as 20.00 180.00"),
            (format!("{head}-20 0 1\n"), "line 3, column 1 (theta)", "0 ≤ θ ≤ 180"),
            (format!("{head}20 inf 1\n"), "line 3, column 2 (phi)", "an angle"),
            (format!("{head}20 0 inf\n"), "line 3, column 3 (value)", "a finite number"),
            ("#format: theta phi DSF\n#incident_angle 40 180\n89.999 0 1e308\n".to_owned(), "line 3, column 3 (value)", "a BRDF of 0"),
            (format!("{head}120 0 1\n"), "none of the geometries", "has a value"),
            ("#incident_angle 90 180\n20 0 1\n".to_owned(), "line 1, column 2 (theta)", "0 ≤ θi < 90"),
        ] {
            let error = import(&text).expect_err(&text);
            assert!(error.starts_with(place) && error.contains(reason), "{text:?}: {error}");
        }
    }
}
