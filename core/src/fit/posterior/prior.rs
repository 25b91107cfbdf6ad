//! What is believed of a parameter before the data.

use crate::fit::bounds::Bounds;
use crate::model::Parameter;
use crate::optics::shortest;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Prior of one parameter, cut at its bounds.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Prior {
    /// Equally likely within the bounds.
    #[default]
    Flat,
    /// Equally likely within a part of the bounds, in the parameter's unit.
    Uniform {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// Gaussian.
    Normal {
        /// Its centre, in the parameter's unit.
        mean: f64,
        /// Its standard deviation, > 0, in the parameter's unit.
        sd: f64,
    },
    /// Equally likely in the logarithm, within a part of the bounds.
    LogUniform {
        /// Lower end, > 0.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

/// Why a prior is none.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PriorError {
    /// The prior reaches outside the bounds, or of a Gaussian next to nothing lies inside.
    #[error("the prior of {} lies outside its bounds {} … {}", .parameter.key(), shortest(*.low), shortest(*.high))]
    OutsideBounds {
        /// Of which parameter.
        parameter: Parameter,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// The ends are not in order, a logarithm has a lower end that is not above 0, or a standard deviation is not above 0.
    #[error("the prior of {} is no distribution: {expected}", .parameter.key())]
    NoDistribution {
        /// Of which parameter.
        parameter: Parameter,
        /// What it should be.
        expected: &'static str,
    },
    /// The parameter is held or not in the model.
    #[error("{} is not free and has no prior", .parameter.key())]
    NotFree {
        /// Which parameter.
        parameter: Parameter,
    },
}

/// Standard deviations that a Gaussian prior's mean may lie outside the bounds: a probability of 10⁻⁷ is left inside.
const FARTHEST_MEAN: f64 = 5.0;

/// A prior with the bounds that it is cut at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundedPrior {
    prior: Prior,
    ends: (f64, f64),
    /// Logarithm of one over the prior's integral over the bounds.
    log_norm: f64,
}

impl Prior {
    /// What kind of distribution it is, in a word.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Flat | Self::Uniform { .. } => "uniform",
            Self::Normal { .. } => "normal",
            Self::LogUniform { .. } => "log-uniform",
        }
    }

    /// Whether it is a distribution within the bounds of its parameter.
    ///
    /// # Errors
    ///
    /// [`PriorError`] where it is none or lies outside.
    pub fn check(self, parameter: Parameter, bounds: &Bounds) -> Result<(), PriorError> {
        self.narrowed(parameter, bounds).map(drop)
    }

    /// The bounds of the parameter with this prior.
    pub(crate) fn narrowed(self, parameter: Parameter, bounds: &Bounds) -> Result<(f64, f64), PriorError> {
        let (low, high) = bounds.of(parameter);
        let wrong = |expected| Err(PriorError::NoDistribution { parameter, expected });
        let is_inside = match self {
            Self::Flat => true,
            Self::Normal { sd, .. } if sd <= 0.0 => return wrong("the standard deviation must be above 0"),
            Self::Normal { mean, sd } => mean + FARTHEST_MEAN * sd >= low && mean - FARTHEST_MEAN * sd <= high,
            Self::Uniform { low: from, high: to } | Self::LogUniform { low: from, high: to } if from >= to => {
                return wrong("the lower end must be below the upper one");
            }
            Self::LogUniform { low: from, .. } if from <= 0.0 => return wrong("the lower end of a logarithm must be above 0"),
            Self::Uniform { low: from, high: to } | Self::LogUniform { low: from, high: to } => {
                if low <= from && to <= high {
                    return Ok((from, to));
                }
                false
            }
        };
        if is_inside { Ok((low, high)) } else { Err(PriorError::OutsideBounds { parameter, low, high }) }
    }
}

impl BoundedPrior {
    /// What kind of distribution it is, in a word.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.prior.kind()
    }

    /// Where it begins and ends, in the parameter's unit.
    #[must_use]
    pub fn ends(&self) -> (f64, f64) {
        self.ends
    }

    /// Its density at a value, per unit of the parameter; 0 outside of its ends.
    #[must_use]
    pub fn density(&self, value: f64) -> f64 {
        let (low, high) = self.ends;
        if (low..=high).contains(&value) { libm::exp(self.log_density(value).0) } else { 0.0 }
    }

    /// A prior on a parameter between those ends.
    pub(crate) fn new(prior: Prior, (low, high): (f64, f64)) -> Self {
        let norm = match prior {
            Prior::Flat | Prior::Uniform { .. } => high - low,
            Prior::Normal { mean, sd } => {
                // On the side where the error functions do not cancel.
                let (near, far) = if mean <= low { (low - mean, high - mean) } else { (mean - high, mean - low) };
                let above = |x: f64| 0.5 * libm::erfc(x / sd * FRAC_1_SQRT_2);
                above(near) - above(far)
            }
            Prior::LogUniform { .. } => libm::log(high / low),
        };
        Self { prior, ends: (low, high), log_norm: -libm::log(norm) }
    }

    /// Logarithm of the density at a value within the bounds, and its derivative.
    pub(crate) fn log_density(&self, value: f64) -> (f64, f64) {
        let (log, slope) = match self.prior {
            Prior::Flat | Prior::Uniform { .. } => (0.0, 0.0),
            Prior::Normal { mean, sd } => {
                let off = (value - mean) / sd;
                (-0.5 * (off * off + libm::log(TAU)) - libm::log(sd), -off / sd)
            }
            Prior::LogUniform { .. } => (-libm::log(value), -1.0 / value),
        };
        (log + self.log_norm, slope)
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::{BoundedPrior, Prior};
    use crate::fit::bounds::Bounds;
    use crate::model::Parameter;

    #[test]
    fn priors_integrate_to_one_over_the_bounds() {
        // Simpson's rule with 2,000 steps on the logarithm of n, whose densities are smooth there.
        const STEPS: usize = 2000;
        let mut bounds = Bounds::default();
        bounds.set(Parameter::N, 0.5, 3.0).unwrap();
        let normal = |mean, sd| Prior::Normal { mean, sd };
        let (low, high) = (0.6, 2.5);
        let parts = [Prior::Uniform { low, high }, Prior::LogUniform { low, high }];
        for prior in [Prior::Flat, normal(2.0, 0.3), normal(0.2, 0.4), normal(3.5, 0.2)].into_iter().chain(parts) {
            let (low, high) = prior.narrowed(Parameter::N, &bounds).unwrap();
            let bounded = BoundedPrior::new(prior, (low, high));
            let width = libm::log(high / low) / STEPS as f64;
            let at = |i: usize| {
                let n = low * libm::exp(i as f64 * width);
                let (log, slope) = bounded.log_density(n);
                let after = bounded.log_density(n * (1.0 + 1e-6)).0;
                // A difference of 1e-6 n leaves its curvature and rounding.
                assert!(((after - log) / (1e-6 * n) - slope).abs() < 1e-4 * (1.0 + slope.abs()) * (1.0 + slope.abs()), "{prior:?} at {n}");
                n * libm::exp(log)
            };
            let sum: f64 = (0..=STEPS)
                .map(|i| {
                    at(i)
                        * if i == 0 || i == STEPS {
                            1.0
                        } else if i % 2 == 1 {
                            4.0
                        } else {
                            2.0
                        }
                })
                .sum();
            assert!((sum * width / 3.0 - 1.0).abs() < 1e-8, "{prior:?}: {}", sum * width / 3.0);
            let at_middle = f64::midpoint(low, high);
            assert_eq!(bounded.density(at_middle).to_bits(), libm::exp(bounded.log_density(at_middle).0).to_bits());
            assert_eq!((bounded.ends(), bounded.density(low - 0.1), bounded.density(high + 0.1)), ((low, high), 0.0, 0.0));
        }
    }

    #[test]
    fn priors_that_are_none_are_refused() {
        let refused = |parameter, prior: Prior| prior.narrowed(parameter, &Bounds::default()).is_err();
        assert!(refused(Parameter::N, Prior::Normal { mean: 12.0, sd: 0.1 }));
        assert!(refused(Parameter::N, Prior::Normal { mean: 2.0, sd: 0.0 }));
        assert!(refused(Parameter::N, Prior::Uniform { low: 1.0, high: 12.0 }));
        assert!(refused(Parameter::N, Prior::Uniform { low: 3.0, high: 2.0 }));
        assert!(refused(Parameter::K, Prior::LogUniform { low: 0.0, high: 2.0 }));
    }
}
