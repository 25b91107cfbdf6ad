//! Jobs around fits run beside the window: on a desktop on threads, in a page in a worker.

use crate::app::jobs::job::JobContext;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
#[cfg(target_arch = "wasm32")]
use crate::app::platform::worker;
use crate::app::tasks::fit_work::{Watch, Work};
#[cfg(target_arch = "wasm32")]
use crate::app::tasks::messages::Message;
use crate::app::tasks::start_error::start_error;
#[cfg(target_arch = "wasm32")]
use std::cell::Cell;
#[cfg(target_arch = "wasm32")]
use std::rc::Rc;

impl<P: Send> Watch<P> for JobContext<P> {
    fn is_cancelled(&self) -> bool {
        Self::is_cancelled(self)
    }

    fn report(&self, progress: P) {
        Self::report(self, progress);
    }
}

/// Starts a job in a slot.
///
/// # Errors
/// The job does not start; a sentence.
#[cfg(not(target_arch = "wasm32"))]
pub fn start<J: Work>(spawner: &Spawner, slot: &mut Slot<J::Output, J::Progress>, name: &str, job: J) -> Result<(), String> {
    slot.start(spawner, name, move |context| job.run(context)).map_err(start_error)
}

/// Starts a job in a slot: in a worker, or where the browser has none as a task of the page, which waits for it.
///
/// # Errors
/// The page takes no tasks; a sentence.
#[cfg(target_arch = "wasm32")]
pub fn start<J: Work + Message>(spawner: &Spawner, slot: &mut Slot<J::Output, J::Progress>, name: &str, job: J) -> Result<(), String> {
    if !worker::are_there() {
        return slot.start(spawner, name, move |context| job.run(context)).map_err(start_error);
    }
    let progress = job.progress();
    let job = Rc::new(Cell::new(Some(job)));
    let asked = job.clone();
    let request = move || {
        let Some(job) = asked.take() else { return Ok(String::new()) };
        let Some(request) = job.request() else { return Err(job.run(&Unwatched)) };
        asked.set(Some(job));
        Ok(request)
    };
    slot.start_beside(spawner, request, progress, move |answer| job.take()?.receive(answer)).map_err(start_error)
}

/// Of a job that the page itself does: until it ends, nobody could cancel it.
#[cfg(target_arch = "wasm32")]
struct Unwatched;

#[cfg(target_arch = "wasm32")]
impl<P> Watch<P> for Unwatched {
    fn is_cancelled(&self) -> bool {
        false
    }

    fn report(&self, _progress: P) {}
}
