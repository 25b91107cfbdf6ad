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

    /// Starts a job in a worker of the page: its request goes as a text, and so do progress and result, which these functions read.
    ///
    /// # Errors
    /// The browser starts no worker.
    #[cfg(target_arch = "wasm32")]
    pub fn start_beside<T: 'static, P: 'static>(
        &self,
        request: &str,
        progress: impl Fn(&str) -> Option<P> + 'static,
        receive: impl FnOnce(&str) -> Option<T> + 'static,
    ) -> io::Result<Job<T, P>> {
        use crate::app::platform::worker::{Reply, beside};
        self.running.fetch_add(1, Ordering::Release);
        let (job, sender, context) = Job::new(self.wake.clone());
        let mut ends = Some((Completion(self.clone()), sender, receive));
        let worker = beside(request, move |reply| match reply {
            Reply::Progress(text) => progress(&text).into_iter().for_each(|progress| context.report(progress)),
            Reply::Answer(text) => {
                if let Some((_completion, sender, receive)) = ends.take()
                    && let Some(result) = receive(&text)
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
