//! The box that a fit stays in.

use crate::model::{Parameter, Parameters};
use crate::optics::shortest;

/// Lower and upper bound of each parameter; by default the ranges of the sliders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    low: Parameters,
    high: Parameters,
}

/// Why two numbers are no bounds.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BoundsError {
    /// The lower is not below the upper.
    #[error(
        "bounds of {} are {} … {}: the lower one must be below the upper one", .parameter.key(), shortest(*.low), shortest(*.high)
    )]
    Order {
        /// Which parameter.
        parameter: Parameter,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// A bound outside the mathematical domain.
    #[error("bound {} of {} is not allowed: expected {}", shortest(*.value), .parameter.key(), .parameter.domain())]
    Domain {
        /// Which parameter.
        parameter: Parameter,
        /// The bound.
        value: f64,
    },
}

impl Default for Bounds {
    fn default() -> Self {
        let mut bounds = Self { low: Parameters::default(), high: Parameters::default() };
        for parameter in Parameter::ALL {
            bounds.low[parameter] = *parameter.range().start();
            bounds.high[parameter] = *parameter.range().end();
        }
        bounds
    }
}

impl Bounds {
    /// Lower and upper bound.
    #[must_use]
    pub fn of(&self, parameter: Parameter) -> (f64, f64) {
        (self.low[parameter], self.high[parameter])
    }

    /// Sets the bounds of one parameter; they may exceed its slider's range within the mathematical domain.
    ///
    /// # Errors
    ///
    /// [`BoundsError`] where a bound lies outside the domain, or the lower one is not below the upper one.
    pub fn set(&mut self, parameter: Parameter, low: f64, high: f64) -> Result<(), BoundsError> {
        for value in [low, high] {
            if !parameter.domain().contains(value) {
                return Err(BoundsError::Domain { parameter, value });
            }
        }
        if low >= high {
            return Err(BoundsError::Order { parameter, low, high });
        }
        self.low[parameter] = low;
        self.high[parameter] = high;
        Ok(())
    }

    /// Makes room for a value outside.
    pub fn widen_to(&mut self, parameter: Parameter, value: f64) {
        self.low[parameter] = self.low[parameter].min(value);
        self.high[parameter] = self.high[parameter].max(value);
    }

    /// Whether a value lies inside or on the edge.
    #[must_use]
    pub fn contain(&self, parameter: Parameter, value: f64) -> bool {
        (self.low[parameter]..=self.high[parameter]).contains(&value)
    }

    /// The nearest value inside.
    #[must_use]
    pub fn clamp(&self, parameter: Parameter, value: f64) -> f64 {
        value.clamp(self.low[parameter], self.high[parameter])
    }

    /// The value at a fraction 0 to 1 of the box, spread by factors; c alone, which has no scale, by steps.
    #[must_use]
    pub fn spread(&self, parameter: Parameter, fraction: f64) -> f64 {
        let (low, high) = self.of(parameter);
        let (origin, smallest) = match parameter {
            Parameter::C => return self.at(parameter, fraction),
            // q counts from 1.
            Parameter::Q => (1.0, 1e-4),
            Parameter::K => (0.0, 1e-2),
            // Four decades below the upper bound a weight is next to nothing; 0 has no logarithm.
            _ => (0.0, 1e-4),
        };
        let (top, bottom) = (high - origin, (low - origin).max(smallest * (high - origin)));
        self.clamp(parameter, origin + bottom * libm::pow(top / bottom, fraction))
    }

    /// The value at a fraction 0 to 1 of the way from the lower to the upper bound.
    #[must_use]
    pub fn at(&self, parameter: Parameter, fraction: f64) -> f64 {
        let (low, high) = self.of(parameter);
        self.clamp(parameter, low + fraction * (high - low))
    }
}
