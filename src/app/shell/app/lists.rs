//! What menus, keys and the palette do with the open measurements and the pinned surfaces.

use crate::app::shell::app::App;
use crate::app::text::i18n::translated;
use crate::app::views::action::ListAction;
use crate::app::work::edit::Edit;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::open_measurement::{MeasurementStyle, OpenMeasurement};
use pbrdf::model::{Model, Preset};
use pbrdf::optics::SlopeDistribution;
use tr::tr;

/// Carries out an action; the error is a sentence.
pub fn execute(app: &mut App, action: ListAction) -> Result<(), String> {
    match action {
        ListAction::Activate(number) => app.work.apply(Edit::Activate(number)),
        ListAction::Step(by) => step(app, by),
        ListAction::Rename => app.dialogs.lists.measurements.rename(app.work.active()),
        ListAction::Move(by) => app.work.apply(Edit::MoveMeasurement { number: app.work.active().number, by }),
        ListAction::ShowAll(shown) => show_all(app, shown),
        ListAction::Close(number) => app.work.apply(Edit::Close(number.unwrap_or(app.work.active().number))),
        ListAction::Share(sharing) => app.work.apply(Edit::Share(sharing.shared())),
        ListAction::PinSliders => pin_sliders(app),
        ListAction::PinOtherDistribution => pin_other_distribution(app)?,
        ListAction::PinFit => pin_fit(app),
        ListAction::PinModelFit(index) => pin_model_fit(app, index),
        ListAction::UnpinAll => unpin_all(app),
    }
    Ok(())
}

/// Shows the measurement so many places down the list, around its ends.
fn step(app: &mut App, by: isize) {
    let list = app.work.measurements();
    let numbers: Vec<u64> = list.iter().map(|open| open.number).collect();
    let at = list.active_index().cast_signed() + by;
    let number = numbers[at.rem_euclid(numbers.len().cast_signed()).cast_unsigned()];
    app.work.apply(Edit::Activate(number));
}

/// Draws all measurements, or the active one alone.
fn show_all(app: &mut App, shown: bool) {
    let style = |open: &OpenMeasurement| Edit::SetMeasurementStyle { number: open.number, style: MeasurementStyle { shown, ..open.style } };
    let edits: Vec<Edit> = app.work.measurements().iter().map(style).collect();
    edits.into_iter().for_each(|edit| app.work.apply(edit));
}

/// The name of a model's preset, if it is one.
fn model_name(model: Model) -> String {
    Preset::of(model).map_or_else(|| tr!("own terms"), |preset| translated(preset.name))
}

fn pin_sliders(app: &mut App) {
    let (model, parameters) = (app.work.surface().model, app.work.surface().parameters);
    app.work.apply(Edit::Pin { name: model_name(model), model, parameters });
}

/// The other distribution of slopes with the same median beside the one of the sliders.
fn pin_other_distribution(app: &mut App) -> Result<(), String> {
    let Some((model, parameters)) = app.work.surface().of_equal_median() else {
        return Err(tr!("There is no specular lobe, and so no distribution of slopes."));
    };
    let name = match model.distribution {
        SlopeDistribution::Gauss => tr!("Gauss, equal median slope"),
        SlopeDistribution::Cauchy => tr!("Cauchy, equal median slope"),
    };
    app.work.apply(Edit::Pin { name, model, parameters });
    Ok(())
}

fn pin_fit(app: &mut App) {
    if let Some(fit) = app.work.shown_fit() {
        let (model, parameters) = (fit.report.model, fit.report.parameters);
        let name = tr!("Fit {0}: {1}", fit.id, model_name(model));
        app.work.apply(Edit::Pin { name, model, parameters });
    }
}

/// A row of the comparison of models.
fn pin_model_fit(app: &mut App, index: usize) {
    if let Some(ModelFit { preset, result: Ok(fit), .. }) = app.work.model_comparison().get(index) {
        let (model, parameters) = (fit.report.model, fit.report.parameters);
        app.work.apply(Edit::Pin { name: translated(preset.name), model, parameters });
    }
}

fn unpin_all(app: &mut App) {
    for place in (0..app.work.pinned().len()).rev() {
        app.work.apply(Edit::Unpin(place));
    }
}
