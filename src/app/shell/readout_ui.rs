//! What the model says at places that a lesson or a talk names, in a line.

use crate::app::views::derived::Derived;
use egui::{Role, Ui, WidgetInfo};

/// What the model says where it is read out.
pub fn readout_ui(derived: &Derived, ui: &mut Ui) {
    let Some(text) = derived.readout() else { return };
    let label = ui.add(egui::Label::new(egui::RichText::new(text).strong()).truncate());
    label.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
}
