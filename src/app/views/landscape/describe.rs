//! The landscape as a figure, with what lies on it.

use crate::app::plots::Range;
use crate::app::plots::theme::{FOREGROUND, MARK, WHITE};
use crate::app::views::context::Cx;
use crate::app::views::landscape::axes::{coordinate, value};
use crate::app::views::landscape::drawn::LandscapeImage;
use crate::app::views::landscape::key::LandscapeKey;
use crate::app::views::landscape::marks::metal_name;
use crate::app::views::landscape::state::LandscapeView;
use crate::app::work::settings::Settings;
use crate::figure::{Axis, Dash, Figure, HeatMap, Panel, Point, Rgb, Series, Symbol};
use egui_plot::PlotPoint;
use pbrdf::fit::LandscapeAxis;
use tr::tr;

const WAY: Rgb = Rgb(255, 96, 64);
const MINIMA: Rgb = Rgb(255, 214, 90);
const METALS: Rgb = Rgb(150, 220, 255);

pub fn describe(view: &LandscapeView, cx: &Cx<'_>) -> Option<Figure> {
    let (settings, surface) = (cx.work.settings(), cx.work.surface());
    let (key, drawn) = (view.job.key()?, view.job.get()?.as_ref()?);
    let mut series = vec![Series::heat_map(heat_map(drawn, key))];
    let back = |[x, y]: [f64; 2]| [value(key.across.parameter, x), value(key.up.parameter, y)];
    for (color, pieces) in drawn.contours.iter().filter(|_| settings.landscape.contours) {
        let ink = if color.r() > 128 { WHITE } else { FOREGROUND };
        let gap = [[f64::NAN; 2]];
        let points = pieces.iter().flat_map(|piece| piece.iter().map(|point| back([point.x, point.y])).chain(gap));
        series.push(Series::dashed("", points.collect(), Dash::Solid).colored(ink));
    }
    // Of a name, as shares of the axes.
    let room = [(key.across, 0.1), (key.up, 0.04)].map(|(nodes, share)| {
        let [low, high] = [nodes.low, nodes.high].map(|value| coordinate(nodes.parameter, value));
        share * (high - low)
    });
    series.extend(marks(view, settings, room, back));
    let sliders = [key.across, key.up].map(|nodes| surface.parameters[nodes.parameter]);
    series.push(pointed(tr!("sliders"), vec![sliders], Symbol::Cross, MARK));
    let panel = Panel { x: axis(key.across), y: axis(key.up), series, ..Panel::default() };
    Some(Figure { title: cx.work.active().title(), panels: vec![panel], width_mm: 160.0, height_mm: 125.0, ..Figure::default() })
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
    let [low, high] = [drawn.scale.range.low, drawn.scale.range.high].map(libm::exp10);
    HeatMap {
        x_edges: edges(key.across),
        y_edges: edges(key.up),
        values: drawn.landscape.objective.clone(),
        color_axis: Axis::log(drawn.title, "").between(low, high),
        colors: drawn.scale.map,
    }
}

fn pointed(name: String, places: Vec<[f64; 2]>, symbol: Symbol, color: Rgb) -> Series {
    Series::measured(name, places.into_iter().map(|[x, y]| Point { x, y, bar: None }).collect(), symbol).colored(color)
}

/// Names that do not stand on an earlier one, each with so much room in the coordinates of the plot.
fn free(names: &[(PlotPoint, &'static str)], room: [f64; 2]) -> Vec<(PlotPoint, &'static str)> {
    let mut free: Vec<(PlotPoint, &str)> = Vec::new();
    for (point, name) in names {
        if free.iter().all(|(other, _)| (other.x - point.x).abs() > room[0] || (other.y - point.y).abs() > room[1]) {
            free.push((*point, name));
        }
    }
    free
}

/// Metals, ways and minima, as far as they are shown.
fn marks(view: &LandscapeView, settings: &Settings, room: [f64; 2], back: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<Series> {
    let shown = settings.landscape;
    let Some(marks) = view.marks.get() else { return Vec::new() };
    let places = |points: &[PlotPoint]| -> Vec<[f64; 2]> { points.iter().map(|point| back([point.x, point.y])).collect() };
    let mut series = Vec::new();
    if shown.metals && !marks.metals.points.is_empty() {
        series.push(pointed(tr!("metals"), places(&marks.metals.points), Symbol::Disc, METALS));
        let names = free(&marks.names, room).into_iter().map(|(point, name)| (back([point.x, point.y]), metal_name(name)));
        series.push(Series::labels(names.collect()));
    }
    for (age, way) in marks.ways.iter().enumerate().rev().filter(|_| shown.paths) {
        let name = if age == 0 { tr!("way of the last fit") } else { tr!("ways of fits before") };
        series.push(Series::line(name, places(&way.points)).colored(WAY));
    }
    if shown.minima && !marks.minima.points.is_empty() {
        series.push(pointed(tr!("minima"), places(&marks.minima.points), Symbol::Square, MINIMA));
    }
    series
}
