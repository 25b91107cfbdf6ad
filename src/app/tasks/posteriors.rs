//! The job that draws from a posterior.

use crate::app::jobs::job::JobContext;
#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::tasks::portable::start;
use crate::app::tasks::posterior_work::{DrawPosterior, Drawing};
use crate::app::tasks::start_error::start_error;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::posterior::{DrawnPosterior, PosteriorOptions};
use pbrdf::fit::posterior::{LogEvidence, Posterior, PosteriorError, PosteriorProblem};
use pbrdf::fit::{JointUnknown, Observer};
use pbrdf::model::Parameters;
use std::sync::Arc;

/// Slot of the job.
pub struct PosteriorJobs {
    spawner: Spawner,
    pub draw: Slot<Result<Arc<DrawnPosterior>, PosteriorError>, Drawing>,
    /// Of the compared models of the measurement of a number; the progress is the name of the model.
    pub evidence: Slot<(u64, Vec<FoundEvidence>), &'static str>,
}

/// The evidence of a row of the comparison of models; none where the model has no posterior or too few draws came.
pub type FoundEvidence = (usize, Option<LogEvidence>);

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

    /// Draws from the posterior of each of these rows of a comparison, for its evidence.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn evidence(
        &mut self,
        number: u64,
        rows: Vec<(usize, &'static str, Arc<FitEntry>)>,
        options: PosteriorOptions,
        seed: u64,
    ) -> Result<(), String> {
        let job = move |context: &JobContext<&'static str>| {
            let cancelled = || context.is_cancelled();
            let observer = Observer { cancelled: &cancelled, ..Observer::NONE };
            let mut found = Vec::new();
            for (row, name, fit) in rows {
                context.report(name);
                let evidence = match &fit.joint {
                    None => {
                        let minima: Vec<Parameters> = fit.report.course.minima.iter().map(|minimum| minimum.parameters).collect();
                        evidence_of(&*fit.problem, &minima, &options, seed, observer)
                    }
                    Some(part) => {
                        let course = &part.of.result.course;
                        let minima: Vec<Vec<Parameters>> = course.minima.iter().map(|minimum| minimum.parameters.clone()).collect();
                        evidence_of(&*part.of.problem, &minima, &options, seed, observer)
                    }
                };
                if cancelled() {
                    break;
                }
                found.push((row, evidence));
            }
            (number, found)
        };
        self.evidence.start(&self.spawner, "evidence", job).map_err(start_error)
    }

    /// Stops what is about other work than what is shown next.
    pub fn abandon(&mut self) {
        self.evidence.abandon();
        self.draw.abandon();
    }
}

/// The evidence of a problem, from chains that begin at those minima.
fn evidence_of<P: PosteriorProblem>(
    problem: &P,
    minima: &[P::Point],
    options: &PosteriorOptions,
    seed: u64,
    observer: Observer<'_>,
) -> Option<LogEvidence> {
    let free: Vec<JointUnknown> = problem.names().iter().map(JointUnknown::of).collect();
    let posterior = Posterior::new(problem, &options.priors_of(&free), options.settings(seed)).ok()?;
    posterior.run(minima, observer, &mut |_, _| {}).ok()?.log_evidence
}
