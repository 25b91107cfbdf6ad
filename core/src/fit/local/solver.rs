//! From one start to a minimum.
//!
//! Two ways lead there. [`crate::fit::local::bounded_lm`] is fast, bends with valleys and ends exactly on edges of the box, but may run into an edge before it
//! sees the minimum behind. The crate `levenberg-marquardt` ([`crate::fit::local::minpack`]) never quite reaches an edge and comes by; it makes the minpack_sin2
//! where a walk alone has failed, and where a start is one of many.

use crate::fit::least_squares::LeastSquares;
use crate::fit::local::bounded_lm::{BoundedLm, Limits};
use crate::fit::local::minpack::minpack_sin2;
use crate::fit::objective::Problem;
use crate::model::Parameters;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// Objective, parameters or gradient changed by no more than rounding.
    Converged,
    /// Model and data agree to the last digits.
    ResidualsZero,
    /// No step improves the objective, though the tests of convergence are not met.
    NoImprovement,
    /// Too many evaluations.
    EvaluationLimit,
    /// Stopped on request; the best point so far is the result.
    Cancelled,
    /// The data leave a direction in the space of the free parameters open.
    Underdetermined,
    /// No row to fit, or all of them masked.
    NoData,
    /// A residual or derivative is not a finite number.
    Numerical,
}

impl StopReason {
    /// In English words, without a capital or a full stop.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::ResidualsZero => "model and data agree to the last digits",
            Self::NoImprovement => "no further improvement is possible",
            Self::EvaluationLimit => "too many evaluations",
            Self::Cancelled => "cancelled; the best so far is shown",
            Self::Underdetermined => "the data leave some parameters open",
            Self::NoData => "there are no data to fit",
            Self::Numerical => "a number beyond the range of f64 came up",
        }
    }
}

/// One improvement on the way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TracePoint {
    /// Milliseconds since the fit began.
    pub elapsed_ms: f64,
    /// Residual evaluations so far.
    pub evaluations: usize,
    /// ΔE of Eq. (18).
    pub objective: f64,
}

/// What a fit is given from outside: a clock, a wish to stop, and somebody to tell.
#[derive(Clone, Copy)]
pub struct Observer<'a> {
    /// Milliseconds since the fit began.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
    /// Whether to stop.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Told of each improvement.
    pub progress: &'a (dyn Fn(TracePoint) + Sync),
}

impl Observer<'static> {
    /// Nobody watches: no clock, no cancel.
    pub const NONE: Self = Self { clock: &|| 0.0, cancelled: &|| false, progress: &|_| {} };
}

/// Where one start led.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalFit {
    /// The best parameters seen.
    pub parameters: Parameters,
    /// Sum of the squared (scaled) residuals there; infinite if none was finite.
    pub sum_of_squares: f64,
    /// Why it ended.
    pub stop_reason: StopReason,
    /// Residual evaluations.
    pub evaluations: usize,
    /// The improvements on the way.
    pub trace: Vec<TracePoint>,
    /// The parameters of each.
    pub path: Vec<Parameters>,
}

/// The same for any least squares problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The best unknowns seen.
    pub x: DVector<f64>,
    /// Sum of squares there; infinite if none was finite.
    pub sum_of_squares: f64,
    /// Why it ended.
    pub stop_reason: StopReason,
    /// Residual evaluations.
    pub evaluations: usize,
    /// The improvements on the way.
    pub trace: Vec<TracePoint>,
    /// The unknowns of each.
    pub path: Vec<DVector<f64>>,
}

/// How far a descent is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// To the minimum, whatever it takes.
    Full,
    /// From far to where another start is worth more.
    Reach,
    /// From near a minimum to the minimum.
    Finish,
    /// For a few steps.
    Few,
}

/// Steps of a walk to the minimum.
const STEPS: usize = 2000;
/// Evaluations of it, per unknown and one; and of one among many.
const PATIENCE: usize = 400;
const SHORT_PATIENCE: usize = 50;
/// Evaluations of the minpack_sin2, per unknown and one.
const APPROACH_PATIENCE: usize = 30;
/// The same for a probe at where a start leads.
const GLANCE: usize = 1;

/// Fits from the problem's start.
#[must_use]
pub fn fit_local(problem: &Problem, effort: Effort, watch: Observer<'_>) -> LocalFit {
    let Solution { x, sum_of_squares, stop_reason, evaluations, trace, path } = minimise(problem, effort, watch);
    let path = path.iter().map(|x| problem.parameters_at(x)).collect();
    LocalFit { parameters: problem.parameters_at(&x), sum_of_squares, stop_reason, evaluations, trace, path }
}

/// Minimises a sum of squares from its start.
#[must_use]
pub fn minimise<P: LeastSquares>(problem: &P, effort: Effort, watch: Observer<'_>) -> Solution {
    let start = problem.start();
    let mut log = Recorder::new(&start, watch);
    if problem.residual_count() == 0 {
        return log.into_solution(StopReason::NoData);
    }
    let n = start.len();
    if n == 0 {
        log.evaluate(problem, &start, &mut DVector::zeros(problem.residual_count()));
        return log.into_solution(StopReason::Converged);
    }
    let stop = match effort {
        Effort::Few => minpack_sin2(problem, &start, GLANCE, &mut log).1,
        Effort::Reach => local_bounds(problem, &start, SHORT_PATIENCE * (n + 1), &mut log),
        Effort::Finish => BoundedLm::new(problem, &start).run(limits(PATIENCE * (n + 1)), &mut log),
        Effort::Full => go_all_the_way(problem, &start, limits(PATIENCE * (n + 1)), &mut log),
    };
    log.into_solution(stop)
}

const fn limits(evaluations: usize) -> Limits {
    Limits { steps: STEPS, evaluations, sharpen: true }
}

/// By the crate until it becomes slow, then on foot.
fn local_bounds<P: LeastSquares>(problem: &P, start: &DVector<f64>, evaluations: usize, log: &mut Recorder<'_>) -> StopReason {
    let (from, stop) = minpack_sin2(problem, start, APPROACH_PATIENCE, log);
    if stop == StopReason::Cancelled {
        return stop;
    }
    BoundedLm::new(problem, &from).run(Limits { steps: STEPS, evaluations, sharpen: false }, log)
}

/// On foot from the start, which is fastest. Where that ends nowhere or on an edge of the box, which a walk runs into before it sees the
/// minimum behind, the crate shows another way.
fn go_all_the_way<P: LeastSquares>(problem: &P, start: &DVector<f64>, limits: Limits, log: &mut Recorder<'_>) -> StopReason {
    let stop = BoundedLm::new(problem, start).run(limits, log);
    if matches!(stop, StopReason::ResidualsZero | StopReason::Cancelled) || (stop == StopReason::Converged && is_inside(problem, &log.best))
    {
        return stop;
    }
    let (from, other) = minpack_sin2(problem, start, APPROACH_PATIENCE, log);
    if other == StopReason::Cancelled {
        return other;
    }
    let before = log.sum_of_squares;
    let other = BoundedLm::new(problem, &from).run(limits, log);
    if log.sum_of_squares < before || other == StopReason::Cancelled { other } else { stop }
}

fn is_inside<P: LeastSquares>(problem: &P, x: &DVector<f64>) -> bool {
    x.iter().enumerate().all(|(j, &value)| {
        let (low, high) = problem.bounds_of(j);
        value > low && value < high
    })
}

/// What is kept while solvers come and go: the solver crate itself returns rejected points.
pub(crate) struct Recorder<'a> {
    watch: Observer<'a>,
    best: DVector<f64>,
    sum_of_squares: f64,
    evaluations: usize,
    trace: Vec<TracePoint>,
    path: Vec<DVector<f64>>,
}

impl LocalFit {
    /// Appends a further descent that began at this one's end.
    pub(crate) fn append(&mut self, further: Self) {
        let so_far = self.evaluations;
        let shifted = further.trace.into_iter().map(|point| TracePoint { evaluations: so_far + point.evaluations, ..point });
        let last = self.trace.last().map_or(f64::INFINITY, |point| point.objective);
        for (point, parameters) in shifted.zip(further.path).filter(|(point, _)| point.objective < last) {
            self.trace.push(point);
            self.path.push(parameters);
        }
        self.evaluations += further.evaluations;
        if further.sum_of_squares <= self.sum_of_squares {
            self.parameters = further.parameters;
            self.sum_of_squares = further.sum_of_squares;
            self.stop_reason = further.stop_reason;
        }
    }
}

impl<'a> Recorder<'a> {
    fn new(start: &DVector<f64>, watch: Observer<'a>) -> Self {
        Self { watch, best: start.clone(), sum_of_squares: f64::INFINITY, evaluations: 0, trace: Vec::new(), path: Vec::new() }
    }

    pub(crate) fn evaluations(&self) -> usize {
        self.evaluations
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        (self.watch.cancelled)()
    }

    /// Writes the residuals at x and returns the sum of their squares, infinite if one is not finite; the best point is remembered.
    pub(crate) fn evaluate<P: LeastSquares>(&mut self, problem: &P, x: &DVector<f64>, residuals: &mut DVector<f64>) -> f64 {
        self.evaluations += 1;
        if !problem.residuals_at(x, residuals) {
            return f64::INFINITY;
        }
        let sum_of_squares = residuals.norm_squared();
        if !sum_of_squares.is_finite() {
            return f64::INFINITY;
        }
        if sum_of_squares < self.sum_of_squares {
            self.sum_of_squares = sum_of_squares;
            self.best.copy_from(x);
            let objective = problem.objective_at(sum_of_squares, x);
            let point = TracePoint { elapsed_ms: (self.watch.clock)(), evaluations: self.evaluations, objective };
            self.trace.push(point);
            self.path.push(x.clone());
            (self.watch.progress)(point);
        }
        sum_of_squares
    }

    /// Takes a point that was evaluated for the result, if it is the best one but for that fraction.
    pub(crate) fn settle(&mut self, x: &DVector<f64>, sum_of_squares: f64, fraction: f64) {
        if sum_of_squares > self.sum_of_squares * (1.0 + fraction) {
            return;
        }
        self.best.copy_from(x);
        self.sum_of_squares = sum_of_squares;
    }

    fn into_solution(self, stop_reason: StopReason) -> Solution {
        let Self { best, sum_of_squares, evaluations, trace, path, .. } = self;
        Solution { x: best, sum_of_squares, stop_reason, evaluations, trace, path }
    }
}

#[cfg(test)]
mod tests {
    use super::{LocalFit, StopReason, TracePoint};
    use crate::model::Parameters;

    fn descent(objectives: [f64; 2]) -> LocalFit {
        let at = |n: f64| Parameters { n, ..Parameters::default() };
        let point = |(evaluations, objective)| TracePoint { elapsed_ms: 0.0, evaluations, objective };
        LocalFit {
            parameters: at(objectives[1]),
            sum_of_squares: objectives[1],
            stop_reason: StopReason::Converged,
            evaluations: 10,
            trace: (1..).zip(objectives).map(point).collect(),
            path: objectives.map(at).to_vec(),
        }
    }

    #[test]
    fn a_descent_that_goes_on_adds_its_improvements_with_their_places() {
        let mut whole = descent([4.0, 2.0]);
        // The first point of what follows is where the one before ended, or worse.
        whole.append(descent([3.0, 1.0]));
        let objectives: Vec<f64> = whole.trace.iter().map(|point| point.objective).collect();
        let places: Vec<f64> = whole.path.iter().map(|parameters| parameters.n).collect();
        assert_eq!((objectives, places), (vec![4.0, 2.0, 1.0], vec![4.0, 2.0, 1.0]));
        assert_eq!((whole.trace[2].evaluations, whole.evaluations), (12, 20));
    }
}
