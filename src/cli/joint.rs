//! `fit` on several measurements, with shared and own parameters.

use crate::cli::arguments::FitArguments;
use crate::cli::documents::{data_source, write_figure, write_report};
use crate::cli::failure::Failure;
use crate::cli::fit_text::{NAME_WIDTH, notice_left_out, number, print_course, print_estimate, print_head, print_open};
use crate::cli::output;
use crate::cli::problem::{check, fitted_jointly, joint_failure, joint_problem, model, own_parameters};
use crate::cli::scans::{add_scans, is_cut_short, print_cut_short, print_scans};
use crate::cli::sets::{MeasurementSets, NamedMeasurement};
use crate::cli::watched::Watched;
use crate::files::export;
use crate::report::{
    DataSource, English, JointDocument, JointSource, ResultColumn, ResultTable, fit_comments, fitted_cells, joint_json, write_beside,
    write_fitted_sets,
};
use pbrdf::fit::{JointProblem, JointResult, JointUnknown, SetResult, UnknownName as _, bootstrap_jointly, profile_jointly};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Parameter, ParameterSet, Pbrdf};
use serde_json::json;
use std::io::{self, Write};
use std::process::ExitCode;

pub fn run(arguments: &FitArguments, sets: &MeasurementSets) -> Result<ExitCode, Failure> {
    check(&arguments.problem, sets)?;
    let own = own_parameters(arguments.own.as_ref(), model(arguments.model, &arguments.problem), sets)?;
    let problem = joint_problem(arguments.model, &arguments.problem, own, sets).map_err(|error| joint_failure(&error, sets))?;
    let profiled = profiled(arguments, &problem)?;
    let left_out: usize = problem.parts().iter().map(pbrdf::fit::Problem::left_out).sum();
    notice_left_out(left_out);
    let watched = Watched::new("fitting");
    let watch = watched.watch();
    let result = fitted_jointly(&problem, &arguments.problem, watch.as_watch());
    let profiles: Vec<_> = profiled.iter().map(|unknown| profile_jointly(&problem, &result, unknown, watch.as_watch())).collect();
    let scatter = arguments.bootstrap.map(|count| bootstrap_jointly(&problem, &result, count, arguments.problem.seed, watch.as_watch()));
    drop(watch);
    drop(watched);
    write_fitted(arguments, sets, &result)?;
    write_documents(arguments, sets, &problem, &result)?;
    if arguments.json {
        let sources: Vec<(String, usize)> =
            sets.all.iter().map(|set| (sets.path(set).display().to_string(), set.measurement.used_rows())).collect();
        let mut json = joint_json(arguments.model, &result, &sources);
        if is_cut_short(result.stop_reason, &result.course) {
            json["complete"] = json!(false);
        }
        add_scans(&mut json, &profiles, scatter.as_ref());
        output::write_json(&json)?;
    } else if let Some(format) = arguments.table {
        let column =
            |(index, set): (usize, &NamedMeasurement)| ResultColumn::of_set(set.name.clone(), &result, index, set.measurement.used_rows());
        let table = ResultTable { columns: sets.all.iter().enumerate().map(column).collect() };
        output::write(None, |out| write!(out, "{}", table.text(format, &English)))?;
    } else {
        output::write(None, |out| {
            print(out, arguments, sets, &problem, &result)?;
            print_scans(out, &profiles, scatter.as_ref())
        })?;
    }
    Ok(output::exit_code())
}

/// The unknowns whose profiles are asked for: of an own parameter, that of each measurement.
fn profiled(arguments: &FitArguments, problem: &JointProblem) -> Result<Vec<JointUnknown>, Failure> {
    let mut all = Vec::new();
    for &parameter in &arguments.profile {
        let before = all.len();
        all.extend(problem.unknowns().iter().filter(|unknown| unknown.parameter == parameter).cloned());
        if all.len() == before {
            return Err(Failure::usage(format!("{} is not free in this fit and has no profile.", parameter.key())));
        }
    }
    Ok(all)
}

/// The report and the figure that were asked for.
fn write_documents(arguments: &FitArguments, sets: &MeasurementSets, problem: &JointProblem, report: &JointResult) -> Result<(), Failure> {
    let origin = |set: &NamedMeasurement| data_source(sets.path(set), &sets.bytes[set.file]);
    let origins: Vec<DataSource> = sets.all.iter().map(origin).collect();
    let source = |(set, source)| {
        let NamedMeasurement { name, measurement, .. }: &NamedMeasurement = set;
        JointSource { name, measurement, source }
    };
    let sources: Vec<JointSource<'_>> = sets.all.iter().zip(&origins).map(source).collect();
    let (program, date) = (export::program(), export::now());
    let fitted = JointDocument { sources: &sources, problem, report, program: &program, date: &date, words: &English };
    write_report(arguments, || fitted.document())?;
    write_figure(arguments.figure.as_deref(), || fitted.figure())
}

/// All rows with the fitted columns beside them: the table itself where there is one file, else all in one table with a column `set`.
fn write_fitted(arguments: &FitArguments, sets: &MeasurementSets, result: &JointResult) -> Result<(), Failure> {
    let Some(path) = &arguments.output else { return Ok(()) };
    let surface = |fitted: &SetResult| Pbrdf::new(result.model, fitted.parameters).map_err(|error| Failure::usage(error.to_string()));
    let surfaces = result.sets.iter().map(surface).collect::<Result<Vec<_>, _>>()?;
    let estimates = result.estimates().map(|(name, estimate)| (name.key().into_owned(), estimate));
    let comments = fit_comments(arguments.model.key, result.objective, estimates.collect::<Vec<_>>());
    let dolp_only = arguments.model.dolp_only;
    let [bytes] = &sets.bytes[..] else {
        let fitted: Vec<(&Measurement, Pbrdf)> = sets.all.iter().map(|set| &set.measurement).zip(surfaces).collect();
        return output::write(Some(path), |out| write_fitted_sets(&fitted, dolp_only, &comments, out));
    };
    let mut rows: Vec<(u64, Vec<String>)> = Vec::new();
    for (set, surface) in sets.all.iter().zip(&surfaces) {
        rows.extend(set.measurement.lines.iter().copied().zip(fitted_cells(&set.measurement, surface, dolp_only)));
    }
    // The sets of a file may take turns.
    rows.sort_by_key(|row| row.0);
    let (lines, cells): (Vec<u64>, Vec<Vec<String>>) = rows.into_iter().unzip();
    output::write(Some(path), |out| write_beside(bytes, (&lines, &cells), &sets.all[0].measurement, &comments, out))
}

/// The report for a person.
fn print(
    out: &mut dyn Write,
    arguments: &FitArguments,
    sets: &MeasurementSets,
    problem: &JointProblem,
    result: &JointResult,
) -> io::Result<()> {
    let keys = |set: ParameterSet| set.iter().map(Parameter::key).collect::<Vec<_>>().join(", ");
    let own = result.model.parameters().intersection(problem.own());
    let own = if own.is_empty() { "all parameters shared".to_owned() } else { format!("own {}", keys(own)) };
    let (used, all) =
        sets.all.iter().fold((0, 0), |(used, all), set| (used + set.measurement.used_rows(), all + set.measurement.rows.len()));
    writeln!(
        out,
        "{} measurements: {used} of {all} rows, model {} ({}), {own}",
        sets.all.len(),
        arguments.model.key,
        arguments.model.name
    )?;
    print_course(out, arguments, (result.start_objective, result.objective), result.stop_reason, &result.course, &result.statistics)?;
    let width = result.estimates().map(|(name, _)| name.key().chars().count()).max().unwrap_or(0).max(NAME_WIDTH);
    print_head(out, width)?;
    for (name, estimate) in result.estimates() {
        print_estimate(out, &name.key(), width, estimate)?;
    }
    let width = sets.all.iter().map(|set| set.name.chars().count()).max().unwrap_or(0).max(NAME_WIDTH);
    writeln!(out, "\n{:<width$} {:>8} {:>14}", "", "rows", "ΔE")?;
    for (set, fitted) in sets.all.iter().zip(&result.sets) {
        writeln!(out, "{:<width$} {:>8} {:>14}", set.name, set.measurement.used_rows(), number(fitted.objective))?;
    }
    if is_cut_short(result.stop_reason, &result.course) {
        return print_cut_short(out);
    }
    print_open(out, &result.statistics, !result.correlations.parameters.is_empty(), &result.describe_undetermined())
}
