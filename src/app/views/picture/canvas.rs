//! The picture on the screen, what lies on it, and what the pointer does there.

use crate::app::plots::{BAR_ROOM, PlotAxis, color_bar, theme};
use crate::app::views::picture::painted::{PaintedScene, texts};
use egui::{Align2, Pos2, Rect, Role, Sense, Stroke, TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, pos2, vec2};
use pbrdf::model::Lamp;
use std::sync::Arc;
use tr::tr;

/// The picture in a texture.
#[derive(Default)]
pub struct PictureCanvas {
    texture: Option<TextureHandle>,
    /// What it shows.
    uploaded: Option<Arc<egui::ColorImage>>,
}

/// A measured direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredMark {
    /// x and y.
    pub at: [f64; 2],
    /// Whether it is seen under the present lamp.
    pub seen: bool,
}

/// What the pointer did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touched {
    /// Where it is: x and y.
    pub hovered: Option<[f64; 2]>,
    pub clicked: Option<[f64; 2]>,
    /// Where the lamp was dragged to: degrees from the camera, and from right to up.
    pub lamp: Option<(f64, f64)>,
}

/// The pixel between −1 and 1 that a place lies in: row and column.
pub fn pixel([x, y]: [f64; 2], size: usize) -> Option<(usize, usize)> {
    #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
    let half = 0.5 * size as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be within the picture")]
    let index = |along: f64| (-1.0..1.0).contains(&along).then_some(((along + 1.0) * half) as usize);
    Some((index(-y)?, index(x)?))
}

/// The lamp whose highlight lies there on a sphere: degrees from the camera, and from right to up.
fn lamp_at([x, y]: [f64; 2]) -> (f64, f64) {
    let tilt = libm::asin(libm::hypot(x, y).min(1.0)).to_degrees();
    let round = |degrees: f64| (degrees * 10.0).round() / 10.0;
    (round(2.0 * tilt), round(libm::atan2(y, x).to_degrees()))
}

/// Where the highlight of a lamp lies on a sphere.
fn highlight(lamp: &Lamp) -> [f64; 2] {
    let ((sin, _), (sin_a, cos_a)) = (pbrdf::optics::Degrees(0.5 * lamp.polar().0).sin_cos(), lamp.azimuth().sin_cos());
    [sin * cos_a, sin * sin_a]
}

/// What lies on the picture: measured directions, what was clicked, the names of two halves.
type Marks<'a> = (&'a [MeasuredMark], Option<[f64; 2]>, Option<[String; 2]>);

impl PictureCanvas {
    /// Paints the picture in that room and tells what the pointer did.
    pub fn ui(&mut self, made: &PaintedScene, (marks, chosen, halves): Marks<'_>, room: Vec2, ui: &mut Ui) -> Touched {
        if self.uploaded.as_ref().is_none_or(|uploaded| !Arc::ptr_eq(uploaded, &made.pixels)) {
            let image = egui::ImageData::Color(made.pixels.clone());
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => self.texture = Some(ui.ctx().load_texture("picture", image, TextureOptions::LINEAR)),
            }
            self.uploaded = Some(made.pixels.clone());
        }
        let side = room.y.min(room.x - BAR_ROOM - 8.0).max(60.0);
        let (whole, response) = ui.allocate_exact_size(room, Sense::hover());
        let left = whole.left() + 0.5 * (whole.width() - side - BAR_ROOM).max(0.0);
        let rect = Rect::from_min_size(pos2(left, whole.top()), vec2(side, side));
        let response = ui.interact(rect, response.id.with("picture"), Sense::click_and_drag());
        let name = texts(made.key.options.quantity)[0].clone();
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr!("Picture: {}", name)));
        if let Some(texture) = &self.texture {
            let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, uv, egui::Color32::WHITE);
        }
        paint_marks(made, marks, chosen, rect, ui);
        halves.iter().for_each(|names| paint_names(names, rect, ui));
        let axis = PlotAxis::new(&made.axis(), std::iter::empty());
        color_bar(ui, rect.right_top() + vec2(14.0, 20.0), (side - 28.0).max(20.0), made.scale, &axis);
        let place = |at: Pos2| {
            let along = |from: f32, to: f32| f64::from(2.0 * (to - from) / side - 1.0);
            [along(rect.left(), at.x), -along(rect.top(), at.y)]
        };
        let at = response.interact_pointer_pos().map(place);
        Touched {
            hovered: response.hover_pos().map(place),
            clicked: at.filter(|_| response.clicked()),
            lamp: at.filter(|_| response.dragged()).map(lamp_at),
        }
    }
}

/// The highlight, measured directions, what was clicked, and the line between two halves.
fn paint_marks(made: &PaintedScene, marks: &[MeasuredMark], chosen: Option<[f64; 2]>, rect: Rect, ui: &Ui) {
    #[expect(clippy::cast_possible_truncation, reason = "a place on the screen")]
    let place = |[x, y]: [f64; 2]| rect.center() + 0.5 * rect.width() * vec2(x as f32, -y as f32);
    let (painter, dark) = (ui.painter(), ui.visuals().dark_mode);
    let ink = theme::on_screen(theme::MARK, dark);
    let ring = |at: Pos2, radius: f32| {
        painter.circle_stroke(at, radius, Stroke::new(3.0, egui::Color32::from_black_alpha(120)));
        painter.circle_stroke(at, radius, Stroke::new(1.5, egui::Color32::WHITE));
    };
    if made.scene.other.is_some() && !made.key.options.difference {
        painter.vline(rect.center().x, rect.y_range(), Stroke::new(1.0, theme::muted(dark)));
    }
    for mark in marks {
        if mark.seen {
            painter.circle_filled(place(mark.at), 3.5, ink);
        } else {
            painter.circle_stroke(place(mark.at), 2.0, Stroke::new(1.0, ink));
        }
    }
    if let Some(lamp) = &made.scene.key.lamp {
        ring(place(highlight(lamp)), 6.0);
    }
    if let Some(at) = chosen.map(place) {
        painter.hline(at.x - 6.0..=at.x + 6.0, at.y, Stroke::new(1.5, ink));
        painter.vline(at.x, at.y - 6.0..=at.y + 6.0, Stroke::new(1.5, ink));
    }
}

/// The names of two halves, in the lower corners: over the upper one stands what the colours mean.
fn paint_names([left, right]: &[String; 2], rect: Rect, ui: &Ui) {
    let font = egui::TextStyle::Body.resolve(ui.style());
    for (name, anchor) in [(left, Align2::LEFT_BOTTOM), (right, Align2::RIGHT_BOTTOM)] {
        let text = ui.painter().layout(name.clone(), font.clone(), ui.visuals().text_color(), 0.5 * rect.width() - 8.0);
        let place = anchor.anchor_size(anchor.pos_in_rect(&rect), text.size());
        ui.painter().rect_filled(place.expand2(vec2(3.0, 1.0)), 2.0, theme::plate(ui.visuals().dark_mode));
        ui.painter().galley(place.min, text, ui.visuals().text_color());
    }
}

#[cfg(test)]
mod tests {
    use super::{highlight, lamp_at, pixel};
    use pbrdf::model::Lamp;

    #[test]
    fn pixels_run_from_the_upper_left() {
        assert_eq!((pixel([-0.99, 0.99], 100), pixel([0.99, -0.99], 100)), (Some((0, 0)), Some((99, 99))));
        assert_eq!((pixel([1.0, 0.0], 100), pixel([0.0, -1.1], 100)), (None, None));
    }

    #[test]
    fn a_lamp_is_dragged_by_its_highlight() {
        for (polar, azimuth) in [(30.0, 135.0), (80.0, -20.0), (150.0, 0.0)] {
            let lamp = Lamp::new(polar, azimuth).expect("a direction");
            let (dragged, around) = lamp_at(highlight(&lamp));
            assert!((dragged - polar).abs() < 1e-9 && (around - azimuth).abs() < 1e-9, "{dragged} {around}");
        }
        // Beside the sphere the lamp stands behind it.
        assert_eq!(lamp_at([0.0, 1.4]), (180.0, 90.0));
    }
}
