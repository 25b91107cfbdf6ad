//! V-grooves seen from one angle of incidence: which share of the light that a facet catches leaves them after one reflection.
//!
//! Facets by their slopes (x, y) = s (cos φ, sin φ), φ = 0 tilted away from the light. With `t = tan θi`, `u = 1 − s t cos φ` (= cos β/(cos α cos θi), the area a
//! facet shows to the light over that of its base) and `c² = cos²α = 1/(1 + s²)` the masking–shadowing of Eq. (6) becomes
//!
//! `G u = min(u, 2, 4c²u − 2)`, and 0 below the horizon, where it is negative.
//!
//! In u these are straight lines, so that the mean over φ, in which u has the mean 1, is elementary: with the mean excess
//! `E(b) = ⟨max(b − u, 0)⟩` what is lost at slope s is
//!
//! - `1 − ⟨G u⟩ = (4c² − 1) E(2/(4c² − 1)) − 4c² E(1/2c²) + E(0)` for s < 1: no difference of large numbers at gentle slopes,
//! - `1 − ⟨G u⟩ = 1 − 4c² (E(2 − 1/2c²) − E(2 − 1/c²))` for s ≥ 1.
//!
//! Nothing is lost at slopes below tan(30° − θi/3), all above tan(45° + θi/2). Between them roots begin and end at tilts of 45° − θi/2, θi, 90° − θi,
//! 30° + θi/3 and, from θi = 45° on, 45°.

use crate::optics::Degrees;
use std::f64::consts::{FRAC_1_PI, PI};

/// Neighbouring edges are at most this factor apart.
const WIDEST: f64 = 6.0;

/// V-grooves at one angle of incidence.
#[derive(Debug, Clone)]
pub(crate) struct VGrooves {
    tan_theta: f64,
    edges: Vec<f64>,
}

impl VGrooves {
    /// Seen under an angle of incidence below 90°.
    pub(crate) fn at(theta_i: Degrees) -> Self {
        let tan = |tilt: Degrees| {
            let (sin, cos) = tilt.sin_cos();
            sin / cos
        };
        let complement = theta_i.complement().0;
        let (first, last) = (tan(Degrees(complement / 3.0)), 1.0 / tan(Degrees(complement / 2.0)));
        let tilts = [complement / 2.0, theta_i.0, complement, 30.0 + theta_i.0 / 3.0, 45.0];
        let mut kinks: Vec<f64> = tilts.map(|tilt| tan(Degrees(tilt))).into_iter().filter(|&s| s > first && s < last).collect();
        kinks.push(last);
        kinks.sort_by(f64::total_cmp);
        let mut edges = vec![first];
        for kink in kinks {
            let mut from = edges[edges.len() - 1];
            while kink > WIDEST * from {
                from *= WIDEST;
                edges.push(from);
            }
            // Two tilts that coincide are one.
            if kink > from * (1.0 + 1e-12) {
                edges.push(kink);
            }
        }
        Self { tan_theta: tan(theta_i), edges }
    }

    /// Slopes at which something begins or ends, ascending: nothing is lost below the first, all above the last.
    pub(crate) fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// u of a facet of slope s and azimuth φ.
    pub(crate) fn u(&self, s: f64, phi: f64) -> f64 {
        self.u_at(s, libm::cos(phi))
    }

    /// The same from cos φ.
    pub(crate) fn u_at(&self, s: f64, cos_phi: f64) -> f64 {
        1.0 - s * self.tan_theta * cos_phi
    }

    /// G u of a facet of slope s: 0 below the horizon.
    pub(crate) fn kept(s: f64, u: f64) -> f64 {
        u.min(2.0).min(4.0 * u / (1.0 + s * s) - 2.0).max(0.0)
    }

    /// The azimuths between 0 and π, cut where `G u` has kinks and where the horizon is.
    pub(crate) fn azimuths(&self, s: f64) -> Vec<[f64; 2]> {
        let swing = s * self.tan_theta;
        let horizon = 0.5 * (1.0 + s * s);
        let kinks = if s < 1.0 { [horizon, 2.0 * (1.0 + s * s) / (3.0 - s * s), 2.0] } else { [horizon, 1.0 + s * s, 1.0 + s * s] };
        let mut cuts = vec![0.0];
        for above in kinks.map(|u| u - 1.0 + swing) {
            if above > 0.0 && above < 2.0 * swing {
                cuts.push(2.0 * libm::asin((0.5 * above / swing).sqrt()));
            }
        }
        cuts.push(PI);
        cuts.windows(2).filter(|ends| ends[1] > ends[0]).map(|ends| [ends[0], ends[1]]).collect()
    }

    /// What facets of slope s, averaged over their azimuths, lose of the light that they catch.
    pub(crate) fn lost(&self, s: f64) -> f64 {
        let c_sq = 1.0 / (1.0 + s * s);
        let swing = s * self.tan_theta;
        if !swing.is_finite() {
            // Steeper than f64 holds, far above the last edge.
            return 1.0;
        }
        let excess = |bound: f64| mean_excess(bound, swing);
        if s < 1.0 {
            let slope = 4.0 * c_sq - 1.0;
            slope * excess(2.0 / slope) - 4.0 * c_sq * excess(0.5 / c_sq) + excess(0.0)
        } else {
            1.0 - 4.0 * c_sq * (excess(2.0 - 0.5 / c_sq) - excess(2.0 - 1.0 / c_sq))
        }
    }
}

/// `⟨max(b − u, 0)⟩` over φ for `u = 1 − swing cos φ`: `(swing/π)(sin φ − φ cos φ)` at the φ where u = b.
fn mean_excess(bound: f64, swing: f64) -> f64 {
    let above = bound - 1.0 + swing;
    if above <= 0.0 {
        0.0
    } else if above >= 2.0 * swing {
        bound - 1.0
    } else {
        // 1 − cos φ = above/swing.
        let phi = 2.0 * libm::asin((0.5 * above / swing).sqrt());
        swing * FRAC_1_PI * sin_less_phi_cos(phi)
    }
}

/// sin φ − φ cos φ for 0 ≤ φ ≤ π, as `φ³/3 (1 − φ²/10 (1 − φ²/28 (1 − φ²/54 (1 − φ²/88))))` where it is small.
fn sin_less_phi_cos(phi: f64) -> f64 {
    debug_assert!((0.0..=PI).contains(&phi));
    if phi > 0.3 {
        return libm::sin(phi) - phi * libm::cos(phi);
    }
    let square = phi * phi;
    let series = [88.0, 54.0, 28.0, 10.0].into_iter().fold(1.0, |rest, divisor| 1.0 - square / divisor * rest);
    phi * square / 3.0 * series
}

#[cfg(test)]
mod tests {
    use super::{Degrees, PI, VGrooves};

    #[test]
    fn what_is_lost_agrees_with_the_masking_of_equation_six() {
        for theta in [0.0, 20.0, 45.0, 60.0, 85.0] {
            let grooves = VGrooves::at(Degrees(theta));
            let t = Degrees(theta).sin() / Degrees(theta).cos();
            for s in [0.05, 0.3, 0.7, 0.99, 1.0, 1.4, 2.5, 30.0] {
                let steps = 20_000;
                let kept: f64 = (0..steps)
                    .map(|i| {
                        let u = 1.0 - s * t * libm::cos(PI * (f64::from(i) + 0.5) / f64::from(steps));
                        u.min(2.0).min(4.0 * u / (1.0 + s * s) - 2.0).max(0.0) / f64::from(steps)
                    })
                    .sum();
                // Kinks cost the midpoint rule of so many steps some (s t)/steps².
                assert!((grooves.lost(s) - (1.0 - kept)).abs() < 1e-6, "θi = {theta}°, s = {s}: {} {}", grooves.lost(s), 1.0 - kept);
            }
        }
    }

    #[test]
    fn nothing_is_lost_below_the_first_edge_and_all_above_the_last() {
        for theta in [0.0, 30.0, 45.0, 70.0, 89.0] {
            let grooves = VGrooves::at(Degrees(theta));
            let edges = grooves.edges();
            let (first, last) = (edges[0], edges[edges.len() - 1]);
            assert_eq!(grooves.lost(0.999 * first), 0.0, "{theta}");
            assert!(grooves.lost(1.01 * first) > 0.0, "{theta}");
            // Excesses of the size of s t = tan 85° tan 87.5° and less leave rounding only.
            assert!((grooves.lost(1.001 * last) - 1.0).abs() < 1e-10 && grooves.lost(0.99 * last) < 1.0, "{theta}");
        }
    }
}
