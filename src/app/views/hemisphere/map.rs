//! The map of all directions of view, or the difference of two: its values, their range and colours.

use crate::app::jobs::async_memo::Stopped;
use crate::app::platform;
use crate::app::plots::{Range, nice_ceiling};
use crate::app::views::curves::{DECADES, SETS_AXES};
use crate::app::work::settings::HemisphereQuantity;
use crate::figure::{Axis, ColorMap, HeatMap};
use pbrdf::model::{Hemisphere, HemisphereMap, Model, Parameters, Pbrdf};
use pbrdf::optics::Degrees;
use std::sync::Arc;

/// Cells along an edge of the map; in a page, whose thread makes it, a quarter of them.
pub const SIZE: usize = if platform::IS_PAGE { 128 } else { 256 };

/// Parameters, model, θi, and the surface that is taken off.
pub type MapKey = (Parameters, Model, f64, Option<(Parameters, Model)>);

/// What the job makes.
pub struct Made {
    /// Kept for the next surface at the same θi.
    pub hemisphere: Arc<Hemisphere>,
    pub theta_i: f64,
    /// Of the surface, or how it differs from the reference: values less those of the reference, of
    /// the BRDF the ratio of both.
    pub map: HemisphereMap,
    pub reference: Option<Arc<MadeReference>>,
    /// Smallest and largest value of each quantity, of the BRDF in decimal logarithms.
    pub extremes: [(f64, f64); HemisphereQuantity::ALL.len()],
}

/// The map that is taken off, kept while the sliders move.
pub struct MadeReference {
    pub of: (Parameters, Model),
    map: HemisphereMap,
}

/// From one angle of polarisation to another: they are the same after half a turn.
fn turn(value: f64, other: f64) -> f64 {
    (value - other + 90.0).rem_euclid(180.0) - 90.0
}

impl MadeReference {
    /// How a map differs from it.
    fn less(&self, mut map: HemisphereMap) -> HemisphereMap {
        let pairs = |values: &mut Vec<f64>, others: &[f64], less: fn(f64, f64) -> f64| {
            values.iter_mut().zip(others).for_each(|(value, other)| *value = less(*value, *other));
        };
        pairs(&mut map.dolp, &self.map.dolp, |value, other| value - other);
        pairs(&mut map.angle, &self.map.angle, turn);
        pairs(&mut map.brdf, &self.map.brdf, |value, other| value / other);
        pairs(&mut map.specular_share, &self.map.specular_share, |value, other| value - other);
        map
    }
}

impl Made {
    pub fn is_difference(&self) -> bool {
        self.reference.is_some()
    }

    /// The map in a figure, over degrees from the middle outwards so that axes can tell θr.
    pub fn heat_map(&self, quantity: HemisphereQuantity, range: Range, axis: Axis) -> HeatMap {
        let end = |end: f64| if quantity == HemisphereQuantity::Brdf { libm::exp10(end) } else { end };
        let edges = Range { low: -90.0, high: 90.0 }.edges(SIZE);
        HeatMap {
            x_edges: edges.clone(),
            y_edges: edges,
            values: values(&self.map, quantity).to_vec(),
            color_axis: axis.between(end(range.low), end(range.high)),
            colors: if self.is_difference() { ColorMap::Diverging } else { quantity.colors() },
        }
    }

    /// The map of a surface, less that of the other where there is one; `before` is what was made last
    /// at the same θi. None if it is stopped, or the other one is no surface.
    pub fn new(
        surface: &Pbrdf,
        theta_i: f64,
        less: Option<(Parameters, Model)>,
        before: Option<Prepared>,
        stopped: Stopped<'_>,
    ) -> Option<Self> {
        let (hemisphere, reference) = before.map_or((None, None), |(hemisphere, reference)| (Some(hemisphere), reference));
        let prepared = || Some(Arc::new(Hemisphere::new(theta_i, SIZE, stopped).ok()??));
        let hemisphere = hemisphere.or_else(prepared)?;
        let mut map = hemisphere.map(surface, stopped)?;
        let mut made = None;
        if let Some(of) = less {
            let kept = reference.filter(|kept| kept.of == of);
            let new = || Some(Arc::new(MadeReference { of, map: hemisphere.map(&Pbrdf::new(of.1, of.0).ok()?, stopped)? }));
            let reference = kept.or_else(new)?;
            map = reference.less(map);
            made = Some(reference);
        }
        let extremes = HemisphereQuantity::ALL.map(|quantity| extremes(&map, quantity));
        Some(Self { hemisphere, theta_i, map, reference: made, extremes })
    }
}

/// What is kept of a map for the next one at the same θi.
pub type Prepared = (Arc<Hemisphere>, Option<Arc<MadeReference>>);

/// The values that are coloured, cell by cell.
pub fn values(map: &HemisphereMap, quantity: HemisphereQuantity) -> &[f64] {
    match quantity {
        HemisphereQuantity::Dolp => &map.dolp,
        HemisphereQuantity::Angle => &map.angle,
        HemisphereQuantity::Brdf => &map.brdf,
        HemisphereQuantity::SpecularShare => &map.specular_share,
    }
}

/// The ends of what is finite and not at the horizon, where a Minnaert lobe has no bound; of the
/// BRDF, which is coloured by its decades, their logarithms.
fn extremes(map: &HemisphereMap, quantity: HemisphereQuantity) -> (f64, f64) {
    let is_log = quantity == HemisphereQuantity::Brdf;
    let (low, high) = ends(values(map, quantity), if is_log { f64::MIN_POSITIVE } else { f64::NEG_INFINITY });
    if is_log { (libm::log10(low), libm::log10(high)) } else { (low, high) }
}

/// The smallest and the largest finite value from `least` on, the horizon left out.
fn ends(values: &[f64], least: f64) -> (f64, f64) {
    // Of the disc of radius 1 that has the horizon at its rim; a square of the radius needs no
    // angle.
    let rim = (SETS_AXES / 90.0) * (SETS_AXES / 90.0);
    let mut ends = (f64::INFINITY, f64::NEG_INFINITY);
    for (row, values) in values.chunks(SIZE).enumerate() {
        let y = center(row);
        for (column, &value) in values.iter().enumerate() {
            let x = center(column);
            if value.is_finite() && value >= least && x * x + y * y <= rim {
                ends = (ends.0.min(value), ends.1.max(value));
            }
        }
    }
    ends
}

/// Where a cell lies between −1 and 1.
#[expect(clippy::cast_precision_loss, reason = "a number of cells")]
fn center(index: usize) -> f64 {
    (2.0 * index as f64 + 1.0) / SIZE as f64 - 1.0
}

/// The range of colours that fits the values.
pub fn wanted(quantity: HemisphereQuantity, (low, high): (f64, f64)) -> Range {
    match quantity {
        HemisphereQuantity::Dolp => Range { low: 0.0, high: if high <= 1.0 { nice_ceiling(high).min(1.0) } else { nice_ceiling(high) } },
        HemisphereQuantity::Angle => Range { low: -90.0, high: 90.0 },
        HemisphereQuantity::SpecularShare => Range { low: 0.0, high: 1.0 },
        HemisphereQuantity::Brdf if !high.is_finite() => Range { low: -1.0, high: 0.0 },
        HemisphereQuantity::Brdf => {
            // By half decades.
            let high = 0.5 * (2.0 * high).ceil();
            Range { low: (0.5 * (2.0 * low).floor()).clamp(high - DECADES, high - 1.0), high }
        }
    }
}

/// The range of colours of a difference: as far on either side of what is the same.
pub fn wanted_of_difference((low, high): (f64, f64)) -> Range {
    let most = low.abs().max(high.abs());
    // What is the same everywhere differs by rounding; of maps that are nowhere finite nothing is
    // known.
    let end = if most.is_finite() { nice_ceiling(most.max(1e-6)) } else { 1.0 };
    Range { low: -end, high: end }
}

/// The cell between −1 and 1 that a coordinate lies in.
pub fn index(coordinate: f64) -> Option<usize> {
    #[expect(clippy::cast_precision_loss, reason = "a number of cells")]
    let place = 0.5 * (coordinate + 1.0) * SIZE as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be within the grid")]
    (-1.0..1.0).contains(&coordinate).then_some(place as usize)
}

/// Where a direction lies on the disc, in degrees of θr from the middle: x to the right and y
/// upwards.
pub fn place(theta_r: f64, dphi: f64) -> [f64; 2] {
    let (sin, cos) = Degrees(dphi - 180.0).sin_cos();
    [theta_r * cos, theta_r * sin]
}

impl HemisphereQuantity {
    pub fn colors(self) -> ColorMap {
        if self == Self::Angle { ColorMap::Cyclic } else { ColorMap::Sequential }
    }
}

#[cfg(test)]
mod tests {
    use super::{HemisphereQuantity, Made, Range, SIZE, ends, index, place, turn, values, wanted, wanted_of_difference};
    use pbrdf::model::{Model, Parameters, Pbrdf};
    use pbrdf::optics::SlopeDistribution;

    #[test]
    fn a_cell_has_the_value_of_the_direction_that_lies_there() {
        let surface = Pbrdf::new(Model::full(SlopeDistribution::Cauchy), Parameters::default()).expect("the defaults");
        let made = Made::new(&surface, 50.0, None, None, &|| false).expect("a map");
        // On either side of the plane of incidence the angle of polarisation has the other sign.
        let (row, column) = (3 * SIZE / 4, SIZE / 2);
        let (theta_r, dphi) = made.map.direction(row, column).expect("inside the disc");
        let [x, y] = place(theta_r, dphi);
        assert!(y > 36.0, "above the middle: {x} {y}");
        assert_eq!((index(y / 90.0), index(x / 90.0)), (Some(row), Some(column)));
        let value = |row: usize| values(&made.map, HemisphereQuantity::Angle)[row * SIZE + column];
        assert!(value(row).abs() > 5.0 && value(row) * value(SIZE - 1 - row) < 0.0);
    }

    #[test]
    fn a_difference_is_that_of_both_maps_and_angles_differ_by_a_right_angle_at_most() {
        let model = Model::full(SlopeDistribution::Cauchy);
        let of = |sigma| Parameters { sigma, ..Parameters::default() };
        let surface = |sigma| Pbrdf::new(model, of(sigma)).expect("a surface");
        let map = |sigma| Made::new(&surface(sigma), 50.0, None, None, &|| false).expect("a map");
        let (rough, smooth) = (map(0.4), map(0.2));
        let less = Some((of(0.2), model));
        let difference = Made::new(&surface(0.4), 50.0, less, None, &|| false).expect("a map");
        let at = SIZE / 3 * SIZE + 2 * SIZE / 3;
        for quantity in HemisphereQuantity::ALL {
            let [one, other, both] = [&rough, &smooth, &difference].map(|made| values(&made.map, quantity)[at]);
            let expected = if quantity == HemisphereQuantity::Brdf { one / other } else { one - other };
            // Angles are brought to half a turn by adding and taking off 90.
            let rounding = if quantity == HemisphereQuantity::Angle { 90.0 * 4.0 * f64::EPSILON } else { 0.0 };
            assert!((both - expected).abs() <= rounding, "{quantity:?}: {both} and {expected}");
            // Roughness depolarises, and turns nothing.
            assert!(both != 0.0 || quantity == HemisphereQuantity::Angle, "{quantity:?}");
        }
        assert_eq!((turn(80.0, -80.0), turn(-80.0, 80.0), turn(30.0, 10.0)), (-20.0, 20.0, 20.0));
        // The next one at the same θi takes over what was prepared.
        let before = Some((difference.hemisphere.clone(), difference.reference.clone()));
        let again = Made::new(&surface(0.4), 50.0, less, before, &|| false).expect("a map");
        assert!(again.reference.as_ref().zip(difference.reference.as_ref()).is_some_and(|(one, other)| std::sync::Arc::ptr_eq(one, other)));
        assert_eq!(values(&again.map, HemisphereQuantity::Dolp)[at], values(&difference.map, HemisphereQuantity::Dolp)[at]);
    }

    #[test]
    fn colours_of_a_difference_are_as_far_on_either_side() {
        assert_eq!(wanted_of_difference((-0.04, 0.02)), Range { low: -0.05, high: 0.05 });
        assert_eq!(wanted_of_difference((f64::INFINITY, f64::NEG_INFINITY)), Range { low: -1.0, high: 1.0 });
    }

    #[test]
    fn light_comes_from_the_left_and_the_mirror_is_to_the_right() {
        for (dphi, x, y) in [(0.0, -45.0, 0.0), (180.0, 45.0, 0.0), (270.0, 0.0, 45.0), (90.0, 0.0, -45.0)] {
            assert_eq!(place(45.0, dphi), [x, y], "{dphi}");
        }
        assert_eq!((index(-1.0), index(0.999_9), index(1.0), index(-1.1)), (Some(0), Some(255), None, None));
    }

    #[test]
    fn colours_span_what_is_above_the_horizon() {
        let mut map = vec![f64::NAN; SIZE * SIZE];
        // In the middle, at θr of about 79° and of about 82°.
        for (column, value) in [(SIZE / 2, 0.2), (SIZE / 2 + 112, 0.7), (SIZE / 2 + 117, 9.0)] {
            map[SIZE / 2 * SIZE + column] = value;
        }
        assert_eq!(ends(&map, f64::NEG_INFINITY), (0.2, 0.7));
    }

    #[test]
    fn colours_reach_the_largest_value_and_no_impossible_one() {
        assert_eq!(wanted(HemisphereQuantity::Dolp, (0.0, 0.97)), Range { low: 0.0, high: 1.0 });
        assert_eq!(wanted(HemisphereQuantity::Dolp, (0.0, 0.04)), Range { low: 0.0, high: 0.05 });
        // Eq. (17) as printed divides by k_s.
        assert_eq!(wanted(HemisphereQuantity::Dolp, (0.0, 1.9)), Range { low: 0.0, high: 2.0 });
        assert_eq!(wanted(HemisphereQuantity::Brdf, (-2.3, 0.1)), Range { low: -2.5, high: 0.5 });
        assert_eq!(wanted(HemisphereQuantity::Brdf, (-80.0, 0.1)), Range { low: -7.5, high: 0.5 });
    }
}
