//! Words that are explained where they stand: dotted under, with their meaning where the pointer
//! rests or clicks.

use egui::{CursorIcon, Label, Popup, Response, Sense, Shape};

/// From dot to dot, and their radius, in points.
const SPACING: f32 = 3.5;
const RADIUS: f32 = 0.7;
/// Width of what is shown after a click.
const WIDTH: f32 = 360.0;

/// A label that says what its word means.
pub trait Explained {
    /// Dots under it; its meaning for who rests the pointer there, clicks or listens.
    fn explained(self, meaning: impl AsRef<str>) -> Response;
}

impl Explained for Response {
    fn explained(self, meaning: impl AsRef<str>) -> Response {
        let meaning = meaning.as_ref();
        // Clicks alone: a stop on the way of the Tab key would be one too many.
        let response = self.interact(Sense::CLICK).on_hover_cursor(CursorIcon::Help);
        let ends = [response.rect.left_bottom(), response.rect.right_bottom()];
        let color = response.ctx.global_style().visuals.weak_text_color();
        let painter = response.ctx.layer_painter(response.layer_id).with_clip_rect(response.interact_rect.expand(2.0));
        painter.extend(Shape::dotted_line(&ends, color, SPACING, RADIUS));
        response.ctx.accesskit_node_builder(response.id, |node| node.set_description(meaning));
        Popup::from_toggle_button_response(&response).show(|ui| {
            ui.set_max_width(WIDTH);
            ui.add(Label::new(meaning).wrap());
        });
        response.on_hover_text(meaning)
    }
}

#[cfg(test)]
mod tests {
    use super::Explained as _;
    use egui_kittest::{
        Harness,
        kittest::{NodeT as _, Queryable as _},
    };

    #[test]
    fn a_click_shows_what_a_word_means_and_screen_readers_are_told() {
        let mut harness = Harness::new_ui(|ui| _ = ui.label("AICc").explained("Akaike's criterion."));
        harness.run();
        assert_eq!(harness.get_by_label("AICc").accesskit_node().description().as_deref(), Some("Akaike's criterion."));
        assert!(harness.query_by_label("Akaike's criterion.").is_none());
        harness.get_by_label("AICc").click();
        harness.run();
        assert!(harness.query_by_label("Akaike's criterion.").is_some());
    }
}
