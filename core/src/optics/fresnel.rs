//! Fresnel reflection at a facet of complex index N = n + i k_m under the angle β.
//!
//! With `a = √(N² − sin²β) = u + iv`, `u ≥ 0`, and `W = |cos β + a|²`, `E = |N² − 1|²`, `H = |a|² cos²β + sin⁴β`,
//! `Z = |a cos β + sin²β|² = H + 2u cos β sin²β`:
//!
//! - `Rs = E / W²`
//! - `(Rs + Rp)/2 = Rs H / Z`
//! - `DoLP_s = (Rs − Rp)/(Rs + Rp) = 2u sin²β cos β / H`: never negative, no difference taken
//! - `rs rp* = Rs (sin⁴β − |a|² cos²β + 2iv cos β sin²β) / Z`
//!
//! These follow from `rs = (cos β − a)/(cos β + a)` and `rp = rs (sin²β − a cos β)/(sin²β + a cos β)`, the
//! "Verdet" sign: at normal incidence rp = −rs.

use crate::optics::{Facet, RefractiveIndex};

/// Fresnel reflection at one facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fresnel {
    index: RefractiveIndex,
    cos_beta: f64,
    cos_beta_sq: f64,
    sin_beta_sq: f64,
    /// Letters of the module's page.
    u: f64,
    v: f64,
    a_sq: f64,
    e: f64,
    w: f64,
    h: f64,
    z: f64,
}

/// Partial derivatives by n and k_m, in this order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FresnelGradient {
    /// Of (Rs + Rp)/2.
    pub mean: [f64; 2],
    /// Of DoLP_s.
    pub dolp: [f64; 2],
}

impl Fresnel {
    /// Of that index at that facet.
    #[must_use]
    pub fn new(index: RefractiveIndex, facet: &Facet) -> Self {
        Self::under(index, facet.cos_beta, facet.cos_beta_sq, facet.sin_beta_sq)
    }

    /// Under an angle of incidence β, given cos β, its square and sin²β.
    pub(crate) fn under(index: RefractiveIndex, cos_beta: f64, cos_beta_sq: f64, sin_beta_sq: f64) -> Self {
        let (n, k) = (index.n(), index.k_m());
        let x = real_part_of_a_sq(n, k, sin_beta_sq, cos_beta_sq);
        let nk = n * k;
        let a_sq = libm::hypot(x, 2.0 * nk);
        let larger = (0.5 * (a_sq + x.abs())).sqrt();
        let smaller = if larger > 0.0 { nk / larger } else { 0.0 };
        let (u, v) = if x >= 0.0 { (larger, smaller) } else { (smaller, larger) };

        let (minus, plus) = (n - 1.0, n + 1.0);
        let h = a_sq * cos_beta_sq + sin_beta_sq * sin_beta_sq;
        let cos_plus_u = cos_beta + u;
        Self {
            index,
            cos_beta,
            cos_beta_sq,
            sin_beta_sq,
            u,
            v,
            a_sq,
            e: (minus * minus + k * k) * (plus * plus + k * k),
            w: cos_plus_u * cos_plus_u + v * v,
            h,
            z: h + 2.0 * u * cos_beta * sin_beta_sq,
        }
    }

    /// Rs, the reflectance of s-polarised light.
    #[must_use]
    pub fn rs(&self) -> f64 {
        self.e / self.w / self.w
    }

    /// (Rs + Rp)/2, the reflectance of unpolarised light.
    #[must_use]
    pub fn mean(&self) -> f64 {
        // h = 0 only at normal incidence with |N|² below the range of f64, where Rs = Rp.
        if self.h > 0.0 { self.rs() * (self.h / self.z) } else { self.rs() }
    }

    /// DoLP_s = (Rs − Rp)/(Rs + Rp), 0 to 1: the degree of linear polarisation of the specular lobe alone.
    ///
    /// At N = 1 it is the limit for an index near 1 (where it is itself well defined).
    #[must_use]
    pub fn dolp(&self) -> f64 {
        let numerator = 2.0 * self.u * self.sin_beta_sq * self.cos_beta;
        // An ulp or two above 1 near Brewster's angle.
        if numerator > 0.0 { (numerator / self.h).min(1.0) } else { 0.0 }
    }

    /// Real and imaginary part of rs rp*.
    #[must_use]
    pub fn cross(&self) -> (f64, f64) {
        if self.h == 0.0 {
            return (-self.rs(), 0.0);
        }
        let scale = self.rs() / self.z;
        let real = self.sin_beta_sq * self.sin_beta_sq - self.a_sq * self.cos_beta_sq;
        (scale * real, scale * 2.0 * self.v * self.cos_beta * self.sin_beta_sq)
    }

    /// Partial derivatives by n and k_m; at k_m = 0 one-sided.
    ///
    /// At the critical angle of a transparent index below 1 they are infinite.
    #[must_use]
    pub fn gradient(&self) -> FresnelGradient {
        if self.a_sq == 0.0 {
            return FresnelGradient { mean: [f64::NEG_INFINITY; 2], dolp: [f64::INFINITY; 2] };
        }
        let (n, k) = (self.index.n(), self.index.k_m());
        let Self { u, v, a_sq, .. } = *self;
        // ∂a/∂n = N/a and ∂a/∂k = iN/a; the second real part is S v n/((n² + v²)|a|²), S = sin²β, once
        // v² − k² = S v²/(n² + v²) has taken the place of its difference.
        let along = (n * u + k * v) / a_sq;
        let size = libm::hypot(n, v);
        let across = if size > 0.0 { self.sin_beta_sq * (n / size) * (v / size) / a_sq } else { 0.0 };
        let modulus_sq = n * n + k * k;
        let u_slopes = [along, across];
        let a_sq_slopes = [2.0 * n * (modulus_sq - self.sin_beta_sq) / a_sq, 2.0 * k * (modulus_sq + self.sin_beta_sq) / a_sq];
        let e_slopes = [4.0 * n * ((n - 1.0) * (n + 1.0) + k * k), 4.0 * k * (modulus_sq + 1.0)];
        let by = |j: usize| self.slopes(u_slopes[j], a_sq_slopes[j], e_slopes[j]);
        let ((mean_n, dolp_n), (mean_k, dolp_k)) = (by(0), by(1));
        FresnelGradient { mean: [mean_n, mean_k], dolp: [dolp_n, dolp_k] }
    }

    /// Derivatives of (Rs + Rp)/2 and DoLP_s, given those of u, |a|² and E.
    fn slopes(&self, du: f64, da_sq: f64, de: f64) -> (f64, f64) {
        if self.h == 0.0 {
            return (0.0, 0.0);
        }
        let Self { u, w, h, z, .. } = *self;
        let dh = self.cos_beta_sq * da_sq;
        let dw = 2.0 * self.cos_beta * du + da_sq;
        let dz = dh + 2.0 * self.cos_beta * self.sin_beta_sq * du;
        let mean = self.mean();
        let dmean = if mean < 0.5 {
            de / w / w * (h / z) + mean * (dh / h - 2.0 * dw / w - dz / z)
        } else {
            // A strong reflector hardly changes: 1 − (Rs + Rp)/2 = 4u (cos β/W + Rs cos β sin²β/2Z) keeps the digits.
            let rs = self.rs();
            let drs = de / w / w - 2.0 * rs * dw / w;
            let s_part = self.cos_beta / w;
            let p_part = 0.5 * self.cos_beta * self.sin_beta_sq / z;
            let absorbed = s_part + rs * p_part;
            let dabsorbed = -s_part * dw / w + p_part * (drs - rs * dz / z);
            -4.0 * (du * absorbed + u * dabsorbed)
        };
        let ddolp = 2.0 * self.sin_beta_sq * self.cos_beta / h * (du - u * dh / h);
        (dmean, ddolp)
    }
}

/// Re(N² − sin²β), by whichever of two equal sums has the smaller terms.
fn real_part_of_a_sq(n: f64, k: f64, sin_sq: f64, cos_sq: f64) -> f64 {
    let excess = (n - 1.0) * (n + 1.0);
    if excess.abs().max(cos_sq) < (n * n).max(sin_sq) { (excess - k * k) + cos_sq } else { (n - k) * (n + k) - sin_sq }
}
