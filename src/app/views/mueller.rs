//! The Mueller matrix over m00: each element against θr at the sliders' θi and Δφ, and all sixteen
//! at one θr as a heat map.
//!
//! Between the meridian bases [E_s, E_p] of the incident and the reflected ray.

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::{FOREGROUND, MUTED};
use crate::app::plots::{ColorScale, FigurePlot, Polyline, Range, theme};
use crate::app::text::explained::Explained as _;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::numbers::significant;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::directions;
use crate::app::work::open_measurement::IncidenceSeries;
use crate::app::work::settings::Settings;
use crate::figure::{Axis, ColorMap, Figure, Panel, SERIES, Series};
use egui::{Align2, DragValue, FontId, Key, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo, vec2};
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
    /// θr that the numbers belong to, in degrees, negative on the backscatter side; the mirror
    /// direction until the user chooses another.
    cursor: Option<f64>,
    /// The angle of view picked in the picture that the numbers went to last.
    picked: Option<f64>,
    matrix: Memo<(SurfaceKey, f64), Option<Mueller>>,
    /// Of curves and matrix by their stamps; the language.
    plot: FigurePlot<([u64; 2], Language)>,
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
                ui.label(tr!("m00 = {} sr⁻¹", significant(matrix.element(0, 0)))).explained(tr!("BRDF for unpolarised light in"));
            }
        });
    }
}

/// Below this width the heat map lies under the curves, unless there is so much more width than height.
const SIDE_BY_SIDE: f32 = 430.0;
const WIDE: f32 = 1.3;
const LETTERS: f32 = 12.0;
/// Between the two parts.
const GAP: f32 = 14.0;

impl View for MuellerView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (settings, surface) = (cx.work.settings(), cx.work.surface());
        let surface = (surface.parameters, surface.model, settings.theta_i, settings.dphi.rem_euclid(360.0));
        let backscatter = settings.show_backscatter || cx.work.active().has_backscatter();
        self.curves.refresh((surface, backscatter), ElementCurves::new);
        let picked = cx.derived.picked_theta_r(cx.work);
        if std::mem::replace(&mut self.picked, picked) != picked {
            self.cursor = picked.or(self.cursor);
        }
        let theta_r = self.theta_r(settings.theta_i, backscatter);
        self.matrix.refresh((surface, theta_r), |((parameters, model, theta_i, plane), theta_r)| {
            let geometry = in_plane(*theta_i, *plane).geometry(*theta_r)?;
            Some(Pbrdf::new(*model, *parameters).ok()?.mueller(geometry))
        });
        let title = cx.work.active().title();
        let mut plot = std::mem::take(&mut self.plot);
        plot.refresh(([self.curves.stamp(), self.matrix.stamp()], i18n::current()), |_| self.describe(&title));
        self.plot = plot;
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let settings = cx.work.settings();
        let low: f64 = if settings.show_backscatter || cx.work.active().has_backscatter() { -90.0 } else { 0.0 };
        let mut theta_r = self.theta_r(settings.theta_i, low < 0.0);
        let before = theta_r;
        self.choice_ui(settings, low, &mut theta_r, ui);
        let room = ui.available_size();
        let (rect, response) = ui.allocate_exact_size(room.max(vec2(120.0, 120.0)), Sense::hover());
        let [left, right] = parts(rect);
        if let Some(at) = self.curves_ui(left, ui) {
            theta_r = ((at / STEP).round() * STEP).clamp(low.max(-LAST), LAST);
        }
        if let Some(Some(matrix)) = self.matrix.get() {
            table_ui(right, matrix, before, ui);
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, spoken(matrix, before)));
        }
        if theta_r != before {
            self.cursor = Some(theta_r);
            ui.ctx().request_repaint();
        }
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

impl MuellerView {
    /// The sixteen plots; the θr under the pointer.
    fn curves_ui(&mut self, room: Rect, ui: &mut Ui) -> Option<f64> {
        let cell = 0.25 * (room.size() - vec2(LEFT, BELOW) - 3.0 * vec2(SEAM, SEAM));
        let mut pointed = None;
        for (element, panel) in self.plot.panels().iter_mut().enumerate() {
            let (row, column) = (element / 4, element % 4);
            // Numbers stand at the left and at the lower rim.
            let rim = [row == 3, column == 0];
            #[expect(clippy::cast_precision_loss, reason = "0 to 3")]
            let corner = room.min + vec2(LEFT, 0.0) + vec2(column as f32, row as f32) * (cell + vec2(SEAM, SEAM));
            let (left, below) = (if rim[1] { LEFT } else { 0.0 }, if rim[0] { BELOW } else { 0.0 });
            let place = Rect::from_min_size(corner - vec2(left, 0.0), cell + vec2(left, below));
            let mut child = ui.new_child(UiBuilder::new().id_salt(element).max_rect(place));
            let at = panel.cell_ui(place.size(), rim, vec2(LEFT, BELOW), &mut child);
            pointed = pointed.or(at);
        }
        // One title for the four at the lower rim.
        let at = Pos2::new(room.left() + LEFT + 0.5 * (room.width() - LEFT), room.bottom());
        ui.painter().text(at, Align2::CENTER_BOTTOM, "θr / °", FontId::proportional(LETTERS), ui.visuals().text_color());
        pointed
    }

    /// Sixteen plots against θr, and all elements as numbers at the θr of the pane.
    fn describe(&self, title: &str) -> Option<Figure> {
        let (curves, ((_, _, theta_i, plane), backscatter)) = (self.curves.get()?, self.curves.key()?);
        let matrix = self.matrix.get().and_then(Option::as_ref).zip(self.matrix.key().map(|key| key.1));
        let low = if *backscatter { -90.0 } else { 0.0 };
        // None at the upper end, where the next plot begins.
        let angles = if *backscatter { [-60.0, 0.0, 60.0] } else { [0.0, 30.0, 60.0] };
        let angles = angles.map(|at| (at, at.to_string().replace('-', "−"))).to_vec();
        let values = [(-1.0, "−1"), (0.0, "0"), (1.0, "1")].map(|(at, label)| (at, label.to_owned())).to_vec();
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
                x: Axis { ticks: Some(angles.clone()), ..Axis::linear("θr", "°") }.between(low, 90.0),
                y: Axis { ticks: Some(values.clone()), ..Axis::linear(format!("m{}{} / m00", element / 4, element % 4), "") }
                    .between(-REACH, REACH),
                series,
                legend: false,
                ..Panel::default()
            }
        });
        let title = tr!("{0}: Mueller matrix at θi = {1}°, Δφ = {2}°", title, theta_i, plane);
        Some(Figure { title, panels: panels.collect(), columns: 4, width_mm: 190.0, height_mm: 180.0, ..Figure::default() })
    }
}

/// Distance of a number from its value in a figure.
const NUMBER: f64 = 0.25;

/// Where the curves and where the heat map lie.
fn parts(rect: Rect) -> [Rect; 2] {
    if rect.width() > SIDE_BY_SIDE.min(WIDE * rect.height()) {
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

/// Room for the numbers at the axes, and between cells.
const LEFT: f32 = 26.0;
const BELOW: f32 = 34.0;
const SEAM: f32 = 3.0;
/// Ends of the common axis of values: beyond what any matrix reaches, so that −1 keeps off the 1 of the row below.
const REACH: f64 = 1.25;

/// Colours of −1 to 1.
const SCALE: ColorScale = ColorScale { map: ColorMap::Diverging, range: Range { low: -1.0, high: 1.0 } };

/// The matrix as a table of colours and numbers.
fn table_ui(room: Rect, matrix: &Mueller, theta_r: f64, ui: &Ui) {
    let (painter, ink) = (ui.painter(), ui.visuals().text_color());
    let title = tr!("m / m00 at θr = {}°", format!("{theta_r:.1}"));
    let head = 28.0;
    let side = room.width().min(room.height() - head).max(40.0);
    let top = Pos2::new(room.center().x, room.top() + 6.0);
    painter.text(top, Align2::CENTER_TOP, title, FontId::proportional(LETTERS), ink);
    let corner = Pos2::new(room.center().x - 0.5 * side, room.top() + head);
    let cell = 0.25 * side;
    let letters = (0.26 * cell).clamp(9.0, 15.0);
    for element in 0..16 {
        #[expect(clippy::cast_precision_loss, reason = "0 to 3")]
        let at = vec2((element % 4) as f32, (element / 4) as f32);
        let rect = Rect::from_min_size(corner + cell * at, vec2(cell, cell)).shrink(1.0);
        let value = normalised(matrix, element);
        let color = SCALE.color(value);
        painter.rect(rect, 2.0, color, Stroke::new(1.0, theme::grid(ui.visuals().dark_mode)), StrokeKind::Inside);
        painter.text(rect.center(), Align2::CENTER_CENTER, number(value), FontId::proportional(letters), SCALE.ink_on(value));
    }
}

/// An element as it is written in the table.
fn number(value: f64) -> String {
    match value {
        _ if value.is_nan() => "–".to_owned(),
        0.0 => "0".to_owned(),
        _ if value.abs() < 5e-4 => if value > 0.0 { "+0" } else { "−0" }.to_owned(),
        _ => format!("{value:.3}").replace('-', "−"),
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
    use super::{ElementCurves, number};
    use pbrdf::model::{Model, Parameters};
    use pbrdf::optics::SlopeDistribution;

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
            [(0.0, "0"), (-0.0, "0"), (1e-9, "+0"), (-1e-9, "−0"), (-0.1234, "−0.123"), (1.0, "1.000"), (f64::NAN, "–")]
        {
            assert_eq!(number(value), expected);
        }
    }
}
