//! What a fit is given from outside: a clock, a cancel flag, and a listener for its progress.

use serde::Serialize;

/// An improvement of the objective during a fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TracePoint {
    /// Milliseconds since the fit began.
    pub elapsed_ms: f64,
    /// Residual evaluations so far.
    pub evaluations: usize,
    /// ΔE of Eq. (18).
    pub objective: f64,
}

/// Clock, cancel flag and progress callback of a fit. The core itself reads no clock and no signal.
///
/// ```
/// use pbrdf::fit::Observer;
/// use std::time::Instant;
///
/// let begin = Instant::now();
/// let clock = || begin.elapsed().as_secs_f64() * 1e3;
/// let observer = Observer { clock: &clock, ..Observer::NONE };
/// assert!(!(observer.cancelled)());
/// ```
#[derive(Clone, Copy)]
pub struct Observer<'a> {
    /// Milliseconds since the fit began.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
    /// Whether the fit is to stop; it then returns the best point so far.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Called at each improvement, from any thread.
    pub progress: &'a (dyn Fn(TracePoint) + Sync),
}

impl Observer<'static> {
    /// No clock, no cancel, no listener.
    pub const NONE: Self = Self { clock: &|| 0.0, cancelled: &|| false, progress: &|_| {} };
}
