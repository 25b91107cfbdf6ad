//! What a parameter is tied to: under its slider, beside its bounds.

use crate::app::panels::tooltip_right::TooltipRight as _;
use crate::app::text::localized::Localized as _;
use crate::app::work::surface::Surface;
use egui::{ComboBox, DragValue, Role, Ui, WidgetInfo};
use pbrdf::fit::Tie;
use pbrdf::model::Parameter;
use tr::tr;

/// What a combo box adds to its width: margins and the arrow.
const ARROW: f32 = 40.0;

/// The factor under the slider, the other parameter under the value; widths of both in points.
pub fn tie_ui(surface: &mut Surface, refusals: &mut Vec<String>, [factor_width, width]: [f32; 2], ui: &mut Ui, parameter: Parameter) {
    let before = surface.tie_of(parameter);
    let mut tie = before;
    ui.label("");
    match &mut tie {
        Some(tie) => {
            let field = DragValue::new(&mut tie.factor).speed(0.01).suffix(" ×").max_decimals(6).update_while_editing(false);
            let field = ui.add_sized([factor_width, 18.0], field);
            field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, tr!("Factor of the tie of {}", parameter.key())));
        }
        None => {
            ui.label("");
        }
    }
    let text = before.map_or_else(|| tr!("not tied"), |tie| tie.to.symbol().to_owned());
    let combo = ComboBox::from_id_salt(("tie", parameter.key())).width(width - ARROW).selected_text(text).show_ui(ui, |ui| {
        ui.selectable_value(&mut tie, None, tr!("not tied"));
        let others = surface.model.parameters().without(parameter);
        for to in others.iter() {
            let this = Tie { parameter, factor: before.map_or(1.0, |tie| tie.factor), to };
            if ui.selectable_label(before.is_some_and(|tie| tie.to == to), format!("= {}", to.symbol())).clicked() {
                tie = Some(this);
            }
        }
    });
    let name = tr!("Tie of {}", parameter.key());
    combo.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, &name));
    combo.response.on_hover_right(ui, tr!("{} can be another parameter, times a factor: it is no unknown of a fit", parameter.symbol()));
    if tie != before
        && let Err(error) = surface.set_tie(parameter, tie)
    {
        refusals.push(tr!("The ties stay as they are: {}.", error.localized()));
    }
}
