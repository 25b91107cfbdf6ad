//! Fits of one measurement or of several together.

use crate::error::{refused, refused_with};
use crate::measurement::Measurement;
use crate::names::{choice, parameter, preset};
use crate::watched::watched;
use pbrdf::fit::{
    Fit, FitOptions, FitRange, FitResult, Intervals, JointFit, JointProblem, JointResult, Observer, Problem, Starts, fit_jointly,
    with_intervals,
};
use pbrdf::model::{Parameter, ParameterSet, Parameters, Preset};
use pyo3::prelude::*;
use serde_json::{Value, json};

/// How a fit is asked for. Names of parameters may carry the name of a measurement: `n@B.csv`.
#[derive(FromPyObject)]
pub struct Settings {
    model: String,
    own: Vec<String>,
    /// Without a value a parameter is held at its start.
    fix: Vec<(String, Option<f64>)>,
    free: Vec<String>,
    bounds: Vec<(String, (f64, f64))>,
    start: Vec<(String, f64)>,
    /// What is tied, the factor, and to what.
    tie: Vec<(String, f64, String)>,
    /// The angles that are fitted: θi, then θr, from and to in degrees.
    range: Option<[[f64; 2]; 2]>,
    starts: Option<usize>,
    seed: u64,
    intervals: String,
    weights: String,
    loss: String,
    loss_scale: Option<f64>,
    brdf_residuals: String,
}

/// What is said of a parameter of all measurements, or of the one of that name.
struct Said<T> {
    parameter: Parameter,
    set: Option<String>,
    what: T,
}

/// Settings, read.
pub struct Plan {
    pub preset: &'static Preset,
    own: ParameterSet,
    fix: Vec<Said<Option<f64>>>,
    free: Vec<Said<()>>,
    bounds: Vec<Said<(f64, f64)>>,
    start: Vec<Said<f64>>,
    ties: Vec<(Parameter, f64, Parameter)>,
    pub starts: Starts,
    pub seed: u64,
    pub intervals: Intervals,
    pub options: FitOptions,
}

/// Reads names, with those of measurements after an `@`; parameters that the model does not have are refused.
fn said<T>(preset: &Preset, all: Vec<(String, T)>) -> PyResult<Vec<Said<T>>> {
    let one = |(name, what): (String, T)| {
        let (key, set) = match name.split_once('@') {
            Some((key, set)) => (key, Some(set.to_owned())),
            None => (&name[..], None),
        };
        Ok(Said { parameter: parameter_of(preset, key)?, set, what })
    };
    all.into_iter().map(one).collect()
}

/// The parameter of a model of that name.
fn parameter_of(preset: &Preset, name: &str) -> PyResult<Parameter> {
    let found = parameter(name)?;
    if preset.model.parameters().contains(found) {
        return Ok(found);
    }
    let known: Vec<&str> = preset.model.parameters().iter().map(Parameter::key).collect();
    Err(refused(format_args!("the model {} has no parameter {name}; it has {}", preset.key, known.join(", "))))
}

impl Plan {
    #[allow(clippy::needless_update, reason = "the core's options may become more")]
    pub fn new(settings: Settings) -> PyResult<Self> {
        let preset = preset(&settings.model)?;
        if settings.loss_scale.is_some_and(|scale| !(scale > 0.0 && scale.is_finite())) {
            return Err(refused("loss_scale: expected a number above 0"));
        }
        Ok(Self {
            preset,
            own: settings.own.iter().map(|name| parameter_of(preset, name)).collect::<PyResult<ParameterSet>>()?,
            fix: said(preset, settings.fix)?,
            free: said(preset, settings.free.into_iter().map(|name| (name, ())).collect())?,
            bounds: said(preset, settings.bounds)?,
            start: said(preset, settings.start)?,
            ties: settings
                .tie
                .iter()
                .map(|(tied, factor, to)| Ok((parameter_of(preset, tied)?, *factor, parameter_of(preset, to)?)))
                .collect::<PyResult<_>>()?,
            starts: match settings.starts {
                None => Starts::Automatic,
                Some(0) => return Err(refused("starts = 0: expected at least 1, or None to search until nothing new is found")),
                Some(1) => Starts::One,
                Some(count) => Starts::Exactly(count),
            },
            seed: settings.seed,
            intervals: choice("intervals", &settings.intervals)?,
            options: FitOptions {
                weights: choice("weights", &settings.weights)?,
                brdf_residuals: choice("brdf_residuals", &settings.brdf_residuals)?,
                loss: choice("loss", &settings.loss)?,
                loss_scale: settings.loss_scale,
                dolp_only: preset.dolp_only,
                range: settings.range.map(|[theta_i, theta_r]| FitRange { theta_i, theta_r }),
                ..FitOptions::default()
            },
        })
    }

    /// The names of measurements that something is said of.
    pub fn sets(&self) -> impl Iterator<Item = &str> {
        let fix = self.fix.iter().map(|said| &said.set);
        let free = self.free.iter().map(|said| &said.set);
        let bounds = self.bounds.iter().map(|said| &said.set);
        let start = self.start.iter().map(|said| &said.set);
        fix.chain(free).chain(bounds).chain(start).flatten().map(String::as_str)
    }

    /// The fit of the measurement of that name: what is said of it alone comes last and counts.
    pub fn describe<'a>(&self, fit: Fit<'a>, set: &str) -> Fit<'a> {
        let fit = self.ties.iter().fold(fit.options(self.options), |fit, &(tied, factor, to)| fit.tie(tied, factor, to));
        let fit = meant(&self.bounds, set).fold(fit, |fit, said| fit.bound(said.parameter, said.what.0..=said.what.1));
        let fit = meant(&self.start, set).fold(fit, |fit, said| fit.start(said.parameter, said.what));
        let fit = meant(&self.fix, set).fold(fit, |fit, said| match said.what {
            Some(value) => fit.fix(said.parameter, value),
            None => fit.hold(said.parameter),
        });
        meant(&self.free, set).fold(fit, |fit, said| fit.free(said.parameter))
    }

    pub fn run(&self, problem: &Problem, observer: Observer<'_>) -> FitResult {
        let result = pbrdf::fit::fit(problem, self.starts, self.seed, observer);
        match self.intervals {
            Intervals::Profile => with_intervals(problem, result, observer),
            Intervals::Linear => result,
            Intervals::None => result.without_errors(),
        }
    }
}

/// What is said of all measurements, then of the one of that name.
fn meant<'b, T>(all: &'b [Said<T>], set: &'b str) -> impl Iterator<Item = &'b Said<T>> {
    let of_all = all.iter().filter(|said| said.set.is_none());
    of_all.chain(all.iter().filter(move |said| said.set.as_deref() == Some(set)))
}

/// A finished fit with its problem.
pub enum Outcome {
    /// Of one measurement.
    Single(Box<(Problem, FitResult)>),
    /// Of several together.
    Joint(Box<(JointProblem, JointResult)>),
}

/// A finished fit.
#[pyclass(frozen, module = "pbrdf._pbrdf")]
pub struct Fitted {
    pub outcome: Outcome,
    pub preset: &'static Preset,
}

/// Fits a model to one measurement, or to several together.
#[pyfunction]
pub fn fit(py: Python<'_>, measurements: Vec<Py<Measurement>>, settings: Settings, progress: Option<Py<PyAny>>) -> PyResult<Fitted> {
    let plan = Plan::new(settings)?;
    let data: Vec<&pbrdf::Measurement> = measurements.iter().map(|measurement| &measurement.get().measurement).collect();
    let names = names(&data);
    if let Some(name) = plan.sets().find(|set| !names.iter().any(|name| name == set)) {
        return Err(refused(format_args!("no measurement is called {name}; there are {}", names.join(", "))));
    }
    let outcome = if let [one] = data[..] {
        let fit = plan.describe(Fit::new(one, plan.preset.model), &names[0]);
        let problem = fit.problem().map_err(|error| refused_with(&error, error.hint()))?;
        let result = watched(py, progress.as_ref(), |watch| watch.observe(|observer| plan.run(&problem, observer)))?;
        Outcome::Single(Box::new((problem, result)))
    } else {
        let mut fit = JointFit::new(data.iter().copied(), plan.preset.model).own(plan.own.iter());
        for name in &names {
            fit = fit.only(name, |fit| plan.describe(fit, name)).map_err(|error| refused_with(&error, error.hint()))?;
        }
        let problem = fit.problem().map_err(|error| refused_with(&error, error.hint()))?;
        let result = watched(py, progress.as_ref(), |watch| {
            watch.observe(|observer| fit_jointly(&problem, plan.starts, plan.seed, plan.intervals, observer))
        })?;
        Outcome::Joint(Box::new((problem, result)))
    };
    Ok(Fitted { outcome, preset: plan.preset })
}

/// What the measurements are called: by their names, else 1, 2, …
fn names(data: &[&pbrdf::Measurement]) -> Vec<String> {
    let name = |(number, one): (usize, &&pbrdf::Measurement)| if one.name.is_empty() { number.to_string() } else { one.name.clone() };
    (1..).zip(data).map(name).collect()
}

#[pymethods]
impl Fitted {
    /// The result as the command `fit --json` prints it.
    fn json(&self) -> String {
        let mut value = match &self.outcome {
            Outcome::Single(fitted) => json!(fitted.1),
            Outcome::Joint(fitted) => json!(fitted.1),
        };
        value["model"] = Value::from(self.preset.key);
        value.to_string()
    }

    /// Each estimate in words, by its key: `n`, `n@B.csv`.
    fn estimates(&self) -> Vec<(String, String)> {
        match &self.outcome {
            Outcome::Single(fitted) => {
                fitted.1.estimates.iter().map(|estimate| (estimate.parameter.key().to_owned(), estimate.to_string())).collect()
            }
            Outcome::Joint(fitted) => {
                let key = |set: Option<&str>, key: &str| set.map_or_else(|| key.to_owned(), |set| format!("{key}@{set}"));
                let all = fitted.1.estimates();
                all.map(|(name, estimate)| (key(name.set.as_deref(), name.parameter.key()), estimate.to_string())).collect()
            }
        }
    }

    /// What the data leave open, a sentence each.
    fn open(&self) -> Vec<String> {
        match &self.outcome {
            Outcome::Single(fitted) => fitted.1.describe_undetermined().iter().map(ToString::to_string).collect(),
            Outcome::Joint(fitted) => fitted.1.describe_undetermined().iter().map(ToString::to_string).collect(),
        }
    }

    /// Why the fit ended, in words.
    fn ending(&self) -> &'static str {
        match &self.outcome {
            Outcome::Single(fitted) => fitted.1.stop_reason.text(),
            Outcome::Joint(fitted) => fitted.1.stop_reason.text(),
        }
    }

    /// The values of the model's parameters, measurement by measurement.
    fn surfaces(&self) -> Vec<Vec<(&'static str, f64)>> {
        let own = self.preset.model.parameters();
        let named = |values: &Parameters| own.iter().map(|parameter| (parameter.key(), values[parameter])).collect();
        match &self.outcome {
            Outcome::Single(fitted) => vec![named(&fitted.1.parameters)],
            Outcome::Joint(fitted) => fitted.1.sets.iter().map(|set| named(&set.parameters)).collect(),
        }
    }
}
