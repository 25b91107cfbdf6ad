//! The plane of θi and θr, coloured by what the next reading would gain there.

use crate::app::plots::theme::{MARK, WHITE};
use crate::app::plots::{FigurePlot, PanelStyle};
use crate::app::text::numbers::short;
use crate::app::views::pointing::picked_name;
use crate::app::work::design::{DesignGoal, DesignSettings};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::figure::{Axis, ColorMap, Figure, HeatMap, Panel, Point, Series, Symbol};
use egui::Ui;
use pbrdf::optics::Geometry;
use tr::tr;

/// Height on the screen where the pane is no higher than it and the table, that of the table, the least of all, and that of a
/// line of words.
const HEIGHT: f32 = 250.0;
const TABLE: f32 = 380.0;
const LEAST_HEIGHT: f32 = 140.0;
const LINE: f32 = 24.0;
/// Cells along a side, at most.
const MOST_CELLS: usize = 200;

/// The figure of gains, θi by θi and θr by θr, with what is measured and what is planned, and the
/// θr and θi of the picked pixel of the picture.
pub fn describe(gains: &[f64], design: &DesignSettings, picked: Option<[f64; 2]>, document: &OpenMeasurement) -> Figure {
    let [theta_i, theta_r] = design.lists().map(once);
    let (x, y) = (Cells::of(&theta_r), Cells::of(&theta_i));
    let value = |row: usize, column: usize| {
        let (i, r) = (y.nearest(row, &theta_i)?, x.nearest(column, &theta_r)?);
        gains.get(i * theta_r.len() + r).copied()
    };
    let values = (0..y.count).flat_map(|row| (0..x.count).map(move |column| (row, column)));
    let values: Vec<f64> = values.map(|(row, column)| value(row, column).unwrap_or(f64::NAN)).collect();
    let most = values.iter().copied().filter(|value| value.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    let map = HeatMap {
        x_edges: x.edges(),
        y_edges: y.edges(),
        values,
        color_axis: Axis::linear(gain_name(design.goal), "").between(0.0, most),
        colors: ColorMap::Sequential,
    };
    let points = |places: Vec<[f64; 2]>| places.into_iter().map(|[x, y]| Point { x, y, bar: None }).collect();
    let mut series = vec![Series::heat_map(map)];
    let measured: Vec<[f64; 2]> = document.measurement.rows.iter().filter(|row| !row.masked).map(|row| signed(row.geometry)).collect();
    if !measured.is_empty() && design.counts_given {
        series.push(Series::measured(tr!("measured"), points(measured), Symbol::Circle).colored(WHITE));
    }
    if !design.readings.is_empty() {
        let planned = design.readings.iter().map(|[theta_i, theta_r]| [*theta_r, *theta_i]).collect();
        series.push(Series::measured(tr!("planned"), points(planned), Symbol::Disc).colored(MARK));
    }
    series.extend(picked.map(|at| Series::measured(picked_name(), points(vec![at]), Symbol::Square).colored(MARK)));
    let title = tr!("What the next reading would gain");
    let (x, y) = (Axis::linear("θr", "°").between(x.low, x.high()), Axis::linear("θi", "°").between(y.low, y.high()));
    Figure { title, panels: vec![Panel { x, y, series, ..Panel::default() }], ..Figure::default() }
}

/// What colours mean.
fn gain_name(goal: DesignGoal) -> String {
    match goal {
        DesignGoal::All => tr!("gain of ln det"),
        DesignGoal::Index | DesignGoal::Roughness => tr!("fall of ln of the variances"),
        DesignGoal::Distribution => tr!("difference² / noise²"),
    }
}

/// θr, negative on the backscatter side, and θi.
fn signed(geometry: Geometry) -> [f64; 2] {
    let is_forward = (90.0..=270.0).contains(&geometry.dphi().0.rem_euclid(360.0));
    let theta_r = geometry.theta_r().0;
    [if is_forward { theta_r } else { -theta_r }, geometry.theta_i().0]
}

/// Angles of a list, each once, as the core counts them.
fn once(angles: Vec<f64>) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::with_capacity(angles.len());
    for angle in angles {
        if !kept.contains(&angle) {
            kept.push(angle);
        }
    }
    kept
}

/// Cells of one size along an axis.
struct Cells {
    low: f64,
    step: f64,
    count: usize,
}

impl Cells {
    /// As fine as the closest two angles, up to a number of cells.
    fn of(angles: &[f64]) -> Self {
        let mut sorted = angles.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (first, last) = (sorted.first().copied().unwrap_or(0.0), sorted.last().copied().unwrap_or(0.0));
        #[expect(clippy::cast_precision_loss, reason = "a small number of cells")]
        let least = ((last - first) / MOST_CELLS as f64).max(1e-3);
        let step = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 1e-9).fold(f64::INFINITY, f64::min);
        // A single angle has a cell of its own.
        let step = if step.is_finite() { step.max(least) } else { 5.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number of cells")]
        let count = ((last - first) / step).round() as usize + 1;
        Self { low: first - 0.5 * step, step, count }
    }

    fn high(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a small number of cells")]
        let count = self.count as f64;
        self.low + count * self.step
    }

    #[expect(clippy::cast_precision_loss, reason = "a small number of cells")]
    fn edges(&self) -> Vec<f64> {
        (0..=self.count).map(|i| self.low + i as f64 * self.step).collect()
    }

    /// The place of the angle in a cell; none of a gap in the list.
    #[expect(clippy::cast_precision_loss, reason = "a small number of cells")]
    fn nearest(&self, cell: usize, angles: &[f64]) -> Option<usize> {
        let middle = self.low + (cell as f64 + 0.5) * self.step;
        let nearest = (0..angles.len()).min_by(|&a, &b| (angles[a] - middle).abs().total_cmp(&(angles[b] - middle).abs()))?;
        ((angles[nearest] - middle).abs() <= 0.5001 * self.step).then_some(nearest)
    }
}

/// Paints it; the pair of angles that was clicked.
pub fn plane_ui<K: PartialEq>(plane: &mut FigurePlot<K>, gains: &[f64], design: &DesignSettings, ui: &mut Ui) -> Option<[f64; 2]> {
    let [theta_i, theta_r] = design.lists().map(once);
    let panel = plane.panel(0)?;
    panel.key_line_ui(ui);
    let hover = |name: &str, x: f64, y: f64| format!("{name}\nθi = {y}°, θr = {x}°");
    // Where the pane is low, the whole of it is seen without scrolling.
    let pane = ui.clip_rect().height();
    let height = HEIGHT.max(pane - TABLE).min(ui.available_width()).min(pane - 2.0 * LINE).max(LEAST_HEIGHT);
    let style = PanelStyle::new("plane of angles", height, &hover).named(tr!("Map: what the next reading would gain at θr and θi"));
    // Within the edge of what scrolls, which would cut the title of the axis.
    let response =
        egui::Frame::new().inner_margin(egui::Margin { left: 4, ..egui::Margin::ZERO }).show(ui, |ui| panel.ui(&style, ui)).inner?;
    let nearest = |angles: &[f64], at: f64| (0..angles.len()).min_by(|&a, &b| (angles[a] - at).abs().total_cmp(&(angles[b] - at).abs()));
    let at = response.response.hover_pos().map(|pointer| response.transform.value_from_position(pointer));
    let pair = at.and_then(|at| Some((nearest(&theta_i, at.y)?, nearest(&theta_r, at.x)?)));
    let text = match pair.and_then(|(i, r)| Some((i, r, gains.get(i * theta_r.len() + r)?))) {
        Some((i, r, gain)) => tr!("θi = {0}°, θr = {1}°: {2} {3}", theta_i[i], theta_r[r], gain_name(design.goal), short(*gain)),
        None => tr!("A click plans a reading there, or takes it out again."),
    };
    ui.weak(text);
    let (i, r) = pair.filter(|_| response.response.clicked())?;
    Some([theta_i[i], theta_r[r]])
}

#[cfg(test)]
mod tests {
    use super::Cells;

    #[test]
    fn cells_are_as_fine_as_the_angles_and_gaps_stay_blank() {
        let angles = [10.0, 20.0, 25.0, 30.0, 60.0];
        let cells = Cells::of(&angles);
        assert_eq!((cells.low, cells.high(), cells.count), (7.5, 62.5, 11));
        let places: Vec<Option<usize>> = (0..cells.count).map(|cell| cells.nearest(cell, &angles)).collect();
        let (none, at) = (None, Some);
        assert_eq!(places, [at(0), none, at(1), at(2), at(3), none, none, none, none, none, at(4)]);
        assert_eq!(Cells::of(&[30.0]).edges(), [27.5, 32.5]);
    }
}
