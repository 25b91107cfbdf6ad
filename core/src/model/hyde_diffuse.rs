//! What one reflection at the facets loses: Hyde's depolarised term carries it.
//!
//! The directional-hemispherical reflectance ρ of the specular lobe of a perfect reflector (Rs = Rp = 1) in V-grooves falls short of 1 by the light
//! that the grooves shadow, mask or send below the horizon. Per facet slope that share is elementary ([`VGrooves`]); the integral over slopes,
//!
//! `1 − ρ(θi) = ∫ lost(s) p(w) dw + e^(−y(w_last))`, `w = s²/2σ²`, p(w) = −d e^(−y)/dw,
//!
//! is left to Gauss–Legendre quadrature in ln(1 + w), piece by piece between the slopes where `lost` has kinks. Relative error of 1 − ρ (not of ρ): below
//! 1e-11 for σ ≥ 0.01 and θi ≤ 85°, below 1e-8 for σ ≥ 0.001 and θi ≤ 89.9°. Where e^(−y) alone underflows, the exponent is kept apart.

use crate::model::Parameters;
use crate::model::lobes::Lobe;
use crate::model::terms::Model;
use crate::optics::{Degrees, Order, SlopeDistribution, VGrooves, reduced_slope_sq};
use std::cell::RefCell;
use std::f64::consts::{FRAC_1_PI, PI};

/// (1 − ρ)/π, and its logarithmic derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SingleScatteringLoss {
    /// The Lambertian lobe that carries what is lost, in sr⁻¹.
    pub(crate) lobe: Lobe,
    /// ∂ln(1 − ρ)/∂σ.
    pub(crate) by_sigma: f64,
    /// ∂ln(1 − ρ)/∂q; 0 for Gauss.
    pub(crate) by_q: f64,
}

/// What a loss depends on: the distribution, and θi, σ, q by their bits.
type Key = (SlopeDistribution, [u64; 3]);

/// Losses that a thread remembers. A data set has few angles of incidence, and all of its rows and all parameters but σ and q leave the loss as it is.
const REMEMBERED: usize = 256;

thread_local! {
    static MEMORY: RefCell<Vec<Option<(Key, SingleScatteringLoss)>>> = const { RefCell::new(Vec::new()) };
}

impl SingleScatteringLoss {
    /// At an angle of incidence, for slope σ > 0 and, of Cauchy, tail exponent q > 1: the quadrature is made once per (θi, σ, q) and remembered.
    pub(crate) fn at(distribution: SlopeDistribution, theta_i: Degrees, sigma: f64, q: f64) -> Self {
        let q = if distribution == SlopeDistribution::Gauss { 0.0 } else { q };
        let key = (distribution, [theta_i.0, sigma, q].map(f64::to_bits));
        let slot = slot(key.1);
        let remembered = MEMORY.with_borrow(|memory| memory.get(slot).copied().flatten()).filter(|(other, _)| *other == key);
        if let Some((_, loss)) = remembered {
            return loss;
        }
        let loss = Self::by_quadrature(distribution, theta_i, sigma, q, Order::Fine);
        MEMORY.with_borrow_mut(|memory| {
            memory.resize(REMEMBERED, None);
            memory[slot] = Some((key, loss));
        });
        loss
    }

    /// The quadrature itself.
    fn by_quadrature(distribution: SlopeDistribution, theta_i: Degrees, sigma: f64, q: f64, order: Order) -> Self {
        let grooves = VGrooves::at(theta_i);
        let w_of = |s: f64| reduced_slope_sq(s * s, sigma);
        let edges = grooves.edges();
        let (first, last) = (w_of(edges[0]), w_of(edges[edges.len() - 1]));
        let exponent = distribution.survival_exponent(first, q);
        let darkness = |w: f64| libm::exp(exponent - distribution.survival_exponent(w, q));
        // Facets steeper than the last edge lose all.
        let (per_sigma, per_q) = survival_slopes(distribution, last, sigma, q);
        let tail = darkness(last);
        let mut sums = [tail, tail * per_sigma, tail * per_q];
        let end = distribution.faintest(first, q);
        for piece in edges.windows(2) {
            let (low, high) = (libm::log1p(w_of(piece[0])), libm::log1p(w_of(piece[1])).min(end));
            if high <= low {
                break;
            }
            for (x, weight) in order.between_roots(low, high) {
                let w = libm::expm1(x);
                let part = weight * distribution.survival_slope(w, q) * darkness(w) * grooves.lost(sigma * (2.0 * w).sqrt());
                sums[0] += part;
                sums[1] += part * distribution.sigma_log_slope(w, q) / sigma;
                sums[2] += part * distribution.q_slope(x, q) / distribution.height(q);
            }
        }
        let [whole, by_sigma, by_q] = sums;
        if whole > 0.0 {
            Self { lobe: Lobe { factor: FRAC_1_PI * whole, exponent }, by_sigma: by_sigma / whole, by_q: by_q / whole }
        } else {
            Self { lobe: Lobe::ZERO, by_sigma: 0.0, by_q: 0.0 }
        }
    }
}

/// 1 − ρ(θi), what single reflection by a perfect reflector loses in V-grooves of a model's facets: 0 to 1.
pub(crate) fn lost_by_single_reflection(model: Model, parameters: &Parameters, theta_i: Degrees) -> f64 {
    PI * SingleScatteringLoss::at(model.distribution, theta_i, parameters.sigma, parameters.q).lobe.value()
}

/// Where a loss is remembered: any mixture of the bits that tells neighbouring angles apart (Fibonacci hashing).
fn slot([theta_i, sigma, q]: [u64; 3]) -> usize {
    let mixed = (theta_i ^ sigma.rotate_left(21) ^ q.rotate_left(42)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> 32) as usize % REMEMBERED
}

/// Derivatives of the logarithm of the share of steeper facets by σ and q.
fn survival_slopes(distribution: SlopeDistribution, w: f64, sigma: f64, q: f64) -> (f64, f64) {
    match distribution {
        SlopeDistribution::Gauss => (2.0 * w / sigma, 0.0),
        SlopeDistribution::Cauchy => (2.0 * (q - 1.0) * (w / (1.0 + w)) / sigma, -libm::log1p(w)),
    }
}

#[cfg(test)]
mod tests {
    use super::{Degrees, Lobe, Order, PI, SingleScatteringLoss};
    use crate::model::lobes;
    use crate::optics::SlopeDistribution;
    use crate::optics::SlopeDistribution::{Cauchy, Gauss};
    use crate::optics::{Facet, Geometry, reduced_slope_sq};

    fn rho(distribution: SlopeDistribution, theta_i: f64, sigma: f64, q: f64) -> f64 {
        1.0 - PI * SingleScatteringLoss::at(distribution, Degrees(theta_i), sigma, q).lobe.value()
    }

    #[test]
    fn the_reflectance_is_that_of_the_reference() {
        // Half a unit in the last of the four decimals that are given, and a little.
        let tolerance = 5.1e-5;
        for (sigma, expected) in
            [(0.1, [1.0, 0.9994, 0.9431, 0.9484]), (0.3, [0.9496, 0.9012, 0.9329, 0.9758]), (0.7, [0.4599, 0.6452, 0.9072, 0.9698])]
        {
            for (theta_i, expected) in [0.0, 45.0, 75.0, 85.0].into_iter().zip(expected) {
                let found = rho(Gauss, theta_i, sigma, 0.0);
                assert!((found - expected).abs() < tolerance, "σ = {sigma}, θi = {theta_i}°: {found}");
            }
        }
    }

    /// ∫ F^s cos θr dω over the directions of view, by midpoints: no slopes, no edges, the lobe itself.
    fn by_directions(distribution: SlopeDistribution, theta_i: f64, sigma: f64, q: f64) -> f64 {
        let (zeniths, azimuths) = (1200, 600);
        let mut sum = 0.0;
        for i in 0..zeniths {
            let theta_r = 90.0 * (f64::from(i) + 0.5) / f64::from(zeniths);
            let (sin, cos) = Degrees(theta_r).sin_cos();
            for j in 0..azimuths {
                let dphi = 180.0 * (f64::from(j) + 0.5) / f64::from(azimuths);
                let facet = Facet::new(Geometry::new(theta_i, theta_r, dphi).expect("a valid geometry"));
                let w = reduced_slope_sq(facet.tan_alpha_sq, sigma);
                sum += lobes::specular(distribution, w, &facet, facet.g_over_cosines, sigma, q).value() * sin * cos;
            }
        }
        // Both halves of the plane: 2 Δθ Δφ.
        sum * (PI / 2.0 / f64::from(zeniths)) * (2.0 * PI / f64::from(azimuths))
    }

    #[test]
    fn the_reflectance_is_the_integral_of_the_lobe() {
        for (distribution, q) in [(Gauss, 0.0), (Cauchy, 1.5), (Cauchy, 4.0)] {
            for (theta_i, sigma) in [(0.0, 0.3), (30.0, 0.7), (60.0, 0.2), (75.0, 0.5)] {
                let (found, expected) = (rho(distribution, theta_i, sigma, q), by_directions(distribution, theta_i, sigma, q));
                // The kinks of G cost the midpoint rule of this mesh up to 1e-5.
                assert!((found - expected).abs() < 1e-5, "{distribution:?}, q = {q}, θi = {theta_i}°, σ = {sigma}: {found} {expected}");
            }
        }
    }

    #[test]
    fn what_is_lost_holds_eleven_digits_against_mpmath() {
        // assets/reference/make_single_reflection.py; relative errors as the module states them.
        for (theta_i, sigma, expected, tolerance) in [
            (0.0, 0.1, 2.525_301_118_852_39e-9, 1e-11),
            (45.0, 0.3, 0.098_796_996_384_785_7, 1e-11),
            (60.0, 0.05, 1.703_145_549_088_93e-5, 1e-11),
            (75.0, 0.7, 0.092_776_588_873_651_5, 1e-11),
            (85.0, 0.3, 0.024_161_225_133_024_1, 1e-11),
            (89.0, 0.1, 0.011_814_419_356_246_2, 1e-8),
        ] {
            let lost = PI * SingleScatteringLoss::at(Gauss, Degrees(theta_i), sigma, 0.0).lobe.value();
            assert!((lost / expected - 1.0).abs() < tolerance, "θi = {theta_i}°, σ = {sigma}: {lost} {expected}");
        }
    }

    #[test]
    fn twice_the_nodes_change_nothing_at_grazing_angles_and_on_mirrors() {
        // Half of the nodes keep half of the digits: so much better is the whole rule.
        for (theta_i, sigma, tolerance) in [(89.9, 0.3, 1e-4), (30.0, 0.001, 1e-3), (85.0, 3.0, 1e-5)] {
            let [fine, coarse] = [Order::Fine, Order::Coarse]
                .map(|order| SingleScatteringLoss::by_quadrature(Gauss, Degrees(theta_i), sigma, 0.0, order).lobe.factor);
            assert!((coarse / fine - 1.0).abs() < tolerance, "θi = {theta_i}°, σ = {sigma}: {coarse} {fine}");
        }
    }

    #[test]
    fn slopes_are_those_of_the_loss() {
        // A central difference of this step is good to about its square and the rounding over it.
        let (step, tolerance) = (1e-5, 1e-7);
        for (distribution, q) in [(Gauss, 2.0), (Cauchy, 1.4), (Cauchy, 6.0)] {
            for (theta_i, sigma) in [(0.0, 0.2), (40.0, 0.05), (70.0, 0.6), (88.0, 0.3)] {
                let ln = |sigma: f64, q: f64| {
                    let Lobe { factor, exponent } = SingleScatteringLoss::at(distribution, Degrees(theta_i), sigma, q).lobe;
                    libm::log(factor) - exponent
                };
                let loss = SingleScatteringLoss::at(distribution, Degrees(theta_i), sigma, q);
                let by_sigma = (ln(sigma * (1.0 + step), q) - ln(sigma * (1.0 - step), q)) / (2.0 * step * sigma);
                let by_q = (ln(sigma, q + step) - ln(sigma, q - step)) / (2.0 * step);
                assert!(
                    (loss.by_sigma / by_sigma - 1.0).abs() < tolerance,
                    "{distribution:?} {theta_i} {sigma}: {} {by_sigma}",
                    loss.by_sigma
                );
                assert!(
                    (loss.by_q - by_q).abs() <= tolerance * by_q.abs().max(1.0),
                    "{distribution:?} {theta_i} {sigma}: {} {by_q}",
                    loss.by_q
                );
            }
        }
    }

    #[test]
    fn a_mirror_loses_less_than_f64_can_hold_and_still_has_a_ratio() {
        let loss = SingleScatteringLoss::at(Gauss, Degrees(30.0), 0.001, 0.0);
        assert_eq!(loss.lobe.value(), 0.0);
        // tan²20°/2σ², the first slope at which anything is lost.
        let tan = libm::tan(20.0_f64.to_radians());
        assert!((loss.lobe.exponent / (tan * tan / 2e-6) - 1.0).abs() < 1e-12 && loss.lobe.factor > 0.0);
    }
}
