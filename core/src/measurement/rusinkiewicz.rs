//! Rusinkiewicz's half and difference angles of two rays (Rusinkiewicz, Eurographics Workshop on
//! Rendering, 11 (1998)), in the conventions of Mitsuba 3's plugin `measured_polarized`.
//!
//! For the rays i towards the light and r towards the eye, h ∝ i + r is the half vector and `θ_h`
//! its zenith angle, `θ_d` is the angle between h and i, and `φ_d` the azimuth of i about h from t
//! = b × h, b ∝ n × h: `i = h cos θ_d + (t cos φ_d + b sin φ_d) sin θ_d`.

use crate::optics::{Degrees, Geometry};

/// φ_d, θ_d, θ_h in radians. φ_d is 0 where h is the normal or both rays are one.
#[must_use]
pub fn rusinkiewicz(geometry: Geometry) -> [f64; 3] {
    let (sin_i, cos_i) = geometry.theta_i().sin_cos();
    let (sin_r, cos_r) = geometry.theta_r().sin_cos();
    let (sin_dphi, cos_dphi) = geometry.dphi().sin_cos();
    let (i, r) = ([sin_i, 0.0, cos_i], [sin_r * cos_dphi, sin_r * sin_dphi, cos_r]);
    let h = unit([i[0] + r[0], i[1] + r[1], i[2] + r[2]]);
    let tilt = libm::hypot(h[0], h[1]);
    let (b, t) = if tilt > 0.0 {
        let b = [-h[1] / tilt, h[0] / tilt, 0.0];
        (b, [b[1] * h[2], -b[0] * h[2], b[0] * h[1] - b[1] * h[0]])
    } else {
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (along, across) = (dot(t, i), dot(b, i));
    [libm::atan2(across, along), libm::atan2(libm::hypot(along, across), dot(h, i)), libm::atan2(tilt, h[2])]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = libm::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    v.map(|x| x / length)
}

/// Directions of light and eye from φ_d, θ_d, θ_h in radians. A ray below the horizon is lifted to
/// the zenith angle `highest` in degrees, so that values beyond the horizon continue those of the
/// rim.
pub(crate) fn geometry_of([phi_d, theta_d, theta_h]: [f64; 3], highest: f64) -> Option<Geometry> {
    let degrees = |radians: f64| Degrees(radians.to_degrees());
    let ((sin_p, cos_p), (sin_d, cos_d), (sin_h, cos_h)) =
        (degrees(phi_d).sin_cos(), degrees(theta_d).sin_cos(), degrees(theta_h).sin_cos());
    // h = (sin θ_h, 0, cos θ_h), t = (cos θ_h, 0, −sin θ_h), b = (0, 1, 0).
    let ray = |sign: f64| {
        let (along, across) = (sign * sin_d * cos_p, sign * sin_d * sin_p);
        let (x, z) = (sin_h * cos_d + cos_h * along, cos_h * cos_d - sin_h * along);
        let zenith = libm::atan2(libm::hypot(x, across), z).to_degrees();
        (zenith.min(highest), libm::atan2(across, x).to_degrees())
    };
    let ((theta_i, phi_i), (theta_r, phi_r)) = (ray(1.0), ray(-1.0));
    Geometry::new(theta_i, theta_r, phi_r - phi_i).ok()
}
