//! A joint fit, described step by step and run.

use crate::fit::builder::{Fit, FitError};
use crate::fit::intervals::profile::profile_all;
use crate::fit::joint::problem::JointProblem;
use crate::fit::joint::result::JointResult;
use crate::fit::multistart::search::Starts;
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::{FitOptions, Intervals};
use crate::fit::solve::solve;
use crate::fit::ties::{Tie, resolve_ties};
use crate::measurement::Measurement;
use crate::model::{Model, Parameter, ParameterSet};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Why several measurements cannot be fitted together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum JointError {
    /// No measurement at all.
    #[error("there is no measurement to fit")]
    NoMeasurement,
    /// Two measurements have the same name.
    #[error("two measurements are called {0}")]
    NameTwice(String),
    /// No measurement has that name.
    #[error("no measurement is called {name}; there are {known}")]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// A parameter that no measurement can have for itself, since the model does not have it.
    #[error("no measurement can have its own {}: the model does not have this parameter", .0.key())]
    OwnOfNone(Parameter),
    /// Something is said of one measurement about a parameter that all share.
    #[error("{} is shared, and what is said of it for {set} differs from the others", .parameter.key())]
    SharedDiffers {
        /// Which parameter.
        parameter: Parameter,
        /// The measurement.
        set: String,
    },
    /// The weight of a measurement is not above 0.
    #[error("the weight of {set} is {weight}: expected a number above 0")]
    Weight {
        /// The measurement.
        set: String,
        /// Its weight.
        weight: f64,
    },
    /// One measurement cannot be fitted.
    #[error("{set}: {error}")]
    Fit {
        /// The measurement.
        set: String,
        /// Why.
        error: FitError,
    },
}

impl JointError {
    /// What to do about it, where there is more to say than the error says.
    #[must_use]
    pub fn hint(&self) -> Option<&'static str> {
        match self {
            Self::NameTwice(_) => Some("give each measurement a name of its own"),
            Self::SharedDiffers { .. } => Some("make it an own parameter"),
            Self::Fit { error, .. } => error.hint(),
            Self::NoMeasurement | Self::UnknownName { .. } | Self::OwnOfNone(_) | Self::Weight { .. } => None,
        }
    }
}

/// A fit of a model to several measurements, with parameters that all share and parameters that each has for itself.
///
/// What [`Fit`] says of one measurement holds for each; without own parameters the measurements are fitted as one. k_s, if shared, is free
/// where any of them has a BRDF. Names are those of the measurements, or 1, 2, … where they have none.
///
/// ```
/// use pbrdf::Parameter::{K, Kd, Kv, Ks, N};
/// use pbrdf::fit::{Intervals, JointFit};
/// use pbrdf::{Measurement, Model};
///
/// let blue = Measurement::read("theta_i,theta_r,dolp\n30,40,0.127\n50,50,0.268\n60,60,0.398\n70,70,0.525\n".as_bytes())?;
/// let red = Measurement::read("theta_i,theta_r,dolp\n30,40,0.113\n50,50,0.240\n60,60,0.361\n70,70,0.490\n".as_bytes())?;
/// let fit = JointFit::new([&blue, &red], Model::SPECULAR).own([N, K]).start(K, 3.0).intervals(Intervals::Linear);
/// let result = fit.run()?;
/// assert!(result.sets[0].own[0].value < result.sets[1].own[0].value);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
#[must_use = "a fit does nothing until it is run"]
pub struct JointFit<'a> {
    fits: Vec<Fit<'a>>,
    names: Vec<Arc<str>>,
    model: Model,
    own: ParameterSet,
    weights: Vec<f64>,
    starts: Starts,
    seed: u64,
    intervals: Intervals,
    observer: Observer<'a>,
}

impl<'a> JointFit<'a> {
    /// A fit of all rows that are not masked.
    pub fn new(measurements: impl IntoIterator<Item = &'a Measurement>, model: Model) -> Self {
        let (mut fits, mut names) = (Vec::new(), Vec::new());
        for (number, measurement) in (1..).zip(measurements) {
            let name = if measurement.name.is_empty() { format!("{number}") } else { measurement.name.clone() };
            names.push(Arc::from(name));
            fits.push(Fit::new(measurement, model));
        }
        let (starts, intervals, observer) = (Starts::Automatic, Intervals::Profile, Observer::NONE);
        let weights = vec![1.0; fits.len()];
        Self { fits, names, model, own: ParameterSet::EMPTY, weights, starts, seed: 1, intervals, observer }
    }

    /// Names the measurements, in their order.
    pub fn named(self, names: impl IntoIterator<Item = impl Into<Arc<str>>>) -> Self {
        let given: Vec<Arc<str>> = names.into_iter().map(Into::into).take(self.names.len()).collect();
        let rest = self.names.iter().skip(given.len()).cloned();
        Self { names: given.iter().cloned().chain(rest).collect(), ..self }
    }

    /// Gives each measurement those parameters for itself.
    pub fn own(self, parameters: impl IntoIterator<Item = Parameter>) -> Self {
        Self { own: parameters.into_iter().fold(self.own, ParameterSet::with), ..self }
    }

    /// Weighs the measurements, in their order: the squared residuals of each are multiplied by its weight over the mean weight of all rows.
    /// By default all weigh the same.
    pub fn weights(mut self, weights: impl IntoIterator<Item = f64>) -> Self {
        self.weights.iter_mut().zip(weights).for_each(|(weight, given)| *weight = given);
        self
    }

    /// Ties a parameter to another one of the same measurement, times a factor. It is each measurement's own if the other one is.
    pub fn tie(self, parameter: Parameter, factor: f64, to: Parameter) -> Self {
        self.each(|fit| fit.tie(parameter, factor, to))
    }

    /// Changes the fit of each measurement.
    pub fn each(self, change: impl FnMut(Fit<'a>) -> Fit<'a>) -> Self {
        Self { fits: self.fits.into_iter().map(change).collect(), ..self }
    }

    /// Changes the fit of one measurement.
    ///
    /// # Errors
    ///
    /// [`JointError::UnknownName`] where none has that name.
    pub fn only(mut self, name: &str, change: impl FnOnce(Fit<'a>) -> Fit<'a>) -> Result<Self, JointError> {
        let Some(index) = self.names.iter().position(|other| &**other == name) else {
            return Err(JointError::UnknownName { name: name.to_owned(), known: self.names.join(", ") });
        };
        self.fits[index] = change(self.fits[index].clone());
        Ok(self)
    }

    /// Holds a parameter at a value.
    pub fn fix(self, parameter: Parameter, value: f64) -> Self {
        self.each(|fit| fit.fix(parameter, value))
    }

    /// Frees a parameter that is not free by default.
    pub fn free(self, parameter: Parameter) -> Self {
        self.each(|fit| fit.free(parameter))
    }

    /// Starts a parameter at a value.
    pub fn start(self, parameter: Parameter, value: f64) -> Self {
        self.each(|fit| fit.start(parameter, value))
    }

    /// Bounds a parameter.
    pub fn bound(self, parameter: Parameter, range: &RangeInclusive<f64>) -> Self {
        self.each(|fit| fit.bound(parameter, range.clone()))
    }

    /// Replaces all options of the objective.
    pub fn options(self, options: FitOptions) -> Self {
        self.each(|fit| fit.options(options))
    }

    /// How many starts; by default [`Starts::Automatic`].
    pub fn starts(self, starts: Starts) -> Self {
        Self { starts, ..self }
    }

    /// Shifts the points that starts are spread over; the default is 1.
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

    /// The problem that is fitted.
    ///
    /// # Errors
    ///
    /// [`JointError`] where names, own parameters, a value, a bound, or what is measured does not allow the fit.
    pub fn problem(&self) -> Result<JointProblem, JointError> {
        if self.fits.is_empty() {
            return Err(JointError::NoMeasurement);
        }
        if let Some((_, name)) = self.names.iter().enumerate().find(|(index, name)| self.names[..*index].contains(name)) {
            return Err(JointError::NameTwice(name.to_string()));
        }
        if let Some(stranger) = self.own.without_all(self.model.parameters()).iter().next() {
            return Err(JointError::OwnOfNone(stranger));
        }
        let is_weight = |weight: f64| weight > 0.0 && weight.is_finite();
        if let Some((weight, name)) = self.weights.iter().zip(&self.names).find(|(weight, _)| !is_weight(**weight)) {
            return Err(JointError::Weight { set: name.to_string(), weight: *weight });
        }
        let own = self.own_with_ties();
        let posed = |extra: ParameterSet| -> Result<Vec<Problem>, JointError> {
            let of = |(fit, name): (&Fit<'a>, &Arc<str>)| {
                fit.problem_freeing(extra).map_err(|error| JointError::Fit { set: name.to_string(), error })
            };
            self.fits.iter().zip(&self.names).map(of).collect()
        };
        // What some data depend on is free for all that share it.
        let free = |problem: &Problem| problem.free().iter().copied().collect::<ParameterSet>();
        let shared = posed(ParameterSet::EMPTY)?.iter().map(free).fold(ParameterSet::EMPTY, ParameterSet::union).without_all(own);
        let problems = posed(shared)?;
        for (problem, name) in problems.iter().zip(&self.names) {
            if let Some(parameter) = disagreement(&problems[0], problem, own) {
                return Err(JointError::SharedDiffers { parameter, set: name.to_string() });
            }
        }
        Ok(JointProblem::new(problems, &self.names, own, &self.weights))
    }

    /// The own parameters: what is tied is own where what it is tied to is.
    fn own_with_ties(&self) -> ParameterSet {
        // A circle is refused where the problem of a measurement is made.
        let ties = self.fits.iter().flat_map(|fit| resolve_ties(fit.ties()).unwrap_or_default());
        let follow = |own: ParameterSet, tie: Tie| if own.contains(tie.to) { own.with(tie.parameter) } else { own.without(tie.parameter) };
        ties.filter(|tie| self.model.parameters().contains(tie.parameter)).fold(self.own, follow)
    }

    /// Runs the fit.
    ///
    /// # Errors
    ///
    /// [`JointError`] where names, own parameters, a value, a bound, or what is measured does not allow the fit.
    pub fn run(&self) -> Result<JointResult, JointError> {
        Ok(fit_jointly(&self.problem()?, self.starts, self.seed, self.intervals, self.observer))
    }
}

/// A shared parameter in which two problems differ: free or not, where it starts, its bounds.
fn disagreement(one: &Problem, other: &Problem, own: ParameterSet) -> Option<Parameter> {
    let state = |problem: &Problem, parameter: Parameter| {
        (problem.free().contains(&parameter), problem.start()[parameter], problem.bounds().of(parameter))
    };
    let shared = one.model().parameters().without_all(own);
    shared.iter().find(|&parameter| state(one, parameter) != state(other, parameter))
}

/// Fits from one start or many, analyses what the data determine, and finds the uncertainties that are asked for.
#[must_use]
pub fn fit_jointly(problem: &JointProblem, starts: Starts, seed: u64, intervals: Intervals, observer: Observer<'_>) -> JointResult {
    let (_, analysis) = solve(problem, starts, seed, observer);
    match intervals {
        Intervals::Profile => {
            let (analysis, intervals) = profile_all(problem, analysis, observer);
            JointResult::new(problem, analysis, intervals.as_deref())
        }
        Intervals::Linear => JointResult::new(problem, analysis, None),
        Intervals::None => JointResult::new(problem, analysis, None).without_errors(),
    }
}
