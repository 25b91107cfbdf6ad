//! The job that draws from a posterior.

use crate::app::jobs::job::JobContext;
#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::platform::Instant;
use crate::app::tasks::start_error::start_error;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::posterior::{DrawnFrom, DrawnPosterior, Draws, PosteriorOptions};
use pbrdf::fit::posterior::{LogEvidence, Posterior, PosteriorError, PosteriorProblem, SampleOf};
use pbrdf::fit::{Intervals, JointProblem, JointUnknown, Observer, Problem, Starts, fit, fit_jointly};
use pbrdf::model::Parameters;
use std::sync::Arc;
use std::time::Duration;

/// What draws are from: one measurement, or several together.
pub enum PosteriorOf {
    One(Box<Posterior<Problem>>),
    Joint(Box<Posterior<JointProblem>>),
}

/// How far the drawing is.
#[derive(Clone)]
pub struct Drawing {
    /// 0 to 1.
    pub share: f64,
    /// The draws so far.
    pub drawn: Option<Arc<DrawnPosterior>>,
}

/// Slot of the job.
pub struct PosteriorJobs {
    spawner: Spawner,
    pub draw: Slot<Result<Arc<DrawnPosterior>, PosteriorError>, Drawing>,
    /// Of the compared models of the measurement of a number; the progress is the name of the model.
    pub evidence: Slot<(u64, Vec<FoundEvidence>), &'static str>,
}

/// The evidence of a row of the comparison of models; none where the model has no posterior or too few draws came.
pub type FoundEvidence = (usize, Option<LogEvidence>);

/// Time between two looks at the draws so far: each takes some milliseconds.
const LOOK_INTERVAL: Duration = Duration::from_millis(400);
/// Draws that are worth a first look.
const FIRST_LOOK: usize = 200;

impl PosteriorJobs {
    pub fn new(spawner: Spawner) -> Self {
        Self { spawner, draw: Slot::default(), evidence: Slot::default() }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        vec![&mut self.draw, &mut self.evidence]
    }

    /// Draws from a posterior, in chains that begin where fits from so many starts end.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn draw(&mut self, of: PosteriorOf, from: DrawnFrom, starts: Starts) -> Result<(), String> {
        let job = move |context: &JobContext<Drawing>| {
            context.report(Drawing { share: 0.0, drawn: None });
            let seed = from.settings.seed;
            match of {
                PosteriorOf::One(posterior) => {
                    let minima = |problem: &Problem, observer: Observer<'_>| {
                        let result = fit(problem, starts, seed, observer);
                        result.course.minima.iter().map(|minimum| minimum.parameters).collect()
                    };
                    let plain = |sample: SampleOf<Problem>| sample.map(JointUnknown::from, |parameters| vec![parameters]);
                    drawn(&posterior, from, &minima, &plain, context)
                }
                PosteriorOf::Joint(posterior) => {
                    let minima = |problem: &JointProblem, observer: Observer<'_>| -> Vec<Vec<Parameters>> {
                        let result = fit_jointly(problem, starts, seed, Intervals::None, observer);
                        result.course.minima.into_iter().map(|minimum| minimum.parameters).collect()
                    };
                    drawn(&posterior, from, &minima, &|sample| sample, context)
                }
            }
        };
        self.draw.start(&self.spawner, "posterior", job).map_err(start_error)
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

fn drawn<P: PosteriorProblem>(
    posterior: &Posterior<P>,
    from: DrawnFrom,
    minima: &dyn Fn(&P, Observer<'_>) -> Vec<P::Point>,
    plain: &dyn Fn(SampleOf<P>) -> Draws,
    context: &JobContext<Drawing>,
) -> Result<Arc<DrawnPosterior>, PosteriorError> {
    let begun = Instant::now();
    let cancelled = || context.is_cancelled();
    let observer = Observer { clock: &|| begun.elapsed().as_secs_f64() * 1e3, cancelled: &cancelled, ..Observer::NONE };
    let minima = minima(posterior.problem(), observer);
    let mut looked_at = Instant::now();
    let mut shown = None;
    let mut progress = |share: f64, sample: &dyn Fn() -> SampleOf<P>| {
        if looked_at.elapsed() >= LOOK_INTERVAL {
            looked_at = Instant::now();
            let draws = plain(sample());
            if draws.len() >= FIRST_LOOK {
                shown = Some(Arc::new(DrawnPosterior::new(from.clone(), draws, false)));
            }
        }
        context.report(Drawing { share, drawn: shown.clone() });
    };
    let draws = plain(posterior.run(&minima, observer, &mut progress)?);
    let is_complete = draws.len() == from.settings.draws * from.settings.chains;
    Ok(Arc::new(DrawnPosterior::new(from, draws, is_complete)))
}
