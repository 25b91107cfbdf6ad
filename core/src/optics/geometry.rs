//! Directions of incidence and view, and the rotations between their meridian planes and the facet's plane of incidence.

use crate::optics::{Degrees, shortest};
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
    #[error("theta_i = {} is outside 0 ≤ θi < 90 degrees", shortest(*.0))]
    ThetaI(f64),
    /// θr outside its range.
    #[error("theta_r = {} is outside 0 ≤ θr < 90 degrees", shortest(*.0))]
    ThetaR(f64),
    /// Signed θr outside its range.
    #[error("theta_r = {} is outside −90 < θr < 90 degrees", shortest(*.0))]
    SignedThetaR(f64),
    /// Δφ infinite or not a number.
    #[error("dphi = {} is not a finite angle", shortest(*.0))]
    Dphi(f64),
}

impl Geometry {
    /// From θi and θr in [0, 90) degrees and any finite Δφ in degrees.
    ///
    /// # Errors
    ///
    /// [`GeometryError`] of the first angle outside its range.
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
    ///
    /// # Errors
    ///
    /// [`GeometryError`] where an angle lies outside its range.
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
