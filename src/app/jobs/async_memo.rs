//! Derived values that take longer than a frame: made on a thread of their own, always from the newest inputs.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

/// Where such jobs run: it wakes the window when one is done, and knows how many are on their way.
#[derive(Clone)]
pub struct Background {
    ctx: egui::Context,
    running: Arc<AtomicUsize>,
}

impl Background {
    pub fn new(ctx: &egui::Context) -> Self {
        Self { ctx: ctx.clone(), running: Arc::default() }
    }

    /// The number of the frame that is being made ready.
    fn frame(&self) -> u64 {
        self.ctx.cumulative_frame_nr()
    }

    /// Whether any job is on its way.
    #[cfg(test)]
    pub fn is_busy(&self) -> bool {
        self.running.load(Ordering::Acquire) > 0
    }
}

/// Ends a job in the count and wakes the window, also when the job panics.
struct MemoResult(Background);

impl Drop for MemoResult {
    fn drop(&mut self) {
        self.0.running.fetch_sub(1, Ordering::Release);
        self.0.ctx.request_repaint();
    }
}

/// What a job answers with. The fields end in this order: the answer, or that there is none, is known before the window wakes.
struct Reply<V> {
    sender: Sender<V>,
    _ending: MemoResult,
}

/// A job on its way. Letting go of it tells it to stop.
struct Running<K, V> {
    key: K,
    /// The last frame that wanted these inputs.
    wanted_at: u64,
    receiver: Receiver<V>,
    stop: Arc<AtomicBool>,
}

impl<K, V> Drop for Running<K, V> {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// Whether a job is to stop, which it looks at now and then.
pub type Stopped<'a> = &'a (dyn Fn() -> bool + Sync);

/// A [`crate::app::jobs::memo::Memo`] that is made in the background. At most one job runs; inputs that come meanwhile wait, and only the
/// newest are taken up. Until their value is there, the one before is shown. Letting go of it stops its job.
pub struct AsyncMemo<K, V> {
    shown: Option<MemoState<K, V>>,
    running: Option<Running<K, V>>,
    /// Inputs whose job panicked or could not be started: not tried again.
    failed: Option<K>,
    frames_behind: u64,
}

/// A value that is done.
struct MemoState<K, V> {
    key: K,
    value: V,
    /// The last frame that wanted it.
    wanted_at: u64,
}

impl<K, V> Default for AsyncMemo<K, V> {
    fn default() -> Self {
        Self { shown: None, running: None, failed: None, frames_behind: 0 }
    }
}

impl<K: PartialEq + Clone + Send + 'static, V: Send + 'static> AsyncMemo<K, V> {
    /// Takes up what is done, and begins a job if the value belongs to other inputs than these. Call it before every frame that
    /// shows the value. `make` owns its inputs; it runs on another thread, and what it answers after a stop is not seen.
    pub fn refresh(&mut self, background: &Background, key: &K, make: impl FnOnce(Stopped<'_>) -> V + Send + 'static) {
        self.take_up();
        let is_there = self.note_frame(background.frame(), key);
        if is_there || self.running.is_some() || self.failed.as_ref() == Some(key) {
            return;
        }
        let (sender, receiver) = channel();
        let reply = Reply { sender, _ending: MemoResult(background.clone()) };
        background.running.fetch_add(1, Ordering::Release);
        let stop = Arc::new(AtomicBool::new(false));
        let looked_at = stop.clone();
        let run = move || {
            let reply = reply;
            // The window may be gone.
            let _ = reply.sender.send(make(&|| looked_at.load(Ordering::Relaxed)));
        };
        match std::thread::Builder::new().name("derive".to_owned()).spawn(run) {
            Ok(_) => self.running = Some(Running { key: key.clone(), wanted_at: background.frame(), receiver, stop }),
            Err(_) => self.failed = Some(key.clone()),
        }
    }

    /// Takes down which inputs this frame wants; tells whether their value is there.
    fn note_frame(&mut self, frame: u64, key: &K) -> bool {
        self.running.iter_mut().filter(|running| running.key == *key).for_each(|running| running.wanted_at = frame);
        let Some(shown) = &mut self.shown else { return false };
        if shown.key == *key {
            shown.wanted_at = frame;
        }
        self.frames_behind = frame - shown.wanted_at;
        shown.key == *key
    }

    fn take_up(&mut self) {
        let Some(running) = self.running.take() else { return };
        match running.receiver.try_recv() {
            Ok(value) => self.shown = Some(MemoState { key: running.key.clone(), value, wanted_at: running.wanted_at }),
            Err(TryRecvError::Empty) => self.running = Some(running),
            Err(TryRecvError::Disconnected) => self.failed = Some(running.key.clone()),
        }
    }

    /// Stops the job on its way if nobody waits for what it makes of its inputs; the next one need not wait for it.
    pub fn stop_if(&mut self, is_useless: impl FnOnce(&K) -> bool) {
        self.take_up();
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

    /// How many frames ago the inputs of the value that is shown were the newest; 0 where they still are.
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
    use super::{AsyncMemo, Background};
    use std::sync::mpsc::channel;
    use std::time::{Duration, Instant};

    /// A window after its first frame.
    fn context() -> egui::Context {
        let ctx = egui::Context::default();
        end_frame(&ctx);
        ctx
    }

    fn end_frame(ctx: &egui::Context) {
        ctx.run_ui(egui::RawInput::default(), |_| {}).textures_delta.clear();
    }

    fn wait(background: &Background) {
        let begun = Instant::now();
        while background.is_busy() {
            assert!(begun.elapsed() < Duration::from_secs(60), "the job does not end");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn the_newest_inputs_win_and_the_old_value_is_shown_meanwhile() {
        let background = Background::new(&context());
        let mut job: AsyncMemo<u32, u32> = AsyncMemo::default();
        job.refresh(&background, &1, |_| 10);
        wait(&background);
        let (let_go, hold) = channel::<()>();
        job.refresh(&background, &2, move |_| {
            let _ = hold.recv();
            20
        });
        assert_eq!((job.get(), job.is_running()), (Some(&10), true));
        // 3 comes and goes while 2 is being made.
        job.refresh(&background, &3, |_| 30);
        job.refresh(&background, &4, |_| 40);
        drop(let_go);
        wait(&background);
        job.refresh(&background, &4, |_| 40);
        assert_eq!(job.get(), Some(&20));
        wait(&background);
        job.refresh(&background, &4, |_| 40);
        assert_eq!((job.get(), job.key(), job.is_running()), (Some(&40), Some(&4), false));
    }

    #[test]
    fn a_job_that_panics_is_not_tried_again_with_the_same_inputs() {
        let background = Background::new(&context());
        let mut job: AsyncMemo<u32, u32> = AsyncMemo::default();
        job.refresh(&background, &1, |_| std::panic::panic_any("on purpose"));
        wait(&background);
        job.refresh(&background, &1, |_| 10);
        assert!(job.has_failed(&1) && !job.is_running() && job.get().is_none());
        job.refresh(&background, &2, |_| 20);
        wait(&background);
        job.refresh(&background, &2, |_| 20);
        assert_eq!(job.get(), Some(&20));
    }

    /// A job that answers whether it was told to stop, once it is let go.
    fn held(job: &mut AsyncMemo<u32, bool>, background: &Background, key: u32) -> std::sync::mpsc::Sender<()> {
        let (let_go, hold) = channel::<()>();
        job.refresh(background, &key, move |stopped| {
            let _ = hold.recv();
            stopped()
        });
        let_go
    }

    #[test]
    fn a_useless_job_is_stopped_and_the_next_does_not_wait_for_it() {
        let background = Background::new(&context());
        let mut job = AsyncMemo::default();
        let first = held(&mut job, &background, 1);
        job.stop_if(|key| *key != 1);
        assert!(job.is_running(), "it is of use");
        job.stop_if(|key| *key == 1);
        assert!(!job.is_running());
        drop(held(&mut job, &background, 2));
        while job.get().is_none() {
            drop(held(&mut job, &background, 2));
        }
        assert_eq!((job.key(), job.get()), (Some(&2), Some(&false)));
        drop(first);
        wait(&background);
        job.stop_if(|_| false);
        assert_eq!((job.key(), job.get()), (Some(&2), Some(&false)), "what a stopped job answers is not seen");
    }

    #[test]
    fn letting_go_stops_the_job() {
        let background = Background::new(&context());
        let (sender, told) = channel();
        let (let_go, hold) = channel::<()>();
        let mut job: AsyncMemo<u32, ()> = AsyncMemo::default();
        job.refresh(&background, &1, move |stopped| {
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
        let ctx = context();
        let background = Background::new(&ctx);
        let mut job = AsyncMemo::default();
        let mut in_frame = |key: u32, let_go: bool| {
            end_frame(&ctx);
            let (sender, hold) = channel::<()>();
            job.refresh(&background, &key, move |_| {
                let _ = hold.recv();
            });
            if let_go {
                drop(sender);
                wait(&background);
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
