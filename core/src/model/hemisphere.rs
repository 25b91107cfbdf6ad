//! All directions of view over a surface, on a square grid: DoLP, angle of polarisation, BRDF and specular share.
//!
//! The hemisphere is drawn as a disc by the equidistant polar projection: the radius of a direction is θr/90°, its azimuth is kept. Seen from
//! above, the light comes from the left and the forward (specular) side, Δφ = 180°, is to the right: cell (row, column) of n × n has its centre at
//! `x = (2 column + 1)/n − 1`, `y = (2 row + 1)/n − 1`, `θr = 90° √(x² + y²)`, `Δφ = 180° + atan2(y, x)`. Cells outside the disc hold NaN.
//!
//! The angle of polarisation is `½ atan2(F20, F10)` in the reflected ray's meridian basis [E_s, E_p]: the angle by which the electric
//! vector is turned from s, which is horizontal, towards p. For unpolarised light in, the facets polarise along their own s, so that it is
//! η_r whatever the surface is made of. Where nothing is polarised there is no such angle: NaN.

use crate::model::Pbrdf;
use crate::model::batch::{Batch, Radiances};
use crate::model::map_parallel::map_parallel;
use crate::optics::{Facet, Geometry, GeometryError};
use std::f64::consts::PI;

/// Directions of view over one direction of incidence, prepared for many surfaces.
#[derive(Debug, Clone, PartialEq)]
pub struct Hemisphere {
    size: usize,
    rows: Vec<Row>,
}

/// One row of the grid: the cells inside the disc, side by side.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    /// Column of the first.
    first: usize,
    batch: Batch,
    /// η_r in degrees, −90 to 90.
    angles: Vec<f64>,
}

/// A surface over all directions of view: `size`² cells, row by row from y = −1 upwards, NaN outside the disc.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct HemisphereMap {
    /// Cells along an edge.
    pub size: usize,
    /// Degree of linear polarisation.
    pub dolp: Vec<f64>,
    /// Angle of polarisation, −90 to 90 degrees; NaN also where nothing is polarised.
    pub angle: Vec<f64>,
    /// BRDF in sr⁻¹.
    pub brdf: Vec<f64>,
    /// The specular part over the whole, 0 to 1; NaN also where it is dark.
    pub specular_share: Vec<f64>,
}

impl HemisphereMap {
    /// θr and Δφ in degrees, 0 ≤ Δφ ≤ 360, at the centre of a cell; none outside the disc.
    #[must_use]
    pub fn direction(&self, row: usize, column: usize) -> Option<(f64, f64)> {
        let (theta_r, dphi) = direction(row, column, self.size);
        (theta_r < 90.0).then_some((theta_r, dphi))
    }
}

impl Hemisphere {
    /// For an angle of incidence in degrees and a grid of `size`² cells; none if it is cancelled.
    ///
    /// # Errors
    ///
    /// [`GeometryError`] where the angle lies outside [0, 90) degrees.
    pub fn new(theta_i: f64, size: usize, cancelled: &(dyn Fn() -> bool + Sync)) -> Result<Option<Self>, GeometryError> {
        Geometry::new(theta_i, 0.0, 0.0)?;
        let row = |index: usize| if cancelled() { None } else { Some(Row::new(theta_i, size, index)) };
        let rows = map_parallel(size, &row);
        Ok(rows.into_iter().collect::<Option<Vec<_>>>().map(|rows| Self { size, rows }))
    }

    /// Cells along an edge.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// A surface in all directions; none if it is cancelled. The rows are shared among threads.
    #[must_use]
    pub fn map(&self, surface: &Pbrdf, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<HemisphereMap> {
        let radiances = |index: usize| {
            let mut radiances = Radiances::default();
            if cancelled() {
                return None;
            }
            self.rows[index].batch.radiances(surface, &mut radiances);
            Some(radiances)
        };
        let rows = map_parallel(self.size, &radiances).into_iter().collect::<Option<Vec<_>>>()?;
        let blank = vec![f64::NAN; self.size * self.size];
        let mut map =
            HemisphereMap { size: self.size, dolp: blank.clone(), angle: blank.clone(), brdf: blank.clone(), specular_share: blank };
        for (index, (row, radiances)) in self.rows.iter().zip(&rows).enumerate() {
            let start = index * self.size + row.first;
            let cells = start..start + row.batch.len();
            map.dolp[cells.clone()].copy_from_slice(&radiances.dolp);
            map.brdf[cells.clone()].copy_from_slice(&radiances.brdf);
            for (i, cell) in cells.enumerate() {
                map.specular_share[cell] = radiances.specular[i] / radiances.brdf[i];
                if radiances.dolp[i] > 0.0 {
                    map.angle[cell] = row.angles[i];
                }
            }
        }
        Some(map)
    }
}

impl Row {
    fn new(theta_i: f64, size: usize, index: usize) -> Self {
        let mut row = Self { first: 0, batch: Batch::default(), angles: Vec::new() };
        let mut facets = Vec::new();
        for column in 0..size {
            let (theta_r, dphi) = direction(index, column, size);
            let Ok(geometry) = Geometry::new(theta_i, theta_r, dphi) else { continue };
            if facets.is_empty() {
                row.first = column;
            }
            facets.push(Facet::new(geometry));
            let (cos, sin) = geometry.rotation_out().double_angle();
            row.angles.push(degrees(0.5 * libm::atan2(sin, cos)));
        }
        row.batch = Batch::from_facets(facets).single_threaded();
        row
    }
}

/// θr, from 90° on outside the disc, and Δφ at the centre of a cell.
fn direction(row: usize, column: usize, size: usize) -> (f64, f64) {
    let (x, y) = (center(column, size), center(row, size));
    (90.0 * (x * x + y * y).sqrt(), 180.0 + degrees(libm::atan2(y, x)))
}

/// Where a cell lies between −1 and 1.
#[expect(clippy::cast_precision_loss, reason = "a number of cells")]
fn center(index: usize, size: usize) -> f64 {
    (2.0 * index as f64 + 1.0) / size as f64 - 1.0
}

fn degrees(radians: f64) -> f64 {
    radians * (180.0 / PI)
}

#[cfg(test)]
mod tests {
    use super::{Hemisphere, degrees};
    use crate::model::{Model, Parameters, Pbrdf};
    use crate::optics::{Facet, Geometry, SlopeDistribution};

    fn surface() -> Pbrdf {
        Pbrdf::new(Model::full(SlopeDistribution::Cauchy), Parameters::default()).expect("the defaults")
    }

    #[test]
    fn every_cell_holds_its_own_direction() {
        let size = 21;
        let hemisphere = Hemisphere::new(50.0, size, &|| false).expect("an angle").expect("not cancelled");
        let map = hemisphere.map(&surface(), &|| false).expect("not cancelled");
        for row in 0..size {
            for column in 0..size {
                let at = |index: usize| (2.0 * f64::from(u8::try_from(index).expect("small")) + 1.0) / 21.0 - 1.0;
                let (x, y) = (at(column), at(row));
                let cell = row * size + column;
                let radius = libm::hypot(x, y);
                let direction = map.direction(row, column);
                if radius >= 1.0 {
                    assert_eq!(direction, None);
                    assert!(map.dolp[cell].is_nan() && map.angle[cell].is_nan() && map.brdf[cell].is_nan());
                    continue;
                }
                let geometry = Geometry::new(50.0, 90.0 * radius, 180.0 + degrees(libm::atan2(y, x))).expect("inside the disc");
                let (theta_r, dphi) = direction.expect("inside the disc");
                // Two ways to a radius.
                assert!((theta_r - geometry.theta_r().0).abs() < 1e-12 && dphi == geometry.dphi().0);
                let expected = surface().reflection(&Facet::new(geometry));
                // The kernel and the scalar form, and two ways to a radius.
                assert!((map.dolp[cell] / expected.dolp - 1.0).abs() < 1e-12, "{row} {column}");
                assert!((map.brdf[cell] / expected.brdf - 1.0).abs() < 1e-12, "{row} {column}");
                assert!((map.specular_share[cell] - expected.specular / expected.brdf).abs() < 1e-12, "{row} {column}");
                let mueller = surface().mueller(geometry);
                let angle = degrees(0.5 * libm::atan2(mueller.element(2, 0), mueller.element(1, 0)));
                // An angle of 90° is one of −90°.
                let apart = (map.angle[cell] - angle).rem_euclid(180.0);
                assert!(apart.min(180.0 - apart) < 1e-9, "{row} {column}: {} {angle}", map.angle[cell]);
            }
        }
    }

    #[test]
    fn the_brightest_cell_of_a_smooth_surface_is_on_the_forward_side() {
        let surface = Pbrdf::new(Model::full(SlopeDistribution::Gauss), Parameters { sigma: 0.05, ..Parameters::default() });
        let hemisphere = Hemisphere::new(45.0, 64, &|| false).expect("an angle").expect("not cancelled");
        let map = hemisphere.map(&surface.expect("in range"), &|| false).expect("not cancelled");
        let brightest = (0..map.brdf.len()).filter(|&i| map.brdf[i].is_finite()).max_by(|&a, &b| map.brdf[a].total_cmp(&map.brdf[b]));
        let (row, column) = brightest.map(|i| (i / 64, i % 64)).expect("a disc");
        assert!((31..=32).contains(&row) && (46..=49).contains(&column), "{row} {column}");
    }

    #[test]
    fn a_cancelled_map_is_none() {
        assert_eq!(Hemisphere::new(30.0, 8, &|| true), Ok(None));
        let hemisphere = Hemisphere::new(30.0, 8, &|| false).expect("an angle").expect("not cancelled");
        assert_eq!(hemisphere.map(&surface(), &|| true), None);
        assert!(Hemisphere::new(90.0, 8, &|| false).is_err());
    }
}
