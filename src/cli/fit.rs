//! `fit`: the model on a measurement.

use crate::cli::arguments::FitArguments;
use crate::cli::documents::{data_source, write_figure, write_report};
use crate::cli::failure::{Failure, input_name};
use crate::cli::fit_text::{NAME_WIDTH, notice_left_out, print_course, print_estimate, print_head, print_open};
use crate::cli::problem::{check, fitted, model, own_parameters, problem};
use crate::cli::scans::{add_scans, is_cut_short, print_cut_short, print_scans};
use crate::cli::sets::MeasurementSets;
use crate::cli::watched::Watched;
use crate::cli::{batch, interrupt, joint, output};
use crate::files::export;
use crate::report::{English, FitDocument, ResultColumn, ResultTable, fit_comments, fit_json, fitted_cells, write_beside};
use pbrdf::fit::{FitResult, Problem, Profile, bootstrap, profile};
use pbrdf::measurement::Measurement;
use pbrdf::model::Pbrdf;
use serde_json::json;
use std::io::{self, Write};
use std::process::ExitCode;

pub fn run(arguments: &FitArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    if arguments.batch {
        return batch::run(arguments);
    }
    let sets = MeasurementSets::read(&arguments.inputs)?;
    match &sets.all[..] {
        [_] => run_single(arguments, &sets),
        _ => joint::run(arguments, &sets),
    }
}

fn run_single(arguments: &FitArguments, sets: &MeasurementSets) -> Result<ExitCode, Failure> {
    let (path, bytes, measurement) = (&arguments.inputs[0], &sets.bytes[0], &sets.all[0].measurement);
    check(&arguments.problem, sets)?;
    own_parameters(arguments.own.as_ref(), model(arguments.model, &arguments.problem), sets)?;
    let problem = problem(arguments.model, &arguments.problem, measurement).map_err(|reason| reason.about(path, measurement))?;
    notice_left_out(problem.left_out());
    if let Some(parameter) = arguments.profile.iter().find(|parameter| !problem.free().contains(parameter)) {
        return Err(Failure::usage(format!("{} is not free in this fit and has no profile.", parameter.key())));
    }
    let watched = Watched::new("fitting");
    let watch = watched.watch();
    let report = fitted(&problem, &arguments.problem, watch.as_watch());
    let profiles: Vec<Profile> =
        arguments.profile.iter().map(|&parameter| profile(&problem, &report, parameter, watch.as_watch())).collect();
    let scatter = arguments.bootstrap.map(|count| bootstrap(&problem, &report, count, arguments.problem.seed, watch.as_watch()));
    drop(watch);
    drop(watched);

    if let Some(path) = &arguments.output {
        let surface = Pbrdf::new(report.model, report.parameters).map_err(|error| Failure::usage(error.to_string()))?;
        let cells = fitted_cells(measurement, &surface, arguments.model.dolp_only);
        let estimates = report.estimates.iter().map(|estimate| (estimate.parameter.key(), estimate));
        let comments = fit_comments(arguments.model.key, report.objective, estimates);
        output::write(Some(path), |out| write_beside(bytes, (&measurement.lines, &cells), measurement, &comments, out))?;
    }
    write_documents(arguments, bytes, measurement, &problem, &report)?;
    if arguments.json {
        let mut json = fit_json(arguments.model, &report);
        if is_cut_short(report.stop_reason, &report.course) {
            json["complete"] = json!(false);
        }
        add_scans(&mut json, &profiles, scatter.as_ref());
        output::write_json(&json)?;
    } else if let Some(format) = arguments.table {
        let rows = measurement.used_rows();
        let table = ResultTable { columns: vec![ResultColumn::single(sets.all[0].name.clone(), &report, rows)] };
        output::write(None, |out| write!(out, "{}", table.text(format, &English)))?;
    } else {
        output::write(None, |out| {
            print(out, arguments, measurement, &report)?;
            print_scans(out, &profiles, scatter.as_ref())
        })?;
    }
    Ok(output::exit_code())
}

/// The report and the figure that were asked for.
fn write_documents(
    arguments: &FitArguments,
    bytes: &[u8],
    measurement: &Measurement,
    problem: &Problem,
    report: &FitResult,
) -> Result<(), Failure> {
    let source = data_source(&arguments.inputs[0], bytes);
    let (program, date) = (export::program(), export::now());
    let fitted = FitDocument { measurement, source: &source, problem, report, program: &program, date: &date, words: &English };
    write_report(arguments, || fitted.document())?;
    write_figure(arguments.figure.as_deref(), || fitted.figure())
}

/// The report for a person.
fn print(out: &mut dyn Write, arguments: &FitArguments, measurement: &Measurement, report: &FitResult) -> io::Result<()> {
    let used = measurement.used_rows();
    writeln!(
        out,
        "{}: {used} of {} rows, model {} ({})",
        input_name(&arguments.inputs[0]),
        measurement.rows.len(),
        arguments.model.key,
        arguments.model.name
    )?;
    print_course(out, arguments, (report.start_objective, report.objective), report.stop_reason, &report.course, &report.statistics)?;
    print_head(out, NAME_WIDTH)?;
    report.estimates.iter().try_for_each(|estimate| print_estimate(out, estimate.parameter.key(), NAME_WIDTH, estimate))?;
    if is_cut_short(report.stop_reason, &report.course) {
        return print_cut_short(out);
    }
    print_open(out, &report.statistics, !report.correlations.parameters.is_empty(), &report.describe_undetermined())
}
