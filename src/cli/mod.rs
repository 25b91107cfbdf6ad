//! Floor 6: the core without a window.
//!
//! Exit codes: 0 an answer; 2 bad usage, bad input, no display; 1 output that could not be written; 130 interrupted.
//! Errors are plain sentences on stderr; progress goes there too.

mod arguments;
mod compare;
mod evaluate;
mod failure;
mod fit;
mod input;
mod interrupt;
mod output;
mod plan;
mod problem;
mod simulate;
mod values;
mod watched;

use arguments::{Arguments, Task};
use clap::Parser as _;
use failure::Failure;
use std::process::ExitCode;

/// Runs what the arguments say.
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.task {
        Some(Task::Evaluate(task)) => evaluate::run(&task),
        Some(Task::Fit(task)) => fit::run(&task),
        Some(Task::Simulate(task)) => simulate::run(&task),
        Some(Task::Compare(task)) => compare::run(&task),
        Some(Task::Plan(task)) => plan::run(&task),
        Some(Task::Report(_)) => Err(Failure::not_yet("report")),
        Some(Task::Import(_)) => Err(Failure::not_yet("import")),
        Some(Task::Export(_)) => Err(Failure::not_yet("export")),
        Some(Task::Metals(_)) => Err(Failure::not_yet("metals")),
        None => window(arguments.file),
    };
    match result {
        Ok(code) => code,
        Err(failure) => failure.report(),
    }
}

/// Opens the window.
#[cfg(feature = "gui")]
fn window(file: Option<std::path::PathBuf>) -> Result<ExitCode, Failure> {
    crate::app::run(file).map_err(|reason| {
        Failure::usage(format!("{reason} Without a window there are the commands evaluate, fit and simulate: see pbrdf-explorer --help."))
    })?;
    Ok(ExitCode::SUCCESS)
}

/// This build has no window.
#[cfg(not(feature = "gui"))]
fn window(file: Option<std::path::PathBuf>) -> Result<ExitCode, Failure> {
    use clap::CommandFactory as _;
    match file {
        Some(file) => Err(Failure::usage(format!(
            "This build has no window to open {} in; it has the commands evaluate, fit and simulate: see pbrdf-explorer --help.",
            file.display()
        ))),
        None => {
            // Nothing can be done about a stderr that is closed.
            let _ = eprint_help(&Arguments::command().render_help().to_string());
            Ok(ExitCode::from(failure::USAGE))
        }
    }
}

#[cfg(not(feature = "gui"))]
fn eprint_help(help: &str) -> std::io::Result<()> {
    use std::io::Write as _;
    write!(std::io::stderr(), "{help}")
}
