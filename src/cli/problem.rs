//! The problem that the options of `fit` and `compare` describe.

use crate::cli::arguments::ProblemArguments;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::cli::sets::MeasurementSets;
use crate::cli::values::{OwnParameters, Targeted};
use pbrdf::fit::{
    Fit, FitError, FitOptions, FitResult, Intervals, JointError, JointFit, JointProblem, JointResult, Observer, Problem, ProblemError,
    Starts, fit, fit_jointly, with_intervals,
};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Model, Parameter, ParameterSet, Preset};
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

/// The same of several measurements.
pub fn fitted_jointly(problem: &JointProblem, arguments: &ProblemArguments, observer: Observer<'_>) -> JointResult {
    fit_jointly(problem, starts(arguments), arguments.seed, arguments.intervals, observer)
}

/// How many starts are asked for.
fn starts(arguments: &ProblemArguments) -> Starts {
    match arguments.starts {
        None => Starts::Automatic,
        Some(1) => Starts::One,
        Some(count) => Starts::Exactly(count),
    }
}

/// That no option says two things of one parameter of one measurement.
pub fn check_once(arguments: &ProblemArguments) -> Result<(), String> {
    fn keys<T>(options: &[Targeted<T>]) -> Vec<(Parameter, Option<&str>)> {
        options.iter().map(|option| (option.parameter, option.set.as_deref())).collect()
    }
    let ProblemArguments { start, fix, free, bounds, .. } = arguments;
    for (option, keys) in [("start", keys(start)), ("fix", keys(fix)), ("bounds", keys(bounds))] {
        if let Some((_, (twice, _))) = keys.iter().enumerate().find(|(index, key)| keys[..*index].contains(key)) {
            return Err(format!("--{option} names {} twice", twice.key()));
        }
    }
    match keys(fix).iter().find(|key| keys(free).contains(key)) {
        Some((parameter, _)) => Err(format!("--fix and --free both name {}", parameter.key())),
        None => Ok(()),
    }
}

/// The model of a preset, as the options read Eq. (17).
pub fn model(preset: &Preset, arguments: &ProblemArguments) -> Model {
    preset.model.with_dolp_formula(arguments.eq17)
}

/// Notices of parameters that options name and the model does not have.
pub fn notice_strangers(preset: &Preset, arguments: &ProblemArguments) {
    let has = model(preset, arguments).parameters();
    let started = arguments.start.iter().map(|option| option.parameter);
    let fixed = arguments.fix.iter().map(|option| option.parameter);
    let freed = arguments.free.iter().map(|option| option.parameter);
    let bounded = arguments.bounds.iter().map(|option| option.parameter);
    let strangers: ParameterSet = started.chain(fixed).chain(freed).chain(bounded).filter(|&parameter| !has.contains(parameter)).collect();
    for parameter in strangers {
        output::notice(format_args!("The model {} has no parameter {}: what is said of it is ignored.", preset.key, parameter.key()));
    }
}

/// What the options say of one measurement; `is_meant` tells whether a name in them is its own.
pub fn described<'a>(mut fit: Fit<'a>, arguments: &ProblemArguments, dolp_only: bool, is_meant: &dyn Fn(&str) -> bool) -> Fit<'a> {
    fit = fit.options(FitOptions {
        weights: arguments.weights,
        brdf_residuals: arguments.brdf_residuals,
        loss: arguments.loss,
        loss_scale: arguments.loss_scale,
        dolp_only,
        range: None,
    });
    for &Targeted { parameter, value: (low, high), .. } in in_order(&arguments.bounds, is_meant) {
        fit = fit.bound(parameter, low..=high);
    }
    for &Targeted { parameter, value, .. } in in_order(&arguments.start, is_meant) {
        fit = fit.start(parameter, value);
    }
    for &Targeted { parameter, value, .. } in in_order(&arguments.fix, is_meant) {
        fit = match value {
            Some(value) => fit.fix(parameter, value),
            None => fit.hold(parameter),
        };
    }
    in_order(&arguments.free, is_meant).into_iter().fold(fit, |fit, option| fit.free(option.parameter))
}

/// Options for all measurements, then those for that one, which overrule them.
fn in_order<'a, T>(options: &'a [Targeted<T>], is_meant: &dyn Fn(&str) -> bool) -> Vec<&'a Targeted<T>> {
    let of_all = options.iter().filter(|option| option.set.is_none());
    of_all.chain(options.iter().filter(|option| option.set.as_ref().is_some_and(|set| is_meant(set)))).collect()
}

/// Whether an option gives a parameter a value to start from.
fn is_given(arguments: &ProblemArguments, parameter: Parameter) -> bool {
    arguments.start.iter().any(|option| option.parameter == parameter)
        || arguments.fix.iter().any(|option| option.parameter == parameter && option.value.is_some())
}

/// Refuses options that contradict each other or name a measurement that is not there.
pub fn check(arguments: &ProblemArguments, sets: &MeasurementSets) -> Result<(), Failure> {
    check_once(arguments).map_err(|reason| Failure::usage(format!("{reason}.")))?;
    sets.check(arguments)
}

/// The problem of fitting that preset to one measurement.
pub fn problem(preset: &Preset, arguments: &ProblemArguments, measurement: &Measurement) -> Result<Problem, NoProblem> {
    problem_of(preset, arguments, measurement, &|_| true)
}

/// The same of one of several measurements; `is_meant` tells whether a name in the options is its own.
pub fn problem_of(
    preset: &Preset,
    arguments: &ProblemArguments,
    measurement: &Measurement,
    is_meant: &dyn Fn(&str) -> bool,
) -> Result<Problem, NoProblem> {
    check_once(arguments).map_err(NoProblem::Usage)?;
    notice_strangers(preset, arguments);
    let fit = Fit::new(measurement, model(preset, arguments));
    let problem = described(fit, arguments, preset.dolp_only, is_meant).problem()?;
    for &parameter in problem.free() {
        let start = problem.start()[parameter];
        if !is_given(arguments, parameter) && start != parameter.default_value() {
            output::notice(format_args!("{} starts at {start}, in the middle of its bounds.", parameter.key()));
        }
    }
    Ok(problem)
}

/// The problem of fitting that preset to several measurements, with those own parameters.
pub fn joint_problem(
    preset: &Preset,
    arguments: &ProblemArguments,
    own: ParameterSet,
    sets: &MeasurementSets,
) -> Result<JointProblem, JointError> {
    notice_strangers(preset, arguments);
    let mut fit = JointFit::new(sets.all.iter().map(|set| &set.measurement), model(preset, arguments)).own(own);
    for set in &sets.all {
        fit = fit.only(&set.name, |fit| described(fit, arguments, preset.dolp_only, &|name| sets.is_meant(set, name)))?;
    }
    fit.problem()
}

/// The parameters that each measurement has for itself; the model has them all.
pub fn own_parameters(own: Option<&OwnParameters>, model: Model, sets: &MeasurementSets) -> Result<ParameterSet, Failure> {
    let named = named_own(own, model);
    match named.without_all(model.parameters()).iter().next() {
        Some(stranger) => Err(joint_failure(&JointError::OwnOfNone(stranger), sets)),
        None => Ok(named),
    }
}

/// The same of one model among several: of the named parameters those that it has.
pub fn own_among(own: Option<&OwnParameters>, model: Model) -> ParameterSet {
    named_own(own, model).intersection(model.parameters())
}

fn named_own(own: Option<&OwnParameters>, model: Model) -> ParameterSet {
    match own {
        None => ParameterSet::EMPTY,
        Some(OwnParameters::All) => model.parameters(),
        Some(OwnParameters::These(these)) => *these,
    }
}

/// The failure of a command on several measurements.
pub fn joint_failure(error: &JointError, sets: &MeasurementSets) -> Failure {
    if let JointError::Fit { set, error: FitError::Problem(reason @ ProblemError::MissingSigma { .. }) } = error
        && let Some(found) = sets.all.iter().find(|found| found.name == *set)
    {
        return NoProblem::Data(reason.clone()).about(sets.path(found), &found.measurement);
    }
    let hint = error.hint().map_or_else(String::new, |hint| format!("; {hint}"));
    let text = error.to_string();
    let mut letters = text.chars();
    let first = letters.next().filter(|_| !matches!(error, JointError::Fit { .. } | JointError::SharedDiffers { .. }));
    let text = first.map_or(text.clone(), |first| first.to_uppercase().to_string() + letters.as_str());
    Failure::usage(format!("{text}{hint}."))
}
