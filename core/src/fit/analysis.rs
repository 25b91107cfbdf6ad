//! From the minima that a search has found to a result: what rests on a bound, uncertainties, statistics.

use crate::fit::estimate::{Edge, Estimate};
use crate::fit::intervals::band::PredictionBand;
use crate::fit::intervals::linear::{Uncertainty, has_effect};
use crate::fit::least_squares::LeastSquares as _;
use crate::fit::local::solution::LocalFit;
use crate::fit::multistart::basin::{Basin, MultistartResult};
use crate::fit::objective::Problem;
use crate::fit::options::Weights;
use crate::fit::result::{Correlations, Course, FitResult, Minimum, Statistics};
use crate::fit::stop_reason::StopReason;
use crate::model::{Parameter, ParameterSet, Parameters};

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

/// The result of a search, which may have been made before. The problem has the loss scales that the search had.
#[must_use]
pub fn analyse(problem: &Problem, search: MultistartResult, elapsed_ms: f64) -> FitResult {
    let MultistartResult { mut basins, evaluations } = search;
    let minimum = |Basin { local_fit, hits }: &Basin| Minimum {
        parameters: local_fit.parameters,
        objective: problem.delta_e(&local_fit.parameters).unwrap_or(f64::NAN),
        stop_reason: local_fit.stop_reason,
        hits: *hits,
    };
    let mut minima: Vec<Minimum> = basins.iter().map(minimum).collect();
    let LocalFit { parameters, sum_of_squares, mut stop_reason, trace, path, .. } = basins.swap_remove(0).local_fit;
    let parameters = on_bounds(problem, parameters, sum_of_squares);
    let at_bound: ParameterSet =
        problem.free().iter().copied().filter(|&parameter| edge(problem, &parameters, parameter).is_some()).collect();
    let uncertainty = Uncertainty::at(problem, &parameters, sum_of_squares, pressed(problem, &parameters, at_bound));
    let parameters = without_idle_changes(problem, parameters, sum_of_squares, &uncertainty);
    let is_undetermined = !uncertainty.undetermined.is_empty() || problem.len() < problem.free().len();
    let is_final = matches!(stop_reason, StopReason::NoData | StopReason::Cancelled | StopReason::Numerical | StopReason::EvaluationLimit);
    if is_undetermined && !is_final {
        stop_reason = StopReason::Underdetermined;
    }
    if let Some(best) = minima.first_mut() {
        best.stop_reason = stop_reason;
    }
    FitResult {
        model: problem.model(),
        estimates: estimates(problem, &parameters, &uncertainty),
        objective: (!problem.is_empty()).then(|| problem.delta_e(&parameters)).flatten(),
        start_objective: problem.delta_e(problem.start()),
        stop_reason,
        statistics: statistics(problem, &parameters, sum_of_squares, uncertainty.rank),
        correlations: Correlations { parameters: uncertainty.determined.clone(), matrix: uncertainty.correlations() },
        undetermined: uncertainty.undetermined.clone(),
        band: PredictionBand::new(problem, &parameters, uncertainty),
        course: Course { evaluations, elapsed_ms, intervals_ms: 0.0, intervals_complete: None, minima, trace, path },
        parameters,
    }
}

fn estimates(problem: &Problem, parameters: &Parameters, uncertainty: &Uncertainty) -> Vec<Estimate> {
    let estimate = |parameter| Estimate {
        parameter,
        start: problem.start()[parameter],
        value: parameters[parameter],
        free: problem.free().contains(&parameter),
        std_error: uncertainty.standard_error(parameter),
        at_bound: problem.free().contains(&parameter).then(|| edge(problem, parameters, parameter)).flatten(),
        interval68: None,
        interval95: None,
        determined: uncertainty.determined.contains(&parameter),
    };
    problem.model().parameters().iter().map(estimate).collect()
}

fn statistics(problem: &Problem, parameters: &Parameters, sum_of_squares: f64, rank: usize) -> Statistics {
    let rss = sum_of_squares * problem.rss_scale();
    Statistics {
        rss: if problem.is_empty() { 0.0 } else { rss },
        start_rss: problem.rss(problem.start()),
        minimises_delta_e: problem.minimises_delta_e(),
        chi2: (problem.options().weights == Weights::Sigma).then_some(sum_of_squares),
        dof: problem.len().saturating_sub(rank),
        aicc: aicc(problem, parameters, rss),
        loss_scales: problem.loss_scales(),
        block_weights: problem.block_weights(),
    }
}

/// Parameters that have no effect at the solution, each by itself, return to their starts if that changes nothing: the fit had no
/// reason to move them.
fn without_idle_changes(problem: &Problem, parameters: Parameters, sum_of_squares: f64, uncertainty: &Uncertainty) -> Parameters {
    let lone = uncertainty.undetermined.iter().filter(|undetermined| undetermined.direction.len() == 1);
    lone.fold(parameters, |so_far, undetermined| {
        let parameter = undetermined.direction[0].0;
        let mut back = so_far;
        back[parameter] = problem.start()[parameter];
        let is_idle = problem.sum_of_squares(&back).is_some_and(|sum| sum <= sum_of_squares * (1.0 + ROUNDING));
        if is_idle { back } else { so_far }
    })
}

/// Parameters beside a bound move onto it if that changes nothing: exact data leave a descent where residuals are rounding.
fn on_bounds(problem: &Problem, parameters: Parameters, sum_of_squares: f64) -> Parameters {
    let enough = (sum_of_squares * (1.0 + ROUNDING)).max(problem.negligible());
    problem.free().iter().fold(parameters, |so_far, &parameter| {
        let (low, high) = problem.bounds().of(parameter);
        let beside = |bound: &&f64| (so_far[parameter] - **bound).abs() <= BESIDE_BOUND * (high - low) && so_far[parameter] != **bound;
        let Some(&bound) = [low, high].iter().find(beside) else { return so_far };
        let mut there = so_far;
        there[parameter] = bound;
        if problem.sum_of_squares(&there).is_some_and(|sum| sum <= enough) { there } else { so_far }
    })
}

/// Those parameters on a bound that the data press against it, or that have no slope there. Another
/// one merely came to lie there, along a direction that the data leave undetermined, and takes part
/// in the analysis of what they determine.
fn pressed(problem: &Problem, parameters: &Parameters, at_bound: ParameterSet) -> ParameterSet {
    if at_bound.is_empty() {
        return at_bound;
    }
    let part = problem.with_free(at_bound);
    let Some((residuals, jacobian)) = part.linearised(parameters) else { return at_bound };
    let is_pressed = |j: usize| {
        let column = jacobian.column(j);
        let (low, high) = problem.bounds().of(part.free()[j]);
        let has_vanished = column.norm() * (high - low) <= VANISHED * residuals.norm();
        (has_vanished && has_effect(problem, parameters, part.free()[j]))
            || column.dot(&residuals).abs() > PRESSED * column.norm() * residuals.norm()
    };
    part.free().iter().enumerate().filter(|(j, _)| is_pressed(*j)).map(|(_, &parameter)| parameter).collect()
}

/// The bound that a parameter rests on: the active set of the solver, which ends exactly there.
fn edge(problem: &Problem, parameters: &Parameters, parameter: Parameter) -> Option<Edge> {
    let (low, high) = problem.bounds().of(parameter);
    match parameters[parameter] {
        value if value <= low => Some(Edge::Lower),
        value if value >= high => Some(Edge::Upper),
        _ => None,
    }
}

/// Akaike's corrected criterion, `Σ N ln(RSS/N) + 2K + 2K(K + 1)/(N − K − 1)` with K the number of free parameters and unknown
/// variances, one of DoLP and one of BRDF; with stated standard deviations `χ² + …` with K = free (Burnham and Anderson, *Model
/// Selection and Multimodel Inference*, 2002, sec. 2.4).
#[expect(clippy::cast_precision_loss, reason = "numbers of residuals and parameters")]
fn aicc(problem: &Problem, parameters: &Parameters, rss: f64) -> Option<f64> {
    let n = problem.len() as f64;
    let free = problem.free().len() as f64;
    let term = |(sum, count): (f64, usize)| count as f64 * libm::log(sum / count as f64);
    let (misfit, k) = match problem.options().weights {
        Weights::None if problem.has_two_variances() => {
            let sums = problem.block_sums(parameters);
            let scales = problem.observations().scales();
            ([0, 1].map(|block| term((sums[block].0 / (scales[block] * scales[block]), sums[block].1))).iter().sum(), free + 2.0)
        }
        Weights::None => (term((rss, problem.len())), free + 1.0),
        Weights::Sigma => (rss, free),
    };
    let left = n - k - 1.0;
    let aicc = misfit + 2.0 * k + 2.0 * k * (k + 1.0) / left;
    (left > 0.0 && aicc.is_finite()).then_some(aicc)
}
