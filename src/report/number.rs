//! Values with their uncertainty in digits, as papers write them.

use pbrdf::fit::Interval;
use pbrdf::fit::rounding::{decimal_places, significant, trimmed};

/// One distance from a value to an end of its interval over the other, from which on the ends are written in place of the value.
const UNEVEN: f64 = 20.0;

/// A number with its uncertainty, in digits.
pub enum Number {
    Text(String),
    Symmetric {
        value: String,
        error: String,
        exponent: i32,
    },
    Asymmetric {
        value: String,
        ends: [String; 2],
        in_digits: [String; 2],
        exponent: i32,
    },
    /// An interval whose ends lie too unevenly about the value for brackets.
    Between([String; 2]),
    Above(String),
    Below(String),
    None,
}

/// The power of ten that a number is written with: 0 from 1e-4 to 1e6.
fn exponent_of(value: f64) -> i32 {
    if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of f64")]
    let exponent = libm::log10(value.abs()).floor() as i32;
    exponent
}

/// `2.049(23)`.
pub fn symmetric(value: f64, error: f64) -> Number {
    if !(error > 0.0 && error.is_finite()) {
        return Number::Text(trimmed(value, 6));
    }
    let exponent = exponent_of(value);
    let unit = libm::pow(10.0, f64::from(exponent));
    let places = decimal_places(error / unit);
    Number::Symmetric { value: format!("{:.places$}", value / unit), error: in_last_digits(error / unit, places), exponent }
}

/// An uncertainty in units of the last of so many decimal places; with its decimal point from 1 on.
fn in_last_digits(error: f64, places: usize) -> String {
    let text = format!("{error:.places$}");
    if text.starts_with("0.") || text.starts_with("-0.") {
        let digits = text.split_once('.').map_or("", |(_, digits)| digits).trim_start_matches('0');
        if digits.is_empty() { "0".to_owned() } else { digits.to_owned() }
    } else {
        text
    }
}

/// `2.05(+31/−24)`, or the one end that there is.
pub fn within(value: f64, interval: Interval) -> Number {
    match (interval.low, interval.high) {
        (Some(low), Some(high)) => {
            let [above, below] = [high - value, value - low];
            if above.min(below) > 0.0 && above.max(below) > UNEVEN * above.min(below) {
                return Number::Between([low, high].map(|end| significant(end, 2)));
            }
            let finer = if above > 0.0 && below > 0.0 { above.min(below) } else { above.max(below) };
            let exponent = exponent_of(value);
            let unit = libm::pow(10.0, f64::from(exponent));
            let places = decimal_places(finer / unit);
            let ends = [above, below].map(|end| format!("{:.places$}", end / unit));
            if ends[0] == ends[1] {
                return symmetric(value, above);
            }
            // Both with a decimal point, or both in the last digits.
            let has_point = above.max(below) / unit >= 1.0;
            let in_digits = if has_point { ends.clone() } else { [above, below].map(|end| in_last_digits(end / unit, places)) };
            Number::Asymmetric { value: format!("{:.places$}", value / unit), ends, in_digits, exponent }
        }
        (Some(low), None) => Number::Above(significant(low, 3)),
        (None, Some(high)) => Number::Below(significant(high, 3)),
        (None, None) => Number::Text(trimmed(value, 3)),
    }
}
