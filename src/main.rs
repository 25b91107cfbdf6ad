//! The program: a window, and the same core without one.

#[cfg(feature = "gui")]
mod app;
mod cli;
mod export;
mod open_file;
mod write_file;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
