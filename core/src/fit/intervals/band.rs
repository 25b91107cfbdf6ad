//! The band around a fitted curve: the standard error of a predicted DoLP or BRDF at any geometry.
//!
//! To first order (delta method; Bates and Watts, *Nonlinear Regression Analysis*, 1988, sec. 2.3) a prediction f with the gradient g by the free
//! parameters has the variance `gᵀ C g`. C is the pseudo-inverse covariance of **all** free parameters, the undetermined ones included: a curve may be
//! determined where its parameters are not (DoLP determines k_d/k_s, but neither k_d nor k_s). Where g has a share in an undetermined
//! direction, the curve is undetermined as well, and there is no standard error.

use crate::fit::intervals::linear::Uncertainty;
use crate::fit::objective::Problem;
use crate::fit::ties::Tie;
use crate::model::{Gradient, GradientRequest, Model, ParameterSet, Parameters, Pbrdf, PerParameter};
use crate::optics::Facet;
use std::sync::Arc;

/// Standard errors of the curves of a fit at any geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictionBand {
    model: Model,
    parameters: Parameters,
    uncertainty: Uncertainty,
    ties: Arc<[Tie]>,
}

impl PredictionBand {
    /// Around the curves of those parameters, given what the problem's data determine there.
    #[must_use]
    pub fn new(problem: &Problem, parameters: &Parameters, uncertainty: Uncertainty) -> Self {
        Self { model: problem.model(), parameters: *parameters, uncertainty, ties: problem.ties().into() }
    }

    /// What the data determine.
    #[must_use]
    pub fn uncertainty(&self) -> &Uncertainty {
        &self.uncertainty
    }

    /// Standard errors of the predicted DoLP at prepared geometries; none where the data leave the curve open or no degree of
    /// freedom is left.
    #[must_use]
    pub fn dolp(&self, facets: &[Facet]) -> Vec<Option<f64>> {
        self.errors(facets, GradientRequest { by: self.by(), brdf: false, dolp: true }, |gradient| gradient.dolp)
    }

    /// Standard errors of the predicted BRDF, in sr⁻¹, the same way.
    #[must_use]
    pub fn brdf(&self, facets: &[Facet]) -> Vec<Option<f64>> {
        self.errors(facets, GradientRequest { by: self.by(), brdf: true, dolp: false }, |gradient| gradient.brdf)
    }

    fn by(&self) -> ParameterSet {
        let analysed: ParameterSet = self.uncertainty.analysed.iter().copied().collect();
        let with_tied = |by: ParameterSet, tie: &Tie| if analysed.contains(tie.to) { by.with(tie.parameter) } else { by };
        self.ties.iter().fold(analysed, with_tied)
    }

    /// Derivatives by the unknowns, which move what is tied to them.
    fn by_unknowns(&self, mut by: PerParameter<f64>) -> PerParameter<f64> {
        for tie in self.ties.iter() {
            by[tie.to] += tie.factor * by[tie.parameter];
        }
        by
    }

    fn errors(&self, facets: &[Facet], wanted: GradientRequest, pick: impl Fn(&Gradient) -> PerParameter<f64>) -> Vec<Option<f64>> {
        let Ok(surface) = Pbrdf::new(self.model, self.parameters) else { return vec![None; facets.len()] };
        let error =
            |facet| self.uncertainty.error_of_prediction(&self.by_unknowns(pick(&surface.reflection_and_gradient(facet, wanted).1)));
        facets.iter().map(error).collect()
    }
}
