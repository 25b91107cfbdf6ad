//! What the data determine, and how well: standard errors and correlations from the Jacobian at the solution.
//!
//! J, its columns scaled by max(|p|, 1e-3) (q by its distance from 1), is U S Vᵀ. The rank is the number of singular values above 1e-8
//! of the largest. The pseudo-inverse covariance `V S⁻² Vᵀ` is summed over those and multiplied by SS/(N − rank) or, where standard
//! deviations were stated, by 1. A parameter with a share in the null space has no standard error; the null space is described
//! instead.

use crate::fit::objective::Problem;
use crate::fit::options::Weights;
use crate::model::{Parameter, ParameterSet, Parameters, PerParameter};
use nalgebra::{DMatrix, DVector, SVD};
use serde::ser::SerializeStruct as _;
use serde::{Serialize, Serializer};
use std::fmt;

/// Singular values below this fraction of the largest count as 0.
pub const RANK_THRESHOLD: f64 = 1e-8;
/// Size below which a parameter is scaled as if it had this size.
const SMALLEST_SCALE: f64 = 1e-3;
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
pub struct UndeterminedDirection {
    /// Why.
    pub reason: UndeterminedReason,
    /// Relative change of each parameter along it, the largest 1, shares below 1e-3 left out.
    pub direction: Vec<(Parameter, f64)>,
}

impl UndeterminedDirection {
    fn new(direction: Vec<(Parameter, f64)>, knows_only_ratios: bool) -> Self {
        let weights = [Parameter::Ks, Parameter::Kd, Parameter::Kv];
        let reason = match direction[..] {
            [_] => UndeterminedReason::NoEffect,
            _ if knows_only_ratios && direction.iter().all(|(parameter, _)| weights.contains(parameter)) => UndeterminedReason::RatiosOnly,
            _ => UndeterminedReason::TradeOff,
        };
        Self { reason, direction }
    }

    /// Symbols of the parameters along it, with commas between them.
    #[must_use]
    pub fn symbols(&self) -> String {
        self.direction.iter().map(|(parameter, _)| parameter.symbol()).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for UndeterminedDirection {
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

impl Serialize for UndeterminedDirection {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("UndeterminedDirection", 2)?;
        object.serialize_field("text", &self.to_string())?;
        object.serialize_field("direction", &ByKey(&self.direction))?;
        object.end()
    }
}

/// Numbers of parameters as an object with the parameters' keys.
struct ByKey<'a>(&'a [(Parameter, f64)]);

impl Serialize for ByKey<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(parameter, number)| (parameter.key(), number)))
    }
}

/// Standard errors, correlations and undetermined directions at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// Number of directions that the data determine.
    pub rank: usize,
    /// Largest over smallest counted singular value of the scaled Jacobian; none without a counted one.
    pub condition: Option<f64>,
    /// The parameters with a standard error.
    pub determined: Vec<Parameter>,
    /// Covariance of those.
    pub covariance: DMatrix<f64>,
    /// The directions that the data do not determine.
    pub undetermined: Vec<UndeterminedDirection>,
    /// The parameters that took part: the free ones that do not rest on a bound.
    pub(crate) analysed: Vec<Parameter>,
    /// Pseudo-inverse covariance of all of those.
    spread: DMatrix<f64>,
    /// The undetermined directions as orthonormal rows, in units of the scales.
    null_space: DMatrix<f64>,
    /// The size that a change of each is measured by.
    scales: Vec<f64>,
}

impl Uncertainty {
    /// At those parameters, for the free ones among them that do not rest on a bound.
    ///
    /// `sum_of_squares` is that of the problem's own residuals.
    #[must_use]
    pub fn at(problem: &Problem, parameters: &Parameters, sum_of_squares: f64, at_bound: ParameterSet) -> Self {
        let inner: ParameterSet = problem.free().iter().copied().filter(|&parameter| !at_bound.contains(parameter)).collect();
        let problem = problem.with_free(inner);
        let free = problem.free();
        let (rows, columns) = (problem.len(), free.len());
        let mut jacobian = DMatrix::zeros(rows.max(columns), columns);
        let mut filled = DMatrix::zeros(rows, columns);
        if columns == 0 || rows == 0 || !problem.jacobian(parameters, &mut filled) {
            return Self::nothing(free);
        }
        let scales: Vec<f64> = free.iter().map(|&parameter| scale(parameter, parameters[parameter])).collect();
        for (j, scale) in scales.iter().enumerate() {
            filled.column_mut(j).scale_mut(*scale);
        }
        // The decomposition of a matrix that is not finite does not terminate.
        if filled.iter().any(|element| !element.is_finite()) {
            return Self::nothing(free);
        }
        // Rows of zeros make a wide matrix square, so that the thin decomposition has all of V.
        jacobian.rows_mut(0, rows).copy_from(&filled);
        let svd = SVD::new(jacobian, false, true);
        let Some(v_t) = svd.v_t else { return Self::nothing(free) };
        let largest = svd.singular_values.max();
        let counted: Vec<usize> = (0..columns).filter(|&i| svd.singular_values[i] > RANK_THRESHOLD * largest && largest > 0.0).collect();
        let left: Vec<usize> = (0..columns).filter(|i| !counted.contains(i)).collect();

        let share = |j: usize| left.iter().map(|&i| v_t[(i, j)] * v_t[(i, j)]).sum::<f64>().sqrt();
        let kept: Vec<usize> = (0..columns).filter(|&j| share(j) < UNDETERMINED_SHARE).collect();
        let variance = variance_of_unit_weight(&problem, sum_of_squares, counted.len());
        let spread = DMatrix::from_fn(columns, columns, |a, b| {
            let sum: f64 = counted.iter().map(|&i| v_t[(i, a)] * v_t[(i, b)] / (svd.singular_values[i] * svd.singular_values[i])).sum();
            variance * scales[a] * scales[b] * sum
        });
        let covariance = DMatrix::from_fn(kept.len(), kept.len(), |a, b| spread[(kept[a], kept[b])]);
        let smallest = counted.iter().map(|&i| svd.singular_values[i]).fold(f64::INFINITY, f64::min);
        let null_space = DMatrix::from_fn(left.len(), columns, |i, j| v_t[(left[i], j)]);
        Self {
            rank: counted.len(),
            condition: (!counted.is_empty()).then(|| largest / smallest),
            determined: kept.iter().map(|&j| free[j]).collect(),
            covariance,
            undetermined: describe(null_space.clone(), free, problem.knows_only_ratios()),
            analysed: free.to_vec(),
            spread,
            null_space,
            scales,
        }
    }

    /// Nothing is determined.
    fn nothing(free: &[Parameter]) -> Self {
        let undetermined = free.iter().map(|&parameter| UndeterminedDirection::new(vec![(parameter, 1.0)], false));
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
        }
    }

    /// Standard error of a prediction with that gradient, `√(gᵀ C g)`; none where the gradient has a share in an open
    /// direction, or where the covariance is unknown.
    #[must_use]
    pub fn error_of_prediction(&self, gradient: &PerParameter<f64>) -> Option<f64> {
        let g = DVector::from_iterator(self.analysed.len(), self.analysed.iter().map(|&parameter| gradient[parameter]));
        let scaled = DVector::from_iterator(g.len(), g.iter().zip(&self.scales).map(|(slope, scale)| slope * scale));
        let is_open = (&self.null_space * &scaled).norm() > UNDETERMINED_SHARE * scaled.norm();
        // Rounding may leave a variance of 0 an ulp below it.
        let variance = g.dot(&(&self.spread * &g)).max(0.0);
        // f64::max drops a NaN: an unknown covariance must not become certainty.
        let is_known = self.spread.iter().all(|element| element.is_finite());
        (!is_open && is_known).then(|| variance.sqrt()).filter(|error| error.is_finite())
    }

    /// Standard error of a parameter, in its own unit; none if it is fixed, at a bound, undetermined, or no degree of freedom is left.
    #[must_use]
    pub fn standard_error(&self, parameter: Parameter) -> Option<f64> {
        let j = self.determined.iter().position(|&other| other == parameter)?;
        Some(self.covariance[(j, j)].sqrt()).filter(|error| error.is_finite())
    }

    /// Correlations of the determined parameters; none where a variance is 0 or unknown.
    #[must_use]
    pub fn correlations(&self) -> DMatrix<f64> {
        let c = &self.covariance;
        DMatrix::from_fn(c.nrows(), c.ncols(), |a, b| if a == b { 1.0 } else { c[(a, b)] / (c[(a, a)] * c[(b, b)]).sqrt() })
    }
}

/// The size that a change of a parameter is measured by: its own, or for q, which counts from 1, its distance from there.
fn scale(parameter: Parameter, value: f64) -> f64 {
    let origin = if parameter == Parameter::Q { 1.0 } else { 0.0 };
    (value - origin).abs().max(SMALLEST_SCALE)
}

/// SS/(N − rank), or 1 where the residuals are in units of their own standard deviation; not a number without a degree of freedom.
fn variance_of_unit_weight(problem: &Problem, sum_of_squares: f64, rank: usize) -> f64 {
    match problem.options().weights {
        Weights::Sigma => 1.0,
        #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
        Weights::None if problem.len() > rank => sum_of_squares / (problem.len() - rank) as f64,
        Weights::None => f64::NAN,
    }
}

/// The null space in its sparsest form: reduced by rows with pivots.
fn describe(mut null_space: DMatrix<f64>, free: &[Parameter], knows_only_ratios: bool) -> Vec<UndeterminedDirection> {
    let (rows, columns) = null_space.shape();
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
    let direction = |i: usize| -> Vec<(Parameter, f64)> {
        let largest = null_space.row(i).amax();
        let relative = (0..columns).map(|j| (free[j], null_space[(i, j)] / largest));
        relative.filter(|(_, coefficient)| coefficient.abs() > UNDETERMINED_SHARE).collect()
    };
    (0..rows).map(|i| UndeterminedDirection::new(direction(i), knows_only_ratios)).collect()
}
