//! A map of colours in a plot, and the bar beside the plot that tells which colour is which value.

use crate::app::plots::color_scale::{ColorScale, color_bar};
use crate::app::plots::plot_axis::{PlotAxis, coordinate};
use crate::app::plots::range::Range;
use crate::figure::{HeatMap, Scale};
use egui::{ColorImage, Rect, TextureHandle, TextureOptions, Ui, vec2};
use egui_plot::{PlotImage, PlotPoint, PlotUi};

/// A map with cells of one size in the coordinates of its plot.
pub struct MapImage {
    /// Until they are in the texture.
    pixels: Option<ColorImage>,
    x: Range,
    y: Range,
    scale: ColorScale,
    axis: PlotAxis,
}

impl MapImage {
    /// The map of a figure; none without cells, or where the axes have no place for it.
    pub fn new(map: &HeatMap, x: &PlotAxis, y: &PlotAxis) -> Option<Self> {
        let ends = |edges: &[f64], axis: &PlotAxis| {
            let (low, high) = (axis.coordinate(*edges.first()?)?, axis.coordinate(*edges.last()?)?);
            Some(Range { low, high })
        };
        let (columns, rows) = (map.x_edges.len().checked_sub(1)?, map.y_edges.len().checked_sub(1)?);
        let axis =
            PlotAxis::new(&map.color_axis, map.values.iter().filter_map(|value| coordinate(map.color_axis.scale == Scale::Log, *value)));
        let scale = ColorScale { map: map.colors, range: axis.range };
        let table = scale.table();
        let color = |value: &f64| table.color(axis.end_coordinate(*value).unwrap_or(f64::NAN));
        // The first row of an image is the uppermost, that of a map has the smallest y.
        let pixels = map.values.chunks(columns).take(rows).rev().flatten().map(color).collect();
        let pixels = Some(ColorImage::new([columns, rows], pixels));
        Some(Self { pixels, x: ends(&map.x_edges, x)?, y: ends(&map.y_edges, y)?, scale, axis })
    }

    /// Whether the texture does not show it yet.
    #[cfg(test)]
    pub fn is_fresh(&self) -> bool {
        self.pixels.is_some()
    }

    /// Puts it into the texture, once.
    pub fn upload(&mut self, texture: &mut Option<TextureHandle>, ui: &Ui) {
        let Some(pixels) = self.pixels.take() else { return };
        match texture {
            Some(texture) => texture.set(pixels, TextureOptions::LINEAR),
            None => *texture = Some(ui.ctx().load_texture("map", pixels, TextureOptions::LINEAR)),
        }
    }

    /// Puts it into the plot.
    pub fn draw(&self, plot: &mut PlotUi<'_>, texture: &TextureHandle) {
        let center = PlotPoint::new(f64::midpoint(self.x.low, self.x.high), f64::midpoint(self.y.low, self.y.high));
        #[expect(clippy::cast_possible_truncation, reason = "a size on the screen")]
        let size = vec2((self.x.high - self.x.low) as f32, (self.y.high - self.y.low) as f32);
        plot.image(PlotImage::new("", texture.id(), center, size).allow_hover(false));
    }

    /// The bar to the right of the plot.
    pub fn bar_ui(&self, plot: Rect, ui: &Ui) {
        let at = plot.right_top() + vec2(14.0, 20.0);
        color_bar(ui, at, (plot.height() - 24.0).max(20.0), self.scale, &self.axis);
    }
}

#[cfg(test)]
mod tests {
    use super::{HeatMap, MapImage, PlotAxis};
    use crate::figure::{Axis, ColorMap};
    use egui::Color32;

    #[test]
    fn the_image_has_the_values_of_the_map_with_y_upwards_and_none_where_there_is_none() {
        let axis = PlotAxis::new(&Axis::linear("x", "").between(0.0, 2.0), std::iter::empty());
        let map = HeatMap {
            x_edges: vec![0.0, 1.0, 2.0],
            y_edges: vec![0.0, 1.0, 2.0],
            values: vec![1.0, 10.0, 100.0, f64::NAN],
            color_axis: Axis::log("", "").between(1.0, 100.0),
            colors: ColorMap::Sequential,
        };
        let mut image = MapImage::new(&map, &axis, &axis).expect("cells");
        let pixels = image.pixels.take().expect("not in a texture yet").pixels;
        let [low, middle, high] = [0.0, 1.0, 2.0].map(|decade| image.scale.color(decade));
        assert_eq!((pixels[0], pixels[1], pixels[2]), (high, Color32::TRANSPARENT, low));
        // Of 512 shades the middle one.
        assert!(pixels[3].to_array().iter().zip(middle.to_array()).all(|(a, b)| a.abs_diff(b) <= 2));
        assert_eq!(((image.x.low, image.x.high), (image.y.low, image.y.high)), ((0.0, 2.0), (0.0, 2.0)));
    }
}
