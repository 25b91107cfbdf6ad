//! The nine parameters, grouped by lobe, and where the lobes are looked at.

use crate::app::panels::list_row::button_width;
use crate::app::panels::parameter_slider::{DirectionAngle, angle_ui, number_from_text, slider_ui};
use crate::app::panels::sharing::{shared_of, shared_ui, sharing_ui};
use crate::app::panels::ties::tie_ui;
use crate::app::panels::tooltip_right::TooltipRight as _;
use crate::app::plots::theme;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::numbers::significant;
use crate::app::views::action::{Action, ListAction};
use crate::app::views::{Cx, note_stop};
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::surface::{Surface, another};
use egui::{DragValue, Grid, Role, Ui, WidgetInfo};
use pbrdf::fit::FitResult;
use pbrdf::model::{Diffuse, Model, PRESETS, Parameter, ParameterSet, Parameters, PerParameter, Preset};
use pbrdf::optics::{Masking, SlopeDistribution};
use std::cell::RefCell;
use std::ops::RangeInclusive;
use tr::tr;

/// What sliders reach.
type SliderRanges = PerParameter<RangeInclusive<f64>>;

/// The panel; what is refused, and why, is added to `refusals`.
pub fn parameters_ui(cx: &mut Cx<'_>, refusals: &mut Vec<String>, ranges: &SliderRanges, ui: &mut Ui) {
    let before = cx.work.surface();
    let mut surface = before.clone();
    let shared_before = shared_of(cx.work);
    let mut shared = shared_before;
    let show_bounds = cx.work.settings().show_bounds;
    egui::ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        ui.add_space(4.0);
        let is_wide = ui.available_width() >= WIDE;
        if !is_wide {
            model_ui(cx, &mut surface, &mut shared, ui);
            ui.separator();
        }
        let fit = cx.work.shown_fit().map(|fit| &fit.report);
        let mut sliders = Sliders { surface: &mut surface, shared: &mut shared, show_bounds, refusals, ranges, fit, is_wide };
        if is_wide {
            ui.columns(2, |columns| {
                specular_ui(&mut sliders, &mut columns[0]);
                diffuse_ui(&mut sliders, &mut columns[1]);
                volume_ui(&mut sliders, &mut columns[1]);
                geometry_ui(cx, &mut columns[0]);
            });
            ui.separator();
            model_ui(cx, &mut surface, &mut shared, ui);
        } else {
            specular_ui(&mut sliders, ui);
            diffuse_ui(&mut sliders, ui);
            volume_ui(&mut sliders, ui);
            geometry_ui(cx, ui);
        }
        ui.add_space(4.0);
        if ui.button(tr!("Reset all parameters")).on_hover_right(ui, tr!("All nine parameters to their defaults")).clicked() {
            surface.parameters = Parameters::default();
        }
    });
    if surface != *before {
        cx.edits.push(Edit::SetSurface(Box::new(surface)));
    }
    if shared != shared_before {
        cx.edits.extend(shared.map(Edit::Share));
    }
}

/// Width in points from which groups stand side by side, before the choice of the model: under a pane of a phone, such a panel is three or
/// four sliders high.
const WIDE: f32 = 760.0;

/// Which terms there are, what surfaces share, and the switch of the bounds.
fn model_ui(cx: &mut Cx<'_>, surface: &mut Surface, shared: &mut Option<ParameterSet>, ui: &mut Ui) {
    preset_ui(cx.work.preset(), surface, ui);
    shared.iter_mut().for_each(|shared| sharing_ui(shared, ui));
    bounds_switch_ui(cx, surface, ui);
}

/// What the groups of sliders share.
struct Sliders<'a> {
    /// A copy, which becomes an edit.
    surface: &'a mut Surface,
    /// The parameters that all measurements share, where there are several.
    shared: &'a mut Option<ParameterSet>,
    show_bounds: bool,
    refusals: &'a mut Vec<String>,
    ranges: &'a SliderRanges,
    /// Of the active measurement.
    fit: Option<&'a FitResult>,
    /// Whether the switch of a lobe and its kinds have room in one line.
    is_wide: bool,
}

/// Widths in points.
#[derive(Clone, Copy)]
struct Room {
    slider: f32,
    value: f32,
    /// Of any column.
    least: f32,
}

/// Least width of a column, and of a slider, in points.
const LEAST: f32 = 27.0;
const SHORTEST_SLIDER: f32 = 56.0;
/// The same beside a switch between shared and own, where the panel is narrow.
const SHORTEST_BESIDE_SWITCH: f32 = 30.0;
/// What a row has beside slider, value and names: lock, reset, the switch between shared and own, the gaps.
const LOCK: f32 = 58.0;
const RESET: f32 = 27.0;
const SHARED: f32 = 56.0;
const GAPS: f32 = 15.0;

impl Room {
    /// Of a row in a panel of that width: what is left is the slider's.
    fn of(width: f32, beside_switch: bool) -> Self {
        let value = if beside_switch { 88.0 } else { 92.0 };
        let rest = width - LEAST - value - LOCK - RESET - GAPS - if beside_switch { SHARED } else { 0.0 };
        let shortest = if beside_switch { SHORTEST_BESIDE_SWITCH } else { SHORTEST_SLIDER };
        Self { slider: rest.clamp(shortest, 420.0), value, least: LEAST }
    }
}

/// Width from which the list of models has its label in front.
const WITH_LABEL: f32 = 312.0;

/// Height of the list of models, in points: all of them are seen.
const LIST: f32 = 320.0;

/// The named models; whatever the switches below say, if they match none.
fn preset_ui(current: Option<&Preset>, surface: &mut Surface, ui: &mut Ui) {
    ui.horizontal(|ui| {
        // In a narrow panel the name of the model has the room.
        let label = (ui.available_width() > WITH_LABEL).then(|| ui.label(tr!("Model")));
        let combo = egui::ComboBox::from_id_salt("preset")
            .height(LIST)
            .truncate()
            .width((ui.available_width() - ui.spacing().item_spacing.x).max(120.0))
            .selected_text(current.map_or_else(|| tr!("as switched below"), |preset| translated(preset.name)));
        let response = combo.show_ui(ui, |ui| {
            for preset in &PRESETS {
                let chosen = current.is_some_and(|current| current.key == preset.key);
                if ui.selectable_label(chosen, translated(preset.name)).on_hover_text(translated(preset.citation)).clicked() {
                    surface.model = preset.model.with_dolp_formula(surface.model.dolp_formula);
                }
            }
        });
        note_stop(ui.ctx(), response.response.id);
        let response = match label {
            Some(label) => response.response.labelled_by(label.id),
            None => {
                let chosen = current.map_or_else(String::new, |preset| translated(preset.name));
                response.response.widget_info(|| WidgetInfo {
                    current_text_value: Some(chosen.clone()),
                    ..WidgetInfo::labeled(Role::ComboBox, true, tr!("Model"))
                });
                response.response
            }
        };
        response.on_hover_right(ui, current.map_or_else(|| tr!("a set of terms without a name"), |preset| translated(preset.citation)));
    });
}

fn bounds_switch_ui(cx: &mut Cx<'_>, surface: &mut Surface, ui: &mut Ui) {
    ui.horizontal(|ui| {
        cx.switch_ui(Switch::Bounds, tr!("Bounds and ties"), ui).on_hover_right(
            ui,
            tr!("Under each slider the box that fits stay in, and what the parameter is tied to; without bounds of its own it has its slider's range"),
        );
        if !surface.bounds.is_empty() {
            let reset = ui.button(RESET_ICON).on_hover_right(ui, tr!("All bounds back to the sliders' ranges"));
            reset.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Reset bounds")));
            if reset.clicked() {
                surface.bounds.clear();
            }
        }
        pin_ui(cx, surface, ui);
    });
}

/// Buttons that pin the surface, and the same with the other distribution.
fn pin_ui(cx: &mut Cx<'_>, surface: &Surface, ui: &mut Ui) {
    let other = surface.model.specular.then(|| match another(surface.model.distribution) {
        SlopeDistribution::Gauss => tr!("Pin Gauss"),
        SlopeDistribution::Cauchy => tr!("Pin Cauchy"),
    });
    let gap = ui.spacing().item_spacing.x;
    let width = |text: &str| button_width(text, ui);
    let room = width(&tr!("Pin")) + other.as_ref().map_or(0.0, |other| gap + width(other));
    // Widths are rounded: a row that is wider than the panel would widen it, frame by frame.
    ui.add_space((ui.available_width() - room - 2.0).max(0.0));
    if ui
        .button(tr!("Pin"))
        .on_hover_right(ui, tr!("Keeps this surface as it is, and draws it in every plot until it is removed"))
        .clicked()
    {
        cx.actions.push(Action::List(ListAction::PinSliders));
    }
    let help = tr!("Pins the same surface with the other distribution of slopes, at equal median slope");
    if other.is_some_and(|other| ui.button(other).on_hover_right(ui, help).clicked()) {
        cx.actions.push(Action::List(ListAction::PinOtherDistribution));
    }
}

fn specular_ui(sliders: &mut Sliders<'_>, ui: &mut Ui) {
    let surface = &mut *sliders.surface;
    let switch_ui = |model: &mut Model, ui: &mut Ui| {
        ui.checkbox(&mut model.specular, tr!("Specular lobe"))
            .on_hover_right(ui, tr!("Torrance–Sparrow facets with complex Fresnel reflection, Eqs. (4–10): the only lobe that polarises"));
    };
    let is_in_line = sliders.is_wide && surface.model.specular;
    if !is_in_line {
        ui.horizontal(|ui| switch_ui(&mut surface.model, ui));
    }
    if surface.model.specular {
        ui.horizontal(|ui| {
            if is_in_line {
                switch_ui(&mut surface.model, ui);
            }
            for (distribution, name) in [(SlopeDistribution::Gauss, tr!("Gauss")), (SlopeDistribution::Cauchy, tr!("Cauchy"))] {
                ui.radio_value(&mut surface.model.distribution, distribution, name).on_hover_right(
                    ui,
                    match distribution {
                        SlopeDistribution::Gauss => tr!("Gaussian facet slopes, Eq. (5): Beckmann"),
                        SlopeDistribution::Cauchy => tr!("Hyper-Cauchy facet slopes, Eq. (7): q = 2 is GGX"),
                    },
                );
            }
            let mut masks = surface.model.masking == Masking::VGroove;
            ui.checkbox(&mut masks, tr!("Masking")).on_hover_right(ui, tr!("V-groove masking–shadowing, Eq. (6)"));
            surface.model.masking = if masks { Masking::VGroove } else { Masking::None };
        });
        let mut shown = vec![Parameter::N, Parameter::K, Parameter::Sigma, Parameter::Ks];
        if surface.model.distribution == SlopeDistribution::Cauchy {
            shown.push(Parameter::Q);
        }
        sliders_ui(sliders, ui, "specular", &shown);
    }
    ui.separator();
}

fn diffuse_ui(sliders: &mut Sliders<'_>, ui: &mut Ui) {
    let surface = &mut *sliders.surface;
    let switch_ui = |model: &mut Model, ui: &mut Ui| {
        let mut present = model.diffuse != Diffuse::Absent;
        let switch = ui
            .checkbox(&mut present, tr!("Diffuse lobe"))
            .on_hover_right(ui, tr!("Minnaert, Eq. (12), or one of its relatives: depolarises"));
        if switch.changed() {
            model.diffuse = if present { Diffuse::Minnaert } else { Diffuse::Absent };
        }
    };
    let is_in_line = sliders.is_wide && surface.model.diffuse != Diffuse::Absent;
    if !is_in_line {
        switch_ui(&mut surface.model, ui);
    }
    if surface.model.diffuse != Diffuse::Absent {
        ui.horizontal(|ui| {
            if is_in_line {
                switch_ui(&mut surface.model, ui);
            }
            ui.radio_value(&mut surface.model.diffuse, Diffuse::Minnaert, tr!("Minnaert")).on_hover_right(ui, "(cos θi cos θr)^c / π");
            ui.radio_value(&mut surface.model.diffuse, Diffuse::Lambert, tr!("Lambert")).on_hover_right(ui, tr!("1/π in all directions: c = 0"));
            ui.radio_value(&mut surface.model.diffuse, Diffuse::Hyde, tr!("Hyde"))
                .on_hover_right(ui, tr!("k_s (1 − ρ(θi))/π, where ρ is the share of the light that the specular lobe would send back if its facets reflected all: what is lost comes back without polarisation. The factor k_s is a choice of this program; no parameter of its own"));
        });
        let shown: &[Parameter] = match surface.model.diffuse {
            Diffuse::Absent | Diffuse::Hyde => &[],
            Diffuse::Lambert => &[Parameter::Kd],
            Diffuse::Minnaert => &[Parameter::Kd, Parameter::C],
        };
        sliders_ui(sliders, ui, "diffuse", shown);
    }
    ui.separator();
}

fn volume_ui(sliders: &mut Sliders<'_>, ui: &mut Ui) {
    let surface = &mut *sliders.surface;
    ui.checkbox(&mut surface.model.volume, tr!("Volume lobe"))
        .on_hover_right(ui, tr!("Gaussian in θr around the normal, Eq. (13): depolarises, and is not reciprocal"));
    if surface.model.volume {
        sliders_ui(sliders, ui, "volume", &[Parameter::Kv, Parameter::SigmaV]);
    }
    ui.separator();
}

fn geometry_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    ui.strong(tr!("Lobes are seen at"));
    let before = [cx.work.settings().theta_i, cx.work.settings().dphi];
    let mut angles = before;
    let width = Room::of(ui.available_width(), false).slider;
    Grid::new("geometry").num_columns(3).min_col_width(LEAST).show(ui, |ui| {
        for (of, angle) in DirectionAngle::ALL.into_iter().zip(&mut angles) {
            angle_ui(of, angle, width, ui);
            ui.end_row();
        }
    });
    if angles != before {
        let [theta_i, dphi] = angles;
        cx.edits.push(Edit::SetDirection { theta_i, dphi });
    }
}

fn sliders_ui(sliders: &mut Sliders<'_>, ui: &mut Ui, id: &str, parameters: &[Parameter]) {
    let Sliders { surface, shared, show_bounds, refusals, ranges, fit, is_wide: _ } = sliders;
    let room = Room::of(ui.available_width(), shared.is_some());
    Grid::new(id).num_columns(if shared.is_some() { 6 } else { 5 }).min_row_height(20.0).min_col_width(room.least).show(ui, |ui| {
        for &parameter in parameters {
            slider_ui(surface, refusals, ranges[parameter].clone(), [room.slider, room.value], *fit, ui, parameter);
            let is_outside = !ranges[parameter].contains(&surface.parameters[parameter]);
            lock_and_reset_ui(surface, is_outside, ui, parameter);
            shared.iter_mut().for_each(|shared| shared_ui(shared, parameter, ui));
            ui.end_row();
            if *show_bounds {
                bounds_ui(surface, refusals, room, ui, parameter);
                ui.end_row();
                tie_ui(surface, refusals, [room.slider, room.value], ui, parameter);
                ui.end_row();
            }
        }
    });
}

/// The way back to a default; a tooltip says to which.
const RESET_ICON: &str = "↺";

/// Whether a fit leaves the parameter alone, and the way back to its default.
fn lock_and_reset_ui(surface: &mut Surface, outside: bool, ui: &mut Ui, parameter: Parameter) {
    if let Some(tie) = surface.tie_of(parameter) {
        let text =
            if tie.factor == 1.0 { format!("= {}", tie.to.symbol()) } else { format!("= {} {}", significant(tie.factor), tie.to.symbol()) };
        ui.weak(text).on_hover_right(ui, tr!("{} is tied: untie it under Bounds and ties", parameter.symbol()));
        ui.label("");
        return;
    }
    let mut locked = surface.locked.contains(parameter);
    let lock = ui.checkbox(&mut locked, tr!("fixed")).on_hover_right(ui, tr!("{} stays as it is in a fit", parameter.symbol()));
    lock.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, locked, tr!("Fix {}", parameter.key())));
    if lock.changed() {
        surface.locked = if locked { surface.locked.with(parameter) } else { surface.locked.without(parameter) };
    }

    let is_default = surface.parameters[parameter] == parameter.default_value();
    let color = if outside { theme::warning(ui.visuals().dark_mode) } else { ui.visuals().text_color() };
    let reset = ui.add_enabled(!is_default, egui::Button::new(egui::RichText::new(RESET_ICON).color(color))).on_hover_right(
        ui,
        if outside {
            tr!("back to {}: the value is outside the slider's range", parameter.default_value())
        } else {
            tr!("back to {}", parameter.default_value())
        },
    );
    reset.widget_info(|| WidgetInfo::labeled(Role::Button, !is_default, tr!("Reset {}", parameter.key())));
    if reset.clicked() {
        surface.parameters[parameter] = parameter.default_value();
    }
}

/// The lower bound under the slider, the upper one under the value.
fn bounds_ui(surface: &mut Surface, refusals: &mut Vec<String>, room: Room, ui: &mut Ui, parameter: Parameter) {
    let (low, high) = surface.bounds_of(parameter);
    let own = surface.has_own_bounds(parameter);
    let color = if own { ui.visuals().text_color() } else { ui.visuals().weak_text_color() };
    let mut wanted = (low, high);
    let refused = RefCell::new(None);
    ui.label("");
    for (value, name, sign, width) in
        [(&mut wanted.0, tr!("Lower bound"), "≥ ", room.slider.min(room.value)), (&mut wanted.1, tr!("Upper bound"), "≤ ", room.value)]
    {
        let before = *value;
        let parse = |text: &str| {
            let parsed = number_from_text(text.trim().trim_start_matches(sign.trim()), parameter.unit());
            if parsed.is_none() {
                *refused.borrow_mut() =
                    Some(tr!("{0} of {1}: found {2}, expected a number.", name, parameter.symbol(), format!("{text:?}")));
            }
            parsed
        };
        let field = DragValue::from_get_set(|new| {
            match new {
                // Text as it was shown means the value as it was, with all its digits.
                Some(new) if significant(new) != significant(*value) => *value = new,
                _ => {}
            }
            *value
        });
        let field = field.speed((0.005 * before.abs()).max(1e-3)).custom_formatter(|value, _| significant(value)).custom_parser(parse);
        let response = ui
            .scope(|ui| {
                ui.visuals_mut().override_text_color = Some(color);
                ui.add_sized([width, 18.0], field.update_while_editing(false).prefix(sign))
            })
            .inner;
        response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, tr!("{0} of {1}", name, parameter.key())));
        response.on_hover_right(ui, tr!("{0} of {1} in fits: {2}", name, parameter.symbol(), parameter.domain().localized()));
    }
    if wanted != (low, high)
        && let Err(error) = surface.set_bounds(parameter, wanted.0, wanted.1)
    {
        refusals.push(tr!("The bounds stay as they are: {}.", error.localized()));
    }
    if let Some(sentence) = refused.into_inner() {
        refusals.push(sentence);
    }
    ui.label("");
    let reset = ui.add_enabled(own, egui::Button::new(RESET_ICON)).on_hover_right(ui, tr!("back to the slider's range"));
    reset.widget_info(|| WidgetInfo::labeled(Role::Button, own, tr!("Reset bounds of {}", parameter.key())));
    if reset.clicked() {
        surface.reset_bounds(parameter);
    }
}
