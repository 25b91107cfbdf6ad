//! Directions of incidence and view, and the microfacet that mirrors one into the other.
//!
//! Eq. (2): `cos 2β = cos θi cos θr + sin θi sin θr cos Δφ`, `cos α = (cos θi + cos θr) / (2 cos β)`.
//! In this form both lose every digit near normal incidence and at grazing angles. With m = (θi − θr)/2 and
//! p = (θi + θr)/2 nothing cancels:
//!
//! - `cos²β = cos²p + sin θi sin θr cos²(Δφ/2)`
//! - `sin²β = sin²m + sin θi sin θr sin²(Δφ/2)`
//! - `tan²α = tan²m + sin θi sin θr cos²(Δφ/2) / (cos p cos m)²`

use crate::optics::Degrees;
use serde::{Deserialize, Serialize};

/// One pair of directions: zenith angles of incidence θi and of view θr, relative azimuth Δφ = φr − φi.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    theta_i: Degrees,
    theta_r: Degrees,
    dphi: Degrees,
}

/// Why three angles are no geometry.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// θi outside its range.
    #[error("theta_i = {0} is outside 0 ≤ θi < 90 degrees")]
    ThetaI(f64),
    /// θr outside its range.
    #[error("theta_r = {0} is outside 0 ≤ θr < 90 degrees")]
    ThetaR(f64),
    /// Signed θr outside its range.
    #[error("theta_r = {0} is outside −90 < θr < 90 degrees")]
    SignedThetaR(f64),
    /// Δφ infinite or not a number.
    #[error("dphi = {0} is not a finite angle")]
    Dphi(f64),
}

impl Geometry {
    /// From θi and θr in [0, 90) degrees and any finite Δφ in degrees.
    pub fn new(theta_i: f64, theta_r: f64, dphi: f64) -> Result<Self, GeometryError> {
        if !(0.0..90.0).contains(&theta_i) {
            Err(GeometryError::ThetaI(theta_i))
        } else if !(0.0..90.0).contains(&theta_r) {
            Err(GeometryError::ThetaR(theta_r))
        } else if !dphi.is_finite() {
            Err(GeometryError::Dphi(dphi))
        } else {
            Ok(Self { theta_i: Degrees(theta_i), theta_r: Degrees(theta_r), dphi: Degrees(dphi) })
        }
    }

    /// In the plane of incidence, with θr in (−90, 90) degrees: negative is the backscatter side (Δφ = 0).
    pub fn in_plane(theta_i: f64, signed_theta_r: f64) -> Result<Self, GeometryError> {
        if signed_theta_r.abs() >= 90.0 || signed_theta_r.is_nan() {
            return Err(GeometryError::SignedThetaR(signed_theta_r));
        }
        let dphi = if signed_theta_r < 0.0 { 0.0 } else { 180.0 };
        Self::new(theta_i, signed_theta_r.abs(), dphi)
    }

    /// Zenith angle of incidence, 0 ≤ θi < 90°.
    #[must_use]
    pub fn theta_i(self) -> Degrees {
        self.theta_i
    }

    /// Zenith angle of view, 0 ≤ θr < 90°.
    #[must_use]
    pub fn theta_r(self) -> Degrees {
        self.theta_r
    }

    /// Relative azimuth φr − φi; 180° is the forward side.
    #[must_use]
    pub fn dphi(self) -> Degrees {
        self.dphi
    }

    /// θr for a plot: negative on the backscatter half of the hemisphere (cos Δφ > 0).
    #[must_use]
    pub fn signed_theta_r(self) -> Degrees {
        if self.dphi.cos() > 0.0 { Degrees(-self.theta_r.0) } else { self.theta_r }
    }

    /// Rotation from the meridian plane of the incident ray into the facet's plane of incidence (η_i).
    ///
    /// Eq. (9) gives the cosine alone and is 0/0 at θi = 0 and at β = 0. Sine and cosine follow from the
    /// vectors: with s = k × n in either plane, `(cos η_i, sin η_i) ∝ (sin(θi − θr) + 2 cos θi sin θr sin²(Δφ/2), sin θr sin Δφ)`.
    #[must_use]
    pub fn rotation_in(self) -> Rotation {
        let (sin_i, cos_i) = self.theta_i.sin_cos();
        let (sin_r, cos_r) = self.theta_r.sin_cos();
        self.rotation(sin_i, cos_i, sin_r, cos_r, (1.0, 0.0))
    }

    /// Rotation from the meridian plane of the reflected ray into the facet's plane of incidence (η_r):
    /// `(cos η_r, sin η_r) ∝ (cos θi sin θr − sin θi cos θr cos Δφ, sin θi sin Δφ)`.
    #[must_use]
    pub fn rotation_out(self) -> Rotation {
        let (sin_i, cos_i) = self.theta_i.sin_cos();
        let (sin_r, cos_r) = self.theta_r.sin_cos();
        // At β = 0 the facet has no plane of its own: that of the incident meridian serves.
        let (sin_dphi, cos_dphi) = self.dphi.sin_cos();
        self.rotation(sin_r, cos_r, sin_i, cos_i, (-cos_dphi, sin_dphi))
    }

    /// The common form: `a` is the ray whose meridian plane is left, `b` the other one.
    fn rotation(self, sin_a: f64, cos_a: f64, sin_b: f64, cos_b: f64, at_normal: (f64, f64)) -> Rotation {
        let (sin_dphi, cos_dphi) = self.dphi.sin_cos();
        let cos = if cos_dphi > 0.0 {
            let half = Degrees(0.5 * self.dphi.0).sin();
            (sin_a * cos_b - cos_a * sin_b) + 2.0 * cos_a * sin_b * half * half
        } else {
            sin_a * cos_b - cos_a * sin_b * cos_dphi
        };
        Rotation::from_direction((cos, sin_b * sin_dphi), at_normal)
    }
}

/// A rotation of the polarisation basis, by its cosine and sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    cos: f64,
    sin: f64,
}

impl Rotation {
    /// By the direction of a vector of any length, or by `otherwise` where it has none.
    fn from_direction((x, y): (f64, f64), otherwise: (f64, f64)) -> Self {
        let length = libm::hypot(x, y);
        let (cos, sin) = if length > 0.0 { (x / length, y / length) } else { otherwise };
        Self { cos, sin }
    }

    /// The opposite rotation.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self { cos: self.cos, sin: -self.sin }
    }

    /// Cosine and sine of twice the angle, as Stokes vectors turn.
    #[must_use]
    pub fn double_angle(self) -> (f64, f64) {
        ((self.cos - self.sin) * (self.cos + self.sin), 2.0 * self.sin * self.cos)
    }
}

/// What the model needs of a geometry, prepared once: the facet that mirrors one ray into the other.
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
    /// θi.
    pub theta_i: Degrees,
    /// θr in radians.
    pub theta_r: f64,
    /// The directions themselves, for what needs more digits than f64 has.
    pub geometry: Geometry,
}

impl Facet {
    /// Prepares a geometry.
    #[must_use]
    pub fn new(geometry: Geometry) -> Self {
        let Geometry { theta_i, theta_r, dphi } = geometry;
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
