//! The result of a fit: values, uncertainties, what is open, and how it came about.

use crate::fit::intervals::band::PredictionBand;
use crate::fit::intervals::linear::{Uncertainty, UndeterminedDirection};
use crate::fit::local::solution::LocalFit;
use crate::fit::multistart::basin::MultistartResult;
use crate::fit::multistart::search::{Starts, multistart};
use crate::fit::objective::Problem;
use crate::fit::observer::{Observer, TracePoint};
use crate::fit::options::{Loss, Weights};
use crate::fit::stop_reason::StopReason;
use crate::model::{Model, Parameter, ParameterSet, Parameters};
use nalgebra::DMatrix;
use std::fmt;

/// Which bound a parameter rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// The lower one.
    Lower,
    /// The upper one.
    Upper,
}

/// One parameter of the model after a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Which.
    pub parameter: Parameter,
    /// Its value before.
    pub start: f64,
    /// Its value.
    pub value: f64,
    /// Whether the fit could change it.
    pub free: bool,
    /// Its standard error, where the data determine it.
    pub std_error: Option<f64>,
    /// The bound it rests on.
    pub at_bound: Option<Edge>,
    /// Whether the data determine it: only a degree of freedom may be missing for a standard error.
    pub determined: bool,
}

/// How an estimate stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EstimateStatus {
    /// The fit did not touch it.
    Fixed,
    /// It rests on a bound, and has no standard error there.
    AtBound(Edge),
    /// The data determine it, with this standard error in its own unit.
    Determined(f64),
    /// The data determine it, but no degree of freedom is left to tell a standard error from.
    NoDegreesOfFreedom,
    /// The data leave it open.
    Open,
}

impl Estimate {
    /// How it stands; a bound comes before all else that is said of a free parameter.
    #[must_use]
    pub fn standing(&self) -> EstimateStatus {
        match (self.free, self.at_bound, self.std_error) {
            (false, ..) => EstimateStatus::Fixed,
            (true, Some(edge), _) => EstimateStatus::AtBound(edge),
            (true, None, Some(error)) => EstimateStatus::Determined(error),
            (true, None, None) if self.determined => EstimateStatus::NoDegreesOfFreedom,
            (true, None, None) => EstimateStatus::Open,
        }
    }

    /// Whether the data determine it, but to no better than half its size.
    #[must_use]
    pub fn is_poorly_determined(&self) -> bool {
        matches!(self.standing(), EstimateStatus::Determined(error) if is_poorly_determined(self.parameter, self.value, error))
    }
}

/// What an error of a parameter is measured by: its distance from where its effect vanishes, or, for c, which has no such place, the width of
/// its range.
#[must_use]
pub fn relative_error_base(parameter: Parameter, value: f64) -> f64 {
    match parameter {
        Parameter::Q => value - 1.0,
        Parameter::C => 1.0,
        _ => value.abs(),
    }
}

/// Something that the data leave open.
#[derive(Debug, Clone, PartialEq)]
pub enum Undetermined {
    /// A direction that they do not determine at all.
    Direction(UndeterminedDirection),
    /// Parameters that they determine with a standard error above half of the value.
    Poorly(Vec<Parameter>),
}

impl Undetermined {
    /// The poorly determined parameters, if there are any.
    #[must_use]
    pub fn poorly(parameters: impl Iterator<Item = Parameter>) -> Option<Self> {
        let parameters: Vec<Parameter> = parameters.collect();
        (!parameters.is_empty()).then_some(Self::Poorly(parameters))
    }
}

impl fmt::Display for Undetermined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Direction(direction) => direction.fmt(f),
            Self::Poorly(parameters) => write!(f, "a standard error above half of the value: {}", symbols(parameters)),
        }
    }
}

/// Symbols of parameters, with commas between them.
#[must_use]
pub fn symbols(parameters: &[Parameter]) -> String {
    parameters.iter().map(|parameter| parameter.symbol()).collect::<Vec<_>>().join(", ")
}

/// Whether an error is above half of that size: then the value says next to nothing.
#[must_use]
pub fn is_poorly_determined(parameter: Parameter, value: f64, error: f64) -> bool {
    error > 0.5 * relative_error_base(parameter, value)
}

/// The end of one start, for the list of minima.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// Where it ended.
    pub parameters: Parameters,
    /// ΔE of Eq. (18).
    pub objective: f64,
    /// Why it ended there.
    pub stop_reason: StopReason,
    /// How many starts ended there.
    pub hits: usize,
}

/// The result of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct FitResult {
    /// Which terms there are.
    pub model: Model,
    /// All nine values; those that play no part are as they were.
    pub parameters: Parameters,
    /// The model's own parameters, one by one.
    pub estimates: Vec<Estimate>,
    /// ΔE of Eq. (18), of DoLP if measured, else of BRDF; with both, the sum. None where all measured values are 0.
    pub objective: Option<f64>,
    /// The same at the start.
    pub start_objective: Option<f64>,
    /// Sum of squares of what was minimised, in the data's own unit where it has one.
    pub sum_of_squares: f64,
    /// The same at the start; none where it is not finite.
    pub start_sum_of_squares: Option<f64>,
    /// Whether what was minimised is ΔE itself.
    pub minimises_delta_e: bool,
    /// Where the loss changed from squares to sizes, for DoLP and BRDF, in units of the scaled residual.
    pub loss_scales: [f64; 2],
    /// χ², where standard deviations were stated and used.
    pub chi2: Option<f64>,
    /// Number of residuals less the rank.
    pub dof: usize,
    /// Akaike's corrected criterion.
    pub aicc: Option<f64>,
    /// Why the fit ended.
    pub stop_reason: StopReason,
    /// Residual evaluations.
    pub evaluations: usize,
    /// Milliseconds from the first residual evaluation to the last.
    pub elapsed_ms: f64,
    /// Directions that the data leave open.
    pub undetermined: Vec<UndeterminedDirection>,
    /// Determined parameters, in the order of the correlations.
    pub determined: Vec<Parameter>,
    /// Their correlations.
    pub correlations: DMatrix<f64>,
    /// Standard errors of the fitted curves at any geometry.
    pub band: PredictionBand,
    /// Where the starts led; empty where that is not known any more.
    pub minima: Vec<Minimum>,
    /// The improvements on the way of the winning start.
    pub trace: Vec<TracePoint>,
    /// The parameters of each.
    pub path: Vec<Parameters>,
}

/// Cosine between the residuals and a parameter's column of the Jacobian from which the data press on its bound.
const PRESSED: f64 = 1e-6;
/// Relative rise of the sum of squares that is rounding.
const IDLE: f64 = 1e-12;
/// A parameter this near a bound, as a fraction of the box, rests on it.
const AT_BOUND: f64 = 1e-9;

/// Fits from one start or many and says what came out.
#[must_use]
pub fn fit(problem: &Problem, starts: Starts, seed: u64, watch: Observer<'_>) -> FitResult {
    let choices = problem.options();
    if choices.loss == Loss::Squared || choices.loss_scale.is_some() {
        let found = multistart(problem, starts, seed, watch);
        return FitResult::new(problem, found, (watch.clock)());
    }
    let squared = multistart(&problem.with_squared_loss(), starts, seed, watch);
    let scaled = squared.basins.first().map(|best| {
        let parameters = best.local_fit.parameters;
        problem.with_loss_scale_of(&parameters).with_start(parameters)
    });
    let robust = scaled.unwrap_or_else(|| problem.clone());
    let mut found = multistart(&robust, starts, seed, watch);
    found.evaluations += squared.evaluations;
    FitResult::new(&robust.with_start(*problem.start()), found, (watch.clock)())
}

impl FitResult {
    /// What the data leave open: directions, and the parameters that are poorly determined.
    #[must_use]
    pub fn describe_undetermined(&self) -> Vec<Undetermined> {
        let poor = self.estimates.iter().filter(|estimate| estimate.is_poorly_determined()).map(|estimate| estimate.parameter);
        self.undetermined.iter().cloned().map(Undetermined::Direction).chain(Undetermined::poorly(poor)).collect()
    }

    /// The report of a search that was made before, on a problem with the loss scales that it had then; none where it found nothing.
    #[must_use]
    pub fn restore(problem: &Problem, search: MultistartResult, elapsed_ms: f64) -> Option<Self> {
        (!search.basins.is_empty()).then(|| Self::new(problem, search, elapsed_ms))
    }

    fn new(problem: &Problem, search: MultistartResult, elapsed_ms: f64) -> Self {
        let MultistartResult { mut basins, evaluations } = search;
        let minima = basins.iter().map(|basin| Minimum {
            parameters: basin.local_fit.parameters,
            objective: problem.delta_e(&basin.local_fit.parameters).unwrap_or(f64::NAN),
            stop_reason: basin.local_fit.stop_reason,
            hits: basin.hits,
        });
        let mut minima: Vec<Minimum> = minima.collect();
        let LocalFit { parameters, sum_of_squares, mut stop_reason, trace, path, .. } = basins.swap_remove(0).local_fit;
        let at_bound: ParameterSet =
            problem.free().iter().copied().filter(|&parameter| edge(problem, &parameters, parameter).is_some()).collect();
        let uncertainty = Uncertainty::at(problem, &parameters, sum_of_squares, pressed(problem, &parameters, at_bound));
        let parameters = with_idle_ones_back(problem, parameters, sum_of_squares, &uncertainty);
        let open = !uncertainty.open.is_empty() || problem.len() < problem.free().len();
        if open && !matches!(stop_reason, StopReason::NoData | StopReason::Cancelled | StopReason::Numerical | StopReason::EvaluationLimit)
        {
            stop_reason = StopReason::Underdetermined;
        }
        let estimates = problem.model().parameters().iter().map(|parameter| Estimate {
            parameter,
            start: problem.start()[parameter],
            value: parameters[parameter],
            free: problem.free().contains(&parameter),
            std_error: uncertainty.standard_error(parameter),
            at_bound: problem.free().contains(&parameter).then(|| edge(problem, &parameters, parameter)).flatten(),
            determined: uncertainty.determined.contains(&parameter),
        });
        let objective = (!problem.is_empty()).then(|| problem.delta_e(&parameters)).flatten();
        let in_data_units = sum_of_squares * problem.sum_of_squares_scale();
        if let Some(best) = minima.first_mut() {
            best.stop_reason = stop_reason;
        }
        Self {
            model: problem.model(),
            estimates: estimates.collect(),
            objective,
            start_objective: problem.delta_e(problem.start()),
            sum_of_squares: if problem.is_empty() { 0.0 } else { in_data_units },
            start_sum_of_squares: problem.sum_of_squares(problem.start()).map(|sum| sum * problem.sum_of_squares_scale()),
            minimises_delta_e: problem.minimises_delta_e(),
            loss_scales: problem.loss_scales(),
            chi2: (problem.options().weights == Weights::Sigma).then_some(sum_of_squares),
            dof: problem.len().saturating_sub(uncertainty.rank),
            aicc: aicc(problem, in_data_units),
            stop_reason,
            evaluations,
            elapsed_ms,
            correlations: uncertainty.correlations(),
            determined: uncertainty.determined.clone(),
            undetermined: uncertainty.open.clone(),
            band: PredictionBand::new(problem, &parameters, uncertainty),
            minima,
            trace,
            path,
            parameters,
        }
    }
}

/// Parameters that have no effect at the solution, each by itself, go back to where they began, if that changes nothing: the fit
/// took them nowhere on purpose.
fn with_idle_ones_back(problem: &Problem, parameters: Parameters, sum_of_squares: f64, uncertainty: &Uncertainty) -> Parameters {
    uncertainty.open.iter().filter(|open| open.direction.len() == 1).fold(parameters, |so_far, open| {
        let parameter = open.direction[0].0;
        let mut back = so_far;
        back[parameter] = problem.start()[parameter];
        let is_idle = problem.sum_of_squares(&back).is_some_and(|sum| sum <= sum_of_squares * (1.0 + IDLE));
        if is_idle { back } else { so_far }
    })
}

/// Those parameters at a bound that the data press against it. One that merely came to lie there, along a direction that the data
/// leave open, takes part in the analysis of what they determine.
fn pressed(problem: &Problem, parameters: &Parameters, at_bound: ParameterSet) -> ParameterSet {
    if at_bound.is_empty() {
        return at_bound;
    }
    let part = problem.with_free(at_bound);
    let Some((residuals, jacobian)) = part.linearised(parameters) else { return at_bound };
    let is_pressed = |j: usize| {
        let column = jacobian.column(j);
        column.dot(&residuals).abs() > PRESSED * column.norm() * residuals.norm()
    };
    part.free().iter().enumerate().filter(|(j, _)| is_pressed(*j)).map(|(_, &parameter)| parameter).collect()
}

fn edge(problem: &Problem, parameters: &Parameters, parameter: Parameter) -> Option<Edge> {
    let (low, high) = problem.bounds().of(parameter);
    let fraction = (parameters[parameter] - low) / (high - low);
    if fraction <= AT_BOUND {
        Some(Edge::Lower)
    } else if fraction >= 1.0 - AT_BOUND {
        Some(Edge::Upper)
    } else {
        None
    }
}

/// `N ln(SS/N) + 2K + 2K(K + 1)/(N − K − 1)` with K = free + 1; with stated standard deviations `χ² + …` with K = free.
#[expect(clippy::cast_precision_loss, reason = "numbers of residuals and parameters")]
fn aicc(problem: &Problem, sum_of_squares: f64) -> Option<f64> {
    let n = problem.len() as f64;
    let free = problem.free().len() as f64;
    let (misfit, k) = match problem.options().weights {
        Weights::None => (n * libm::log(sum_of_squares / n), free + 1.0),
        Weights::Sigma => (sum_of_squares, free),
    };
    let rest = n - k - 1.0;
    let aicc = misfit + 2.0 * k + 2.0 * k * (k + 1.0) / rest;
    (rest > 0.0 && aicc.is_finite()).then_some(aicc)
}
