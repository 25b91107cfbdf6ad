//! What a joint fit minimises: the sum of squares over the rows of all measurements.

use crate::fit::intervals::linear::Uncertainty;
use crate::fit::joint::unknown::JointUnknown;
use crate::fit::loss::robust_scale;
use crate::fit::objective::{JacobianPlace, Problem};
use crate::fit::observations::delta_e;
use crate::fit::options::{BrdfResiduals, FitOptions, Weights};
use crate::fit::ties::apply_ties;
use crate::model::{Model, Parameter, ParameterSet, Parameters};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;
use std::sync::Arc;

/// Several measurements under one model, with shared and own parameters.
///
/// A measurement's own parameters stand side by side among the unknowns, in the order of the measurements; the shared ones follow.
#[derive(Debug, Clone)]
pub struct JointProblem {
    /// Each measurement by itself, scaled for Eq. (18) over all rows.
    parts: Vec<Problem>,
    names: Vec<Arc<str>>,
    unknowns: Vec<JointUnknown>,
    /// Of each measurement, the unknown of each of its free parameters.
    places: Vec<Vec<usize>>,
    /// Of each unknown, the first measurement that it plays a part in, and its place among the free parameters there.
    homes: Vec<(usize, usize)>,
    /// Where each measurement's residuals stand.
    rows: Vec<Range<usize>>,
    own: ParameterSet,
    start: Vec<Parameters>,
    further_starts: Arc<[Vec<Parameters>]>,
    /// Of each unknown, see [`Self::weight_exponent`].
    exponents: Vec<i32>,
}

impl JointProblem {
    /// Of problems of the same model and options, one for each measurement, that agree in what is shared: the free parameters, their starts and
    /// bounds. The squared residuals of each count so many times as its weight says, which is above 0: for all weights alike nothing changes.
    pub(crate) fn new(mut parts: Vec<Problem>, names: &[Arc<str>], own: ParameterSet, weights: &[f64]) -> Self {
        Problem::normalise_together(&mut parts);
        #[expect(clippy::cast_precision_loss, reason = "numbers of residuals")]
        let counts = || parts.iter().map(|part| part.len() as f64);
        let mean = counts().zip(weights).map(|(count, weight)| count * weight).sum::<f64>() / counts().sum::<f64>().max(1.0);
        let are_alike = weights.iter().all(|weight| *weight == weights[0]);
        if !are_alike && mean > 0.0 {
            parts = parts.iter().zip(weights).map(|(part, weight)| part.emphasised(weight / mean)).collect();
        }
        Self::of_scaled(parts, names, own)
    }

    /// Of problems that are scaled.
    fn of_scaled(parts: Vec<Problem>, names: &[Arc<str>], own: ParameterSet) -> Self {
        let mut unknowns = Vec::new();
        for (part, name) in parts.iter().zip(names) {
            let of_part = part.free().iter().filter(|&&parameter| own.contains(parameter));
            unknowns.extend(of_part.map(|&parameter| JointUnknown { parameter, set: Some(name.clone()) }));
        }
        let shared = parts.iter().flat_map(|part| part.free().iter().copied()).filter(|&parameter| !own.contains(parameter));
        let shared: ParameterSet = shared.collect();
        unknowns.extend(shared.iter().map(|parameter| JointUnknown { parameter, set: None }));
        let place = |name: &Arc<str>, parameter: Parameter| {
            let is_it = |unknown: &JointUnknown| unknown.parameter == parameter && unknown.set.as_ref().is_none_or(|set| set == name);
            unknowns.iter().position(is_it)
        };
        let places_of = |(part, name): (&Problem, &Arc<str>)| part.free().iter().filter_map(|&parameter| place(name, parameter)).collect();
        let mut end = 0;
        let rows = parts.iter().map(|part| {
            let first = end;
            end += part.len();
            first..end
        });
        let places: Vec<Vec<usize>> = parts.iter().zip(names).map(places_of).collect();
        let home = |unknown: usize| {
            let place = |(part, places): (usize, &Vec<usize>)| Some((part, places.iter().position(|&place| place == unknown)?));
            places.iter().enumerate().find_map(place).unwrap_or((0, 0))
        };
        let homes = (0..unknowns.len()).map(home).collect();
        let mut problem = Self {
            rows: rows.collect(),
            places,
            start: parts.iter().map(|part| *part.start()).collect(),
            further_starts: Arc::default(),
            names: names.to_vec(),
            exponents: Vec::new(),
            homes,
            unknowns,
            own,
            parts,
        };
        problem.exponents = (0..problem.unknowns.len()).map(|unknown| problem.coupling(unknown)).collect();
        problem
    }

    /// Exponent e such that weight·(σ²/h)^e is held constant when σ or q moves; 0 for unknowns that are not coupled.
    pub(crate) fn weight_exponent(&self, unknown: usize) -> i32 {
        self.exponents[unknown]
    }

    /// The measurements by themselves; their sums of squares add up to that of the joint fit.
    #[must_use]
    pub fn parts(&self) -> &[Problem] {
        &self.parts
    }

    /// What the measurements are called.
    #[must_use]
    pub fn set_names(&self) -> &[Arc<str>] {
        &self.names
    }

    /// The unknowns, in their order.
    #[must_use]
    pub fn unknowns(&self) -> &[JointUnknown] {
        &self.unknowns
    }

    /// The parameters that each measurement has for itself.
    #[must_use]
    pub fn own(&self) -> ParameterSet {
        self.own
    }

    /// Where the fit begins, for each measurement.
    #[must_use]
    pub fn start(&self) -> &[Parameters] {
        &self.start
    }

    pub(crate) fn start_list(&self) -> &Vec<Parameters> {
        &self.start
    }

    /// Which terms there are.
    #[must_use]
    pub fn model(&self) -> Model {
        self.parts[0].model()
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &FitOptions {
        self.parts[0].options()
    }

    /// Number of residuals.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.last().map_or(0, |rows| rows.end)
    }

    /// Whether there is nothing to fit.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where a measurement's residuals stand, measurement after measurement.
    pub(crate) fn rows(&self) -> &[Range<usize>] {
        &self.rows
    }

    /// Of each measurement, the unknown of each of its free parameters.
    pub(crate) fn places(&self) -> &[Vec<usize>] {
        &self.places
    }

    /// The first measurement that an unknown plays a part in, and its place among the free parameters there.
    pub(crate) fn home(&self, unknown: usize) -> (usize, usize) {
        self.homes[unknown]
    }

    /// The measurement that has an unknown for itself; none where all share it.
    pub(crate) fn set_of(&self, unknown: usize) -> Option<usize> {
        self.unknowns[unknown].set.is_some().then(|| self.home(unknown).0)
    }

    fn with_parts(&self, change: impl Fn(&Problem) -> Problem) -> Self {
        Self { parts: self.parts.iter().map(change).collect(), ..self.clone() }
    }

    /// The same problem with each measurement's changed, its start too.
    pub(crate) fn changed<E>(&self, change: impl Fn(usize, &Problem) -> Result<Problem, E>) -> Result<Self, E> {
        let started = self.parts.iter().zip(&self.start).map(|(part, start)| part.with_start(*start)).enumerate();
        let parts: Vec<Problem> = started.map(|(index, part)| change(index, &part)).collect::<Result<_, _>>()?;
        Ok(Self { start: parts.iter().map(|part| *part.start()).collect(), parts, ..self.clone() })
    }

    /// The same problem from another start.
    #[must_use]
    pub fn with_start(&self, start: &[Parameters]) -> Self {
        Self { start: start.to_vec(), ..self.clone() }
    }

    /// The same problem whose search begins at those points too, and ends above none of them; what is fixed stays as at its start, shared
    /// values are those of the first measurement that has them, and values outside of the bounds move onto them.
    #[must_use]
    pub fn with_further_starts(&self, starts: impl IntoIterator<Item = Vec<Parameters>>) -> Self {
        let within = |point: Vec<Parameters>| {
            let clamped = |(part, parameters): (&Problem, Parameters)| {
                part.free().iter().fold(parameters, |mut within, &parameter| {
                    within[parameter] = part.bounds().clamp(parameter, parameters[parameter]);
                    within
                })
            };
            let point: Vec<Parameters> = self.parts.iter().zip(point).map(clamped).collect();
            self.parameters_of(&self.unknowns_at(&point))
        };
        Self { further_starts: starts.into_iter().map(within).collect(), ..self.clone() }
    }

    /// Where its search begins too.
    #[must_use]
    pub fn further_starts(&self) -> &[Vec<Parameters>] {
        &self.further_starts
    }

    /// The same problem with those parameters free, of those that may be.
    #[must_use]
    pub(crate) fn with_free(&self, free: ParameterSet) -> Self {
        let part = |(part, start): (&Problem, &Parameters)| {
            let had: ParameterSet = part.free().iter().copied().collect();
            part.with_start(*start).with_free(had.intersection(free))
        };
        Self::of_scaled(self.parts.iter().zip(&self.start).map(part).collect(), &self.names, self.own)
    }

    /// The same problem with other data: of each measurement the values at the start plus residuals drawn from its own, since noise may
    /// differ between measurements.
    pub(crate) fn resampled(&self, widen: f64, pick: &mut dyn FnMut(usize) -> usize) -> Self {
        let parts = self.parts.iter().zip(&self.start).map(|(part, start)| part.with_start(*start).resampled(widen, pick)).collect();
        Self { parts, ..self.clone() }
    }

    /// The parameters of each measurement, given the unknowns.
    pub(crate) fn parameters_of(&self, x: &DVector<f64>) -> Vec<Parameters> {
        let of_part = |((part, places), start): ((&Problem, &Vec<usize>), &Parameters)| {
            let mut parameters = *start;
            for (&parameter, &place) in part.free().iter().zip(places) {
                parameters[parameter] = parameter.domain().flush_to_zero(x[place]);
            }
            apply_ties(part.ties(), parameters)
        };
        self.parts.iter().zip(&self.places).zip(&self.start).map(of_part).collect()
    }

    /// The unknowns at those parameters; of a shared one, that of the first measurement counts.
    pub(crate) fn unknowns_at(&self, point: &[Parameters]) -> DVector<f64> {
        DVector::from_fn(self.unknowns.len(), |unknown, _| point[self.home(unknown).0][self.unknowns[unknown].parameter])
    }

    /// The unknowns at those parameters, in the order of [`Self::unknowns`]; of a shared one, that of the first measurement counts.
    #[must_use]
    pub fn values_at(&self, point: &[Parameters]) -> Vec<f64> {
        self.unknowns_at(point).as_slice().to_vec()
    }

    /// The parameters of each measurement, given as many values as there are unknowns; all others as at the start.
    #[must_use]
    pub fn point_with(&self, values: &[f64]) -> Vec<Parameters> {
        self.parameters_of(&DVector::from_column_slice(values))
    }

    /// Sum of the squares of the residuals; none without data and where it is not finite.
    #[must_use]
    pub fn sum_of_squares(&self, point: &[Parameters]) -> Option<f64> {
        let mut residuals = DVector::zeros(self.len());
        (!self.is_empty() && self.write_residuals(point, &mut residuals)).then(|| residuals.norm_squared())
    }

    /// Writes the residuals; false where parameters are no surface or a residual is not finite.
    pub(crate) fn write_residuals(&self, point: &[Parameters], out: &mut DVector<f64>) -> bool {
        let out = out.as_mut_slice();
        let mut finite = true;
        for ((part, rows), parameters) in self.parts.iter().zip(&self.rows).zip(point) {
            finite = finite && part.write_residuals(parameters, &mut out[rows.clone()]);
        }
        finite
    }

    /// Writes the Jacobian; false where an element is not finite.
    pub(crate) fn write_jacobian(&self, point: &[Parameters], out: &mut DMatrix<f64>) -> bool {
        out.fill(0.0);
        let mut finite = true;
        for (((part, rows), places), parameters) in self.parts.iter().zip(&self.rows).zip(&self.places).zip(point) {
            let place = JacobianPlace { first_row: rows.start, column: &|j| places[j] };
            finite = finite && part.write_jacobian(parameters, &place, out);
        }
        finite
    }

    /// Whether any DoLP and any BRDF is compared.
    pub(crate) fn has(&self) -> [bool; 2] {
        let any = |has: fn(&Problem) -> bool| self.parts.iter().any(has);
        [any(|part| part.observations().has_dolp()), any(|part| part.observations().has_brdf())]
    }

    /// Σ Xm² of DoLP (0) or BRDF (1) over all rows, where it is above 0.
    fn square_sum(&self, block: usize) -> Option<f64> {
        let sum: f64 = self.parts.iter().filter_map(|part| part.observations().square_sum(block)).sum();
        Some(sum).filter(|&sum| sum > 0.0)
    }

    /// Whether k_s, k_d and k_v enter by their ratios alone: DoLP by the consistent formula is all there is.
    #[must_use]
    pub fn knows_only_ratios(&self) -> bool {
        self.parts.iter().all(Problem::knows_only_ratios)
    }

    /// ΔE of Eq. (18) over all rows: of DoLP if measured, else of BRDF; with both, the sum.
    #[must_use]
    pub fn delta_e(&self, point: &[Parameters]) -> Option<f64> {
        let mut sums = [0.0; 2];
        for (part, parameters) in self.parts.iter().zip(point) {
            let of_part = part.misfit_sums(parameters)?;
            (0..2).for_each(|block| sums[block] += of_part[block]);
        }
        delta_e(sums, [self.square_sum(0), self.square_sum(1).filter(|_| self.has()[1])])
    }

    /// What the data determine at that point, and how well, if the noise is as large as the misfit there or as stated; none without data and
    /// where a residual is not finite.
    #[must_use]
    pub fn uncertainty_at(&self, point: &[Parameters]) -> Option<Uncertainty<JointUnknown>> {
        let sum_of_squares = self.sum_of_squares(point)?;
        Some(Uncertainty::of_unknowns(&self.with_start(point), &self.unknowns_at(point), sum_of_squares, &[]))
    }

    /// What the sum of squares is multiplied by to give the residual sum of squares in the unit of the data.
    pub(crate) fn rss_scale(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
        let count = self.len() as f64;
        let options = self.options();
        match (options.weights, self.has()) {
            (Weights::None, [true, false]) => self.square_sum(0).unwrap_or(1.0),
            (Weights::None, [false, true]) if options.brdf_residuals == BrdfResiduals::Absolute => self.square_sum(1).unwrap_or(1.0),
            (Weights::None, [false, true]) => count.max(1.0),
            _ => 1.0,
        }
    }

    /// Whether the sum of squares is ΔE of Eq. (18).
    pub(crate) fn minimises_delta_e(&self) -> bool {
        self.parts.iter().all(Problem::minimises_delta_e)
    }

    pub(crate) fn block_sums(&self, point: &[Parameters]) -> [(f64, usize); 2] {
        let mut sums = [(0.0, 0); 2];
        for (part, parameters) in self.parts.iter().zip(point) {
            for (sum, of_part) in sums.iter_mut().zip(part.block_sums(parameters)) {
                *sum = (sum.0 + of_part.0, sum.1 + of_part.1);
            }
        }
        sums
    }

    pub(crate) fn with_squared_loss(&self) -> Self {
        self.with_parts(Problem::with_squared_loss)
    }

    /// The same problem with those scales of the loss for DoLP and BRDF.
    #[must_use]
    pub fn with_loss_scales(&self, loss_scales: [f64; 2]) -> Self {
        self.with_parts(|part| part.with_loss_scales(loss_scales))
    }

    /// The same problem with the residuals of DoLP and BRDF multiplied by those numbers.
    #[must_use]
    pub fn with_block_weights(&self, block_weights: [f64; 2]) -> Self {
        self.with_parts(|part| part.with_block_weights(block_weights))
    }

    pub(crate) fn with_loss_scale_of(&self, point: &[Parameters]) -> Self {
        let mut blocks = [Vec::new(), Vec::new()];
        let squared = self.with_squared_loss();
        for (part, parameters) in squared.parts.iter().zip(point) {
            let mut residuals = DVector::zeros(part.len());
            part.residuals(parameters, &mut residuals);
            let of_part = part.observations().by_block(residuals.as_slice());
            blocks.iter_mut().zip(of_part).for_each(|(block, of_part)| block.extend(of_part));
        }
        self.with_loss_scales(blocks.map(robust_scale))
    }

    /// About so many residuals, of each measurement in proportion.
    pub(crate) fn thinned(&self, most: usize) -> Self {
        let all = self.len().max(1);
        let mut thinned = self.with_parts(|part| part.thinned((most * part.len()).div_ceil(all)));
        let mut end = 0;
        for (rows, part) in thinned.rows.iter_mut().zip(&thinned.parts) {
            *rows = end..end + part.len();
            end = rows.end;
        }
        thinned
    }

    /// The predicted DoLP or BRDF of each residual; none where parameters are no surface or a value is not finite.
    pub(crate) fn predictions(&self, point: &[Parameters]) -> Option<Vec<f64>> {
        let mut all = Vec::with_capacity(self.len());
        for (part, parameters) in self.parts.iter().zip(point) {
            all.extend(part.predictions(parameters)?);
        }
        Some(all)
    }

    /// Whether what is minimised falls apart into the sums of squares of several measurements.
    pub(crate) fn is_separable(&self) -> bool {
        self.parts.len() > 1 && self.unknowns.iter().all(|unknown| unknown.set.is_some())
    }

    /// Each measurement by itself, scaled as here.
    pub(crate) fn split(&self) -> Vec<Self> {
        let alone = |(place, ((part, name), start)): (usize, ((&Problem, &Arc<str>), &Parameters))| {
            let problem = Self::of_scaled(vec![part.with_start(*start)], std::slice::from_ref(name), self.own);
            problem.with_further_starts(self.further_starts.iter().map(|point| vec![point[place]]))
        };
        self.parts.iter().zip(&self.names).zip(&self.start).enumerate().map(alone).collect()
    }
}
