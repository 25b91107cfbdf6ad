//! The three lobes, each for unit weight.
//!
//! - specular, Eqs. (4, 10): `F^s = P(α) G / (4 cos α cos θi cos θr) · M`, here without M
//! - diffuse, Eq. (12): `F^d = (cos θi cos θr)^c / π` (Minnaert)
//! - volume, Eq. (13): `F^v = exp(−θr²/2σ_v²) / (√(2π) σ_v)`
//!
//! A lobe is kept as `factor · e^(−exponent)`, so that the ratio of two lobes is right even where both underflow.

use crate::optics::{Facet, SlopeDistribution};
use std::f64::consts::{FRAC_1_PI, PI};

/// √(2π).
const SQRT_TWO_PI: f64 = 2.506_628_274_631_000_5;
/// e^x and e^(−x) are normal numbers up to here.
const LARGEST_EXPONENT: f64 = 700.0;

/// A radiance factor `factor · e^(−exponent)` in sr⁻¹.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// What stands before the exponential.
    pub factor: f64,
    /// What stands in it, with the sign changed: large is dark.
    pub exponent: f64,
}

impl Lobe {
    /// No light.
    pub const ZERO: Self = Self { factor: 0.0, exponent: 0.0 };

    /// Its value.
    #[must_use]
    pub fn value(self) -> f64 {
        times_exp(self.factor, -self.exponent)
    }

    /// This lobe divided by another one.
    #[must_use]
    pub fn ratio(self, other: Self) -> f64 {
        times_exp(self.factor / other.factor, other.exponent - self.exponent)
    }

    /// This lobe divided by another one, times two gains: right also where the ratio or the product of the gains alone
    /// leaves the range of f64.
    #[must_use]
    pub fn scaled_ratio(self, other: Self, [a, b]: [f64; 2]) -> f64 {
        let half = libm::exp(0.5 * (other.exponent - self.exponent));
        let factor = self.factor / other.factor;
        if [a, b, half, factor].contains(&0.0) { 0.0 } else { (a * half) * (b * half) * factor }
    }

    /// With another weight; a weight of 0 makes an infinite lobe 0, too.
    #[must_use]
    pub fn scaled(self, weight: f64) -> Self {
        if weight == 0.0 { Self::ZERO } else { Self { factor: weight * self.factor, ..self } }
    }
}

/// `factor · e^x`, also where e^x alone leaves the range of f64.
fn times_exp(factor: f64, x: f64) -> f64 {
    if factor == 0.0 {
        0.0
    } else if x.abs() <= LARGEST_EXPONENT {
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
    Lobe { factor: distribution.height(q) * geometric / sigma / sigma, exponent: distribution.exponent(w, q) }
}

/// The Minnaert lobe; c = 0 is Lambert.
pub(crate) fn diffuse(facet: &Facet, c: f64) -> Lobe {
    Lobe { factor: FRAC_1_PI, exponent: -c * facet.ln_cosines }
}

/// The volume lobe.
pub(crate) fn volume(facet: &Facet, sigma_v: f64) -> Lobe {
    let reduced = facet.theta_r / sigma_v;
    Lobe { factor: 1.0 / (SQRT_TWO_PI * sigma_v), exponent: 0.5 * reduced * reduced }
}

#[cfg(test)]
mod tests {
    use super::Lobe;

    fn lobe(factor: f64, exponent: f64) -> Lobe {
        Lobe { factor, exponent }
    }

    #[test]
    fn ratio_of_two_underflowing_lobes_is_kept() {
        let a = lobe(3.0, 1000.0);
        let b = lobe(1.5, 1000.0);
        assert_eq!((a.value(), b.value(), a.ratio(b)), (0.0, 0.0, 2.0));
    }

    #[test]
    fn a_huge_factor_brings_back_what_the_exponential_alone_would_lose() {
        let lobe = lobe(1e300, 800.0);
        let expected = libm::exp10(300.0 - 800.0 * std::f64::consts::LOG10_E);
        // exp10 of such an argument is itself good to about 1e-13.
        assert!((lobe.value() / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn gains_and_ratio_may_leave_the_range_of_f64_where_their_product_does_not() {
        let (dark, darker) = (lobe(1.0, 100.0), lobe(2.0, 900.0));
        let expected = 0.5 * libm::exp(800.0 - 2.0 * 300.0);
        // Three exponentials with arguments of some hundreds.
        assert!((dark.scaled_ratio(darker, [libm::exp(-300.0); 2]) / expected - 1.0).abs() < 1e-12);
        assert_eq!(lobe(1.0, 0.0).scaled_ratio(darker, [0.0, f64::INFINITY]), 0.0);
    }
}
