//! The result of a fit: values, uncertainties, what the data leave undetermined, and how the fit came about.

use crate::fit::estimate::{Edge, Estimate, EstimateStatus, Undetermined};
use crate::fit::fit_problem::UnknownName;
use crate::fit::intervals::band::PredictionBand;
use crate::fit::intervals::interval::Interval;
use crate::fit::intervals::linear::UndeterminedDirection;
use crate::fit::multistart::basin::{SAME_ABSOLUTE, unseen_share};
use crate::fit::objective::Problem;
use crate::fit::observer::TracePoint;
use crate::fit::stop_reason::StopReason;
use crate::model::{Model, Parameter, Parameters};
use nalgebra::DMatrix;
use serde::ser::{SerializeMap, SerializeStruct};
use serde::{Serialize, Serializer};
use std::fmt;
use std::ops::Index;

/// A distinct minimum that starts ended in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum<T = Parameters> {
    /// Where it is.
    pub parameters: T,
    /// ΔE of Eq. (18).
    pub objective: f64,
    /// Why the best start ended there.
    pub stop_reason: StopReason,
    /// How many starts ended there.
    pub hits: usize,
}

impl<T> Serialize for Minimum<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut minimum = serializer.serialize_struct("Minimum", 3)?;
        minimum.serialize_field("objective", &self.objective)?;
        minimum.serialize_field("stop_reason", &self.stop_reason)?;
        minimum.serialize_field("reached", &self.hits)?;
        minimum.end()
    }
}

/// How well a model describes the data.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Residual sum of squares, [`crate::fit::Problem::rss`].
    pub rss: f64,
    /// The same at the start; none where it is not finite.
    pub start_rss: Option<f64>,
    /// Whether what was minimised is ΔE itself.
    pub minimises_delta_e: bool,
    /// χ², where standard deviations were stated and used.
    pub chi2: Option<f64>,
    /// Degrees of freedom: number of residuals less the rank.
    pub dof: usize,
    /// Akaike's corrected criterion.
    pub aicc: Option<f64>,
    /// Scale of the robust loss for DoLP and BRDF, in units of the scaled residual.
    pub loss_scales: [f64; 2],
    /// What residuals of DoLP and BRDF were multiplied by, [`crate::fit::Problem::block_weights`].
    pub block_weights: [f64; 2],
}

/// Correlations of the determined parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlations<N = Parameter> {
    /// The determined parameters, in the order of rows and columns.
    pub parameters: Vec<N>,
    /// Correlation coefficients, −1 to 1.
    pub matrix: DMatrix<f64>,
}

impl<N: UnknownName> Serialize for Correlations<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let names: Vec<_> = self.parameters.iter().map(|parameter| parameter.key()).collect();
        let matrix: Vec<Vec<f64>> = self.matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
        let mut correlations = serializer.serialize_struct("Correlations", 2)?;
        correlations.serialize_field("names", &names)?;
        correlations.serialize_field("matrix", &matrix)?;
        correlations.end()
    }
}

/// How a fit came about.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Course<T = Parameters> {
    /// Residual evaluations of all starts.
    pub evaluations: usize,
    /// Milliseconds from the first residual evaluation to the last, by the clock of the observer.
    pub elapsed_ms: f64,
    /// Milliseconds that the intervals took; 0 without.
    pub intervals_ms: f64,
    /// Whether all intervals were followed to their ends; none without intervals.
    pub intervals_complete: Option<bool>,
    /// The distinct minima, best first; empty where they are not known.
    pub minima: Vec<Minimum<T>>,
    /// The improvements of the winning start, in their order.
    pub trace: Vec<TracePoint>,
    /// The parameters at each improvement.
    pub path: Vec<T>,
}

impl<T> Default for Course<T> {
    fn default() -> Self {
        Self {
            evaluations: 0,
            elapsed_ms: 0.0,
            intervals_ms: 0.0,
            intervals_complete: None,
            minima: Vec::new(),
            trace: Vec::new(),
            path: Vec::new(),
        }
    }
}

impl<T> Course<T> {
    /// How many starts there were.
    #[must_use]
    pub fn starts(&self) -> usize {
        self.minima.iter().map(|minimum| minimum.hits).sum()
    }

    /// How many of them ended in the best minimum.
    #[must_use]
    pub fn hits_of_best(&self) -> usize {
        self.minima.first().map_or(0, |best| best.hits)
    }

    /// The share of starts, 0 to 1, that would end in minima not seen yet, as Boender and Kan (Math. Program. 37, 59 (1987)) expect
    /// it; none after a single start.
    #[must_use]
    pub fn unseen_share(&self) -> Option<f64> {
        unseen_share(self.minima.len(), self.starts())
    }
}

/// The result of a fit.
///
/// `result[parameter]` is the estimate of a parameter of the model. `Display` lists all estimates and what is undetermined;
/// serialised, it has the keys of the JSON that the command line prints.
#[derive(Debug, Clone, PartialEq)]
pub struct FitResult {
    /// Which terms there are.
    pub model: Model,
    /// All values; those that play no part are as they were.
    pub parameters: Parameters,
    /// The model's own parameters, one by one.
    pub estimates: Vec<Estimate>,
    /// ΔE of Eq. (18), of DoLP if measured, else of BRDF; with both, the sum. None where all measured values are 0.
    pub objective: Option<f64>,
    /// The same at the start.
    pub start_objective: Option<f64>,
    /// Why the fit ended.
    pub stop_reason: StopReason,
    /// How well the model describes the data.
    pub statistics: Statistics,
    /// Correlations of the determined parameters.
    pub correlations: Correlations,
    /// Directions that the data leave undetermined.
    pub undetermined: Vec<UndeterminedDirection>,
    /// Standard errors of the fitted curves at any geometry.
    pub band: PredictionBand,
    /// How the fit came about.
    pub course: Course,
}

/// Whether a model meets its data to the last digits: ΔE, or the sum of squares where there is no ΔE, is rounding.
pub(crate) fn is_exact(stop_reason: StopReason, objective: Option<f64>, rss: f64) -> bool {
    stop_reason != StopReason::NoData && objective.unwrap_or(rss) < SAME_ABSOLUTE
}

impl FitResult {
    /// The problem as it was minimised: with the scales of the loss and the weights of DoLP and BRDF that the fit found.
    #[must_use]
    pub fn fitted(&self, problem: &Problem) -> Problem {
        problem.with_loss_scales(self.statistics.loss_scales).with_block_weights(self.statistics.block_weights)
    }

    /// Without standard errors of the parameters.
    #[must_use]
    pub fn without_errors(mut self) -> Self {
        self.estimates.iter_mut().for_each(|estimate| estimate.std_error = None);
        self
    }

    /// Whether the model meets the data to the last digits: ΔE, or the sum of squares where there is no ΔE, is rounding.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        is_exact(self.stop_reason, self.objective, self.statistics.rss)
    }

    /// The estimate of a parameter; none if the model does not have it.
    #[must_use]
    pub fn estimate(&self, parameter: Parameter) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.parameter == parameter)
    }

    /// The directions in parameter space that the data leave undetermined; each displays as a sentence.
    pub fn undetermined(&self) -> impl Iterator<Item = &UndeterminedDirection> {
        self.undetermined.iter()
    }

    /// What the data leave open: directions and, by the intervals, parameters that are not determined; without intervals, parameters
    /// that are poorly determined.
    #[must_use]
    pub fn describe_undetermined(&self) -> Vec<Undetermined> {
        let of = |is_such: &dyn Fn(&Estimate) -> bool| -> Vec<Parameter> {
            self.estimates.iter().filter(|estimate| is_such(estimate)).map(|estimate| estimate.parameter).collect()
        };
        let is_named = |parameter| self.undetermined.iter().any(|open| matches!(open.direction[..], [(only, _)] if only == parameter));
        let is_open = |estimate: &Estimate| {
            let is_undetermined = estimate.interval68.is_some() && estimate.status() == EstimateStatus::Undetermined;
            is_undetermined && !is_named(estimate.parameter)
        };
        let lists = [Undetermined::Parameters(of(&is_open)), Undetermined::Poorly(of(&Estimate::is_poorly_determined))];
        let lists = lists.into_iter().filter(|list| !list.is_empty());
        self.undetermined.iter().cloned().map(Undetermined::Direction).chain(lists).collect()
    }
}

impl Index<Parameter> for FitResult {
    type Output = Estimate;

    /// # Panics
    ///
    /// If the model does not have the parameter; [`FitResult::estimate`] does not.
    fn index(&self, parameter: Parameter) -> &Estimate {
        #[expect(clippy::expect_used, reason = "as indexing does; `estimate` is the way without")]
        self.estimate(parameter).expect("a parameter of the fitted model")
    }
}

impl fmt::Display for FitResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.stop_reason)?;
        for estimate in &self.estimates {
            writeln!(f, "{} = {estimate}", estimate.parameter.symbol())?;
        }
        self.undetermined().try_for_each(|direction| writeln!(f, "{direction}"))
    }
}

/// An estimate as JSON has it, beside its name.
#[derive(Serialize)]
struct JsonEstimate {
    value: f64,
    free: bool,
    std_error: Option<f64>,
    at_bound: Option<Edge>,
    interval68: Option<Interval>,
    interval95: Option<Interval>,
    determined: bool,
}

/// Estimates by the keys of their parameters.
pub(crate) struct ByKey<'a>(pub &'a [Estimate]);

impl Serialize for ByKey<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for &Estimate { parameter, value, free, std_error, at_bound, interval68, interval95, determined, .. } in self.0 {
            let estimate = JsonEstimate { value, free, std_error, at_bound, interval68, interval95, determined };
            map.serialize_entry(parameter.key(), &estimate)?;
        }
        map.end()
    }
}

/// How many fields [`serialize_summary`] writes.
pub(crate) const SUMMARY_FIELDS: usize = 10;

/// What the JSON of a fit says before its parameters, whether of one measurement or of several.
pub(crate) fn serialize_summary<S: SerializeStruct, P>(
    out: &mut S,
    model: Model,
    objective: Option<f64>,
    stop_reason: StopReason,
    statistics: &Statistics,
    course: &Course<P>,
) -> Result<(), S::Error> {
    out.serialize_field("distribution", model.distribution.key())?;
    out.serialize_field("objective", &objective)?;
    out.serialize_field("sum_of_squares", &statistics.rss)?;
    out.serialize_field("chi2", &statistics.chi2)?;
    out.serialize_field("dof", &statistics.dof)?;
    out.serialize_field("aicc", &statistics.aicc)?;
    out.serialize_field("stop_reason", &stop_reason)?;
    out.serialize_field("evaluations", &course.evaluations)?;
    out.serialize_field("elapsed_ms", &course.elapsed_ms)?;
    out.serialize_field("intervals_ms", &course.intervals_ms)?;
    Ok(())
}

impl Serialize for FitResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { statistics, course, .. } = self;
        let mut result = serializer.serialize_struct("FitResult", SUMMARY_FIELDS + 5)?;
        serialize_summary(&mut result, self.model, self.objective, self.stop_reason, statistics, course)?;
        result.serialize_field("parameters", &ByKey(&self.estimates))?;
        result.serialize_field("undetermined", &self.undetermined)?;
        result.serialize_field("correlations", &self.correlations)?;
        result.serialize_field("starts", &course.minima)?;
        result.serialize_field("trace", &course.trace)?;
        result.end()
    }
}
