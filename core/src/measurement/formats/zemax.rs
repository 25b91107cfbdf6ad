//! Zemax tabular BSDF, the BSDF Data Interchange file format.
//!
//! A head of keys, each with its value or its number of values and then these; `DataBegin`; for each
//! rotation of the sample and each angle of incidence a line `TIS` and a line for each azimuth with
//! a value for each radial angle; `DataEnd`. Scatter angles count from the specular ray: the radial
//! angle from that ray, the azimuth around it, 0 towards the surface normal. With the specular ray
//! in the x-z plane, the direction of scatter is
//!
//! x = sin θi cos r − cos θi sin r cos a, y = sin r sin a, z = cos θi cos r + sin θi sin r cos a.

use super::error::ImportError;
use super::format::{ForeignFile, Format};
use super::imported::Imported;
use super::question::{ImportOptions, Question};
use super::text_line::{TextLine, for_each_line};
use crate::measurement::note::ImportNote;
use crate::measurement::{Expected, Measurement, Progress, Quantity, ReadError, ReadErrorKind, Row};
use crate::optics::{Degrees, Geometry};

/// Bytes of a file that are looked at to recognise it.
const HEAD_BYTES: usize = 4096;
const SCATTER: Expected = Expected::Line("ScatterType BRDF");
const GRID: Expected = Expected::Line("AngleOfIncidence 3, then a line with the 3 angles");

/// Zemax tabular BSDF as a form of files.
pub(super) struct Zemax;

impl Format for Zemax {
    fn name(&self) -> &'static str {
        "Zemax tabular BSDF"
    }

    fn help(&self) -> &'static str {
        "\
Zemax tabular BSDF (.bsdf): BRDF on the angles of the file, turned from the specular ray; directions without a value are left out."
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["bsdf"]
    }

    fn sniff(&self, bytes: &[u8]) -> bool {
        let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD_BYTES)]);
        let has = |key: &str| head.lines().any(|line| line.trim_start().starts_with(key));
        has("ScatterType") && has("AngleOfIncidence")
    }

    fn open(&self, bytes: Vec<u8>, progress: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError> {
        let mut reader = Reader::default();
        let mut last = 1;
        for_each_line(&bytes, progress, |line| {
            last = line.number;
            if line.text.starts_with('#') { Ok(()) } else { reader.take(line) }
        })?;
        let complete = reader.theta_i.len() * reader.rotations.len();
        if reader.block == 0 || !reader.block.is_multiple_of(complete.max(1)) || reader.row > 0 {
            return Err(ReadErrorKind::Unexpected { found: String::new(), expected: Expected::Line("DataEnd after all blocks") }
                .at_line(last)
                .into());
        }
        Ok(Box::new(Scatter { measurements: reader.measurements, without_value: reader.without_value }))
    }
}

/// A file as far as it is read.
#[derive(Default)]
struct Reader {
    rotations: Vec<f64>,
    theta_i: Vec<f64>,
    azimuths: Vec<f64>,
    radials: Vec<f64>,
    /// Number of values that the next line holds, and of what.
    announced: Option<(Grid, usize)>,
    metadata: Vec<(String, String)>,
    is_data: bool,
    /// What stands above the data: `Monochrome`, or a colour.
    content: String,
    /// Blocks that are complete, one for each rotation and angle of incidence.
    block: usize,
    /// Rows of the present block.
    row: usize,
    measurements: Vec<Measurement>,
    without_value: usize,
}

#[derive(Clone, Copy)]
enum Grid {
    Rotation,
    Incidence,
    Azimuth,
    Radial,
}

impl Reader {
    fn take(&mut self, line: &TextLine<'_>) -> Result<(), ReadError> {
        if let Some((grid, count)) = self.announced.take() {
            return self.take_grid(line, grid, count);
        }
        if self.is_data {
            return self.take_data(line);
        }
        let value = line.cells.get(1).copied().unwrap_or_default();
        let grid = match line.cells[0] {
            "ScatterType" if value.eq_ignore_ascii_case("BRDF") => None,
            "ScatterType" => return Err(line.unexpected(SCATTER)),
            "SampleRotation" => Some(Grid::Rotation),
            "AngleOfIncidence" => Some(Grid::Incidence),
            "ScatterAzimuth" => Some(Grid::Azimuth),
            "ScatterRadial" => Some(Grid::Radial),
            "DataBegin" => {
                let is_complete = [&self.rotations, &self.theta_i, &self.azimuths, &self.radials].iter().all(|grid| !grid.is_empty());
                if !is_complete {
                    return Err(line.unexpected(GRID));
                }
                self.is_data = true;
                None
            }
            _ => {
                if line.cells.len() == 1 {
                    line.text.clone_into(&mut self.content);
                } else if !value.is_empty() {
                    self.metadata.push((line.cells[0].to_owned(), line.cells[1..].join(" ").replace(char::is_control, " ")));
                }
                None
            }
        };
        if let Some(grid) = grid {
            let count = value.parse().ok().filter(|count| (1..=100_000).contains(count)).ok_or_else(|| line.unexpected(GRID))?;
            self.announced = Some((grid, count));
        }
        Ok(())
    }

    fn take_grid(&mut self, line: &TextLine<'_>, grid: Grid, count: usize) -> Result<(), ReadError> {
        if line.cells.len() != count {
            return Err(line.error(ReadErrorKind::Numbers { found: line.cells.len(), without_sigmas: count, with_sigmas: count }));
        }
        let is_allowed: fn(f64) -> bool = match grid {
            Grid::Incidence => |angle| (0.0..90.0).contains(&angle),
            Grid::Radial => |angle| (0.0..=180.0).contains(&angle),
            Grid::Rotation | Grid::Azimuth => |_| true,
        };
        let angles = (0..count).map(|cell| line.number(cell, "angle", Expected::Angle, is_allowed)).collect::<Result<Vec<f64>, _>>()?;
        *match grid {
            Grid::Rotation => &mut self.rotations,
            Grid::Incidence => &mut self.theta_i,
            Grid::Azimuth => &mut self.azimuths,
            Grid::Radial => &mut self.radials,
        } = angles;
        Ok(())
    }

    fn take_data(&mut self, line: &TextLine<'_>) -> Result<(), ReadError> {
        match line.cells[0] {
            "DataEnd" => {
                self.is_data = false;
                return Ok(());
            }
            "TIS" => return Ok(()),
            _ => {}
        }
        if line.cells.len() != self.radials.len() {
            let count = self.radials.len();
            return Err(line.error(ReadErrorKind::Numbers { found: line.cells.len(), without_sigmas: count, with_sigmas: count }));
        }
        let theta_i = self.theta_i[self.block % self.theta_i.len()];
        let azimuth = self.azimuths[self.row];
        let name = self.name();
        if self.measurements.last().is_none_or(|measurement| measurement.name != name) {
            self.measurements.push(Measurement { name, metadata: self.metadata.clone(), ..Measurement::default() });
        }
        let place = self.measurements.len() - 1;
        for (cell, &radial) in self.radials.iter().enumerate() {
            let value = line.number(cell, "brdf", Expected::Brdf, |brdf| brdf >= 0.0)?;
            // No instrument sees a BRDF of 0: the direction was not measured, or is below the surface.
            match geometry(theta_i, radial, azimuth).filter(|_| value > 0.0) {
                Some(geometry) => {
                    self.measurements[place].rows.push(Row {
                        geometry,
                        dolp: None,
                        brdf: Some(Quantity { value, sigma: None }),
                        masked: false,
                    });
                    self.measurements[place].lines.push(line.number);
                }
                None => self.without_value += 1,
            }
        }
        self.row += 1;
        if self.row == self.azimuths.len() {
            (self.row, self.block) = (0, self.block + 1);
        }
        Ok(())
    }

    /// The name of the measurement of the present block, where there are several.
    fn name(&self) -> String {
        let rotation = self.block / self.theta_i.len() % self.rotations.len();
        let rotation = (self.rotations.len() > 1).then(|| format!("rotation {}°", self.rotations[rotation]));
        let content = Some(self.content.clone()).filter(|content| !content.is_empty() && !content.eq_ignore_ascii_case("monochrome"));
        [content, rotation].into_iter().flatten().collect::<Vec<_>>().join(" ")
    }
}

/// The direction at a radial angle and an azimuth from the specular ray; none below the surface.
fn geometry(theta_i: f64, radial: f64, azimuth: f64) -> Option<Geometry> {
    let ((sin_i, cos_i), (sin_r, cos_r), (sin_a, cos_a)) =
        (Degrees(theta_i).sin_cos(), Degrees(radial).sin_cos(), Degrees(azimuth).sin_cos());
    if sin_r == 0.0 || sin_a == 0.0 {
        // In the plane of incidence the angles add up, to the last bit.
        let signed = if cos_a > 0.0 { theta_i - radial } else { theta_i + radial };
        return Geometry::in_plane(theta_i, signed).ok();
    }
    let x = sin_i * cos_r - cos_i * sin_r * cos_a;
    let (y, z) = (sin_r * sin_a, cos_i * cos_r + sin_i * sin_r * cos_a);
    let theta_r = libm::atan2(libm::hypot(x, y), z).to_degrees();
    Geometry::new(theta_i, theta_r, 180.0 - libm::atan2(y, x).to_degrees()).ok()
}

/// The measurements of a file: one for each rotation of the sample and each colour.
struct Scatter {
    measurements: Vec<Measurement>,
    without_value: usize,
}

impl ForeignFile for Scatter {
    fn summary(&self) -> &'static str {
        "Zemax tabular BSDF: BRDF on the angles of the file, turned from the specular ray."
    }

    fn questions(&self) -> Vec<Question> {
        Vec::new()
    }

    fn notes(&self) -> Vec<ImportNote> {
        (self.without_value > 0).then_some(ImportNote::NoValue { count: self.without_value }).into_iter().collect()
    }

    fn import(&self, _: &ImportOptions, _: Progress<'_>) -> Result<Imported, ImportError> {
        if self.measurements.iter().all(|measurement| measurement.rows.is_empty()) {
            return Err(ImportError::NoValue { notes: self.notes() });
        }
        Ok(Imported { measurements: self.measurements.clone(), notes: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::geometry;

    #[test]
    fn scatter_angles_turn_from_the_specular_ray() {
        // The specular ray itself, 30° towards the normal and beyond it, and 10° away from it.
        for (theta_i, radial, azimuth, signed) in
            [(20.0, 0.0, 90.0, 20.0), (20.0, 30.0, 0.0, -10.0), (20.0, 10.0, 180.0, 30.0), (20.0, 20.0, 0.0, 0.0)]
        {
            let found = geometry(theta_i, radial, azimuth).expect("above the surface");
            assert_eq!(found.signed_theta_r().0, signed);
        }
        assert_eq!(geometry(20.0, 80.0, 180.0), None);
        // At normal incidence the azimuth turns around the normal.
        let found = geometry(0.0, 40.0, 60.0).expect("above the surface");
        assert!((found.theta_r().0 - 40.0).abs() < 1e-12 && (found.dphi().0 - 60.0).abs() < 1e-12, "{found:?}");
        // cos θr = cos θi cos r at a = 90°.
        let found = geometry(30.0, 30.0, 90.0).expect("above the surface");
        assert!((found.theta_r().0 - 0.75_f64.acos().to_degrees()).abs() < 1e-12);
    }
}
