//! Marks of a panel: curves clipped to the frame, points, bands, bars, maps.

use crate::figure::canvas::{Anchor, Canvas, INK, Paint, circle, polyline, rectangle};
use crate::figure::layout::{Frame, GAP, LETTER_HEIGHT, Placed, Ruled, SMALL};
use crate::figure::{Dash, HeatMap, Mark, Point, Rgb, Series, Symbol};
use std::collections::BTreeMap;

/// Radius of a point.
const RADIUS: f64 = 2.0;
/// Half the width of the cap of an error bar.
const CAP: f64 = 2.0;
/// Points of a curve closer than this are merged, in points of paper.
const SAME: f64 = 0.02;
/// Opacity of a band.
const BAND: f64 = 0.2;
/// Opacity of the background of a label.
const PLATE: f64 = 0.7;
/// Number of colours of a map.
const LEVELS: u16 = 255;

/// Dash and gap of a line of that width.
fn dashes(dash: Dash, width: f64) -> Option<(f64, f64)> {
    match dash {
        Dash::Solid => None,
        Dash::Dashed => Some((4.0 * width, 2.5 * width)),
        Dash::Dotted => Some((1.2 * width, 2.0 * width)),
        Dash::Sparse => Some((1.2 * width, 5.0 * width)),
    }
}

/// Transform from coordinates to points on paper.
struct Map<'a> {
    frame: Frame,
    x: &'a Ruled,
    y: &'a Ruled,
}

impl Map<'_> {
    /// Far outside counts as outside, and differences stay finite.
    fn place(frame_start: f64, length: f64, fraction: f64) -> f64 {
        frame_start + length * fraction.clamp(-1e6, 1e6)
    }

    fn x(&self, x: f64) -> Option<f64> {
        Some(Self::place(self.frame.left, self.frame.width, self.x.fraction(x)?))
    }

    fn y(&self, y: f64) -> Option<f64> {
        Some(Self::place(self.frame.top, self.frame.height, 1.0 - self.y.fraction(y)?))
    }

    /// The same, clamped to the frame; none for NaN. On a logarithmic axis 0 is at the lower end.
    fn y_within(&self, y: f64) -> Option<f64> {
        let place = if !y.is_nan() && self.y.scale == crate::figure::Scale::Log && y <= 0.0 { self.frame.bottom() } else { self.y(y)? };
        Some(place.clamp(self.frame.top, self.frame.bottom()))
    }

    fn point(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        Some((self.x(x)?, self.y(y)?))
    }

    fn contains(&self, (x, y): (f64, f64)) -> bool {
        // Points on the frame itself are inside, whatever rounding does.
        const EDGE: f64 = 1e-6;
        let frame = &self.frame;
        (frame.left - EDGE..=frame.right() + EDGE).contains(&x) && (frame.top - EDGE..=frame.bottom() + EDGE).contains(&y)
    }
}

/// Draws a series in that colour.
pub fn draw(canvas: &mut Canvas<'_>, placed: &Placed, series: &Series, color: Rgb) {
    let map = Map { frame: placed.frame, x: &placed.x, y: &placed.y };
    match &series.mark {
        Mark::Line { points, width, dash } => {
            let data = curve(&map, points.iter().map(|[x, y]| map.point(*x, *y)));
            canvas.path(&data, Paint::Stroke(color, *width, dashes(*dash, *width)));
        }
        Mark::Steps { points } => canvas.path(&steps(&map, points), Paint::Stroke(color, 1.2, None)),
        Mark::Points { points, symbol } => draw_points(canvas, &map, points, *symbol, color),
        Mark::Band { points } => {
            for piece in points.split(|[x, low, high]| !(x.is_finite() && low.is_finite() && high.is_finite())) {
                canvas.path(&band(&map, piece), Paint::Fill(color, BAND));
            }
        }
        Mark::Area { points } => {
            for piece in points.split(|point| !point.iter().all(|coordinate| coordinate.is_finite())) {
                let outline: Vec<(f64, f64)> = piece.iter().filter_map(|[x, y]| Some((map.x(*x)?, map.y_within(*y)?))).collect();
                canvas.path(&if outline.len() < 3 { String::new() } else { polyline(&outline) + "Z" }, Paint::Fill(color, BAND));
            }
        }
        Mark::Bars { points, width } => canvas.path(&bars(&map, points, *width), Paint::Fill(color, 1.0)),
        Mark::HeatMap(values) => draw_heat_map(canvas, &map, values, placed),
        Mark::Rule { upright, at } => canvas.path(&rule(&map, *upright, *at), Paint::Stroke(color, 0.9, dashes(Dash::Dashed, 0.9))),
        Mark::Labels(labels) => draw_labels(canvas, &map, labels),
    }
}

/// A curve through points, split at missing ones and clipped to the frame.
fn curve(map: &Map<'_>, points: impl Iterator<Item = Option<(f64, f64)>>) -> String {
    let mut data = String::new();
    let mut before: Option<(f64, f64)> = None;
    let mut piece: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if let (Some(a), Some(b)) = (before, point)
            && let Some((from, to)) = cut(&map.frame, a, b)
        {
            let joins = piece.last().is_some_and(|last| near(*last, from));
            if !joins {
                data.push_str(&finished(&mut piece));
                piece.push(from);
            }
            if !near(from, to) {
                piece.push(to);
            }
        }
        if point.is_none() {
            data.push_str(&finished(&mut piece));
        }
        // A point too close to the last one is skipped; its step adds to the next.
        before = match (before, point) {
            (Some(a), Some(b)) if near(a, b) => Some(a),
            _ => point,
        };
    }
    data.push_str(&finished(&mut piece));
    data
}

fn near(a: (f64, f64), b: (f64, f64)) -> bool {
    (a.0 - b.0).abs() < SAME && (a.1 - b.1).abs() < SAME
}

fn finished(piece: &mut Vec<(f64, f64)>) -> String {
    let data = if piece.len() > 1 { polyline(piece) } else { String::new() };
    piece.clear();
    data
}

/// The part of a segment that lies in the frame (Liang and Barsky).
fn cut(frame: &Frame, a: (f64, f64), b: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let sides = [(-dx, a.0 - frame.left), (dx, frame.right() - a.0), (-dy, a.1 - frame.top), (dy, frame.bottom() - a.1)];
    for (outwards, room) in sides {
        if outwards == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if outwards < 0.0 {
            from = from.max(room / outwards);
        } else {
            to = to.min(room / outwards);
        }
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    // Unclipped ends stay exact, so that the next piece joins.
    let first = if from == 0.0 { a } else { at(from) };
    let last = if to == 1.0 { b } else { at(to) };
    (from <= to).then_some((first, last))
}

fn steps(map: &Map<'_>, points: &[[f64; 2]]) -> String {
    let corners = points.iter().enumerate().flat_map(|(i, [x, y])| {
        let next = points.get(i + 1).map(|[next, _]| map.point(*next, *y));
        [Some(map.point(*x, *y)), next]
    });
    curve(map, corners.flatten())
}

fn band(map: &Map<'_>, piece: &[[f64; 3]]) -> String {
    let within = |x: f64| map.x(x).map(|x| x.clamp(map.frame.left, map.frame.right()));
    let upper = piece.iter().filter_map(|[x, _, high]| Some((within(*x)?, map.y_within(*high)?)));
    let lower = piece.iter().rev().filter_map(|[x, low, _]| Some((within(*x)?, map.y_within(*low)?)));
    let outline: Vec<(f64, f64)> = upper.chain(lower).collect();
    if outline.len() < 4 { String::new() } else { polyline(&outline) + "Z" }
}

fn bars(map: &Map<'_>, points: &[[f64; 2]], width: f64) -> String {
    let mut data = String::new();
    for [x, y] in points {
        let ends = (map.x(x - 0.5 * width), map.x(x + 0.5 * width), map.y_within(*y), map.y_within(0.0));
        if let (Some(left), Some(right), Some(top), Some(foot)) = ends
            && x.is_finite()
        {
            let (left, right) = (left.max(map.frame.left), right.min(map.frame.right()));
            data.push_str(&rectangle(left, top.min(foot), (right - left).max(0.0), (foot - top).abs()));
        }
    }
    data
}

fn rule(map: &Map<'_>, upright: bool, at: f64) -> String {
    let frame = &map.frame;
    let ends = if upright {
        map.x(at).map(|x| [(x, frame.bottom()), (x, frame.top)])
    } else {
        map.y(at).map(|y| [(frame.left, y), (frame.right(), y)])
    };
    ends.filter(|[first, _]| map.contains(*first)).map_or_else(String::new, |ends| polyline(&ends))
}

fn draw_points(canvas: &mut Canvas<'_>, map: &Map<'_>, points: &[Point], symbol: Symbol, color: Rgb) {
    let mut error_bars = String::new();
    let mut symbols = String::new();
    for point in points {
        let Some(x) = map.x(point.x).filter(|x| map.contains((*x, map.frame.top))) else { continue };
        let bar = point.bar.and_then(|(low, high)| Some((low, high, map.y_within(low)?, map.y_within(high)?)));
        if let Some((low, high, foot, top)) = bar.filter(|(.., foot, top)| foot != top) {
            error_bars.push_str(&polyline(&[(x, foot), (x, top)]));
            // No cap where the bar is clipped.
            for (end, place) in [(low, foot), (high, top)] {
                if map.y(end).is_some_and(|exact| exact == place) {
                    error_bars.push_str(&polyline(&[(x - CAP, place), (x + CAP, place)]));
                }
            }
        }
        if let Some(y) = map.y(point.y).filter(|y| map.contains((x, *y))) {
            symbols.push_str(&symbol_at(symbol, x, y));
        }
    }
    canvas.path(&error_bars, Paint::Stroke(color, 0.7, None));
    canvas.path(&symbols, symbol_paint(symbol, color));
}

fn symbol_at(symbol: Symbol, x: f64, y: f64) -> String {
    match symbol {
        Symbol::Disc | Symbol::Circle => circle(x, y, RADIUS),
        Symbol::Square => rectangle(x - 0.9 * RADIUS, y - 0.9 * RADIUS, 1.8 * RADIUS, 1.8 * RADIUS),
        Symbol::Cross => {
            polyline(&[(x - RADIUS, y - RADIUS), (x + RADIUS, y + RADIUS)])
                + &polyline(&[(x - RADIUS, y + RADIUS), (x + RADIUS, y - RADIUS)])
        }
    }
}

fn symbol_paint(symbol: Symbol, color: Rgb) -> Paint {
    match symbol {
        Symbol::Disc | Symbol::Square => Paint::Fill(color, 1.0),
        Symbol::Circle | Symbol::Cross => Paint::Stroke(color, 0.9, None),
    }
}

fn draw_labels(canvas: &mut Canvas<'_>, map: &Map<'_>, labels: &[([f64; 2], String)]) {
    for ([x, y], text) in labels {
        let Some((x, y)) = map.point(*x, *y).filter(|place| map.contains(*place)) else { continue };
        // Right of the point, unless the frame ends there.
        let is_free = x + GAP + canvas.font.width(text, SMALL) <= map.frame.right();
        let (x, anchor) = if is_free { (x + GAP + RADIUS, Anchor::Start) } else { (x - GAP - RADIUS, Anchor::End) };
        // A background keeps the label readable on a map.
        let width = canvas.font.width(text, SMALL) + 2.0;
        let left = if is_free { x - 1.0 } else { x - width + 1.0 };
        canvas.path(&rectangle(left, y - 0.55 * SMALL, width, 1.1 * SMALL), Paint::Fill(Rgb(255, 255, 255), PLATE));
        canvas.text(text, SMALL, (x, y + 0.5 * LETTER_HEIGHT * SMALL), anchor, false, INK);
    }
}

/// One path per colour; runs of cells of one colour are one rectangle.
fn draw_heat_map(canvas: &mut Canvas<'_>, map: &Map<'_>, heat: &HeatMap, placed: &Placed) {
    let (columns, rows) = (heat.x_edges.len().saturating_sub(1), heat.y_edges.len().saturating_sub(1));
    let Some(bar) = placed.color_bar.as_ref().filter(|_| columns > 0) else { return };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let level = |value: &f64| bar.axis.fraction(*value).map(|fraction| (fraction.clamp(0.0, 1.0) * f64::from(LEVELS)).round() as u16);
    let left = |x: f64| map.x(x).map(|x| x.clamp(map.frame.left, map.frame.right()));
    let mut paths: BTreeMap<u16, String> = BTreeMap::new();
    for (row, values) in heat.values.chunks(columns).take(rows).enumerate() {
        let (Some(bottom), Some(top)) = (map.y_within(heat.y_edges[row]), map.y_within(heat.y_edges[row + 1])) else { continue };
        let levels: Vec<Option<u16>> = values.iter().map(level).collect();
        let mut column = 0;
        for run in levels.chunk_by(|a, b| a == b) {
            let ends = (left(heat.x_edges[column]), left(heat.x_edges[column + run.len()]));
            column += run.len();
            if let (Some(level), (Some(from), Some(to))) = (run[0], ends)
                && to > from
                && bottom > top
            {
                paths.entry(level).or_default().push_str(&rectangle(from, top, to - from, bottom - top));
            }
        }
    }
    for (level, data) in paths {
        canvas.path(&data, Paint::Cells(heat.colors.at(f64::from(level) / f64::from(LEVELS))));
    }
}

/// The colours of a bar beside a map.
pub fn draw_color_bar(canvas: &mut Canvas<'_>, frame: &Frame, heat: &HeatMap) {
    const BANDS: u16 = 128;
    let height = frame.height / f64::from(BANDS);
    for band in 0..BANDS {
        let color = heat.colors.at((f64::from(band) + 0.5) / f64::from(BANDS));
        let top = frame.bottom() - f64::from(band + 1) * height;
        canvas.path(&rectangle(frame.left, top, frame.width, height), Paint::Cells(color));
    }
}

/// The sample of a series in the legend, in a box of that width whose middle is at that height.
pub fn draw_sample(canvas: &mut Canvas<'_>, series: &Series, color: Rgb, (left, middle): (f64, f64), width: f64) {
    let line = polyline(&[(left, middle), (left + width, middle)]);
    let center = left + 0.5 * width;
    match &series.mark {
        Mark::Line { width, dash, .. } => canvas.path(&line, Paint::Stroke(color, *width, dashes(*dash, *width))),
        Mark::Steps { .. } => canvas.path(&line, Paint::Stroke(color, 1.2, None)),
        Mark::Rule { .. } => canvas.path(&line, Paint::Stroke(color, 0.9, dashes(Dash::Dashed, 0.9))),
        Mark::Points { points, symbol } => {
            if points.iter().any(|point| point.bar.is_some()) {
                canvas.path(&polyline(&[(center, middle - 4.0), (center, middle + 4.0)]), Paint::Stroke(color, 0.7, None));
            }
            canvas.path(&symbol_at(*symbol, center, middle), symbol_paint(*symbol, color));
        }
        Mark::Band { .. } | Mark::Area { .. } => canvas.path(&rectangle(left, middle - 3.0, width, 6.0), Paint::Fill(color, BAND)),
        Mark::Bars { .. } => canvas.path(&rectangle(left + 4.0, middle - 3.0, width - 8.0, 6.0), Paint::Fill(color, 1.0)),
        Mark::HeatMap(_) | Mark::Labels(_) => {}
    }
}
