//! The likelihood of the data, by the residuals of the fit.
//!
//! With stated standard deviations the sum of squares is χ² and `ln L = −χ²/2`. Else each quantity has one unknown standard deviation s
//! with the prior 1/s, which is integrated out: `L ∝ SS^(−N/2)`, a factor for DoLP and one for BRDF, each over the rows of all
//! measurements. Constants are those of densities of the data in units of the residuals, so that models are compared on the same footing.

use crate::fit::objective::Problem;
use crate::model::{Batch, DolpGradients, Parameters, Pbrdf};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::{PI, TAU};

/// Sum of squares, in units of ΔE of Eq. (18), that rounding alone leaves: data without noise have no narrower posterior.
const ROUNDING: f64 = 1e-20;

/// Sum of squares of DoLP and of BRDF.
pub(crate) type SquareSums = [f64; 2];

/// The sums of squares of a measurement, with buffers for their evaluation.
#[derive(Debug, Clone)]
pub(crate) struct Misfit {
    problem: Problem,
    /// Where DoLP alone is measured: the geometries for the kernels, and measured value and weight of each point.
    dolp: Option<DolpData>,
    residuals: DVector<f64>,
    jacobian: DMatrix<f64>,
    /// Number of residuals of DoLP and of BRDF.
    counts: [usize; 2],
}

#[derive(Debug, Clone)]
struct DolpData {
    batch: Batch,
    measured: Vec<(f64, f64)>,
    out: DolpGradients,
}

/// Derivatives of both sums by the free parameters.
pub(crate) type SumGradients = [Vec<f64>; 2];

impl Misfit {
    pub(crate) fn new(problem: &Problem) -> Self {
        let data = problem.observations().data();
        let counts = [0, 1].map(|block| data.iter().filter(|datum| datum.kind.block() == block).count());
        let dolp = (counts[1] == 0 && problem.ties().is_empty()).then(|| DolpData {
            batch: Batch::from_facets(data.iter().map(|datum| problem.geometries().facets()[datum.point]).collect()).single_threaded(),
            measured: data.iter().map(|datum| (datum.measured, datum.weight)).collect(),
            out: DolpGradients::default(),
        });
        Self {
            problem: problem.with_squared_loss(),
            dolp,
            residuals: DVector::zeros(problem.len()),
            jacobian: DMatrix::zeros(problem.len(), problem.free().len()),
            counts,
        }
    }

    /// Number of residuals of DoLP and of BRDF.
    pub(crate) fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// The sums; writes their derivatives. None where the parameters are no surface.
    pub(crate) fn sums_and_gradients(&mut self, parameters: &Parameters, gradients: &mut SumGradients) -> Option<SquareSums> {
        gradients.iter_mut().for_each(|by| by.fill(0.0));
        if self.dolp.is_some() { self.of_dolp(parameters, gradients) } else { self.of_any(parameters, gradients) }
    }

    fn of_dolp(&mut self, parameters: &Parameters, [by_dolp, _]: &mut SumGradients) -> Option<SquareSums> {
        let DolpData { batch, measured, out } = self.dolp.as_mut()?;
        let surface = Pbrdf::new(self.problem.model(), *parameters).ok()?;
        batch.dolp_gradients(&surface, out);
        let mut sum = 0.0;
        // The column of DoLP becomes that of ∂(SS/2)/∂DoLP.
        for (slot, &(measured, weight)) in out.dolp.iter_mut().zip(&*measured) {
            let residual = weight * (*slot - measured);
            sum += residual * residual;
            *slot = weight * residual;
        }
        for (slot, &parameter) in by_dolp.iter_mut().zip(self.problem.free()) {
            *slot = 2.0 * out.dolp.iter().zip(&out.by[parameter]).map(|(a, b)| a * b).sum::<f64>();
        }
        Some([sum, 0.0])
    }

    fn of_any(&mut self, parameters: &Parameters, gradients: &mut SumGradients) -> Option<SquareSums> {
        let Self { problem, residuals, jacobian, .. } = self;
        if !(problem.residuals(parameters, residuals) && problem.jacobian(parameters, jacobian)) {
            return None;
        }
        for (row, datum) in problem.observations().data().iter().enumerate() {
            let by = &mut gradients[datum.kind.block()];
            by.iter_mut().enumerate().for_each(|(j, slot)| *slot += 2.0 * residuals[row] * jacobian[(row, j)]);
        }
        Some(square_sums(problem, residuals))
    }

    /// Sums of squares in units of the measured values: of DoLP, of BRDF.
    pub(crate) fn square_sums(&mut self, parameters: &Parameters) -> SquareSums {
        let Self { problem, residuals, .. } = self;
        problem.residuals(parameters, residuals);
        let scales = problem.observations().scales();
        let sums = square_sums(problem, residuals);
        [0, 1].map(|block| sums[block] / (scales[block] * scales[block]))
    }
}

fn square_sums(problem: &Problem, residuals: &DVector<f64>) -> SquareSums {
    let mut sums = [0.0; 2];
    for (residual, datum) in residuals.iter().zip(problem.observations().data()) {
        sums[datum.kind.block()] += residual * residual;
    }
    sums
}

/// ln L of so many residuals with that sum of squares, and its derivative by the sum.
pub(crate) fn log_likelihood(sum: f64, count: usize, by_sigma: bool) -> (f64, f64) {
    if count == 0 {
        return (0.0, 0.0);
    }
    #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
    let half = 0.5 * count as f64;
    if by_sigma {
        (-0.5 * sum - half * libm::log(TAU), -0.5)
    } else {
        let floored = sum + ROUNDING;
        (libm::lgamma(half) - half * libm::log(PI * floored) - libm::log(2.0), -half / floored)
    }
}
