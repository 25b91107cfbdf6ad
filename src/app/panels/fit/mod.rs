//! The fit: start it, watch it, read it, take it or leave it.

mod comparison;
mod options;
mod outlook;
mod past;
mod result;
mod scans;

use crate::app::jobs::job::Job;
use crate::app::plots::theme;
use crate::app::text::glossary;
use crate::app::views::Cx;
use crate::app::views::action::Action;
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::fit_setup::free;
use crate::app::work::surface::Surface;
use egui::{Label, RichText, Ui};
use pbrdf::fit::{FitOptions, Weights};
use pbrdf::model::{Parameter, ParameterSet};
use tr::tr;

pub fn fit_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let work = cx.work;
    let (surface, document) = (work.surface(), work.active());
    let free = free(surface, document.measurement.has_brdf());
    let jobs = cx.jobs;
    egui::ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            let running = jobs.fits.fit.is_running();
            let fit =
                ui.add_enabled(!running, egui::Button::new(egui::RichText::new(tr!("Fit")).strong()).min_size(egui::vec2(84.0, 26.0)));
            if fit.on_hover_text(tr!("Levenberg–Marquardt from the sliders, all parameters that are not fixed")).clicked() {
                cx.actions.push(Action::StartFit);
            }
            if ui
                .add_enabled(running, egui::Button::new(tr!("Cancel")).min_size(egui::vec2(64.0, 26.0)))
                .on_hover_text(tr!("Stop and keep the best so far"))
                .clicked()
            {
                cx.actions.push(Action::CancelFit);
            }
            if running {
                ui.spinner();
            }
        });
        ui.weak(free_text(free, surface));
        if let Some(text) = cx.derived.values().and_then(|values| glossary::too_few(values, free.len())) {
            ui.add(Label::new(RichText::new(text).color(theme::warning(ui.visuals().dark_mode))).wrap());
        }
        sigmas_ui(cx, ui);
        cx.switch_ui(Switch::RefitLive, tr!("keep refitting while I drag"), ui)
            .on_hover_text(tr!("Fixed parameters follow their sliders, the others are fitted again at once"));
        match jobs.fits.fit.job().map(Job::progress) {
            Some(Some(point)) => ui.label(tr!("{0} evaluations, ΔE = {1}", point.evaluations, format!("{:.4e}", point.objective))),
            Some(None) => ui.label(tr!("Fitting…")),
            None => ui.label(tr!("Sliders: {}", delta_e_text(cx.derived.delta_e()))).on_hover_text(glossary::delta_e_help()),
        };
        options::options_ui(cx, ui);
        let outlook = ui.collapsing(tr!("What these data determine"), |ui| outlook::outlook_ui(cx.derived.outlook(), ui));
        let is_open = outlook.openness > 0.0;
        if is_open != cx.derived.is_outlook_shown {
            cx.actions.push(Action::ShowOutlook(is_open));
            ui.ctx().request_repaint();
        }
        ui.separator();
        match work.shown_fit().filter(|fit| fit.number == document.number) {
            Some(fit) => {
                if fit.report.model != surface.model {
                    ui.colored_label(theme::warning(ui.visuals().dark_mode), tr!("This fit is of another model than the sliders show."));
                }
                if fit.generation != document.generation {
                    ui.colored_label(theme::warning(ui.visuals().dark_mode), tr!("The mask has changed since this fit."))
                        .on_hover_text(glossary::mask_help());
                }
                result::result_ui(fit, work, &jobs.fits, cx.actions, ui);
                scans::scans_ui(fit, cx, ui);
            }
            None => {
                ui.label(tr!("Move the sliders until the curves are near the points, then press Fit."));
            }
        }
        past::past_fits_ui(work, cx.actions, ui);
        ui.separator();
        comparison::comparison_ui(work.model_comparison(), jobs.fits.compare.job().map(Job::progress), cx.actions, ui);
    });
}

/// ΔE as a label.
pub fn delta_e_text(delta_e: Option<f64>) -> String {
    delta_e.map_or_else(|| tr!("ΔE not defined"), |value| format!("ΔE = {value:.4e}"))
}

/// Offers stated standard deviations as weights, where they are there.
fn sigmas_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    if cx.derived.states_sigmas() && cx.derived.values().is_some_and(|values| values > 0) {
        let fit_options = cx.work.settings().fit_options;
        let mut used = fit_options.weights == Weights::Sigma;
        let help =
            tr!("Every residual is then divided by its stated standard deviation, and the sum of squares is χ²; without, ΔE is minimised.");
        if ui.checkbox(&mut used, tr!("The file states standard deviations: use them as weights")).on_hover_text(help).changed() {
            let weights = if used { Weights::Sigma } else { Weights::None };
            cx.edits.push(Edit::SetFitOptions(FitOptions { weights, ..fit_options }));
        }
    }
}

/// What a fit would change, or why it would change nothing.
fn free_text(free: ParameterSet, surface: &Surface) -> String {
    let names: Vec<&str> = free.iter().map(Parameter::symbol).collect();
    let of_model = surface.model.parameters();
    match () {
        () if !names.is_empty() => tr!("Free: {}", names.join(", ")),
        () if of_model.is_empty() => tr!("Nothing is free: no lobe with parameters is on."),
        () if of_model.without_all(surface.locked).is_empty() => tr!("Nothing is free: all parameters are fixed."),
        () => tr!("Nothing is free: the data say nothing about what is not fixed."),
    }
}
