//! `fit`: the model on a measurement.

use super::arguments::Fit;
use super::failure::{Failure, INTERRUPTED};
use super::{input, interrupt, output};
use pbrdf::fit::{Bounds, Choices, Edge, FitReport, Loss, Problem, Starts, Watch, fit, free_by_default};
use pbrdf::measurement::{Measurement, append_columns, exact};
use pbrdf::model::{Parameter, ParameterSet, Parameters, Pbrdf};
use pbrdf::optics::Facet;
use pbrdf::report::fit_json;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Mutex;

pub fn run(task: &Fit) -> Result<ExitCode, Failure> {
    refuse_what_is_not_there(task)?;
    interrupt::watch();
    let bytes = input::bytes(&task.input)?;
    let measurement = input::measurement(&task.input, &bytes)?;
    let problem = problem(task, &measurement)?;
    if problem.left_out() > 0 {
        output::notice(format_args!(
            "{} measured BRDF values of 0 are left out: they have no relative or logarithmic residual.",
            problem.left_out()
        ));
    }

    let progress = Mutex::new(output::Progress::new("fitting"));
    let clock = std::time::Instant::now();
    let starts = match task.starts {
        None => Starts::Automatic,
        Some(1) => Starts::One,
        Some(count) => Starts::Exactly(count),
    };
    let report = fit(
        &problem,
        starts,
        task.seed,
        Watch {
            clock: &|| clock.elapsed().as_secs_f64() * 1e3,
            cancelled: &interrupt::asked,
            progress: &|point| {
                if let Ok(mut progress) = progress.lock() {
                    progress.tell(|| format!("{} evaluations, ΔE = {:.4e}", point.evaluations, point.objective));
                }
            },
        },
    );
    drop(progress);

    if task.json {
        let text = serde_json::to_string_pretty(&fit_json(task.model, &report)).map_err(|error| Failure::output("JSON", &error.into()))?;
        output::write(None, |out| writeln!(out, "{text}"))?;
    } else {
        output::write(None, |out| print(out, task, &measurement, &report))?;
    }
    if let Some(path) = &task.output {
        let surface = Pbrdf::new(report.model, report.parameters).map_err(|error| Failure::usage(error.to_string()))?;
        let cells = fitted_cells(&measurement, &surface, task);
        output::write(Some(path), |out| {
            append_columns(&bytes, &["dolp_model", "dolp_residual", "brdf_model", "brdf_residual"], &cells, out)
        })?;
    }
    Ok(if interrupt::asked() { ExitCode::from(INTERRUPTED) } else { ExitCode::SUCCESS })
}

fn refuse_what_is_not_there(task: &Fit) -> Result<(), Failure> {
    let later = [
        ("--loss", task.loss.is_some()),
        ("--loss-scale", task.loss_scale.is_some()),
        ("--profile", task.profile.is_some()),
        ("--bootstrap", task.bootstrap.is_some()),
    ];
    match later.into_iter().find(|(_, asked)| *asked) {
        Some((option, _)) => Err(Failure::not_yet(option)),
        None => Ok(()),
    }
}

/// The problem that the options describe.
fn problem(task: &Fit, measurement: &Measurement) -> Result<Problem, Failure> {
    let usage = |error: &dyn std::fmt::Display| Failure::usage(format!("{error}."));
    let model = task.model.model;
    let choices = Choices {
        weights: task.weights.into(),
        brdf_residuals: task.brdf_residuals.into(),
        loss: Loss::Linear,
        loss_scale: None,
        eq17: task.eq17.into(),
        dolp_only: task.model.dolp_only,
    };
    let mut free = free_by_default(model, measurement, &choices);
    let mut bounds = Bounds::default();
    for &(parameter, low, high) in &task.bounds {
        bounds.set(parameter, low, high).map_err(|error| usage(&error))?;
    }
    let mut start = Parameters::default();
    let mut given = ParameterSet::EMPTY;
    let fixed_values = task.fix.iter().filter_map(|&(parameter, value)| Some((parameter, value?)));
    for (parameter, value) in task.start.iter().copied().chain(fixed_values) {
        start[parameter] = value;
        given = given.with(parameter);
    }
    for &(parameter, _) in &task.fix {
        require_used(task, parameter)?;
        free = free.without(parameter);
    }
    for &parameter in &task.free {
        require_used(task, parameter)?;
        free = free.with(parameter);
    }
    for parameter in free {
        if !given.contains(parameter) && !bounds.contain(parameter, start[parameter]) {
            // A default that the given bounds exclude is nobody's wish.
            start[parameter] = bounds.at(parameter, 0.5);
            output::notice(format_args!("{} starts at {}, in the middle of its bounds.", parameter.key(), start[parameter]));
        }
    }
    start.validate(model.parameters()).map_err(|error| usage(&error))?;
    Problem::new(measurement, model, start, free, bounds, choices).map_err(|error| Failure::input(&task.input, error))
}

fn require_used(task: &Fit, parameter: Parameter) -> Result<(), Failure> {
    if task.model.model.parameters().contains(parameter) {
        Ok(())
    } else {
        Err(Failure::usage(format!("The model {} has no parameter {}.", task.model.key, parameter.key())))
    }
}

/// Model and residual of both quantities for each row; a quantity that was not measured or is not predicted leaves its cells empty.
fn fitted_cells(measurement: &Measurement, surface: &Pbrdf, task: &Fit) -> Vec<Vec<String>> {
    let printed_gain = match task.eq17 {
        super::arguments::Eq17::Consistent => 1.0,
        super::arguments::Eq17::Printed => surface.parameters().ks,
    };
    let pair = |model: f64, measured: Option<f64>| [exact(model), measured.map_or_else(String::new, |measured| exact(model - measured))];
    measurement
        .rows
        .iter()
        .map(|row| {
            let reflection = surface.reflection(&Facet::new(row.geometry));
            let dolp = pair(reflection.dolp / printed_gain, row.dolp.map(|dolp| dolp.value));
            let brdf =
                if task.model.dolp_only { [String::new(), String::new()] } else { pair(reflection.brdf, row.brdf.map(|brdf| brdf.value)) };
            dolp.into_iter().chain(brdf).collect()
        })
        .collect()
}

/// The report for a person.
fn print(out: &mut dyn Write, task: &Fit, measurement: &Measurement, report: &FitReport) -> io::Result<()> {
    let used = measurement.rows.iter().filter(|row| !row.masked).count();
    writeln!(out, "{}: {used} of {} rows, model {} ({})", task.input.display(), measurement.rows.len(), task.model.key, task.model.name)?;
    let number = |value: Option<f64>| value.map_or_else(|| "not defined".to_owned(), |value| format!("{value:.6e}"));
    writeln!(
        out,
        "ΔE {} -> {}   ({}, {} evaluations, {:.1} ms)",
        number(report.start_objective),
        number(report.objective),
        report.stop_reason.text(),
        report.evaluations,
        report.elapsed_ms
    )?;
    if let Some(chi2) = report.chi2 {
        writeln!(out, "χ² {chi2:.4} with {} degrees of freedom", report.dof)?;
    }
    writeln!(out, "\n{:<8} {:>14} {:>12} {:>12}", "", "value", "± std.err.", "start")?;
    for estimate in &report.estimates {
        let error = match (estimate.free, estimate.std_error, estimate.at_bound) {
            (false, ..) => "fixed".to_owned(),
            (true, _, Some(Edge::Lower)) => "at lower".to_owned(),
            (true, _, Some(Edge::Upper)) => "at upper".to_owned(),
            (true, Some(error), None) => format!("{error:.3e}"),
            (true, None, None) => "open".to_owned(),
        };
        let unit = estimate.parameter.unit();
        writeln!(out, "{:<8} {:>14.8} {error:>12} {:>12.6} {unit}", estimate.parameter.key(), estimate.value, estimate.start)?;
    }
    if !report.undetermined.is_empty() {
        writeln!(out, "\nThe data leave open:")?;
        for direction in &report.undetermined {
            writeln!(out, "  {}", direction.text)?;
        }
    }
    Ok(())
}
