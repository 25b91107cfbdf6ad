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

/// Marks 1, 2 or 5 times a power of ten apart: at least `spread` times the plot's smallest spacing, and at least `least`.
pub fn marks(input: &GridInput, spread: f64, least: f64) -> Vec<GridMark> {
    let wanted = (spread * input.base_step_size).max(least);
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

/// A number with as many decimals as the step between marks has; in powers of ten where those would be many.
pub fn decimal(value: f64, step_size: f64) -> String {
    // Adding 0 turns -0 into 0.
    let value = value + 0.0;
    if !(1e-3..1e5).contains(&step_size) {
        if value == 0.0 {
            return "0".to_owned();
        }
        let decade = |x: f64| libm::log10(x.abs() * (1.0 + 1e-9)).floor();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of digits from 0 to 12")]
        let digits = (decade(value) - decade(step_size)).clamp(0.0, 12.0) as usize;
        return format!("{value:.digits$e}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of decimals from 0 to 3")]
    let decimals = (-libm::log10(step_size).floor()).clamp(0.0, 3.0) as usize;
    format!("{value:.decimals$}")
}

/// A value at a mark of its decimal logarithm: a power of ten, or a number where marks are closer than decades.
pub fn logarithmic(exponent: f64, step_size: f64) -> String {
    if step_size >= 1.0 { power_of_ten(exponent, step_size) } else { format!("{:.2e}", libm::exp10(exponent)) }
}

/// A power of ten.
pub fn power_of_ten(exponent: f64, _step_size: f64) -> String {
    format!("1e{}", exponent + 0.0)
}
