//! The failure of a command: a sentence and an exit code.

use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Bad usage, bad input, no display.
pub const USAGE: u8 = 2;
/// Output that could not be written.
const OUTPUT: u8 = 1;
/// Interrupted, as a shell reports it for SIGINT.
pub const INTERRUPTED: u8 = 130;

/// Whether a path stands for standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// What a message calls a file.
pub fn input_name(path: &Path) -> String {
    if is_standard_input(path) { "Standard input".to_owned() } else { path.display().to_string() }
}

/// A sentence and an exit code.
#[derive(Debug)]
pub struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// Bad usage or input.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: USAGE }
    }

    /// A file that is not what it should be.
    pub fn input(path: &Path, reason: impl std::fmt::Display) -> Self {
        Self::usage(format!("{}: {reason}.", input_name(path)))
    }

    /// Several failures at once: all sentences, one a line, with the code of the first.
    pub fn all(failures: Vec<Self>) -> Self {
        let code = failures.first().map_or(USAGE, |failure| failure.code);
        Self { message: failures.into_iter().map(|failure| failure.message).collect::<Vec<_>>().join("\n"), code }
    }

    /// A file or stream that could not be written.
    pub fn output(to: impl std::fmt::Display, error: &std::io::Error) -> Self {
        Self { message: format!("{to} could not be written: {error}."), code: OUTPUT }
    }

    /// Stopped by the user before there was an answer.
    pub fn interrupted() -> Self {
        Self { message: "Interrupted.".to_owned(), code: INTERRUPTED }
    }

    /// The sentence, or the sentences, one a line.
    pub fn sentence(&self) -> &str {
        &self.message
    }

    /// Prints the sentence.
    pub fn report(self) -> ExitCode {
        // A closed stderr cannot be reported.
        let _ = writeln!(std::io::stderr(), "{}", self.message);
        ExitCode::from(self.code)
    }
}
