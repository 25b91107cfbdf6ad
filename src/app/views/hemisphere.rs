//! Hemisphere map: DoLP, angle of polarisation, BRDF or specular share over all directions of view at the sliders' θi.
//!
//! The disc is that of [`pbrdf::model::Hemisphere`]: light from the left, forward side to the right, θr = 90° at the rim.

mod figure;

pub use figure::hemisphere_figure;

use crate::app::jobs::async_memo::{AsyncMemo, Stopped};
use crate::app::jobs::memo::Memo;
use crate::app::plots::{BAR_ROOM, BarLabels, BarMarks, ColorScale, Following, Range, color_bar, round_up};
use crate::app::shell::app::App;
use crate::app::views::curves::{DECADES, MOST_POINTS, SETS_AXES};
use crate::app::work::document::Document;
use crate::app::work::settings::Quantity;
use crate::app::work::workspace::Workspace;
use crate::figure::ColorMap;
use egui::{Align2, Color32, ColorImage, FontId, Painter, Pos2, Rect, Sense, Stroke, TextureHandle, TextureOptions, Ui, Vec2, vec2};
use pbrdf::model::{Hemisphere, HemisphereMap, Model, Parameters, Pbrdf};
use pbrdf::optics::{Degrees, Geometry};
use std::sync::Arc;
use tr::tr;

/// Cells along an edge of the map.
pub const SIZE: usize = 256;

/// What the pane keeps.
#[derive(Default)]
pub struct HemisphereView {
    job: AsyncMemo<MapKey, Option<Made>>,
    ranges: [Following; Quantity::ALL.len()],
    colored: Memo<(MapKey, Quantity, ColorScale), ()>,
    /// An image that the texture does not show yet.
    fresh: Option<ColorImage>,
    texture: Option<TextureHandle>,
    /// Directions measured at the sliders' θi, as places on the disc of radius 1.
    measured: Memo<(u64, f64), Vec<Vec2>>,
}

/// Parameters, model, θi.
type MapKey = (Parameters, Model, f64);

/// What the job makes.
pub struct Made {
    /// Kept for the next surface at the same θi.
    hemisphere: Arc<Hemisphere>,
    theta_i: f64,
    map: HemisphereMap,
    /// Smallest and largest value of each quantity, as it is coloured.
    extremes: [(f64, f64); Quantity::ALL.len()],
}

impl Made {
    fn new(surface: &Pbrdf, theta_i: f64, before: Option<Arc<Hemisphere>>, stopped: Stopped<'_>) -> Option<Self> {
        let prepared = || Some(Arc::new(Hemisphere::new(theta_i, SIZE, stopped).ok()??));
        let hemisphere = before.or_else(prepared)?;
        let mut map = hemisphere.map(surface, stopped)?;
        // Coloured by its decades.
        map.brdf.iter_mut().for_each(|brdf| *brdf = libm::log10(*brdf));
        let extremes = Quantity::ALL.map(|quantity| extremes(values(&map, quantity)));
        Some(Self { hemisphere, theta_i, map, extremes })
    }

    fn image(&self, quantity: Quantity, scale: ColorScale) -> ColorImage {
        let table = scale.table();
        // The first row of an image is the uppermost, that of a map has the smallest y.
        let rows = values(&self.map, quantity).chunks(SIZE).rev();
        ColorImage::new([SIZE; 2], rows.flatten().map(|&value| table.color(value)).collect())
    }
}

/// The values that are coloured, cell by cell; of the BRDF the logarithms.
fn values(map: &HemisphereMap, quantity: Quantity) -> &[f64] {
    match quantity {
        Quantity::Dolp => &map.dolp,
        Quantity::Angle => &map.angle,
        Quantity::Brdf => &map.brdf,
        Quantity::SpecularShare => &map.specular_share,
    }
}

/// The ends of what is finite and not at the horizon, where a Minnaert lobe has no bound.
fn extremes(values: &[f64]) -> (f64, f64) {
    // Of the disc of radius 1 that has the horizon at its rim; a square of the radius needs no angle.
    let rim = (SETS_AXES / 90.0) * (SETS_AXES / 90.0);
    let mut ends = (f64::INFINITY, f64::NEG_INFINITY);
    for (row, values) in values.chunks(SIZE).enumerate() {
        let y = center(row);
        for (column, &value) in values.iter().enumerate() {
            let x = center(column);
            if value.is_finite() && x * x + y * y <= rim {
                ends = (ends.0.min(value), ends.1.max(value));
            }
        }
    }
    ends
}

/// Where a cell lies between −1 and 1.
#[expect(clippy::cast_precision_loss, reason = "a number of cells")]
fn center(index: usize) -> f64 {
    (2.0 * index as f64 + 1.0) / SIZE as f64 - 1.0
}

/// The range of colours that fits the values.
fn wanted(quantity: Quantity, (low, high): (f64, f64)) -> Range {
    match quantity {
        Quantity::Dolp => Range { low: 0.0, high: if high <= 1.0 { round_up(high).min(1.0) } else { round_up(high) } },
        Quantity::Angle => Range { low: -90.0, high: 90.0 },
        Quantity::SpecularShare => Range { low: 0.0, high: 1.0 },
        Quantity::Brdf if !high.is_finite() => Range { low: -1.0, high: 0.0 },
        Quantity::Brdf => {
            // By half decades.
            let high = 0.5 * (2.0 * high).ceil();
            Range { low: (0.5 * (2.0 * low).floor()).clamp(high - DECADES, high - 1.0), high }
        }
    }
}

impl Quantity {
    fn colors(self) -> ColorMap {
        if self == Self::Angle { ColorMap::Cyclic } else { ColorMap::Sequential }
    }

    /// Its name and what the pointer finds out about it.
    fn texts(self) -> [String; 2] {
        match self {
            Self::Dolp => [tr!("DoLP"), tr!("Degree of linear polarisation for unpolarised light in, Eq. (17)")],
            Self::Angle => [
                tr!("Angle of polarisation"),
                tr!("½ atan2(F20, F10): how far the electric vector is turned from s, which is horizontal, towards p"),
            ],
            Self::Brdf => [tr!("BRDF"), tr!("F00, Eq. (14), on a logarithmic scale")],
            Self::SpecularShare => [tr!("Specular share"), tr!("The specular lobe's part of the radiance")],
        }
    }

    /// A value in words.
    fn reading(self, value: f64) -> String {
        match self {
            _ if value.is_nan() => tr!("nothing to tell"),
            Self::Dolp => tr!("DoLP = {}", format!("{value:.5}")),
            Self::Angle => tr!("angle of polarisation = {}°", format!("{:.2}", value + 0.0)),
            Self::Brdf => tr!("BRDF = {} 1/sr", format!("{:.4e}", libm::exp10(value))),
            Self::SpecularShare => tr!("specular share = {}", format!("{value:.5}")),
        }
    }
}

impl HemisphereView {
    /// What is known at a place of the disc, x to the right and y upwards; none outside it.
    fn reading(&self, x: f64, y: f64, quantity: Quantity) -> Option<String> {
        let map = &self.job.get()?.as_ref()?.map;
        let (row, column) = (index(y)?, index(x)?);
        let (theta_r, dphi) = map.direction(row, column)?;
        let value = values(map, quantity)[row * SIZE + column];
        let at = tr!("θr = {}°, Δφ = {}°", format!("{theta_r:.2}"), format!("{dphi:.2}"));
        Some(format!("{at}: {}", quantity.reading(value)))
    }

    /// Stops the job on its way, where nobody looks.
    pub fn rest(&mut self) {
        self.job.stop_if(|_| true);
    }

    /// How many frames the map is behind the sliders.
    pub fn frames_behind(&self) -> u64 {
        self.job.frames_behind()
    }

    /// Whether a map is being made.
    #[cfg(test)]
    pub fn is_running(&self) -> bool {
        self.job.is_running()
    }

    /// Whether the next frame changes the texture.
    #[cfg(test)]
    pub fn is_fresh(&self) -> bool {
        self.fresh.is_some()
    }

    /// The inputs of the newest map.
    #[cfg(test)]
    pub fn key(&self) -> Option<&MapKey> {
        self.job.key()
    }
}

/// The cell between −1 and 1 that a coordinate lies in.
fn index(coordinate: f64) -> Option<usize> {
    #[expect(clippy::cast_precision_loss, reason = "a number of cells")]
    let place = 0.5 * (coordinate + 1.0) * SIZE as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be within the grid")]
    (-1.0..1.0).contains(&coordinate).then_some(place as usize)
}

/// Where a direction lies on the disc of radius 1, x to the right and y upwards.
fn place(theta_r: f64, dphi: f64) -> Vec2 {
    let (sin, cos) = Degrees(dphi - 180.0).sin_cos();
    #[expect(clippy::cast_possible_truncation, reason = "a place on the screen")]
    let at = |coordinate: f64| (theta_r / 90.0 * coordinate) as f32;
    vec2(at(cos), at(sin))
}

/// Directions measured at that θi.
fn measured(document: &Document, theta_i: f64) -> Vec<Vec2> {
    let geometries = document.measurement.rows.iter().map(|row| row.geometry);
    let at = geometries.filter(|geometry| geometry.theta_i() == Degrees(theta_i));
    at.map(|geometry: Geometry| place(geometry.theta_r().0, geometry.dphi().0)).take(MOST_POINTS).collect()
}

pub fn hemisphere_refresh(explorer: &mut App) {
    let App { work: Workspace { settings, document, .. }, views, background, dragging, .. } = explorer;
    let view = &mut views.hemisphere;
    let (parameters, model, theta_i) = (settings.parameters, settings.model, settings.theta_i);
    let Ok(surface) = Pbrdf::new(model, parameters) else {
        // Values that are not numbers differ from themselves: a job would follow a job for ever.
        view.job = AsyncMemo::default();
        return;
    };
    let before = view.job.get().and_then(Option::as_ref).filter(|made| made.theta_i == theta_i).map(|made| made.hemisphere.clone());
    view.job.refresh(background, &(parameters, model, theta_i), move |stopped| Made::new(&surface, theta_i, before, stopped));
    view.measured.refresh((document.generation, theta_i), |_| measured(document, theta_i));
    let (Some(key), Some(Some(made))) = (view.job.key(), view.job.get()) else { return };
    let quantity = settings.shown.hemisphere;
    let range = &mut view.ranges[quantity as usize];
    range.follow(wanted(quantity, made.extremes[quantity as usize]), *dragging);
    let Some(scale) = range.get().map(|range| ColorScale { map: quantity.colors(), range }) else { return };
    let fresh = &mut view.fresh;
    view.colored.refresh((*key, quantity, scale), |_| *fresh = Some(made.image(quantity, scale)));
}

/// Room around the disc for its labels.
const MARGIN: Vec2 = vec2(34.0, 20.0);
const LETTERS: f32 = 12.0;

pub fn hemisphere_ui(explorer: &mut App, ui: &mut Ui) {
    let App { work: Workspace { settings, .. }, views, .. } = explorer;
    let view = &mut views.hemisphere;
    ui.horizontal_wrapped(|ui| {
        for quantity in Quantity::ALL {
            let [name, help] = quantity.texts();
            ui.selectable_value(&mut settings.shown.hemisphere, quantity, name).on_hover_text(help);
        }
    });
    let quantity = settings.shown.hemisphere;
    if let Some(image) = view.fresh.take() {
        match &mut view.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => view.texture = Some(ui.ctx().load_texture("hemisphere", image, TextureOptions::LINEAR)),
        }
    }
    // So high whatever the lines say: the map does not jump.
    let lines = if ui.available_width() < 430.0 { 4.0 } else { 2.0 };
    let below = lines * (ui.text_style_height(&egui::TextStyle::Body) + ui.spacing().item_spacing.y);
    let room = vec2(ui.available_width(), (ui.available_height() - below).max(60.0));
    let (rect, response) = ui.allocate_exact_size(room, Sense::hover());
    let radius = 0.5 * (room.x - 2.0 * MARGIN.x - BAR_ROOM).min(room.y - 2.0 * MARGIN.y).max(20.0);
    let disc = Disc { center: rect.center() - vec2(0.5 * BAR_ROOM, 0.0), radius };
    let painter = ui.painter_at(rect);
    let (ink, dark) = (ui.visuals().text_color(), ui.visuals().dark_mode);
    let is_there = matches!(view.job.get(), Some(Some(_)));
    if let (Some(texture), true) = (&view.texture, is_there) {
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        painter.image(texture.id(), disc.square(), whole, Color32::WHITE);
    }
    disc.draw_directions(&painter, ink);
    for at in view.measured.get().into_iter().flatten() {
        measured_mark(&painter, disc.at(*at));
    }
    incident_mark(&painter, disc.at(place(settings.theta_i, 0.0)));
    mirror_mark(&painter, disc.at(place(settings.theta_i, 180.0)));
    if let Some(range) = view.ranges[quantity as usize].get() {
        let at = Pos2::new(disc.center.x + radius + MARGIN.x + 6.0, disc.center.y - radius);
        color_bar(ui, at, 2.0 * radius, ColorScale { map: quantity.colors(), range }, &labels(quantity), ink, dark);
    }
    let reading = response.hover_pos().and_then(|at| {
        let at = (at - disc.center) / radius;
        view.reading(f64::from(at.x), f64::from(-at.y), quantity)
    });
    let name = quantity.texts()[0].clone();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, tr!("Map of all directions of view: {}", name)));
    ui.label(reading.unwrap_or_else(|| tr!("The pointer over the map reads a value.")));
    let count = view.measured.get().map_or(0, Vec::len);
    legend_ui(settings.theta_i, count, ui);
}

/// What stands at the colour bar.
fn labels(quantity: Quantity) -> BarLabels<'static> {
    match quantity {
        Quantity::Dolp => BarLabels { title: "DoLP", marks: BarMarks::Linear },
        Quantity::Angle => BarLabels { title: "°", marks: BarMarks::At(&[-90.0, -45.0, 0.0, 45.0, 90.0]) },
        Quantity::Brdf => BarLabels { title: "1/sr", marks: BarMarks::Log },
        Quantity::SpecularShare => BarLabels { title: "", marks: BarMarks::Linear },
    }
}

/// Draws a mark.
type Mark = fn(&Painter, Pos2);

/// What the marks on the map mean.
fn legend_ui(theta_i: f64, count: usize, ui: &mut Ui) {
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
fn incident_mark(painter: &Painter, at: Pos2) {
    painter.circle(at, 4.5, WHITE, Stroke::new(1.5, BLACK));
}

/// The mirror direction: a cross.
fn mirror_mark(painter: &Painter, at: Pos2) {
    for stroke in [Stroke::new(4.0, BLACK), Stroke::new(2.0, WHITE)] {
        for arm in [vec2(4.0, 4.0), vec2(4.0, -4.0)] {
            painter.line_segment([at - arm, at + arm], stroke);
        }
    }
}

/// A measured direction: a small ring.
fn measured_mark(painter: &Painter, at: Pos2) {
    painter.circle_stroke(at, 2.5, Stroke::new(2.5, BLACK));
    painter.circle_stroke(at, 2.5, Stroke::new(1.2, WHITE));
}

/// Where the disc lies on the screen.
#[derive(Debug, Clone, Copy)]
struct Disc {
    center: Pos2,
    radius: f32,
}

impl Disc {
    fn square(self) -> Rect {
        Rect::from_center_size(self.center, Vec2::splat(2.0 * self.radius))
    }

    /// From a place on the disc of radius 1, y upwards.
    fn at(self, place: Vec2) -> Pos2 {
        self.center + self.radius * vec2(place.x, -place.y)
    }

    /// Rings of θr and the labels of Δφ.
    fn draw_directions(self, painter: &Painter, ink: Color32) {
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

#[cfg(test)]
mod tests {
    use super::{ColorScale, Made, Quantity, Range, SIZE, extremes, index, place, values, wanted};
    use pbrdf::model::{Model, Parameters, Pbrdf};
    use pbrdf::optics::SlopeDistribution;

    #[test]
    fn the_image_has_the_values_of_the_map_with_y_upwards() {
        let surface = Pbrdf::new(Model::full(SlopeDistribution::Cauchy), Parameters::default()).expect("the defaults");
        let made = Made::new(&surface, 50.0, None, &|| false).expect("a map");
        // On either side of the plane of incidence the angle of polarisation has the other sign.
        let scale = ColorScale { map: Quantity::Angle.colors(), range: Range { low: -90.0, high: 90.0 } };
        let image = made.image(Quantity::Angle, scale);
        let (row, column) = (3 * SIZE / 4, SIZE / 2);
        let (theta_r, dphi) = made.map.direction(row, column).expect("inside the disc");
        let at = place(theta_r, dphi);
        assert!(at.y > 0.4, "above the middle: {at:?}");
        let value = values(&made.map, Quantity::Angle)[row * SIZE + column];
        assert!(value.abs() > 5.0);
        assert_eq!(image.pixels[(SIZE - 1 - row) * SIZE + column], scale.table().color(value));
        assert_ne!(image.pixels[row * SIZE + column], scale.table().color(value));
    }

    #[test]
    fn light_comes_from_the_left_and_the_mirror_is_to_the_right() {
        for (dphi, x, y) in [(0.0, -0.5, 0.0), (180.0, 0.5, 0.0), (270.0, 0.0, 0.5), (90.0, 0.0, -0.5)] {
            let at = place(45.0, dphi);
            assert_eq!((at.x, at.y), (x, y), "{dphi}");
        }
        assert_eq!((index(-1.0), index(0.999_9), index(1.0), index(-1.1)), (Some(0), Some(255), None, None));
    }

    #[test]
    fn colours_span_what_is_above_the_horizon() {
        let mut map = vec![f64::NAN; SIZE * SIZE];
        // In the middle, at θr of about 79° and of about 82°.
        for (column, value) in [(SIZE / 2, 0.2), (SIZE / 2 + 112, 0.7), (SIZE / 2 + 117, 9.0)] {
            map[SIZE / 2 * SIZE + column] = value;
        }
        assert_eq!(extremes(&map), (0.2, 0.7));
    }

    #[test]
    fn colours_reach_the_largest_value_and_no_impossible_one() {
        assert_eq!(wanted(Quantity::Dolp, (0.0, 0.97)), Range { low: 0.0, high: 1.0 });
        assert_eq!(wanted(Quantity::Dolp, (0.0, 0.04)), Range { low: 0.0, high: 0.05 });
        // Eq. (17) as printed divides by k_s.
        assert_eq!(wanted(Quantity::Dolp, (0.0, 1.9)), Range { low: 0.0, high: 2.0 });
        assert_eq!(wanted(Quantity::Brdf, (-2.3, 0.1)), Range { low: -2.5, high: 0.5 });
        assert_eq!(wanted(Quantity::Brdf, (-80.0, 0.1)), Range { low: -7.5, high: 0.5 });
    }
}
