//! Measured rows grouped for plots: one θi and one plane through the surface normal.

use crate::measurement::{Quantity, Row};
use crate::optics::Geometry;

/// One measured value in a plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DataPoint {
    /// θr in degrees, negative on the backscatter side.
    pub theta_r: f64,
    /// What was measured.
    pub quantity: Quantity,
    /// Whether statistics leave it out.
    pub masked: bool,
    /// Its row in the measurement.
    pub row: usize,
}

/// Rows of one θi in one plane through the surface normal, by ascending signed θr.
#[derive(Debug, Clone, PartialEq)]
pub struct IncidenceSeries {
    /// Degrees.
    pub theta_i: f64,
    /// Δφ of its forward side in degrees, 90 < Δφ ≤ 270; 180 is the plane of incidence.
    pub plane: f64,
    /// Measured DoLP.
    pub dolp: Vec<DataPoint>,
    /// Measured BRDF.
    pub brdf: Vec<DataPoint>,
    /// Its rows in the measurement.
    pub rows: Vec<usize>,
}

impl IncidenceSeries {
    /// All series of those rows, by ascending θi and plane.
    #[must_use]
    pub fn of(rows: &[Row]) -> Vec<Self> {
        let mut order: Vec<(f64, f64, f64, usize)> = rows
            .iter()
            .enumerate()
            .map(|(index, row)| {
                let (plane, theta_r) = plane_of(row.geometry);
                (row.geometry.theta_i().0, plane, theta_r, index)
            })
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.total_cmp(&b.2)));
        let mut groups: Vec<Self> = Vec::new();
        for (theta_i, plane, theta_r, index) in order {
            if groups.last().is_none_or(|last| last.theta_i != theta_i || last.plane != plane) {
                groups.push(Self { theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() });
            }
            if let Some(last) = groups.last_mut() {
                let row = &rows[index];
                let point = |quantity| DataPoint { theta_r, quantity, masked: row.masked, row: index };
                last.dolp.extend(row.dolp.map(point));
                last.brdf.extend(row.brdf.map(point));
                last.rows.push(index);
            }
        }
        groups
    }

    /// Geometry at a signed θr in this plane.
    #[must_use]
    pub fn geometry(&self, signed_theta_r: f64) -> Option<Geometry> {
        let dphi = if signed_theta_r < 0.0 { self.plane - 180.0 } else { self.plane };
        Geometry::new(self.theta_i, signed_theta_r.abs(), dphi).ok()
    }

    /// Name in a legend.
    #[must_use]
    pub fn name(&self) -> String {
        if self.plane == 180.0 { format!("θi = {}°", self.theta_i) } else { format!("θi = {}°, Δφ = {}°", self.theta_i, self.plane) }
    }

    /// Whether anything was measured on the backscatter side.
    #[must_use]
    pub fn has_backscatter(&self) -> bool {
        self.dolp.iter().chain(&self.brdf).any(|point| point.theta_r < 0.0)
    }
}

/// Plane and signed θr of a geometry, degrees.
pub(crate) fn plane_of(geometry: Geometry) -> (f64, f64) {
    let dphi = geometry.dphi().0.rem_euclid(360.0);
    let theta_r = geometry.theta_r().0;
    if dphi > 90.0 && dphi <= 270.0 { (dphi, theta_r) } else { ((dphi + 180.0).rem_euclid(360.0), -theta_r) }
}

#[cfg(test)]
mod tests {
    use super::IncidenceSeries;
    use crate::measurement::{Quantity, Row};
    use crate::optics::Geometry;

    fn row(theta_i: f64, theta_r: f64, dphi: f64) -> Row {
        let dolp = Some(Quantity { value: 0.1, sigma: None });
        Row { geometry: Geometry::new(theta_i, theta_r, dphi).unwrap(), dolp, brdf: None, masked: false }
    }

    #[test]
    fn rows_of_one_angle_and_plane_stand_together_with_signs() {
        let rows = [row(40.0, 20.0, 180.0), row(30.0, 10.0, 180.0), row(40.0, 30.0, 0.0), row(40.0, 10.0, 90.0)];
        let series = IncidenceSeries::of(&rows);
        assert_eq!(series.iter().map(IncidenceSeries::name).collect::<Vec<_>>(), ["θi = 30°", "θi = 40°", "θi = 40°, Δφ = 270°"]);
        assert_eq!(series[1].dolp.iter().map(|point| point.theta_r).collect::<Vec<_>>(), [-30.0, 20.0]);
        assert_eq!(series[1].rows, [2, 0]);
        assert!(series[1].has_backscatter() && !series[0].has_backscatter());
        for group in &series {
            for point in &group.dolp {
                let geometry = group.geometry(point.theta_r).unwrap();
                assert_eq!(geometry.theta_r(), rows[point.row].geometry.theta_r());
                let turn = (geometry.dphi().0 - rows[point.row].geometry.dphi().0).rem_euclid(360.0);
                assert_eq!(turn, 0.0);
            }
        }
    }
}
