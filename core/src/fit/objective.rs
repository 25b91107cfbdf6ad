//! What is minimised: the sum of squares of the residuals of a measurement under a model, and the derivatives of the residuals.
//!
//! What a residual is, and its scale in Eq. (18), is said at [`crate::fit::observations`]; how it counts at [`crate::fit::loss`].

use crate::fit::bounds::Bounds;
use crate::fit::loss::robust_scale;
use crate::fit::observations::{Datum, Kind, Observations};
use crate::fit::options::{FitOptions, Loss};
use crate::fit::problem_error::ProblemError;
use crate::fit::ties::{Tie, apply_ties};
use crate::measurement::Measurement;
use crate::model::batch::surface_row::{MeasuredDolp, dolp_misfits};
use crate::model::{DolpFormula, GeometrySet, Model, Parameter, ParameterSet, Parameters, Pbrdf, PerParameter, Radiances};
use nalgebra::{DMatrix, DVector};
use std::cell::Cell;
use std::sync::Arc;

/// A measurement, a model and what may change.
///
/// The data are shared: a clone, and a problem derived by one of the `with_…` methods, copies a handful of numbers.
#[derive(Debug, Clone)]
pub struct Problem {
    model: Model,
    free: Vec<Parameter>,
    start: Parameters,
    /// Where searches begin too.
    further_starts: Arc<[Parameters]>,
    bounds: Bounds,
    options: FitOptions,
    observations: Arc<Observations>,
    /// Scale of the loss for DoLP and BRDF, in units of the residual as Eq. (18) scales it.
    loss_scales: [f64; 2],
    /// What residuals of DoLP and BRDF are multiplied by in the end: 1, or one over their own standard deviations.
    block_weights: [f64; 2],
    /// What the squares of all residuals are multiplied by, among other measurements; 1 alone.
    emphasis: f64,
    /// Each to a parameter that is tied to none.
    ties: Arc<[Tie]>,
}

/// Where the Jacobian of a problem stands in a larger one.
pub(crate) struct JacobianPlace<'a> {
    pub first_row: usize,
    /// The column of each free parameter.
    pub column: &'a dyn Fn(usize) -> usize,
}

/// Columns of predictions, used again from evaluation to evaluation on the same thread.
#[derive(Default)]
struct Columns {
    radiances: Radiances,
    /// Derivatives by the free parameters, of one quantity at a time.
    slopes: PerParameter<Vec<f64>>,
    factors: Vec<f64>,
}

thread_local! {
    static COLUMNS: Cell<Columns> = Cell::default();
}

/// Lends the columns of this thread. Where the batch kernel works on several threads, this one may turn to another evaluation while
/// it waits; that one finds empty columns.
fn with_columns<T>(use_columns: impl FnOnce(&mut Columns) -> T) -> T {
    let mut columns = COLUMNS.take();
    let value = use_columns(&mut columns);
    COLUMNS.set(columns);
    value
}

impl Problem {
    /// From the rows that are not masked. Free parameters that the model does not have are left out.
    ///
    /// # Errors
    ///
    /// [`ProblemError::StartOutsideBounds`] for a free parameter, [`ProblemError::NothingToPredict`] where the model predicts DoLP
    /// only and none is measured, [`ProblemError::MissingSigma`] where standard deviations are to weigh and one is not stated.
    pub fn new(
        measurement: &Measurement,
        model: Model,
        start: Parameters,
        free: ParameterSet,
        bounds: Bounds,
        options: FitOptions,
    ) -> Result<Self, ProblemError> {
        for parameter in free {
            if !bounds.contain(parameter, start[parameter]) {
                let (low, high) = bounds.of(parameter);
                return Err(ProblemError::StartOutsideBounds { parameter, value: start[parameter], low, high });
            }
        }
        if options.dolp_only && !measurement.has_dolp() {
            return Err(ProblemError::NothingToPredict);
        }
        let observations = Observations::new(measurement, &options)?;
        Ok(Self {
            model,
            free: free.intersection(model.parameters()).iter().collect(),
            start,
            further_starts: Arc::default(),
            bounds,
            options,
            loss_scales: observations.scales().map(|scale| options.loss_scale.unwrap_or(1.0) * scale),
            block_weights: [1.0; 2],
            observations: Arc::new(observations),
            emphasis: 1.0,
            ties: Arc::default(),
        })
    }

    /// Scales the residuals of several measurements for Eq. (18) over the union of their rows.
    pub(crate) fn normalise_together(problems: &mut [Self]) {
        let mut observations: Vec<Observations> = problems.iter().map(|problem| (*problem.observations).clone()).collect();
        if let Some(problem) = problems.first() {
            Observations::normalise_together(&mut observations, &problem.options);
        }
        for (problem, observations) in problems.iter_mut().zip(observations) {
            problem.loss_scales = observations.scales().map(|scale| problem.options.loss_scale.unwrap_or(1.0) * scale);
            problem.observations = Arc::new(observations);
        }
    }

    /// The rows of all those problems under one surface: the first one's start, bounds and choices, free what is free in any; none
    /// without problems.
    pub(crate) fn pooled(problems: &[Self]) -> Option<Self> {
        let observations: Vec<&Observations> = problems.iter().map(|problem| &*problem.observations).collect();
        let observations = Arc::new(Observations::concatenated(&observations)?);
        let free: ParameterSet = problems.iter().flat_map(|problem| problem.free.iter().copied()).collect();
        Some(Self { observations, free: free.iter().collect(), ..problems.first()?.clone() })
    }

    /// The same problem with each of its squared residuals multiplied by that number, which is above 0.
    pub(crate) fn emphasised(&self, emphasis: f64) -> Self {
        let observations = Arc::new(self.observations.emphasised(emphasis / self.emphasis));
        Self { emphasis, observations, ..self.clone() }
    }

    /// What its squared residuals are multiplied by, among other measurements; 1 alone.
    #[must_use]
    pub fn emphasis(&self) -> f64 {
        self.emphasis
    }

    /// The same problem with those ties, which its start obeys and whose parameters are not free.
    pub(crate) fn tied_by(&self, ties: Vec<Tie>) -> Self {
        Self { ties: ties.into(), ..self.clone() }
    }

    /// The ties, each to a parameter that is tied to none.
    #[must_use]
    pub fn ties(&self) -> &[Tie] {
        &self.ties
    }

    /// The surface of those parameters, tied ones as their ties have them; none where they are no surface.
    fn surface(&self, parameters: &Parameters) -> Option<Pbrdf> {
        Pbrdf::new(self.model, apply_ties(&self.ties, *parameters)).ok()
    }

    /// Σ (X − Xm)² of DoLP and of BRDF; none where the parameters are no surface.
    pub(crate) fn misfit_sums(&self, parameters: &Parameters) -> Option<[f64; 2]> {
        let surface = self.surface(parameters)?;
        with_columns(|columns| {
            self.predict(&surface, &mut columns.radiances);
            Some(self.observations.misfit_sums(&columns.radiances))
        })
    }

    /// The same problem from another start.
    #[must_use]
    pub fn with_start(&self, start: Parameters) -> Self {
        Self { start, ..self.clone() }
    }

    /// The same problem whose search begins at those parameters too, and ends above none of them; values of what is fixed are those of
    /// its start, and values outside of the bounds move onto them.
    #[must_use]
    pub fn with_further_starts(&self, starts: Vec<Parameters>) -> Self {
        let within = |further: Parameters| {
            let mut start = self.start;
            self.free.iter().for_each(|&parameter| start[parameter] = self.bounds.clamp(parameter, further[parameter]));
            start
        };
        Self { further_starts: starts.into_iter().map(within).collect(), ..self.clone() }
    }

    /// The same problem in another box, which its start must lie in.
    #[must_use]
    pub(crate) fn with_bounds(&self, bounds: Bounds) -> Self {
        Self { bounds, ..self.clone() }
    }

    /// The same problem with other parameters free.
    #[must_use]
    pub fn with_free(&self, free: ParameterSet) -> Self {
        Self { free: free.intersection(self.model.parameters()).iter().collect(), ..self.clone() }
    }

    /// The same problem with about so many of its residuals.
    #[must_use]
    pub(crate) fn thinned(&self, most: usize) -> Self {
        Self { observations: Arc::new(self.observations.thinned(most)), ..self.clone() }
    }

    /// The same problem with every residual counted by its square.
    #[must_use]
    pub fn with_squared_loss(&self) -> Self {
        Self { options: FitOptions { loss: Loss::Squared, ..self.options }, ..self.clone() }
    }

    /// The same problem with the scale of its loss taken from the residuals at those parameters, for each quantity by itself:
    /// 1.345 × their median absolute deviation over 0.6745 (Huber's 95 % efficiency for Gaussian noise).
    #[must_use]
    pub fn with_loss_scale_of(&self, parameters: &Parameters) -> Self {
        let mut residuals = DVector::zeros(self.len());
        self.with_squared_loss().residuals(parameters, &mut residuals);
        self.with_loss_scales(self.observations.by_block(residuals.as_slice()).map(robust_scale))
    }

    /// The same problem with those scales of the loss for DoLP and BRDF, in units of the scaled residual.
    #[must_use]
    pub fn with_loss_scales(&self, loss_scales: [f64; 2]) -> Self {
        Self { loss_scales, ..self.clone() }
    }

    /// The same problem with the residuals of DoLP and BRDF multiplied by those numbers: one over their standard deviations.
    #[must_use]
    pub fn with_block_weights(&self, block_weights: [f64; 2]) -> Self {
        Self { block_weights, ..self.clone() }
    }

    /// Sum of squares and number of the residuals of DoLP and of BRDF, before these are weighted against each other.
    pub(crate) fn block_sums(&self, parameters: &Parameters) -> [(f64, usize); 2] {
        let mut residuals = DVector::zeros(self.len());
        self.with_block_weights([1.0; 2]).residuals(parameters, &mut residuals);
        self.observations.by_block(residuals.as_slice()).map(|block| (block.iter().map(|residual| residual * residual).sum(), block.len()))
    }

    /// What residuals of DoLP and BRDF are multiplied by: 1, or one over their own standard deviations.
    #[must_use]
    pub fn block_weights(&self) -> [f64; 2] {
        self.block_weights
    }

    /// The same problem with other data: the values at its start plus residuals drawn from its own, within each quantity, by
    /// `pick` (an index below its argument), times a factor.
    #[must_use]
    pub fn resampled(&self, widen: f64, pick: &mut dyn FnMut(usize) -> usize) -> Self {
        let mut residuals = DVector::zeros(self.len());
        self.with_squared_loss().residuals(&self.start, &mut residuals);
        let observations = Arc::new(self.observations.resampled(residuals.as_slice(), widen, pick));
        Self { observations, ..self.clone() }
    }

    /// Scale of the loss for DoLP and BRDF, in units of the scaled residual.
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

    /// Where its search begins too.
    #[must_use]
    pub fn further_starts(&self) -> &[Parameters] {
        &self.further_starts
    }

    /// The box that the free parameters stay in.
    #[must_use]
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &FitOptions {
        &self.options
    }

    /// Number of residuals.
    #[must_use]
    pub fn len(&self) -> usize {
        self.observations.data().len()
    }

    /// Whether there is nothing to fit.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.observations.data().is_empty()
    }

    /// Number of measured values that the chosen residuals cannot use (a BRDF of 0 has no logarithm and no relative error).
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.observations.left_out()
    }

    /// The data.
    pub(crate) fn observations(&self) -> &Observations {
        &self.observations
    }

    /// The prepared geometries of the rows that are not masked.
    pub(crate) fn geometries(&self) -> &GeometrySet {
        self.observations.batch().geometries()
    }

    /// Whether the BRDF is needed.
    pub(crate) fn predicts_brdf(&self) -> bool {
        self.observations.has_brdf()
    }

    /// Whether k_s, k_d and k_v enter by their ratios alone: DoLP is all there is, by the consistent formula.
    #[must_use]
    pub fn knows_only_ratios(&self) -> bool {
        !self.predicts_brdf() && self.model.dolp_formula == DolpFormula::Consistent
    }

    /// Writes the residuals; false where the parameters are no surface or a residual is not finite.
    pub fn residuals(&self, parameters: &Parameters, out: &mut DVector<f64>) -> bool {
        self.write_residuals(parameters, out.as_mut_slice())
    }

    /// The same into a part of a longer column.
    pub(crate) fn write_residuals(&self, parameters: &Parameters, out: &mut [f64]) -> bool {
        let Some(surface) = self.surface(parameters) else { return false };
        with_columns(|columns| {
            self.predict(&surface, &mut columns.radiances);
            let mut finite = true;
            for (slot, datum) in out.iter_mut().zip(self.observations.data()) {
                let (dolp, brdf) = (&columns.radiances.dolp, &columns.radiances.brdf);
                let predicted = if datum.kind == Kind::Dolp { dolp[datum.point] } else { brdf[datum.point] };
                let block = datum.kind.block();
                *slot = self.block_weights[block] * self.options.loss.apply(datum.residual(predicted), self.loss_scales[block]).0;
                finite &= slot.is_finite();
            }
            finite
        })
    }

    /// The predicted DoLP or BRDF of each residual; none where the parameters are no surface or a value is not finite.
    pub(crate) fn predictions(&self, parameters: &Parameters) -> Option<Vec<f64>> {
        let surface = self.surface(parameters)?;
        with_columns(|Columns { radiances, .. }| {
            self.predict(&surface, radiances);
            let value = |datum: &Datum| if datum.kind == Kind::Dolp { radiances.dolp[datum.point] } else { radiances.brdf[datum.point] };
            let values: Vec<f64> = self.observations.data().iter().map(value).collect();
            values.iter().all(|value| value.is_finite()).then_some(values)
        })
    }

    /// The scale of the loss of each residual.
    pub(crate) fn loss_scales_of_rows(&self) -> Vec<f64> {
        self.observations.data().iter().map(|datum| self.loss_scales[datum.kind.block()]).collect()
    }

    /// Writes DoLP and BRDF of each geometry, those that are measured.
    fn predict(&self, surface: &Pbrdf, out: &mut Radiances) {
        let batch = self.observations.batch();
        match (self.observations.has_dolp(), self.observations.has_brdf()) {
            (true, true) => batch.radiances(surface, out),
            (false, true) => batch.brdf(surface, &mut out.brdf),
            _ => batch.dolp(surface, &mut out.dolp),
        }
    }

    /// Writes the Jacobian of the residuals by the free parameters; false where an element is not finite.
    pub fn jacobian(&self, parameters: &Parameters, out: &mut DMatrix<f64>) -> bool {
        self.write_jacobian(parameters, &JacobianPlace { first_row: 0, column: &|j| j }, out)
    }

    /// The same into some rows and columns of a larger matrix.
    pub(crate) fn write_jacobian(&self, parameters: &Parameters, place: &JacobianPlace<'_>, out: &mut DMatrix<f64>) -> bool {
        let Some(surface) = self.surface(parameters) else { return false };
        with_columns(|columns| {
            let mut finite = true;
            for (block, is_measured) in [self.observations.has_dolp(), self.observations.has_brdf()].into_iter().enumerate() {
                if is_measured {
                    finite &= self.jacobian_of_block(&surface, block, columns, place, out);
                }
            }
            finite
        })
    }

    /// Writes the rows of DoLP (0) or BRDF (1).
    fn jacobian_of_block(
        &self,
        surface: &Pbrdf,
        block: usize,
        columns: &mut Columns,
        place: &JacobianPlace<'_>,
        out: &mut DMatrix<f64>,
    ) -> bool {
        let Columns { radiances, slopes, factors } = columns;
        let batch = self.observations.batch();
        let value = if block == 0 { &mut radiances.dolp } else { &mut radiances.brdf };
        value.resize(batch.len(), 0.0);
        for parameter in Parameter::ALL {
            let is_tied = self.ties.iter().any(|tie| tie.parameter == parameter && self.free.contains(&tie.to));
            slopes[parameter].resize(if is_tied || self.free.contains(&parameter) { batch.len() } else { 0 }, 0.0);
        }
        let by = PerParameter(slopes.0.each_mut().map(Vec::as_mut_slice));
        if block == 0 {
            batch.dolp_gradient_columns(surface, value, by);
        } else {
            batch.brdf_gradient_columns(surface, value, by);
        }
        for tie in self.ties.iter().filter(|tie| self.free.contains(&tie.to)) {
            let along = std::mem::take(&mut slopes[tie.parameter]);
            slopes[tie.to].iter_mut().zip(&along).for_each(|(slope, along)| *slope += tie.factor * along);
            slopes[tie.parameter] = along;
        }
        let members = || self.observations.data().iter().enumerate().filter(|(_, datum)| datum.kind.block() == block);
        let factor = |(_, datum): (usize, &Datum)| {
            let slope = self.options.loss.apply(datum.residual(value[datum.point]), self.loss_scales[block]).1;
            self.block_weights[block] * slope * datum.slope(value[datum.point])
        };
        factors.clear();
        factors.extend(members().map(factor));
        let mut finite = true;
        for (j, &parameter) in self.free.iter().enumerate() {
            let (mut column, slopes) = (out.column_mut((place.column)(j)), &slopes[parameter]);
            for ((i, datum), factor) in members().zip(factors.iter()) {
                let slot = &mut column[place.first_row + i];
                *slot = factor * slopes[datum.point];
                finite &= slot.is_finite();
            }
        }
        finite
    }

    /// Residuals and Jacobian; none where an element of either is not finite.
    #[must_use]
    pub fn linearised(&self, parameters: &Parameters) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let mut residuals = DVector::zeros(self.len());
        let mut jacobian = DMatrix::zeros(self.len(), self.free.len());
        (self.residuals(parameters, &mut residuals) && self.jacobian(parameters, &mut jacobian)).then_some((residuals, jacobian))
    }

    /// Sum of the squares of the residuals that are minimised, in the units of Eq. (18) or of the standard deviations. None without
    /// data and where it is not finite.
    #[must_use]
    pub fn sum_of_squares(&self, parameters: &Parameters) -> Option<f64> {
        let mut residuals = DVector::zeros(self.len());
        (!self.is_empty() && self.residuals(parameters, &mut residuals)).then(|| residuals.norm_squared())
    }

    /// The sum of squares at those parameters with one of them at each of the values; NaN where it is not finite or the parameters are no
    /// surface.
    pub(crate) fn sums_of_squares_along(&self, parameters: &Parameters, along: Parameter, values: &[f64]) -> Vec<f64> {
        let fast = || {
            let is_plain = self.ties.is_empty() && !self.observations.has_brdf() && self.options.loss == Loss::Squared && !self.is_empty();
            if !is_plain {
                return None;
            }
            let facets = self.observations.batch().facets();
            let measured = |datum: &Datum| MeasuredDolp {
                facet: &facets[datum.point],
                measured: datum.measured,
                weight: self.block_weights[0] * datum.weight,
            };
            let data: Vec<MeasuredDolp<'_>> = self.observations.data().iter().map(measured).collect();
            dolp_misfits(&data, self.model, parameters, along, values)
        };
        let mut sums = fast().unwrap_or_else(|| vec![f64::NAN; values.len()]);
        for (sum, &value) in sums.iter_mut().zip(values).filter(|(sum, _)| !sum.is_finite()) {
            let mut there = *parameters;
            there[along] = value;
            *sum = self.sum_of_squares(&there).unwrap_or(f64::NAN);
        }
        sums
    }

    /// ΔE of Eq. (18) at those parameters: of DoLP if measured, else of BRDF; with both, the sum.
    #[must_use]
    pub fn delta_e(&self, parameters: &Parameters) -> Option<f64> {
        let surface = self.surface(parameters)?;
        with_columns(|columns| {
            self.predict(&surface, &mut columns.radiances);
            self.observations.delta_e(&columns.radiances)
        })
    }
}
