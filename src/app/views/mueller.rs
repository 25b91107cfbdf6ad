//! The Mueller matrix over m00: each element against θr at the sliders' θi and Δφ, and all sixteen at one θr as a heat map.
//!
//! Between the meridian bases [E_s, E_p] of the incident and the reflected ray.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::{FOREGROUND, MUTED};
use crate::app::plots::{ColorScale, Polyline, Range, ink_on, theme};
use crate::app::text::numbers::significant;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::directions;
use crate::app::work::open_measurement::IncidenceSeries;
use crate::app::work::settings::Settings;
use crate::figure::{Axis, ColorMap, Figure, Panel, SERIES, Series};
use egui::{Align2, Color32, DragValue, FontId, Key, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, vec2};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::Mueller;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Mueller matrix",
    tooltip: "All sixteen elements over m00 against θr, Eqs. (8, 9, 14), and as numbers at one direction",
    shortcut: Some(Key::Num6),
    has_options: false,
    has_figure: true,
    new: || Box::new(MuellerView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct MuellerView {
    curves: Memo<CurveKey, ElementCurves>,
    /// θr that the numbers belong to, in degrees, negative on the backscatter side; the mirror direction until the user chooses another.
    cursor: Option<f64>,
    matrix: Memo<(SurfaceKey, f64), Option<Mueller>>,
}

/// Parameters, model, θi, plane.
type SurfaceKey = (Parameters, Model, f64, f64);
/// And whether the backscatter side is drawn.
type CurveKey = (SurfaceKey, bool);

/// m_ij/m00 against θr, row by row; broken where there is no light.
#[derive(Default)]
struct ElementCurves([Polyline; 16]);

impl ElementCurves {
    fn new(&((parameters, model, theta_i, plane), backscatter): &CurveKey) -> Self {
        let mut curves = Self::default();
        let Ok(surface) = Pbrdf::new(model, parameters) else { return curves };
        let series = in_plane(theta_i, plane);
        for theta_r in directions(theta_i, backscatter) {
            let matrix = series.geometry(theta_r).map(|geometry| surface.mueller(geometry));
            for (element, curve) in curves.0.iter_mut().enumerate() {
                curve.push([theta_r, matrix.map_or(f64::NAN, |matrix| normalised(&matrix, element))]);
            }
        }
        curves
    }
}

fn in_plane(theta_i: f64, plane: f64) -> IncidenceSeries {
    IncidenceSeries { theta_i, plane, dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() }
}

/// m_ij/m00, i and j by the number of the element in reading order.
fn normalised(matrix: &Mueller, element: usize) -> f64 {
    matrix.element(element / 4, element % 4) / matrix.element(0, 0)
}

/// θr up to the last that is a direction, in steps of which the pointer chooses.
const LAST: f64 = 89.9;
const STEP: f64 = 0.1;

impl MuellerView {
    fn theta_r(&self, theta_i: f64, backscatter: bool) -> f64 {
        self.cursor.unwrap_or(theta_i).clamp(if backscatter { -LAST } else { 0.0 }, LAST)
    }

    /// The line with the choice of θr.
    fn choice_ui(&self, settings: &Settings, low: f64, theta_r: &mut f64, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            let help = tr!("θr of the numbers: also by pointing at the curves");
            let label = ui.label("θr").on_hover_text(&help);
            let range = low.max(-LAST)..=LAST;
            let field = DragValue::new(theta_r).range(range).speed(0.2).max_decimals(2).suffix("°");
            ui.add(field).labelled_by(label.id).on_hover_text(help);
            ui.label(tr!("at θi = {}°, Δφ = {}°", settings.theta_i, settings.dphi));
            if let Some(Some(matrix)) = self.matrix.get() {
                ui.label(tr!("m00 = {} 1/sr", significant(matrix.element(0, 0)))).on_hover_text(tr!("BRDF for unpolarised light in"));
            }
        });
    }
}

/// Below this width the heat map lies under the curves.
const SIDE_BY_SIDE: f32 = 430.0;
const LETTERS: f32 = 12.0;
/// Between the two parts.
const GAP: f32 = 14.0;

impl View for MuellerView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (settings, surface) = (cx.work.settings(), cx.work.surface());
        let surface = (surface.parameters, surface.model, settings.theta_i, settings.dphi.rem_euclid(360.0));
        let backscatter = settings.show_backscatter || cx.work.active().has_backscatter();
        self.curves.refresh((surface, backscatter), ElementCurves::new);
        let theta_r = self.theta_r(settings.theta_i, backscatter);
        self.matrix.refresh((surface, theta_r), |((parameters, model, theta_i, plane), theta_r)| {
            let geometry = in_plane(*theta_i, *plane).geometry(*theta_r)?;
            Some(Pbrdf::new(*model, *parameters).ok()?.mueller(geometry))
        });
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let settings = cx.work.settings();
        let low: f64 = if settings.show_backscatter || cx.work.active().has_backscatter() { -90.0 } else { 0.0 };
        let mut theta_r = self.theta_r(settings.theta_i, low < 0.0);
        let before = theta_r;
        self.choice_ui(settings, low, &mut theta_r, ui);
        let room = ui.available_size();
        let (rect, response) = ui.allocate_exact_size(room.max(vec2(120.0, 120.0)), Sense::hover());
        let painter = ui.painter_at(rect);
        let style = Style { ink: ui.visuals().text_color(), dark: ui.visuals().dark_mode };
        let [left, right] = parts(rect);
        let multiples = Multiples::new(left, Range { low, high: 90.0 });
        if let Some(curves) = self.curves.get() {
            multiples.draw(&painter, curves, theta_r, style);
        }
        if let Some(at) = response.hover_pos().and_then(|at| multiples.theta_r(at)) {
            theta_r = at.clamp(low.max(-LAST), LAST);
        }
        if let Some(Some(matrix)) = self.matrix.get() {
            heat_map(&painter, right, matrix, before, style);
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, spoken(matrix, before)));
        }
        if theta_r != before {
            self.cursor = Some(theta_r);
            ui.ctx().request_repaint();
        }
    }

    /// Sixteen plots against θr, and all elements as numbers at the θr of the pane.
    fn figure(&self, cx: &Cx<'_>) -> Option<Figure> {
        let (curves, ((_, _, theta_i, plane), backscatter)) = (self.curves.get()?, self.curves.key()?);
        let matrix = self.matrix.get().and_then(Option::as_ref).zip(self.matrix.key().map(|key| key.1));
        let reach = f64::from(REACH);
        let panels = curves.0.iter().enumerate().map(|(element, curve)| {
            let mut series = vec![Series::line("", curve.clone()).colored(SERIES[0])];
            let mut title = String::new();
            if let Some((matrix, theta_r)) = matrix {
                let value = normalised(matrix, element);
                series.insert(0, Series::upright("", theta_r).colored(MUTED));
                series.push(Series::points("", [[theta_r, value]]).colored(FOREGROUND));
                // On the free side of the curve.
                let beside = if value > 0.0 { value - NUMBER } else { value + NUMBER };
                series.push(Series::labels(vec![([theta_r, beside], number(value))]));
                if element == 0 {
                    let m00 = significant(matrix.element(0, 0));
                    title = tr!("numbers at θr = {0}°, m00 = {1} sr⁻¹", format!("{theta_r:.1}"), m00);
                }
            }
            Panel {
                title,
                x: Axis::linear("θr", "°").between(if *backscatter { -90.0 } else { 0.0 }, 90.0),
                y: Axis::linear(format!("m{}{} / m00", element / 4, element % 4), "").between(-reach, reach),
                series,
                legend: false,
                ..Panel::default()
            }
        });
        let title = tr!("{0}: Mueller matrix at θi = {1}°, Δφ = {2}°", cx.work.active().title(), theta_i, plane);
        Some(Figure { title, panels: panels.collect(), columns: 4, width_mm: 190.0, height_mm: 180.0 })
    }
}

/// Distance of a number from its value in a figure.
const NUMBER: f64 = 0.25;

/// Where the curves and where the heat map lie.
fn parts(rect: Rect) -> [Rect; 2] {
    if rect.width() > SIDE_BY_SIDE {
        let width = (0.4 * rect.width()).min(rect.height());
        let [left, mut right] = {
            let (left, right) = rect.split_left_right_at_x(rect.right() - width);
            [left, right]
        };
        right.min.x += GAP;
        [left, right]
    } else {
        let (upper, mut lower) = rect.split_top_bottom_at_y(rect.top() + 0.55 * rect.height());
        lower.min.y += GAP;
        [upper, lower]
    }
}

#[derive(Debug, Clone, Copy)]
struct Style {
    ink: Color32,
    dark: bool,
}

/// Sixteen small plots with common axes.
struct Multiples {
    /// All cells together.
    rect: Rect,
    x: Range,
}

/// Room for the numbers at the axes.
const LEFT: f32 = 26.0;
const BELOW: f32 = 34.0;
/// Between cells.
const SEAM: f32 = 3.0;
/// Ends of the common axis of values: a little beyond what any matrix reaches.
const REACH: f32 = 1.12;

impl Multiples {
    fn new(room: Rect, x: Range) -> Self {
        Self { rect: Rect::from_min_max(room.min + vec2(LEFT, 6.0), room.max - vec2(6.0, BELOW)), x }
    }

    fn cell(&self, row: usize, column: usize) -> Rect {
        #[expect(clippy::cast_precision_loss, reason = "0 to 3")]
        let at = vec2(column as f32, row as f32);
        let size = 0.25 * (self.rect.size() - 3.0 * vec2(SEAM, SEAM));
        Rect::from_min_size(self.rect.min + at * (size + vec2(SEAM, SEAM)), size)
    }

    fn place(&self, cell: Rect, theta_r: f64, value: f64) -> Pos2 {
        #[expect(clippy::cast_possible_truncation, reason = "a place on the screen")]
        let (x, y) = (((theta_r - self.x.low) / (self.x.high - self.x.low)) as f32, value as f32);
        Pos2::new(cell.left() + x * cell.width(), cell.center().y - 0.5 * cell.height() * y / REACH)
    }

    /// The θr under the pointer, in whichever cell it is.
    fn theta_r(&self, at: Pos2) -> Option<f64> {
        let cells = (0..16).map(|element| self.cell(element / 4, element % 4));
        let cell = cells.into_iter().find(|cell| cell.contains(at))?;
        let share = f64::from((at.x - cell.left()) / cell.width());
        Some(((self.x.low + share * (self.x.high - self.x.low)) / STEP).round() * STEP)
    }

    fn draw(&self, painter: &Painter, curves: &ElementCurves, theta_r: f64, style: Style) {
        let font = FontId::proportional(LETTERS);
        let grid = Stroke::new(1.0, theme::grid(style.dark));
        for (element, curve) in curves.0.iter().enumerate() {
            let (row, column) = (element / 4, element % 4);
            let cell = self.cell(row, column);
            for value in [-1.0, 0.0, 1.0] {
                painter.hline(cell.x_range(), self.place(cell, 0.0, value).y, grid);
            }
            painter.vline(self.place(cell, theta_r, 0.0).x, cell.y_range(), Stroke::new(1.0, theme::muted(style.dark)));
            let inside = painter.with_clip_rect(cell);
            for piece in curve.split(|point| !point[1].is_finite()) {
                inside.add(Shape::line(self.thinned(cell, piece), Stroke::new(1.5, theme::series(0, style.dark))));
            }
            painter.rect_stroke(cell, 0.0, grid, StrokeKind::Inside);
            let label = painter.layout_no_wrap(format!("m{row}{column}"), font.clone(), style.ink);
            // Where the curve seldom is: m00 is 1, and m11 is near it.
            let (anchor, corner) = if matches!(element, 0 | 5) {
                (Align2::LEFT_BOTTOM, cell.left_bottom() + vec2(3.0, -2.0))
            } else {
                (Align2::LEFT_TOP, cell.left_top() + vec2(3.0, 2.0))
            };
            let corner = anchor.anchor_size(corner, label.size());
            painter.rect_filled(corner.expand2(vec2(2.0, 0.0)), 2.0, background(style.dark).gamma_multiply(0.8));
            painter.galley(corner.min, label, style.ink);
        }
        self.draw_axes(painter, &font, style.ink);
    }

    /// The curve without points that would fall together on the screen.
    fn thinned(&self, cell: Rect, piece: &[[f64; 2]]) -> Vec<Pos2> {
        let mut points: Vec<Pos2> = Vec::new();
        for &[theta_r, value] in piece {
            let point = self.place(cell, theta_r, value);
            match points.last() {
                Some(last) if (point - *last).length_sq() < 1.0 => {}
                _ => points.push(point),
            }
        }
        points
    }

    fn draw_axes(&self, painter: &Painter, font: &FontId, ink: Color32) {
        let small = FontId::proportional(LETTERS - 1.0);
        for row in 0..4 {
            let cell = self.cell(row, 0);
            let values = if cell.height() > 40.0 { &[-1.0, 0.0, 1.0][..] } else { &[0.0] };
            for value in values {
                let at = self.place(cell, self.x.low, *value) - vec2(3.0, 0.0);
                painter.text(at, Align2::RIGHT_CENTER, value.to_string(), small.clone(), ink);
            }
        }
        let middle = f64::midpoint(self.x.low, self.x.high);
        for column in 0..4 {
            let cell = self.cell(3, column);
            // Both ends of neighbours would run into each other, and in narrow cells all three marks.
            let wide = cell.width() > 100.0;
            for (theta_r, anchor, is_drawn) in [
                (self.x.low, Align2::LEFT_TOP, column == 0),
                (middle, Align2::CENTER_TOP, wide || (1..3).contains(&column)),
                (self.x.high, Align2::RIGHT_TOP, wide || column == 3),
            ] {
                if is_drawn {
                    let at = Pos2::new(self.place(cell, theta_r, 0.0).x, cell.bottom() + 2.0);
                    painter.text(at, anchor, theta_r.to_string(), small.clone(), ink);
                }
            }
        }
        let at = Pos2::new(self.rect.center().x, self.rect.bottom() + BELOW);
        painter.text(at, Align2::CENTER_BOTTOM, tr!("θr / °: each element over m00"), font.clone(), ink);
    }
}

fn background(dark: bool) -> Color32 {
    if dark { Color32::from_gray(27) } else { Color32::from_gray(248) }
}

/// Colours of −1 to 1.
const SCALE: ColorScale = ColorScale { map: ColorMap::Diverging, range: Range { low: -1.0, high: 1.0 } };

/// The matrix as a table of colours and numbers.
fn heat_map(painter: &Painter, room: Rect, matrix: &Mueller, theta_r: f64, style: Style) {
    let title = tr!("m / m00 at θr = {}°", format!("{theta_r:.1}"));
    let head = 28.0;
    let side = room.width().min(room.height() - head).max(40.0);
    let top = Pos2::new(room.center().x, room.top() + 6.0);
    painter.text(top, Align2::CENTER_TOP, title, FontId::proportional(LETTERS), style.ink);
    let corner = Pos2::new(room.center().x - 0.5 * side, room.top() + head);
    let cell = 0.25 * side;
    let letters = (0.26 * cell).clamp(9.0, 15.0);
    for element in 0..16 {
        #[expect(clippy::cast_precision_loss, reason = "0 to 3")]
        let at = vec2((element % 4) as f32, (element / 4) as f32);
        let rect = Rect::from_min_size(corner + cell * at, vec2(cell, cell)).shrink(1.0);
        let value = normalised(matrix, element);
        let color = SCALE.color(value);
        painter.rect(rect, 2.0, color, Stroke::new(1.0, theme::grid(style.dark)), StrokeKind::Inside);
        painter.text(rect.center(), Align2::CENTER_CENTER, number(value), FontId::proportional(letters), ink_on(color));
    }
}

/// An element as it is written in the table.
fn number(value: f64) -> String {
    match value {
        _ if value.is_nan() => "–".to_owned(),
        0.0 => "0".to_owned(),
        _ if value.abs() < 5e-4 => if value > 0.0 { "+0" } else { "-0" }.to_owned(),
        _ => format!("{value:.3}"),
    }
}

/// The matrix for a screen reader, row by row.
fn spoken(matrix: &Mueller, theta_r: f64) -> String {
    let elements: Vec<String> = (0..16).map(|element| number(normalised(matrix, element))).collect();
    let rows: Vec<String> = elements.chunks(4).map(|row| row.join(" ")).collect();
    format!("{}: {}", tr!("Mueller matrix over m00 at θr = {}°", format!("{theta_r:.1}")), rows.join("; "))
}

#[cfg(test)]
mod tests {
    use super::{ElementCurves, Multiples, Range, number};
    use egui::{Rect, pos2};
    use pbrdf::model::{Model, Parameters};
    use pbrdf::optics::SlopeDistribution;

    #[test]
    fn the_pointer_finds_the_theta_r_under_it_in_every_cell() {
        let multiples = Multiples::new(Rect::from_min_max(pos2(10.0, 20.0), pos2(410.0, 330.0)), Range { low: -90.0, high: 90.0 });
        for element in 0..16 {
            let cell = multiples.cell(element / 4, element % 4);
            let at = multiples.place(cell, 37.3, 0.2);
            // Steps of 0.1° and places in single precision.
            assert!((multiples.theta_r(at).expect("inside") - 37.3).abs() < 0.1 + 1e-3);
        }
        assert_eq!(multiples.theta_r(pos2(0.0, 0.0)), None);
    }

    #[test]
    fn a_curve_is_broken_where_there_is_no_light() {
        let dark = Parameters { ks: 0.0, kd: 0.0, kv: 0.0, ..Parameters::default() };
        let model = Model::full(SlopeDistribution::Gauss);
        assert!(ElementCurves::new(&((dark, model, 40.0, 180.0), true)).0.iter().flatten().all(|[_, value]| value.is_nan()));
        let lit = ElementCurves::new(&((Parameters::default(), model, 40.0, 180.0), true));
        assert!(lit.0.iter().all(|curve| curve.len() > 300 && curve.iter().all(|[_, value]| value.is_finite())));
    }

    #[test]
    fn numbers_tell_nothing_from_little() {
        for (value, expected) in
            [(0.0, "0"), (-0.0, "0"), (1e-9, "+0"), (-1e-9, "-0"), (-0.1234, "-0.123"), (1.0, "1.000"), (f64::NAN, "–")]
        {
            assert_eq!(number(value), expected);
        }
    }
}
