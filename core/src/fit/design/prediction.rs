//! What a choice of angles would determine, before anything is measured.
//!
//! Standard errors are those of a fit weighted by stated standard deviations: σ_DoLP absolute, σ_BRDF relative, `C = (JᵀJ)⁺` of the residuals in units of
//! σ at the planned surface, without χ²/dof, which nobody knows beforehand.

use crate::fit::bounds::Bounds;
use crate::fit::estimate::is_determined;
use crate::fit::free_parameters::free_by_default;
use crate::fit::intervals::band::PredictionBand;
use crate::fit::intervals::linear::{Uncertainty, UndeterminedDirection};
use crate::fit::objective::Problem;
use crate::fit::options::{FitOptions, Weights};
use crate::fit::problem_error::ProblemError;
use crate::measurement::{Measurement, Quantity, Row};
use crate::model::{Model, Parameter, ParameterError, ParameterSet, Parameters, Pbrdf};
use crate::optics::{Facet, Geometry};

/// What is to be measured, and how well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseModel {
    /// Standard deviation of DoLP, absolute, > 0; none where DoLP is not measured.
    pub dolp: Option<f64>,
    /// Standard deviation of the BRDF relative to its value, > 0; none where the BRDF is not measured.
    pub brdf: Option<f64>,
}

/// A measurement to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// Which terms the surface has.
    pub model: Model,
    /// Its supposed values.
    pub parameters: Parameters,
    /// Where it is to be measured.
    pub geometries: Vec<Geometry>,
    /// How well.
    pub noise: NoiseModel,
    /// The parameters that the fit is to find.
    pub free: ParameterSet,
    /// What is measured already, with its standard deviations; those that are not stated are as the noise of the plan.
    pub given: Vec<Row>,
}

/// What a plan would determine.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignPrediction {
    /// Standard error of each free parameter in its own unit; none where it would stay open.
    pub errors: Vec<(Parameter, Option<f64>)>,
    /// The parameters whose error is at most half of max(|value|, 0.1) and half of their range.
    pub determined: ParameterSet,
    /// What would stay open.
    pub undetermined: Vec<UndeterminedDirection>,
    /// Number of directions that would be determined.
    pub rank: usize,
    /// Largest over smallest singular value of the scaled Jacobian; none without a determined direction.
    pub condition: Option<f64>,
    /// The band that the fitted curves would have.
    pub band: PredictionBand,
}

/// Why nothing can be predicted of a plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// The parameters are no surface.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The data would make no fit.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}

impl NoiseModel {
    /// How many quantities are measured.
    pub(crate) fn quantities(self) -> usize {
        usize::from(self.dolp.is_some()) + usize::from(self.brdf.is_some())
    }

    /// The standard deviation that information is counted in units of: of DoLP, or of a BRDF that alone is measured.
    pub(crate) fn unit(self) -> f64 {
        self.dolp.or(self.brdf).unwrap_or(1.0)
    }

    /// What a derivative of the BRDF is multiplied by for those units; 0 where a BRDF of 0 has no standard deviation.
    pub(crate) fn brdf_weight(self, brdf: f64) -> f64 {
        let weight = self.unit() / (self.brdf.unwrap_or(f64::INFINITY) * brdf);
        if weight.is_finite() { weight } else { 0.0 }
    }
}

impl Design {
    /// With the parameters free that a fit of such data frees by default.
    #[must_use]
    pub fn new(model: Model, parameters: Parameters, geometries: Vec<Geometry>, noise: NoiseModel) -> Self {
        let mut plan = Self { model, parameters, geometries, noise, free: ParameterSet::EMPTY, given: Vec::new() };
        plan.free = Pbrdf::new(model, parameters)
            .map_or(ParameterSet::EMPTY, |surface| free_by_default(model, &plan.measurement(&surface), &FitOptions::default()));
        plan
    }

    /// What it would determine.
    ///
    /// # Errors
    ///
    /// [`DesignError`] where the parameters are no surface, or the planned values are no data for a fit.
    pub fn predict(&self) -> Result<DesignPrediction, DesignError> {
        let surface = Pbrdf::new(self.model, self.parameters)?;
        let mut bounds = Bounds::default();
        for parameter in self.free {
            bounds.widen_to(parameter, self.parameters[parameter]);
        }
        let choices = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
        let problem = Problem::new(&self.measurement(&surface), self.model, self.parameters, self.free, bounds, choices);
        let problem = problem?;
        let uncertainty = Uncertainty::at(&problem, &self.parameters, 0.0, ParameterSet::EMPTY);
        let errors: Vec<(Parameter, Option<f64>)> =
            problem.free().iter().map(|&parameter| (parameter, uncertainty.standard_error(parameter))).collect();
        let is_determined = |&(parameter, error): &(Parameter, Option<f64>)| {
            let is_determined = |error| is_determined(self.parameters[parameter], error, bounds.of(parameter));
            error.is_some_and(is_determined).then_some(parameter)
        };
        Ok(DesignPrediction {
            determined: errors.iter().filter_map(is_determined).collect(),
            errors,
            undetermined: uncertainty.undetermined.clone(),
            rank: uncertainty.rank,
            condition: uncertainty.condition,
            band: PredictionBand::new(&problem, &self.parameters, uncertainty),
        })
    }

    /// The values to be expected, each with its standard deviation; a BRDF of 0 has none and is left out.
    fn measurement(&self, surface: &Pbrdf) -> Measurement {
        let rows = self.geometries.iter().map(|&geometry| {
            let reflection = surface.reflection(&Facet::new(geometry));
            let quantity = |value: f64, sigma: f64| (sigma > 0.0).then_some(Quantity { value, sigma: Some(sigma) });
            Row {
                geometry,
                dolp: self.noise.dolp.and_then(|sigma| quantity(reflection.dolp, sigma)),
                brdf: self.noise.brdf.and_then(|relative| quantity(reflection.brdf, relative * reflection.brdf)),
                masked: false,
            }
        });
        let relative = |brdf: Quantity| self.noise.brdf.map(|relative| relative * brdf.value).filter(|&sigma| sigma > 0.0);
        let stated = |quantity: Option<Quantity>, otherwise: &dyn Fn(Quantity) -> Option<f64>| {
            quantity.and_then(|quantity| Some(Quantity { sigma: Some(quantity.sigma.or_else(|| otherwise(quantity))?), ..quantity }))
        };
        let given =
            self.given.iter().map(|row| Row { dolp: stated(row.dolp, &|_| self.noise.dolp), brdf: stated(row.brdf, &relative), ..*row });
        Measurement { rows: rows.chain(given).collect(), ..Measurement::default() }
    }
}
