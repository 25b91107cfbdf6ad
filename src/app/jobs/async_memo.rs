//! Derived values that take longer than a frame: made by a job, always from the newest inputs.

use crate::app::jobs::job::{Job, Panicked};
use crate::app::jobs::spawner::Spawner;
use std::time::Duration;

/// A running job, which makes the value of a key.
struct Running<K, V> {
    key: K,
    /// The frame in which it began, and the last one that wanted these inputs.
    begun_at: u64,
    wanted_at: u64,
    job: Job<V>,
}

impl<K, V> Running<K, V> {
    fn new(key: K, frame: u64, job: Job<V>) -> Self {
        Self { key, begun_at: frame, wanted_at: frame, job }
    }

    fn result(&self, frame: Option<u64>, patience: Duration) -> Result<Option<V>, Panicked> {
        if frame == Some(self.begun_at + 1) { self.job.wait(patience) } else { self.job.poll() }
    }
}

/// Tells a job whether it is to stop.
pub type Stopped<'a> = &'a (dyn Fn() -> bool + Sync);

/// A [`Memo`](crate::app::jobs::memo::Memo) whose value is made by a job. At most one job runs; of
/// inputs that come meanwhile only the newest are used. Until their value is there, the value
/// before is shown. Dropping the memo stops its job.
pub struct AsyncMemo<K, V> {
    shown: Option<MemoState<K, V>>,
    running: Option<Running<K, V>>,
    /// Inputs whose job panicked or did not start; they are not tried again.
    failed: Option<K>,
    frames_behind: u64,
    /// How long a frame waits for a job that began with the frame before. A page cannot wait.
    patience: Duration,
}

/// A value with its inputs.
struct MemoState<K, V> {
    key: K,
    value: V,
    /// The last frame that wanted it.
    wanted_at: u64,
}

impl<K, V> Default for AsyncMemo<K, V> {
    fn default() -> Self {
        Self { shown: None, running: None, failed: None, frames_behind: 0, patience: Duration::ZERO }
    }
}

impl<K: PartialEq + Clone + Send + 'static, V: Send + 'static> AsyncMemo<K, V> {
    /// For values that take less than a frame: one that is not quite there when the next frame begins is waited for
    /// so long, and is one frame behind instead of two.
    pub fn set_patience(&mut self, patience: Duration) {
        self.patience = patience;
    }

    /// Takes the value of a job that has ended, and starts a job if the value belongs to other
    /// inputs than these. Call it before every frame that shows the value. `make` owns its inputs
    /// and runs apart from the window; its value is dropped after a stop.
    pub fn refresh(&mut self, spawner: &Spawner, key: &K, make: impl FnOnce(Stopped<'_>) -> V + Send + 'static) {
        if !self.is_to_be_made(spawner, key) {
            return;
        }
        match spawner.start("derive", move |context| make(&|| context.is_cancelled())) {
            Ok(job) => self.running = Some(Running::new(key.clone(), spawner.frame(), job)),
            Err(_) => self.failed = Some(key.clone()),
        }
    }

    /// Takes the value of a job that has ended; whether a job is to begin.
    fn is_to_be_made(&mut self, spawner: &Spawner, key: &K) -> bool {
        self.poll(Some(spawner.frame()));
        let is_current = self.note_frame(spawner.frame(), key);
        !is_current && self.running.is_none() && self.failed.as_ref() != Some(key)
    }

    /// The same by a worker of the page, whose request and the reading of its answer `ask` gives; false where there is no worker
    /// or no request.
    #[cfg(target_arch = "wasm32")]
    pub fn refresh_beside<R: FnOnce(&str) -> Option<V> + 'static>(
        &mut self,
        spawner: &Spawner,
        key: &K,
        ask: impl FnOnce() -> Option<(String, R)>,
    ) -> bool {
        if !crate::app::platform::worker::are_there() {
            return false;
        }
        if !self.is_to_be_made(spawner, key) {
            return true;
        }
        let Some((request, receive)) = ask() else { return false };
        match spawner.start_beside(|| Ok(request), |_| None, receive) {
            Ok(job) => self.running = Some(Running::new(key.clone(), spawner.frame(), job)),
            Err(_) => self.failed = Some(key.clone()),
        }
        true
    }

    /// Notes which inputs this frame wants; tells whether their value is shown.
    fn note_frame(&mut self, frame: u64, key: &K) -> bool {
        self.running.iter_mut().filter(|running| running.key == *key).for_each(|running| running.wanted_at = frame);
        let Some(shown) = &mut self.shown else { return false };
        if shown.key == *key {
            shown.wanted_at = frame;
        }
        self.frames_behind = frame - shown.wanted_at;
        shown.key == *key
    }

    /// Takes the value of a job that has ended, or ends soon after the beginning of that frame.
    fn poll(&mut self, frame: Option<u64>) {
        let Some(running) = self.running.take() else { return };
        match running.result(frame, self.patience) {
            Ok(Some(value)) => self.shown = Some(MemoState { key: running.key, value, wanted_at: running.wanted_at }),
            Ok(None) => self.running = Some(running),
            Err(Panicked) => self.failed = Some(running.key),
        }
    }

    /// Stops the running job if nobody waits for the value of its inputs; the next job then need
    /// not wait for it.
    pub fn stop_if(&mut self, is_useless: impl FnOnce(&K) -> bool) {
        self.poll(None);
        if self.running.as_ref().is_some_and(|running| is_useless(&running.key)) {
            self.running = None;
        }
    }

    /// The newest value that is done.
    pub fn get(&self) -> Option<&V> {
        self.shown.as_ref().map(|shown| &shown.value)
    }

    /// The inputs of that value.
    pub fn key(&self) -> Option<&K> {
        self.shown.as_ref().map(|shown| &shown.key)
    }

    /// How many frames ago the inputs of the value that is shown were the newest; 0 where they
    /// still are.
    pub fn frames_behind(&self) -> u64 {
        self.frames_behind
    }

    /// Whether a newer value is being made.
    #[cfg(test)]
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Whether the job for these inputs came to nothing.
    #[cfg(test)]
    pub fn has_failed(&self, key: &K) -> bool {
        self.failed.as_ref() == Some(key)
    }
}

#[cfg(test)]
mod tests {
    use super::AsyncMemo;
    use crate::app::jobs::spawner::Spawner;
    use std::sync::mpsc::channel;
    use std::time::{Duration, Instant};

    fn spawner() -> Spawner {
        Spawner::new(|| {})
    }

    fn wait(spawner: &Spawner) {
        let begun = Instant::now();
        while spawner.is_busy() {
            assert!(begun.elapsed() < Duration::from_secs(60), "the job does not end");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn the_newest_inputs_win_and_the_old_value_is_shown_meanwhile() {
        let spawner = spawner();
        let mut job: AsyncMemo<u32, u32> = AsyncMemo::default();
        job.refresh(&spawner, &1, |_| 10);
        wait(&spawner);
        let (let_go, hold) = channel::<()>();
        job.refresh(&spawner, &2, move |_| {
            let _ = hold.recv();
            20
        });
        assert_eq!((job.get(), job.is_running()), (Some(&10), true));
        // 3 comes and goes while 2 is being made.
        job.refresh(&spawner, &3, |_| 30);
        job.refresh(&spawner, &4, |_| 40);
        drop(let_go);
        wait(&spawner);
        job.refresh(&spawner, &4, |_| 40);
        assert_eq!(job.get(), Some(&20));
        wait(&spawner);
        job.refresh(&spawner, &4, |_| 40);
        assert_eq!((job.get(), job.key(), job.is_running()), (Some(&40), Some(&4), false));
    }

    #[test]
    fn a_job_that_panics_is_not_tried_again_with_the_same_inputs() {
        let spawner = spawner();
        let mut job: AsyncMemo<u32, u32> = AsyncMemo::default();
        job.refresh(&spawner, &1, |_| std::panic::panic_any("on purpose"));
        wait(&spawner);
        job.refresh(&spawner, &1, |_| 10);
        assert!(job.has_failed(&1) && !job.is_running() && job.get().is_none());
        job.refresh(&spawner, &2, |_| 20);
        wait(&spawner);
        job.refresh(&spawner, &2, |_| 20);
        assert_eq!(job.get(), Some(&20));
    }

    /// A job that answers whether it was told to stop, once it is let go.
    fn held(job: &mut AsyncMemo<u32, bool>, spawner: &Spawner, key: u32) -> std::sync::mpsc::Sender<()> {
        let (let_go, hold) = channel::<()>();
        job.refresh(spawner, &key, move |stopped| {
            let _ = hold.recv();
            stopped()
        });
        let_go
    }

    #[test]
    fn a_useless_job_is_stopped_and_the_next_does_not_wait_for_it() {
        let spawner = spawner();
        let mut job = AsyncMemo::default();
        let first = held(&mut job, &spawner, 1);
        job.stop_if(|key| *key != 1);
        assert!(job.is_running(), "it is of use");
        job.stop_if(|key| *key == 1);
        assert!(!job.is_running());
        drop(held(&mut job, &spawner, 2));
        while job.get().is_none() {
            drop(held(&mut job, &spawner, 2));
        }
        assert_eq!((job.key(), job.get()), (Some(&2), Some(&false)));
        drop(first);
        wait(&spawner);
        job.stop_if(|_| false);
        assert_eq!((job.key(), job.get()), (Some(&2), Some(&false)), "what a stopped job answers is not seen");
    }

    #[test]
    fn a_value_that_is_nearly_there_is_waited_for() {
        let spawner = spawner();
        let mut job = AsyncMemo::default();
        job.set_patience(Duration::from_secs(60));
        for key in 1..4_u64 {
            spawner.begin_frame();
            job.refresh(&spawner, &key, |_| std::thread::sleep(Duration::from_millis(20)));
            assert_eq!(job.key().copied().unwrap_or_default(), key - 1, "one frame behind");
        }
    }

    #[test]
    fn letting_go_stops_the_job() {
        let spawner = spawner();
        let (sender, told) = channel();
        let (let_go, hold) = channel::<()>();
        let mut job: AsyncMemo<u32, ()> = AsyncMemo::default();
        job.refresh(&spawner, &1, move |stopped| {
            let before = stopped();
            let _ = hold.recv();
            let _ = sender.send((before, stopped()));
        });
        drop(job);
        drop(let_go);
        let (_, after) = told.recv().expect("an answer");
        assert!(after);
    }

    #[test]
    fn frames_are_counted_since_the_inputs_of_what_is_shown_were_the_newest() {
        let spawner = spawner();
        let mut job = AsyncMemo::default();
        let mut in_frame = |key: u32, let_go: bool| {
            spawner.begin_frame();
            let (sender, hold) = channel::<()>();
            job.refresh(&spawner, &key, move |_| {
                let _ = hold.recv();
            });
            if let_go {
                drop(sender);
                wait(&spawner);
            } else {
                // Held for as long as the test runs.
                std::mem::forget(sender);
            }
            job.frames_behind()
        };
        assert_eq!([in_frame(1, true), in_frame(1, true), in_frame(1, true)], [0, 0, 0], "the sliders rest");
        assert_eq!([in_frame(2, true), in_frame(3, true), in_frame(4, true)], [1, 1, 1], "each value is there for the next frame");
        assert_eq!([in_frame(4, true), in_frame(4, true)], [0, 0], "it is the newest");
        assert_eq!([in_frame(5, false), in_frame(6, false), in_frame(7, false)], [1, 2, 3], "the job of 5 takes long");
    }
}
