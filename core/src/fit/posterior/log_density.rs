//! What a sampler draws from: a density by its logarithm and the gradient of that.

/// An unnormalised density on all of ℝᵈ.
pub(crate) trait LogDensity {
    /// d.
    fn dimension(&self) -> usize;

    /// Logarithm of the density; writes its gradient. −∞ or NaN where there is none: the gradient is then of no meaning.
    fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64;
}
