//! A figure as SVG.

use crate::figure::canvas::{Anchor, Canvas, FAINT, INK, Missing, POINTS_PER_MM, Paint, polyline, rectangle};
use crate::figure::layout;
use crate::figure::layout::{Frame, GAP, LABEL, LEGEND_LINE, LEGEND_SAMPLE, LETTER_HEIGHT, Placed, Ruled, SMALL, TICK, TITLE, place};
use crate::figure::shapes::{draw, draw_color_bar, draw_sample};
use crate::figure::text::Font;
use crate::figure::{Figure, Panel, Rgb, Series};

/// Sides of a page in millimetres.
const SMALLEST: f64 = 20.0;
const LARGEST: f64 = 2000.0;

impl Figure {
    /// The figure as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        self.drawn(Missing::LeftToViewer)
    }

    pub(crate) fn drawn(&self, missing: Missing) -> String {
        let side = |mm: f64| if mm.is_finite() { mm.clamp(SMALLEST, LARGEST) } else { SMALLEST };
        let figure = Self { width_mm: side(self.width_mm), height_mm: side(self.height_mm), ..self.clone() };
        let font = Font::new();
        let name = if figure.title.is_empty() { figure.panels.first().map_or("", |panel| panel.title.as_str()) } else { &figure.title };
        let mut canvas = Canvas::new(&font, missing, figure.width_mm, figure.height_mm, name);
        draw_figure(&mut canvas, &figure);
        canvas.finish()
    }
}

/// Title and panels, or title and figures.
fn draw_figure(canvas: &mut Canvas<'_>, figure: &Figure) {
    let middle = 0.5 * figure.width_mm * POINTS_PER_MM;
    canvas.text(&figure.title, TITLE, (middle, 2.0 * GAP + LETTER_HEIGHT * TITLE), Anchor::Middle, false, INK);
    for (panel, placed) in figure.panels.iter().zip(place(figure, canvas.font)).filter(|(panel, _)| !panel.is_blank()) {
        draw_panel(canvas, panel, &placed);
    }
    let columns = figure.columns.max(1);
    let rows: Vec<&[Figure]> = figure.figures.chunks(columns).collect();
    let highest = |row: &[Figure]| row.iter().map(|cell| cell.height_mm).fold(0.0, f64::max);
    let title = if figure.title.is_empty() { 0.0 } else { (TITLE + 2.0 * GAP) / POINTS_PER_MM };
    let all: f64 = rows.iter().map(|row| highest(row)).sum();
    let room = (figure.height_mm - title).max(SMALLEST);
    let mut top = title;
    for row in rows {
        let height_mm = room * highest(row) / all.max(f64::MIN_POSITIVE);
        #[expect(clippy::cast_precision_loss, reason = "a handful of figures")]
        let width_mm = figure.width_mm / columns as f64;
        for (column, cell) in row.iter().enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "a handful of figures")]
            let left = column as f64 * width_mm;
            canvas.begin_group(left * POINTS_PER_MM, top * POINTS_PER_MM);
            draw_figure(canvas, &Figure { width_mm, height_mm, ..cell.clone() });
            canvas.end_group();
        }
        top += height_mm;
    }
}

fn draw_panel(canvas: &mut Canvas<'_>, panel: &Panel, placed: &Placed) {
    let colors: Vec<Rgb> = panel.series.iter().zip(panel.colors()).map(|(series, color)| color.on_white(series.opacity)).collect();
    let heat_map = panel.heat_map();
    if heat_map.is_none() {
        draw_grid(canvas, placed);
    }
    for (series, color) in panel.series.iter().zip(&colors) {
        draw(canvas, placed, series, *color);
    }
    let frame = placed.frame;
    canvas.path(&rectangle(frame.left, frame.top, frame.width, frame.height), Paint::Stroke(INK, 0.7, None));
    draw_x_axis(canvas, panel, placed);
    draw_y_axis(canvas, &placed.y, &panel.y.title(), &frame, false);
    if let (Some(map), Some(bar)) = (heat_map.filter(|_| panel.legend), &placed.color_bar) {
        draw_color_bar(canvas, &bar.frame, map);
        let frame = bar.frame;
        canvas.path(&rectangle(frame.left, frame.top, frame.width, frame.height), Paint::Stroke(INK, 0.7, None));
        draw_y_axis(canvas, &bar.axis, &map.color_axis.title(), &frame, true);
    }
    #[expect(clippy::cast_precision_loss, reason = "a handful of lines")]
    let legend_top = frame.top - 0.5 * SMALL - LEGEND_LINE * placed.legend.len() as f64;
    draw_legend(canvas, panel, placed, &colors, legend_top);
    canvas.text(&panel.title, LABEL, (frame.left, legend_top - 0.5 * GAP), Anchor::Start, false, INK);
}

/// Places of marks on paper with their labels; `along` gives a place for a fraction.
fn places<'a>(axis: &'a Ruled, along: impl Fn(f64) -> f64 + 'a) -> impl Iterator<Item = (f64, Option<&'a str>)> + 'a {
    let inside = axis.ticks.iter().filter_map(|tick| {
        let fraction = axis.fraction(tick.at)?;
        (-1e-6..=1.0 + 1e-6).contains(&fraction).then_some((fraction, tick.label.as_deref()))
    });
    inside.map(move |(fraction, label)| (along(fraction), label))
}

fn draw_grid(canvas: &mut Canvas<'_>, placed: &Placed) {
    let frame = placed.frame;
    let mut data = String::new();
    for (x, _) in places(&placed.x, |fraction| frame.left + fraction * frame.width).filter(|(_, label)| label.is_some()) {
        data.push_str(&polyline(&[(x, frame.top), (x, frame.bottom())]));
    }
    for (y, _) in places(&placed.y, |fraction| frame.bottom() - fraction * frame.height).filter(|(_, label)| label.is_some()) {
        data.push_str(&polyline(&[(frame.left, y), (frame.right(), y)]));
    }
    canvas.path(&data, Paint::Stroke(FAINT, 0.5, None));
}

/// Size of a text that fits into that length, though never too small to read.
fn fitting(font: &Font, text: &str, room: f64) -> f64 {
    const SMALLEST: f64 = 6.0;
    (LABEL * room / font.width(text, LABEL).max(1.0)).clamp(SMALLEST, LABEL)
}

fn length(label: Option<&str>) -> f64 {
    if label.is_some() { TICK } else { 0.6 * TICK }
}

fn draw_x_axis(canvas: &mut Canvas<'_>, panel: &Panel, placed: &Placed) {
    let frame = placed.frame;
    let mut marks = String::new();
    let baseline = frame.bottom() + TICK + GAP + LETTER_HEIGHT * SMALL;
    for (x, label) in places(&placed.x, |fraction| frame.left + fraction * frame.width) {
        marks.push_str(&polyline(&[(x, frame.bottom()), (x, frame.bottom() + length(label))]));
        canvas.text(label.unwrap_or(""), SMALL, (x, baseline), Anchor::Middle, false, INK);
    }
    canvas.path(&marks, Paint::Stroke(INK, 0.7, None));
    let middle = frame.left + 0.5 * frame.width;
    let title = panel.x.title();
    let size = fitting(canvas.font, &title, frame.width + LABEL);
    canvas.text(&title, size, (middle, baseline + GAP + LABEL), Anchor::Middle, false, INK);
}

/// A vertical axis at the left of its frame, or at the right.
pub fn draw_y_axis(canvas: &mut Canvas<'_>, axis: &Ruled, title: &str, frame: &Frame, at_right: bool) {
    let (edge, outwards, anchor) = if at_right { (frame.right(), 1.0, Anchor::Start) } else { (frame.left, -1.0, Anchor::End) };
    let mut marks = String::new();
    for (y, label) in places(axis, |fraction| frame.bottom() - fraction * frame.height) {
        marks.push_str(&polyline(&[(edge, y), (edge + outwards * length(label), y)]));
        let place = (edge + outwards * (TICK + GAP), y + 0.5 * LETTER_HEIGHT * SMALL);
        canvas.text(label.unwrap_or(""), SMALL, place, anchor, false, INK);
    }
    canvas.path(&marks, Paint::Stroke(INK, 0.7, None));
    let beside = TICK + 2.0 * GAP + axis.label_width(canvas.font) + if at_right { LETTER_HEIGHT * LABEL } else { 0.0 };
    let middle = frame.top + 0.5 * frame.height;
    let size = fitting(canvas.font, title, frame.height + LABEL);
    canvas.text(title, size, (edge + outwards * beside, middle), Anchor::Middle, true, INK);
}

/// Where on a map of colours the ground of a legend's samples is.
const LIKE_A_MAP: f64 = 0.3;

fn draw_legend(canvas: &mut Canvas<'_>, panel: &Panel, placed: &Placed, colors: &[Rgb], top: f64) {
    let mut middle = top + 0.5 * LEGEND_LINE;
    for line in &placed.legend {
        let mut left = placed.frame.left;
        for &index in line {
            let series = &panel.series[index];
            let parts: Vec<(&Series, Rgb)> =
                panel.series.iter().zip(colors.iter().copied()).filter(|(other, _)| other.name == series.name).collect();
            // One sample of each kind; a name for curves of several colours has none of them.
            let is_one = parts.iter().all(|(_, color)| *color == parts[0].1);
            // Colours made for a map need one behind them.
            if panel.heat_map().is_some() {
                let plate = rectangle(left, middle - 0.5 * LEGEND_LINE + 1.0, LEGEND_SAMPLE, LEGEND_LINE - 2.0);
                canvas.path(&plate, Paint::Fill(crate::figure::ColorMap::Sequential.at(LIKE_A_MAP), 1.0));
            }
            let mut kinds = Vec::new();
            for (part, color) in parts {
                let kind = std::mem::discriminant(&part.mark);
                if !kinds.contains(&kind) {
                    kinds.push(kind);
                    draw_sample(canvas, part, if is_one { color } else { INK }, (left, middle), LEGEND_SAMPLE);
                }
            }
            let baseline = middle + 0.5 * LETTER_HEIGHT * SMALL;
            canvas.text(&series.name, SMALL, (left + LEGEND_SAMPLE + GAP, baseline), Anchor::Start, false, INK);
            left += layout::entry_width(series, canvas.font);
        }
        middle += LEGEND_LINE;
    }
}
