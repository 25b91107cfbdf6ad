//! A place for one running job of a kind.

use crate::app::jobs::job::{Job, JobContext, Panicked};
use crate::app::jobs::spawner::Spawner;
use std::io;

/// At most one running job of a kind, with a result `T` and a progress `P`.
pub struct Slot<T, P = ()> {
    job: Option<Job<T, P>>,
}

impl<T, P> Default for Slot<T, P> {
    fn default() -> Self {
        Self { job: None }
    }
}

impl<T, P> Slot<T, P> {
    /// The running job.
    pub fn job(&self) -> Option<&Job<T, P>> {
        self.job.as_ref()
    }

    pub fn is_running(&self) -> bool {
        self.job.is_some()
    }

    /// Asks the running job to stop soon; its result still comes.
    pub fn cancel(&self) {
        self.job.iter().for_each(Job::cancel);
    }

    /// Stops the running job; its result is dropped.
    pub fn abandon(&mut self) {
        self.job = None;
    }

    /// The result of the job, or that it panicked, once; the slot is then free.
    pub fn poll(&mut self) -> Option<Result<T, Panicked>> {
        let result = self.job.as_ref()?.poll().transpose()?;
        self.job = None;
        Some(result)
    }
}

impl<T: Send + 'static, P: Send + 'static> Slot<T, P> {
    /// Starts a job on a thread of that name, in place of the running one, which is abandoned.
    ///
    /// # Errors
    /// The system refuses a thread.
    pub fn start(&mut self, spawner: &Spawner, name: &str, body: impl FnOnce(&JobContext<P>) -> T + Send + 'static) -> io::Result<()> {
        self.abandon();
        self.job = Some(spawner.start(name, body)?);
        Ok(())
    }
}

#[cfg(target_arch = "wasm32")]
impl<T: 'static, P: 'static> Slot<T, P> {
    /// The same in a worker of the page.
    ///
    /// # Errors
    /// The browser starts no worker.
    pub fn start_beside(
        &mut self,
        spawner: &Spawner,
        request: impl FnOnce() -> Result<String, T> + 'static,
        progress: impl Fn(&str) -> Option<P> + 'static,
        receive: impl FnOnce(&str) -> Option<T> + 'static,
    ) -> io::Result<()> {
        self.abandon();
        self.job = Some(spawner.start_beside(request, progress, receive)?);
        Ok(())
    }
}

/// A slot of whatever kind, for tests that go through all of them.
#[cfg(test)]
pub trait AnySlot {
    fn is_running(&self) -> bool;

    /// Starts a job that panics.
    fn start_panicking(&mut self, spawner: &Spawner);
}

#[cfg(test)]
impl<T: Send + 'static, P: Send + 'static> AnySlot for Slot<T, P> {
    fn is_running(&self) -> bool {
        Self::is_running(self)
    }

    fn start_panicking(&mut self, spawner: &Spawner) {
        self.start(spawner, "panicking", |_| std::panic::panic_any("on purpose")).expect("a thread");
    }
}

#[cfg(test)]
mod tests {
    use super::Slot;
    use crate::app::jobs::job::Panicked;
    use crate::app::jobs::spawner::Spawner;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::mpsc::channel;
    use std::time::{Duration, Instant};

    fn wait<T, P>(slot: &mut Slot<T, P>) -> Result<T, Panicked> {
        let begun = Instant::now();
        loop {
            if let Some(result) = slot.poll() {
                return result;
            }
            assert!(begun.elapsed() < Duration::from_secs(60), "the job does not end");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_result_comes_once_and_frees_the_slot() {
        let wakes = Arc::new(AtomicUsize::new(0));
        let count = wakes.clone();
        let spawner = Spawner::new(move || {
            count.fetch_add(1, Ordering::SeqCst);
        });
        let mut slot: Slot<i32> = Slot::default();
        slot.start(&spawner, "test", |_| 7).expect("a thread");
        assert_eq!(wait(&mut slot), Ok(7));
        assert!(!slot.is_running() && slot.poll().is_none());
        while spawner.is_busy() {
            std::thread::yield_now();
        }
        // The count drops before the window wakes.
        while wakes.load(Ordering::SeqCst) < 1 {
            std::thread::yield_now();
        }
    }

    #[test]
    fn a_job_that_panics_frees_the_slot() {
        let spawner = Spawner::new(|| {});
        let mut slot: Slot<i32> = Slot::default();
        slot.start(&spawner, "test", |_| std::panic::panic_any("on purpose")).expect("a thread");
        assert_eq!(wait(&mut slot), Err(Panicked));
        assert!(!slot.is_running());
        slot.start(&spawner, "test", |_| 8).expect("a thread");
        assert_eq!(wait(&mut slot), Ok(8));
    }

    #[test]
    fn a_cancelled_job_tells_what_it_has_and_an_abandoned_one_nothing() {
        let spawner = Spawner::new(|| {});
        let mut slot: Slot<bool, f64> = Slot::default();
        let (sender, told) = channel();
        let start = |slot: &mut Slot<bool, f64>| {
            let (release, hold) = channel::<()>();
            let sender = sender.clone();
            slot.start(&spawner, "test", move |context| {
                context.report(0.5);
                let _ = hold.recv();
                let _ = sender.send(context.is_cancelled());
                context.is_cancelled()
            })
            .expect("a thread");
            release
        };
        let release = start(&mut slot);
        slot.cancel();
        drop(release);
        assert_eq!(wait(&mut slot), Ok(true));
        assert_eq!(told.recv(), Ok(true));
        // The second job replaces the first.
        let (first, second) = (start(&mut slot), start(&mut slot));
        drop(first);
        assert_eq!(told.recv(), Ok(true), "a job that is replaced is asked to stop");
        while slot.job().expect("the second job").progress().is_none() {
            std::thread::yield_now();
        }
        assert_eq!(slot.job().expect("the second job").progress(), Some(0.5));
        drop(second);
        assert_eq!(wait(&mut slot), Ok(false), "the result of the second job alone");
        let third = start(&mut slot);
        slot.abandon();
        drop(third);
        assert_eq!((told.recv(), told.recv()), (Ok(false), Ok(true)));
        assert!(slot.poll().is_none());
    }
}
