//! The last fits, to look at again and to return to.

use crate::app::text::estimate::uncertainty_text;
use crate::app::text::localized::Localized as _;
use crate::app::views::action::Action;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::open_measurement::title_of;
use crate::app::work::workspace::Workspace;
use crate::report::bracketed;
use egui::{Button, CollapsingHeader, Label, RichText, Ui};
use pbrdf::fit::Estimate;
use pbrdf::model::{Parameter, ParameterSet};
use std::sync::Arc;
use tr::tr;

pub fn past_fits_ui(work: &Workspace, commands: &mut Vec<Action>, ui: &mut Ui) {
    let (fits, shown, number) = (work.fit_history(), work.shown_fit(), work.active().number);
    if fits.is_empty() {
        return;
    }
    let title = tr!("History of fits ({})", fits.len());
    CollapsingHeader::new(title).id_salt("past fits").show(ui, |ui| {
        ui.weak(tr!("A click returns to a fit; undo takes it back."));
        for (index, fit) in fits.rows(number).enumerate() {
            let is_shown = shown.is_some_and(|shown| Arc::ptr_eq(shown, fit));
            if fit_ui(fit, is_shown, fit.number != number, ui) {
                commands.push(Action::ReturnToFit(index));
            }
        }
    });
}

/// Two lines: file and model; ΔE, n, k and what was free. Whether it was clicked.
fn fit_ui(fit: &FitEntry, is_shown: bool, is_elsewhere: bool, ui: &mut Ui) -> bool {
    let report = &fit.report;
    let model = fit.preset().map_or_else(|| tr!("own terms"), |preset| preset.key.to_owned());
    let line =
        |estimate: &Estimate| format!("\n{} = {}, {}", estimate.parameter.symbol(), estimate.value_text(), uncertainty_text(estimate));
    let values: String = report.estimates.iter().filter(|estimate| estimate.free).map(line).collect();
    let elsewhere = if is_elsewhere { format!("\n{}", tr!("A click shows that measurement, too.")) } else { String::new() };
    let help = format!("{}\n{}{elsewhere}{values}", fit.document, report.stop_reason.localized());
    let about = match &fit.joint {
        Some(part) => tr!("{} together", part.of.result.sets.len()),
        None => title_of(&fit.document),
    };
    let button = Button::selectable(is_shown, format!("{}. {about} · {model}", fit.id)).truncate();
    let is_clicked = ui.add(button).on_hover_text(&help).clicked();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 10.0;
        ui.add_space(14.0);
        let objective = fit.joint.as_ref().map_or(report.objective, |part| part.of.result.objective);
        let delta_e = objective.map_or_else(|| "–".to_owned(), |value| format!("{value:.3e}"));
        let values = [Parameter::N, Parameter::K].map(|parameter| {
            let value = report.estimate(parameter).map_or_else(|| "–".to_owned(), bracketed);
            format!("{} = {value}", parameter.symbol())
        });
        for text in [format!("ΔE = {delta_e}")].into_iter().chain(values).chain([free_text(fit)]) {
            ui.add(Label::new(RichText::new(text).small()).extend());
        }
    });
    is_clicked
}

/// What was free, or the few that were not.
fn free_text(fit: &FitEntry) -> String {
    let free: ParameterSet = fit.problem.free().iter().copied().collect();
    let symbols = |set: ParameterSet| set.iter().map(Parameter::symbol).collect::<Vec<_>>().join(", ");
    let fixed = fit.report.model.parameters().without_all(free);
    match (free.is_empty(), fixed.is_empty()) {
        (true, _) => tr!("nothing was free"),
        (_, true) => tr!("all free"),
        _ if fixed.iter().count() <= FEW => tr!("all free but {}", symbols(fixed)),
        _ => tr!("free: {}", symbols(free)),
    }
}

/// Fixed parameters that are named in place of the free ones.
const FEW: usize = 3;
