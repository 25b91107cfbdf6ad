//! Axes with a unit, and marks at round numbers that are never too close to read.

use egui::Ui;
use egui_plot::{AxisHints, GridInput, GridMark};

/// An axis of that title; `format` makes the labels.
pub fn axis<'a>(hints: AxisHints<'a>, ui: &Ui, title: &str, format: impl Fn(f64, f64) -> String + 'a) -> AxisHints<'a> {
    hints
        .label(title.to_owned())
        .formatter(move |mark, _| format(mark.value, mark.step_size))
        .label_spacing(egui::Rangef::new(0.0, 1.0))
        .tick_label_color(ui.visuals().text_color())
}

/// How many marks there are at most, however long the axis is: numbers beyond that tell nothing more.
const MOST: f64 = 14.0;

/// Of the wanted gap, what marks may be apart where there would be a single one, which tells no scale.
const CLOSER: f64 = 0.6;

/// The same where there would be two.
const CLOSE: f64 = 0.8;

/// What is at least between marks, in the plot's smallest spacing: a line of text.
const LINE: f64 = 1.65;

/// Marks 1, 2 or 5 times a power of ten apart: at least `spread` times the plot's smallest spacing,
/// and at least `least`.
pub fn marks(input: &GridInput, spread: f64, least: f64) -> Vec<GridMark> {
    let wanted = (spread * input.base_step_size).max(least).max((input.bounds.1 - input.bounds.0) / MOST);
    let marks = marks_apart(input, wanted);
    // Two are a scale, but hardly one to read by.
    let share = if marks.len() < 2 { CLOSER } else { CLOSE };
    let closer = (share * wanted).max(LINE.min(spread) * input.base_step_size);
    if marks.len() < 3 { marks_apart(input, closer.max(least)) } else { marks }
}

fn marks_apart(input: &GridInput, wanted: f64) -> Vec<GridMark> {
    if !(wanted.is_finite() && wanted > 0.0) {
        return Vec::new();
    }
    let decade = libm::exp10(libm::log10(wanted).floor());
    let step_size =
        [1.0, 2.0, 5.0].into_iter().map(|step| step * decade).find(|&step| step >= wanted * (1.0 - 1e-9)).unwrap_or(10.0 * decade);
    let (first, last) = ((input.bounds.0 / step_size).ceil(), (input.bounds.1 / step_size).floor());
    let mut marks = Vec::new();
    let mut i = first;
    // A step is at least a few points of the screen wide, so that there are few marks.
    while i <= last && marks.len() < 200 {
        marks.push(GridMark { value: i * step_size, step_size });
        i += 1.0;
    }
    marks
}

/// A number with as many decimals as the step between marks has; in powers of ten where those would
/// be many.
pub fn decimal(value: f64, step_size: f64) -> String {
    let text = unsigned(value.abs(), step_size);
    if value < 0.0 { format!("−{text}") } else { text }
}

fn unsigned(value: f64, step_size: f64) -> String {
    if !(1e-3..1e5).contains(&step_size) {
        if value == 0.0 {
            return "0".to_owned();
        }
        let decade = |x: f64| libm::log10(x * (1.0 + 1e-9)).floor();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of digits from 0 to 12")]
        let digits = (decade(value) - decade(step_size)).clamp(0.0, 12.0) as usize;
        return format!("{value:.digits$e}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of decimals from 0 to 3")]
    let decimals = (-libm::log10(step_size).floor()).clamp(0.0, 3.0) as usize;
    format!("{value:.decimals$}")
}

/// Marks of a decimal logarithm: at powers of ten or, where there are fewer of those than fit, at
/// 1, 2 and 5 times each.
pub fn decades(input: &GridInput, spread: f64) -> Vec<GridMark> {
    let wanted = spread * input.base_step_size;
    // The narrowest of the three gaps is that from 1 to 2.
    let third = std::f64::consts::LOG10_2;
    if !(wanted.is_finite() && wanted > 0.0 && wanted <= third) {
        return marks(input, spread, 1.0);
    }
    if input.bounds.1 - input.bounds.0 < 2.0 * third {
        // A closer look than these marks allow.
        return round_values(input, wanted);
    }
    let mut all = Vec::new();
    let mut decade = input.bounds.0.floor();
    while decade <= input.bounds.1 && all.len() < 200 {
        let at = [1.0, 2.0, 5.0].map(|times| decade + libm::log10(times));
        all.extend(
            at.into_iter().filter(|at| (input.bounds.0..=input.bounds.1).contains(at)).map(|value| GridMark { value, step_size: third }),
        );
        decade += 1.0;
    }
    all
}

/// Marks of a decimal logarithm at values that are 1, 2 or 5 times a power of ten apart.
fn round_values(input: &GridInput, wanted: f64) -> Vec<GridMark> {
    let (low, high) = (libm::exp10(input.bounds.0), libm::exp10(input.bounds.1));
    // Marks are closest at the upper end.
    let least = high * (1.0 - libm::exp10(-wanted));
    let of_values = GridInput { bounds: (low, high), base_step_size: least };
    let at = |mark: GridMark| GridMark { value: libm::log10(mark.value), step_size: libm::log10(1.0 + mark.step_size / mark.value) };
    marks(&of_values, 1.0, 0.0).into_iter().filter(|mark| mark.value > 0.0).map(at).collect()
}

/// Whether the numbers of a logarithmic axis between those exponents are written out: on one axis all of them, or none.
pub fn is_written_out(low: f64, high: f64) -> bool {
    (-4.0..4.5).contains(&low) && (-3.0..4.5).contains(&high)
}

/// A value at a mark of its decimal logarithm, with the digits that tell it from the next mark; as a power of ten, or written
/// out.
pub fn logarithmic(exponent: f64, step_size: f64, written_out: bool) -> String {
    if step_size >= 1.0 && !written_out {
        return format!("1e{}", exponent + 0.0);
    }
    let value = libm::exp10(exponent);
    // The next mark is that much larger; where they are decades apart, all are powers of ten.
    let gap = value * (libm::exp10(step_size) - 1.0).min(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of digits from 0 to 12")]
    let digits = |size: f64| (-libm::log10(gap / size * (1.0 + 1e-9)).floor()).clamp(0.0, 12.0) as usize;
    let short = |digits: &str| {
        let has_point = digits.contains('.');
        if has_point { digits.trim_end_matches('0').trim_end_matches('.').to_owned() } else { digits.to_owned() }
    };
    if written_out {
        return short(&format!("{value:.*}", digits(1.0)));
    }
    let scientific = format!("{value:.*e}", digits(libm::exp10(exponent.floor())));
    scientific.split_once('e').map_or_else(|| scientific.clone(), |(digits, exponent)| format!("{}e{exponent}", short(digits)))
}

#[cfg(test)]
mod tests {
    use super::{decades, is_written_out, logarithmic, marks};
    use egui_plot::GridInput;

    fn labels(low: f64, high: f64, base_step_size: f64) -> Vec<String> {
        let marks = decades(&GridInput { bounds: (low, high), base_step_size }, 5.0);
        let written_out = is_written_out(low, high);
        marks.iter().map(|mark| logarithmic(mark.value, mark.step_size, written_out)).collect()
    }

    #[test]
    fn a_logarithmic_axis_has_round_numbers_at_its_marks() {
        assert_eq!(labels(-1.1, 1.1, 0.02), ["0.1", "0.2", "0.5", "1", "2", "5", "10"]);
        assert_eq!(labels(4.0, 5.0, 0.02), ["1e4", "2e4", "5e4", "1e5"]);
        assert_eq!(labels(-16.0, 1.0, 1.0), ["1e-15", "1e-10", "1e-5", "1e0"]);
        // Closer than those marks: round values, not values of round logarithms.
        assert_eq!(labels(-3.46, -3.29, 0.005), ["3.5e-4", "4e-4", "4.5e-4", "5e-4"]);
        // One way of writing on one axis.
        assert_eq!(labels(-1.5, 1.0, 0.15), ["0.1", "1", "10"]);
        assert_eq!(labels(-3.0106, -2.9626, 0.0016), ["0.00098", "0.001", "0.00102", "0.00104", "0.00106", "0.00108"]);
    }

    #[test]
    fn a_low_axis_has_more_than_one_number() {
        // A strip of residuals to ±0.0162, 53 points high.
        let input = GridInput { bounds: (-0.0162, 0.0162), base_step_size: 8.0 * 0.0324 / 53.0 };
        let at: Vec<f64> = marks(&input, 2.2, 0.0).iter().map(|mark| mark.value).collect();
        assert_eq!(at, [-0.01, 0.0, 0.01]);
        // One of 64 points, where there is room for more.
        let input = GridInput { base_step_size: 8.0 * 0.0324 / 64.0, ..input };
        let at: Vec<f64> = marks(&input, 3.5, 0.0).iter().map(|mark| mark.value).collect();
        assert_eq!(at, [-0.01, 0.0, 0.01]);
    }

    #[test]
    fn no_two_marks_of_a_logarithmic_axis_have_the_same_label() {
        // The last steps of a fit differ in the sixth digit.
        for (low, high) in [(1.261_62e-3, 1.261_68e-3), (0.999_98, 1.000_03), (4.000_1e5, 4.000_9e5), (1.26e-9, 1.27e-9)] {
            let (low, high) = (libm::log10(low), libm::log10(high));
            let all = labels(low, high, (high - low) / 200.0);
            let different: std::collections::BTreeSet<&String> = all.iter().collect();
            assert!(all.len() > 2 && different.len() == all.len(), "{all:?}");
        }
        assert_eq!(labels(libm::log10(1.261_62e-3), libm::log10(1.261_68e-3), 2e-7)[0], "0.00126162");
    }
}
