//! Draws from posteriors that the window starts, and what it does with them.

use crate::app::shell::app::App;
use crate::app::shell::app::fits::{problem_of, whole};
use crate::app::tasks::inquiry_work::{EvidenceRow, FindEvidence};
use crate::app::tasks::posterior_work::{DrawPosterior, PosteriorOf};
use crate::app::text::localized::Localized as _;
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::{is_joint, joint_problem};
use crate::app::work::model_fit::ModelFit;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::posterior::{DrawnFrom, DrawnPosterior, PosteriorOptions};
use crate::app::work::settings::Settings;
use pbrdf::fit::posterior::{Posterior, PosteriorError, PosteriorProblem};
use pbrdf::fit::{JointUnknown, Loss};
use pbrdf::model::ParameterSet;
use std::sync::Arc;
use tr::tr;

/// Draws from the posterior of the active measurement, or of all where they share anything.
pub fn start_posterior(app: &mut App) -> Result<(), String> {
    let job = job_of_posterior(app)?;
    app.jobs.posteriors.draw(job)
}

/// The job that draws from it.
pub fn job_of_posterior(app: &App) -> Result<DrawPosterior, String> {
    let Settings { fit_options, starts, .. } = *app.work.settings();
    if fit_options.loss != Loss::Squared {
        return Err(tr!("A posterior takes squared residuals: its likelihood is Gaussian. Choose the loss “squared” first."));
    }
    let list = app.work.measurements();
    let (of, from, about) = if is_joint(list) {
        let problem = joint_problem(list, ParameterSet::EMPTY, fit_options).map_err(|error| cannot_begin(&error.localized()))?;
        let (posterior, from) = posterior(app, &problem, &list.measured().collect::<Vec<_>>())?;
        (PosteriorOf::Joint(posterior), from, list.measured().cloned().collect())
    } else {
        let (posterior, from) = posterior(app, &problem_of(app, list.active())?, &[list.active()])?;
        (PosteriorOf::One(posterior), from, vec![list.active().clone()])
    };
    Ok(DrawPosterior { of, about, shared: list.shared(), from, starts })
}

/// The posterior of a problem, and what is to be remembered of it.
fn posterior<P: PosteriorProblem>(app: &App, problem: &P, about: &[&OpenMeasurement]) -> Result<(Box<Posterior<P>>, DrawnFrom), String> {
    let settings = app.work.settings();
    let free: Vec<JointUnknown> = problem.names().iter().map(JointUnknown::of).collect();
    let prior_options = settings.panes.posterior.priors_of(&free);
    let posterior = Posterior::new(problem, &prior_options, settings.panes.posterior.settings(settings.seed));
    let posterior = posterior.map_err(|error| cannot_begin(&error.localized()))?;
    let from = DrawnFrom {
        numbers: about.iter().map(|open| open.number).collect(),
        generations: about.iter().map(|open| open.generation).collect(),
        names: about.iter().map(|open| open.title()).collect(),
        priors: posterior.priors().to_vec(),
        prior_options,
        settings: posterior.settings(),
        values: problem.residual_count(),
    };
    Ok((Box::new(posterior), from))
}

fn cannot_begin(reason: &str) -> String {
    tr!("Nothing can be drawn: {}.", reason)
}

/// Draws of each chain for the evidence of a model: its error is then a few hundredths.
const EVIDENCE_DRAWS: usize = 1000;

/// Finds the evidence of the compared models; of those that leave a measured quantity out it is that of other data.
pub fn find_evidence(app: &mut App) -> Result<(), String> {
    let settings = app.work.settings();
    let has_brdf = app.work.active().measurement.has_brdf();
    let row = |(index, row): (usize, &ModelFit)| {
        let fit = row.result.as_ref().ok().filter(|fit| !has_brdf || !fit.problem.options().dolp_only)?;
        Some(EvidenceRow { row: index, model: row.preset.key, fit: whole(&app.work, fit) })
    };
    let rows: Vec<_> = app.work.model_comparison().iter().enumerate().filter_map(row).collect();
    if rows.is_empty() {
        return Err(tr!("Nothing is compared yet."));
    }
    let options = PosteriorOptions { draws: EVIDENCE_DRAWS, ..settings.panes.posterior.clone() };
    let (number, seed) = (app.work.active().number, settings.seed);
    app.jobs.posteriors.evidence(FindEvidence { number, rows, options, seed })
}

/// The draws are there, or those that there were when somebody stopped it.
pub fn drawn(app: &mut App, result: Result<Arc<DrawnPosterior>, PosteriorError>) {
    match result {
        Ok(drawn) if drawn.draws.is_empty() => {}
        Ok(drawn) => app.work.apply(Edit::SetPosterior(drawn)),
        Err(error) => app.toasts.error(cannot_begin(&error.localized())),
    }
}
