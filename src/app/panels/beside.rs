//! Tooltips beside a panel: below a control they would cover the rows that come next.

use egui::{Rect, RectAlign, Response, Tooltip, Ui};

/// A control of a panel on the left.
pub trait Beside {
    /// Shows this text right of the panel while the pointer is on the control.
    fn on_hover_beside(self, ui: &Ui, text: impl Into<String>) -> Self;
}

impl Beside for Response {
    fn on_hover_beside(self, ui: &Ui, text: impl Into<String>) -> Self {
        let text = text.into();
        if self.ctx.has_accesskit_node(self.id) {
            self.ctx.accesskit_node_builder(self.id, |node| node.set_description(text.as_str()));
        }
        // As if the control reached to the panel's edge.
        let right = ui.clip_rect().right().max(self.rect.right());
        let row = Rect::from_x_y_ranges(self.rect.left()..=right, self.rect.y_range());
        let mut tooltip = Tooltip::for_enabled(&self);
        tooltip.popup = tooltip.popup.anchor(row).align(RectAlign::RIGHT_START);
        tooltip.show(|ui| {
            ui.set_max_width(ui.spacing().tooltip_width);
            ui.add(egui::Label::new(text))
        });
        self
    }
}
