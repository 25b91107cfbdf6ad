//! Ends of an axis, and how they follow what is drawn.

use crate::figure::Axis;

/// Ends of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    /// The axis with these ends.
    pub fn on(self, axis: Axis) -> Axis {
        axis.between(self.low, self.high)
    }

    /// Borders of so many cells of equal width.
    #[expect(clippy::cast_precision_loss, reason = "a number of cells")]
    pub fn edges(self, cells: usize) -> Vec<f64> {
        (0..=cells).map(|i| self.low + (self.high - self.low) * i as f64 / cells as f64).collect()
    }

    /// The smallest range with both in it.
    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// A range that grows with its contents and shrinks only while nothing is dragged: no axis jumps
/// under a moving slider.
#[derive(Debug, Default)]
pub struct AutoRange {
    shown: Option<Range>,
}

impl AutoRange {
    /// Moves to what the contents want.
    pub fn follow(&mut self, wanted: Range, dragging: bool) {
        self.shown = Some(match self.shown {
            Some(shown) if dragging => shown.with(wanted),
            _ => wanted,
        });
    }

    pub fn get(&self) -> Option<Range> {
        self.shown
    }

    /// The axis with these ends, once there are some.
    pub fn on(&self, axis: Axis) -> Axis {
        match self.shown {
            Some(range) => range.on(axis),
            None => axis,
        }
    }
}

/// The next of 1, 1.5, 2, 3, 5, 7.5 times a power of ten with some air above the value.
pub fn nice_ceiling(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let value = 1.04 * value;
    let decade = libm::exp10(libm::log10(value).floor());
    [1.0, 1.5, 2.0, 3.0, 5.0, 7.5, 10.0].into_iter().map(|step| step * decade).find(|&top| top >= value).unwrap_or(value)
}
