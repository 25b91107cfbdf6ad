//! The microfacet that mirrors the direction of incidence into that of view.
//!
//! Eq. (2): `cos 2β = cos θi cos θr + sin θi sin θr cos Δφ`, `cos α = (cos θi + cos θr) / (2 cos β)`.
//! In this form both lose every digit near normal incidence and at grazing angles. With m = (θi − θr)/2 and
//! p = (θi + θr)/2 nothing cancels:
//!
//! - `cos²β = cos²p + sin θi sin θr cos²(Δφ/2)`
//! - `sin²β = sin²m + sin θi sin θr sin²(Δφ/2)`
//! - `tan²α = tan²m + sin θi sin θr cos²(Δφ/2) / (cos p cos m)²`

use crate::optics::{Degrees, Geometry};

/// The microfacet that mirrors one direction into the other, prepared once for many evaluations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// cos β, β the angle of incidence on the facet.
    pub cos_beta: f64,
    /// cos²β.
    pub cos_beta_sq: f64,
    /// sin²β.
    pub sin_beta_sq: f64,
    /// tan²α, α the tilt of the facet.
    pub tan_alpha_sq: f64,
    /// G/(cos θi cos θr) with the V-groove G of Eq. (6), in sr⁻¹: finite at grazing angles.
    pub g_over_cosines: f64,
    /// 1/(cos θi cos θr): the same without masking–shadowing, G = 1.
    pub one_over_cosines: f64,
    /// ln(cos θi cos θr) ≤ 0.
    pub ln_cosines: f64,
    /// θi in degrees.
    pub theta_i: Degrees,
    /// θr in radians.
    pub theta_r: f64,
    /// The directions themselves.
    pub geometry: Geometry,
}

impl Facet {
    /// Prepares a geometry.
    #[must_use]
    pub fn new(geometry: Geometry) -> Self {
        let (theta_i, theta_r, dphi) = (geometry.theta_i(), geometry.theta_r(), geometry.dphi());
        let (sin_i, cos_i) = theta_i.sin_cos();
        let (sin_r, cos_r) = theta_r.sin_cos();
        let (sin_half, cos_half) = Degrees(0.5 * dphi.0).sin_cos();
        let (sin_m, cos_m) = Degrees(0.5 * (theta_i.0 - theta_r.0)).sin_cos();
        let cos_p = Degrees(0.5 * (theta_i.complement().0 + theta_r.complement().0)).sin();

        let sines = sin_i * sin_r;
        let cos_beta_sq = cos_p * cos_p + sines * cos_half * cos_half;
        let sin_beta_sq = sin_m * sin_m + sines * sin_half * sin_half;
        let mean_cosine = cos_p * cos_m;
        let tan_m = sin_m / cos_m;
        let tilt = cos_half / mean_cosine;
        let one_over_cosines = 1.0 / (cos_i * cos_r);
        Self {
            cos_beta: cos_beta_sq.sqrt(),
            cos_beta_sq,
            sin_beta_sq,
            tan_alpha_sq: tan_m * tan_m + sines * tilt * tilt,
            g_over_cosines: one_over_cosines.min(2.0 * mean_cosine / (cos_beta_sq * cos_i.max(cos_r))),
            one_over_cosines,
            ln_cosines: ln_cos(sin_i, cos_i) + ln_cos(sin_r, cos_r),
            theta_i,
            theta_r: theta_r.radians(),
            geometry,
        }
    }
}

/// ln cos θ from both sine and cosine, so that it keeps its digits where cos θ is near 1.
fn ln_cos(sin: f64, cos: f64) -> f64 {
    if sin < cos { 0.5 * libm::log1p(-sin * sin) } else { libm::log(cos) }
}
