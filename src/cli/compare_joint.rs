//! `compare --own`: the ladder of models on several measurements together.

use crate::cli::arguments::CompareArguments;
use crate::cli::failure::Failure;
use crate::cli::problem::{fitted_jointly, joint_failure, joint_problem, model, own_parameters};
use crate::cli::sets::MeasurementSets;
use crate::cli::watched::Watched;
use crate::cli::{interrupt, output};
use crate::report::{English, ResultColumn, ResultTable, TableFormat, joint_json};
use pbrdf::fit::{FitError, JointError, JointResult, ProblemError};
use pbrdf::model::{PRESETS, Preset};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

/// A model with its joint fit, or why there is none.
type JointModelResult = (&'static Preset, Result<JointResult, String>);

pub fn run(arguments: &CompareArguments, sets: &MeasurementSets) -> Result<ExitCode, Failure> {
    let presets: Vec<&'static Preset> = if arguments.models.is_empty() { PRESETS.iter().collect() } else { arguments.models.clone() };
    let mut results: Vec<JointModelResult> = Vec::new();
    for preset in presets {
        if interrupt::asked() {
            break;
        }
        results.push((preset, fit(arguments, sets, preset)?));
    }
    let rows: Vec<usize> = sets.all.iter().map(|set| set.measurement.rows.iter().filter(|row| !row.masked).count()).collect();
    if arguments.json {
        let sources: Vec<(String, usize)> =
            sets.all.iter().zip(&rows).map(|(set, &rows)| (sets.path(set).display().to_string(), rows)).collect();
        let of = |(preset, result): &JointModelResult| match result {
            Ok(result) => joint_json(preset, result, &sources),
            Err(reason) => json!({ "model": preset.key, "skipped": reason }),
        };
        let fits: Vec<Value> = results.iter().map(of).collect();
        output::write_json(&json!({ "fits": fits }))?;
    } else {
        output::write(None, |out| {
            if arguments.table.is_none() {
                print(out, &results)?;
            }
            let table = table(sets, &rows, &results).text(arguments.table.unwrap_or(TableFormat::Markdown), &English);
            write!(out, "{table}")
        })?;
    }
    Ok(output::exit_code())
}

/// The joint fit of one model. Of the own parameters those count that the model has.
fn fit(arguments: &CompareArguments, sets: &MeasurementSets, preset: &'static Preset) -> Result<Result<JointResult, String>, Failure> {
    let parameters = model(preset, &arguments.problem).parameters();
    let own = own_parameters(arguments.own.as_ref(), model(preset, &arguments.problem)).intersection(parameters);
    let problem = match joint_problem(preset, &arguments.problem, own, sets) {
        Ok(problem) => problem,
        Err(JointError::Fit { set, error: FitError::Problem(reason @ ProblemError::NothingToPredict) }) => {
            return Ok(Err(format!("{set}: {reason}")));
        }
        Err(error) => return Err(joint_failure(&error, sets)),
    };
    let watched = Watched::new(preset.key);
    let closures = watched.watch();
    Ok(Ok(fitted_jointly(&problem, &arguments.problem, closures.as_watch())))
}

fn table(sets: &MeasurementSets, rows: &[usize], results: &[JointModelResult]) -> ResultTable {
    let mut columns = Vec::new();
    for (preset, result) in results.iter().filter_map(|(preset, result)| Some((preset, result.as_ref().ok()?))) {
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
            Ok(result) => writeln!(
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
