//! A fit, described step by step and run.

use crate::fit::bounds::{Bounds, BoundsError};
use crate::fit::free_parameters::free_by_default;
use crate::fit::intervals::profile::with_intervals;
use crate::fit::multistart::search::Starts;
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::{FitOptions, FitRange, Intervals, Loss, Weights};
use crate::fit::problem_error::ProblemError;
use crate::fit::result::FitResult;
use crate::fit::solve::fit;
use crate::fit::ties::Tie;
use crate::measurement::Measurement;
use crate::model::{Model, Parameter, ParameterError, ParameterSet, Parameters};
use std::ops::RangeInclusive;

/// Why a fit cannot be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// A value that the model does not allow.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Bounds that are none.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
    /// Data, model and options that do not go together.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}

impl FitError {
    /// What to do about it, where there is more to say than the error says.
    #[must_use]
    pub fn hint(&self) -> Option<&'static str> {
        match self {
            Self::Problem(error) => error.hint(),
            Self::Bounds(BoundsError::Order { .. }) => Some("to hold a parameter at one value, fix it"),
            _ => None,
        }
    }
}

/// A fit of a model to a measurement.
///
/// Without further ado the parameters that [`free_by_default`] names are free, bounds are the ranges of [`Parameter::range`], and an
/// automatic search ([`Starts::Automatic`]) from the defaults of [`Parameter::default_value`] finds the minimum. What is said of a
/// parameter that the model does not have is ignored.
///
/// ```
/// use pbrdf::Parameter::{K, Ks, N};
/// use pbrdf::fit::Starts;
/// use pbrdf::{Fit, Measurement, Model};
///
/// let table = "theta_i,theta_r,dolp\n30,40,0.127\n40,40,0.166\n50,50,0.268\n60,60,0.398\n70,60,0.466\n70,70,0.525\n";
/// let data = Measurement::read(table.as_bytes())?;
/// let result = Fit::new(&data, Model::SPECULAR).fix(Ks, 1.0).bound(N, 0.1..=5.0).start(K, 3.0).starts(Starts::One).run()?;
/// assert_eq!(result[N].to_string(), "2.080 ± 0.018");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
#[must_use = "a fit does nothing until it is run"]
pub struct Fit<'a> {
    measurement: &'a Measurement,
    model: Model,
    start: Parameters,
    /// The parameters whose start was given.
    given: ParameterSet,
    fixed: ParameterSet,
    freed: ParameterSet,
    bounds: Vec<(Parameter, f64, f64)>,
    ties: Vec<Tie>,
    options: FitOptions,
    starts: Starts,
    further_starts: Vec<Parameters>,
    seed: u64,
    intervals: Intervals,
    observer: Observer<'a>,
}

impl<'a> Fit<'a> {
    /// A fit of all rows that are not masked.
    pub fn new(measurement: &'a Measurement, model: Model) -> Self {
        Self {
            measurement,
            model,
            start: Parameters::default(),
            given: ParameterSet::EMPTY,
            fixed: ParameterSet::EMPTY,
            freed: ParameterSet::EMPTY,
            bounds: Vec::new(),
            ties: Vec::new(),
            options: FitOptions::default(),
            starts: Starts::Automatic,
            further_starts: Vec::new(),
            seed: 1,
            intervals: Intervals::Profile,
            observer: Observer::NONE,
        }
    }

    /// Holds a parameter at a value.
    pub fn fix(self, parameter: Parameter, value: f64) -> Self {
        self.start(parameter, value).hold(parameter)
    }

    /// Holds a parameter at its start, by default [`Parameter::default_value`].
    pub fn hold(self, parameter: Parameter) -> Self {
        Self { fixed: self.fixed.with(parameter), ..self }
    }

    /// Frees a parameter that is not free by default, also where it was held before.
    pub fn free(self, parameter: Parameter) -> Self {
        Self { freed: self.freed.with(parameter), ..self }
    }

    /// Starts a parameter at a value.
    pub fn start(mut self, parameter: Parameter, value: f64) -> Self {
        self.start[parameter] = value;
        Self { given: self.given.with(parameter), ..self }
    }

    /// Starts all parameters at those values.
    pub fn start_at(self, start: Parameters) -> Self {
        Self { start, given: ParameterSet::ALL, ..self }
    }

    /// Bounds a parameter; the default is [`Parameter::range`]. A start that was not given and lies outside moves to the middle.
    pub fn bound(mut self, parameter: Parameter, range: RangeInclusive<f64>) -> Self {
        self.bounds.push((parameter, *range.start(), *range.end()));
        self
    }

    /// Ties a parameter to another one times a factor: it is no unknown of the fit.
    ///
    /// ```
    /// # use pbrdf::Parameter::{Kd, Kv};
    /// # use pbrdf::{Fit, Measurement, Model};
    /// # let data = Measurement::read("theta_i,theta_r,dolp\n30,40,0.127\n".as_bytes())?;
    /// let fit = Fit::new(&data, Model::CAUCHY).tie(Kv, 2.0, Kd);
    /// assert_eq!(fit.clone().tie(Kd, 0.5, Kv).problem().unwrap_err().to_string(), "kd → kv → kd is a circle");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn tie(mut self, parameter: Parameter, factor: f64, to: Parameter) -> Self {
        self.ties.push(Tie { parameter, factor, to });
        self
    }

    /// Fits the rows with those angles alone; by default all that are not masked.
    pub fn range(self, range: FitRange) -> Self {
        Self { options: FitOptions { range: Some(range), ..self.options }, ..self }
    }

    /// What its parameters are tied to.
    pub(crate) fn ties(&self) -> &[Tie] {
        &self.ties
    }

    /// Weights the residuals; by default the scale of Eq. (18) alone does.
    pub fn weights(self, weights: Weights) -> Self {
        Self { options: FitOptions { weights, ..self.options }, ..self }
    }

    /// Counts the residuals by a loss; by default by their squares.
    pub fn loss(self, loss: Loss) -> Self {
        Self { options: FitOptions { loss, ..self.options }, ..self }
    }

    /// Replaces all options of the objective.
    pub fn options(self, options: FitOptions) -> Self {
        Self { options, ..self }
    }

    /// How many starts; by default [`Starts::Automatic`].
    pub fn starts(self, starts: Starts) -> Self {
        Self { starts, ..self }
    }

    /// Starts also there, whatever else it starts from; the result is no worse than that point within the bounds.
    pub fn start_also_at(mut self, start: Parameters) -> Self {
        self.further_starts.push(start);
        self
    }

    /// Shifts the points that starts are spread over; the default is 1. The same seed gives the same result.
    pub fn seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// How the uncertainty of the parameters is found; by default by their profiles.
    pub fn intervals(self, intervals: Intervals) -> Self {
        Self { intervals, ..self }
    }

    /// Clock, cancel flag and progress callback; by default [`Observer::NONE`].
    pub fn observe(self, observer: Observer<'a>) -> Self {
        Self { observer, ..self }
    }

    /// The problem that is fitted, for profiles, bootstrap and landscapes.
    ///
    /// # Errors
    ///
    /// [`FitError`] where a value, a bound, or what is measured does not allow the fit.
    pub fn problem(&self) -> Result<Problem, FitError> {
        self.problem_freeing(ParameterSet::EMPTY)
    }

    /// The same with more parameters free by default.
    pub(crate) fn problem_freeing(&self, also: ParameterSet) -> Result<Problem, FitError> {
        let mut bounds = Bounds::default();
        for &(parameter, low, high) in &self.bounds {
            bounds.set(parameter, low, high)?;
        }
        let free = free_by_default(self.model, self.measurement, &self.options).union(also).without_all(self.fixed);
        let free = free.union(self.freed.intersection(self.model.parameters()));
        let mut start = self.start;
        for parameter in free {
            if !self.given.contains(parameter) && !bounds.contain(parameter, start[parameter]) {
                start[parameter] = bounds.at(parameter, 0.5);
            }
        }
        start.validate(self.model.parameters())?;
        let problem = Problem::new(self.measurement, self.model, start, free, bounds, self.options)?;
        let problem = if self.ties.is_empty() { problem } else { problem.with_ties(&self.ties)? };
        Ok(problem.with_further_starts(self.further_starts.clone()))
    }

    /// Runs the fit.
    ///
    /// # Errors
    ///
    /// [`FitError`] where a value, a bound, or what is measured does not allow the fit. A fit without data is a result, with
    /// [`crate::fit::StopReason::NoData`].
    pub fn run(self) -> Result<FitResult, FitError> {
        let problem = self.problem()?;
        let result = fit(&problem, self.starts, self.seed, self.observer);
        Ok(match self.intervals {
            Intervals::Profile => with_intervals(&problem, result, self.observer),
            Intervals::Linear => result,
            Intervals::None => result.without_errors(),
        })
    }
}
