//! The program pbrdf-explorer: a command line and a window on the core, the crate `pbrdf`.
//!
//! Floors, each importing only those before it: [`figure`] (the plotter), [`report`] (documents, JSON, tables), `files` (files read and
//! written), `cli`, `app` (the window). Neither `cli` nor `app` needs the other.

#[cfg(feature = "gui")]
mod app;
#[cfg(feature = "cli")]
mod cli;
pub mod figure;
#[cfg(feature = "files")]
mod files;
pub mod report;

#[cfg(not(target_arch = "wasm32"))]
use std::path::PathBuf;
use std::process::ExitCode;

/// Opens the window with files in it and returns when the user closes it; the error is a sentence.
#[cfg(not(target_arch = "wasm32"))]
type OpenWindow = fn(Vec<PathBuf>) -> Result<(), String>;

#[cfg(all(feature = "gui", not(target_arch = "wasm32")))]
const WINDOW: Option<OpenWindow> = Some(app::run);
#[cfg(all(not(feature = "gui"), not(target_arch = "wasm32")))]
const WINDOW: Option<OpenWindow> = None;

/// Runs the program as its arguments say; without arguments it opens the window.
#[cfg(all(feature = "cli", not(target_arch = "wasm32")))]
#[must_use]
pub fn run() -> ExitCode {
    cli::run(std::env::args_os(), WINDOW)
}

/// The same with other arguments, of which the first is the name of the program; returns the number of the exit code. For programs that have
/// this one within them.
#[cfg(feature = "cli")]
#[must_use]
pub fn run_with(arguments: impl IntoIterator<Item = std::ffi::OsString>) -> u8 {
    let code = cli::run(arguments, WINDOW);
    // The standard library tells exit codes apart, but does not say their numbers.
    (0..=u8::MAX).find(|&number| ExitCode::from(number) == code).unwrap_or(1)
}

/// The arguments of the program, from which completions of shells and manual pages are made.
#[cfg(feature = "cli")]
#[must_use]
pub fn command() -> clap::Command {
    cli::command()
}

/// Opens the window. This build reads no arguments.
#[cfg(all(not(feature = "cli"), not(target_arch = "wasm32")))]
#[must_use]
pub fn run() -> ExitCode {
    use std::io::Write as _;
    let result = WINDOW.map_or_else(|| Err("This build has neither a window nor a command line.".to_owned()), |open| open(Vec::new()));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            // Nobody reads a closed stderr.
            let _ = writeln!(std::io::stderr(), "{sentence}");
            ExitCode::from(2)
        }
    }
}

/// Opens the window in the page of a browser, which owns the loop of events: this returns at once.
#[cfg(target_arch = "wasm32")]
#[must_use]
pub fn run() -> ExitCode {
    #[cfg(feature = "gui")]
    app::run();
    ExitCode::SUCCESS
}
