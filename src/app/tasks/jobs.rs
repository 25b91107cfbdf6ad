//! All jobs of the program.

#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::spawner::Spawner;
use crate::app::tasks::benchmarks::BenchmarkJobs;
use crate::app::tasks::files::FileJobs;
use crate::app::tasks::fits::FitJobs;
use crate::app::tasks::plans::PlanJobs;
use crate::app::tasks::posteriors::PosteriorJobs;

/// The slots of all jobs. Views read progress here; commands start and cancel.
pub struct Jobs {
    /// Starts what views derive.
    pub spawner: Spawner,
    pub files: FileJobs,
    pub fits: FitJobs,
    pub posteriors: PosteriorJobs,
    pub plans: PlanJobs,
    pub benchmarks: BenchmarkJobs,
}

impl Jobs {
    pub fn new(spawner: Spawner) -> Self {
        Self {
            files: FileJobs::new(spawner.clone()),
            fits: FitJobs::new(spawner.clone()),
            posteriors: PosteriorJobs::new(spawner.clone()),
            plans: PlanJobs::new(spawner.clone()),
            benchmarks: BenchmarkJobs::new(spawner.clone()),
            spawner,
        }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        let Self { spawner: _, files, fits, posteriors, plans, benchmarks } = self;
        files.slots().into_iter().chain(fits.slots()).chain(posteriors.slots()).chain(plans.slots()).chain(benchmarks.slots()).collect()
    }

    /// Whether a job runs or a result waits to be taken.
    #[cfg(test)]
    pub fn is_busy(&mut self) -> bool {
        self.spawner.is_busy() || self.slots().iter().any(|slot| slot.is_running())
    }
}
