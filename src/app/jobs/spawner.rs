//! Starting jobs.

use crate::app::jobs::job::{Job, JobContext, Wake};
use crate::app::platform;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// Starts jobs, which wake the window when they report or end, and counts the frames of the window.
#[derive(Clone)]
pub struct Spawner {
    wake: Wake,
    running: Arc<AtomicUsize>,
    frame: Arc<AtomicU64>,
}

/// Takes a job out of the count and wakes the window, also where the job panics or never starts.
struct Completion(Spawner);

impl Drop for Completion {
    fn drop(&mut self) {
        self.0.running.fetch_sub(1, Ordering::Release);
        (self.0.wake)();
    }
}

impl Spawner {
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self { wake: Arc::new(wake), running: Arc::default(), frame: Arc::default() }
    }

    /// Starts a job on a thread of that name.
    ///
    /// # Errors
    /// The system refuses a thread.
    pub fn start<T: Send + 'static, P: Send + 'static>(
        &self,
        name: &str,
        body: impl FnOnce(&JobContext<P>) -> T + Send + 'static,
    ) -> io::Result<Job<T, P>> {
        self.running.fetch_add(1, Ordering::Release);
        let completion = Completion(self.clone());
        let (job, sender, context) = Job::new(self.wake.clone());
        #[cfg(test)]
        let language = crate::app::text::i18n::current();
        platform::spawn(name, move || {
            // Each thread of a test has a language of its own.
            #[cfg(test)]
            crate::app::text::i18n::set(language);
            // The variables are dropped in reverse order: the channel has a result or is closed
            // before the window wakes.
            let _completion = completion;
            let sender = sender;
            // The job may be abandoned.
            let _ = sender.send(body(&context));
        })?;
        Ok(job)
    }

    /// Starts a job in a worker of the page: its request goes as a text, and so do progress and result, which these functions read. The
    /// request is made after the frame that is being drawn; where it cannot be written, it gives the result itself.
    ///
    /// # Errors
    /// The browser starts no worker.
    #[cfg(target_arch = "wasm32")]
    pub fn start_beside<T: 'static, P: 'static>(
        &self,
        request: impl FnOnce() -> Result<String, T> + 'static,
        progress: impl Fn(&str) -> Option<P> + 'static,
        receive: impl FnOnce(&str) -> Option<T> + 'static,
    ) -> io::Result<Job<T, P>> {
        use crate::app::platform::worker::{Reply, beside};
        use std::cell::Cell;
        use std::rc::Rc;
        self.running.fetch_add(1, Ordering::Release);
        let (job, sender, context) = Job::new(self.wake.clone());
        let ends = Rc::new(Cell::new(Some((Completion(self.clone()), sender))));
        let asked = ends.clone();
        let ask = move || {
            let made = request();
            let result = match made {
                Ok(text) => return Some(text),
                Err(result) => result,
            };
            if let Some((_completion, sender)) = asked.take() {
                let _ = sender.send(result);
            }
            None
        };
        let mut receive = Some(receive);
        let worker = beside(ask, move |reply| match reply {
            Reply::Progress(text) => progress(&text).into_iter().for_each(|progress| context.report(progress)),
            Reply::Answer(text) => {
                if let Some((_completion, sender)) = ends.take()
                    && let Some(result) = receive.take().and_then(|receive| receive(&text))
                {
                    let _ = sender.send(result);
                }
            }
            // The channel closes.
            Reply::Failed => drop(ends.take()),
        })?;
        Ok(job.done_by(worker))
    }

    /// Counts a frame of the window.
    pub fn begin_frame(&self) {
        self.frame.fetch_add(1, Ordering::Relaxed);
    }

    /// The number of the current frame.
    pub(super) fn frame(&self) -> u64 {
        self.frame.load(Ordering::Relaxed)
    }

    /// Whether any job runs.
    #[cfg(test)]
    pub fn is_busy(&self) -> bool {
        self.running.load(Ordering::Acquire) > 0
    }
}
