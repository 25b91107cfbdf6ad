//! The slider of a parameter or an angle, with its name and its value.

use crate::app::panels::stepping::{SliderStep, step_with_arrows};
use crate::app::panels::tooltip_right::TooltipRight as _;
use crate::app::platform;
use crate::app::text::estimate::estimate_text;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::numbers::significant;
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use egui::{DragValue, Response, Slider, SliderClamping, Ui};
use pbrdf::fit::FitResult;
use pbrdf::model::Parameter;
use pbrdf::optics::shortest;
use std::cell::RefCell;
use std::ops::RangeInclusive;
use tr::tr;

/// Name, slider, typed value with unit, of those widths; with what the shown fit says of it where
/// the pointer rests, and for screen readers.
pub fn slider_ui(
    surface: &mut Surface,
    refusals: &mut Vec<String>,
    range: RangeInclusive<f64>,
    [slider_width, value_width]: [f32; 2],
    fit: Option<&FitResult>,
    ui: &mut Ui,
    parameter: Parameter,
) {
    ui.spacing_mut().slider_width = slider_width;
    let outside = !range.contains(&surface.parameters[parameter]);
    let help = tr!(
        "{0} {1}: {2}\nSlider from {3} to {4}; a double click resets it, arrow keys step it, with Shift by a tenth.",
        translated(parameter.name()),
        parameter.symbol(),
        translated(parameter.help()),
        range.start(),
        range.end()
    );
    let estimate = fit.and_then(|fit| fit.estimates.iter().find(|estimate| estimate.parameter == parameter && estimate.free));
    let estimate = estimate.map(estimate_text);
    let help = estimate.iter().fold(help, |help, estimate| format!("{help}\n{estimate}"));
    let label = name_ui(ui, parameter.symbol(), &help);

    let tie = surface.tie_of(parameter);
    let value = &mut surface.parameters[parameter];
    let before = *value;
    let mut slider = Slider::new(value, range.clone()).show_value(false).clamping(SliderClamping::Never);
    if parameter.is_logarithmic() {
        slider = slider.logarithmic(true).smallest_positive(1e-3);
    }
    let is_tied = tie.is_some();
    let slider = ui.add_enabled(!is_tied, slider).labelled_by(label.id).on_hover_right(ui, help.as_str());
    let step = if parameter.is_logarithmic() { SliderStep::OfSize } else { SliderStep::over(&range) };
    step_with_arrows(ui, &slider, before, value, &range, step);
    if is_double_clicked(ui, &[&label, &slider]) {
        *value = parameter.default_value();
    }
    let spoken = format!("{} {}", significant(*value), parameter.unit());
    say_value(&slider, spoken.trim_end());

    // What the formulas do not allow is not taken; what only the slider cannot show is.
    let domain = parameter.domain();
    let speed = (0.005 * value.abs()).max(1e-4);
    let refused = RefCell::new(None);
    let written = RefCell::new(None);
    let refuse = |found: &str| {
        *refused.borrow_mut() = Some(tr!("{0}: found {1}, expected {2}.", parameter.symbol(), format!("{found:?}"), domain.localized()));
    };
    let typed = DragValue::from_get_set(|new| {
        match new {
            // Text as it was shown means the value as it was, with all its digits.
            Some(new) if significant(new) == significant(*value) => {}
            Some(new) if domain.contains(new) => *value = new,
            // As it was written; a drag and a screen reader write nothing.
            Some(new) => refuse(&written.take().unwrap_or_else(|| shortest(new))),
            None => {}
        }
        *value
    });
    let parse = |text: &str| {
        let parsed = number_from_text(text, parameter.unit());
        if parsed.is_none() {
            refuse(text);
        }
        written.replace(Some(text.trim().to_owned()));
        parsed
    };
    let unit = parameter.unit();
    let suffix = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let typed = typed.speed(speed).custom_formatter(|value, _| significant(value)).custom_parser(parse).update_while_editing(false);
    let typed = ui
        .scope(|ui| {
            if is_tied {
                ui.disable();
            }
            keep_focus(ui.add_sized([value_width, 20.0], typed.suffix(suffix)))
        })
        .inner;
    let help = if outside {
        tr!("outside the slider's range {0} to {1}", range.start(), range.end())
    } else {
        tr!("type a value: {}", domain.localized())
    };
    let help = estimate.iter().fold(help, |help, estimate| format!("{help}\n{estimate}"));
    typed.labelled_by(label.id).on_hover_right(ui, help);

    if let Some(sentence) = refused.into_inner() {
        refusals.push(sentence);
    }
}

/// Tells screen readers the value with its unit, which a slider does not.
fn say_value(slider: &Response, value: &str) {
    slider.ctx.accesskit_node_builder(slider.id, |node| node.set_value(value));
}

/// An angle of the direction that lobes are seen at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DirectionAngle {
    ThetaI,
    Dphi,
}

impl DirectionAngle {
    pub const ALL: [Self; 2] = [Self::ThetaI, Self::Dphi];

    pub fn symbol(self) -> &'static str {
        match self {
            Self::ThetaI => "θi",
            Self::Dphi => "Δφ",
        }
    }

    fn help(self) -> String {
        match self {
            Self::ThetaI => tr!("Angle of incidence of the lobes, degrees"),
            Self::Dphi => tr!("Relative azimuth φr − φi, degrees: 180 is the forward side of the plane of incidence"),
        }
    }

    fn range(self) -> RangeInclusive<f64> {
        match self {
            Self::ThetaI => 0.0..=89.9,
            Self::Dphi => 0.0..=360.0,
        }
    }

    fn default(self, settings: &Settings) -> f64 {
        match self {
            Self::ThetaI => settings.theta_i,
            Self::Dphi => settings.dphi,
        }
    }
}

/// Name, slider of that width and typed value of an angle.
pub fn angle_ui(of: DirectionAngle, angle: &mut f64, slider_width: f32, ui: &mut Ui) {
    let (help, range, before) = (of.help(), of.range(), *angle);
    let label = name_ui(ui, of.symbol(), &help);
    ui.spacing_mut().slider_width = slider_width;
    let slider = Slider::new(angle, range.clone()).show_value(false).step_by(0.5).clamping(SliderClamping::Never);
    let slider = ui.add(slider).labelled_by(label.id).on_hover_right(ui, help);
    say_value(&slider, &format!("{}°", significant(*angle)));
    step_with_arrows(ui, &slider, before, angle, &range, SliderStep::Fixed(0.5));
    if is_double_clicked(ui, &[&label, &slider]) {
        *angle = of.default(&Settings::default());
    }
    let typed = DragValue::new(angle).range(range).clamp_existing_to_range(false).speed(0.1).max_decimals(3).suffix("°");
    keep_focus(ui.add(typed)).labelled_by(label.id);
}

/// Enter takes a typed value and leaves the field where it is: Tab goes on from there. The keyboard of a tablet, which covers the plots, goes.
fn keep_focus(typed: Response) -> Response {
    if !platform::has_fingers() && typed.lost_focus() && typed.ctx.input(|input| input.key_pressed(egui::Key::Enter)) {
        typed.request_focus();
    }
    typed
}

/// The name of a slider; a double click on it resets what it names.
pub fn name_ui(ui: &mut Ui, name: &str, help: &str) -> egui::Response {
    // Clicks alone: a stop on the way of the Tab key would be one too many.
    ui.add(egui::Label::new(name).selectable(false).sense(egui::Sense::CLICK)).on_hover_right(ui, help)
}

/// Whether any of them was clicked twice; a slider senses drags alone.
pub fn is_double_clicked(ui: &Ui, responses: &[&egui::Response]) -> bool {
    let twice = ui.input(|input| input.pointer.button_double_clicked(egui::PointerButton::Primary));
    twice && responses.iter().any(|response| response.contains_pointer())
}

/// A number as a person types it: with a decimal comma or point, with or without its unit.
pub fn number_from_text(text: &str, unit: &str) -> Option<f64> {
    // The window shows a typographic minus.
    let text = text.trim().trim_end_matches(unit).trim().replace('−', "-");
    let number = if text.contains('.') { text.parse() } else { text.replacen(',', ".", 1).parse() };
    number.ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::number_from_text;

    #[test]
    fn numbers_are_read_as_people_type_them() {
        for (text, expected) in [
            ("0,25", Some(0.25)),
            (" 0.25 rad", Some(0.25)),
            ("−3", Some(-3.0)),
            ("1e5", Some(1e5)),
            ("0.25abc", None),
            ("abc", None),
            ("1.2,3", None),
            ("inf", None),
            ("", None),
        ] {
            assert_eq!(number_from_text(text, "rad"), expected, "{text:?}");
        }
    }
}
