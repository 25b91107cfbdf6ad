//! Colours of values in a map, and the bar beside it that tells which is which.

use crate::app::plots::plot_axis::PlotAxis;
use crate::app::plots::range::Range;
use crate::app::plots::theme;
use crate::figure::{ColorMap, Rgb};
use egui::{Align2, Color32, FontId, Mesh, Pos2, Rect, Role, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, vec2};
use egui_plot::GridInput;
use tr::tr;

/// A map of colours over a range of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorScale {
    pub map: ColorMap,
    pub range: Range,
}

/// Shades that are told apart.
const SHADES: u16 = 512;

impl ColorScale {
    /// The colours of many values: a look-up instead of a calculation for each.
    pub fn table(self) -> ColorTable {
        let shades = (0..SHADES).map(|i| color32(self.map.at(f64::from(i) / f64::from(SHADES - 1)))).collect();
        ColorTable { shades, low: self.range.low, per_unit: f64::from(SHADES - 1) / (self.range.high - self.range.low) }
    }

    /// The colour of one value.
    pub fn color(self, value: f64) -> Color32 {
        color32(self.map.at(self.fraction(value)))
    }

    /// Black or white, whichever is easier to read on that colour.
    pub fn ink_on(self, value: f64) -> Color32 {
        color32(self.map.ink_on(self.fraction(value)))
    }

    fn fraction(self, value: f64) -> f64 {
        (value - self.range.low) / (self.range.high - self.range.low)
    }
}

/// A scale, worked out.
pub struct ColorTable {
    shades: Vec<Color32>,
    low: f64,
    per_unit: f64,
}

impl ColorTable {
    /// The colour of a value; that of the ends beyond them, and none where there is no value.
    pub fn color(&self, value: f64) -> Color32 {
        if value.is_nan() {
            return Color32::TRANSPARENT;
        }
        let place = ((value - self.low) * self.per_unit + 0.5).clamp(0.0, f64::from(SHADES - 1));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the number of shades")]
        let shade = place as usize;
        self.shades[shade]
    }
}

fn color32(Rgb(r, g, b): Rgb) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// Width of the bar itself; its labels stand to the right.
const BAR_WIDTH: f32 = 14.0;
/// What bar and labels need.
pub const BAR_ROOM: f32 = 78.0;
/// Points of the screen between marks.
const SPREAD: f64 = 26.0;

/// Draws a colour bar with its upper left corner there; the axis of its colours stands to the
/// right, its title above.
pub fn color_bar(ui: &Ui, at: Pos2, height: f32, scale: ColorScale, axis: &PlotAxis) {
    let rect = Rect::from_min_size(at, vec2(BAR_WIDTH, height));
    let (painter, ink) = (ui.painter(), ui.visuals().text_color());
    painter.add(gradient(rect, scale.map));
    painter.rect_stroke(rect, 0.0, Stroke::new(1.0, theme::muted(ui.visuals().dark_mode)), StrokeKind::Outside);
    let font = FontId::proportional(12.0);
    // A long title ends where the room of the bar does.
    let title = painter.layout_no_wrap(axis.title.clone(), font.clone(), ink);
    let left = rect.left().min(rect.left() - 14.0 + BAR_ROOM - title.size().x);
    painter.galley(Pos2::new(left, rect.top() - 5.0 - title.size().y), title, ink);
    let Range { low, high } = scale.range;
    let input = GridInput { bounds: (low, high), base_step_size: (high - low) / f64::from(height) };
    let marks = axis.marks(&input, SPREAD).into_iter().filter(|mark| (low..=high).contains(&mark.value));
    let marks: Vec<(f64, String)> = marks.map(|mark| (mark.value, axis.label(mark.value, mark.step_size))).collect();
    if let (Some((_, first)), Some((_, last))) = (marks.first(), marks.last()) {
        let name = || WidgetInfo::labeled(Role::Image, true, tr!("Colour bar: {0}, marks from {1} to {2}", axis.title, first, last));
        ui.interact(rect, ui.scope_id().with("colour bar"), Sense::hover()).widget_info(name);
    }
    for (value, text) in marks {
        #[expect(clippy::cast_possible_truncation, reason = "a place on the screen")]
        let y = rect.bottom() - height * ((value - low) / (high - low)) as f32;
        painter.hline(rect.right()..=rect.right() + 4.0, y, Stroke::new(1.0, ink));
        painter.text(Pos2::new(rect.right() + 6.0, y), Align2::LEFT_CENTER, text, font.clone(), ink);
    }
}

/// The colours of a map from the bottom upwards.
fn gradient(rect: Rect, map: ColorMap) -> Shape {
    const STEPS: u16 = 64;
    let mut mesh = Mesh::default();
    for i in 0..=STEPS {
        let fraction = f32::from(i) / f32::from(STEPS);
        let y = rect.bottom() - fraction * rect.height();
        let shade = color32(map.at(f64::from(fraction)));
        mesh.colored_vertex(Pos2::new(rect.left(), y), shade);
        mesh.colored_vertex(Pos2::new(rect.right(), y), shade);
        if i > 0 {
            let corner = 2 * u32::from(i);
            mesh.add_triangle(corner - 2, corner - 1, corner);
            mesh.add_triangle(corner - 1, corner, corner + 1);
        }
    }
    Shape::mesh(mesh)
}

#[cfg(test)]
mod tests {
    use super::{ColorMap, ColorScale, Range};
    use egui::Color32;

    #[test]
    fn a_table_holds_the_colours_of_its_scale() {
        let scale = ColorScale { map: ColorMap::Sequential, range: Range { low: -2.0, high: 3.0 } };
        let table = scale.table();
        for i in 0..=50 {
            let value = -2.0 + 0.1 * f64::from(i);
            let (near, exact) = (table.color(value).to_array(), scale.color(value).to_array());
            // One of 512 shades more or less: at most two steps of a byte.
            assert!(near.iter().zip(exact).all(|(a, b)| a.abs_diff(b) <= 2), "{value}: {near:?} {exact:?}");
        }
        assert_eq!(table.color(f64::NEG_INFINITY), scale.color(-2.0));
        assert_eq!(table.color(9.0), scale.color(3.0));
        assert_eq!(table.color(f64::NAN), Color32::TRANSPARENT);
    }
}
