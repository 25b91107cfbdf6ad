//! What the data determine, and how well: standard errors and correlations from the Jacobian at the solution.
//!
//! J, its columns scaled to length 1, is U S Vᵀ: no unit matters. The rank is the number of singular values above 1e-8 of the largest. The
//! pseudo-inverse covariance `V S⁻² Vᵀ` is summed over those and multiplied by SS/(N − rank) or, where standard deviations were
//! stated, by 1. A parameter with a share in the null space has no standard error; the null space is described instead. A
//! parameter that changes nothing in its whole box is left out beforehand.
//!
//! Under a robust loss the covariance is the sandwich `A⁻¹ B A⁻¹` of M-estimation, A = Σ ψ′ JJᵀ and B = Σ ψ² JJᵀ (Huber, *Robust
//! Statistics*, 1981, sec. 7.6).

use crate::fit::fit_problem::{FitProblem, UnknownName};
use crate::fit::objective::Problem;
use crate::fit::options::{Loss, Weights};
use crate::model::{Parameter, ParameterSet, Parameters, PerParameter};
use nalgebra::{DMatrix, DVector, SVD};
use serde::ser::SerializeStruct as _;
use serde::{Serialize, Serializer};
use std::fmt;

/// Singular values below this fraction of the largest count as 0.
pub const RANK_THRESHOLD: f64 = 1e-8;
/// Relative change of a value by which a parameter that crosses its whole box has an effect.
const EFFECT: f64 = 1e-10;
/// Size below which a change of a parameter is taken relative to this size.
const SMALLEST_SIZE: f64 = 1e-3;
/// Share in an undetermined direction from which a parameter is undetermined.
const UNDETERMINED_SHARE: f64 = 1e-3;

/// Why the data do not determine a direction in parameter space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UndeterminedReason {
    /// The direction is one parameter, and no residual depends on it.
    NoEffect,
    /// The direction scales the weights k_s, k_d, k_v together; DoLP depends on their ratios alone.
    RatiosOnly,
    /// The residuals depend on combinations of the parameters, not on each.
    TradeOff,
}

/// A direction in parameter space that the data do not determine.
///
/// `Display` says it in English. As JSON it has the keys `text` and `direction`.
#[derive(Debug, Clone, PartialEq)]
pub struct UndeterminedDirection<N = Parameter> {
    /// Why.
    pub reason: UndeterminedReason,
    /// Relative change of each parameter along it, the largest 1, shares below 1e-3 left out.
    pub direction: Vec<(N, f64)>,
}

impl<N: UnknownName> UndeterminedDirection<N> {
    fn new(direction: Vec<(N, f64)>, knows_only_ratios: bool) -> Self {
        let weights = [Parameter::Ks, Parameter::Kd, Parameter::Kv];
        let reason = match direction[..] {
            [_] => UndeterminedReason::NoEffect,
            _ if knows_only_ratios && direction.iter().all(|(name, _)| weights.contains(&name.parameter())) => {
                UndeterminedReason::RatiosOnly
            }
            _ => UndeterminedReason::TradeOff,
        };
        Self { reason, direction }
    }

    /// Symbols of the parameters along it, with commas between them.
    #[must_use]
    pub fn symbols(&self) -> String {
        self.direction.iter().map(|(name, _)| name.symbol()).collect::<Vec<_>>().join(", ")
    }
}

impl<N: UnknownName> fmt::Display for UndeterminedDirection<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let symbols = self.symbols();
        match (self.reason, &self.direction[..]) {
            (UndeterminedReason::NoEffect, _) => write!(f, "{symbols} has no effect on these data"),
            (UndeterminedReason::RatiosOnly, _) => write!(f, "{symbols} together: only their ratios enter DoLP"),
            (UndeterminedReason::TradeOff, [(one, _), (other, _)]) => {
                write!(f, "{} and {} trade off: these data fix a combination of them, not each", one.symbol(), other.symbol())
            }
            (UndeterminedReason::TradeOff, _) => write!(f, "{symbols} together: these data fix combinations of them, not each"),
        }
    }
}

impl<N: UnknownName> Serialize for UndeterminedDirection<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("UndeterminedDirection", 2)?;
        object.serialize_field("text", &self.to_string())?;
        object.serialize_field("direction", &ByKey(&self.direction))?;
        object.end()
    }
}

/// Numbers of parameters as an object with the parameters' keys.
struct ByKey<'a, N>(&'a [(N, f64)]);

impl<N: UnknownName> Serialize for ByKey<'_, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, number)| (name.key(), number)))
    }
}

/// Standard errors, correlations and undetermined directions at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty<N = Parameter> {
    /// Number of directions that the data determine.
    pub rank: usize,
    /// Largest over smallest counted singular value of the scaled Jacobian; none without a counted one.
    pub condition: Option<f64>,
    /// The parameters with a standard error.
    pub determined: Vec<N>,
    /// Covariance of those.
    pub covariance: DMatrix<f64>,
    /// The directions that the data do not determine.
    pub undetermined: Vec<UndeterminedDirection<N>>,
    /// The parameters that took part: the free ones that do not rest on a bound.
    pub(crate) analysed: Vec<N>,
    /// Pseudo-inverse covariance of all of those.
    spread: DMatrix<f64>,
    /// The undetermined directions as orthonormal rows, in units of the scales.
    null_space: DMatrix<f64>,
    /// One over the length of each one's column of the Jacobian.
    scales: Vec<f64>,
    /// Of each, the variance under a robust loss over the one that the loss alone suggests.
    inflation: Vec<f64>,
}

impl Uncertainty {
    /// At those parameters, for the free ones among them that do not rest on a bound.
    ///
    /// `sum_of_squares` is that of the problem's own residuals.
    #[must_use]
    pub fn at(problem: &Problem, parameters: &Parameters, sum_of_squares: f64, at_bound: ParameterSet) -> Self {
        let problem = problem.with_start(*parameters);
        let at_bound: Vec<usize> = (0..problem.free().len()).filter(|&j| at_bound.contains(problem.free()[j])).collect();
        Self::of_unknowns(&problem, &problem.unknowns_of(parameters), sum_of_squares, &at_bound)
    }

    /// Standard error of a prediction with that gradient, `√(gᵀ C g)`; none where the gradient has a share in an open
    /// direction, or where the covariance is unknown.
    #[must_use]
    pub fn error_of_prediction(&self, gradient: &PerParameter<f64>) -> Option<f64> {
        let g = DVector::from_iterator(self.analysed.len(), self.analysed.iter().map(|&parameter| gradient[parameter]));
        self.error_along(&g)
    }

    /// Standard error of a parameter, in its own unit; none if it is fixed, at a bound, undetermined, or no degree of freedom is left.
    #[must_use]
    pub fn standard_error(&self, parameter: Parameter) -> Option<f64> {
        self.error_of(&parameter)
    }
}

impl<N: UnknownName> Uncertainty<N> {
    /// At those unknowns, for those that do not rest on a bound.
    pub(crate) fn of_unknowns<P: FitProblem<Name = N>>(problem: &P, x: &DVector<f64>, sum_of_squares: f64, at_bound: &[usize]) -> Self {
        let inner = (0..x.len()).filter(|j| !at_bound.contains(j));
        let (moving, idle): (Vec<usize>, Vec<usize>) = inner.partition(|&j| has_effect(problem, x, j));
        let mut uncertainty = Self::of_moving(problem, x, sum_of_squares, &moving);
        let alone = |j: &usize| UndeterminedDirection::new(vec![(problem.names()[*j].clone(), 1.0)], false);
        uncertainty.undetermined.extend(idle.iter().map(alone));
        uncertainty
    }

    /// Of unknowns that each have an effect.
    fn of_moving<P: FitProblem<Name = N>>(problem: &P, x: &DVector<f64>, sum_of_squares: f64, moving: &[usize]) -> Self {
        let free: Vec<N> = moving.iter().map(|&j| problem.names()[j].clone()).collect();
        let (rows, columns) = (problem.residual_count(), free.len());
        if columns == 0 || rows == 0 {
            return Self::nothing(&free);
        }
        let Some((jacobian, meat)) = information(problem, x, moving) else { return Self::nothing(&free) };
        let scales: Vec<f64> = jacobian.column_iter().map(|column| 1.0 / column.norm()).collect();
        // A column without an effect in f64 stays one of zeros.
        let scales: Vec<f64> = scales.into_iter().map(|scale| if scale.is_finite() { scale } else { 0.0 }).collect();
        // Rows of zeros make a wide matrix square, so that the thin decomposition has all of V.
        let scaled = DMatrix::from_fn(rows.max(columns), columns, |i, j| if i < rows { jacobian[(i, j)] * scales[j] } else { 0.0 });
        // The decomposition of a matrix that is not finite does not terminate.
        if scaled.iter().any(|element| !element.is_finite()) {
            return Self::nothing(&free);
        }
        let svd = SVD::new(scaled, false, true);
        let Some(v_t) = svd.v_t else { return Self::nothing(&free) };
        let largest = svd.singular_values.max();
        let counted: Vec<usize> = (0..columns).filter(|&i| svd.singular_values[i] > RANK_THRESHOLD * largest && largest > 0.0).collect();
        let left: Vec<usize> = (0..columns).filter(|i| !counted.contains(i)).collect();

        let share = |j: usize| left.iter().map(|&i| v_t[(i, j)] * v_t[(i, j)]).sum::<f64>().sqrt();
        let kept: Vec<usize> = (0..columns).filter(|&j| share(j) < UNDETERMINED_SHARE).collect();
        let inverse = DMatrix::from_fn(columns, columns, |a, b| {
            let sum: f64 = counted.iter().map(|&i| v_t[(i, a)] * v_t[(i, b)] / (svd.singular_values[i] * svd.singular_values[i])).sum();
            scales[a] * scales[b] * sum
        });
        let plain = &inverse * variance_of_unit_weight(problem, sum_of_squares, counted.len());
        let spread = meat.map_or_else(|| plain.clone(), |meat| &inverse * (meat * small_sample(problem, counted.len())) * &inverse);
        let covariance = DMatrix::from_fn(kept.len(), kept.len(), |a, b| spread[(kept[a], kept[b])]);
        let smallest = counted.iter().map(|&i| svd.singular_values[i]).fold(f64::INFINITY, f64::min);
        let null_space = DMatrix::from_fn(left.len(), columns, |i, j| v_t[(left[i], j)]);
        let by_parameter = DMatrix::from_fn(left.len(), columns, |i, j| null_space[(i, j)] * scales[j]);
        let values: Vec<f64> = moving.iter().map(|&j| x[j]).collect();
        Self {
            rank: counted.len(),
            condition: (!counted.is_empty()).then(|| largest / smallest),
            determined: kept.iter().map(|&j| free[j].clone()).collect(),
            covariance,
            undetermined: describe(by_parameter, &values, &free, problem.knows_only_ratios()),
            inflation: (0..columns).map(|j| spread[(j, j)] / plain[(j, j)]).collect(),
            analysed: free,
            spread,
            null_space,
            scales,
        }
    }

    /// Of those unknowns that get a parameter: what the data say of one surface among several.
    pub(crate) fn restricted(&self, parameter: impl Fn(&N) -> Option<Parameter>) -> Uncertainty {
        let named = |names: &[N]| -> (Vec<usize>, Vec<Parameter>) {
            names.iter().enumerate().filter_map(|(j, name)| Some((j, parameter(name)?))).unzip()
        };
        let (kept, analysed) = named(&self.analysed);
        let (kept_determined, determined) = named(&self.determined);
        Uncertainty {
            rank: self.rank,
            condition: self.condition,
            determined,
            covariance: self.covariance.select_rows(&kept_determined).select_columns(&kept_determined),
            undetermined: Vec::new(),
            analysed,
            spread: self.spread.select_rows(&kept).select_columns(&kept),
            null_space: self.null_space.select_columns(&kept),
            scales: kept.iter().map(|&j| self.scales[j]).collect(),
            inflation: kept.iter().map(|&j| self.inflation[j]).collect(),
        }
    }

    /// Nothing is determined.
    fn nothing(free: &[N]) -> Self {
        let undetermined = free.iter().map(|name| UndeterminedDirection::new(vec![(name.clone(), 1.0)], false));
        let count = free.len();
        Self {
            rank: 0,
            condition: None,
            determined: Vec::new(),
            covariance: DMatrix::zeros(0, 0),
            undetermined: undetermined.collect(),
            analysed: free.to_vec(),
            spread: DMatrix::zeros(count, count),
            null_space: DMatrix::identity(count, count),
            scales: vec![1.0; count],
            inflation: vec![1.0; count],
        }
    }

    /// Standard error of a prediction, given its derivatives by the unknowns that took part.
    pub(crate) fn error_along(&self, g: &DVector<f64>) -> Option<f64> {
        let scaled = DVector::from_iterator(g.len(), g.iter().zip(&self.scales).map(|(slope, scale)| slope * scale));
        let is_open = (&self.null_space * &scaled).norm() > UNDETERMINED_SHARE * scaled.norm();
        // Rounding may leave a variance of 0 an ulp below it.
        let variance = g.dot(&(&self.spread * g)).max(0.0);
        // f64::max drops a NaN: an unknown covariance must not become certainty.
        let is_known = self.spread.iter().all(|element| element.is_finite());
        (!is_open && is_known).then(|| variance.sqrt()).filter(|error| error.is_finite())
    }

    /// Standard error of an unknown, in its own unit; none if it is at a bound, undetermined, or no degree of freedom is left.
    #[must_use]
    pub fn error_of(&self, name: &N) -> Option<f64> {
        let j = self.determined.iter().position(|other| other == name)?;
        Some(self.covariance[(j, j)].sqrt()).filter(|error| error.is_finite())
    }

    /// The variance of a parameter under a robust loss over the one that the rise of the loss alone suggests; 1 for squares.
    #[must_use]
    pub(crate) fn inflation(&self, name: &N) -> f64 {
        let j = self.analysed.iter().position(|other| other == name);
        j.map(|j| self.inflation[j]).filter(|ratio| ratio.is_finite() && *ratio > 0.0).unwrap_or(1.0)
    }

    /// Correlations of the determined parameters; none where a variance is 0 or unknown.
    #[must_use]
    pub fn correlations(&self) -> DMatrix<f64> {
        let c = &self.covariance;
        DMatrix::from_fn(c.nrows(), c.ncols(), |a, b| if a == b { 1.0 } else { c[(a, b)] / (c[(a, a)] * c[(b, b)]).sqrt() })
    }
}

/// Whether an unknown changes any value when it crosses its box.
pub(crate) fn has_effect<P: FitProblem>(problem: &P, x: &DVector<f64>, unknown: usize) -> bool {
    let (low, high) = problem.bounds_of(unknown);
    let values = |at: f64| {
        let mut there = x.clone();
        there[unknown] = at;
        problem.predictions(&problem.point_at(&there))
    };
    let Some(here) = values(x[unknown]) else { return true };
    [low, f64::midpoint(low, high), high].into_iter().any(|at| {
        let changes = |there: Vec<f64>| there.iter().zip(&here).any(|(there, here)| (there - here).abs() > EFFECT * here.abs());
        values(at).is_none_or(changes)
    })
}

/// The Jacobian by those unknowns whose square is A, and B where it is not A times the variance.
fn information<P: FitProblem>(problem: &P, x: &DVector<f64>, moving: &[usize]) -> Option<(DMatrix<f64>, Option<DMatrix<f64>>)> {
    let loss = problem.options().loss;
    if loss == Loss::Squared {
        return problem.linearised_at(x).map(|(_, jacobian)| (jacobian.select_columns(moving), None));
    }
    let (residuals, jacobian) = problem.with_squared_loss().linearised_at(x)?;
    let scales = problem.loss_scales_of_rows();
    let weighted = |weight: &dyn Fn(f64, f64) -> f64| {
        DMatrix::from_fn(jacobian.nrows(), moving.len(), |i, j| jacobian[(i, moving[j])] * weight(residuals[i], scales[i]))
    };
    let bread = weighted(&|residual, scale| loss.influence_slope(residual, scale).sqrt());
    let meat = weighted(&|residual, scale| loss.influence(residual, scale));
    Some((bread, Some(meat.transpose() * &meat)))
}

/// N/(N − rank): residuals of a fit are smaller than the noise.
#[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
fn small_sample<P: FitProblem>(problem: &P, rank: usize) -> f64 {
    let count = problem.residual_count();
    if count > rank { count as f64 / (count - rank) as f64 } else { f64::NAN }
}

/// The size that a change of a parameter is relative to: its own, or for q, which counts from 1, its distance from there.
fn size(parameter: Parameter, value: f64) -> f64 {
    let origin = if parameter == Parameter::Q { 1.0 } else { 0.0 };
    (value - origin).abs().max(SMALLEST_SIZE)
}

/// SS/(N − rank), or 1 where the residuals are in units of their own standard deviation; not a number without a degree of freedom.
fn variance_of_unit_weight<P: FitProblem>(problem: &P, sum_of_squares: f64, rank: usize) -> f64 {
    match problem.options().weights {
        Weights::Sigma => 1.0,
        #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
        Weights::None if problem.residual_count() > rank => sum_of_squares / (problem.residual_count() - rank) as f64,
        Weights::None => f64::NAN,
    }
}

/// The null space in its sparsest form, of relative changes: reduced by rows with pivots.
fn describe<N: UnknownName>(
    mut null_space: DMatrix<f64>,
    values: &[f64],
    free: &[N],
    knows_only_ratios: bool,
) -> Vec<UndeterminedDirection<N>> {
    let (rows, columns) = null_space.shape();
    for (j, (name, &value)) in free.iter().zip(values).enumerate() {
        null_space.column_mut(j).scale_mut(1.0 / size(name.parameter(), value));
    }
    for i in 0..rows {
        let pivot =
            (i..rows).flat_map(|r| (0..columns).map(move |j| (r, j))).max_by(|a, b| null_space[*a].abs().total_cmp(&null_space[*b].abs()));
        let Some((row, column)) = pivot.filter(|at| null_space[*at] != 0.0) else { break };
        null_space.swap_rows(i, row);
        let scaled = null_space.row(i) / null_space[(i, column)];
        null_space.row_mut(i).copy_from(&scaled);
        for other in (0..rows).filter(|&other| other != i) {
            let reduced = null_space.row(other) - &scaled * null_space[(other, column)];
            null_space.row_mut(other).copy_from(&reduced);
        }
    }
    let direction = |i: usize| -> Vec<(N, f64)> {
        let largest = null_space.row(i).amax();
        let relative = (0..columns).map(|j| (free[j].clone(), null_space[(i, j)] / largest));
        relative.filter(|(_, coefficient)| coefficient.abs() > UNDETERMINED_SHARE).collect()
    };
    (0..rows).map(|i| UndeterminedDirection::new(direction(i), knows_only_ratios)).collect()
}
