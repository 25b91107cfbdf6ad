//! Ends of axes: the requested ones, or the ends of the data with a margin.

use crate::figure::{Axis, HeatMap, Mark, Panel, Scale};

/// Largest magnitude of an end: beyond it differences overflow.
const LARGEST: f64 = 1e300;
/// Margin at either end of an axis with points, as a fraction of the span.
const AIR: f64 = 0.04;
/// An axis begins at 0 if its lower end is below this fraction of the upper one.
const NEAR_ZERO: f64 = 0.3;

/// Ends of the horizontal axis.
pub fn x(panel: &Panel) -> (f64, f64) {
    let is_poorly_determined =
        panel.series.iter().all(|series| matches!(series.mark, Mark::Points { .. } | Mark::Labels(_) | Mark::Rule { .. }));
    ends(&panel.x, panel.series.iter().flat_map(|series| xs(&series.mark)), is_poorly_determined)
}

/// Ends of the vertical axis.
pub fn y(panel: &Panel) -> (f64, f64) {
    let is_map = panel.series.iter().any(|series| matches!(series.mark, Mark::HeatMap(_)));
    ends(&panel.y, panel.series.iter().flat_map(|series| ys(&series.mark)), !is_map)
}

/// Ends of a colour bar.
pub fn color(map: &HeatMap) -> (f64, f64) {
    ends(&map.color_axis, map.values.iter().copied(), false)
}

fn xs(mark: &Mark) -> Vec<f64> {
    match mark {
        Mark::Line { points, .. } | Mark::Steps { points } | Mark::Area { points } => points.iter().map(|[x, _]| *x).collect(),
        Mark::Points { points, .. } => points.iter().map(|point| point.x).collect(),
        Mark::Band { points } => points.iter().map(|[x, ..]| *x).collect(),
        Mark::Bars { points, width } => points.iter().flat_map(|[x, _]| [x - 0.6 * width, x + 0.6 * width]).collect(),
        Mark::HeatMap(map) => map.x_edges.clone(),
        Mark::Rule { upright: true, at } => vec![*at],
        Mark::Rule { .. } => Vec::new(),
        Mark::Labels(labels) => labels.iter().map(|([x, _], _)| *x).collect(),
    }
}

fn ys(mark: &Mark) -> Vec<f64> {
    match mark {
        Mark::Line { points, .. } | Mark::Steps { points } | Mark::Area { points } => points.iter().map(|[_, y]| *y).collect(),
        Mark::Points { points, .. } => points
            .iter()
            .flat_map(|point| {
                let (low, high) = point.bar.unwrap_or((point.y, point.y));
                [point.y, low, high]
            })
            .collect(),
        Mark::Band { points } => points.iter().flat_map(|[_, low, high]| [*low, *high]).collect(),
        Mark::Bars { points, .. } => points.iter().map(|[_, y]| *y).chain([0.0]).collect(),
        Mark::HeatMap(map) => map.y_edges.clone(),
        Mark::Rule { upright: false, at } => vec![*at],
        Mark::Rule { .. } => Vec::new(),
        Mark::Labels(labels) => labels.iter().map(|([_, y], _)| *y).collect(),
    }
}

fn ends(axis: &Axis, values: impl Iterator<Item = f64>, air: bool) -> (f64, f64) {
    let is_log = axis.scale == Scale::Log;
    let fits = |value: f64| value.is_finite() && value.abs() <= LARGEST && (!is_log || value >= f64::MIN_POSITIVE);
    if let Some((low, high)) = axis.range
        && fits(low)
        && fits(high)
        && low < high
    {
        return (low, high);
    }
    let (low, high) =
        values.filter(|&value| fits(value)).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    match (low <= high, axis.scale) {
        (false, Scale::Linear) => (0.0, 1.0),
        (false, Scale::Log) => (1.0, 10.0),
        (true, Scale::Linear) => linear(low, high, air),
        (true, Scale::Log) => log(low, high, air),
    }
}

fn linear(low: f64, high: f64, air: bool) -> (f64, f64) {
    // Ticks closer than rounding have the same label.
    let least = 1e-9 * low.abs().max(high.abs());
    if high - low <= least {
        let half = if high == 0.0 { 1.0 } else { 0.1 * high.abs() };
        return (low - half, high + half);
    }
    if !air {
        return (low, high);
    }
    let free = AIR * (high - low);
    let from = if low >= 0.0 && low <= NEAR_ZERO * high { 0.0 } else { low - free };
    (from, high + free)
}

fn log(low: f64, high: f64, air: bool) -> (f64, f64) {
    let (first, last) = (libm::log10(low), libm::log10(high));
    if last - first < 1e-3 {
        return (libm::exp10((first - 0.5).max(-307.0)), libm::exp10((last + 0.5).min(300.0)));
    }
    if !air {
        return (low, high);
    }
    let free = AIR * (last - first);
    (libm::exp10((first - free).max(-307.0)), libm::exp10((last + free).min(300.0)))
}
