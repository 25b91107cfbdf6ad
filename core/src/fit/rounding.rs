//! Numbers for people: as many digits as mean something.

/// The number with that many significant digits: in decimal form from 1e-4 to 1e6, else with an exponent.
///
/// ```
/// assert_eq!(pbrdf::rounding::significant(2.071_234, 3), "2.07");
/// assert_eq!(pbrdf::rounding::significant(1.5e-7, 3), "1.50e-7");
/// ```
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits_less_one = digits.saturating_sub(1);
    let text = format!("{value:.digits_less_one$e}");
    let exponent: i32 = text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return text;
    }
    let decimals = usize::try_from(i32::try_from(digits_less_one).unwrap_or(0) - exponent).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// The same without zeros at the end of a decimal fraction.
#[must_use]
pub fn trimmed(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    if text.contains('.') && !text.contains('e') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A value to the second digit of its standard error, and the error to two digits. Without an error above 0
/// the value has six digits.
///
/// ```
/// let (value, error) = pbrdf::rounding::with_error(2.071_234, Some(0.012_3));
/// assert_eq!((value.as_str(), error.as_deref()), ("2.071", Some("0.012")));
/// ```
#[must_use]
pub fn with_error(value: f64, error: Option<f64>) -> (String, Option<String>) {
    let Some(error) = error.filter(|error| *error > 0.0 && error.is_finite()) else { return (trimmed(value, 6), None) };
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of f64")]
    let exponent = |x: f64| if x == 0.0 { -400 } else { libm::log10(x.abs()).floor() as i32 };
    let digits = usize::try_from(exponent(value) - exponent(error) + 2).unwrap_or(0).clamp(2, 17);
    (significant(value, digits), Some(significant(error, 2)))
}

/// Decimal places that show the second digit of an uncertainty; none from 10 on.
#[must_use]
pub fn decimal_places(uncertainty: f64) -> usize {
    if !(uncertainty > 0.0 && uncertainty.is_finite()) {
        return 6;
    }
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of f64")]
    let exponent = libm::log10(uncertainty).floor() as i32;
    usize::try_from(1 - exponent).unwrap_or(0).min(17)
}

#[cfg(test)]
mod tests {
    use super::{significant, trimmed, with_error};

    #[test]
    fn numbers_have_the_digits_that_mean_something() {
        assert_eq!(significant(2.071_234, 3), "2.07");
        assert_eq!(significant(1.5e-7, 3), "1.50e-7");
        assert_eq!(significant(1234.6, 2), "1235");
        assert_eq!(significant(-0.0, 3), "-0");
        assert_eq!([trimmed(2.5, 5), trimmed(100.0, 5), trimmed(2e-3, 5)], ["2.5", "100", "0.002"]);
        let pair = |value, error| {
            let (value, error) = with_error(value, error);
            (value, error.unwrap_or_default())
        };
        assert_eq!(pair(2.071_234, Some(0.012_3)), ("2.071".to_owned(), "0.012".to_owned()));
        assert_eq!(pair(0.3, Some(12.0)), ("0.30".to_owned(), "12".to_owned()));
        assert_eq!(pair(2.071_234_5, None), ("2.07123".to_owned(), String::new()));
        assert_eq!([pair(1.0, None).0, pair(100.0, None).0, pair(1e-7, None).0], ["1", "100", "1.00000e-7"]);
        assert_eq!(pair(0.0, Some(0.1)), ("0".to_owned(), "0.10".to_owned()));
    }
}
