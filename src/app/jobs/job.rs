//! A running job: progress, cancel, result.

use crate::app::platform::Instant;
use std::sync::atomic::{AtomicBool, Ordering};
#[cfg(not(target_arch = "wasm32"))]
use std::sync::mpsc::RecvTimeoutError;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Makes the window draw a frame.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// A running job with a result `T` and a progress `P`, as its owner sees it. Dropping it asks the
/// job to stop; the result is then lost.
pub struct Job<T, P = ()> {
    receiver: Receiver<T>,
    cancelled: Arc<AtomicBool>,
    progress: Arc<Mutex<Option<P>>>,
    /// The worker of the page that does the work, if one does.
    #[cfg(target_arch = "wasm32")]
    beside: Option<crate::app::platform::worker::Beside>,
}

/// A job ended without a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Panicked;

/// What a job reports to and asks whether it is cancelled.
pub struct JobContext<P = ()> {
    cancelled: Arc<AtomicBool>,
    progress: Arc<Mutex<Option<P>>>,
    woken_at: Mutex<Instant>,
    wake: Wake,
}

/// The least time between two frames for the sake of progress.
const WAKE_INTERVAL: Duration = Duration::from_millis(60);

impl<T, P> Job<T, P> {
    /// Both ends of a job.
    pub(super) fn new(wake: Wake) -> (Self, Sender<T>, JobContext<P>) {
        let (sender, receiver) = channel();
        let job = Self {
            receiver,
            cancelled: Arc::default(),
            progress: Arc::new(Mutex::new(None)),
            #[cfg(target_arch = "wasm32")]
            beside: None,
        };
        let (cancelled, progress) = (job.cancelled.clone(), job.progress.clone());
        (job, sender, JobContext { cancelled, progress, woken_at: Mutex::new(Instant::now()), wake })
    }

    /// Asks the job to stop soon; its result, which may be a partial one, still comes.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
        #[cfg(target_arch = "wasm32")]
        self.beside.iter().for_each(crate::app::platform::worker::Beside::cancel);
    }

    /// With the worker of the page that does the work.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn done_by(self, worker: crate::app::platform::worker::Beside) -> Self {
        // `Job` has a `Drop` of its own: its fields stay together.
        let mut job = self;
        job.beside = Some(worker);
        job
    }

    /// The result, if it is there.
    ///
    /// # Errors
    /// The job panicked.
    pub fn poll(&self) -> Result<Option<T>, Panicked> {
        match self.receiver.try_recv() {
            Ok(result) => Ok(Some(result)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(Panicked),
        }
    }
}

impl<T, P> Job<T, P> {
    /// The result, if it comes within that time.
    ///
    /// # Errors
    /// The job panicked.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait(&self, patience: Duration) -> Result<Option<T>, Panicked> {
        match self.receiver.recv_timeout(patience) {
            Ok(result) => Ok(Some(result)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(Panicked),
        }
    }

    /// The result, if it is there: a page cannot wait.
    ///
    /// # Errors
    /// The job panicked.
    #[cfg(target_arch = "wasm32")]
    pub fn wait(&self, _patience: Duration) -> Result<Option<T>, Panicked> {
        self.poll()
    }
}

impl<T, P: Clone> Job<T, P> {
    /// The newest report of the job.
    pub fn progress(&self) -> Option<P> {
        // The lock is poisoned where the job panicked while it reported; such a job has no
        // progress.
        self.progress.lock().ok().and_then(|progress| progress.clone())
    }
}

impl<T, P> Drop for Job<T, P> {
    fn drop(&mut self) {
        self.cancel();
    }
}

impl<P> JobContext<P> {
    /// Tells how far the job is.
    pub fn report(&self, progress: P) {
        if let (Ok(mut newest), Ok(mut woken_at)) = (self.progress.lock(), self.woken_at.lock()) {
            *newest = Some(progress);
            if woken_at.elapsed() >= WAKE_INTERVAL {
                *woken_at = Instant::now();
                (self.wake)();
            }
        }
    }

    /// Whether the job is asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
