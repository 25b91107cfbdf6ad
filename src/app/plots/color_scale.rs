//! Colours of values in a map, and the bar beside it that tells which is which.

use crate::app::plots::axis::{decimal, marks};
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
        let shades = (0..SHADES).map(|i| color(self.map, f64::from(i) / f64::from(SHADES - 1))).collect();
        ColorTable { shades, low: self.range.low, per_unit: f64::from(SHADES - 1) / (self.range.high - self.range.low) }
    }

    /// The colour of one value.
    pub fn color(self, value: f64) -> Color32 {
        color(self.map, (value - self.range.low) / (self.range.high - self.range.low))
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

fn color(map: ColorMap, fraction: f64) -> Color32 {
    let Rgb(r, g, b) = map.at(fraction);
    Color32::from_rgb(r, g, b)
}

/// Black or white, whichever is easier to read on that colour.
pub fn ink_on(background: Color32) -> Color32 {
    let [r, g, b, _] = background.to_array();
    let luma = 0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b);
    if luma > 130.0 { Color32::BLACK } else { Color32::WHITE }
}

/// What stands beside a colour bar.
#[derive(Debug, Clone, Copy)]
pub struct BarLabels<'a> {
    /// Quantity and unit, above it.
    pub title: &'a str,
    pub marks: BarMarks,
}

/// Which marks a colour bar has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BarMarks {
    /// At round numbers.
    Linear,
    /// There.
    At(&'static [f64]),
    /// The values are decimal logarithms: at decades, and at twice and five times them where there is room.
    Log,
}

impl BarMarks {
    /// Places and labels along a bar of that height.
    fn along(self, Range { low, high }: Range, height: f32) -> Vec<(f64, String)> {
        let per_point = (high - low) / f64::from(height);
        match self {
            Self::Linear => {
                let input = GridInput { bounds: (low, high), base_step_size: per_point };
                marks(&input, SPREAD, 0.0).into_iter().map(|mark| (mark.value, decimal(mark.value, mark.step_size))).collect()
            }
            Self::At(values) => values.iter().map(|value| (*value, value.to_string())).collect(),
            Self::Log => decades(low, high, per_point),
        }
    }
}

/// Marks of a logarithmic bar.
fn decades(low: f64, high: f64, per_point: f64) -> Vec<(f64, String)> {
    // From 1 to 2 is 0.3 of a decade.
    let between: &[f64] = if 0.3 > CLOSEST * per_point { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let step = (SPREAD * per_point).ceil().max(1.0);
    let mut marks = Vec::new();
    let mut decade = (low / step).floor() * step;
    while decade <= high {
        for factor in between {
            let at = decade + libm::log10(*factor);
            if (low - 1e-9..=high + 1e-9).contains(&at) {
                marks.push((at, power(*factor, decade)));
            }
        }
        decade += step;
    }
    marks
}

/// A round number by its first digit and decade.
fn power(factor: f64, decade: f64) -> String {
    if (-3.0..=3.0).contains(&decade) {
        // Decades below 1 have as many decimals.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 3")]
        let decimals = (-decade).max(0.0) as usize;
        format!("{:.decimals$}", factor * libm::exp10(decade))
    } else {
        format!("{factor}e{decade}")
    }
}

/// Width of the bar itself; its labels stand to the right.
const BAR_WIDTH: f32 = 14.0;
/// What bar and labels need.
pub const BAR_ROOM: f32 = 78.0;
/// Points of the screen between marks.
const SPREAD: f64 = 30.0;
/// The same for those between decades.
const CLOSEST: f64 = 16.0;

/// Draws a colour bar with its upper left corner there.
pub fn color_bar(ui: &Ui, at: Pos2, height: f32, scale: ColorScale, labels: &BarLabels<'_>, ink: Color32, dark: bool) {
    let rect = Rect::from_min_size(at, vec2(BAR_WIDTH, height));
    let painter = ui.painter();
    painter.add(gradient(rect, scale.map));
    painter.rect_stroke(rect, 0.0, Stroke::new(1.0, theme::muted(dark)), StrokeKind::Outside);
    let font = FontId::proportional(12.0);
    painter.text(rect.left_top() - vec2(0.0, 5.0), Align2::LEFT_BOTTOM, labels.title, font.clone(), ink);
    let Range { low, high } = scale.range;
    let marks = labels.marks.along(scale.range, height);
    if let (Some((_, first)), Some((_, last))) = (marks.first(), marks.last()) {
        let name = || WidgetInfo::labeled(Role::Image, true, tr!("Colour bar: {0}, marks from {1} to {2}", labels.title, first, last));
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
        let shade = color(map, f64::from(fraction));
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
    use super::{BarMarks, ColorMap, ColorScale, Range};
    use egui::Color32;

    #[test]
    fn a_logarithmic_bar_is_marked_at_decades_and_between_them_where_there_is_room() {
        let texts = |low, high, height| -> Vec<String> {
            BarMarks::Log.along(Range { low, high }, height).into_iter().map(|(_, text)| text).collect()
        };
        assert_eq!(texts(-2.0, 0.5, 300.0), ["0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(texts(-2.0, 0.5, 100.0), ["0.01", "0.1", "1"]);
        assert_eq!(texts(-7.5, 0.5, 100.0), ["1e-6", "0.001", "1"]);
        for (at, text) in BarMarks::Log.along(Range { low: -5.0, high: 1.0 }, 2000.0) {
            let value: f64 = text.parse().expect("a number");
            // Digits as written against their logarithm.
            assert!((libm::exp10(at) / value - 1.0).abs() < 1e-12, "{text}");
        }
    }

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
