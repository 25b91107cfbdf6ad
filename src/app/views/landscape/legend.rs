//! What the marks on the map mean: on a dark plate in its corner, since their colours are made for the map and not for the page.

use crate::app::views::landscape::marks::{METALS, MINIMA, Marks, PLATE, RING, way_color, way_name};
use crate::app::work::settings::LandscapeAxes;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};
use tr::tr;

/// A mark's look.
#[derive(Debug, Clone, Copy)]
enum Sample {
    Metal,
    Way(usize),
    Minimum,
    Sliders,
}

const LETTERS: f32 = 12.0;
/// Height of an entry, and the width that its sample has.
const LINE: f32 = 17.0;
const SAMPLE: f32 = 24.0;
/// Around the entries, and between the plate and the corner of the map.
const PAD: Vec2 = vec2(6.0, 3.0);
const AWAY: Vec2 = vec2(5.0, 5.0);

/// Names and samples of what lies on the map.
fn entries(marks: Option<&Marks>, shown: LandscapeAxes) -> Vec<(Sample, String)> {
    let mut entries = vec![(Sample::Sliders, tr!("sliders"))];
    let Some(marks) = marks else { return entries };
    let ways = marks.ways.len();
    entries.extend((0..ways).filter(|_| shown.paths).map(|age| (Sample::Way(age), way_name(age))));
    if shown.minima && !marks.minima.points.is_empty() {
        entries.push((Sample::Minimum, tr!("minima")));
    }
    if shown.metals && !marks.metals.points.is_empty() {
        entries.push((Sample::Metal, tr!("metals")));
    }
    entries
}

pub fn legend_ui(marks: Option<&Marks>, shown: LandscapeAxes, map: Rect, ui: &Ui) {
    let entries = entries(marks, shown);
    let painter = ui.painter().with_clip_rect(map.intersect(ui.clip_rect()));
    let font = FontId::proportional(LETTERS);
    let galleys: Vec<_> = entries.iter().map(|(_, name)| painter.layout_no_wrap(name.clone(), font.clone(), Color32::WHITE)).collect();
    let widest = galleys.iter().map(|galley| galley.size().x).fold(0.0, f32::max);
    #[expect(clippy::cast_precision_loss, reason = "a handful of lines")]
    let size = vec2(SAMPLE + widest, LINE * entries.len() as f32) + 2.0 * PAD;
    let plate = Rect::from_min_size(map.min + AWAY, size);
    painter.rect_filled(plate, 3.0, PLATE);
    let mut middle = plate.min + PAD + vec2(0.0, 0.5 * LINE);
    for ((sample, _), galley) in entries.iter().zip(galleys) {
        draw(*sample, &painter, middle + vec2(0.5 * (SAMPLE - PAD.x), 0.0));
        let text = Align2::LEFT_CENTER.anchor_size(middle + vec2(SAMPLE, 0.0), galley.size());
        painter.galley(text.min, galley, Color32::WHITE);
        middle.y += LINE;
    }
    let names: Vec<String> = entries.into_iter().map(|(_, name)| name).collect();
    let response = ui.interact(plate, ui.scope_id().with("landscape legend"), Sense::empty());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, tr!("On the map: {}", names.join(", "))));
}

fn draw(sample: Sample, painter: &Painter, at: Pos2) {
    match sample {
        Sample::Metal => {
            painter.circle_filled(at, 2.5, METALS);
        }
        Sample::Way(age) => {
            let color = way_color(age);
            painter.hline(at.x - 8.0..=at.x + 8.0, at.y, Stroke::new(1.5, color));
            painter.circle_filled(at, 2.5, color);
        }
        Sample::Minimum => {
            let corners = [vec2(0.0, -4.5), vec2(4.5, 0.0), vec2(0.0, 4.5), vec2(-4.5, 0.0)].map(|corner| at + corner);
            painter.add(Shape::convex_polygon(corners.to_vec(), MINIMA, Stroke::NONE));
        }
        Sample::Sliders => {
            let stroke = Stroke::new(1.2, Color32::WHITE);
            painter.circle_stroke(at, RING, stroke);
            painter.hline(at.x - RING..=at.x + RING, at.y, stroke);
            painter.vline(at.x, at.y - RING..=at.y + RING, stroke);
        }
    }
}
