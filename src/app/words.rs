//! Errors of parameters in words that more than one panel says.

use pbrdf::model::Parameter;

/// What an error of a parameter is measured by: its distance from where its effect vanishes, or, for c, which has no such place,
/// the width of its range.
fn size(parameter: Parameter, value: f64) -> f64 {
    match parameter {
        Parameter::Q => value - 1.0,
        Parameter::C => 1.0,
        _ => value.abs(),
    }
}

/// Whether an error is so large that the value says next to nothing.
pub fn is_loose(parameter: Parameter, value: f64, error: f64) -> bool {
    error > 0.5 * size(parameter, value)
}

/// An error in percent of that size.
pub fn percent(parameter: Parameter, value: f64, error: f64) -> String {
    let percent = 100.0 * error / size(parameter, value);
    if percent.is_finite() && percent < 1e4 { format!("{percent:.*} %", usize::from(percent < 10.0)) } else { "—".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{is_loose, percent};
    use pbrdf::model::Parameter;

    #[test]
    fn errors_are_judged_by_the_size_of_what_they_belong_to() {
        assert!(is_loose(Parameter::N, 2.0, 1.5) && !is_loose(Parameter::N, 2.0, 0.5));
        // q counts from 1.
        assert!(is_loose(Parameter::Q, 1.2, 0.15));
        assert_eq!(percent(Parameter::N, 2.0, 0.05), "2.5 %");
        assert_eq!(percent(Parameter::Kd, 0.0, 0.05), "—");
    }
}
