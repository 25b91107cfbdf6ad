//! `compare`: the ladder of models on one measurement, from the same starts and from the best fits of their special cases.

use crate::cli::arguments::CompareArguments;
use crate::cli::documents::write_figure;
use crate::cli::failure::Failure;
use crate::cli::ladder;
use crate::cli::ladder::ladder_results;
use crate::cli::problem::{NoProblem, check, fitted, problem_of};
use crate::cli::sets::{MeasurementSets, NamedMeasurement};
use crate::cli::verdict::{INTERRUPTED, PAIRS, verdict_text};
use crate::cli::watched::Watched;
use crate::cli::{compare_joint, interrupt, output};
use crate::figure::Figure;
use crate::report::{ComparedMeasurement, English, ResultColumn, ResultTable, comparison_figure, fit_json};
use pbrdf::fit::{DistributionComparison, EstimateStatus, FitResult, GaussAtFixedSigma, Problem, ProblemError, ends_text};
use pbrdf::measurement::Measurement;
use pbrdf::model::{PRESETS, Parameter, Preset};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

/// A model with its fit to one measurement, or why there is none.
type ModelResult = ladder::ModelResult<Problem>;

pub fn run(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let sets = MeasurementSets::read(&arguments.inputs)?;
    check(&arguments.problem, &sets)?;
    if arguments.own.is_some() && sets.all.len() > 1 {
        return compare_joint::run(arguments, &sets);
    }
    let ladders: Vec<Vec<ModelResult>> = sets.all.iter().map(|set| ladder(arguments, &sets, set)).collect::<Result<_, _>>()?;
    let is_complete = !interrupt::asked();
    write_figure(arguments.figure.as_deref(), || figure(&sets, &ladders))?;
    if arguments.json {
        let fits: Vec<Value> = sets.all.iter().zip(&ladders).flat_map(|(set, results)| json_of(&sets, set, results)).collect();
        let mut json = json!({ "fits": fits });
        if !is_complete {
            json["complete"] = json!(false);
        }
        output::write_json(&json)?;
    } else if let Some(format) = arguments.table {
        let columns = sets.all.iter().zip(&ladders).flat_map(|(set, results)| columns(&sets, set, results)).collect();
        output::write(None, |out| write!(out, "{}", ResultTable { columns }.text(format, &English)))?;
    } else {
        for (set, results) in sets.all.iter().zip(&ladders) {
            // A fit that was stopped on its way is worth no verdict.
            let verdicts = if is_complete { verdicts(results) } else { vec![INTERRUPTED.to_owned()] };
            output::write(None, |out| {
                if sets.all.len() > 1 {
                    writeln!(out, "{}", set.name)?;
                }
                print(out, &set.measurement, results)?;
                verdicts.iter().try_for_each(|verdict| writeln!(out, "\n{verdict}"))?;
                if sets.all.len() > 1 { writeln!(out) } else { Ok(()) }
            })?;
        }
    }
    Ok(output::exit_code())
}

/// The fits of a measurement as JSON, with its file where there are several measurements.
fn json_of(sets: &MeasurementSets, set: &NamedMeasurement, results: &[ModelResult]) -> Vec<Value> {
    let of = |(preset, result): &ModelResult| {
        let mut fit = match result {
            Ok((_, report)) => fit_json(preset, report),
            Err(reason) => json!({ "model": preset.key, "skipped": reason }),
        };
        if sets.all.len() > 1 {
            fit["file"] = json!(sets.path(set).display().to_string());
            fit["set"] = json!(set.name);
        }
        fit
    };
    results.iter().map(of).collect()
}

/// The fits of a measurement as columns of a table.
fn columns(sets: &MeasurementSets, set: &NamedMeasurement, results: &[ModelResult]) -> Vec<ResultColumn> {
    let rows = set.measurement.used_rows();
    let title = |preset: &Preset| if sets.all.len() > 1 { format!("{}, {}", set.name, preset.key) } else { preset.key.to_owned() };
    let fits = results.iter().filter_map(|(preset, result)| Some((preset, &result.as_ref().ok()?.1)));
    fits.map(|(preset, fit)| ResultColumn::single(title(preset), fit, rows)).collect()
}

/// The measurements with the curves of all models.
fn figure(sets: &MeasurementSets, ladders: &[Vec<ModelResult>]) -> Option<Figure> {
    let of = |results: &Vec<ModelResult>| {
        let fits = results.iter().filter_map(|(preset, result)| Some((*preset, &result.as_ref().ok()?.1)));
        fits.map(|(preset, fit)| (preset, fit.model, fit.parameters)).collect::<Vec<_>>()
    };
    let models = ladders.iter().map(of);
    let measurement = |(set, models)| {
        let NamedMeasurement { name, measurement, .. }: &NamedMeasurement = set;
        ComparedMeasurement { name: name.clone(), measurement, models }
    };
    let measurements: Vec<ComparedMeasurement<'_>> = sets.all.iter().zip(models).map(measurement).collect();
    comparison_figure(&measurements)
}

/// The ladder of models on one measurement.
fn ladder(arguments: &CompareArguments, sets: &MeasurementSets, set: &NamedMeasurement) -> Result<Vec<ModelResult>, Failure> {
    let presets: Vec<&'static Preset> = if arguments.models.is_empty() { PRESETS.iter().collect() } else { arguments.models.clone() };
    let problems = problems(&presets, arguments, sets, set)?;
    Ok(ladder_results(&presets, problems, |problem, observer| fitted(problem, &arguments.problem, observer)))
}

/// The problem of each model, or why there is none.
fn problems(
    presets: &[&'static Preset],
    arguments: &CompareArguments,
    sets: &MeasurementSets,
    set: &NamedMeasurement,
) -> Result<Vec<Result<Problem, String>>, Failure> {
    let of = |preset: &&'static Preset| match problem_of(preset, &arguments.problem, &set.measurement, &|name| sets.is_meant(set, name)) {
        Ok(problem) => Ok(Ok(problem)),
        Err(NoProblem::Data(reason @ ProblemError::NothingToPredict)) => Ok(Err(reason.to_string())),
        Err(other) => Err(other.about(sets.path(set), &set.measurement)),
    };
    presets.iter().map(of).collect()
}

/// Gauss against Cauchy, wherever both were fitted.
fn verdicts(results: &[ModelResult]) -> Vec<String> {
    let of = |key: &str| results.iter().find(|(preset, _)| preset.key == key).and_then(|(_, result)| result.as_ref().ok());
    let verdict = |&(gauss, cauchy): &(&str, &str)| {
        let watched = Watched::new("gauss at equal median slope");
        let closures = watched.watch();
        let ((problem, gauss_fit), (_, cauchy_fit)) = (of(gauss)?, of(cauchy)?);
        let contest = DistributionComparison::new(gauss_fit, cauchy_fit)?;
        let held = || GaussAtFixedSigma::new(problem, gauss_fit, cauchy_fit, closures.as_watch());
        Some(verdict_text((gauss, cauchy), &contest, held))
    };
    PAIRS.iter().filter_map(verdict).collect()
}

/// Two tables: goodness of fit of each model, and its parameters beside the true ones of a simulation.
fn print(out: &mut dyn Write, measurement: &Measurement, results: &[ModelResult]) -> io::Result<()> {
    writeln!(
        out,
        "{:<16} {:>12} {:>12} {:>10} {:>5} {:>11} {:>10}  stop",
        "model", "ΔE", "χ²/dof", "AICc", "dof", "evaluations", "time/ms"
    )?;
    for (preset, result) in results {
        match result {
            Err(reason) => writeln!(out, "{:<16} skipped: {reason}", preset.key)?,
            Ok((_, report)) => {
                let number = |value: Option<f64>, digits: usize| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"));
                #[expect(clippy::cast_precision_loss, reason = "degrees of freedom")]
                let reduced = report.statistics.chi2.map(|chi2| chi2 / report.statistics.dof as f64);
                writeln!(
                    out,
                    "{:<16} {:>12} {:>12} {:>10} {:>5} {:>11} {:>10.1}  {}",
                    preset.key,
                    report.objective.map_or_else(|| "-".to_owned(), |value| format!("{value:.4e}")),
                    number(reduced, 4),
                    number(report.statistics.aicc, 1),
                    report.statistics.dof,
                    report.course.evaluations,
                    report.course.elapsed_ms,
                    report.stop_reason.text()
                )?;
            }
        }
    }
    let fits: Vec<(&str, &FitResult)> =
        results.iter().filter_map(|(preset, result)| Some((preset.key, &result.as_ref().ok()?.1))).collect();
    let is_simulated = measurement.metadata("simulated") == Some("true");
    // In the table of a fit the truth has a name of its own.
    let stated = |parameter: Parameter| {
        let key = parameter.key();
        measurement.metadata(key).or_else(|| measurement.metadata(&format!("simulated_{key}")))
    };
    let truth = |parameter: Parameter| stated(parameter).filter(|_| is_simulated);
    write!(out, "\n{:<9}", "")?;
    for (key, _) in &fits {
        write!(out, " {key:>22}")?;
    }
    writeln!(out, " {:>10}", if is_simulated { "truth" } else { "" })?;
    for parameter in Parameter::ALL {
        write!(out, "{:<9}", parameter.key())?;
        for (_, report) in &fits {
            let cell = report.estimates.iter().find(|estimate| estimate.parameter == parameter).map_or_else(
                || "-".to_owned(),
                |estimate| match estimate.status() {
                    EstimateStatus::Fixed => format!("{:.5} fixed", estimate.value),
                    EstimateStatus::AtBound(_) => format!("{:.5} at bound", estimate.value),
                    EstimateStatus::Determined(error) => format!("{:.5} ± {error:.1e}", estimate.value),
                    EstimateStatus::UncertaintyUnknown => format!("{:.5} ± unknown", estimate.value),
                    EstimateStatus::Within(interval) => format!("{:.5} {}", estimate.value, ends_text(estimate.value, interval)),
                    EstimateStatus::Undetermined => format!("{:.5} open", estimate.value),
                },
            );
            write!(out, " {cell:>22}")?;
        }
        writeln!(out, " {:>10}", truth(parameter).unwrap_or(""))?;
    }
    Ok(())
}
