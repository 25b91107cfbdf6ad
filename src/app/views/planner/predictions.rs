//! The errors before and after a plan.

use crate::app::plots::theme;
use crate::app::text::explained::Explained as _;
use crate::app::text::glossary::open_help;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::numbers::{percent, short, significant};
use crate::app::views::planner::PlannerView;
use crate::app::work::predicted_errors::PredictedErrors;
use crate::app::work::workspace::Workspace;
use egui::{Grid, Ui};
use pbrdf::fit::Undetermined;
use pbrdf::model::{Parameter, Parameters};
use tr::tr;

/// Width from which errors stand in percent too.
const WITH_PERCENT: f32 = 450.0;

pub fn predictions_ui(work: &Workspace, view: &PlannerView, ui: &mut Ui) {
    let warning = theme::warning(ui.visuals().dark_mode);
    let Some([now, planned]) = view.predictions.get() else {
        ui.label("…");
        return;
    };
    let parameters = &work.surface().parameters;
    let design = &work.settings().design;
    let (incidences, views) = design.counts();
    let measured = work.active().measurement.rows.len() - work.active().mask().len();
    match design.readings.len() {
        0 => ui.strong(tr!("Predicted standard errors: {0} × {1} planned points", incidences, views)),
        planned if design.counts_given && measured > 0 => {
            ui.strong(tr!("Predicted standard errors: {0} planned readings beside {1} that are measured", planned, measured))
        }
        planned => ui.strong(tr!("Predicted standard errors: {} planned readings", planned)),
    };
    ui.weak(tr!("At the sliders as they stand; both columns with the planned noise."));
    for sentence in [now, planned].into_iter().filter_map(|prediction| prediction.as_ref().err()) {
        ui.colored_label(warning, sentence);
    }
    let any = planned.as_ref().or(now.as_ref());
    let Ok(any) = any else { return };
    let with_percent = ui.available_width() > WITH_PERCENT;
    Grid::new("predicted errors").num_columns(5).striped(true).spacing([9.0, 4.0]).min_col_width(0.0).show(ui, |ui| {
        for (heading, help) in [
            ("", ""),
            ("value", "The slider"),
            ("± now", "With the angles of the open measurement"),
            ("± planned", "With the planned angles"),
            ("gain", "How many times smaller the error becomes: now over planned"),
        ] {
            if heading.is_empty() {
                ui.scope(|_| ());
            } else {
                ui.strong(translated(heading)).explained(translated(help));
            }
        }
        ui.end_row();
        for (parameter, _) in &any.errors {
            error_row_ui(parameters, *parameter, [now, planned], with_percent, ui);
        }
    });
    for (prediction, angles) in [(planned, "With the planned angles"), (now, "With the measured angles")] {
        if let Ok(prediction) = prediction {
            open_ui(prediction, angles, ui);
        }
    }
}

fn error_row_ui(
    parameters: &Parameters,
    parameter: Parameter,
    [now, planned]: [&Result<PredictedErrors, String>; 2],
    with_percent: bool,
    ui: &mut Ui,
) {
    let value = parameters[parameter];
    let error =
        |prediction: &Result<PredictedErrors, String>| prediction.as_ref().ok().and_then(|prediction| prediction.error_of(parameter));
    ui.label(parameter.symbol()).on_hover_text(translated(parameter.name()));
    ui.monospace(significant(value));
    for prediction in [now, planned] {
        match (prediction, error(prediction)) {
            (Err(_), _) => _ = ui.monospace("-"),
            (Ok(_), None) => _ = ui.monospace(tr!("open")).explained(open_help()),
            (Ok(prediction), Some(error)) if !prediction.determined.contains(parameter) => {
                ui.monospace(tr!("not determined")).on_hover_text(format!("± {}", short(error)));
            }
            (Ok(_), Some(error)) => {
                let share = percent(parameter, value, error);
                let text = if with_percent { format!("{} ({share})", short(error)) } else { short(error) };
                ui.monospace(text).on_hover_text(share);
            }
        }
    }
    ui.monospace(error(now).zip(error(planned)).map_or_else(String::new, |(now, planned)| short(now / planned)));
    ui.end_row();
}

/// What stays open, in words.
fn open_ui(prediction: &PredictedErrors, angles: &str, ui: &mut Ui) {
    let loose = prediction.errors.iter().filter(|(_, error)| error.is_some()).map(|(parameter, _)| *parameter);
    let loose: Vec<Parameter> = loose.filter(|parameter| !prediction.determined.contains(*parameter)).collect();
    let directions = prediction.open.iter().cloned().map(Undetermined::Direction);
    let loose = (!loose.is_empty()).then_some(Undetermined::Parameters(loose));
    let open: Vec<Undetermined> = directions.chain(loose).collect();
    if open.is_empty() {
        ui.add(egui::Label::new(tr!("{} nothing stays open.", translated(angles))).wrap());
        return;
    }
    ui.add_space(4.0);
    ui.strong(tr!("{} there stays open:", translated(angles)));
    for what in &open {
        ui.add(egui::Label::new(format!("• {}", what.localized())).wrap());
    }
}
