//! What several measurements share: a choice in the user's words, and a switch for each parameter.

use crate::app::panels::tooltip_right::TooltipRight as _;
use crate::app::text::i18n::translated;
use crate::app::work::sharing::Sharing;
use crate::app::work::workspace::Workspace;
use egui::{Button, ComboBox, Role, Ui, WidgetInfo};
use pbrdf::model::{Parameter, ParameterSet};
use tr::tr;

/// The shared parameters where there are several measurements; elsewhere nobody is to see the word.
pub fn shared_of(work: &Workspace) -> Option<ParameterSet> {
    let list = work.measurements();
    (list.measured().count() > 1).then(|| list.shared())
}

/// Width from which the choice has its label in front.
const WITH_LABEL: f32 = 360.0;

/// The choice between the three cases that have a name.
pub fn sharing_ui(shared: &mut ParameterSet, ui: &mut Ui) {
    let current = Sharing::of(*shared);
    ui.horizontal(|ui| {
        // In a narrow panel the choice has the room.
        let label = (ui.available_width() > WITH_LABEL).then(|| ui.label(tr!("Measurements of")));
        let combo = ComboBox::from_id_salt("sharing")
            .truncate()
            .width(ui.available_width() - 8.0)
            .selected_text(current.map_or_else(|| tr!("as chosen below"), |sharing| translated(sharing.name())));
        let response = combo.show_ui(ui, |ui| {
            for sharing in Sharing::ALL {
                let button = ui.selectable_label(current == Some(sharing), translated(sharing.name()));
                if button.on_hover_text(translated(sharing.help())).clicked() {
                    *shared = sharing.shared();
                }
            }
        });
        let help = current.map_or_else(|| tr!("some parameters are shared, others own"), |sharing| translated(sharing.help()));
        let response = match label {
            Some(label) => response.response.labelled_by(label.id),
            None => {
                let chosen = current.map_or_else(String::new, |sharing| translated(sharing.name()));
                response.response.widget_info(|| WidgetInfo {
                    current_text_value: Some(chosen.clone()),
                    ..WidgetInfo::labeled(Role::ComboBox, true, tr!("Measurements of"))
                });
                response.response
            }
        };
        response.on_hover_right(ui, help);
    });
}

/// Whether all measurements share the parameter.
pub fn shared_ui(shared: &mut ParameterSet, parameter: Parameter, ui: &mut Ui) {
    let is_shared = shared.contains(parameter);
    let text = egui::RichText::new(if is_shared { tr!("shared") } else { tr!("own") });
    let text = if is_shared { text } else { text.weak() };
    let help = if is_shared {
        tr!("{} is one and the same for all measurements; a click gives each its own", parameter.symbol())
    } else {
        tr!("each measurement has its own {}; a click makes it one for all", parameter.symbol())
    };
    let button = Button::new(text).selected(is_shared).min_size(egui::vec2(WIDTH, 0.0));
    let place = |ui: &mut Ui| {
        // The longer word keeps to the width.
        ui.spacing_mut().button_padding.x = 4.0;
        ui.add(button)
    };
    let button = ui.scope(place).inner.on_hover_right(ui, help);
    button.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, is_shared, tr!("Share {}", parameter.key())));
    if button.clicked() {
        *shared = if is_shared { shared.without(parameter) } else { shared.with(parameter) };
    }
}

/// Of the switch, in points: that of the longer word.
const WIDTH: f32 = 50.0;
