//! The three lobes, each for unit weight.
//!
//! - specular, Eqs. (4, 10): `F^s = P(α) G / (4 cos α cos θi cos θr) · M`, here without M
//! - diffuse, Eq. (12): `F^d = (cos θi cos θr)^c / π` (Minnaert)
//! - volume, Eq. (13): `F^v = exp(−θr²/2σ_v²) / (√(2π) σ_v)`
//!
//! A lobe is kept as `factor · e^(−exponent)`, so that the ratio of two lobes is right even where both underflow.

use crate::optics::{Double, Facet, SlopeDistribution, two_sum};
use std::f64::consts::{FRAC_1_PI, PI};
use std::ops::RangeInclusive;

/// √(2π).
const SQRT_TWO_PI: f64 = 2.506_628_274_631_000_5;

/// Exponents end here: darker than this is equally dark, and the difference of two stays a number.
const DARKEST: f64 = 1e300;
/// No finite factor brings e^(±1e4) back into the range of f64: there are no digits to mend.
const BEYOND: f64 = 1e4;
/// What larger exponents leave over is too large for e^(−rest) = 1 − rest.
const LARGEST_WITH_REST: f64 = 1e9;
/// Values whose squares and quotients are far from the ends of f64.
const PLAIN: RangeInclusive<f64> = 1e-100..=1e100;

/// A radiance factor `factor · e^(−exponent)` in sr⁻¹.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// What stands before the exponential.
    pub factor: f64,
    /// What stands in it, with the sign changed: large is dark.
    pub exponent: f64,
    /// What the exponent leaves over where it is known to more digits than f64 has; 0 elsewhere.
    pub exponent_rest: f64,
}

impl Lobe {
    /// No light.
    pub const DARK: Self = Self::new(0.0, 0.0);

    /// `factor · e^(−exponent)`.
    #[must_use]
    pub const fn new(factor: f64, exponent: f64) -> Self {
        Self { factor, exponent, exponent_rest: 0.0 }
    }

    /// With an exponent of more digits, where these matter.
    pub(crate) fn with_exponent(self, exponent: Double) -> Self {
        let exponent_rest = if exponent.hi.abs() < LARGEST_WITH_REST { exponent.lo } else { 0.0 };
        Self { exponent: exponent.hi, exponent_rest, ..self }
    }

    /// Its value.
    #[must_use]
    pub fn value(self) -> f64 {
        let value = times_exp(self.factor, -self.exponent);
        // e^(−rest) = 1 − rest, the rest being a rounding.
        value * (1.0 - self.exponent_rest)
    }

    /// This lobe divided by another one.
    #[must_use]
    pub fn over(self, other: Self) -> f64 {
        self.over_times(other, [1.0; 2])
    }

    /// This lobe divided by another one, times two gains: right also where the ratio or the product of the gains alone leaves the
    /// range of f64.
    #[must_use]
    pub fn over_times(self, other: Self, gains: [f64; 2]) -> f64 {
        let [a, b] = gains;
        if a == 0.0 || b == 0.0 || self.factor == 0.0 {
            return 0.0;
        }
        let (x, rest) = self.exponent_over(other);
        let gain = a * b;
        let factor = gain * (self.factor / other.factor);
        // A subnormal product has lost digits.
        let ratio = if gain.is_normal() && factor.is_normal() {
            times_exp(factor, x)
        } else {
            let exponent = libm::log(a.abs()) + libm::log(b.abs()) + libm::log(self.factor) - libm::log(other.factor) + x;
            // An infinite gain over an infinite lobe: what is left of a product that f64 holds no factor of.
            if exponent.is_nan() { 0.0 } else { libm::exp(exponent).copysign(a * b) }
        };
        ratio * (1.0 + rest)
    }

    /// The exponent of the ratio, and what it leaves over.
    fn exponent_over(self, other: Self) -> (f64, f64) {
        if self.exponent_rest == 0.0 && other.exponent_rest == 0.0 {
            return (other.exponent - self.exponent, 0.0);
        }
        let difference = two_sum(other.exponent, -self.exponent);
        let rest = if difference.hi.abs() < BEYOND { difference.lo + (other.exponent_rest - self.exponent_rest) } else { 0.0 };
        (difference.hi, rest)
    }

    /// With another weight; a weight of 0 puts out even an infinite lobe.
    #[must_use]
    pub fn scaled(self, weight: f64) -> Self {
        if weight == 0.0 { Self::DARK } else { Self { factor: weight * self.factor, ..self } }
    }

    /// The value of the lobe with that weight, also where weight times factor alone leaves the range of f64.
    #[must_use]
    pub fn weighted(self, weight: f64) -> f64 {
        let scaled = self.scaled(weight);
        if scaled.factor.is_finite() { scaled.value() } else { weight * self.value() }
    }
}

/// `factor · e^x`, also where e^x alone leaves the range of f64.
fn times_exp(factor: f64, x: f64) -> f64 {
    // Beyond 700 in two steps; beyond 1500 no finite factor brings the product back.
    if factor == 0.0 || x < -1500.0 {
        0.0
    } else if x.abs() <= 700.0 {
        factor * libm::exp(x)
    } else {
        let half = libm::exp(0.5 * x);
        factor * half * half
    }
}

/// The specular lobe without its Mueller matrix.
///
/// `w = tan²α/2σ²`; P/cos α = D brings 1/cos⁴α = (1 + tan²α)², since P has 1/cos³α.
pub(crate) fn specular(distribution: SlopeDistribution, w: f64, facet: &Facet, g_over_cosines: f64, sigma: f64, q: f64) -> Lobe {
    let one_over_cos_sq = 1.0 + facet.tan_alpha_sq;
    let geometric = one_over_cos_sq * one_over_cos_sq * g_over_cosines / (8.0 * PI);
    let height = distribution.height(q);
    let exponent = distribution.exponent(w, q).min(DARKEST);
    if has_plain_factor(sigma, height) {
        Lobe::new(height * geometric / sigma / sigma, exponent)
    } else {
        // h/σ² alone would leave the range of f64.
        Lobe::new(geometric, exponent + 2.0 * libm::log(sigma) - libm::log(height))
    }
}

/// Whether the height over σ² stays in the range of f64.
pub(crate) fn has_plain_factor(sigma: f64, height: f64) -> bool {
    is_plain(sigma) && is_plain(height.max(1.0))
}

/// Whether squares and quotients of a value are far from the ends of f64.
pub(crate) fn is_plain(value: f64) -> bool {
    PLAIN.contains(&value)
}

/// The Minnaert lobe; c = 0 is Lambert.
pub(crate) fn diffuse(facet: &Facet, c: f64) -> Lobe {
    Lobe::new(FRAC_1_PI, -c * facet.ln_cosines)
}

/// The volume lobe.
pub(crate) fn volume(facet: &Facet, sigma_v: f64) -> Lobe {
    let reduced = facet.theta_r / sigma_v;
    Lobe::new(1.0 / (SQRT_TWO_PI * sigma_v), (0.5 * reduced * reduced).min(DARKEST))
}

#[cfg(test)]
mod tests {
    use super::Lobe;

    #[test]
    fn ratio_of_two_underflowing_lobes_is_kept() {
        let a = Lobe::new(3.0, 1000.0);
        let b = Lobe::new(1.5, 1000.0);
        assert_eq!((a.value(), b.value(), a.over(b)), (0.0, 0.0, 2.0));
    }

    #[test]
    fn a_huge_factor_brings_back_what_the_exponential_alone_would_lose() {
        let lobe = Lobe::new(1e300, 800.0);
        let expected = libm::exp10(300.0 - 800.0 * std::f64::consts::LOG10_E);
        // exp10 of such an argument is itself good to about 1e-13.
        assert!((lobe.value() / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn an_infinitely_dark_lobe_is_dark() {
        assert_eq!(Lobe::new(f64::INFINITY, f64::INFINITY).value(), 0.0);
    }
}
