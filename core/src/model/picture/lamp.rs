//! A distant lamp, and the geometry under which a point with a given normal shows its light to the camera.

use crate::optics::{Degrees, Facet, Geometry, shortest};
use std::f64::consts::PI;

/// Direction of a distant, unpolarised lamp whose irradiance across its beam is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    polar: Degrees,
    azimuth: Degrees,
    direction: [f64; 3],
}

/// Why two angles are no direction.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LampError {
    /// Angle from z outside its range.
    #[error("the angle of the lamp from z, {}, is outside 0 to 180 degrees", shortest(*.0))]
    Polar(f64),
    /// Angle from x infinite or not a number.
    #[error("the azimuth of the lamp, {0}, is not a finite angle")]
    Azimuth(f64),
}

impl Lamp {
    /// From the angle from z, which points to the camera, and the angle from x towards y, in degrees.
    ///
    /// # Errors
    ///
    /// [`LampError`] where the first is outside 0 to 180 degrees or the second is not finite.
    pub fn new(polar: f64, azimuth: f64) -> Result<Self, LampError> {
        if !(0.0..=180.0).contains(&polar) {
            return Err(LampError::Polar(polar));
        }
        if !azimuth.is_finite() {
            return Err(LampError::Azimuth(azimuth));
        }
        let (polar, azimuth) = (Degrees(polar), Degrees(azimuth));
        Ok(Self { polar, azimuth, direction: vector(polar, azimuth) })
    }

    /// Angle from z: twice the angle of incidence on the facets that mirror it to the camera.
    #[must_use]
    pub fn polar(&self) -> Degrees {
        self.polar
    }

    /// Angle from x towards y.
    #[must_use]
    pub fn azimuth(&self) -> Degrees {
        self.azimuth
    }

    /// Cosine of the angle of incidence on a surface of that unit normal; negative in its own shadow.
    #[must_use]
    pub fn cos_incidence(&self, normal: [f64; 3]) -> f64 {
        dot(normal, self.direction)
    }

    /// The unit vector halfway to the camera: the normal of the facets that mirror the lamp, the same in every pixel.
    pub(crate) fn half_vector(&self) -> [f64; 3] {
        vector(Degrees(0.5 * self.polar.0), self.azimuth)
    }

    /// Where a surface of that unit normal, seen along z, has lamp and camera; none in its own shadow. Where the normal is z itself,
    /// Δφ is as if it were turned a little towards x.
    #[must_use]
    pub fn geometry(&self, normal: [f64; 3]) -> Option<Geometry> {
        let cos_i = self.cos_incidence(normal);
        if cos_i <= 0.0 {
            return None;
        }
        let ([nx, ny, nz], [lx, ly, _]) = (normal, self.direction);
        let sin_r = libm::hypot(nx, ny);
        let (tx, ty) = if sin_r > 0.0 { (nx / sin_r, ny / sin_r) } else { (1.0, 0.0) };
        let across = cross(normal, self.direction);
        // N·(L × V) and (N × L)·(N × V), both over sin θr: sine and cosine of Δφ times sin θi.
        let (sine, cosine) = (tx * ly - ty * lx, across[0] * ty - across[1] * tx);
        let theta_i = degrees(libm::atan2(length(across), cos_i));
        Geometry::new(theta_i, theta_r([nx, ny, nz]), degrees(libm::atan2(sine, cosine))).ok()
    }

    /// The way back from [`Self::geometry`]: the lamp at that azimuth, in degrees, under which a surface shows a geometry to the camera, and the
    /// surface's normal. None where lamp and camera coincide.
    #[must_use]
    pub fn facing(geometry: Geometry, azimuth: f64) -> Option<(Self, [f64; 3])> {
        let facet = Facet::new(geometry);
        let polar = degrees(2.0 * libm::atan2(facet.sin_beta_sq.sqrt(), facet.cos_beta));
        let lamp = Self::new(polar, azimuth).ok()?;
        let ((sin_i, cos_i), (sin_r, cos_r)) = (geometry.theta_i().sin_cos(), geometry.theta_r().sin_cos());
        let (sin_p, cos_p) = lamp.polar.sin_cos();
        if sin_p <= 0.0 {
            return None;
        }
        // Components towards the lamp's azimuth and to the left of it.
        let (towards, aside) = ((cos_i - cos_p * cos_r) / sin_p, -sin_i * sin_r * geometry.dphi().sin() / sin_p);
        let (sin_a, cos_a) = lamp.azimuth.sin_cos();
        Some((lamp, [towards * cos_a - aside * sin_a, towards * sin_a + aside * cos_a, cos_r]))
    }

    /// Angle of polarisation of what facets mirror, from x towards y: across the plane of lamp and camera. Cosine and sine of twice the
    /// angle.
    pub(crate) fn polarisation(&self) -> (f64, f64) {
        let (sin, cos) = Degrees(2.0 * self.azimuth.0).sin_cos();
        (-cos, -sin)
    }
}

/// Zenith angle of the camera over a surface of that unit normal, in degrees.
pub(crate) fn theta_r([nx, ny, nz]: [f64; 3]) -> f64 {
    degrees(libm::atan2(libm::hypot(nx, ny), nz))
}

fn vector(polar: Degrees, azimuth: Degrees) -> [f64; 3] {
    let ((sin, cos), (sin_a, cos_a)) = (polar.sin_cos(), azimuth.sin_cos());
    [sin * cos_a, sin * sin_a, cos]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn degrees(radians: f64) -> f64 {
    radians * (180.0 / PI)
}
