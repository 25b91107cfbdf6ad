//! Ends of an axis, and how they follow what is drawn.

/// Ends of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    /// The smallest range with both in it.
    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// A range that grows with its contents and shrinks only when nobody drags, so that nothing jumps under a moving slider.
#[derive(Debug, Default)]
pub struct Following {
    shown: Option<Range>,
}

impl Following {
    /// Goes where the contents want it.
    pub fn follow(&mut self, wanted: Range, dragging: bool) {
        self.shown = Some(match self.shown {
            Some(shown) if dragging => shown.with(wanted),
            _ => wanted,
        });
    }

    pub fn get(&self) -> Option<Range> {
        self.shown
    }
}

/// The next of 1, 1.5, 2, 3, 5, 7.5 times a power of ten with some air above the value.
pub fn round_up(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let value = 1.04 * value;
    let decade = libm::exp10(libm::log10(value).floor());
    [1.0, 1.5, 2.0, 3.0, 5.0, 7.5, 10.0].into_iter().map(|step| step * decade).find(|&top| top >= value).unwrap_or(value)
}
