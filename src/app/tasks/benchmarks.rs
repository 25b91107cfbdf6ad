//! Jobs that measure the program itself. They run one after the other, since each measures times.

use crate::app::jobs::job::{Job, JobContext, Panicked};
#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::platform::{self, Instant};
use crate::app::tasks::start_error::start_error;
use crate::files::export::{machine, now};
use pbrdf::selftest::{Cost, ErrorVsTime, Host, Report, Stability};
use tr::tr;

/// Which benchmark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BenchmarkId {
    ErrorVsTime,
    Stability,
    Cost,
}

impl BenchmarkId {
    #[cfg(test)]
    pub const ALL: [Self; 3] = [Self::ErrorVsTime, Self::Stability, Self::Cost];

    /// Runs the benchmark, for seconds to a minute.
    pub fn run(self, host: Host<'_>) -> BenchmarkResult {
        match self {
            Self::ErrorVsTime => BenchmarkResult::ErrorVsTime(ErrorVsTime::run(machine(), now(), host)),
            Self::Stability => BenchmarkResult::Stability(Stability::run(machine(), now(), host)),
            Self::Cost => BenchmarkResult::Cost(Cost::run(machine(), now(), host)),
        }
    }
}

/// The report of a benchmark.
pub enum BenchmarkResult {
    ErrorVsTime(Report<ErrorVsTime>),
    Stability(Report<Stability>),
    Cost(Report<Cost>),
}

/// A benchmark that has ended.
pub struct FinishedBenchmark {
    pub result: Box<BenchmarkResult>,
    /// Whether it was stopped before its end.
    pub is_part: bool,
}

/// The running benchmark, and those that wait for it.
pub struct BenchmarkJobs {
    spawner: Spawner,
    /// The progress is a fraction.
    slot: Slot<FinishedBenchmark, f64>,
    running: Option<BenchmarkId>,
    waiting: Vec<BenchmarkId>,
}

impl BenchmarkJobs {
    pub fn new(spawner: Spawner) -> Self {
        Self { spawner, slot: Slot::default(), running: None, waiting: Vec::new() }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        let Self { spawner: _, slot, running: _, waiting: _ } = self;
        vec![slot]
    }

    /// Runs a benchmark, after the one that runs.
    ///
    /// # Errors
    /// The job does not start, or the window is in a page; a sentence.
    pub fn start(&mut self, id: BenchmarkId) -> Result<(), String> {
        if platform::IS_PAGE {
            // Known when the program is built: the tables of reference values are not in a page.
            return Err(tr!("A page does not measure the program: the program on a desktop does."));
        }
        if self.slot.is_running() {
            if self.can_start(id) {
                self.waiting.push(id);
            }
            return Ok(());
        }
        let job = move |context: &JobContext<f64>| {
            let begun = Instant::now();
            let host = Host {
                clock: &|| begun.elapsed().as_secs_f64() * 1e3,
                cancelled: &|| context.is_cancelled(),
                progress: &|done| context.report(done),
            };
            let result = Box::new(id.run(host));
            FinishedBenchmark { result, is_part: context.is_cancelled() }
        };
        self.slot.start(&self.spawner, "benchmark", job).map_err(start_error)?;
        self.running = Some(id);
        Ok(())
    }

    /// The result of the benchmark that has ended.
    pub fn poll(&mut self) -> Option<Result<FinishedBenchmark, Panicked>> {
        let result = self.slot.poll()?;
        self.running = None;
        Some(result)
    }

    /// Starts the benchmark that waits longest, where none runs.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn start_waiting(&mut self) -> Result<(), String> {
        if self.slot.is_running() || self.waiting.is_empty() {
            return Ok(());
        }
        let next = self.waiting.remove(0);
        self.start(next)
    }

    pub fn is_running(&self) -> bool {
        self.slot.is_running()
    }

    /// The running benchmark and the fraction that is done.
    pub fn progress(&self) -> Option<(BenchmarkId, f64)> {
        let fraction = self.slot.job().map(Job::progress)?.unwrap_or(0.0);
        self.running.map(|id| (id, fraction))
    }

    /// Whether the benchmark neither runs nor waits.
    pub fn can_start(&self, id: BenchmarkId) -> bool {
        !self.is_waiting(id) && self.running != Some(id)
    }

    /// Whether the benchmark waits for another one.
    pub fn is_waiting(&self, id: BenchmarkId) -> bool {
        self.waiting.contains(&id)
    }

    /// Takes a waiting benchmark out of the queue.
    pub fn forget(&mut self, id: BenchmarkId) {
        self.waiting.retain(|other| *other != id);
    }

    /// Asks the running benchmark to stop; its result so far comes.
    pub fn cancel(&self) {
        self.slot.cancel();
    }
}
