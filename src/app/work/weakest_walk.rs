//! The way from a fit along the direction that the data determine least.

use pbrdf::fit::{Geodesic, GeodesicPoint, GeodesicWay, JointUnknown};
use pbrdf::model::{Parameter, Parameters};

/// A way that sliders go.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakestWalk {
    /// The fit that it begins at, by its number in the history.
    pub fit: usize,
    /// The measurements by their numbers, in the order of the parameter sets.
    pub numbers: Vec<u64>,
    pub way: GeodesicWay,
    pub geodesic: Geodesic<JointUnknown, Vec<Parameters>>,
}

/// A point of the way, and its share of a place beside it.
type Weighted<'a> = (&'a GeodesicPoint<Vec<Parameters>>, f64);

impl WeakestWalk {
    /// The two points around a share, 0 to 1, of the way, and where it lies between them.
    fn around(&self, share: f64) -> Option<[Weighted<'_>; 2]> {
        let points = &self.geodesic.points;
        let length = share.clamp(0.0, 1.0) * points.last()?.length;
        let after = points.partition_point(|point| point.length < length).min(points.len() - 1);
        let (one, other) = (&points[after.saturating_sub(1)], &points[after]);
        let part = if other.length > one.length { (length - one.length) / (other.length - one.length) } else { 1.0 };
        Some([(one, 1.0 - part), (other, part)])
    }

    /// The parameters there, by the numbers of the measurements.
    pub fn at(&self, share: f64) -> Vec<(u64, Parameters)> {
        let Some([(one, before), (other, after)]) = self.around(share) else { return Vec::new() };
        let mixed = |(one, other): (&Parameters, &Parameters)| {
            let mut mixed = *other;
            // At a point itself, and of what does not move, nothing is rounded.
            for parameter in Parameter::ALL.into_iter().filter(|&parameter| before > 0.0 && one[parameter] != other[parameter]) {
                mixed[parameter] = before * one[parameter] + after * other[parameter];
            }
            mixed
        };
        self.numbers.iter().copied().zip(one.parameters.iter().zip(&other.parameters).map(mixed)).collect()
    }

    /// How much of the rise that the data allow at 95 % the sum of squares has risen there.
    pub fn rise(&self, share: f64) -> Option<f64> {
        let [(one, before), (other, after)] = self.around(share)?;
        let first = self.geodesic.points.first()?.sum_of_squares;
        let rise = (before * one.sum_of_squares + after * other.sum_of_squares - first) / (self.geodesic.limit - first);
        rise.is_finite().then_some(rise)
    }

    /// The parameters with the largest parts in its beginning, the largest first.
    pub fn movers(&self) -> Vec<(&JointUnknown, f64)> {
        let mut movers: Vec<(&JointUnknown, f64)> = self.geodesic.direction.iter().map(|(name, along)| (name, *along)).collect();
        movers.retain(|(_, along)| along.abs() > LEAST_PART);
        movers.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        movers
    }
}

/// Part of a direction of length 1 below which a parameter is not named.
const LEAST_PART: f64 = 0.2;

#[cfg(test)]
mod tests {
    use super::WeakestWalk;
    use pbrdf::fit::{Geodesic, GeodesicEnd, GeodesicPoint, GeodesicWay};
    use pbrdf::model::{Parameter, Parameters};

    #[test]
    fn the_way_is_walked_evenly_and_reaches_its_ends_exactly() {
        let point = |n: f64, length: f64, sum_of_squares: f64| GeodesicPoint {
            parameters: vec![Parameters { n, ..Parameters::default() }],
            sum_of_squares,
            length,
        };
        let points = vec![point(1.1, 0.0, 1.0), point(2.0, 1.0, 1.5), point(3.3, 4.0, 2.0)];
        let direction = vec![(Parameter::N.into(), -0.9), (Parameter::K.into(), 0.1), (Parameter::Q.into(), 0.95)];
        let geodesic = Geodesic { points, direction, limit: 3.0, end: GeodesicEnd::Misfit };
        let walk = WeakestWalk { fit: 1, numbers: vec![7], way: GeodesicWay::Nearer, geodesic };
        let n = |share| walk.at(share)[0].1.n;
        assert_eq!((n(0.0), n(0.25), n(1.0), n(7.0)), (1.1, 2.0, 3.3, 3.3));
        assert!((n(0.625) - 2.65).abs() < 1e-12 && walk.at(0.5)[0].0 == 7);
        assert_eq!((walk.rise(0.0), walk.rise(1.0)), (Some(0.0), Some(0.5)));
        let movers: Vec<_> = walk.movers().into_iter().map(|(name, _)| name.parameter).collect();
        assert_eq!(movers, [Parameter::Q, Parameter::N]);
    }
}
