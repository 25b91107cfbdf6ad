//! The residuals of the pBRDF as a least squares problem, and local coordinates in which its valleys are straight.
//!
//! The peak of the specular lobe is proportional to `h(q)/σ²` (h = 1 for Gauss, q − 1 for Cauchy). DoLP depends on k_d and k_v only
//! relative to that peak, so that their valley in σ and q is curved, and a descent in the parameters themselves creeps along it. In
//! the local coordinates `k_d σ²/h` and `k_v σ²/h` are constant when σ or q moves. With a measured BRDF k_s takes their place, and
//! `k_s h/σ²` is constant. Steps of n, k, σ, q and σ_v are logarithmic: the coordinate of p is `ln(p − origin)`.

use crate::fit::least_squares::LeastSquares;
use crate::fit::objective::Problem;
use crate::fit::ties::apply_ties;
use crate::model::{Parameter, Parameters};
use crate::optics::SlopeDistribution;
use nalgebra::{DMatrix, DVector};

/// Below this objective the relative misfit is 1e-13, which is rounding.
pub(crate) const ROUNDING_OBJECTIVE: f64 = 1e-26;

/// The part of its upper bound above which a weight is followed by factors.
const EVEN_PART_OF_WEIGHT: f64 = 1e-9;

/// Origin of the logarithm of a parameter with logarithmic steps; none where steps are linear.
pub(crate) fn origin(parameter: Parameter) -> Option<f64> {
    match parameter {
        // n and k may be 0, which has no logarithm.
        Parameter::N => Some(-0.05),
        Parameter::K => Some(-0.5),
        Parameter::Sigma | Parameter::SigmaV => Some(0.0),
        Parameter::Q => Some(1.0),
        Parameter::Ks | Parameter::Kd | Parameter::Kv | Parameter::C => None,
    }
}

impl Problem {
    /// All parameters, given the free ones; a weight below its domain is 0.
    pub(crate) fn parameters_at(&self, x: &DVector<f64>) -> Parameters {
        let mut parameters = *self.start();
        for (&parameter, value) in self.free().iter().zip(x.iter()) {
            parameters[parameter] = parameter.domain().flush_to_zero(*value);
        }
        apply_ties(self.ties(), parameters)
    }

    /// Part of the bound of a weight above which the weight is followed by factors, and below which by steps: the height of the specular
    /// peak may make weights small by many decades. None for other parameters.
    fn even_part(&self, unknown: usize) -> Option<f64> {
        let parameter = self.free()[unknown];
        let is_weight = matches!(parameter, Parameter::Ks | Parameter::Kd | Parameter::Kv);
        is_weight.then(|| (EVEN_PART_OF_WEIGHT * self.bounds().of(parameter).1).max(f64::MIN_POSITIVE))
    }

    /// σ²/h, one over the peak height of the specular lobe.
    pub(crate) fn inverse_peak_height(&self, parameters: &Parameters) -> f64 {
        parameters.sigma * parameters.sigma / self.model().distribution.height(parameters.q)
    }

    /// Exponent e such that weight·(σ²/h)^e is held constant when σ or q moves; 0 for parameters that are not coupled.
    fn weight_exponent(&self, parameter: Parameter) -> i32 {
        match parameter {
            _ if !self.model().specular => 0,
            Parameter::Kd | Parameter::Kv if self.knows_only_ratios() => 1,
            Parameter::Ks if !self.knows_only_ratios() => -1,
            _ => 0,
        }
    }
}

/// What local coordinates need to know of the unknowns, whether of one measurement or of several.
pub(crate) struct Unknowns<'a> {
    pub distribution: SlopeDistribution,
    /// Which parameter an unknown is.
    pub parameter: &'a dyn Fn(usize) -> Parameter,
    /// Exponent e such that the first unknown, a weight, times (σ²/h)^e is held constant when the second one, σ or q, moves; 0 for
    /// unknowns that are not coupled.
    pub weight_exponent: &'a dyn Fn(usize, usize) -> i32,
}

impl Unknowns<'_> {
    /// See [`LeastSquares::to_local`].
    pub(crate) fn to_local(&self, x: &DVector<f64>, moving: &[usize], jacobian: &mut DMatrix<f64>) {
        for &i in moving {
            let parameter = (self.parameter)(i);
            let Some(origin) = origin(parameter) else { continue };
            jacobian.column_mut(i).scale_mut(x[i] - origin);
            // ∂ln(σ²/h) by the coordinate.
            let slope = match parameter {
                Parameter::Sigma => 2.0,
                Parameter::Q if self.distribution == SlopeDistribution::Cauchy => -1.0,
                _ => continue,
            };
            for &j in moving {
                let weight_exponent = (self.weight_exponent)(j, i);
                if weight_exponent != 0 && x[j] != 0.0 {
                    let along = -slope * f64::from(weight_exponent) * x[j];
                    let weight = jacobian.column(j).clone_owned();
                    jacobian.column_mut(i).axpy(along, &weight, 1.0);
                }
            }
        }
    }
}

/// The least and the largest step of a parameter's local coordinate that stay within its bounds.
pub(crate) fn local_bounds(parameter: Parameter, value: f64, (low, high): (f64, f64)) -> (f64, f64) {
    match origin(parameter) {
        Some(origin) => (libm::log((low - origin) / (value - origin)), libm::log((high - origin) / (value - origin))),
        None => (low - value, high - value),
    }
}

/// The value that a step of the local coordinate leads to.
pub(crate) fn moved(parameter: Parameter, value: f64, step: f64) -> f64 {
    origin(parameter).map_or(value + step, |origin| origin + (value - origin) * libm::exp(step))
}

impl LeastSquares for Problem {
    fn residual_count(&self) -> usize {
        self.len()
    }

    fn start(&self) -> DVector<f64> {
        DVector::from_iterator(self.free().len(), self.free().iter().map(|&parameter| Self::start(self)[parameter]))
    }

    fn bounds_of(&self, unknown: usize) -> (f64, f64) {
        self.bounds().of(self.free()[unknown])
    }

    fn residuals_at(&self, x: &DVector<f64>, out: &mut DVector<f64>) -> bool {
        self.residuals(&self.parameters_at(x), out)
    }

    fn jacobian_at(&self, x: &DVector<f64>, out: &mut DMatrix<f64>) -> bool {
        self.jacobian(&self.parameters_at(x), out)
    }

    fn objective_at(&self, sum_of_squares: f64, x: &DVector<f64>) -> f64 {
        if self.minimises_delta_e() { sum_of_squares } else { self.objective(sum_of_squares, &self.parameters_at(x)) }
    }

    fn negligible(&self) -> f64 {
        ROUNDING_OBJECTIVE
    }

    fn to_local(&self, x: &DVector<f64>, moving: &[usize], jacobian: &mut DMatrix<f64>) {
        let unknowns = Unknowns {
            distribution: self.model().distribution,
            parameter: &|unknown| self.free()[unknown],
            weight_exponent: &|weight, _| self.weight_exponent(self.free()[weight]),
        };
        unknowns.to_local(x, moving, jacobian);
    }

    fn local_bounds(&self, x: &DVector<f64>, unknown: usize) -> (f64, f64) {
        local_bounds(self.free()[unknown], x[unknown], self.bounds_of(unknown))
    }

    fn straight(&self, unknown: usize, value: f64) -> f64 {
        match (self.even_part(unknown), origin(self.free()[unknown])) {
            (Some(even), _) => libm::log1p(value / even),
            (None, Some(origin)) => libm::log(value - origin),
            (None, None) => value,
        }
    }

    fn at_straight(&self, unknown: usize, coordinate: f64) -> f64 {
        match (self.even_part(unknown), origin(self.free()[unknown])) {
            (Some(even), _) => even * libm::expm1(coordinate),
            (None, Some(origin)) => origin + libm::exp(coordinate),
            (None, None) => coordinate,
        }
    }

    fn retract(&self, x: &DVector<f64>, moving: &[usize], step: &[f64], out: &mut DVector<f64>) {
        out.copy_from(x);
        for (&j, step) in moving.iter().zip(step) {
            out[j] = moved(self.free()[j], x[j], *step);
        }
        let flatter = self.inverse_peak_height(&self.parameters_at(out)) / self.inverse_peak_height(&self.parameters_at(x));
        for &j in moving {
            match self.weight_exponent(self.free()[j]) {
                0 => {}
                weight_exponent if weight_exponent > 0 => out[j] /= flatter,
                _ => out[j] *= flatter,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::LeastSquares;
    use crate::fit::{Bounds, FitOptions, Problem};
    use crate::measurement::{Columns, Simulation};
    use crate::model::{Model, Parameters, Pbrdf};
    use crate::optics::SlopeDistribution;
    use crate::optics::SlopeDistribution::{Cauchy, Gauss};
    use nalgebra::{DMatrix, DVector};

    /// All parameters of the model free, on simulated data.
    fn problem(distribution: SlopeDistribution, columns: Columns) -> Problem {
        let model = Model::full(distribution);
        let measurement = Simulation {
            model_name: distribution.key().to_owned(),
            surface: Pbrdf::new(model, Parameters::default()).unwrap(),
            theta_i: vec![30.0, 60.0],
            theta_r: vec![0.0, 20.0, 40.0, 60.0, 70.0],
            dphi: 180.0,
            columns,
            noise: 0.0,
            brdf_noise: 0.0,
            seed: 1,
        }
        .run()
        .unwrap();
        let start = Parameters { n: 1.4, k: 2.2, sigma: 0.4, ks: 0.8, kd: 0.2, kv: 0.3, q: 2.6, c: -0.3, sigma_v: 0.7 };
        Problem::new(&measurement, model, start, model.parameters(), Bounds::default(), FitOptions::default()).unwrap()
    }

    #[test]
    fn local_derivatives_are_those_along_the_steps() {
        // Central differences: h² of a third derivative of order 1, and rounding over h.
        const STEP: f64 = 1e-5;
        const NEAR: f64 = 1e-8;
        for (distribution, columns) in [(Gauss, Columns::Dolp), (Cauchy, Columns::Dolp), (Cauchy, Columns::Brdf), (Cauchy, Columns::Both)] {
            let problem = problem(distribution, columns);
            let x = LeastSquares::start(&problem);
            let moving: Vec<usize> = (0..x.len()).collect();
            let mut jacobian = DMatrix::zeros(problem.residual_count(), x.len());
            assert!(problem.jacobian_at(&x, &mut jacobian));
            problem.to_local(&x, &moving, &mut jacobian);
            for j in 0..x.len() {
                let residuals_after = |h: f64| {
                    let step: Vec<f64> = (0..x.len()).map(|i| if i == j { h } else { 0.0 }).collect();
                    let (mut there, mut residuals) = (x.clone(), DVector::zeros(problem.residual_count()));
                    problem.retract(&x, &moving, &step, &mut there);
                    assert!(problem.residuals_at(&there, &mut residuals));
                    residuals
                };
                let along = (residuals_after(STEP) - residuals_after(-STEP)) / (2.0 * STEP);
                let column = jacobian.column(j).clone_owned();
                assert!((&along - &column).amax() <= NEAR * column.amax().max(1.0), "{distribution:?} {columns:?} {j}: {along} {column}");
            }
        }
    }

    #[test]
    fn the_longest_steps_end_on_the_edges_of_the_box() {
        let problem = problem(Cauchy, Columns::Dolp);
        let x = LeastSquares::start(&problem);
        for j in 0..x.len() {
            let (down, up) = problem.local_bounds(&x, j);
            for (step, edge) in [(down, problem.bounds_of(j).0), (up, problem.bounds_of(j).1)] {
                let mut there = x.clone();
                problem.retract(&x, &[j], &[step], &mut there);
                assert!((there[j] - edge).abs() <= 1e-13 * (1.0 + edge.abs()), "{j}: {} instead of {edge}", there[j]);
            }
        }
    }
}
