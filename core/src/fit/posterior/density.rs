//! The posterior as a density on ℝᵈ: likelihood, priors and the volume of the transform.

use crate::fit::posterior::likelihood::Likelihood;
use crate::fit::posterior::log_density::LogDensity;
use crate::fit::posterior::prior::BoundedPrior;
use crate::fit::posterior::transform::{Transform, Transformed};

/// Likelihood × priors in the coordinates of a transform.
#[derive(Debug, Clone)]
pub(crate) struct PosteriorDensity {
    pub(crate) likelihood: Likelihood,
    /// Of each free parameter.
    priors: Vec<BoundedPrior>,
    pub(crate) transform: Transform,
    at: Transformed,
}

impl PosteriorDensity {
    pub(crate) fn new(likelihood: Likelihood, priors: Vec<BoundedPrior>, transform: Transform) -> Self {
        Self { likelihood, priors, transform, at: Transformed::default() }
    }
}

impl LogDensity for PosteriorDensity {
    fn dimension(&self) -> usize {
        self.transform.dimension()
    }

    fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
        let Self { likelihood, priors, transform, at: there } = self;
        transform.transform(at, there);
        let parameters = &there.parameters;
        let Some(mut value) = likelihood.value_and_gradient(parameters, gradient) else { return f64::NEG_INFINITY };
        for ((&parameter, prior), slot) in likelihood.free().iter().zip(priors).zip(&mut *gradient) {
            let (log, slope) = prior.log_density(parameters[parameter]);
            value += log;
            *slot += slope;
        }
        transform.pull_back(there, gradient);
        value + there.log_jacobian
    }
}
