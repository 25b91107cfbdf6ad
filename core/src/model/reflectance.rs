//! Directional-hemispherical reflectance of the terms of a surface, `ρ(θi) = ∫ F00 cos θr dω`.
//!
//! The specular part is a [`FacetMean`]; its estimated error is the difference to half the nodes. The Minnaert term has
//! `2 cos^c θi/(c + 2)` for unit k_d, infinite for c ≤ −2, Hyde's `k_s (1 − ρ_perfect)`, the volume term `2π ∫ F^v sin θr cos θr dθr`.

use crate::model::facet_mean::FacetMean;
use crate::model::terms::Diffuse;
use crate::model::{Pbrdf, lost_by_single_reflection};
use crate::optics::{Degrees, Order};
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
    /// Of θi in degrees, ρ of the specular, diffuse and volume terms, and the error of the first.
    #[must_use]
    pub fn of_terms(theta_i: f64, [specular, diffuse, volume]: [f64; 3], error: f64) -> Self {
        Self { theta_i, specular, diffuse, volume, error }
    }

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
    let [fine, coarse] =
        [Order::Fine, Order::Coarse].map(|order| surface.parameters().ks * FacetMean::new(surface, theta_i, order).reflected);
    (fine, (fine - coarse).abs())
}

/// `2 cos^c θi/(c + 2)`.
pub(crate) fn minnaert(theta_i: Degrees, c: f64) -> f64 {
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
