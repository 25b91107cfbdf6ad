//! Ticks of an axis and their labels.

use crate::figure::{Axis, Scale};

/// A tick of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Its value, in the unit of the axis.
    pub at: f64,
    /// Its label; a minor tick has none.
    pub label: Option<String>,
}

/// Ticks between the ends of an axis, with at most about `most` labels.
pub fn ticks(axis: &Axis, (low, high): (f64, f64), most: usize) -> Vec<Tick> {
    if let Some(own) = &axis.ticks {
        let inside = own.iter().filter(|(at, _)| (low..=high).contains(at));
        return inside.map(|(at, label)| Tick { at: *at, label: Some(label.clone()) }).collect();
    }
    match axis.scale {
        Scale::Linear => {
            let step = step_of(axis, high - low, most);
            let marks = linear(low, high, step);
            // One tick shows no scale.
            if marks.len() < 2 { linear(low, high, 0.5 * step) } else { marks }
        }
        Scale::Log => log(low, high, most),
    }
}

/// Steps in degrees that divide a circle evenly.
const DEGREES: [f64; 4] = [15.0, 30.0, 45.0, 90.0];

/// The step between ticks; for angles beyond 10° one that divides the circle.
fn step_of(axis: &Axis, span: f64, most: usize) -> f64 {
    let step = step(span, most);
    #[expect(clippy::cast_precision_loss, reason = "a handful of marks")]
    let fits = |degrees: &f64| span / degrees <= most as f64;
    if axis.unit == "°" && step > 10.0 { DEGREES.into_iter().find(fits).unwrap_or(step) } else { step }
}

/// The step of 1, 2 or 5 times a power of ten that divides a span into at least two and at most
/// `most` parts.
pub fn step(span: f64, most: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a handful of marks")]
    let wanted = span / most.max(2) as f64;
    let decade = libm::exp10(libm::log10(wanted).floor());
    let nice = [1.0, 2.0, 5.0].into_iter().map(|step| step * decade).find(|&step| step >= wanted * (1.0 - 1e-9));
    nice.unwrap_or(10.0 * decade)
}

/// More ticks than this mean that the step is lost in rounding.
const MOST_MARKS: usize = 60;

fn linear(low: f64, high: f64, step: f64) -> Vec<Tick> {
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    if !(step > 0.0 && first.is_finite() && last.is_finite()) {
        return Vec::new();
    }
    let largest = (first * step).abs().max((last * step).abs());
    let mut marks = Vec::new();
    let mut i = first;
    while i <= last && marks.len() < MOST_MARKS {
        marks.push(Tick { at: i * step, label: Some(number(i * step, step, largest)) });
        i += 1.0;
    }
    marks
}

/// Powers of ten; every n-th where there are too many, and 1, 2 and 5 times each where there are
/// too few.
fn log(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let (first, last) = (libm::log10(low), libm::log10(high));
    let decades = last - first;
    if decades < 1.0 {
        return short_log(low, high, most);
    }
    #[expect(clippy::cast_precision_loss, reason = "a handful of marks")]
    let every = [1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0].into_iter().find(|every| decades / every <= most as f64).unwrap_or(200.0);
    let mut marks = Vec::new();
    let mut exponent = first.floor();
    while exponent <= last.floor() {
        let decade = libm::exp10(exponent);
        if decade >= low * (1.0 - 1e-9) && decade <= high * (1.0 + 1e-9) {
            // Counted from 10⁰, so that labels do not move with the ends.
            let is_labelled = (exponent / every).fract() == 0.0;
            marks.push(Tick { at: decade, label: is_labelled.then(|| power_of_ten(exponent)) });
        }
        if every == 1.0 && decades <= 8.0 {
            let between = (2..10).map(|m| f64::from(m) * decade).filter(|at| (low..=high).contains(at));
            marks.extend(between.map(|at| Tick { at, label: None }));
        }
        exponent += 1.0;
    }
    marks
}

/// Within one decade a logarithmic axis has the ticks of a linear one.
fn short_log(low: f64, high: f64, most: usize) -> Vec<Tick> {
    linear(low, high, step(high - low, most)).into_iter().filter(|tick| tick.at > 0.0).collect()
}

/// `10ⁿ`.
pub fn power_of_ten(exponent: f64) -> String {
    format!("10{}", superscript(&format!("{}", exponent + 0.0)))
}

/// Superscript digits and signs.
pub fn superscript(text: &str) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |letter: char| match letter.to_digit(10) {
        Some(digit) => DIGITS[digit as usize],
        None if matches!(letter, '-' | '−') => '⁻',
        None => letter,
    };
    text.chars().map(raised).collect()
}

/// A number with the decimals of the step between ticks; where these are many, with the power of ten
/// of the largest number of the axis.
pub fn number(value: f64, step: f64, largest: f64) -> String {
    if value == 0.0 || value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    let exponent_of = |x: f64| libm::log10(x.abs() * (1.0 + 1e-9)).floor();
    let decimals_of = |step: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of decimals from 0 to 12")]
        let decimals = (-exponent_of(step)).clamp(0.0, 12.0) as usize;
        decimals
    };
    if step >= 1e-4 && largest < 1e6 {
        return minus(&format!("{value:.0$}", decimals_of(step)));
    }
    let exponent = exponent_of(largest);
    let power = libm::exp10(exponent);
    // The power of ten of a subnormal number underflows.
    let mantissa = if power > 0.0 { value / power } else { value };
    let text = minus(&format!("{mantissa:.0$}", decimals_of(step / power)));
    match text.as_str() {
        "1" => power_of_ten(exponent),
        "−1" => format!("−{}", power_of_ten(exponent)),
        _ => format!("{text}·{}", power_of_ten(exponent)),
    }
}

fn minus(text: &str) -> String {
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::{number, ticks};
    use crate::figure::{Axis, Scale};

    fn labels(scale: Scale, low: f64, high: f64) -> Vec<String> {
        let axis = Axis { scale, ..Axis::default() };
        ticks(&axis, (low, high), 6).into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn logarithmic_marks_are_powers_of_ten_with_superscripts() {
        assert_eq!(labels(Scale::Log, 1e-3, 1e1), ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]);
        assert_eq!(labels(Scale::Log, 1e-17, 1e-2), ["10⁻¹⁵", "10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³"]);
    }

    #[test]
    fn linear_marks_are_round_numbers() {
        assert_eq!(labels(Scale::Linear, -90.0, 90.0), ["−50", "0", "50"]);
        let few = ticks(&Axis::default(), (-0.0075, 0.008), 3).into_iter().filter_map(|tick| tick.label).collect::<Vec<_>>();
        assert_eq!(few, ["−0.005", "0", "0.005"]);
        let degrees = Axis::linear("θr", "°");
        let at = |most| ticks(&degrees, (-90.0, 90.0), most).into_iter().filter_map(|tick| tick.label).collect::<Vec<_>>();
        assert_eq!(at(6), ["−90", "−60", "−30", "0", "30", "60", "90"]);
        assert_eq!(at(4), ["−90", "−45", "0", "45", "90"]);
        assert_eq!(labels(Scale::Linear, 0.0, 0.15), ["0", "0.05", "0.10", "0.15"]);
        assert_eq!(labels(Scale::Linear, 0.0, 3e-6), ["0", "0.5·10⁻⁶", "1.0·10⁻⁶", "1.5·10⁻⁶", "2.0·10⁻⁶", "2.5·10⁻⁶", "3.0·10⁻⁶"]);
    }

    #[test]
    fn numbers_have_the_digits_that_their_step_asks_for() {
        assert_eq!(number(1.5e-7, 5e-8, 2e-7), "1.5·10⁻⁷");
        assert_eq!(number(-0.25, 0.05, 0.5), "−0.25");
        assert_eq!(number(2e7, 1e7, 3e7), "2·10⁷");
        assert_eq!(number(-1e-300, 1e-300, 1e-300), "−10⁻³⁰⁰");
        assert_eq!(number(1e-19, 0.1, 0.5), "0");
    }

    #[test]
    fn extreme_ends_give_few_marks_and_no_panic() {
        for (low, high) in [(0.0, 1e-300), (-1e300, 1e300), (1.0, 1.0 + 1e-13), (5e-324, 1e300)] {
            for scale in [Scale::Linear, Scale::Log] {
                if scale == Scale::Linear || low > 0.0 {
                    let axis = Axis { scale, ..Axis::default() };
                    assert!(ticks(&axis, (low, high), 6).len() < 700, "{low} {high}");
                }
            }
        }
    }
}
