//! Directional-hemispherical reflectance of the terms of a surface, `ρ(θi) = ∫ F00 cos θr dω`.
//!
//! The specular lobe is integrated over facets instead of directions (dω_r = 4 cos β dω_h), which makes mirror-like lobes as easy as
//! rough ones:
//!
//! `ρ^s = ∫ p(s) ⟨R(β) G u⟩ ds`, `cos β = u cos α cos θi` with the u of [`VGrooves`],
//!
//! by Gauss–Legendre quadrature between all kinks of G u; the estimated error is the difference to half the nodes. The Minnaert term has
//! `2 cos^c θi/(c + 2)` for unit k_d, infinite for c ≤ −2, Hyde's `k_s (1 − ρ_perfect)`, the volume term `2π ∫ F^v sin θr cos θr dθr`.

use crate::model::terms::Diffuse;
use crate::model::{Pbrdf, lost_by_single_reflection};
use crate::optics::{Degrees, Fresnel, Masking, Order, VGrooves, pieces, reduced_slope_sq};
use std::f64::consts::PI;

/// Directional-hemispherical reflectance of each term at one angle of incidence, weights included.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Reflectance {
    /// θi in degrees.
    pub theta_i: f64,
    /// ρ of the specular term.
    pub specular: f64,
    /// ρ of the diffuse term.
    pub diffuse: f64,
    /// ρ of the volume term.
    pub volume: f64,
    /// Estimated error of the specular ρ.
    pub error: f64,
}

impl Reflectance {
    /// ρ of all terms.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.specular + self.diffuse + self.volume
    }
}

impl Reflectance {
    /// Of a surface under an angle of incidence below 90°.
    #[must_use]
    pub fn new(surface: &Pbrdf, theta_i: Degrees) -> Self {
        let (model, p) = (surface.model(), surface.parameters());
        let (specular, error) = if model.specular { specular_reflectance(surface, theta_i) } else { (0.0, 0.0) };
        let diffuse = match model.diffuse {
            Diffuse::Absent => 0.0,
            Diffuse::Lambert => p.kd,
            Diffuse::Minnaert => p.kd * minnaert(theta_i, p.c),
            Diffuse::Hyde if model.specular => p.ks * lost_by_single_reflection(model, p, theta_i),
            Diffuse::Hyde => 0.0,
        };
        let volume = if model.volume { p.kv * volume(p.sigma_v) } else { 0.0 };
        Self { theta_i: theta_i.0, specular, diffuse, volume, error }
    }
}

/// ρ of the specular term and its estimated error.
fn specular_reflectance(surface: &Pbrdf, theta_i: Degrees) -> (f64, f64) {
    let grooves = VGrooves::at(theta_i);
    let [fine, coarse] =
        [Order::Fine, Order::Coarse].map(|order| surface.parameters().ks * mean_over_facets(surface, &grooves, theta_i, order));
    (fine, (fine - coarse).abs())
}

/// ∫ p(s) ⟨R G u⟩ ds for unit k_s.
fn mean_over_facets(surface: &Pbrdf, grooves: &VGrooves, theta_i: Degrees, order: Order) -> f64 {
    let (p, distribution) = (surface.parameters(), surface.model().distribution);
    let end = distribution.faintest(0.0, p.q);
    let mut sum = 0.0;
    let mut low = 0.0;
    for &edge in grooves.edges() {
        let high = libm::log1p(reduced_slope_sq(edge * edge, p.sigma)).min(end);
        for piece in pieces(low, high) {
            for (x, weight) in order.between_roots(piece[0], piece[1]) {
                let w = libm::expm1(x);
                let share = weight * distribution.survival_slope(w, p.q) * libm::exp(-distribution.survival_exponent(w, p.q));
                sum += share * mean_over_azimuths(surface, grooves, p.sigma * (2.0 * w).sqrt(), theta_i.cos(), order.halved());
            }
        }
        low = high;
    }
    sum
}

/// ⟨R G u⟩ over the azimuths of facets of slope s.
fn mean_over_azimuths(surface: &Pbrdf, grooves: &VGrooves, s: f64, cos_i: f64, order: Order) -> f64 {
    let cos_alpha = 1.0 / (1.0 + s * s).sqrt();
    let mut sum = 0.0;
    for [low, high] in grooves.azimuths(s) {
        let middle = VGrooves::kept(s, grooves.u(s, f64::midpoint(low, high)));
        if middle == 0.0 {
            // Below the horizon.
            continue;
        }
        for (phi, weight) in order.between(low, high) {
            let u = grooves.u(s, phi);
            let kept = match surface.model().masking {
                Masking::None => u,
                Masking::VGroove => VGrooves::kept(s, u),
            };
            let cos_beta = (u * cos_alpha * cos_i).clamp(0.0, 1.0);
            let sin_beta_sq = (1.0 - cos_beta) * (1.0 + cos_beta);
            sum += weight * kept * Fresnel::under(surface.index(), cos_beta, cos_beta * cos_beta, sin_beta_sq).mean();
        }
    }
    sum / PI
}
/// `2 cos^c θi/(c + 2)`.
fn minnaert(theta_i: Degrees, c: f64) -> f64 {
    if c > -2.0 { 2.0 * libm::pow(theta_i.cos(), c) / (c + 2.0) } else { f64::INFINITY }
}

/// `2π ∫ F^v sin θr cos θr dθr` for unit k_v, between 0 and the lesser of 90° and ten widths.
fn volume(sigma_v: f64) -> f64 {
    let end = (10.0 * sigma_v).min(0.5 * PI);
    let lobe = |theta: f64| libm::exp(-0.5 * (theta / sigma_v) * (theta / sigma_v)) * libm::sin(2.0 * theta);
    let integral: f64 = Order::Fine.between(0.0, end).map(|(theta, weight)| weight * lobe(theta)).sum();
    // 2π sin cos = π sin 2θ.
    PI * integral / ((2.0 * PI).sqrt() * sigma_v)
}
