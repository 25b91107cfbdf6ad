//! What the job around a posterior does, wherever it runs: on a thread, or in the worker of a page.

use crate::app::platform::Instant;
use crate::app::tasks::fit_work::{Watch, Work};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::posterior::{DrawnFrom, DrawnPosterior, Draws};
use pbrdf::fit::posterior::{Posterior, PosteriorError, PosteriorProblem, SampleOf};
use pbrdf::fit::{Intervals, JointProblem, JointUnknown, Observer, Problem, Starts, fit, fit_jointly};
use pbrdf::model::{ParameterSet, Parameters};
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

/// Draws from a posterior, in chains that begin where fits from so many starts end.
pub struct DrawPosterior {
    pub of: PosteriorOf,
    /// The measurements, and what their surfaces share.
    #[cfg_attr(not(any(test, target_arch = "wasm32")), expect(dead_code, reason = "sent to the worker of a page"))]
    pub about: Vec<OpenMeasurement>,
    #[cfg_attr(not(any(test, target_arch = "wasm32")), expect(dead_code, reason = "sent to the worker of a page"))]
    pub shared: ParameterSet,
    pub from: DrawnFrom,
    pub starts: Starts,
}

/// Time between two looks at the draws so far: each takes some milliseconds.
const LOOK_INTERVAL: Duration = Duration::from_millis(400);
/// Draws that are worth a first look.
const FIRST_LOOK: usize = 200;

impl Work for DrawPosterior {
    type Output = Result<Arc<DrawnPosterior>, PosteriorError>;
    type Progress = Drawing;

    fn run(self, watch: &impl Watch<Drawing>) -> Self::Output {
        let Self { of, from, starts, .. } = self;
        watch.report(Drawing { share: 0.0, drawn: None });
        let seed = from.settings.seed;
        match of {
            PosteriorOf::One(posterior) => {
                let minima = |problem: &Problem, observer: Observer<'_>| {
                    let result = fit(problem, starts, seed, observer);
                    result.course.minima.iter().map(|minimum| minimum.parameters).collect()
                };
                let plain = |sample: SampleOf<Problem>| sample.map(JointUnknown::from, |parameters| vec![parameters]);
                drawn(&posterior, from, &minima, &plain, watch)
            }
            PosteriorOf::Joint(posterior) => {
                let minima = |problem: &JointProblem, observer: Observer<'_>| -> Vec<Vec<Parameters>> {
                    let result = fit_jointly(problem, starts, seed, Intervals::None, observer);
                    result.course.minima.into_iter().map(|minimum| minimum.parameters).collect()
                };
                drawn(&posterior, from, &minima, &|sample| sample, watch)
            }
        }
    }
}

fn drawn<P: PosteriorProblem>(
    posterior: &Posterior<P>,
    from: DrawnFrom,
    minima: &dyn Fn(&P, Observer<'_>) -> Vec<P::Point>,
    plain: &dyn Fn(SampleOf<P>) -> Draws,
    watch: &impl Watch<Drawing>,
) -> Result<Arc<DrawnPosterior>, PosteriorError> {
    let begun = Instant::now();
    let cancelled = || watch.is_cancelled();
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
        watch.report(Drawing { share, drawn: shown.clone() });
    };
    let draws = plain(posterior.run(&minima, observer, &mut progress)?);
    let is_complete = draws.len() == from.settings.draws * from.settings.chains;
    Ok(Arc::new(DrawnPosterior::new(from, draws, is_complete)))
}
