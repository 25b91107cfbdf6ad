//! Arrow keys on a slider: steps that are the same forth and back.

use egui::{Event, Key, Response, Ui};
use std::ops::RangeInclusive;

/// How far an arrow key goes.
#[derive(Debug, Clone, Copy)]
pub enum SliderStep {
    Fixed(f64),
    /// A tenth of the power of ten that the value begins with.
    OfSize,
}

/// The least size that steps follow.
const SMALLEST: f64 = 1e-3;
/// Steps that can be taken back exactly.
const LONGEST: usize = 1000;

/// Where arrow keys came from: values with the sign and fineness of the step that left them.
#[derive(Debug, Clone, Default)]
struct Trail {
    at: f64,
    before: Vec<(f64, bool, f64)>,
}

impl SliderStep {
    /// The step of a slider over that range, a hundredth of it or less.
    pub fn over(range: &RangeInclusive<f64>) -> Self {
        Self::Fixed(libm::exp10(libm::floor(libm::log10((range.end() - range.start()) / 100.0))))
    }

    fn size(self, value: f64, sign: f64) -> f64 {
        match self {
            Self::Fixed(step) => step,
            // Just below a power of ten steps are those of below.
            Self::OfSize => libm::exp10(libm::floor(libm::log10((value.abs() * (1.0 + 1e-9 * sign)).max(SMALLEST))) - 1.0),
        }
    }
}

/// Gives the slider the focus when it is clicked or dragged, and lets arrow keys step its value
/// from where it was `before` the slider was drawn; with Shift or Ctrl by a tenth of a step.
pub fn step_with_arrows(ui: &Ui, slider: &Response, before: f64, value: &mut f64, range: &RangeInclusive<f64>, step: SliderStep) {
    if slider.is_pointer_button_down_on() {
        slider.request_focus();
    }
    if !slider.has_focus() {
        return;
    }
    let press = |event: &Event| match event {
        Event::Key { key: Key::ArrowRight, pressed: true, modifiers, .. } => Some((1.0, modifiers.shift || modifiers.command)),
        Event::Key { key: Key::ArrowLeft, pressed: true, modifiers, .. } => Some((-1.0, modifiers.shift || modifiers.command)),
        _ => None,
    };
    let presses: Vec<(f64, bool)> = ui.input(|input| input.events.iter().filter_map(press).collect());
    if presses.is_empty() {
        return;
    }
    let mut trail: Trail = ui.data(|data| data.get_temp(slider.id)).filter(|trail: &Trail| trail.at == before).unwrap_or_default();
    trail.at = before;
    for (sign, is_fine) in presses {
        trail.go(sign, is_fine, range, step);
    }
    *value = trail.at;
    ui.data_mut(|data| data.insert_temp(slider.id, trail));
}

impl Trail {
    fn go(&mut self, sign: f64, is_fine: bool, range: &RangeInclusive<f64>, step: SliderStep) {
        if let Some(&(back, fine, to)) = self.before.last()
            && (fine, to) == (is_fine, -sign)
        {
            self.before.pop();
            self.at = back;
            return;
        }
        let size = step.size(self.at, sign) * if is_fine { 0.1 } else { 1.0 };
        // Without the dust of sums in binary; what lies outside stays until it is stepped inwards.
        let next = ((self.at + sign * size) * 1e9).round() / 1e9;
        let next = next.clamp(range.start().min(self.at), range.end().max(self.at));
        if next != self.at {
            self.before.push((self.at, is_fine, sign));
            let surplus = self.before.len().saturating_sub(LONGEST);
            self.before.drain(..surplus);
            self.at = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{SliderStep, Trail};

    #[test]
    fn steps_come_back_exactly_and_go_over_powers_of_ten() {
        let mut trail = Trail { at: 2.071_234_567_89, ..Trail::default() };
        for sign in [1.0, 1.0, -1.0, -1.0, -1.0, 1.0] {
            trail.go(sign, false, &(0.0..=10.0), SliderStep::OfSize);
        }
        assert_eq!(trail.at, 2.071_234_567_89);
        trail.go(1.0, true, &(0.0..=10.0), SliderStep::OfSize);
        assert!((trail.at - 2.081_234_568).abs() < 1e-12, "{}", trail.at);
        for (from, sign, to) in
            [(1.0, -1.0, 0.99), (1.0, 1.0, 1.1), (10.0, 1.0, 10.0), (0.0, -1.0, 0.0), (0.0, 1.0, 1e-4), (25.0, 1.0, 25.0)]
        {
            let mut trail = Trail { at: from, ..Trail::default() };
            trail.go(sign, false, &(0.0..=10.0), SliderStep::OfSize);
            assert_eq!(trail.at, to, "{from} {sign}");
        }
    }
}
