//! The landscape as a figure, with what lies on it.

use crate::app::plots::Range;
use crate::app::plots::theme::MARK;
use crate::app::views::landscape::axes::{coordinate, value};
use crate::app::views::landscape::drawn::{COLORS, LandscapeImage};
use crate::app::views::landscape::key::LandscapeKey;
use crate::app::views::landscape::marks::{Marks, metal_name, way_name};
use crate::app::work::settings::LandscapeAxes;
use crate::figure::{Axis, Dash, Figure, HeatMap, Panel, Point, Rgb, Series, Symbol};
use pbrdf::fit::LandscapeAxis;
use tr::tr;

const WAY: Rgb = Rgb(255, 96, 64);
const MINIMA: Rgb = Rgb(255, 214, 90);
const METALS: Rgb = Rgb(150, 220, 255);
const CLOUD: Rgb = Rgb(240, 240, 240);

/// The figure of a landscape with these marks on it; the sliders stand there.
pub fn describe(
    drawn: &LandscapeImage,
    key: &LandscapeKey,
    marks: Option<&Marks>,
    (shown, sliders): (LandscapeAxes, [f64; 2]),
    title: String,
) -> Figure {
    let mut series = vec![Series::heat_map(heat_map(drawn, key))];
    let back = |[x, y]: [f64; 2]| [value(key.across.parameter, x), value(key.up.parameter, y)];
    for (ink, pieces) in drawn.contours.iter().filter(|_| shown.contours) {
        let gap = [[f64::NAN; 2]];
        let points = pieces.iter().flat_map(|piece| piece.iter().map(|point| back(*point)).chain(gap));
        series.push(Series::stroke("", points.collect(), 0.45, Dash::Solid).colored(*ink));
    }
    // Of a name, as shares of the axes.
    let room = [(key.across, 0.1), (key.up, 0.04)].map(|(nodes, share)| {
        let [low, high] = [nodes.low, nodes.high].map(|value| coordinate(nodes.parameter, value));
        share * (high - low)
    });
    series.extend(marks.into_iter().flat_map(|marks| on_map(marks, shown, room, back)));
    if sliders.iter().all(|value| value.is_finite()) {
        series.push(pointed(tr!("sliders"), vec![sliders], Symbol::Cross, MARK));
    }
    let panel = Panel { x: axis(key.across), y: axis(key.up), series, ..Panel::default() };
    Figure { title, panels: vec![panel], width_mm: 160.0, height_mm: 125.0, ..Figure::default() }
}

fn axis(nodes: LandscapeAxis) -> Axis {
    let LandscapeAxis { parameter, low, high, .. } = nodes;
    let unit = parameter.unit().trim();
    let axis = if nodes.logarithmic { Axis::log(parameter.symbol(), unit) } else { Axis::linear(parameter.symbol(), unit) };
    axis.between(low, high)
}

/// The nodes are in the middle of cells; those at the ends stand half outside the axes.
fn heat_map(drawn: &LandscapeImage, key: &LandscapeKey) -> HeatMap {
    let edges = |nodes: LandscapeAxis| -> Vec<f64> {
        let [low, high] = [nodes.low, nodes.high].map(|value| coordinate(nodes.parameter, value));
        #[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
        let half = 0.5 * (high - low) / (nodes.count - 1) as f64;
        Range { low: low - half, high: high + half }.edges(nodes.count).into_iter().map(|edge| value(nodes.parameter, edge)).collect()
    };
    let [low, high] = [drawn.range.low, drawn.range.high].map(libm::exp10);
    HeatMap {
        x_edges: edges(key.across),
        y_edges: edges(key.up),
        values: drawn.landscape.objective.clone(),
        color_axis: Axis::log(drawn.title, "").between(low, high),
        colors: COLORS,
    }
}

fn pointed(name: String, places: Vec<[f64; 2]>, symbol: Symbol, color: Rgb) -> Series {
    Series::measured(name, places.into_iter().map(|[x, y]| Point { x, y, bar: None }).collect(), symbol).colored(color)
}

/// Names that do not stand on an earlier one, each with so much room in the coordinates of the
/// plot.
fn free(names: &[([f64; 2], &'static str)], room: [f64; 2]) -> Vec<([f64; 2], &'static str)> {
    let mut free: Vec<([f64; 2], &str)> = Vec::new();
    for (point, name) in names {
        if free.iter().all(|(other, _)| (other[0] - point[0]).abs() > room[0] || (other[1] - point[1]).abs() > room[1]) {
            free.push((*point, name));
        }
    }
    free
}

/// Metals, ways and minima, as far as they are shown.
fn on_map(marks: &Marks, shown: LandscapeAxes, room: [f64; 2], back: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<Series> {
    let places = |points: &[[f64; 2]]| -> Vec<[f64; 2]> { points.iter().map(|point| back(*point)).collect() };
    let mut series = Vec::new();
    if shown.cloud && !marks.cloud.is_empty() {
        series.push(pointed(tr!("draws"), places(&marks.cloud), Symbol::Disc, CLOUD).faded(0.45));
    }
    if shown.metals && !marks.metals.points.is_empty() {
        series.push(pointed(tr!("metals"), places(&marks.metals.points), Symbol::Disc, METALS));
        let names = free(&marks.names, room).into_iter().map(|(point, name)| (back(point), metal_name(name)));
        series.push(Series::labels(names.collect()));
    }
    for (age, way) in marks.ways.iter().enumerate().rev().filter(|_| shown.paths) {
        let opacity = if age == 0 { 1.0 } else { FADED };
        series.push(Series::line(way_name(age), places(&way.points)).colored(WAY).faded(opacity));
        series.push(pointed(way_name(age), places(&way.points), Symbol::Disc, WAY).faded(opacity));
    }
    if shown.minima && !marks.minima.points.is_empty() {
        series.push(pointed(tr!("minima"), places(&marks.minima.points), Symbol::Square, MINIMA));
    }
    series
}

/// Opacity of the ways of earlier fits.
const FADED: f64 = 0.55;
