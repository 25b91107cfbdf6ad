//! Carries out what is asked of data beyond a fit.

use crate::app::shell::app::App;
use crate::app::shell::app::plans::choose_angles;
use crate::app::shell::app::posteriors::{find_evidence, start_posterior};
use crate::app::shell::app::walk::{cancel_walk, start_walk};
use crate::app::views::action::InquiryAction;
use crate::app::work::pane_id::PaneId;

/// Carries out an inquiry; the error is a sentence.
pub fn execute(app: &mut App, action: InquiryAction) -> Result<(), String> {
    match action {
        InquiryAction::Walk(way) => start_walk(app, way)?,
        InquiryAction::StopWalk => app.jobs.fits.walking_since = None,
        InquiryAction::CancelWalk => cancel_walk(app),
        InquiryAction::ChooseAngles => choose_angles(app)?,
        InquiryAction::CancelChoice => app.jobs.plans.choose.cancel(),
        InquiryAction::DrawPosterior => {
            app.dock.show(PaneId::Posterior);
            start_posterior(app)?;
        }
        InquiryAction::FindEvidence => find_evidence(app)?,
        InquiryAction::CancelEvidence => app.jobs.posteriors.evidence.cancel(),
        InquiryAction::CancelPosterior => app.jobs.posteriors.draw.cancel(),
    }
    Ok(())
}
