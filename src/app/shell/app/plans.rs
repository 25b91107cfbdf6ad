//! Angles that the window lets choose, and what it does with them.

use crate::app::shell::app::App;
use crate::app::text::localized::Localized as _;
use crate::app::work::design::DesignSettings;
use crate::app::work::edit::Edit;
use crate::app::work::predicted_errors::{PlannedAngles, PredictedErrors, angle_choice, measured};
use pbrdf::fit::AngleChoiceError;
use pbrdf::model::Parameter;
use tr::tr;

/// Chooses as many angles as the plan says.
pub fn choose_angles(app: &mut App) -> Result<(), String> {
    let (surface, design, open) = (app.work.surface().clone(), app.work.settings().design.clone(), app.work.active());
    let choice = angle_choice(&surface, &design, &open.measurement)?;
    let given = if design.counts_given { measured(&open.measurement) } else { Vec::new() };
    let asked = design.goal.parameters(choice.free);
    let loose = move |angles: &[[f64; 3]]| -> Vec<Parameter> {
        let readings = angles.iter().map(|&[theta_i, theta_r, _]| [theta_i, theta_r]).collect();
        let design = DesignSettings { readings, ..design.clone() };
        let predicted = PredictedErrors::of_plan(&surface, &design, choice_free(&surface, &design), &given);
        let determined = predicted.map(|predicted| predicted.determined).unwrap_or_default();
        asked.iter().filter(|parameter| !determined.contains(*parameter)).collect()
    };
    app.jobs.plans.choose(choice, loose)
}

fn choice_free(surface: &crate::app::work::surface::Surface, design: &DesignSettings) -> pbrdf::model::ParameterSet {
    crate::app::work::fit_setup::free_in_design(surface, design, design.has_brdf())
}

/// The angles are there.
pub fn chosen(app: &mut App, result: Result<PlannedAngles, AngleChoiceError>) {
    match result {
        Ok(planned) => app.work.apply(Edit::SetPlan(planned)),
        Err(AngleChoiceError::Cancelled) => {}
        Err(error) => app.toasts.error(tr!("No angles can be chosen: {}.", error.localized())),
    }
}
