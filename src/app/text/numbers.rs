//! Numbers as the window shows them: by the rounding of the core.

use pbrdf::fit::relative_error_base;
use pbrdf::model::Parameter;
use pbrdf::rounding;

/// Three significant digits, enough for an error.
pub fn short(value: f64) -> String {
    rounding::significant(value, 3)
}

/// Up to five significant digits, for a value.
pub fn significant(value: f64) -> String {
    rounding::trimmed(value, 5)
}

/// An error in percent of the size of its parameter.
pub fn percent(parameter: Parameter, value: f64, error: f64) -> String {
    let percent = 100.0 * error / relative_error_base(parameter, value);
    if percent.is_finite() && percent < 1e4 { format!("{percent:.*} %", usize::from(percent < 10.0)) } else { "—".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{percent, short, significant};
    use pbrdf::fit::is_poorly_determined;
    use pbrdf::model::Parameter;

    #[test]
    fn errors_are_judged_by_the_size_of_what_they_belong_to() {
        assert!(is_poorly_determined(Parameter::N, 2.0, 1.5) && !is_poorly_determined(Parameter::N, 2.0, 0.5));
        // q counts from 1.
        assert!(is_poorly_determined(Parameter::Q, 1.2, 0.15));
        assert_eq!(percent(Parameter::N, 2.0, 0.05), "2.5 %");
        assert_eq!(percent(Parameter::Kd, 0.0, 0.05), "—");
    }

    #[test]
    fn errors_have_three_digits_and_values_five() {
        for (value, expected) in [(0.0, "0"), (2.3561, "2.36"), (-0.001_234, "-0.00123"), (1234.5, "1234"), (1e-7, "1.00e-7")] {
            assert_eq!(short(value), expected);
        }
        for (value, expected) in [(0.0, "0"), (2.0, "2"), (-1.25, "-1.25"), (std::f64::consts::PI, "3.1416"), (0.0005, "0.0005")] {
            assert_eq!(significant(value), expected);
        }
    }
}
