//! The disc of directions on the screen, with what lies on it.

use crate::app::views::hemisphere::map::place;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2, vec2};
use tr::tr;

/// Room around the disc for its labels.
pub const MARGIN: Vec2 = vec2(34.0, 20.0);
const LETTERS: f32 = 12.0;

/// Draws a mark.
type Mark = fn(&Painter, Pos2);

/// What the marks on the map mean.
pub fn legend_ui(theta_i: f64, count: usize, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let entries: [(Mark, String); 3] = [
            (incident_mark, tr!("incident, θi = {}°", theta_i)),
            (mirror_mark, tr!("mirror direction")),
            (measured_mark, if count == 0 { tr!("not measured at this θi") } else { tr!("measured: {}", count) }),
        ];
        for (mark, text) in entries {
            let (rect, _) = ui.allocate_exact_size(Vec2::splat(14.0), Sense::hover());
            // White marks need their dark map also on a light page.
            ui.painter().rect_filled(rect, 3.0, MAP);
            mark(ui.painter(), rect.center());
            ui.label(text);
            ui.add_space(10.0);
        }
    });
}

/// Behind marks that do not lie on the map.
const MAP: Color32 = Color32::from_rgb(49, 104, 142);
const WHITE: Color32 = Color32::WHITE;
const BLACK: Color32 = Color32::BLACK;

/// The rays come from there: a disc.
pub fn incident_mark(painter: &Painter, at: Pos2) {
    painter.circle(at, 4.5, WHITE, Stroke::new(1.5, BLACK));
}

/// The mirror direction: a cross.
pub fn mirror_mark(painter: &Painter, at: Pos2) {
    for stroke in [Stroke::new(4.0, BLACK), Stroke::new(2.0, WHITE)] {
        for arm in [vec2(4.0, 4.0), vec2(4.0, -4.0)] {
            painter.line_segment([at - arm, at + arm], stroke);
        }
    }
}

/// A measured direction: a small ring.
pub fn measured_mark(painter: &Painter, at: Pos2) {
    painter.circle_stroke(at, 2.5, Stroke::new(2.5, BLACK));
    painter.circle_stroke(at, 2.5, Stroke::new(1.2, WHITE));
}

/// Where the disc lies on the screen.
#[derive(Debug, Clone, Copy)]
pub struct Disc {
    pub center: Pos2,
    pub radius: f32,
}

impl Disc {
    pub fn square(self) -> Rect {
        Rect::from_center_size(self.center, Vec2::splat(2.0 * self.radius))
    }

    /// From a place on the disc of radius 1, y upwards.
    pub fn at(self, place: Vec2) -> Pos2 {
        self.center + self.radius * vec2(place.x, -place.y)
    }

    /// Rings of θr and the labels of Δφ.
    pub fn draw_directions(self, painter: &Painter, ink: Color32) {
        let font = FontId::proportional(LETTERS);
        // Readable on light and dark colours alike.
        let strokes = [Stroke::new(2.0, Color32::from_black_alpha(60)), Stroke::new(1.0, Color32::from_white_alpha(140))];
        for theta_r in [30.0, 60.0] {
            for stroke in strokes {
                painter.circle_stroke(self.center, self.radius * place(theta_r, 180.0).x, stroke);
            }
        }
        for [from, to] in [[place(90.0, 0.0), place(90.0, 180.0)], [place(90.0, 90.0), place(90.0, 270.0)]] {
            for stroke in strokes {
                painter.line_segment([self.at(from), self.at(to)], stroke);
            }
        }
        painter.circle_stroke(self.center, self.radius, Stroke::new(1.0, ink));
        for theta_r in [30.0, 60.0] {
            let galley = painter.layout_no_wrap(format!("{theta_r}°"), font.clone(), WHITE);
            let label = Align2::CENTER_CENTER.anchor_size(self.at(place(theta_r, 120.0)), galley.size());
            painter.rect_filled(label.expand2(vec2(2.0, 0.0)), 3.0, Color32::from_black_alpha(130));
            painter.galley(label.min, galley, WHITE);
        }
        let gap = 4.0 / self.radius;
        for (dphi, anchor, text) in [
            (0.0, Align2::RIGHT_CENTER, "0°"),
            (90.0, Align2::CENTER_TOP, "90°"),
            (180.0, Align2::LEFT_CENTER, "180°"),
            (270.0, Align2::CENTER_BOTTOM, "Δφ = 270°"),
        ] {
            painter.text(self.at((1.0 + gap) * place(90.0, dphi)), anchor, text, font.clone(), ink);
        }
        painter.text(self.at((1.0 + gap) * place(90.0, 135.0)), Align2::LEFT_TOP, "θr = 90°", font, ink);
    }
}
