//! Measured points with their error bars, of thousands of rows in every frame: one mesh for the bars
//! and one for the symbols. `egui_plot` has no error bars, and would make a shape of every point.

use crate::figure::Symbol;
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Color32, ColorImage, Context, Id, Pos2, Rect, Shape, TextureHandle, TextureId, TextureOptions, Ui, pos2, vec2};
use egui_plot::{PlotBounds, PlotGeometry, PlotItem, PlotItemBase, PlotPoint, PlotTransform};
use std::ops::RangeInclusive;

/// The ends of an error bar, in plot coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBar {
    pub x: f64,
    pub low: f64,
    pub high: f64,
}

/// Points of one colour.
pub struct Markers<'a> {
    base: PlotItemBase,
    points: &'a [PlotPoint],
    bars: &'a [ErrorBar],
    symbol: Symbol,
    color: Color32,
}

/// Radius of a symbol in points of the screen.
pub const RADIUS: f32 = 3.0;
/// Half the width of a cap in points.
const CAP: f32 = 2.5;
/// Half the edge of the picture of a symbol in points: the symbol and what its rim fades over.
const HALF: f32 = 4.0;
/// Width of the lines of open symbols in points.
const LINE: f32 = 1.0;
/// A bar up to this length lies under a disc with its caps: `2 sqrt(RADIUS² − CAP²)`.
const UNDER_A_DISC: f32 = 3.2;
/// Points of one item with symbols of full size and bars with caps: those of more are a blur, and
/// what they cover is most of the time to draw.
const MANY: usize = 100;
/// The size of the symbols of many points over the full size.
const SIZE_OF_MANY: f32 = 2.0 / 3.0;
/// The symbols in the order of their pictures.
const SYMBOLS: [Symbol; 4] = [Symbol::Disc, Symbol::Circle, Symbol::Square, Symbol::Cross];

impl<'a> Markers<'a> {
    pub fn new(name: String, points: &'a [PlotPoint], bars: &'a [ErrorBar], symbol: Symbol, color: Color32) -> Self {
        Self { base: PlotItemBase::new(name), points, bars, symbol, color }
    }

    fn bars(&self, pixel: f32, transform: &PlotTransform) -> Mesh {
        let mut mesh = Mesh::default();
        mesh.reserve_vertices(12 * self.bars.len());
        mesh.reserve_triangles(6 * self.bars.len());
        // Whole pixels need no smooth edges.
        let snap = |at: f32| (at / pixel).round() * pixel;
        let width = pixel.max((1.0 / pixel).round() * pixel);
        let seen = transform.frame().expand(CAP);
        for bar in self.bars {
            let low = transform.position_from_point(&PlotPoint::new(bar.x, bar.low));
            let high = transform.position_from_point(&PlotPoint::new(bar.x, bar.high));
            let is_hidden = self.symbol == Symbol::Disc && (low.y - high.y).abs() <= UNDER_A_DISC;
            if is_hidden || !seen.x_range().contains(low.x) || high.y > seen.bottom() || low.y < seen.top() {
                continue;
            }
            let left = snap(low.x - 0.5 * width);
            quad(&mut mesh, Rect::from_min_max(pos2(left, high.y), pos2(left + width, low.y)), Rect::from_pos(WHITE_UV), self.color);
            let ends = [low, high].into_iter().filter(|_| self.bars.len() <= MANY);
            for end in ends {
                let top = snap(end.y - 0.5 * width);
                let cap = Rect::from_min_max(pos2(snap(end.x - CAP), top), pos2(snap(end.x + CAP), top + width));
                quad(&mut mesh, cap, Rect::from_pos(WHITE_UV), self.color);
            }
        }
        mesh
    }

    fn symbols(&self, texture: TextureId, pixel: f32, transform: &PlotTransform) -> Mesh {
        let mut mesh = Mesh::with_texture(texture);
        mesh.reserve_vertices(4 * self.points.len());
        mesh.reserve_triangles(2 * self.points.len());
        let size = if self.points.len() > MANY { SIZE_OF_MANY } else { 1.0 };
        let edge = size * pixel * cells(pixel);
        let index = SYMBOLS.iter().position(|symbol| *symbol == self.symbol).unwrap_or(0);
        #[expect(clippy::cast_precision_loss, reason = "one of four")]
        let [left, right] = [index, index + 1].map(|place| place as f32 / SYMBOLS.len() as f32);
        let uv = Rect::from_min_max(pos2(left, 0.0), pos2(right, 1.0));
        let seen = transform.frame().expand(RADIUS);
        for point in self.points {
            let at = transform.position_from_point(point);
            if seen.contains(at) {
                quad(&mut mesh, Rect::from_center_size(at, vec2(edge, edge)), uv, self.color);
            }
        }
        mesh
    }
}

/// A rectangle of a colour, under that part of the texture.
fn quad(mesh: &mut Mesh, rect: Rect, uv: Rect, color: Color32) {
    let Ok(first) = u32::try_from(mesh.vertices.len()) else { return };
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first + 2, first + 1, first + 3);
    let corner = |pos: Pos2, uv: Pos2| Vertex { pos, uv, color };
    mesh.vertices.push(corner(rect.left_top(), uv.left_top()));
    mesh.vertices.push(corner(rect.right_top(), uv.right_top()));
    mesh.vertices.push(corner(rect.left_bottom(), uv.left_bottom()));
    mesh.vertices.push(corner(rect.right_bottom(), uv.right_bottom()));
}

/// Pixels along the edge of the picture of a symbol, where a pixel is so many points.
fn cells(pixel: f32) -> f32 {
    (2.0 * HALF / pixel).ceil()
}

/// The pictures of the symbols side by side, white, as sharp as the screen is.
fn picture(pixel: f32) -> ColorImage {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some tens of pixels")]
    let cells = cells(pixel) as usize;
    let mut image = ColorImage::filled([SYMBOLS.len() * cells, cells], Color32::TRANSPARENT);
    for (index, symbol) in SYMBOLS.into_iter().enumerate() {
        for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
            #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
            let [x, y] = [column, row].map(|place| pixel * (place as f32 + 0.5 - 0.5 * cells as f32));
            // As far as the middle of the pixel is inside, in pixels.
            let covered = (0.5 - outside(symbol, x, y) / pixel).clamp(0.0, 1.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
            let alpha = (255.0 * covered).round() as u8;
            image[(index * cells + column, row)] = Color32::from_white_alpha(alpha);
        }
    }
    image
}

/// How far a place lies outside a symbol around the origin, in points; inside it is below 0.
fn outside(symbol: Symbol, x: f32, y: f32) -> f32 {
    let radius = x.hypot(y);
    match symbol {
        Symbol::Disc => radius - RADIUS,
        Symbol::Circle => (radius - RADIUS).abs() - 0.5 * LINE,
        Symbol::Square => x.abs().max(y.abs()) - std::f32::consts::FRAC_1_SQRT_2 * RADIUS,
        Symbol::Cross => {
            // Along the nearer diagonal and off it.
            let (along, off) =
                (std::f32::consts::FRAC_1_SQRT_2 * (x.abs() + y.abs()), std::f32::consts::FRAC_1_SQRT_2 * (x.abs() - y.abs()).abs());
            (along - RADIUS).max(0.0).hypot(off) - 0.5 * LINE
        }
    }
}

/// The texture of the symbols, made once for a screen.
fn texture(ctx: &Context, pixel: f32) -> TextureId {
    let id = Id::unique("symbols of measured points");
    let kept: Option<(f32, TextureHandle)> = ctx.data(|data| data.get_temp(id));
    if let Some((_, texture)) = kept.filter(|(made_for, _)| *made_for == pixel) {
        return texture.id();
    }
    let texture = ctx.load_texture("symbols", picture(pixel), TextureOptions::LINEAR);
    let texture_id = texture.id();
    ctx.data_mut(|data| data.insert_temp(id, (pixel, texture)));
    texture_id
}

impl PlotItem for Markers<'_> {
    fn shapes(&self, ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        let pixel = 1.0 / ui.pixels_per_point();
        if !self.bars.is_empty() {
            shapes.push(Shape::mesh(self.bars(pixel, transform)));
        }
        shapes.push(Shape::mesh(self.symbols(texture(ui.ctx(), pixel), pixel, transform)));
    }

    fn initialize(&mut self, _x_range: RangeInclusive<f64>) {}

    fn color(&self) -> Color32 {
        self.color
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        PlotGeometry::Points(self.points)
    }

    fn bounds(&self) -> PlotBounds {
        let mut bounds = PlotBounds::NOTHING;
        self.points.iter().for_each(|point| bounds.extend_with(point));
        for bar in self.bars {
            bounds.extend_with(&PlotPoint::new(bar.x, bar.low));
            bounds.extend_with(&PlotPoint::new(bar.x, bar.high));
        }
        bounds
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixels of a small picture")]
mod tests {
    use super::{Markers, SYMBOLS, cells, outside, picture};
    use crate::app::plots::markers::ErrorBar;
    use crate::figure::Symbol;
    use egui::{Color32, Shape};
    use egui_kittest::Harness;
    use egui_plot::{Plot, PlotPoint};

    #[test]
    fn symbols_are_full_inside_and_empty_outside_on_every_screen() {
        for pixel in [1.0, 0.5, 1.0 / 1.5] {
            let (image, edge) = (picture(pixel), cells(pixel));
            assert_eq!(image.size[0], SYMBOLS.len() * image.size[1]);
            assert!((edge - image.size[1] as f32).abs() < 0.5);
            let at = |index: usize, x: f32, y: f32| {
                let place = |at: f32| ((at / pixel + 0.5 * edge).floor()) as usize;
                image[(index * image.size[1] + place(x), place(y))].a()
            };
            // The middle, between the middle and the rim, and a corner of the picture.
            let seen = |index| [at(index, 0.1, 0.1), at(index, 0.1, -2.9), at(index, 3.7, 3.7)].map(|alpha| alpha > 60);
            assert_eq!(
                [0, 1, 2, 3].map(seen),
                [[true, true, false], [false, true, false], [true, false, false], [true, false, false]],
                "{pixel}"
            );
        }
        assert!(outside(Symbol::Cross, 2.0, 2.0) < 0.0 && outside(Symbol::Cross, 2.0, 0.0) > 0.0);
    }

    #[test]
    fn thousands_of_points_are_two_shapes_and_none_is_drawn_outside() {
        let points: Vec<PlotPoint> = (0..5000).map(|i| PlotPoint::new(f64::from(i % 100), f64::from(i / 100))).collect();
        let bars: Vec<ErrorBar> = points.iter().map(|at| ErrorBar { x: at.x, low: at.y - 20.0, high: at.y + 20.0 }).collect();
        let harness = Harness::new_ui(|ui| {
            Plot::new("plot").show(ui, |plot| {
                plot.set_plot_bounds_x(-0.5..=49.5);
                plot.set_plot_bounds_y(-10.0..=60.0);
                plot.add(Markers::new("points".to_owned(), &points, &bars, Symbol::Square, Color32::RED));
            });
        });
        let red = |shape: &Shape| match shape {
            Shape::Mesh(mesh) if mesh.vertices.first().is_some_and(|vertex| vertex.color == Color32::RED) => Some(mesh.vertices.len()),
            _ => None,
        };
        let meshes: Vec<usize> = harness.output().shapes.iter().filter_map(|clipped| red(&clipped.shape)).collect();
        // Half of the points are to the right of the plot.
        assert_eq!(meshes, [2500 * 4, 2500 * 4]);
    }
}
