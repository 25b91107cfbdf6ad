//! A point of phase space, and one leapfrog step from it.

use crate::fit::posterior::log_density::LogDensity;

/// Position and momentum, and what the density is there.
#[derive(Debug, Clone, Default)]
pub(crate) struct Phase {
    pub position: Vec<f64>,
    pub momentum: Vec<f64>,
    pub gradient: Vec<f64>,
    pub log_density: f64,
    /// Logarithm of the probability of the steps back to where the trajectory began, over that of the steps from there.
    pub log_ratio: f64,
}

impl Phase {
    pub(crate) fn new(dimension: usize) -> Self {
        let zeros = || vec![0.0; dimension];
        Self { position: zeros(), momentum: zeros(), gradient: zeros(), log_density: f64::NEG_INFINITY, log_ratio: 0.0 }
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.position.copy_from_slice(&other.position);
        self.momentum.copy_from_slice(&other.momentum);
        self.gradient.copy_from_slice(&other.gradient);
        (self.log_density, self.log_ratio) = (other.log_density, other.log_ratio);
    }

    pub(crate) fn energy(&self) -> f64 {
        0.5 * dot(&self.momentum, &self.momentum) - self.log_density
    }

    /// One leapfrog step.
    pub(crate) fn step(&mut self, density: &mut impl LogDensity, step_size: f64) {
        add_scaled(&mut self.momentum, 0.5 * step_size, &self.gradient);
        add_scaled(&mut self.position, step_size, &self.momentum);
        self.log_density = density.value_and_gradient(&self.position, &mut self.gradient);
        add_scaled(&mut self.momentum, 0.5 * step_size, &self.gradient);
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds a multiple of another vector.
pub(crate) fn add_scaled(to: &mut [f64], factor: f64, other: &[f64]) {
    to.iter_mut().zip(other).for_each(|(slot, other)| *slot += factor * other);
}
