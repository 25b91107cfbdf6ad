//! The observer of a fit on the terminal: clock, Ctrl-C, progress.

use crate::cli::interrupt;
use crate::cli::output::Progress;
use pbrdf::fit::{Observer, TracePoint};
use std::sync::Mutex;
use std::time::Instant;

/// Clock and progress line of a fit.
pub struct Watched {
    begun: Instant,
    progress: Mutex<Progress>,
}

/// The closures that an [`Observer`] borrows.
pub struct Closures<'a> {
    clock: Box<dyn Fn() -> f64 + Sync + 'a>,
    progress: Box<dyn Fn(TracePoint) + Sync + 'a>,
}

impl Watched {
    /// Starts the clock.
    pub fn new(what: &'static str) -> Self {
        Self { begun: Instant::now(), progress: Mutex::new(Progress::new(what)) }
    }

    /// The closures.
    pub fn watch(&self) -> Closures<'_> {
        Closures {
            clock: Box::new(|| self.begun.elapsed().as_secs_f64() * 1e3),
            progress: Box::new(|point| {
                if let Ok(mut progress) = self.progress.lock() {
                    progress.tell(|| format!("{} evaluations, ΔE = {:.4e}", point.evaluations, point.objective));
                }
            }),
        }
    }
}

impl Closures<'_> {
    /// The observer for the core.
    pub fn as_watch(&self) -> Observer<'_> {
        Observer { clock: &*self.clock, cancelled: &interrupt::asked, progress: &*self.progress }
    }
}
