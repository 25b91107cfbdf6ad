//! `compare --own`: the ladder of models on several measurements together.

use crate::cli::arguments::CompareArguments;
use crate::cli::documents::write_figure;
use crate::cli::failure::Failure;
use crate::cli::ladder;
use crate::cli::ladder::ladder_results;
use crate::cli::problem::{fitted_jointly, joint_failure, joint_problem, model, own_among};
use crate::cli::sets::MeasurementSets;
use crate::cli::verdict::{INTERRUPTED, PAIRS, verdict_text};
use crate::cli::watched::Watched;
use crate::cli::{interrupt, output};
use crate::figure::Figure;
use crate::report::{ComparedMeasurement, English, ResultColumn, ResultTable, TableFormat, comparison_figure, joint_json};
use pbrdf::fit::{DistributionComparison, FitError, GaussAtFixedSigma, JointError, JointProblem, ProblemError};
use pbrdf::model::{PRESETS, Preset};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

/// A model with its joint fit, or why there is none.
type JointModelResult = ladder::ModelResult<JointProblem>;

pub fn run(arguments: &CompareArguments, sets: &MeasurementSets) -> Result<ExitCode, Failure> {
    let presets: Vec<&'static Preset> = if arguments.models.is_empty() { PRESETS.iter().collect() } else { arguments.models.clone() };
    let results = results(&presets, arguments, sets)?;
    let is_complete = !interrupt::asked();
    let rows: Vec<usize> = sets.all.iter().map(|set| set.measurement.used_rows()).collect();
    write_figure(arguments.figure.as_deref(), || figure(sets, &results))?;
    if arguments.json {
        let sources: Vec<(String, usize)> =
            sets.all.iter().zip(&rows).map(|(set, &rows)| (sets.path(set).display().to_string(), rows)).collect();
        let of = |(preset, result): &JointModelResult| match result {
            Ok((_, result)) => joint_json(preset, result, &sources),
            Err(reason) => json!({ "model": preset.key, "skipped": reason }),
        };
        let mut json = json!({ "fits": results.iter().map(of).collect::<Vec<Value>>() });
        if !is_complete {
            json["complete"] = json!(false);
        }
        output::write_json(&json)?;
    } else if let Some(format) = arguments.table {
        output::write(None, |out| write!(out, "{}", table(sets, &rows, &results).text(format, &English)))?;
    } else {
        // A fit that was stopped on its way is worth no verdict.
        let verdicts = if is_complete { verdicts(&results) } else { vec![INTERRUPTED.to_owned()] };
        output::write(None, |out| {
            print(out, &results)?;
            write!(out, "{}", table(sets, &rows, &results).text(TableFormat::Markdown, &English))?;
            verdicts.iter().try_for_each(|verdict| writeln!(out, "\n{verdict}"))
        })?;
    }
    Ok(output::exit_code())
}

/// The joint fit of each model, in the order of the presets.
fn results(presets: &[&'static Preset], arguments: &CompareArguments, sets: &MeasurementSets) -> Result<Vec<JointModelResult>, Failure> {
    let problems = presets.iter().map(|preset| posed(arguments, sets, preset)).collect::<Result<_, _>>()?;
    Ok(ladder_results(presets, problems, |problem, observer| fitted_jointly(problem, &arguments.problem, observer)))
}

/// The problem of one model, or why there is none. Of the own parameters those count that the model has.
fn posed(arguments: &CompareArguments, sets: &MeasurementSets, preset: &'static Preset) -> Result<Result<JointProblem, String>, Failure> {
    let own = own_among(arguments.own.as_ref(), model(preset, &arguments.problem));
    match joint_problem(preset, &arguments.problem, own, sets) {
        Ok(problem) => Ok(Ok(problem)),
        Err(JointError::Fit { set, error: FitError::Problem(reason @ ProblemError::NothingToPredict) }) => {
            Ok(Err(format!("{set}: {reason}")))
        }
        Err(error) => Err(joint_failure(&error, sets)),
    }
}

/// Gauss against Cauchy, wherever both were fitted.
fn verdicts(results: &[JointModelResult]) -> Vec<String> {
    let of = |key: &str| results.iter().find(|(preset, _)| preset.key == key).and_then(|(_, result)| result.as_ref().ok());
    let verdict = |&(gauss, cauchy): &(&str, &str)| {
        let watched = Watched::new("gauss at equal median slope");
        let closures = watched.watch();
        let ((problem, gauss_fit), (_, cauchy_fit)) = (of(gauss)?, of(cauchy)?);
        let comparison = DistributionComparison::jointly(gauss_fit, cauchy_fit)?;
        let held = || GaussAtFixedSigma::jointly(problem, gauss_fit, cauchy_fit, closures.as_watch());
        Some(verdict_text((gauss, cauchy), &comparison, held))
    };
    PAIRS.iter().filter_map(verdict).collect()
}

/// The measurements with the curves of all models.
fn figure(sets: &MeasurementSets, results: &[JointModelResult]) -> Option<Figure> {
    let fits = || results.iter().filter_map(|(preset, result)| Some((*preset, &result.as_ref().ok()?.1)));
    let mut measurements = Vec::new();
    for (index, set) in sets.all.iter().enumerate() {
        let models = fits().map(|(preset, fit)| (preset, fit.model, fit.sets[index].parameters)).collect();
        measurements.push(ComparedMeasurement { name: set.name.clone(), measurement: &set.measurement, models });
    }
    comparison_figure(&measurements)
}

fn table(sets: &MeasurementSets, rows: &[usize], results: &[JointModelResult]) -> ResultTable {
    let mut columns = Vec::new();
    for (preset, result) in results.iter().filter_map(|(preset, result)| Some((preset, &result.as_ref().ok()?.1))) {
        for (index, (set, &rows)) in sets.all.iter().zip(rows).enumerate() {
            columns.push(ResultColumn::of_set(format!("{}, {}", set.name, preset.key), result, index, rows));
        }
    }
    ResultTable { columns }
}

/// Goodness of fit of each model.
fn print(out: &mut dyn Write, results: &[JointModelResult]) -> io::Result<()> {
    writeln!(out, "{:<16} {:>12} {:>10} {:>5} {:>11} {:>10}  stop", "model", "ΔE", "AICc", "dof", "evaluations", "time/ms")?;
    for (preset, result) in results {
        match result {
            Err(reason) => writeln!(out, "{:<16} skipped: {reason}", preset.key)?,
            Ok((_, result)) => writeln!(
                out,
                "{:<16} {:>12} {:>10} {:>5} {:>11} {:>10.1}  {}",
                preset.key,
                result.objective.map_or_else(|| "-".to_owned(), |value| format!("{value:.4e}")),
                result.statistics.aicc.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}")),
                result.statistics.dof,
                result.course.evaluations,
                result.course.elapsed_ms,
                result.stop_reason.text()
            )?,
        }
    }
    writeln!(out)
}
