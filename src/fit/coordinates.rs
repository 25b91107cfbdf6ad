//! The coordinates that the solver walks in: no bounds, and few curved valleys.
//!
//! Each free parameter p in [a, b] becomes an angle φ with `p = a + (b − a) sin²φ`: smooth, onto the closed box, and a step
//! too long folds back instead of running away.
//!
//! The height of the specular lobe goes as h(q)/σ² (h = 1 for Gauss, q − 1 for Cauchy). DoLP sees k_d and k_v only over that
//! height, so that changing σ or q alone throws them off, and a descent in plain coordinates creeps along the curved valley in which they
//! make up for it. There the coordinate of k_d and k_v is `z = φ/g`, `g = √h(q)/σ` over its value at the start: near the
//! lower bound, where `k ∝ φ²`, z holds k/g² fixed while σ and q move. With a measured BRDF it is k_s that makes up for
//! them, the other way round: `z = φ g`.

use super::problem::Problem;
use crate::model::{Parameter, Parameters};
use crate::optics::SlopeDistribution;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::FRAC_PI_2;

/// The fraction of the box that a start keeps from an edge, where the slope by φ vanishes.
const START_MARGIN: f64 = 1e-3;

/// Solver coordinates of a problem's free parameters.
pub(super) struct Coordinates<'a> {
    problem: &'a Problem,
    /// For each free parameter the power of g in φ = z gᵖ: 0 for those that go their own way.
    powers: Vec<i32>,
    /// √h(q)/σ at the start.
    start_height: f64,
}

impl<'a> Coordinates<'a> {
    /// Each parameter goes its own way.
    pub(super) fn plain(problem: &'a Problem) -> Self {
        Self { problem, powers: vec![0; problem.free().len()], start_height: 1.0 }
    }

    /// The weights follow σ and q.
    pub(super) fn valley(problem: &'a Problem) -> Self {
        let power = |parameter: &Parameter| match parameter {
            _ if !problem.model().specular => 0,
            Parameter::Kd | Parameter::Kv if problem.knows_only_ratios() => 1,
            Parameter::Ks if !problem.knows_only_ratios() => -1,
            _ => 0,
        };
        let mut coordinates = Self { powers: problem.free().iter().map(power).collect(), ..Self::plain(problem) };
        coordinates.start_height = coordinates.height(problem.start());
        coordinates
    }

    /// g: √h(q)/σ over its value at the start.
    fn height(&self, parameters: &Parameters) -> f64 {
        let h = self.problem.model().distribution.height(parameters.q);
        h.sqrt() / parameters.sigma / self.start_height
    }

    fn box_of(&self, j: usize) -> (f64, f64) {
        let (low, high) = self.problem.bounds().of(self.problem.free()[j]);
        (low, high - low)
    }

    /// The coordinates of the start, a little inside the box: there g = 1, and z = φ.
    pub(super) fn start(&self) -> DVector<f64> {
        let free = self.problem.free();
        DVector::from_fn(free.len(), |j, _| {
            let (low, width) = self.box_of(j);
            let fraction = ((self.problem.start()[free[j]] - low) / width).clamp(START_MARGIN, 1.0 - START_MARGIN);
            FRAC_PI_2 - libm::acos(fraction.sqrt())
        })
    }

    /// φ of each free parameter, given z and g.
    fn angle(&self, j: usize, z: f64, g: f64) -> f64 {
        match self.powers[j] {
            0 => z,
            power if power > 0 => z * g,
            _ => z / g,
        }
    }

    /// The parameters at those coordinates.
    pub(super) fn parameters(&self, z: &DVector<f64>) -> Parameters {
        let mut parameters = *self.problem.start();
        let mut set = |own_way: bool, g: f64| {
            for (j, &parameter) in self.problem.free().iter().enumerate() {
                if (self.powers[j] == 0) == own_way {
                    let (low, width) = self.box_of(j);
                    let sin = libm::sin(self.angle(j, z[j], g));
                    parameters[parameter] = self.problem.bounds().clamp(parameter, low + width * sin * sin);
                }
            }
            parameters
        };
        // σ and q first: g follows from them.
        let g = self.height(&set(true, 1.0));
        set(false, g)
    }

    /// Turns the derivatives by the parameters into those by the coordinates.
    pub(super) fn chain(&self, z: &DVector<f64>, parameters: &Parameters, jacobian: &mut DMatrix<f64>) {
        let g = self.height(parameters);
        let free = self.problem.free();
        let phi: Vec<f64> = (0..free.len()).map(|j| self.angle(j, z[j], g)).collect();
        for (j, phi) in phi.iter().enumerate() {
            // dp/dφ
            jacobian.column_mut(j).scale_mut(self.box_of(j).1 * libm::sin(2.0 * phi));
        }
        for (i, &parameter) in free.iter().enumerate() {
            // ∂ln g/∂σ and ∂ln g/∂q
            let slope = match parameter {
                Parameter::Sigma => -1.0 / parameters.sigma,
                Parameter::Q if self.problem.model().distribution == SlopeDistribution::Cauchy => 0.5 / (parameters.q - 1.0),
                _ => continue,
            };
            let along = slope * self.box_of(i).1 * libm::sin(2.0 * phi[i]);
            for (j, phi) in phi.iter().enumerate().filter(|(j, _)| self.powers[*j] != 0) {
                let moved = jacobian.column(j) * (along * phi * f64::from(self.powers[j]));
                let mut column = jacobian.column_mut(i);
                column += moved;
            }
        }
        for j in 0..free.len() {
            // dφ/dz
            jacobian.column_mut(j).scale_mut(self.angle(j, 1.0, g));
        }
        // A power of 0 has angle(1) = 1: its column stays.
    }
}
