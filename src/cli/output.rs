//! Output of answers, notices and progress.

use crate::cli::failure::{Failure, INTERRUPTED};
use crate::cli::interrupt;
use crate::files::write_file::write_file;
use std::io::{self, IsTerminal as _, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Writes a file atomically, or stdout without a path.
pub fn write(path: Option<&Path>, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    match path {
        Some(path) => write_file(path, body).map_err(|error| Failure::output(path.display(), &error)),
        None => {
            let mut out = io::BufWriter::new(io::stdout().lock());
            body(&mut out).and_then(|()| out.flush()).map_err(|error| Failure::output("Standard output", &error))
        }
    }
}

/// Progress on stderr from 0.2 s on: every 0.2 s on a terminal, every 2 s elsewhere.
pub struct Progress {
    what: &'static str,
    begun: Instant,
    last: Option<Instant>,
    is_terminal: bool,
}

impl Progress {
    /// Starts the clock; `what` names the task.
    pub fn new(what: &'static str) -> Self {
        Self { what, begun: Instant::now(), last: None, is_terminal: io::stderr().is_terminal() }
    }

    /// Prints the progress if the pause is over.
    pub fn tell(&mut self, how_far: impl FnOnce() -> String) {
        let pause = Duration::from_millis(if self.is_terminal { 200 } else { 2000 });
        let waited = self.last.map_or(self.begun.elapsed() >= Duration::from_millis(200), |last| last.elapsed() >= pause);
        if waited {
            self.last = Some(Instant::now());
            let (start, end) = if self.is_terminal { ("\r\x1b[K", "") } else { ("", "\n") };
            self.print(format_args!("{start}{}: {}{end}", self.what, how_far()));
        }
    }

    /// Prints a fraction from 0 to 1 as percent.
    pub fn tell_fraction(&mut self, done: f64) {
        self.tell(|| format!("{:.0} %", 100.0 * done));
    }

    fn print(&self, text: std::fmt::Arguments<'_>) {
        let mut stderr = io::stderr();
        // A closed stderr is no reason to stop.
        let _ = stderr.write_fmt(text).and_then(|()| stderr.flush());
    }
}

/// Runs what cannot tell how far it is, and tells meanwhile how long it takes.
pub fn while_waiting<T>(what: &'static str, work: impl FnOnce() -> T) -> T {
    let is_done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let teller = scope.spawn(|| {
            let (mut progress, begun) = (Progress::new(what), Instant::now());
            while !is_done.load(Ordering::Relaxed) {
                progress.tell(|| format!("{:.0} s", begun.elapsed().as_secs_f64()));
                std::thread::park_timeout(Duration::from_millis(200));
            }
        });
        let result = work();
        is_done.store(true, Ordering::Relaxed);
        teller.thread().unpark();
        result
    })
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.last.is_some() && self.is_terminal {
            self.print(format_args!("\r\x1b[K"));
        }
    }
}

/// Writes JSON to standard output.
pub fn write_json(json: &serde_json::Value) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(json).map_err(|error| Failure::output("JSON", &error.into()))?;
    write(None, |out| writeln!(out, "{text}"))
}

/// 0, or 130 where the answer is the best so far of an interrupted job.
pub fn exit_code() -> ExitCode {
    if interrupt::asked() { ExitCode::from(INTERRUPTED) } else { ExitCode::SUCCESS }
}

/// A line on stderr that is no error.
pub fn notice(text: impl std::fmt::Display) {
    // A closed stderr is no reason to stop.
    let _ = writeln!(io::stderr(), "{text}");
}
