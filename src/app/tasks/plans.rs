//! The job that chooses angles.

#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::tasks::inquiry_work::{ChooseAngles, NotChosen};
use crate::app::tasks::portable::start;
use crate::app::work::predicted_errors::PlannedAngles;

/// Slot of the job.
pub struct PlanJobs {
    spawner: Spawner,
    /// The progress is a share, 0 to 1.
    pub choose: Slot<Result<PlannedAngles, NotChosen>, f64>,
}

impl PlanJobs {
    pub fn new(spawner: Spawner) -> Self {
        Self { spawner, choose: Slot::default() }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        vec![&mut self.choose]
    }

    /// Chooses angles.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn choose(&mut self, job: ChooseAngles) -> Result<(), String> {
        start(&self.spawner, &mut self.choose, "choose angles", job)
    }

    /// Stops what is about other work than what is shown next.
    pub fn abandon(&mut self) {
        self.choose.abandon();
    }
}
