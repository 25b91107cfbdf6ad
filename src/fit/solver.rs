//! Levenberg–Marquardt in a box, from one start.
//!
//! The solver is the crate `levenberg-marquardt` (MINPACK's lmder), in the coordinates of [`super::coordinates`]. Where the
//! minimum lies on an edge of the box the slope by a coordinate vanishes there and convergence would be slow: a parameter that has
//! come to rest at an edge with the gradient pointing outwards is put on it and the rest fitted again.

use super::coordinates::Coordinates;
use super::problem::Problem;
use crate::model::{Parameter, ParameterSet, Parameters};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use serde::Serialize;
use std::cell::RefCell;

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
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
    /// In words.
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
pub struct Watch<'a> {
    /// Milliseconds since the fit began.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
    /// Whether to stop.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Told of each improvement.
    pub progress: &'a (dyn Fn(TracePoint) + Sync),
}

impl Watch<'static> {
    /// Nobody watches: no clock, no cancel.
    pub const NOBODY: Self = Self { clock: &|| 0.0, cancelled: &|| false, progress: &|_| {} };
}

/// Where one start led.
#[derive(Debug, Clone, PartialEq)]
pub struct Descent {
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
}

/// Below this objective the relative misfit is 1e-13: rounding, not physics.
const ROUNDING_OBJECTIVE: f64 = 1e-26;
/// A parameter this near an edge, as a fraction of the box, is at it.
const AT_EDGE: f64 = 1e-5;
/// First step bound of MINPACK: 100 by default, which overshoots from far starts.
const STEP_BOUND: f64 = 1.0;
/// Evaluations allowed per free parameter and one.
const PATIENCE: usize = 100;

/// Relative fall of the objective in a step below which the approach has done its part.
const APPROACH: f64 = 1e-5;

/// How far a descent is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// To the minimum.
    Full,
    /// From near a minimum to the minimum.
    Finish,
    /// For one evaluation per free parameter and one.
    Few,
}

/// The two parts of a descent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Path {
    /// From anywhere, in plain coordinates, until progress is slow.
    Plain(Effort),
    /// To the end, in coordinates that straighten valleys.
    Valley,
}

/// Fits from the problem's start.
#[must_use]
pub fn descend(problem: &Problem, effort: Effort, watch: Watch<'_>) -> Descent {
    let mut log = Log::new(problem, watch);
    if problem.is_empty() {
        return log.into_descent(StopReason::NoData);
    }
    let all: ParameterSet = problem.free().iter().copied().collect();
    log.evaluate(problem, problem.start());
    // Far from the minimum the plain coordinates are the safer ones; near it the others cut the valleys short.
    let mut stop = run(problem, Path::Plain(effort), &mut log);
    if effort == Effort::Few {
        return log.into_descent(stop);
    }
    if matches!(stop, StopReason::Converged | StopReason::EvaluationLimit) {
        stop = run(&problem.with_start(log.best), Path::Valley, &mut log);
    }
    let mut at_edge = ParameterSet::EMPTY;
    while !matches!(stop, StopReason::Cancelled | StopReason::Numerical) {
        let found = edges(problem, &log.best, all);
        if found.without_all(at_edge).is_empty() {
            break;
        }
        at_edge = at_edge.union(found);
        let mut snapped = log.best;
        for parameter in at_edge {
            let (low, high) = problem.bounds().of(parameter);
            snapped[parameter] = if snapped[parameter] - low < high - snapped[parameter] { low } else { high };
        }
        stop = run(&problem.with_free(all.without_all(at_edge)).with_start(snapped), Path::Valley, &mut log);
    }
    if log.sum_of_squares < ROUNDING_OBJECTIVE && stop != StopReason::Cancelled {
        stop = StopReason::ResidualsZero;
    }
    log.into_descent(stop)
}

/// The free parameters that rest at an edge while the objective still falls towards it.
fn edges(problem: &Problem, parameters: &Parameters, free: ParameterSet) -> ParameterSet {
    let near = |parameter: Parameter| {
        let (low, high) = problem.bounds().of(parameter);
        let fraction = (parameters[parameter] - low) / (high - low);
        if fraction < AT_EDGE {
            Some(1.0)
        } else if fraction > 1.0 - AT_EDGE {
            Some(-1.0)
        } else {
            None
        }
    };
    let candidates: ParameterSet = free.into_iter().filter(|&parameter| near(parameter).is_some()).collect();
    if candidates.is_empty() {
        return candidates;
    }
    let part = problem.with_free(candidates);
    let Some((residuals, jacobian)) = part.linearised(parameters) else { return ParameterSet::EMPTY };
    let gradient = jacobian.tr_mul(&residuals);
    let outwards =
        |(&parameter, slope): (&Parameter, &f64)| near(parameter).is_some_and(|inward| slope * inward >= 0.0).then_some(parameter);
    part.free().iter().zip(gradient.iter()).filter_map(outwards).collect()
}

/// One run of the solver crate; the best point goes to the log.
fn run(problem: &Problem, path: Path, log: &mut Log<'_>) -> StopReason {
    let free = problem.free();
    if free.is_empty() {
        log.evaluate(problem, problem.start());
        return StopReason::Converged;
    }
    let coordinates = match path {
        Path::Plain(_) => Coordinates::plain(problem),
        Path::Valley => Coordinates::valley(problem),
    };
    let adapter = Adapter { problem, z: coordinates.start(), coordinates, log: RefCell::new(log) };
    let solver = LevenbergMarquardt::new().with_stepbound(STEP_BOUND);
    let solver = match path {
        Path::Plain(Effort::Few) => solver.with_ftol(APPROACH).with_patience(1),
        Path::Plain(Effort::Full) => solver.with_ftol(APPROACH).with_patience(PATIENCE),
        Path::Plain(Effort::Finish) | Path::Valley => solver.with_patience(PATIENCE),
    };
    let (_, report) = solver.minimize(adapter);
    match report.termination {
        TerminationReason::Converged { .. } | TerminationReason::Orthogonal | TerminationReason::NoParameters => StopReason::Converged,
        TerminationReason::ResidualsZero => StopReason::ResidualsZero,
        TerminationReason::NoImprovementPossible(_) => StopReason::NoImprovement,
        TerminationReason::LostPatience => StopReason::EvaluationLimit,
        TerminationReason::User(_) => StopReason::Cancelled,
        TerminationReason::NoResiduals => StopReason::NoData,
        TerminationReason::Numerical(_) | TerminationReason::WrongDimensions(_) => StopReason::Numerical,
    }
}

/// What is kept while solvers come and go: the solver crate itself returns rejected points.
struct Log<'a> {
    watch: Watch<'a>,
    best: Parameters,
    sum_of_squares: f64,
    evaluations: usize,
    trace: Vec<TracePoint>,
}

impl Descent {
    /// Appends a further descent that began at this one's end.
    pub(super) fn go_on(&mut self, further: Self) {
        let so_far = self.evaluations;
        let shifted = further.trace.into_iter().map(|point| TracePoint { evaluations: so_far + point.evaluations, ..point });
        let last = self.trace.last().map_or(f64::INFINITY, |point| point.objective);
        self.trace.extend(shifted.filter(|point| point.objective < last));
        self.evaluations += further.evaluations;
        if further.sum_of_squares <= self.sum_of_squares {
            self.parameters = further.parameters;
            self.sum_of_squares = further.sum_of_squares;
            self.stop_reason = further.stop_reason;
        }
    }
}

impl<'a> Log<'a> {
    fn new(problem: &Problem, watch: Watch<'a>) -> Self {
        Self { watch, best: *problem.start(), sum_of_squares: f64::INFINITY, evaluations: 0, trace: Vec::new() }
    }

    /// Residuals at those parameters, remembered if they are the best.
    fn evaluate(&mut self, problem: &Problem, parameters: &Parameters) -> DVector<f64> {
        let mut residuals = DVector::zeros(problem.len());
        let finite = problem.residuals(parameters, &mut residuals);
        self.evaluations += 1;
        let sum_of_squares = residuals.norm_squared();
        if !finite {
            residuals.fill(f64::NAN);
        } else if sum_of_squares < self.sum_of_squares {
            self.sum_of_squares = sum_of_squares;
            self.best = *parameters;
            let objective = problem.objective(sum_of_squares, parameters);
            let point = TracePoint { elapsed_ms: (self.watch.clock)(), evaluations: self.evaluations, objective };
            self.trace.push(point);
            (self.watch.progress)(point);
        }
        residuals
    }

    fn into_descent(self, stop_reason: StopReason) -> Descent {
        let Self { best, sum_of_squares, evaluations, trace, .. } = self;
        Descent { parameters: best, sum_of_squares, stop_reason, evaluations, trace }
    }
}

/// The problem in the solver's coordinates.
struct Adapter<'a, 'w> {
    problem: &'a Problem,
    coordinates: Coordinates<'a>,
    z: DVector<f64>,
    log: RefCell<&'a mut Log<'w>>,
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Adapter<'_, '_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, z: &DVector<f64>) {
        self.z.copy_from(z);
    }

    fn params(&self) -> DVector<f64> {
        self.z.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let mut log = self.log.borrow_mut();
        if (log.watch.cancelled)() {
            return None;
        }
        Some(log.evaluate(self.problem, &self.coordinates.parameters(&self.z)))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let mut jacobian = DMatrix::zeros(self.problem.len(), self.problem.free().len());
        let parameters = self.coordinates.parameters(&self.z);
        self.problem.jacobian(&parameters, &mut jacobian);
        self.coordinates.chain(&self.z, &parameters, &mut jacobian);
        Some(jacobian)
    }
}
