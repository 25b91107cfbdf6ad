//! The program: a window, and the same core without one.

use std::process::ExitCode;

fn main() -> ExitCode {
    pbrdf_explorer::run()
}
