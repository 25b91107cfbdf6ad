//! Slope distributions of the microfacets: Gauss, Eq. (5), and Cauchy, Eq. (7).
//!
//! With `w = tan²α / 2σ²` both are one form, `P(α) = e^(−x) h / (2πσ² cos³α)`:
//!
//! - Gauss: `x = w`, `h = 1`
//! - Cauchy: `x = q ln(1 + w)`, `h = q − 1`
//!
//! P carries one cosine more than the usual density of facet normals: `D = P / cos α` has
//! `∫ D cos α dω = 1`. Gauss is Beckmann with `α_ggx = √2 σ`; Cauchy with q = 2 is GGX with the same; Cauchy
//! tends to Gauss of slope σ/√q as q → ∞.

use serde::{Deserialize, Serialize};
use std::f64::consts::{LN_2, PI, SQRT_2};

/// How the slopes of the facets are distributed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SlopeDistribution {
    /// Eq. (5): Gaussian slopes (Beckmann); q plays no part.
    Gauss,
    /// Eq. (7): two-parameter hyper-Cauchy slopes with tail exponent q > 1.
    Cauchy,
}

impl SlopeDistribution {
    /// Both, in the order of the paper.
    pub const ALL: [Self; 2] = [Self::Gauss, Self::Cauchy];

    /// Name in files and options.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Gauss => "gauss",
            Self::Cauchy => "cauchy",
        }
    }

    /// The distribution of that name.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|distribution| distribution.key() == key)
    }

    /// x of the module's formula: P falls off as e^(−x).
    #[must_use]
    pub fn exponent(self, w: f64, q: f64) -> f64 {
        match self {
            Self::Gauss => w,
            Self::Cauchy => q * libm::log1p(w),
        }
    }

    /// h of the module's formula.
    #[must_use]
    pub fn height(self, q: f64) -> f64 {
        match self {
            Self::Gauss => 1.0,
            Self::Cauchy => q - 1.0,
        }
    }

    /// `σ ∂ln P/∂σ`: Gauss 2(w − 1), Cauchy 2((q − 1) w − 1)/(1 + w).
    #[must_use]
    pub fn sigma_log_slope(self, w: f64, q: f64) -> f64 {
        match self {
            Self::Gauss => 2.0 * (w - 1.0),
            // Beyond w = 1 in powers of 1/w, so that an infinite w has its limit 2(q − 1).
            Self::Cauchy if w > 1.0 => 2.0 * ((q - 1.0) - 1.0 / w) / (1.0 + 1.0 / w),
            Self::Cauchy => 2.0 * ((q - 1.0) * w - 1.0) / (1.0 + w),
        }
    }

    /// `∂P/∂q ÷ (P/h)` from ln(1 + w): Gauss 0, Cauchy 1 − (q − 1) ln(1 + w).
    #[must_use]
    pub fn q_slope(self, ln_1p_w: f64, q: f64) -> f64 {
        match self {
            Self::Gauss => 0.0,
            Self::Cauchy => 1.0 - (q - 1.0) * ln_1p_w,
        }
    }

    /// y of the share e^(−y) of the projected facets that are steeper: Gauss w, Cauchy (q − 1) ln(1 + w).
    #[must_use]
    pub fn survival_exponent(self, w: f64, q: f64) -> f64 {
        match self {
            Self::Gauss => w,
            Self::Cauchy => (q - 1.0) * libm::log1p(w),
        }
    }

    /// `dy/dx` for `x = ln(1 + w)`: with e^(−y) the share of facets per step in x.
    pub(crate) fn survival_slope(self, w: f64, q: f64) -> f64 {
        match self {
            Self::Gauss => 1.0 + w,
            Self::Cauchy => q - 1.0,
        }
    }

    /// ln(1 + w) beyond which facets are too few to count beside those at `first`: e^(−44) is less than f64 can add to 1.
    pub(crate) fn faintest(self, first: f64, q: f64) -> f64 {
        const FAINT: f64 = 44.0;
        match self {
            Self::Gauss => libm::log1p(first + FAINT),
            Self::Cauchy => libm::log1p(first) + FAINT / (q - 1.0),
        }
    }

    /// The σ of Gauss at which it has the median slope of Cauchy with that σ and q: then only their tails differ.
    /// `σ_G = σ √((2^(1/(q−1)) − 1)/ln 2)`; infinite for q so near 1 that half of the facets stand upright.
    #[must_use]
    pub fn gauss_of_equal_median(sigma: f64, q: f64) -> f64 {
        sigma * (libm::expm1(LN_2 / (q - 1.0)) / LN_2).sqrt()
    }

    /// The σ of Cauchy with tail exponent q at which it has the median slope of Gauss with that σ: the way back.
    #[must_use]
    pub fn cauchy_of_equal_median(gauss_sigma: f64, q: f64) -> f64 {
        gauss_sigma / (libm::expm1(LN_2 / (q - 1.0)) / LN_2).sqrt()
    }

    /// P(α), Eq. (5) or (7), for tan²α, slope σ > 0 and tail exponent q > 1.
    #[must_use]
    pub fn facet_density(self, tan_alpha_sq: f64, sigma: f64, q: f64) -> f64 {
        let w = reduced_slope_sq(tan_alpha_sq, sigma);
        let cos_alpha_sq = 1.0 / (1.0 + tan_alpha_sq);
        self.height(q) * libm::exp(-self.exponent(w, q)) / (2.0 * PI * sigma * sigma * cos_alpha_sq * cos_alpha_sq.sqrt())
    }

    /// The slope tan α that half of the projected facets stay below: Gauss `σ √(2 ln 2)`, Cauchy `√2 σ √(2^(1/(q−1)) − 1)`.
    #[must_use]
    pub fn median_slope(self, sigma: f64, q: f64) -> f64 {
        match self {
            Self::Gauss => sigma * (2.0 * LN_2).sqrt(),
            Self::Cauchy => SQRT_2 * sigma * libm::expm1(LN_2 / (q - 1.0)).sqrt(),
        }
    }
}

/// `w = tan²α / 2σ²`.
pub(crate) fn reduced_slope_sq(tan_alpha_sq: f64, sigma: f64) -> f64 {
    0.5 * (tan_alpha_sq / sigma / sigma)
}

#[cfg(test)]
mod tests {
    use super::{PI, SlopeDistribution};

    /// ∫ P(α) dω over the hemisphere in slope s = tan α: dω = 2π s cos³α ds; by midpoints in s = t/(1 − t).
    fn integral(distribution: SlopeDistribution, sigma: f64, q: f64, upto: f64) -> f64 {
        let steps = 200_000;
        let end = upto / (1.0 + upto);
        (0..steps)
            .map(|i| {
                let t = end * (f64::from(i) + 0.5) / f64::from(steps);
                let s = t / (1.0 - t);
                let cos_alpha_cubed = libm::pow(1.0 + s * s, -1.5);
                let ds = end / f64::from(steps) / ((1.0 - t) * (1.0 - t));
                distribution.facet_density(s * s, sigma, q) * 2.0 * PI * s * cos_alpha_cubed * ds
            })
            .sum()
    }

    /// The midpoint rule with these steps is good to about 1e-9 on these smooth integrands.
    const QUADRATURE: f64 = 1e-7;

    #[test]
    fn facets_cover_the_plane_exactly_once() {
        for (distribution, q) in [(SlopeDistribution::Gauss, 2.0), (SlopeDistribution::Cauchy, 2.0), (SlopeDistribution::Cauchy, 5.0)] {
            let total = integral(distribution, 0.4, q, 1e6);
            assert!((total - 1.0).abs() < QUADRATURE, "{distribution:?} q = {q}: {total}");
        }
    }

    #[test]
    fn half_the_facets_are_flatter_than_the_median_slope() {
        for (distribution, q) in [(SlopeDistribution::Gauss, 2.0), (SlopeDistribution::Cauchy, 1.7), (SlopeDistribution::Cauchy, 6.0)] {
            let half = integral(distribution, 0.3, q, distribution.median_slope(0.3, q));
            assert!((half - 0.5).abs() < QUADRATURE, "{distribution:?} q = {q}: {half}");
        }
    }

    #[test]
    fn sigmas_of_equal_median_have_equal_medians_and_lead_back() {
        // A handful of roundings, as often as the exponential grows.
        for (sigma, q) in [(0.3, 2.0), (0.7, 1.2), (0.05, 9.0)] {
            let gauss = SlopeDistribution::gauss_of_equal_median(sigma, q);
            let medians = [SlopeDistribution::Gauss.median_slope(gauss, q), SlopeDistribution::Cauchy.median_slope(sigma, q)];
            assert!((medians[0] / medians[1] - 1.0).abs() < 8.0 * f64::EPSILON, "{medians:?}");
            assert!((SlopeDistribution::cauchy_of_equal_median(gauss, q) / sigma - 1.0).abs() < 8.0 * f64::EPSILON);
        }
        // GGX and Beckmann: σ_G = σ/√(ln 2).
        assert!((SlopeDistribution::gauss_of_equal_median(1.0, 2.0) * std::f64::consts::LN_2.sqrt() - 1.0).abs() < 8.0 * f64::EPSILON);
    }

    #[test]
    fn cauchy_with_q_of_two_is_ggx() {
        let (sigma, tan_sq) = (0.3, 0.25_f64);
        let alpha_ggx_sq = 2.0 * sigma * sigma;
        let cos_sq = 1.0 / (1.0 + tan_sq);
        let ggx = alpha_ggx_sq / (PI * cos_sq * cos_sq * (alpha_ggx_sq + tan_sq) * (alpha_ggx_sq + tan_sq));
        let ndf = SlopeDistribution::Cauchy.facet_density(tan_sq, sigma, 2.0) / cos_sq.sqrt();
        // A handful of roundings on either side.
        assert!((ndf / ggx - 1.0).abs() < 8.0 * f64::EPSILON);
    }
}
