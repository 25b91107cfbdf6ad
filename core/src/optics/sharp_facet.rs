//! What the exponents of the lobes need of a geometry, to some 30 digits: for lobes so far out in their tails that an f64 no longer holds
//! the digits of e^(−x).

use crate::optics::double::{Double, two_sum};
use crate::optics::{Degrees, Geometry};

/// The exponents' part of a [`crate::optics::Facet`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SharpFacet {
    /// tan²α.
    pub tan_alpha_sq: Double,
    /// ln tan²α, −∞ where α = 0.
    pub ln_tan_alpha_sq: Double,
    /// ln(cos θi cos θr).
    pub ln_cosines: Double,
    /// θr in radians.
    pub theta_r: Double,
}

impl SharpFacet {
    /// By the same forms as [`crate::optics::Facet::new`].
    pub(crate) fn new(geometry: Geometry) -> Self {
        let [Degrees(theta_i), Degrees(theta_r), Degrees(dphi)] = [geometry.theta_i(), geometry.theta_r(), geometry.dphi()];
        let (sin_i, cos_i) = Double::from(theta_i).sin_cos_degrees();
        let (sin_r, cos_r) = Double::from(theta_r).sin_cos_degrees();
        let cos_half = Double::from(0.5 * dphi).sin_cos_degrees().1;
        let (sin_m, cos_m) = (two_sum(theta_i, -theta_r) * 0.5).sin_cos_degrees();
        let complements = two_sum(90.0, -theta_i) + two_sum(90.0, -theta_r);
        let cos_p = (complements * 0.5).sin_cos_degrees().0;
        let (tan_m, tilt) = (sin_m / cos_m, cos_half / (cos_p * cos_m));
        let tan_alpha_sq = tan_m * tan_m + sin_i * sin_r * tilt * tilt;
        Self {
            tan_alpha_sq,
            ln_tan_alpha_sq: if tan_alpha_sq.hi > 0.0 { tan_alpha_sq.ln() } else { Double::from(f64::NEG_INFINITY) },
            ln_cosines: (cos_i * cos_r).ln(),
            theta_r: Double::from(theta_r).radians(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SharpFacet;
    use crate::optics::{Facet, Geometry};

    #[test]
    fn it_says_the_same_as_the_facet() {
        for (theta_i, theta_r, dphi) in [(40.0, 55.5, 180.0), (0.0, 1e-7, 20.0), (89.999_999, 89.9, 359.0), (12.3, 45.6, -78.9)] {
            let geometry = Geometry::new(theta_i, theta_r, dphi).expect("angles in range");
            let (facet, sharp) = (Facet::new(geometry), SharpFacet::new(geometry));
            for (value, sharp) in [
                (facet.tan_alpha_sq, sharp.tan_alpha_sq),
                (libm::log(facet.tan_alpha_sq), sharp.ln_tan_alpha_sq),
                (facet.ln_cosines, sharp.ln_cosines),
                (facet.theta_r, sharp.theta_r),
            ] {
                // A handful of roundings of f64.
                assert!((value - sharp.hi).abs() <= 16.0 * f64::EPSILON * sharp.hi.abs(), "{geometry:?}: {value} {sharp:?}");
                assert!(sharp.lo.abs() <= f64::EPSILON * sharp.hi.abs(), "{geometry:?}: {sharp:?}");
            }
        }
    }
}
