//! The last fits, to look at again and to return to.

use crate::app::text::estimate::uncertainty_text;
use crate::app::text::glossary::delta_e_help;
use crate::app::text::localized::Localized as _;
use crate::app::views::action::Action;
use crate::app::work::workspace::Workspace;
use egui::{CollapsingHeader, Grid, Ui};
use pbrdf::fit::Estimate;
use pbrdf::model::Preset;
use std::sync::Arc;
use tr::tr;

/// The beginning of a name, for a narrow column.
fn beginning(name: &str) -> String {
    const LETTERS: usize = 14;
    if name.chars().count() <= LETTERS { name.to_owned() } else { name.chars().take(LETTERS - 1).chain(['…']).collect() }
}

pub fn past_fits_ui(work: &Workspace, commands: &mut Vec<Action>, ui: &mut Ui) {
    let (fits, shown, number) = (work.fit_history(), work.shown_fit(), work.active().number);
    if fits.is_empty() {
        return;
    }
    let is_mixed = fits.rows(number).any(|fit| fit.number != number);
    let title = tr!("History of fits ({})", fits.len());
    CollapsingHeader::new(title).id_salt("past fits").show(ui, |ui| {
        ui.weak(tr!("A click returns to a fit; undo takes it back."));
        Grid::new("past fits").num_columns(3).striped(true).show(ui, |ui| {
            ui.strong(tr!("model"));
            ui.strong("ΔE").on_hover_text(delta_e_help());
            ui.strong(tr!("time"));
            ui.end_row();
            for (index, fit) in fits.rows(number).enumerate() {
                let report = &fit.report;
                let model = Preset::of(report.model).map_or_else(|| tr!("own terms"), |preset| preset.key.to_owned());
                let elsewhere =
                    if fit.number == number { String::new() } else { format!("\n{}", tr!("A click shows that measurement, too.")) };
                let is_shown = shown.is_some_and(|shown| Arc::ptr_eq(shown, fit));
                let line = |estimate: &Estimate| {
                    format!("\n{} = {}, {}", estimate.parameter.symbol(), estimate.value_text(), uncertainty_text(estimate))
                };
                let values: String = report.estimates.iter().filter(|estimate| estimate.free).map(line).collect();
                let help = format!("{}\n{}{elsewhere}{values}", fit.document, report.stop_reason.localized());
                let about = if let Some(part) = &fit.joint {
                    format!(" · {}", tr!("{} together", part.of.result.sets.len()))
                } else if is_mixed {
                    format!(" · {}", beginning(&fit.document))
                } else {
                    String::new()
                };
                if ui.selectable_label(is_shown, format!("{}. {model}{about}", fit.id)).on_hover_text(help).clicked() {
                    commands.push(Action::ReturnToFit(index));
                }
                let objective = fit.joint.as_ref().map_or(report.objective, |part| part.of.result.objective);
                ui.monospace(objective.map_or_else(|| "-".to_owned(), |value| format!("{value:.4e}")));
                ui.monospace(if report.course.minima.is_empty() {
                    "–".to_owned()
                } else {
                    format!("{:.1} ms", report.course.elapsed_ms)
                });
                ui.end_row();
            }
        });
    });
}
