//! From the minima that a search has found to a result: what rests on a bound, uncertainties, statistics.

use crate::fit::estimate::{Edge, Estimate};
use crate::fit::fit_problem::{FitProblem, UnknownName as _};
use crate::fit::intervals::band::PredictionBand;
use crate::fit::intervals::linear::{Uncertainty, has_effect};
use crate::fit::least_squares::LeastSquares;
use crate::fit::local::solution::LocalFit;
use crate::fit::multistart::basin::{Basin, MultistartResult};
use crate::fit::objective::Problem;
use crate::fit::options::Weights;
use crate::fit::result::{Correlations, Course, FitResult, Minimum, Statistics};
use crate::fit::stop_reason::StopReason;
use crate::model::Parameter;
use nalgebra::DVector;

/// Cosine between the residuals and a parameter's column of the Jacobian above which the data press the parameter against its
/// bound: far above rounding, and at an inner minimum the cosine is 0.
const PRESSED: f64 = 1e-6;
/// Relative rise of the sum of squares that is rounding.
const ROUNDING: f64 = 1e-12;
/// A parameter is beside a bound within this fraction of the box.
const BESIDE_BOUND: f64 = 1e-9;
/// A parameter's column of the Jacobian vanishes if it changes the residuals by no more than this fraction of their norm when it
/// crosses its box: where DoLP is even in k, at k = 0, the effect is quadratic.
const VANISHED: f64 = 1e-10;

/// What is said of a minimum, of one measurement or of several.
#[derive(Debug, Clone)]
pub(crate) struct Analysis<P: FitProblem> {
    /// The unknowns.
    pub x: DVector<f64>,
    /// ΔE of Eq. (18) there and at the start.
    pub objective: Option<f64>,
    pub start_objective: Option<f64>,
    pub stop_reason: StopReason,
    pub statistics: Statistics,
    pub uncertainty: Uncertainty<P::Name>,
    pub course: Course<P::Point>,
}

impl<P: FitProblem> Analysis<P> {
    /// Of a search, which may have been made before. The problem has the loss scales that the search had.
    pub(crate) fn new(problem: &P, search: MultistartResult<P::Point>, elapsed_ms: f64) -> Self {
        let MultistartResult { mut basins, evaluations } = search;
        let minimum = |Basin { local_fit, hits }: &Basin<P::Point>| Minimum {
            parameters: local_fit.parameters.clone(),
            objective: problem.delta_e(&local_fit.parameters).unwrap_or(f64::NAN),
            stop_reason: local_fit.stop_reason,
            hits: *hits,
        };
        let mut minima: Vec<Minimum<P::Point>> = basins.iter().map(minimum).collect();
        let LocalFit { parameters, sum_of_squares, mut stop_reason, trace, path, .. } = basins.swap_remove(0).local_fit;
        let x = on_bounds(problem, problem.unknowns_of(&parameters), sum_of_squares);
        let at_bound: Vec<usize> = (0..x.len()).filter(|&j| edge(problem, &x, j).is_some()).collect();
        let uncertainty = Uncertainty::of_unknowns(problem, &x, sum_of_squares, &pressed(problem, &x, at_bound));
        let x = without_idle_changes(problem, x, sum_of_squares, &uncertainty);
        let is_undetermined = !uncertainty.undetermined.is_empty() || problem.residual_count() < problem.names().len();
        let is_final =
            matches!(stop_reason, StopReason::NoData | StopReason::Cancelled | StopReason::Numerical | StopReason::EvaluationLimit);
        if is_undetermined && !is_final {
            stop_reason = StopReason::Underdetermined;
        }
        if let Some(best) = minima.first_mut() {
            best.stop_reason = stop_reason;
        }
        let is_empty = problem.residual_count() == 0;
        Self {
            objective: (!is_empty).then(|| problem.delta_e(&problem.point_at(&x))).flatten(),
            start_objective: problem.delta_e(problem.start_point()),
            stop_reason,
            statistics: statistics(problem, &x, sum_of_squares, uncertainty.rank),
            uncertainty,
            course: Course { evaluations, elapsed_ms, intervals_ms: 0.0, intervals_complete: None, minima, trace, path },
            x,
        }
    }

    /// The unknown after the fit, without intervals.
    pub(crate) fn estimate(&self, problem: &P, unknown: usize) -> Estimate {
        let name = &problem.names()[unknown];
        Estimate {
            parameter: name.parameter(),
            start: LeastSquares::start(problem)[unknown],
            value: self.x[unknown],
            free: true,
            std_error: self.uncertainty.error_of(name),
            at_bound: edge(problem, &self.x, unknown),
            interval68: None,
            interval95: None,
            determined: self.uncertainty.determined.contains(name),
        }
    }

    /// Correlations of the determined unknowns.
    pub(crate) fn correlations(&self) -> Correlations<P::Name> {
        Correlations { parameters: self.uncertainty.determined.clone(), matrix: self.uncertainty.correlations() }
    }

    /// The problem as it was minimised: with the scales of the loss and the weights of DoLP and BRDF that the fit found.
    pub(crate) fn fitted(&self, problem: &P) -> P {
        problem.with_loss_scales(self.statistics.loss_scales).with_block_weights(self.statistics.block_weights)
    }
}

impl Analysis<Problem> {
    /// Of a result, which says the same.
    pub(crate) fn of_result(problem: &Problem, result: FitResult) -> Self {
        Self {
            x: problem.unknowns_of(&result.parameters),
            objective: result.objective,
            start_objective: result.start_objective,
            stop_reason: result.stop_reason,
            statistics: result.statistics,
            uncertainty: result.band.uncertainty().clone(),
            course: result.course,
        }
    }

    /// As the result of a fit.
    pub(crate) fn into_result(self, problem: &Problem) -> FitResult {
        let parameters = problem.parameters_at(&self.x);
        FitResult {
            model: problem.model(),
            estimates: estimates(problem, &self),
            objective: self.objective,
            start_objective: self.start_objective,
            stop_reason: self.stop_reason,
            statistics: self.statistics,
            correlations: self.correlations(),
            undetermined: self.uncertainty.undetermined.clone(),
            band: PredictionBand::new(problem, &parameters, self.uncertainty),
            course: self.course,
            parameters,
        }
    }
}

/// The result of a search, which may have been made before. The problem has the loss scales that the search had.
#[must_use]
pub fn analyse(problem: &Problem, search: MultistartResult, elapsed_ms: f64) -> FitResult {
    Analysis::new(problem, search, elapsed_ms).into_result(problem)
}

/// Of all parameters of the model.
fn estimates(problem: &Problem, analysis: &Analysis<Problem>) -> Vec<Estimate> {
    let of = |parameter: Parameter| {
        let unknown = problem.free().iter().position(|&free| free == parameter);
        unknown.map_or_else(|| Estimate::fixed(parameter, problem.start()[parameter]), |unknown| analysis.estimate(problem, unknown))
    };
    let estimate = |parameter| {
        let tie = problem.ties().iter().find(|tie| tie.parameter == parameter);
        tie.map_or_else(|| of(parameter), |tie| of(tie.to).of_tied(tie))
    };
    problem.model().parameters().iter().map(estimate).collect()
}

fn statistics<P: FitProblem>(problem: &P, x: &DVector<f64>, sum_of_squares: f64, rank: usize) -> Statistics {
    let rss = sum_of_squares * problem.rss_scale();
    let start = LeastSquares::start(problem);
    Statistics {
        rss: if problem.residual_count() == 0 { 0.0 } else { rss },
        start_rss: problem.sum_of_squares_at(&start).map(|sum| sum * problem.rss_scale()),
        minimises_delta_e: problem.minimises_delta_e(),
        chi2: (problem.options().weights == Weights::Sigma).then_some(sum_of_squares),
        dof: problem.residual_count().saturating_sub(rank),
        aicc: aicc(problem, x, rss),
        loss_scales: problem.loss_scales(),
        block_weights: problem.block_weights(),
    }
}

/// Unknowns that have no effect at the solution, each by itself, return to their starts if that changes nothing: the fit had no
/// reason to move them.
fn without_idle_changes<P: FitProblem>(
    problem: &P,
    x: DVector<f64>,
    sum_of_squares: f64,
    uncertainty: &Uncertainty<P::Name>,
) -> DVector<f64> {
    let start = LeastSquares::start(problem);
    let lone = uncertainty.undetermined.iter().filter(|undetermined| undetermined.direction.len() == 1);
    lone.fold(x, |so_far, undetermined| {
        let Some(unknown) = problem.names().iter().position(|name| *name == undetermined.direction[0].0) else { return so_far };
        let mut back = so_far.clone();
        back[unknown] = start[unknown];
        let is_idle = problem.sum_of_squares_at(&back).is_some_and(|sum| sum <= sum_of_squares * (1.0 + ROUNDING));
        if is_idle { back } else { so_far }
    })
}

/// Unknowns beside a bound move onto it if that changes nothing: exact data leave a descent where residuals are rounding.
fn on_bounds<P: FitProblem>(problem: &P, x: DVector<f64>, sum_of_squares: f64) -> DVector<f64> {
    let enough = (sum_of_squares * (1.0 + ROUNDING)).max(problem.negligible());
    (0..x.len()).fold(x, |so_far, j| {
        let (low, high) = problem.bounds_of(j);
        let beside = |bound: &&f64| (so_far[j] - **bound).abs() <= BESIDE_BOUND * (high - low) && so_far[j] != **bound;
        let Some(&bound) = [low, high].iter().find(beside) else { return so_far };
        let mut there = so_far.clone();
        there[j] = bound;
        if problem.sum_of_squares_at(&there).is_some_and(|sum| sum <= enough) { there } else { so_far }
    })
}

/// Those unknowns on a bound that the data press against it, or that have no slope there. Another
/// one merely came to lie there, along a direction that the data leave undetermined, and takes part
/// in the analysis of what they determine.
fn pressed<P: FitProblem>(problem: &P, x: &DVector<f64>, at_bound: Vec<usize>) -> Vec<usize> {
    if at_bound.is_empty() {
        return at_bound;
    }
    let Some((residuals, jacobian)) = problem.linearised_at(x) else { return at_bound };
    let is_pressed = |&j: &usize| {
        let column = jacobian.column(j);
        let (low, high) = problem.bounds_of(j);
        let has_vanished = column.norm() * (high - low) <= VANISHED * residuals.norm();
        (has_vanished && has_effect(problem, x, j)) || column.dot(&residuals).abs() > PRESSED * column.norm() * residuals.norm()
    };
    at_bound.into_iter().filter(is_pressed).collect()
}

/// The bound that an unknown rests on: the active set of the solver, which ends exactly there.
pub(crate) fn edge<P: FitProblem>(problem: &P, x: &DVector<f64>, unknown: usize) -> Option<Edge> {
    let (low, high) = problem.bounds_of(unknown);
    match x[unknown] {
        value if value <= low => Some(Edge::Lower),
        value if value >= high => Some(Edge::Upper),
        _ => None,
    }
}

/// Akaike's corrected criterion, `Σ N ln(RSS/N) + 2K + 2K(K + 1)/(N − K − 1)` with K the number of free parameters and unknown
/// variances, one of DoLP and one of BRDF; with stated standard deviations `χ² + …` with K = free (Burnham and Anderson, *Model
/// Selection and Multimodel Inference*, 2002, sec. 2.4).
#[expect(clippy::cast_precision_loss, reason = "numbers of residuals and parameters")]
fn aicc<P: FitProblem>(problem: &P, x: &DVector<f64>, rss: f64) -> Option<f64> {
    let n = problem.residual_count() as f64;
    let free = problem.names().len() as f64;
    let term = |(sum, count): (f64, usize)| count as f64 * libm::log(sum / count as f64);
    let (misfit, k) = match problem.options().weights {
        Weights::None if problem.has_two_variances() => {
            let sums = problem.block_sums(&problem.point_at(x));
            let scales = problem.scales();
            ([0, 1].map(|block| term((sums[block].0 / (scales[block] * scales[block]), sums[block].1))).iter().sum(), free + 2.0)
        }
        Weights::None => (term((rss, problem.residual_count())), free + 1.0),
        Weights::Sigma => (rss, free),
    };
    let left = n - k - 1.0;
    let aicc = misfit + 2.0 * k + 2.0 * k * (k + 1.0) / left;
    (left > 0.0 && aicc.is_finite()).then_some(aicc)
}
