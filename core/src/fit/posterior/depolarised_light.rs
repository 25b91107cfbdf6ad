//! How much depolarised light lowers DoLP, in the coordinates of a posterior.
//!
//! `DoLP = P/(I + d)` with the polarised part P and the intensity I of the specular lobe, and the light d of the depolarising lobes. The
//! data determine the mean of ln DoLP far better than anything else. `ln P/I ≈ −ln D` up to a constant, D = n + k²/n. So the mean of
//! `ln(1 + d/I)` over the measured points is added to the coordinate of D: a change of d/I at a fixed coordinate leaves the mean of
//! ln DoLP as it is. By Eqs. (12, 13)
//!
//! `d/I = a k_d s (cos θi cos θr)^c + b k_v s exp(−θr²/2σ_v²)/σ_v`,
//!
//! where a and b are those of a reference surface, and s is what k_d and k_v are relative to ([`crate::fit::posterior::transform`]). The
//! coordinates of k_d and k_v are the logarithms of each summand at a mean point, so that they hardly depend on c and σ_v.

use crate::fit::objective::Problem;
use crate::model::{Parameter, Parameters, Pbrdf};

/// Points that the mean is taken over, at most: enough to follow θr.
const MOST_POINTS: usize = 9;

/// Light of the volume lobe at the mean point, in sr⁻¹, that is added to it: where σ_v is small, k_v means nothing there.
const DARK: f64 = 1e-3;

/// What the mean of ln(1 + d/I) depends on.
pub(crate) const LIGHT_PARAMETERS: [Parameter; 4] = [Parameter::Kd, Parameter::Kv, Parameter::C, Parameter::SigmaV];

/// A measured point.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Point {
    /// Its share of the mean.
    share: f64,
    /// ln a and ln b; −∞ where a weight is not free.
    ln_ratios: [f64; 2],
    ln_cosines: f64,
    /// θr²/2 in rad².
    half_theta_r_sq: f64,
}

/// A point that stands for all in the coordinates of k_d and k_v.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct MeanPoint {
    ln_cosines: f64,
    /// θr²/2 in rad².
    half_theta_r_sq: f64,
}

impl MeanPoint {
    /// Logarithm of the diffuse lobe, and its derivative by c.
    pub(crate) fn ln_diffuse(self, c: f64) -> (f64, f64) {
        (c * self.ln_cosines, self.ln_cosines)
    }

    /// Logarithm of the volume lobe, and its derivative by σ_v.
    pub(crate) fn ln_volume(self, sigma_v: f64) -> (f64, f64) {
        let reduced = self.half_theta_r_sq / (sigma_v * sigma_v);
        let light = libm::exp(-reduced) / sigma_v;
        (libm::log(light + DARK), light / (light + DARK) * (2.0 * reduced - 1.0) / sigma_v)
    }
}

/// The mean of ln(1 + d/I) over the points of a measurement.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct DepolarisedLight {
    points: Vec<Point>,
}

impl DepolarisedLight {
    /// At a reference surface. `added` is what the coordinates of k_d and k_v are above the logarithms of their values there, without the
    /// mean point; none of a weight that is not free.
    pub(crate) fn new(problem: &Problem, reference: &Parameters, added: [Option<f64>; 2]) -> Self {
        let unit = Parameters { kd: 0.0, kv: 0.0, c: 0.0, sigma_v: 1.0, ..*reference };
        let surface = |parameters: Parameters| Pbrdf::new(problem.model(), parameters).ok();
        let lit = [Parameters { kd: 1.0, ..unit }, Parameters { kv: 1.0, ..unit }].map(surface);
        let (Some(bare), Some(whole)) = (surface(unit), surface(*reference)) else { return Self::default() };
        let facets = problem.geometries().facets();
        let data = problem.observations().data();
        let mut points = Vec::new();
        for datum in data.iter().step_by(data.len().div_ceil(MOST_POINTS).max(1)) {
            let facet = &facets[datum.point];
            let half_theta_r_sq = 0.5 * facet.theta_r * facet.theta_r;
            // The reference has c = 0 and σ_v = 1 rad.
            let ln_ratio = |of: usize, shape: f64| match (&lit[of], added[of]) {
                (Some(lit), Some(added)) => libm::log(bare.dolp(facet) / lit.dolp(facet) - 1.0) + shape - added,
                _ => f64::NEG_INFINITY,
            };
            let ln_ratios = [ln_ratio(0, 0.0), ln_ratio(1, half_theta_r_sq)];
            let pull = datum.weight * whole.dolp(facet);
            if pull.is_finite() && ln_ratios.iter().all(|ratio| *ratio < f64::INFINITY) {
                points.push(Point { share: pull * pull, ln_ratios, ln_cosines: facet.ln_cosines, half_theta_r_sq });
            }
        }
        let sum: f64 = points.iter().map(|point| point.share).sum();
        points.iter_mut().for_each(|point| point.share /= sum);
        if sum > 0.0 { Self { points } } else { Self::default() }
    }

    /// Whether no weight is free that D may follow: the mean is 0 everywhere.
    pub(crate) fn is_dark(&self) -> bool {
        self.points.iter().all(|point| point.ln_ratios == [f64::NEG_INFINITY; 2])
    }

    /// The point that stands for all.
    pub(crate) fn mean_point(&self) -> MeanPoint {
        let mean = |of: fn(&Point) -> f64| self.points.iter().map(|point| point.share * of(point)).sum();
        MeanPoint { ln_cosines: mean(|point| point.ln_cosines), half_theta_r_sq: mean(|point| point.half_theta_r_sq) }
    }

    /// The mean at coordinates of k_d and k_v from which the mean point is taken off; its derivatives by both, and by c and σ_v.
    pub(crate) fn mean(&self, [u_kd, u_kv]: [f64; 2], c: f64, sigma_v: f64) -> (f64, [f64; 4]) {
        let mut mean = 0.0;
        let mut slopes = [0.0; 4];
        let (ln_sigma_v, one_over_sq) = (libm::log(sigma_v), 1.0 / (sigma_v * sigma_v));
        for point in &self.points {
            let diffuse = libm::exp(u_kd + point.ln_ratios[0] + c * point.ln_cosines);
            let volume = libm::exp(u_kv + point.ln_ratios[1] - point.half_theta_r_sq * one_over_sq - ln_sigma_v);
            let brightness = 1.0 + diffuse + volume;
            mean += point.share * libm::log(brightness);
            let share = point.share / brightness;
            slopes[0] += share * diffuse;
            slopes[1] += share * volume;
            slopes[2] += share * diffuse * point.ln_cosines;
            slopes[3] += share * volume * (2.0 * point.half_theta_r_sq * one_over_sq - 1.0) / sigma_v;
        }
        (mean, slopes)
    }
}

#[cfg(test)]
mod tests {
    use super::{DepolarisedLight, MeanPoint};
    use crate::fit::{Bounds, FitOptions, Problem};
    use crate::measurement::{Columns, Simulation};
    use crate::model::{Model, ParameterSet, Parameters, Pbrdf};

    const STEP: f64 = 1e-5;
    /// h² of a third derivative of order 10, and rounding over h.
    const NEAR: f64 = 1e-8;

    fn problem() -> Problem {
        let surface = Pbrdf::new(Model::CAUCHY, Parameters::default()).unwrap();
        // No more points than the mean is taken over.
        let (theta_i, theta_r) = (vec![30.0, 60.0], vec![10.0, 20.0, 40.0, 70.0]);
        let (columns, model_name) = (Columns::Dolp, String::new());
        let simulation = Simulation { model_name, surface, theta_i, theta_r, dphi: 180.0, columns, noise: 0.0, brdf_noise: 0.0, seed: 1 };
        let measurement = simulation.run().unwrap();
        let (start, free) = (Parameters::default(), ParameterSet::ALL);
        Problem::new(&measurement, Model::CAUCHY, start, free, Bounds::default(), FitOptions::default()).unwrap()
    }

    #[test]
    fn it_is_how_much_the_depolarising_lobes_lower_dolp() {
        let problem = problem();
        let reference = *problem.start();
        let light = DepolarisedLight::new(&problem, &reference, [Some(0.0); 2]);
        for (kd, kv, c, sigma_v) in [(0.1, 0.2, -0.5, 0.5), (3.0, 0.0, -0.9, 1.0), (1e-3, 5.0, 0.0, 0.2)] {
            let dolp = |parameters: Parameters, facet| Pbrdf::new(Model::CAUCHY, parameters).unwrap().dolp(facet);
            let (mut mean, mut shares) = (0.0, 0.0);
            for facet in problem.geometries().facets() {
                let share = dolp(reference, facet) * dolp(reference, facet);
                let lit = Parameters { kd, kv, c, sigma_v, ..reference };
                mean += share * libm::log(dolp(Parameters { kd: 0.0, kv: 0.0, ..lit }, facet) / dolp(lit, facet));
                shares += share;
            }
            let found = light.mean([libm::log(kd), libm::log(kv)], c, sigma_v).0;
            assert!((found - mean / shares).abs() < 1e-12 * (1.0 + found), "{kd} {kv}: {found} instead of {}", mean / shares);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let problem = problem();
        let light = DepolarisedLight::new(&problem, problem.start(), [Some(0.3), Some(-0.2)]);
        let at = |[u_kd, u_kv, c, sigma_v]: [f64; 4]| light.mean([u_kd, u_kv], c, sigma_v);
        for point in [[-2.0, -1.0, -0.5, 0.6], [1.0, 2.0, -0.1, 0.3], [0.0, 0.0, -1.0, 1.5]] {
            for (j, slope) in at(point).1.into_iter().enumerate() {
                let value = |h: f64| {
                    let mut there = point;
                    there[j] += h;
                    at(there).0
                };
                let expected = (value(STEP) - value(-STEP)) / (2.0 * STEP);
                assert!((slope - expected).abs() < NEAR, "{j}: {slope} instead of {expected}");
            }
        }
    }

    #[test]
    fn the_mean_point_tells_nothing_of_a_volume_lobe_that_is_dark_there() {
        let point = MeanPoint { ln_cosines: -0.5, half_theta_r_sq: 0.3 };
        // exp(−0.3/0.01²) is 0: what is added is a constant.
        assert!(point.ln_volume(0.01).1.abs() < 1e-300, "{}", point.ln_volume(0.01).1);
        for sigma_v in [0.1, 0.5, 2.0] {
            let expected = (point.ln_volume(sigma_v + STEP).0 - point.ln_volume(sigma_v - STEP).0) / (2.0 * STEP);
            assert!((point.ln_volume(sigma_v).1 - expected).abs() < NEAR * (1.0 + expected.abs()), "{sigma_v}: {expected}");
        }
    }
}
