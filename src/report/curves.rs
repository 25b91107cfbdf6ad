//! The model along a series: DoLP, Fresnel limit, BRDF and its terms against θr.

use pbrdf::measurement::IncidenceSeries;
use pbrdf::model::{Pbrdf, Reflection};
use pbrdf::optics::{Facet, shortest};
use std::io::{self, Write};

/// One direction of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// θr in degrees, negative on the backscatter side.
    pub theta_r: f64,
    /// BRDF, DoLP and terms.
    pub reflection: Reflection,
    /// DoLP of the specular lobe alone: the Fresnel limit.
    pub limit: f64,
}

/// Signed θr of a curve in degrees: every half degree, and denser around the mirror direction, where
/// lobes are narrow.
#[must_use]
pub fn directions(theta_i: f64, backscatter: bool) -> Vec<f64> {
    let first = if backscatter { -179 } else { 0 };
    let mut angles: Vec<f64> = (first..180).map(|half| 0.5 * f64::from(half)).collect();
    angles.push(89.9);
    if backscatter {
        angles.push(-89.9);
    }
    let near = (0..48).map(|i| 0.002 * libm::pow(1.18, f64::from(i)));
    angles.extend(near.flat_map(|offset| [theta_i - offset, theta_i + offset]).chain([theta_i]));
    angles.retain(|angle| angle.abs() < 90.0 && (backscatter || *angle >= 0.0));
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// The model along a series.
#[must_use]
pub fn curve(surface: &Pbrdf, series: &IncidenceSeries, backscatter: bool) -> Vec<CurvePoint> {
    let angles = directions(series.theta_i, backscatter).into_iter();
    let points = angles.filter_map(|theta_r| {
        let facet = Facet::new(series.geometry(theta_r)?);
        Some(CurvePoint { theta_r, reflection: surface.reflection(&facet), limit: surface.fresnel_limit(&facet) })
    });
    points.collect()
}

/// Writes the model along some series as CSV, 17 significant digits a number.
///
/// Columns: `theta_i`, `theta_r`, `dphi` in degrees as in a measurement, so that the file can be read as
/// one; `signed_theta_r`, negative on the backscatter side; `dolp`, `fresnel_limit`; `brdf`, `specular`,
/// `diffuse`, `volume` in 1/sr.
///
/// # Errors
///
/// Those of `out`.
pub fn write_curves(surface: &Pbrdf, series: &[IncidenceSeries], backscatter: bool, mut out: impl Write) -> io::Result<()> {
    writeln!(out, "theta_i,theta_r,dphi,signed_theta_r,dolp,fresnel_limit,brdf,specular,diffuse,volume")?;
    for group in series {
        for point in curve(surface, group, backscatter) {
            let Some(geometry) = group.geometry(point.theta_r) else { continue };
            let CurvePoint { theta_r, reflection: Reflection { brdf, dolp, specular, diffuse, volume, .. }, limit } = point;
            let angles = [geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0, theta_r];
            let numbers = angles.into_iter().chain([dolp, limit, brdf, specular, diffuse, volume]);
            let cells: Vec<String> = numbers.map(shortest).collect();
            writeln!(out, "{}", cells.join(","))?;
        }
    }
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::{curve, directions, write_curves};
    use pbrdf::measurement::{IncidenceSeries, Measurement};
    use pbrdf::model::{Model, Parameters, Pbrdf};
    use pbrdf::optics::SlopeDistribution;

    fn surface() -> Pbrdf {
        Pbrdf::new(Model::full(SlopeDistribution::Cauchy), Parameters::default()).unwrap()
    }

    fn series(theta_i: f64, plane: f64) -> IncidenceSeries {
        IncidenceSeries { theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() }
    }

    #[test]
    fn curves_read_back_as_a_measurement_with_the_same_bits() {
        let groups = [series(30.0, 180.0), series(55.5, 225.0)];
        let mut bytes = Vec::new();
        write_curves(&surface(), &groups, true, &mut bytes).unwrap();
        let measurement = Measurement::read(bytes.as_slice()).unwrap();
        let points: Vec<_> = groups.iter().flat_map(|group| curve(&surface(), group, true)).collect();
        assert_eq!(measurement.rows.len(), points.len());
        assert!(points.iter().any(|point| point.theta_r < 0.0));
        for (row, point) in measurement.rows.iter().zip(&points) {
            assert_eq!(row.dolp.unwrap().value, point.reflection.dolp);
            assert_eq!(row.brdf.unwrap().value, point.reflection.brdf);
        }
        let back = IncidenceSeries::of(&measurement.rows);
        assert_eq!(back.len(), 2);
        assert!(back[1].dolp.iter().zip(&points[points.len() - back[1].dolp.len()..]).all(|(mark, point)| mark.theta_r == point.theta_r));
    }

    #[test]
    fn directions_are_closest_around_the_mirror() {
        let angles = directions(40.0, false);
        assert!(angles.windows(2).all(|pair| pair[0] < pair[1]) && angles[0] == 0.0 && angles.last() == Some(&89.9));
        let gap = |near: f64| angles.windows(2).filter(|pair| pair[0] <= near && near < pair[1]).map(|pair| pair[1] - pair[0]).sum::<f64>();
        assert!(gap(40.0) < 0.003 && gap(70.0) > 0.4);
    }
}
