//! A picture as pixels, one for each cell of a map, with the key of its colours to the right.

use crate::figure::canvas::{Canvas, INK, Missing, POINTS_PER_MM, Paint, rectangle};
use crate::figure::layout::{COLOR_BAR, Frame, Ruled};
use crate::figure::png::rendered;
use crate::figure::shapes::draw_color_bar;
use crate::figure::svg::draw_y_axis;
use crate::figure::text::Font;
use crate::figure::{HeatMap, Image, PngError, Rgb, range};

/// Sides of the key in millimetres, whatever the picture's size in pixels.
const HEIGHT: f64 = 90.0;
const WIDTH: f64 = 20.0;
/// Free above and below the bar, in points.
const FREE: f64 = 12.0;
/// Most labels.
const LABELS: usize = 9;

impl HeatMap {
    /// Each cell as one pixel, the lowest row at the bottom, blank ones white, and the key of the colours to the right.
    ///
    /// # Errors
    ///
    /// [`PngError`] where the picture has no cells, or more pixels than an image may have, or the renderer fails.
    pub fn image_with_key(&self) -> Result<Image, PngError> {
        let (columns, rows) = (self.x_edges.len().saturating_sub(1), self.y_edges.len().saturating_sub(1));
        #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
        let dpi = rows as f64 * 25.4 / HEIGHT;
        let ends = range::color(self);
        let axis = Ruled::new(&self.color_axis, ends, LABELS);
        let key = self.key(&axis, dpi)?;
        let (key_width, width) = (key.width as usize, columns + key.width as usize);
        let mut rgba = vec![255; 4 * width * rows];
        // The first row of an image is the uppermost.
        for (row, line) in rgba.chunks_exact_mut((4 * width).max(1)).enumerate() {
            let cells = self.values.iter().skip((rows - 1 - row) * columns).take(columns);
            for (pixel, value) in line.chunks_exact_mut(4).zip(cells) {
                if let Some(fraction) = axis.fraction(*value) {
                    let Rgb(r, g, b) = self.colors.at(fraction);
                    pixel.copy_from_slice(&[r, g, b, 255]);
                }
            }
            if let Some(from) = key.rgba.chunks_exact((4 * key_width).max(1)).nth(row) {
                line[4 * columns..].copy_from_slice(from);
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "the key's own height, and a sum of its width and that")]
        Ok(Image { width: width as u32, height: rows as u32, rgba })
    }

    /// The colours with their marks.
    fn key(&self, axis: &Ruled, dpi: f64) -> Result<Image, PngError> {
        let font = Font::new();
        let title = self.color_axis.title();
        let mut canvas = Canvas::new(&font, Missing::Boxes, WIDTH, HEIGHT, &title);
        let frame = Frame { left: 6.0, top: FREE, width: COLOR_BAR, height: HEIGHT * POINTS_PER_MM - 2.0 * FREE };
        draw_color_bar(&mut canvas, &frame, self);
        canvas.path(&rectangle(frame.left, frame.top, frame.width, frame.height), Paint::Stroke(INK, 0.7, None));
        draw_y_axis(&mut canvas, axis, &title, &frame, true);
        rendered(&canvas.finish(), WIDTH, HEIGHT, dpi)
    }
}

#[cfg(test)]
mod tests {
    use crate::figure::{Axis, ColorMap, HeatMap};

    #[test]
    fn every_cell_is_a_pixel_and_the_key_stands_beside_it() {
        let edges: Vec<f64> = (0..=100).map(f64::from).collect();
        let values = (0..10_000).map(|cell| if cell == 0 { 0.0 } else { 1.0 }).collect();
        let map = HeatMap {
            x_edges: edges.clone(),
            y_edges: edges,
            values,
            color_axis: Axis::linear("a", "").between(0.0, 1.0),
            colors: ColorMap::Light,
        };
        let image = map.image_with_key().expect("an image");
        assert_eq!(image.height, 100);
        assert!((110..150).contains(&image.width), "{}", image.width);
        let pixel = |column: usize, row: usize| &image.rgba[4 * (row * image.width as usize + column)..][..4];
        // The first cell is at the lower left.
        assert_eq!(pixel(0, 99), [0, 0, 0, 255]);
        assert_eq!(pixel(0, 98), [255, 255, 255, 255]);
        // The bar is dark at its foot.
        let dark = (100..image.width as usize).filter(|column| pixel(*column, 80)[0] < 150).count();
        assert!(dark > 2, "{dark}");
    }
}
