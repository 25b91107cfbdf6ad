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
use crate::app::views::derived::Derived;
use crate::app::work::fit_setup::free;
use crate::app::work::settings::Settings;
use egui::{Label, RichText, Ui};
use pbrdf::fit::Weights;
use pbrdf::model::{Parameter, ParameterSet};
use tr::tr;

/// The panel; `show_predicted_errors` tells whether what the data would determine is unfolded.
pub fn fit_ui(cx: &mut Cx<'_>, show_predicted_errors: &mut bool, ui: &mut Ui) {
    let free = free(cx.settings, cx.document.measurement.has_brdf());
    let last_fit = cx.fit;
    let Cx { jobs, actions: commands, derived, fits: fit_history, document, settings, comparison, diagnostics: scans, .. } = cx;
    egui::ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            let running = jobs.fits.fit.is_running();
            let fit =
                ui.add_enabled(!running, egui::Button::new(egui::RichText::new(tr!("Fit")).strong()).min_size(egui::vec2(84.0, 26.0)));
            if fit.on_hover_text(tr!("Levenberg–Marquardt from the sliders, all parameters that are not fixed")).clicked() {
                commands.push(Action::StartFit);
            }
            if ui
                .add_enabled(running, egui::Button::new(tr!("Cancel")).min_size(egui::vec2(64.0, 26.0)))
                .on_hover_text(tr!("Stop and keep the best so far"))
                .clicked()
            {
                commands.push(Action::CancelFit);
            }
            if running {
                ui.spinner();
            }
        });
        ui.weak(free_text(free, settings));
        if let Some(text) = derived.values().and_then(|values| glossary::too_few(values, free.len())) {
            ui.add(Label::new(RichText::new(text).color(theme::warning(ui.visuals().dark_mode))).wrap());
        }
        sigmas_ui(settings, derived, ui);
        ui.checkbox(&mut settings.refit_live, tr!("keep refitting while I drag"))
            .on_hover_text(tr!("Fixed parameters follow their sliders, the others are fitted again at once"));
        match jobs.fits.fit.job().map(Job::progress) {
            Some(Some(point)) => ui.label(tr!("{0} evaluations, ΔE = {1}", point.evaluations, format!("{:.4e}", point.objective))),
            Some(None) => ui.label(tr!("Fitting…")),
            None => ui.label(tr!("Sliders: {}", delta_e_text(derived.delta_e()))).on_hover_text(glossary::delta_e_help()),
        };
        options::options_ui(settings, &document.measurement, derived.states_sigmas(), ui);
        let outlook = ui.collapsing(tr!("What these data determine"), |ui| outlook::outlook_ui(derived.outlook(), ui));
        let was_shown = std::mem::replace(show_predicted_errors, outlook.openness > 0.0);
        if *show_predicted_errors != was_shown {
            // It is made before the next frame.
            ui.ctx().request_repaint();
        }
        ui.separator();
        match last_fit.filter(|fit| fit.number == document.number) {
            Some(fit) => {
                if fit.report.model != settings.model {
                    ui.colored_label(theme::warning(ui.visuals().dark_mode), tr!("This fit is of another model than the sliders show."));
                }
                if fit.generation != document.generation {
                    ui.colored_label(theme::warning(ui.visuals().dark_mode), tr!("The mask has changed since this fit."))
                        .on_hover_text(glossary::mask_help());
                }
                result::result_ui(fit, settings, scans.scatter.as_ref(), commands, ui);
                scans::scans_ui(fit, scans, jobs.fits.is_scanning(), commands, ui);
            }
            None => {
                ui.label(tr!("Move the sliders until the curves are near the points, then press Fit."));
            }
        }
        past::past_fits_ui(fit_history, last_fit, document.number, commands, ui);
        ui.separator();
        comparison::comparison_ui(comparison, jobs.fits.compare.job().map(Job::progress), commands, ui);
    });
}

/// ΔE as a label.
pub fn delta_e_text(delta_e: Option<f64>) -> String {
    delta_e.map_or_else(|| tr!("ΔE not defined"), |value| format!("ΔE = {value:.4e}"))
}

/// Offers stated standard deviations as weights, where they are there.
fn sigmas_ui(settings: &mut Settings, derived: &Derived, ui: &mut Ui) {
    if derived.states_sigmas() && derived.values().is_some_and(|values| values > 0) {
        let mut used = settings.choices.weights == Weights::Sigma;
        let help =
            tr!("Every residual is then divided by its stated standard deviation, and the sum of squares is χ²; without, ΔE is minimised.");
        if ui.checkbox(&mut used, tr!("The file states standard deviations: use them as weights")).on_hover_text(help).changed() {
            settings.choices.weights = if used { Weights::Sigma } else { Weights::None };
        }
    }
}

/// What a fit would change, or why it would change nothing.
fn free_text(free: ParameterSet, settings: &Settings) -> String {
    let names: Vec<&str> = free.iter().map(Parameter::symbol).collect();
    let of_model = settings.model.parameters();
    match () {
        () if !names.is_empty() => tr!("Free: {}", names.join(", ")),
        () if of_model.is_empty() => tr!("Nothing is free: no lobe with parameters is on."),
        () if of_model.without_all(settings.locked).is_empty() => tr!("Nothing is free: all parameters are fixed."),
        () => tr!("Nothing is free: the data say nothing about what is not fixed."),
    }
}
