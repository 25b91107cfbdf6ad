//! The command line: the core without a window.
//!
//! Exit codes: 0 an answer; 2 bad usage, bad input, no display; 1 output that could not be written;
//! 130 interrupted. Errors and progress go to stderr.

mod arguments;
mod batch;
mod batch_table;
mod compare;
mod compare_joint;
mod documents;
mod draws;
mod evaluate;
mod failure;
mod fit;
mod fit_text;
mod import;
mod import_command;
mod input;
mod interrupt;
mod joint;
mod ladder;
mod metals;
mod mitsuba;
mod output;
mod picture;
mod plan;
mod posterior;
mod problem;
mod report;
mod scans;
mod sets;
mod simulate;
mod values;
mod verdict;
mod watched;

use arguments::{Arguments, Commands, ExportTarget};
use clap::{CommandFactory as _, Parser as _};
use failure::Failure;
use std::ffi::OsString;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// Opens the window with files in it and returns when the user closes it; the error is a sentence.
type OpenWindow = fn(Vec<PathBuf>) -> Result<(), String>;

/// The arguments.
pub fn command() -> clap::Command {
    Arguments::command()
}

/// With `portable`, numbers are those of a processor without fused multiply–add, and of a browser, to the bit.
const INSTRUCTIONS: &str = "PBRDF_INSTRUCTIONS";

/// Does what [`INSTRUCTIONS`] says.
fn choose_instructions() -> Result<(), Failure> {
    let Some(value) = std::env::var_os(INSTRUCTIONS) else { return Ok(()) };
    if value != "portable" {
        return Err(Failure::usage(format!("{INSTRUCTIONS}: found {value:?}, expected \"portable\".")));
    }
    let is_switched = pbrdf::model::Instructions::use_portable_only();
    let why = "this processor multiplies and adds in one rounding, always; its last digits stay other than those of a browser";
    if is_switched { Ok(()) } else { Err(Failure::usage(format!("{INSTRUCTIONS}: {why}."))) }
}

/// Runs what the arguments say; without a command opens the window, where this build has one.
pub fn run(arguments: impl IntoIterator<Item = OsString>, open_window: Option<OpenWindow>) -> ExitCode {
    if let Err(failure) = choose_instructions() {
        return failure.report();
    }
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() => return Failure::usage(sentence(&error)).report(),
        // Help and version are answers.
        Err(answer) => answer.exit(),
    };
    let result = match arguments.command {
        Some(Commands::Evaluate(arguments)) => evaluate::run(&arguments),
        Some(Commands::Fit(arguments)) => fit::run(&arguments),
        Some(Commands::Simulate(arguments)) => simulate::run(&arguments),
        Some(Commands::Compare(arguments)) => compare::run(&arguments),
        Some(Commands::Posterior(arguments)) => posterior::run(&arguments),
        Some(Commands::Plan(arguments)) => plan::run(&arguments),
        Some(Commands::Report(arguments)) => report::run(&arguments),
        Some(Commands::Picture(arguments)) => picture::run(&arguments),
        Some(Commands::Import(arguments)) => import::run(&arguments),
        Some(Commands::Export(ExportTarget::Mitsuba(arguments))) => mitsuba::run(&arguments),
        Some(Commands::Metals(arguments)) => metals::run(&arguments),
        None => window(open_window, arguments.files),
    };
    match result {
        Ok(code) => code,
        Err(failure) => failure.report(),
    }
}

/// What the argument parser has to say, in one sentence without its usage lines.
fn sentence(error: &clap::Error) -> String {
    let text = error.to_string();
    let said = text.split("\n\nUsage:").next().unwrap_or(&text).split("\n\nFor more information").next().unwrap_or(&text);
    let words = said.trim_start_matches("error: ").split_whitespace().collect::<Vec<_>>().join(" ");
    let mut letters = words.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str().trim_end_matches('.'))
}

fn window(open: Option<OpenWindow>, files: Vec<PathBuf>) -> Result<ExitCode, Failure> {
    match (open, files.first()) {
        (Some(open), _) => {
            open(files).map_err(|reason| Failure::usage(format!("{reason} The commands need no window: see pbrdf-explorer --help.")))?;
            Ok(ExitCode::SUCCESS)
        }
        (None, Some(file)) => Err(Failure::usage(format!(
            "This build has no window to open {} in; it has the commands evaluate, fit and simulate: see pbrdf-explorer --help.",
            file.display()
        ))),
        (None, None) => {
            // Nobody reads a closed stderr.
            let _ = write!(std::io::stderr(), "{}", command().render_help());
            Ok(ExitCode::from(failure::USAGE))
        }
    }
}
