//! What the lines of a plot mean, in a line above it: nothing is hidden there, and a broken line is told from a whole one.

use egui::{Align2, Color32, FontId, Role, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};
use egui_plot::LineStyle;

/// A name with the look of its line.
pub struct KeyEntry {
    pub name: String,
    pub color: Color32,
    pub style: LineStyle,
    pub width: f32,
}

/// Size of the letters, length of a sample, and what is free around it.
const LETTERS: f32 = 12.0;
const SAMPLE: f32 = 24.0;
const GAP: f32 = 5.0;
const BETWEEN: f32 = 10.0;
/// Length of a gap over that of a dash, as the plots have it.
const GAP_OVER_DASH: f32 = 0.618;

/// Names with samples of their lines; none is torn at the end of a line.
pub fn key_line_ui(entries: &[KeyEntry], ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(BETWEEN, 0.0);
        for KeyEntry { name, color, style, width } in entries {
            let ink = ui.visuals().text_color();
            let galley = ui.painter().layout_no_wrap(name.clone(), FontId::proportional(LETTERS), ink);
            let (rect, response) = ui.allocate_exact_size(vec2(SAMPLE + GAP, 0.0) + galley.size(), Sense::hover());
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
            let ends = [rect.left_center(), rect.left_center() + vec2(SAMPLE, 0.0)];
            let stroke = Stroke::new(*width, *color);
            let shapes = match *style {
                LineStyle::Solid => vec![Shape::line_segment(ends, stroke)],
                LineStyle::Dashed { length } => Shape::dashed_line(&ends, stroke, length, GAP_OVER_DASH * length),
                LineStyle::Dotted { spacing } => Shape::dotted_line(&ends, *color, spacing, *width),
            };
            ui.painter().extend(shapes);
            let text = Align2::RIGHT_CENTER.anchor_size(rect.right_center(), galley.size());
            ui.painter().galley(text.min, galley, ink);
        }
    });
}
