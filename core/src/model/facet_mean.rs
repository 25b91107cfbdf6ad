//! Integrals of the specular lobe over one of its two directions, the other one held at a zenith angle θ.
//!
//! The lobe is integrated over facets instead of directions (dω = 4 cos β dω_h), which makes mirror-like lobes as easy as rough ones:
//!
//! `∫ F^s cos θ' dω' = ∫ p(s) ⟨R(β) G u⟩ ds`, `cos β = u cos α cos θ` with the u of [`VGrooves`],
//!
//! by Gauss–Legendre quadrature between all kinks of G u. F00 of the lobe is the same with its directions exchanged, so that one integral
//! is both the reflectance of a beam and the radiance under a uniform sky of radiance 1.
//!
//! Of the light from that sky, the facet whose normal is the half vector polarises along its own s. Against s of the meridian plane it is
//! turned by η with `tan η = s sin φ/(s cos φ cos θ + sin θ)`: what is left of S1 there is the mean of `(Rs − Rp)/2 cos 2η`, and S2 cancels.

use crate::model::Pbrdf;
use crate::optics::{Degrees, Fresnel, Masking, Order, VGrooves, pieces, reduced_slope_sq};
use std::f64::consts::PI;

/// Means over the facets that a direction sees, for unit k_s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct FacetMean {
    /// ∫ F00 cos θ' dω'.
    pub(crate) reflected: f64,
    /// ∫ F10 cos θ' dω', of the light that leaves in the direction held: S1 in its meridian basis.
    pub(crate) polarised: f64,
}

/// Facets of one slope as the direction sees them.
struct Facets<'a> {
    surface: &'a Pbrdf,
    grooves: &'a VGrooves,
    slope: f64,
    sin: f64,
    cos: f64,
}

impl FacetMean {
    /// Of the specular lobe of a surface, for a zenith angle below 90°.
    pub(crate) fn new(surface: &Pbrdf, theta: Degrees, order: Order) -> Self {
        let grooves = VGrooves::at(theta);
        let (p, distribution) = (surface.parameters(), surface.model().distribution);
        let (sin, cos) = theta.sin_cos();
        let end = distribution.faintest(0.0, p.q);
        let mut sum = Self::default();
        let mut low = 0.0;
        for &edge in grooves.edges() {
            let high = libm::log1p(reduced_slope_sq(edge * edge, p.sigma)).min(end);
            for piece in pieces(low, high) {
                for (x, weight) in order.between_roots(piece[0], piece[1]) {
                    let w = libm::expm1(x);
                    let share = weight * distribution.survival_slope(w, p.q) * libm::exp(-distribution.survival_exponent(w, p.q));
                    let slope = p.sigma * (2.0 * w).sqrt();
                    sum.add(share, Facets { surface, grooves: &grooves, slope, sin, cos }.mean(order.halved()));
                }
            }
            low = high;
        }
        sum
    }

    fn add(&mut self, weight: f64, other: Self) {
        self.reflected += weight * other.reflected;
        self.polarised += weight * other.polarised;
    }
}

impl Facets<'_> {
    /// The mean over their azimuths.
    fn mean(&self, order: Order) -> FacetMean {
        let Self { surface, grooves, slope: s, sin, cos } = *self;
        let cos_alpha_sq = 1.0 / (1.0 + s * s);
        let mut sum = FacetMean::default();
        for [low, high] in grooves.azimuths(s) {
            let middle = VGrooves::kept(s, grooves.u(s, f64::midpoint(low, high)));
            if middle == 0.0 {
                // Below the horizon.
                continue;
            }
            for (phi, weight) in order.between(low, high) {
                let (sin_phi, cos_phi) = libm::sincos(phi);
                let u = grooves.u_at(s, cos_phi);
                let kept = match surface.model().masking {
                    Masking::None => u,
                    Masking::VGroove => VGrooves::kept(s, u),
                };
                // The facet's normal across the direction held: in its meridian plane, and beside it, over cos α.
                let (along, beside) = (s * cos_phi * cos + sin, s * sin_phi);
                let across_sq = along * along + beside * beside;
                let cos_beta = (u * cos_alpha_sq.sqrt() * cos).clamp(0.0, 1.0);
                let fresnel = Fresnel::under(surface.index(), cos_beta, cos_beta * cos_beta, (cos_alpha_sq * across_sq).min(1.0));
                let reflected = weight * kept * fresnel.mean();
                let cos_2eta = if across_sq > 0.0 { (along - beside) * (along + beside) / across_sq } else { 0.0 };
                sum.reflected += reflected;
                sum.polarised += reflected * fresnel.dolp() * cos_2eta;
            }
        }
        FacetMean { reflected: sum.reflected / PI, polarised: sum.polarised / PI }
    }
}
