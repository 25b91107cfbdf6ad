//! A range with soft walls: its coordinate runs from −∞ to ∞, and is the logarithm of a value far below the upper wall.

/// A soft-walled range, its ends ≥ 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Walls {
    pub low: f64,
    /// One over the upper end; 0 where there is none.
    pub one_over_high: f64,
}

/// A value between walls, and what its derivatives need.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Walled {
    pub value: f64,
    /// Derivative of the value by the coordinate.
    pub slope: f64,
    /// e to the coordinate.
    e: f64,
    /// That over the upper end.
    ratio: f64,
    /// 1 − low/high.
    span: f64,
}

impl Walls {
    pub(crate) fn between(low: f64, high: f64) -> Self {
        Self { low, one_over_high: 1.0 / high }
    }

    /// `ln(x − low) − ln(1 − x/high)`.
    pub(crate) fn coordinate(self, value: f64) -> f64 {
        libm::log(value - self.low) - libm::log1p(-value * self.one_over_high)
    }

    /// The value at a coordinate.
    pub(crate) fn value(self, coordinate: f64) -> Walled {
        let e = libm::exp(coordinate);
        let ratio = e * self.one_over_high;
        let span = 1.0 - self.low * self.one_over_high;
        let one_over = 1.0 / (1.0 + ratio);
        Walled { value: (self.low + e) * one_over, slope: e * span * one_over * one_over, e, ratio, span }
    }
}

impl Walled {
    /// Derivative of the logarithm of the slope by the coordinate.
    pub(crate) fn log_slope_change(&self) -> f64 {
        (1.0 - self.ratio) / (1.0 + self.ratio)
    }

    /// Change of the value, and of the logarithm of its slope, where the walls move at a fixed coordinate: by the changes of the
    /// lower end and of one over the upper one.
    pub(crate) fn moved(&self, walls: Walls, [low, one_over_high]: [f64; 2]) -> [f64; 2] {
        let one_over = 1.0 / (1.0 + self.ratio);
        let value = one_over * (low - one_over_high * self.value * self.e);
        let by_low = -walls.one_over_high / self.span;
        let by_high = -walls.low / self.span - 2.0 * self.e * one_over;
        [value, by_low * low + by_high * one_over_high]
    }
}
