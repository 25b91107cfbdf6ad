//! Errors of parameters in words that more than one panel says.

use pbrdf::fit::size_of;
use pbrdf::model::Parameter;

/// An error in percent of the size of what it belongs to.
pub fn percent(parameter: Parameter, value: f64, error: f64) -> String {
    let percent = 100.0 * error / size_of(parameter, value);
    if percent.is_finite() && percent < 1e4 { format!("{percent:.*} %", usize::from(percent < 10.0)) } else { "—".to_owned() }
}

/// Three significant digits, enough for an error.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e4).contains(&value.abs()) {
        return format!("{value:.2e}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of decimals from 0 to 6")]
    let decimals = (2.0 - libm::log10(value.abs()).floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::{percent, short};
    use pbrdf::fit::is_loose;
    use pbrdf::model::Parameter;

    #[test]
    fn errors_are_judged_by_the_size_of_what_they_belong_to() {
        assert!(is_loose(Parameter::N, 2.0, 1.5) && !is_loose(Parameter::N, 2.0, 0.5));
        // q counts from 1.
        assert!(is_loose(Parameter::Q, 1.2, 0.15));
        assert_eq!(percent(Parameter::N, 2.0, 0.05), "2.5 %");
        assert_eq!(percent(Parameter::Kd, 0.0, 0.05), "—");
    }

    #[test]
    fn errors_are_shown_with_three_digits() {
        for (value, expected) in [(0.0, "0"), (2.3561, "2.36"), (-0.001_234, "-0.00123"), (1234.5, "1234"), (1e-7, "1.00e-7")] {
            assert_eq!(short(value), expected);
        }
    }
}
