//! How long work on files tells where it is, and how it is stopped.

use std::ops::ControlFlow;

/// Told which fraction of the work is done, 0 to 1; `Break` stops the work.
pub type Progress<'a> = &'a mut dyn FnMut(f64) -> ControlFlow<()>;

/// A [`Progress`] that nobody watches and nobody stops.
pub fn unwatched(_fraction: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
