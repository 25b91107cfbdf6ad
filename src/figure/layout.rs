//! Layout of a figure: frames, ends of axes, ticks, legends, colour bars.

use crate::figure::canvas::POINTS_PER_MM;
use crate::figure::text::Font;
use crate::figure::ticks::{Tick, ticks};
use crate::figure::{Axis, Figure, Panel, Scale, Series};

/// Sizes of text in points.
pub const TITLE: f64 = 10.0;
pub const LABEL: f64 = 9.0;
pub const SMALL: f64 = 8.0;
/// Margin of the page, in points.
const MARGIN: f64 = 6.0;
/// Length of a tick.
pub const TICK: f64 = 3.5;
/// Distance between a tick and its label, and between neighbouring elements.
pub const GAP: f64 = 3.0;
/// Height of a line of the legend.
pub const LEGEND_LINE: f64 = 11.5;
/// Width of the sample in a legend.
pub const LEGEND_SAMPLE: f64 = 18.0;
/// Distance between two entries of a legend.
const LEGEND_SPACE: f64 = 12.0;
/// Width of a colour bar.
pub const COLOR_BAR: f64 = 9.0;
/// Largest share of the width for the labels of a vertical axis.
const WIDEST_LABELS: f64 = 0.45;
/// Height of a letter relative to its size, for centring.
pub const LETTER_HEIGHT: f64 = 0.73;

/// A rectangle in points; y grows downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Frame {
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// An axis with its ends and marks.
#[derive(Debug, Clone, PartialEq)]
pub struct Ruled {
    pub low: f64,
    pub high: f64,
    pub scale: Scale,
    pub ticks: Vec<Tick>,
}

impl Ruled {
    pub fn new(axis: &Axis, ends: (f64, f64), most: usize) -> Self {
        Self { low: ends.0, high: ends.1, scale: axis.scale, ticks: ticks(axis, ends, most) }
    }

    /// Position of a value, 0 at the lower end and 1 at the upper; none for a value outside the
    /// domain of the scale.
    pub fn fraction(&self, value: f64) -> Option<f64> {
        let fraction = match self.scale {
            // Differences of halves do not overflow.
            Scale::Linear => (0.5 * value - 0.5 * self.low) / (0.5 * self.high - 0.5 * self.low),
            Scale::Log => (libm::log10(value) - libm::log10(self.low)) / (libm::log10(self.high) - libm::log10(self.low)),
        };
        fraction.is_finite().then_some(fraction)
    }

    /// Widest label.
    pub fn label_width(&self, font: &Font) -> f64 {
        self.ticks.iter().filter_map(|tick| tick.label.as_ref()).map(|label| font.width(label, SMALL)).fold(0.0, f64::max)
    }
}

/// A colour bar.
#[derive(Debug, Clone, PartialEq)]
pub struct ColorBar {
    pub frame: Frame,
    pub axis: Ruled,
}

/// A panel with the positions of its elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    pub frame: Frame,
    pub x: Ruled,
    pub y: Ruled,
    /// Lines of indices of series.
    pub legend: Vec<Vec<usize>>,
    pub color_bar: Option<ColorBar>,
}

/// Breaks the legend into lines no wider than the frame.
fn legend(panel: &Panel, font: &Font, room: f64) -> Vec<Vec<usize>> {
    let mut lines: Vec<Vec<usize>> = Vec::new();
    let mut used = 0.0;
    if !panel.legend {
        return lines;
    }
    for (i, series) in panel.series.iter().enumerate() {
        let is_first = !panel.series[..i].iter().any(|before| before.name == series.name);
        if series.name.is_empty() || !is_first {
            continue;
        }
        let width = entry_width(series, font);
        match lines.last_mut().filter(|_| used + width <= room) {
            Some(line) => line.push(i),
            None => {
                lines.push(vec![i]);
                used = 0.0;
            }
        }
        used += width;
    }
    lines
}

/// Width of an entry of the legend with the space after it.
pub fn entry_width(series: &Series, font: &Font) -> f64 {
    LEGEND_SAMPLE + GAP + font.width(&series.name, SMALL) + LEGEND_SPACE
}

/// A cell of the grid of panels and the margins inside it, all in points.
struct Cell {
    outer: Frame,
    above: f64,
    below: f64,
    left: f64,
    right: f64,
    y: Ruled,
    color: Option<Ruled>,
    legend: Vec<Vec<usize>>,
}

/// Number of labels that fit into a length, with a lower limit.
fn most(length: f64, each: f64, least: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "2 to 9")]
    let most = (length / each).clamp(least, 9.0) as usize;
    most
}

fn cell(panel: &Panel, outer: Frame, font: &Font) -> Cell {
    if panel.is_blank() {
        let y = Ruled::new(&panel.y, (0.0, 1.0), 2);
        return Cell { outer, above: 0.0, below: 0.0, left: 0.0, right: 0.0, y, color: None, legend: Vec::new() };
    }
    let legend = legend(panel, font, outer.width - 30.0);
    let title = if panel.title.is_empty() { 0.0 } else { LABEL + GAP };
    #[expect(clippy::cast_precision_loss, reason = "a handful of lines")]
    let above = title + LEGEND_LINE * legend.len() as f64 + 0.5 * SMALL;
    let x_label = if panel.x.title().is_empty() { 0.0 } else { LABEL + GAP };
    let below = TICK + GAP + SMALL + x_label + GAP;
    let height = (outer.height - above - below).max(1.0);
    let y = Ruled::new(&panel.y, crate::figure::range::y(panel), most(height, 20.0, 3.0));
    let y_label = if panel.y.title().is_empty() { 0.0 } else { LABEL + GAP };
    let left = y_label + y.label_width(font).min(WIDEST_LABELS * outer.width) + TICK + 2.0 * GAP;
    let color = panel.heat_map().map(|map| Ruled::new(&map.color_axis, crate::figure::range::color(map), most(height, 20.0, 3.0)));
    let bar = color.as_ref().filter(|_| panel.legend).map_or(0.0, |color| {
        let label = panel.heat_map().map_or(0.0, |map| if map.color_axis.title().is_empty() { 0.0 } else { LABEL + GAP });
        2.0 * GAP + COLOR_BAR + TICK + GAP + color.label_width(font) + label
    });
    Cell { outer, above, below, left, right: bar + 12.0, y, color, legend }
}

/// Places all panels of a figure.
pub fn place(figure: &Figure, font: &Font) -> Vec<Placed> {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let rows = figure.panels.len().div_ceil(columns);
    let title = if figure.title.is_empty() { 0.0 } else { TITLE + 2.0 * GAP };
    let width = figure.width_mm * POINTS_PER_MM - 2.0 * MARGIN;
    let height = figure.height_mm * POINTS_PER_MM - 2.0 * MARGIN - title;
    let share = |row: usize| {
        let row = figure.panels.iter().skip(row * columns).take(columns);
        row.map(|panel| if panel.height_share > 0.0 { panel.height_share.min(100.0) } else { 1.0 }).fold(0.0, f64::max)
    };
    let shares: f64 = (0..rows).map(share).sum();
    #[expect(clippy::cast_precision_loss, reason = "a handful of panels")]
    let column_width = width / columns as f64;
    let mut top = MARGIN + title;
    let mut cells: Vec<Cell> = Vec::new();
    for row in 0..rows {
        let row_height = height * share(row) / shares;
        for (column, panel) in figure.panels.iter().skip(row * columns).take(columns).enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "a handful of panels")]
            let left = MARGIN + column as f64 * column_width;
            cells.push(cell(panel, Frame { left, top, width: column_width, height: row_height }, font));
        }
        top += row_height;
    }
    align(&mut cells, columns);
    figure.panels.iter().zip(cells).map(|(panel, cell)| placed(panel, cell, font)).collect()
}

/// Gives panels above each other the same margins, and panels beside each other too.
fn align(cells: &mut [Cell], columns: usize) {
    for column in 0..columns {
        let widest = |of: fn(&Cell) -> f64, cells: &[Cell]| cells.iter().skip(column).step_by(columns).map(of).fold(0.0, f64::max);
        let (left, right) = (widest(|cell| cell.left, cells), widest(|cell| cell.right, cells));
        for cell in cells.iter_mut().skip(column).step_by(columns) {
            (cell.left, cell.right) = (left, right);
        }
    }
    for row in cells.chunks_mut(columns) {
        let above = row.iter().map(|cell| cell.above).fold(0.0, f64::max);
        let below = row.iter().map(|cell| cell.below).fold(0.0, f64::max);
        for cell in row {
            (cell.above, cell.below) = (above, below);
        }
    }
}

fn placed(panel: &Panel, cell: Cell, font: &Font) -> Placed {
    let Cell { outer, above, below, left, right, y, color, legend } = cell;
    let ends = crate::figure::range::x(panel);
    let mut frame = Frame {
        left: outer.left + left,
        top: outer.top + above,
        width: (outer.width - left - right).max(1.0),
        height: (outer.height - above - below).max(1.0),
    };
    if panel.equal_aspect {
        let ratio = (ends.1 - ends.0) / (y.high - y.low);
        if ratio.is_finite() && ratio > 0.0 {
            let (width, height) = (frame.width.min(frame.height * ratio), frame.height.min(frame.width / ratio));
            frame = Frame { left: frame.left + 0.5 * (frame.width - width), top: frame.top + 0.5 * (frame.height - height), width, height };
        }
    }
    let mut x = Ruled::new(&panel.x, ends, most(frame.width, 34.0, 2.0));
    let needed = x.label_width(font) + 3.0 * GAP;
    if needed > 34.0 {
        x = Ruled::new(&panel.x, ends, most(frame.width, needed, 2.0));
    }
    let color_bar = color.map(|axis| ColorBar {
        frame: Frame { left: frame.right() + 2.0 * GAP, top: frame.top, width: COLOR_BAR, height: frame.height },
        axis,
    });
    Placed { frame, x, y, legend, color_bar }
}
