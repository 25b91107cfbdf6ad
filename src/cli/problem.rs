//! The problem that the options of `fit` and `compare` describe.

use crate::cli::arguments::ProblemArguments;
use crate::cli::failure::Failure;
use crate::cli::{output, values};
use pbrdf::fit::{Fit, FitError, FitOptions, FitResult, Intervals, Observer, Problem, ProblemError, Starts, fit, with_intervals};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Parameter, ParameterSet, Preset};
use std::path::Path;

/// Why there is no problem.
pub enum NoProblem {
    /// The options are wrong.
    Usage(String),
    /// The data do not fit the arguments.
    Data(ProblemError),
}

impl NoProblem {
    /// The row of the measurement that it is about, if it is about one.
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::Data(ProblemError::MissingSigma { row, .. }) => Some(*row),
            _ => None,
        }
    }

    /// As the failure of a command on that file.
    pub fn about(self, path: &Path, measurement: &Measurement) -> Failure {
        match self {
            Self::Data(error @ ProblemError::MissingSigma { row, .. }) => {
                let line = measurement.lines.get(row).map_or_else(String::new, |line| format!("line {line}: "));
                Failure::input(path, format!("{line}{error}"))
            }
            Self::Usage(reason) => Failure::usage(format!("{reason}.")),
            Self::Data(error @ ProblemError::StartOutsideBounds { .. }) => Failure::usage(format!("{error}.")),
            Self::Data(error) => Failure::input(path, error),
        }
    }
}

impl From<FitError> for NoProblem {
    fn from(error: FitError) -> Self {
        match error {
            FitError::Problem(error) => Self::Data(error),
            error => Self::Usage(error.to_string()),
        }
    }
}

/// The fit of a problem, with the uncertainties that are asked for.
pub fn fitted(problem: &Problem, arguments: &ProblemArguments, observer: Observer<'_>) -> FitResult {
    let result = fit(problem, starts(arguments), arguments.seed, observer);
    match arguments.intervals {
        Intervals::Profile => with_intervals(problem, result, observer),
        Intervals::Linear => result,
        Intervals::None => result.without_errors(),
    }
}

/// How many starts are asked for.
fn starts(arguments: &ProblemArguments) -> Starts {
    match arguments.starts {
        None => Starts::Automatic,
        Some(1) => Starts::One,
        Some(count) => Starts::Exactly(count),
    }
}

/// That no option says two things of one parameter.
fn check_once(arguments: &ProblemArguments) -> Result<(), NoProblem> {
    let ProblemArguments { start, fix, free, bounds, .. } = arguments;
    let fixed: Vec<Parameter> = fix.iter().map(|&(parameter, _)| parameter).collect();
    let twice = values::twice(start.iter().map(|&(parameter, _)| parameter))
        .map(|parameter| (parameter, "start"))
        .or_else(|| values::twice(fixed.iter().copied()).map(|parameter| (parameter, "fix")))
        .or_else(|| values::twice(bounds.iter().map(|&(parameter, ..)| parameter)).map(|parameter| (parameter, "bounds")));
    if let Some((parameter, option)) = twice {
        return Err(NoProblem::Usage(format!("--{option} names {} twice", parameter.key())));
    }
    match fixed.iter().find(|parameter| free.contains(parameter)) {
        Some(parameter) => Err(NoProblem::Usage(format!("--fix and --free both name {}", parameter.key()))),
        None => Ok(()),
    }
}

/// The problem of fitting that preset.
pub fn problem(preset: &Preset, arguments: &ProblemArguments, measurement: &Measurement) -> Result<Problem, NoProblem> {
    check_once(arguments)?;
    let model = preset.model.with_dolp_formula(arguments.eq17);
    let options = FitOptions {
        weights: arguments.weights,
        brdf_residuals: arguments.brdf_residuals,
        loss: arguments.loss,
        loss_scale: arguments.loss_scale,
        dolp_only: preset.dolp_only,
    };
    let started: Vec<Parameter> = arguments.start.iter().map(|&(parameter, _)| parameter).collect();
    let fixed: Vec<Parameter> = arguments.fix.iter().map(|&(parameter, _)| parameter).collect();
    let bounded: Vec<Parameter> = arguments.bounds.iter().map(|&(parameter, ..)| parameter).collect();
    let named = [&started, &fixed, &arguments.free, &bounded].into_iter().flatten();
    let strangers: ParameterSet = named.copied().filter(|&parameter| !model.parameters().contains(parameter)).collect();
    for parameter in strangers {
        output::notice(format_args!("The model {} has no parameter {}: what is said of it is ignored.", preset.key, parameter.key()));
    }
    let fit = Fit::new(measurement, model).options(options);
    let fit = arguments.bounds.iter().fold(fit, |fit, &(parameter, low, high)| fit.bound(parameter, low..=high));
    let fit = arguments.start.iter().fold(fit, |fit, &(parameter, value)| fit.start(parameter, value));
    let fit = arguments.fix.iter().fold(fit, |fit, &(parameter, value)| match value {
        Some(value) => fit.fix(parameter, value),
        None => fit.hold(parameter),
    });
    let fit = arguments.free.iter().fold(fit, |fit, &parameter| fit.free(parameter));
    let problem = fit.problem()?;
    for &parameter in problem.free() {
        let start = problem.start()[parameter];
        let is_given = started.contains(&parameter) || arguments.fix.iter().any(|&(fixed, value)| fixed == parameter && value.is_some());
        if !is_given && start != parameter.default_value() {
            output::notice(format_args!("{} starts at {start}, in the middle of its bounds.", parameter.key()));
        }
    }
    Ok(problem)
}
