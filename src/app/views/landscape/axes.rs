//! The axes of the landscape: where values lie on them, what of them is seen first, and their
//! marks.

use crate::app::plots::Range;
use pbrdf::fit::LandscapeAxis;
use pbrdf::model::Parameter;

/// The coordinate of a value on an axis: its logarithm where the parameter is best walked by
/// factors.
pub fn coordinate(parameter: Parameter, value: f64) -> f64 {
    if parameter.is_logarithmic() { libm::log10(value) } else { value }
}

/// The value at a coordinate.
pub fn value(parameter: Parameter, coordinate: f64) -> f64 {
    if parameter.is_logarithmic() { libm::exp10(coordinate) } else { coordinate }
}

/// All that the slider reaches; four decades of a weight, whose range begins at 0.
pub fn whole(parameter: Parameter) -> Range {
    let (low, high) = parameter.range().into_inner();
    let low = if parameter.is_logarithmic() { low.max(1e-4 * high) } else { low };
    Range { low: coordinate(parameter, low), high: coordinate(parameter, high) }
}

/// What is seen first: of n and k where metals are in the visible, of the others all.
pub fn first(parameter: Parameter) -> Range {
    match parameter {
        Parameter::N => Range { low: coordinate(parameter, 0.03), high: coordinate(parameter, 10.0) },
        Parameter::K => Range { low: 0.0, high: 9.0 },
        _ => whole(parameter),
    }
}

/// The axis over what is seen, as far as there are surfaces.
pub fn axis_over(parameter: Parameter, seen: Range, count: usize) -> Option<LandscapeAxis> {
    let [low, high] = [seen.low, seen.high].map(|coordinate| value(parameter, coordinate));
    let low = if parameter.domain().contains(low) { low } else { whole_low(parameter) };
    let is_sound = low.is_finite() && high.is_finite() && low < high && parameter.domain().contains(low);
    is_sound.then_some(LandscapeAxis { parameter, low, high, count, logarithmic: parameter.is_logarithmic() })
}

fn whole_low(parameter: Parameter) -> f64 {
    *parameter.range().start()
}

/// Four digits: what a click can mean.
pub fn tidy(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::{Range, axis_over, coordinate, tidy, value, whole};
    use pbrdf::model::Parameter;

    #[test]
    fn every_axis_over_the_whole_range_is_sound_and_values_come_back() {
        for parameter in Parameter::ALL {
            let range = whole(parameter);
            let axis = axis_over(parameter, range, 16).expect("a range of values");
            assert!(parameter.domain().contains(axis.low) && parameter.domain().contains(axis.high), "{}", parameter.key());
            let back = coordinate(parameter, value(parameter, range.high));
            assert!((back - range.high).abs() < 1e-12);
        }
    }

    #[test]
    fn an_axis_stops_where_surfaces_stop() {
        let axis = axis_over(Parameter::K, Range { low: -3.0, high: 5.0 }, 16).expect("half of it is a range");
        assert_eq!((axis.low, axis.high), (0.0, 5.0));
        assert_eq!(axis_over(Parameter::K, Range { low: -3.0, high: -1.0 }, 16), None);
    }

    #[test]
    fn a_click_means_four_digits() {
        assert_eq!((tidy(2.037_19), tidy(1.0)), (2.037, 1.0));
    }
}
