//! `fit`: the model on a measurement.

use crate::cli::arguments::FitArguments;
use crate::cli::failure::{Failure, input_name, is_standard_input};
use crate::cli::fit_text::{NAME_WIDTH, notice_left_out, print_course, print_estimate, print_head, print_open};
use crate::cli::problem::{check, fitted, joint_failure, model, own_parameters, problem};
use crate::cli::sets::MeasurementSets;
use crate::cli::watched::Watched;
use crate::cli::{interrupt, joint, output};
use crate::files::export;
use crate::report::{DataSource, English, FITTED_COLUMNS, FitDocument, ResultColumn, ResultTable, fit_json, fitted_cells};
use pbrdf::fit::{Bootstrap, BootstrapEstimate, FitResult, JointError, Problem, Profile, StopReason, bootstrap, profile};
use pbrdf::measurement::{Measurement, append_columns};
use pbrdf::model::Pbrdf;
use serde_json::{Map, Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

pub fn run(arguments: &FitArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let sets = MeasurementSets::read(&arguments.inputs)?;
    match &sets.all[..] {
        [_] => run_single(arguments, &sets),
        _ => joint::run(arguments, &sets),
    }
}

fn run_single(arguments: &FitArguments, sets: &MeasurementSets) -> Result<ExitCode, Failure> {
    let (path, bytes, measurement) = (&arguments.inputs[0], &sets.bytes[0], &sets.all[0].measurement);
    check(&arguments.problem, sets)?;
    let own = own_parameters(arguments.own.as_ref(), model(arguments.model, &arguments.problem));
    if let Some(stranger) = own.without_all(model(arguments.model, &arguments.problem).parameters()).iter().next() {
        return Err(joint_failure(&JointError::OwnOfNone(stranger), sets));
    }
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
        output::write(Some(path), |out| append_columns(bytes, &FITTED_COLUMNS, &measurement.lines, &cells, out))?;
    }
    write_documents(arguments, bytes, measurement, &problem, &report)?;
    if arguments.json {
        let mut json = fit_json(arguments.model, &report);
        if is_cut_short(&report) {
            json["complete"] = json!(false);
        }
        add_scans(&mut json, &profiles, scatter.as_ref());
        output::write_json(&json)?;
    } else if let Some(format) = arguments.table {
        let rows = measurement.rows.iter().filter(|row| !row.masked).count();
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

/// Whether an interruption left the search or its intervals without their ends.
fn is_cut_short(report: &FitResult) -> bool {
    report.stop_reason == StopReason::Cancelled || interrupt::asked() && report.course.intervals_complete == Some(false)
}

/// The report and the figure that were asked for.
fn write_documents(
    arguments: &FitArguments,
    bytes: &[u8],
    measurement: &Measurement,
    problem: &Problem,
    report: &FitResult,
) -> Result<(), Failure> {
    let path = &arguments.inputs[0];
    let file_name = path.file_name().filter(|_| !is_standard_input(path));
    let name = file_name.map_or_else(|| input_name(path), |name| name.to_string_lossy().into_owned());
    let source = DataSource { name, sha256: Some(export::sha256(bytes)) };
    let (program, date) = (export::program(), export::now());
    let fitted = FitDocument { measurement, source: &source, problem, report, program: &program, date: &date, words: &English };
    if let Some(path) = &arguments.report {
        let kind = export::report_kind(path).map_err(|error| Failure::usage(error.to_string()))?;
        export::write_report(path, kind, &fitted.document()).map_err(|error| Failure::output(path.display(), &error))?;
    }
    if let Some(path) = &arguments.figure {
        let kind = export::picture_kind(path).map_err(|error| Failure::usage(error.to_string()))?;
        let figure = fitted.figure().ok_or_else(|| Failure::usage("There is nothing to draw: no row has a value."))?;
        export::write_picture(path, kind, &figure).map_err(|error| Failure::output(path.display(), &error))?;
    }
    Ok(())
}

/// The report for a person.
fn print(out: &mut dyn Write, arguments: &FitArguments, measurement: &Measurement, report: &FitResult) -> io::Result<()> {
    let used = measurement.rows.iter().filter(|row| !row.masked).count();
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
    if is_cut_short(report) {
        return writeln!(out, "\nInterrupted: this is the best so far; intervals that were not followed to their ends are not known.");
    }
    print_open(out, &report.statistics, !report.correlations.parameters.is_empty(), &report.describe_undetermined())
}

/// Profiles and bootstrap beside the agreed keys.
fn add_scans(json: &mut Value, profiles: &[Profile], scatter: Option<&Bootstrap>) {
    let Some(object) = json.as_object_mut() else { return };
    if !profiles.is_empty() {
        let of = |profile: &Profile| {
            let Profile { points, interval68, interval95, is_complete, .. } = profile;
            let (low, high) = (interval68.low, interval68.high);
            let json = json!({ "low": low, "high": high, "interval95": interval95, "points": points, "complete": is_complete });
            (profile.parameter.key().to_owned(), json)
        };
        object.insert("profile".to_owned(), Value::Object(profiles.iter().map(of).collect::<Map<_, _>>()));
    }
    if let Some(scatter) = scatter {
        let of = |scatter: &BootstrapEstimate| {
            (scatter.parameter.key().to_owned(), json!({ "std_error": scatter.std_error, "low": scatter.low, "high": scatter.high }))
        };
        let parameters = Value::Object(scatter.estimates.iter().map(of).collect::<Map<_, _>>());
        let mut bootstrap = json!({ "replicates": scatter.replicates, "parameters": parameters });
        if let Some(bootstrap) = bootstrap.as_object_mut().filter(|_| !scatter.is_complete()) {
            bootstrap.insert("complete".to_owned(), json!(false));
        }
        object.insert("bootstrap".to_owned(), bootstrap);
    }
}

fn print_scans(out: &mut dyn Write, profiles: &[Profile], scatter: Option<&Bootstrap>) -> io::Result<()> {
    for profile in profiles {
        let (open, note) = if profile.is_complete { ("open", "") } else { ("not known", " (interrupted)") };
        let end = |end: Option<f64>| end.map_or_else(|| open.to_owned(), |value| format!("{value:.6}"));
        writeln!(
            out,
            "\nprofile of {}: one-standard-error interval {} … {}{note}",
            profile.parameter.key(),
            end(profile.interval68.low),
            end(profile.interval68.high)
        )?;
        for point in &profile.points {
            writeln!(out, "  {:>14.8} sum of squares {:.6e}, ΔE {:.6e}", point.value, point.rss, point.objective)?;
        }
    }
    let Some(scatter) = scatter else { return Ok(()) };
    let (made, of) =
        (scatter.replicates, if scatter.is_complete() { String::new() } else { format!(" of {}: interrupted", scatter.asked) });
    writeln!(out, "\nbootstrap over {made} data sets{of}: standard deviation, 16th and 84th percentile")?;
    for scatter in &scatter.estimates {
        writeln!(out, "  {:<8} {:>12.3e} {:>14.8} {:>14.8}", scatter.parameter.key(), scatter.std_error, scatter.low, scatter.high)?;
    }
    Ok(())
}
