//! The problem that the options of `fit` and `compare` describe.

use crate::cli::arguments::ProblemArguments;
use crate::cli::failure::Failure;
use crate::cli::output;
use pbrdf::fit::{Bounds, FitOptions, Problem, ProblemError, Starts, free_by_default};
use pbrdf::measurement::Measurement;
use pbrdf::model::{ParameterSet, Parameters, Preset};
use std::path::Path;

/// Why there is no problem.
pub enum NoProblem {
    /// The options are wrong.
    Usage(String),
    /// The data do not fit the arguments.
    Data(ProblemError),
}

impl NoProblem {
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

/// How many starts are asked for.
pub fn starts(arguments: &ProblemArguments) -> Starts {
    match arguments.starts {
        None => Starts::Automatic,
        Some(1) => Starts::One,
        Some(count) => Starts::Exactly(count),
    }
}

/// The problem of fitting that preset.
pub fn problem(preset: &Preset, arguments: &ProblemArguments, measurement: &Measurement) -> Result<Problem, NoProblem> {
    let usage = |error: &dyn std::fmt::Display| NoProblem::Usage(error.to_string());
    let model = preset.model.with_dolp_formula(arguments.eq17);
    let choices = FitOptions {
        weights: arguments.weights,
        brdf_residuals: arguments.brdf_residuals,
        loss: arguments.loss,
        loss_scale: arguments.loss_scale,
        dolp_only: preset.dolp_only,
    };
    let named = arguments.start.iter().map(|(parameter, _)| parameter).chain(arguments.fix.iter().map(|(parameter, _)| parameter));
    let named = named.chain(&arguments.free).chain(arguments.bounds.iter().map(|(parameter, ..)| parameter));
    let strangers: ParameterSet = named.copied().filter(|&parameter| !model.parameters().contains(parameter)).collect();
    for parameter in strangers {
        output::notice(format_args!("The model {} has no parameter {}: what is said of it is ignored.", preset.key, parameter.key()));
    }
    let mut bounds = Bounds::default();
    for &(parameter, low, high) in &arguments.bounds {
        bounds.set(parameter, low, high).map_err(|error| usage(&error))?;
    }
    let mut start = Parameters::default();
    let mut given = ParameterSet::EMPTY;
    let fixed_values = arguments.fix.iter().filter_map(|&(parameter, value)| Some((parameter, value?)));
    for (parameter, value) in arguments.start.iter().copied().chain(fixed_values) {
        start[parameter] = value;
        given = given.with(parameter);
    }
    let mut free = free_by_default(model, measurement, &choices);
    for &(parameter, _) in &arguments.fix {
        free = free.without(parameter);
    }
    for &parameter in &arguments.free {
        free = free.union(ParameterSet::EMPTY.with(parameter).intersection(model.parameters()));
    }
    for parameter in free {
        if !given.contains(parameter) && !bounds.contain(parameter, start[parameter]) {
            // The user gave bounds but no start; the default start is outside of them.
            start[parameter] = bounds.at(parameter, 0.5);
            output::notice(format_args!("{} starts at {}, in the middle of its bounds.", parameter.key(), start[parameter]));
        }
    }
    start.validate(model.parameters()).map_err(|error| usage(&error))?;
    Problem::new(measurement, model, start, free, bounds, choices).map_err(NoProblem::Data)
}
