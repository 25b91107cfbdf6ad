//! What is minimised: the residuals of a measurement under a model, and their derivatives by the free parameters.
//!
//! Objective (18): `ΔE = Σ (X − Xm)² / Σ Xm²` over all measured rows; with DoLP and BRDF both measured, the sum of both ΔE.
//! Every residual is divided by the root of its own Σ Xm², so that the sum of their squares *is* the objective. BRDF residuals may
//! instead be relative, (X − Xm)/Xm, or logarithmic, ln(X/Xm), divided by the root of their number: lobes span decades.
//! With stated standard deviations the residual is (X − Xm)/σ and the sum of squares is χ².
//!
//! A robust loss ρ turns a residual r of scale s into `s √ρ(r²/s²)`: Huber `ρ(z) = z` up to 1 and `2√z − 1` above, soft-L1
//! `ρ(z) = 2(√(1 + z) − 1)`.

use crate::fit::bounds::Bounds;
use crate::fit::options::{BrdfResiduals, FitOptions, Loss, Weights};
use crate::measurement::{Measurement, Quantity};
use crate::model::{DolpFormula, GeometrySet, Gradient, GradientRequest, Model, Parameter, ParameterSet, Parameters, Pbrdf, Reflection};
use crate::optics::RefractiveIndex;
use nalgebra::{DMatrix, DVector};

/// Huber's constant: 95 % efficient where the noise is Gaussian.
const HUBER_EFFICIENCY: f64 = 1.345;
/// Median absolute deviation of the standard normal distribution.
const NORMAL_MAD: f64 = 0.674_489_750_196_081_7;

/// Median of the distances from the median; 0 without values.
fn median_absolute_deviation(mut values: Vec<f64>) -> f64 {
    let middle = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let half = values.len() / 2;
        match values.len() {
            0 => 0.0,
            n if n % 2 == 1 => values[half],
            _ => f64::midpoint(values[half - 1], values[half]),
        }
    };
    let center = middle(&mut values);
    let mut distances: Vec<f64> = values.into_iter().map(|value| (value - center).abs()).collect();
    middle(&mut distances)
}

/// Why data and choices make no problem.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProblemError {
    /// A stated standard deviation is needed and missing.
    #[error("the value of {quantity} has no {quantity}_sigma, which weights by standard deviation need")]
    MissingSigma {
        /// Index of the row in the measurement.
        row: usize,
        /// `dolp` or `brdf`.
        quantity: &'static str,
    },
    /// No measured quantity that the model predicts.
    #[error("the model predicts DoLP only, and no DoLP is measured")]
    NothingToPredict,
    /// Bounds and start do not fit.
    #[error("{} = {value} is outside its bounds {low} … {high}", .parameter.key())]
    StartOutsideBounds {
        /// Which parameter.
        parameter: Parameter,
        /// Its start.
        value: f64,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Dolp,
    Brdf,
    LogBrdf,
}

impl Kind {
    /// 0 for DoLP, 1 for BRDF.
    fn block(self) -> usize {
        usize::from(self != Self::Dolp)
    }
}

/// One residual.
#[derive(Debug, Clone, Copy)]
struct Datum {
    /// Index into the scene.
    point: usize,
    kind: Kind,
    /// Measured value, or its logarithm.
    measured: f64,
    /// What the difference is multiplied by.
    weight: f64,
}

/// A measurement, a model and what may change.
#[derive(Debug, Clone)]
pub struct Problem {
    model: Model,
    free: Vec<Parameter>,
    start: Parameters,
    bounds: Bounds,
    choices: FitOptions,
    scene: GeometrySet,
    data: Vec<Datum>,
    wanted: GradientRequest,
    /// Σ Xm² of DoLP and of BRDF, where there are any.
    sums: [Option<f64>; 2],
    /// Where the loss changes from squares to sizes, for DoLP and BRDF, in units of the scaled residual.
    loss_scales: [f64; 2],
    left_out: usize,
}

impl Problem {
    /// From the rows that are not masked.
    pub fn new(
        measurement: &Measurement,
        model: Model,
        start: Parameters,
        free: ParameterSet,
        bounds: Bounds,
        choices: FitOptions,
    ) -> Result<Self, ProblemError> {
        for parameter in free {
            if !bounds.contain(parameter, start[parameter]) {
                let (low, high) = bounds.of(parameter);
                return Err(ProblemError::StartOutsideBounds { parameter, value: start[parameter], low, high });
            }
        }
        if choices.dolp_only && !measurement.has_dolp() {
            return Err(ProblemError::NothingToPredict);
        }
        let rows = || measurement.rows.iter().enumerate().filter(|(_, row)| !row.masked);
        let scene = GeometrySet::new(rows().map(|(_, row)| row.geometry));
        let mut problem = Self {
            model,
            free: free.intersection(model.parameters()).iter().collect(),
            start,
            bounds,
            choices,
            scene,
            data: Vec::new(),
            wanted: GradientRequest { by: free, brdf: false, dolp: false },
            sums: [None; 2],
            loss_scales: [1.0; 2],
            left_out: 0,
        };
        for (point, (row, values)) in rows().enumerate() {
            if let Some(dolp) = values.dolp {
                problem.add(point, row, Kind::Dolp, dolp)?;
            }
            if let Some(brdf) = values.brdf.filter(|_| !choices.dolp_only) {
                problem.add(point, row, if choices.brdf_residuals == BrdfResiduals::Log { Kind::LogBrdf } else { Kind::Brdf }, brdf)?;
            }
        }
        problem.normalise();
        problem.wanted.dolp = problem.data.iter().any(|datum| datum.kind == Kind::Dolp);
        problem.wanted.brdf = problem.data.iter().any(|datum| datum.kind != Kind::Dolp);
        Ok(problem.prepared())
    }

    fn add(&mut self, point: usize, row: usize, kind: Kind, quantity: Quantity) -> Result<(), ProblemError> {
        let (index, name) = if kind == Kind::Dolp { (0, "dolp") } else { (1, "brdf") };
        let value = quantity.value;
        *self.sums[index].get_or_insert(0.0) += value * value;
        let relative = kind == Kind::Brdf && self.choices.brdf_residuals == BrdfResiduals::Relative;
        let by_sigma = self.choices.weights == Weights::Sigma;
        if value == 0.0 && (kind == Kind::LogBrdf || (relative && !by_sigma)) {
            self.left_out += 1;
            return Ok(());
        }
        let sigma = match (by_sigma, quantity.sigma) {
            (false, _) => None,
            (true, Some(sigma)) => Some(sigma),
            (true, None) => return Err(ProblemError::MissingSigma { row, quantity: name }),
        };
        let (measured, weight) = match (kind, sigma) {
            // The standard deviation of ln X is σ/X.
            (Kind::LogBrdf, sigma) => (libm::log(value), sigma.map_or(1.0, |sigma| value / sigma)),
            (_, Some(sigma)) => (value, 1.0 / sigma),
            (_, None) => (value, if relative { 1.0 / value } else { 1.0 }),
        };
        self.data.push(Datum { point, kind, measured, weight });
        Ok(())
    }

    /// Divides the residuals of each quantity by the root of what makes the sum of squares ΔE, Eq. (18).
    fn normalise(&mut self) {
        self.loss_scales = [self.choices.loss_scale.unwrap_or(1.0); 2];
        if self.choices.weights == Weights::Sigma {
            return;
        }
        for index in [0, 1] {
            let block = || self.data.iter().filter(|datum| datum.kind.block() == index);
            #[expect(clippy::cast_precision_loss, reason = "a number of rows")]
            let count = block().count() as f64;
            let whole = if index == 0 || self.choices.brdf_residuals == BrdfResiduals::Absolute {
                block().map(|datum| datum.measured * datum.measured).sum()
            } else {
                count
            };
            if whole > 0.0 {
                let scale = 1.0 / whole.sqrt();
                self.data.iter_mut().filter(|datum| datum.kind.block() == index).for_each(|datum| datum.weight *= scale);
                self.loss_scales[index] *= scale;
            }
        }
    }

    /// The same problem with every residual counted by its square.
    #[must_use]
    pub fn with_linear_loss(&self) -> Self {
        Self { choices: FitOptions { loss: Loss::Squared, ..self.choices }, ..self.clone() }
    }

    /// The same problem with the scale of its loss taken from the residuals at those parameters, for each quantity by itself:
    /// 1.345 × their median absolute deviation over 0.6745 (Huber's 95 % efficiency for Gaussian noise).
    #[must_use]
    pub fn with_loss_scale_of(&self, parameters: &Parameters) -> Self {
        let mut residuals = DVector::zeros(self.len());
        self.with_linear_loss().residuals(parameters, &mut residuals);
        let scale = |block: usize| {
            let of_block = residuals.iter().zip(&self.data).filter(|(_, datum)| datum.kind.block() == block);
            HUBER_EFFICIENCY * median_absolute_deviation(of_block.map(|(residual, _)| *residual).collect()) / NORMAL_MAD
        };
        Self { loss_scales: [scale(0), scale(1)], ..self.clone() }
    }

    /// The same problem with its loss changing from squares to sizes there.
    #[must_use]
    pub fn with_loss_scales(&self, loss_scales: [f64; 2]) -> Self {
        Self { loss_scales, ..self.clone() }
    }

    /// Where the loss changes from squares to sizes, for DoLP and BRDF, in units of the scaled residual.
    #[must_use]
    pub fn loss_scales(&self) -> [f64; 2] {
        self.loss_scales
    }

    /// Which terms there are.
    #[must_use]
    pub fn model(&self) -> Model {
        self.model
    }

    /// The parameters that may change, in the order of the columns of the Jacobian.
    #[must_use]
    pub fn free(&self) -> &[Parameter] {
        &self.free
    }

    /// Where the fit begins; the values of what is fixed.
    #[must_use]
    pub fn start(&self) -> &Parameters {
        &self.start
    }

    /// The box that the free parameters stay in.
    #[must_use]
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The choices.
    #[must_use]
    pub fn choices(&self) -> &FitOptions {
        &self.choices
    }

    /// Number of residuals.
    #[must_use]
    pub fn len(&self) -> usize {
        self.data.len()
    }

    /// Whether there is nothing to fit.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// Measured values that the chosen residuals cannot use (a BRDF of 0 has no logarithm and no relative error).
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// The same problem from another start.
    #[must_use]
    pub fn with_start(&self, start: Parameters) -> Self {
        Self { start, ..self.clone() }.prepared()
    }

    /// With the Fresnel reflection prepared where n and k are held.
    fn prepared(mut self) -> Self {
        let is_held = !self.free.contains(&Parameter::N) && !self.free.contains(&Parameter::K);
        self.scene = match RefractiveIndex::new(self.start.n, self.start.k) {
            Ok(index) if is_held => self.scene.with_index(index),
            _ => self.scene.without_index(),
        };
        self
    }

    /// The same problem with other parameters free.
    #[must_use]
    pub fn with_free(&self, free: ParameterSet) -> Self {
        Self {
            free: free.intersection(self.model.parameters()).iter().collect(),
            wanted: GradientRequest { by: free, ..self.wanted },
            ..self.clone()
        }
        .prepared()
    }

    /// The same problem with other data: the values at its start plus residuals drawn from its own, within each quantity, by
    /// `pick` (an index below its argument), times a factor.
    #[must_use]
    pub fn resampled(&self, widen: f64, pick: &mut dyn FnMut(usize) -> usize) -> Self {
        let mut residuals = DVector::zeros(self.len());
        let linear = self.with_linear_loss();
        linear.residuals(&self.start, &mut residuals);
        let mut other = self.clone();
        for block in [0, 1] {
            let members: Vec<usize> = (0..self.len()).filter(|&i| self.data[i].kind.block() == block).collect();
            for &i in &members {
                let drawn = residuals[members[pick(members.len())]];
                let datum = &mut other.data[i];
                // The residual of the datum becomes −widen · drawn at the start.
                datum.measured += (residuals[i] + widen * drawn) / datum.weight;
            }
        }
        other
    }

    /// Writes the residuals; false where the parameters are no surface or a residual is not finite.
    pub fn residuals(&self, parameters: &Parameters, out: &mut DVector<f64>) -> bool {
        let Ok(surface) = Pbrdf::new(self.model, *parameters) else { return false };
        let mut point = usize::MAX;
        let mut reflection = Reflection::default();
        let mut finite = true;
        for (slot, datum) in out.iter_mut().zip(&self.data) {
            if datum.point != point {
                point = datum.point;
                reflection = if self.wanted.brdf {
                    self.scene.reflection(&surface, point)
                } else {
                    Reflection { dolp: self.scene.dolp(&surface, point), ..reflection }
                };
            }
            *slot = self.loss(datum, self.residual(datum, &reflection)).0;
            finite &= slot.is_finite();
        }
        finite
    }

    /// Writes the Jacobian of the residuals by the free parameters; false where an element is not finite.
    pub fn jacobian(&self, parameters: &Parameters, out: &mut DMatrix<f64>) -> bool {
        let Ok(surface) = Pbrdf::new(self.model, *parameters) else { return false };
        let mut point = usize::MAX;
        let mut at = (Reflection::default(), Gradient::default());
        let mut finite = true;
        for (i, datum) in self.data.iter().enumerate() {
            if datum.point != point {
                point = datum.point;
                at = self.scene.reflection_and_gradient(&surface, point, self.wanted);
            }
            let slope = self.loss(datum, self.residual(datum, &at.0)).1;
            for (j, &parameter) in self.free.iter().enumerate() {
                let derivative = slope * datum.weight * derivative(datum.kind, parameter, &at);
                out[(i, j)] = derivative;
                finite &= derivative.is_finite();
            }
        }
        finite
    }

    fn residual(&self, datum: &Datum, reflection: &Reflection) -> f64 {
        let predicted = match datum.kind {
            Kind::Dolp => reflection.dolp,
            Kind::Brdf => reflection.brdf,
            Kind::LogBrdf => libm::log(reflection.brdf),
        };
        datum.weight * (predicted - datum.measured)
    }

    /// A residual as the loss counts it, and the slope of that.
    fn loss(&self, datum: &Datum, residual: f64) -> (f64, f64) {
        let scale = self.loss_scales[datum.kind.block()];
        if self.choices.loss == Loss::Squared || scale <= 0.0 {
            return (residual, 1.0);
        }
        let r = residual / scale;
        let z = r * r;
        let (rho, slope) = match self.choices.loss {
            Loss::Squared => (z, 1.0),
            Loss::Huber if z <= 1.0 => (z, 1.0),
            Loss::Huber => (2.0 * r.abs() - 1.0, 1.0 / r.abs()),
            // 2(√(1 + z) − 1) without the difference.
            Loss::SoftL1 => (2.0 * z / (1.0 + (1.0 + z).sqrt()), 1.0 / (1.0 + z).sqrt()),
        };
        let root = rho.sqrt();
        if root > 0.0 { (scale * root.copysign(r), slope * r.abs() / root) } else { (residual, 1.0) }
    }

    /// Residuals and Jacobian; none where an element of either is not finite.
    #[must_use]
    pub fn linearised(&self, parameters: &Parameters) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let mut residuals = DVector::zeros(self.len());
        let mut jacobian = DMatrix::zeros(self.len(), self.free.len());
        (self.residuals(parameters, &mut residuals) && self.jacobian(parameters, &mut jacobian)).then_some((residuals, jacobian))
    }

    /// Sum of the squared (scaled) residuals; none where it is not finite.
    #[must_use]
    pub fn sum_of_squares(&self, parameters: &Parameters) -> Option<f64> {
        let mut residuals = DVector::zeros(self.len());
        (!self.is_empty() && self.residuals(parameters, &mut residuals)).then(|| residuals.norm_squared())
    }

    /// The prepared geometries of the rows that are not masked.
    pub(crate) fn scene(&self) -> &GeometrySet {
        &self.scene
    }

    /// Whether the BRDF is needed.
    pub(crate) fn predicts_brdf(&self) -> bool {
        self.wanted.brdf
    }

    /// Sum of the squared (scaled) residuals of DoLP and BRDF evaluated elsewhere in [`Self::scene`]. None without data.
    pub(crate) fn sum_of_squares_of(&self, dolp: &[f64], brdf: &[f64]) -> Option<f64> {
        let square = |datum: &Datum| {
            let reflection = match datum.kind {
                Kind::Dolp => Reflection { dolp: dolp[datum.point], ..Reflection::default() },
                Kind::Brdf | Kind::LogBrdf => Reflection { brdf: brdf[datum.point], ..Reflection::default() },
            };
            let (residual, _) = self.loss(datum, self.residual(datum, &reflection));
            residual * residual
        };
        (!self.is_empty()).then(|| self.data.iter().map(square).sum())
    }

    /// Whether the sum of squared residuals is ΔE of Eq. (18).
    #[must_use]
    pub fn minimises_delta_e(&self) -> bool {
        let absolute = !self.wanted.brdf || self.choices.brdf_residuals == BrdfResiduals::Absolute;
        absolute && self.choices.weights == Weights::None && self.choices.loss == Loss::Squared
    }

    /// ΔE of Eq. (18), given the sum of squared residuals: the same number wherever that is what is minimised.
    #[must_use]
    pub fn objective(&self, sum_of_squares: f64, parameters: &Parameters) -> f64 {
        if self.minimises_delta_e() { sum_of_squares } else { self.delta_e(parameters).unwrap_or(sum_of_squares) }
    }

    /// ΔE of Eq. (18) at those parameters: of DoLP if measured, else of BRDF; with both, the sum.
    #[must_use]
    pub fn delta_e(&self, parameters: &Parameters) -> Option<f64> {
        let surface = Pbrdf::new(self.model, *parameters).ok()?;
        let mut sums = [0.0; 2];
        for datum in &self.data {
            let reflection = self.scene.reflection(&surface, datum.point);
            let (index, difference) = match datum.kind {
                Kind::Dolp => (0, reflection.dolp - datum.measured),
                Kind::Brdf => (1, reflection.brdf - datum.measured),
                Kind::LogBrdf => (1, reflection.brdf - libm::exp(datum.measured)),
            };
            sums[index] += difference * difference;
        }
        let present = |j: usize| self.sums[j].filter(|&whole| whole > 0.0).map(|whole| sums[j] / whole);
        match (present(0), present(1).filter(|_| self.wanted.brdf)) {
            (Some(dolp), Some(brdf)) => Some(dolp + brdf),
            (dolp, brdf) => dolp.or(brdf),
        }
    }

    /// What the sum of squared residuals is multiplied by to give the sum of squares of the data's own differences:
    /// Σ Xm² of Eq. (18) where one quantity alone is fitted without weights, 1 otherwise.
    #[must_use]
    pub fn sum_of_squares_scale(&self) -> f64 {
        match (self.choices.weights, self.wanted.dolp, self.wanted.brdf) {
            (Weights::None, true, false) => self.sums[0].filter(|&sum| sum > 0.0).unwrap_or(1.0),
            (Weights::None, false, true) => {
                if self.choices.brdf_residuals == BrdfResiduals::Absolute {
                    self.sums[1].filter(|&sum| sum > 0.0).unwrap_or(1.0)
                } else {
                    #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
                    let count = self.len() as f64;
                    count.max(1.0)
                }
            }
            _ => 1.0,
        }
    }

    /// Places in the scene with their measured DoLP, evenly picked where there are more than `most`, zeros too.
    pub(crate) fn dolp_rows(&self, most: usize) -> Vec<(usize, f64)> {
        let dolp = || self.data.iter().filter(|datum| datum.kind == Kind::Dolp);
        let step = dolp().count().div_ceil(most).max(1);
        dolp().step_by(step).map(|datum| (datum.point, datum.measured)).collect()
    }

    /// Whether k_s, k_d and k_v enter by their ratios alone: DoLP is all there is, by the consistent formula.
    #[must_use]
    pub fn knows_only_ratios(&self) -> bool {
        !self.wanted.brdf && self.model.dolp_formula == DolpFormula::Consistent
    }
}

/// Derivative of what is predicted by a parameter.
fn derivative(kind: Kind, parameter: Parameter, (reflection, gradient): &(Reflection, Gradient)) -> f64 {
    let j = parameter as usize;
    match kind {
        Kind::Dolp => gradient.dolp[j],
        Kind::Brdf => gradient.brdf[j],
        Kind::LogBrdf => gradient.brdf[j] / reflection.brdf,
    }
}

/// The parameters that a fit changes unless told otherwise: all of the model, but with DoLP alone k_s stays (only ratios of
/// weights enter the consistent formula), and so do those that DoLP does not depend on.
#[must_use]
pub fn free_by_default(model: Model, measurement: &Measurement, choices: &FitOptions) -> ParameterSet {
    if measurement.has_brdf() && !choices.dolp_only {
        return model.parameters();
    }
    let set = model.dolp_parameters();
    match model.dolp_formula {
        DolpFormula::Consistent => set.without(Parameter::Ks),
        DolpFormula::AsPrinted => set,
    }
}
