//! An axis of a figure on the screen: where values lie along it, its ends and its marks.

use crate::app::plots::axis::{decades, decimal, is_written_out, logarithmic, marks};
use crate::app::plots::range::Range;
use crate::figure::{Axis, Scale};
use egui_plot::{GridInput, GridMark};

/// An axis in the coordinates of the plot, which are decimal logarithms on a logarithmic one.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotAxis {
    pub title: String,
    pub range: Range,
    log: bool,
    ticks: Option<Vec<(f64, String)>>,
}

/// Room around what is drawn, as a fraction of it.
const AIR: f64 = 0.04;

/// Decades below the axis where what is 0 or less ends.
const BELOW: f64 = 16.0;

impl PlotAxis {
    /// The axis; where it has no ends of its own, around those coordinates.
    pub fn new(axis: &Axis, coordinates: impl Iterator<Item = f64>) -> Self {
        let log = axis.scale == Scale::Log;
        let own = axis.range.and_then(|(low, high)| Some(Range { low: coordinate(log, low)?, high: coordinate(log, high)? }));
        let range = own.filter(|range| range.low < range.high).unwrap_or_else(|| around(coordinates));
        Self { title: axis.title(), range, log, ticks: axis.ticks.clone() }
    }

    /// The coordinate of a value; none where the axis has no place for it.
    pub fn coordinate(&self, value: f64) -> Option<f64> {
        coordinate(self.log, value)
    }

    /// Like [`PlotAxis::coordinate`], but 0 and less lie far below a logarithmic axis: ends of
    /// bands and error bars.
    pub fn end_coordinate(&self, value: f64) -> Option<f64> {
        if self.log && value <= 0.0 { Some(self.range.low - BELOW) } else { self.coordinate(value) }
    }

    /// The value at a coordinate.
    pub fn value(&self, coordinate: f64) -> f64 {
        if self.log { libm::exp10(coordinate) } else { coordinate }
    }

    /// Marks, at least `spread` times the plot's smallest spacing apart.
    pub fn marks(&self, input: &GridInput, spread: f64) -> Vec<GridMark> {
        match &self.ticks {
            Some(ticks) => {
                let at: Vec<f64> = ticks.iter().filter_map(|(at, _)| self.coordinate(*at)).collect();
                let closest = at.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(f64::INFINITY, f64::min);
                let every = every(at.len(), LETTERS * spread * input.base_step_size / closest);
                let kept = at.into_iter().step_by(every);
                kept.map(|value| GridMark { value, step_size: spread * input.base_step_size }).collect()
            }
            None if self.log => decades(input, spread),
            None => marks(input, spread, 0.0),
        }
    }

    /// What stands at a mark.
    pub fn label(&self, coordinate: f64, step_size: f64) -> String {
        match &self.ticks {
            Some(ticks) => {
                let distance = |(at, _): &&(f64, String)| self.coordinate(*at).map_or(f64::INFINITY, |at| (at - coordinate).abs());
                let nearest = ticks.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
                nearest.map_or_else(String::new, |(_, label)| label.clone())
            }
            None if self.log => logarithmic(coordinate, step_size, is_written_out(self.range.low, self.range.high)),
            None => decimal(coordinate, step_size),
        }
    }
}

/// What a number takes at least, in wanted gaps between marks.
const LETTERS: f64 = 0.45;

/// Of so many marks at equal gaps every how many are kept where a number takes that many gaps: such that the last one is kept
/// as well as the first, if that is possible.
fn every(count: usize, gaps: f64) -> usize {
    let last = count.saturating_sub(1);
    (1..=last)
        .filter(|every| last.is_multiple_of(*every))
        .find(|every| f64::from(u32::try_from(*every).unwrap_or(u32::MAX)) >= gaps)
        .unwrap_or(last.max(1))
}

/// The coordinate of a value on an axis.
pub fn coordinate(log: bool, value: f64) -> Option<f64> {
    let coordinate = if log { libm::log10(value) } else { value };
    coordinate.is_finite().then_some(coordinate)
}

/// Ends with some air around coordinates.
fn around(coordinates: impl Iterator<Item = f64>) -> Range {
    let (low, high) = coordinates.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    // Nothing, or a single place, has no extent of its own.
    let (low, high) = match (low, high) {
        (low, high) if low < high => (low, high),
        (low, _) if low.is_finite() => (low - 0.5, low + 0.5),
        _ => (0.0, 1.0),
    };
    let air = AIR * (high - low);
    Range { low: low - air, high: high + air }
}

#[cfg(test)]
mod tests {
    use super::every;

    #[test]
    fn numbers_of_a_short_axis_keep_off_each_other() {
        // −90 to 90 in steps of 30: all, every second, −90, 0 and 90, both ends.
        for (gaps, expected) in [(0.4, 1), (1.0, 1), (1.8, 2), (2.5, 3), (3.5, 6), (9.0, 6)] {
            assert_eq!(every(7, gaps), expected, "{gaps}");
        }
        assert_eq!((every(0, 2.0), every(1, 2.0), every(3, 0.0)), (1, 1, 1));
    }
}
