//! Long work on a thread of its own, while this one listens to Ctrl-C and tells of progress.

use crate::error::refused;
use pbrdf::fit::{Observer, TracePoint};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

/// How often Ctrl-C is looked for.
const GLANCE: Duration = Duration::from_millis(50);
/// Stack of the thread: as much as a main thread has on most systems.
const STACK: usize = 8 << 20;

/// What work has to tell.
enum Event {
    /// A fit came closer.
    Improved(TracePoint),
    /// The share that is done, 0 to 1.
    Share(f64),
}

/// How work learns that it is to stop, and tells how far it is.
pub struct Watch<'a> {
    begun: Instant,
    stopped: &'a AtomicBool,
    /// None where nobody listens.
    events: Option<Sender<Event>>,
}

impl Watch<'_> {
    /// Whether it is to stop.
    fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Tells the share that is done, 0 to 1.
    pub fn tell_share(&self, share: f64) {
        self.tell(Event::Share(share));
    }

    fn tell(&self, event: Event) {
        if let Some(events) = &self.events {
            // Who went away does not want to know.
            let _ = events.send(event);
        }
    }

    /// Calls a function with the observer that fits take.
    pub fn observe<T>(&self, work: impl FnOnce(Observer<'_>) -> T) -> T {
        let clock = || self.begun.elapsed().as_secs_f64() * 1e3;
        let cancelled = || self.is_stopped();
        let progress = |point: TracePoint| self.tell(Event::Improved(point));
        work(Observer { clock: &clock, cancelled: &cancelled, progress: &progress })
    }

    /// The same, telling nothing of the improvements of a fit.
    pub fn fit_quietly<T>(&self, work: impl FnOnce(Observer<'_>) -> T) -> T {
        self.observe(|observer| work(Observer { progress: &|_| {}, ..observer }))
    }
}

/// Does work without the interpreter's lock. `progress` is called with (milliseconds, evaluations, ΔE) of a fit, or with the share that is
/// done of other work.
///
/// # Errors
///
/// `KeyboardInterrupt` after Ctrl-C, what `progress` raises, or an exception where the work panics.
pub fn watched<T: Send>(py: Python<'_>, progress: Option<&Py<PyAny>>, work: impl FnOnce(&Watch<'_>) -> T + Send) -> PyResult<T> {
    let stopped = AtomicBool::new(false);
    py.detach(|| {
        thread::scope(|scope| {
            let (events, heard) = mpsc::channel();
            let listener = progress.is_some().then(|| events.clone());
            let watch = Watch { begun: Instant::now(), stopped: &stopped, events: listener };
            let worker = thread::Builder::new().name("pbrdf".to_owned()).stack_size(STACK).spawn_scoped(scope, move || {
                let done = work(&watch);
                // Its end closes the channel.
                drop(events);
                done
            });
            let worker = worker.map_err(|error| refused(format_args!("no thread could be started: {error}")))?;
            let mut failure = None;
            loop {
                let event = match heard.recv_timeout(GLANCE) {
                    Ok(event) => Some(event),
                    Err(RecvTimeoutError::Timeout) => None,
                    Err(RecvTimeoutError::Disconnected) => break,
                };
                if failure.is_none()
                    && let Err(error) = Python::attach(|py| listen(py, progress, event))
                {
                    stopped.store(true, Ordering::Relaxed);
                    failure = Some(error);
                }
            }
            let done = worker.join().map_err(|_| refused("an internal error; please report it with the arguments"))?;
            failure.map_or(Ok(done), Err)
        })
    })
}

/// Runs signal handlers and tells of an event.
fn listen(py: Python<'_>, progress: Option<&Py<PyAny>>, event: Option<Event>) -> PyResult<()> {
    py.check_signals()?;
    if let (Some(progress), Some(event)) = (progress, event) {
        match event {
            Event::Improved(TracePoint { elapsed_ms, evaluations, objective }) => {
                progress.call1(py, (elapsed_ms, evaluations, objective))?
            }
            Event::Share(share) => progress.call1(py, (share,))?,
        };
    }
    Ok(())
}
