//! Tooltips beside a panel: below a control they would cover the rows that come next.

use egui::{Id, Rect, RectAlign, Response, Tooltip, Ui};

/// Whether the pointer dragged the control and is still on it: then the plots are looked at, and no
/// text comes before them.
fn was_dragged(response: &Response) -> bool {
    let key = Id::unique("dragged last");
    if response.dragged() {
        response.ctx.data_mut(|data| data.insert_temp(key, response.id));
        return true;
    }
    let is_last = response.ctx.data(|data| data.get_temp::<Id>(key)) == Some(response.id);
    if is_last && !response.contains_pointer() {
        response.ctx.data_mut(|data| data.insert_temp(key, Id::NULL));
    }
    is_last && response.contains_pointer()
}

/// A control of a panel on the left.
pub trait TooltipRight {
    /// Shows this text right of the panel while the pointer is on the control.
    fn on_hover_right(self, ui: &Ui, text: impl Into<String>) -> Self;
}

impl TooltipRight for Response {
    fn on_hover_right(self, ui: &Ui, text: impl Into<String>) -> Self {
        let text = text.into();
        if self.ctx.has_accesskit_node(self.id) {
            self.ctx.accesskit_node_builder(self.id, |node| node.set_description(text.as_str()));
        }
        if was_dragged(&self) {
            return self;
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
