//! The job that draws from a posterior.

#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::tasks::inquiry_work::{FindEvidence, FoundEvidence};
use crate::app::tasks::portable::start;
use crate::app::tasks::posterior_work::{DrawPosterior, Drawing};
use crate::app::work::posterior::DrawnPosterior;
use pbrdf::fit::posterior::PosteriorError;
use std::sync::Arc;

/// Slot of the job.
pub struct PosteriorJobs {
    spawner: Spawner,
    pub draw: Slot<Result<Arc<DrawnPosterior>, PosteriorError>, Drawing>,
    /// Of the compared models of the measurement of a number; the progress is the name of the model.
    pub evidence: Slot<(u64, Vec<FoundEvidence>), &'static str>,
}

impl PosteriorJobs {
    pub fn new(spawner: Spawner) -> Self {
        Self { spawner, draw: Slot::default(), evidence: Slot::default() }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        vec![&mut self.draw, &mut self.evidence]
    }

    /// Draws from a posterior.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn draw(&mut self, job: DrawPosterior) -> Result<(), String> {
        start(&self.spawner, &mut self.draw, "posterior", job)
    }

    /// Draws from the posterior of the fitted models of a comparison, for their evidence.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn evidence(&mut self, job: FindEvidence) -> Result<(), String> {
        start(&self.spawner, &mut self.evidence, "evidence", job)
    }

    /// Stops what is about other work than what is shown next.
    pub fn abandon(&mut self) {
        self.evidence.abandon();
        self.draw.abandon();
    }
}
