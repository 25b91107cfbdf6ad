//! Angles that the window lets choose, and what it does with them.

use crate::app::shell::app::App;
use crate::app::tasks::inquiry_work::{ChooseAngles, NotChosen};
use crate::app::text::i18n;
use crate::app::work::edit::Edit;
use crate::app::work::predicted_errors::{PlannedAngles, angle_choice};

/// Chooses as many angles as the plan says.
pub fn choose_angles(app: &mut App) -> Result<(), String> {
    let (surface, design, about) = (app.work.surface().clone(), app.work.settings().design.clone(), app.work.active().clone());
    // What is wrong with the request is said at once.
    angle_choice(&surface, &design, &about.measurement)?;
    app.jobs.plans.choose(ChooseAngles { surface, design, about, language: i18n::current() })
}

/// The angles are there.
pub fn chosen(app: &mut App, result: Result<PlannedAngles, NotChosen>) {
    match result {
        Ok(planned) => app.work.apply(Edit::SetPlan(planned)),
        Err(NotChosen::Cancelled) => {}
        Err(NotChosen::Because(sentence)) => app.toasts.error(sentence),
    }
}
