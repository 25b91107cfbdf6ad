//! The fit: start it, watch it, read it, take it or leave it.

mod comparison;
mod options;
mod outlook;
mod past;
mod result;
mod scans;
mod weakest;

use crate::app::jobs::job::Job;
use crate::app::plots::theme;
use crate::app::text::explained::Explained as _;
use crate::app::text::glossary;
use crate::app::views::action::Action;
use crate::app::views::{Cx, note_stop};
use crate::app::work::edit::{Edit, Switch};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::fit_setup::{free, free_together, is_joint};
use crate::app::work::surface::Surface;
use crate::app::work::workspace::Workspace;
use egui::{Button, Label, RichText, Ui, vec2};
use pbrdf::fit::{FitOptions, Weights};
use pbrdf::model::{Parameter, ParameterSet};
use std::sync::Arc;
use tr::tr;

pub fn fit_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let work = cx.work;
    let (surface, document) = (work.surface(), work.active());
    let jobs = cx.jobs;
    // A table that is wider than the panel scrolls: the panel does not grow by itself.
    egui::ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| {
        ui.add_space(4.0);
        buttons_ui(cx, ui);
        let scope = Scope::of(cx);
        ui.weak(scope.text);
        if let Some(text) = scope.values.and_then(|values| glossary::too_few(values, scope.free)) {
            ui.add(Label::new(RichText::new(text).color(theme::warning(ui.visuals().dark_mode))).wrap());
        }
        sigmas_ui(cx, ui);
        cx.switch_ui(Switch::RefitLive, tr!("keep refitting while I drag"), ui)
            .on_hover_text(tr!("Fixed parameters follow their sliders, the others are fitted again at once"));
        match jobs.fits.fit.job().map(Job::progress) {
            Some(Some(point)) => {
                let objective = format!("{:.4e}", point.objective);
                ui.label(tr!("one evaluation, ΔE = {0}" | "{n} evaluations, ΔE = {0}" % point.evaluations, objective))
            }
            Some(None) => ui.label(tr!("Fitting…")),
            None => ui.label(tr!("Sliders: {}", delta_e_text(cx.derived.delta_e()))).explained(glossary::delta_e_help()),
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
                if is_of_another_mask(fit, work) {
                    ui.colored_label(theme::warning(ui.visuals().dark_mode), tr!("The mask has changed since this fit."))
                        .on_hover_text(glossary::mask_help());
                }
                result::result_ui(fit, work, &jobs.fits, cx.actions, ui);
                weakest::weakest_ui(cx, ui);
                scans::scans_ui(fit, cx, ui);
            }
            None => {
                ui.label(tr!("Move the sliders until the curves are near the points, then press Fit."));
            }
        }
        past::past_fits_ui(work, cx.actions, ui);
        ui.separator();
        comparison::comparison_ui(work, jobs.fits.compare.job().map(Job::progress), cx.actions, ui);
    });
}

/// Whether a measurement of the fit has another mask now.
fn is_of_another_mask(fit: &FitEntry, work: &Workspace) -> bool {
    let has_changed = |part: &Arc<FitEntry>| work.measurements().get(part.number).is_some_and(|open| open.generation != part.generation);
    work.fit_history().parts(fit.id).any(has_changed)
}

/// Fit, and the way to stop it.
fn buttons_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let running = cx.jobs.fits.fit.is_running();
    let list = cx.work.measurements();
    ui.horizontal(|ui| {
        let fit = ui.add_enabled(!running, Button::new(RichText::new(tr!("Fit")).strong()).min_size(vec2(84.0, 26.0)));
        note_stop(ui.ctx(), fit.id);
        let help = if is_joint(list) {
            tr!("All measurements together, from their sliders, all parameters that are not fixed")
        } else {
            tr!("Levenberg–Marquardt from the sliders, all parameters that are not fixed")
        };
        if fit.on_hover_text(help).clicked() {
            cx.actions.push(Action::StartFit);
        }
        let cancel = ui.add_enabled(running, Button::new(tr!("Cancel")).min_size(vec2(64.0, 26.0)));
        if cancel.on_hover_text(tr!("Stop and keep the best so far")).clicked() {
            cx.actions.push(Action::CancelFit);
        }
        if running {
            ui.spinner();
        } else if list.measured().count() > 1 && !is_joint(list) {
            let each = ui.add(Button::new(tr!("Fit each")).min_size(vec2(0.0, 26.0)));
            if each.on_hover_text(tr!("Every open measurement by itself, one after the other")).clicked() {
                cx.actions.push(Action::FitEach);
            }
        }
    });
}

/// What a fit would change, and how many values there are.
struct Scope {
    text: String,
    values: Option<usize>,
    free: usize,
}

impl Scope {
    fn of(cx: &Cx<'_>) -> Self {
        let (list, surface) = (cx.work.measurements(), cx.work.surface());
        if !is_joint(list) {
            let free = free(surface, list.active().measurement.has_brdf());
            return Self { text: free_text(free, surface), values: cx.derived.values_of(list.active().number), free: free.len() };
        }
        let sets = list.measured().map(|open| free_together(list, open));
        let shared = sets.clone().fold(ParameterSet::EMPTY, ParameterSet::union).intersection(list.shared());
        let own: Vec<ParameterSet> = sets.map(|free| free.without_all(list.shared())).collect();
        let names = |set: ParameterSet| set.iter().map(Parameter::symbol).collect::<Vec<_>>().join(", ");
        let any_own = own.iter().copied().fold(ParameterSet::EMPTY, ParameterSet::union);
        let text = match (shared.is_empty(), any_own.is_empty()) {
            (true, true) => tr!("Nothing is free: all parameters are fixed."),
            (false, true) => tr!("{0} measurements together. Free and shared: {1}", own.len(), names(shared)),
            (true, false) => tr!("{0} measurements together. Free and own: {1}", own.len(), names(any_own)),
            (false, false) => {
                tr!("{0} measurements together. Free and shared: {1}; own: {2}", own.len(), names(shared), names(any_own))
            }
        };
        let values = list.measured().map(|open| cx.derived.values_of(open.number)).sum();
        Self { text, values, free: shared.len() + own.iter().map(|set| set.len()).sum::<usize>() }
    }
}

/// ΔE as a label.
pub fn delta_e_text(delta_e: Option<f64>) -> String {
    delta_e.map_or_else(|| tr!("ΔE not defined"), |value| format!("ΔE = {value:.4e}"))
}

/// Offers stated standard deviations as weights, where they are there.
fn sigmas_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    if cx.derived.states_sigmas() && cx.derived.values_of(cx.work.active().number).is_some_and(|values| values > 0) {
        let fit_options = cx.work.settings().fit_options;
        let mut used = fit_options.weights == Weights::Sigma;
        let help =
            tr!("Every residual is then divided by its stated standard deviation, and the sum of squares is χ²; without, ΔE is minimised.");
        if ui.checkbox(&mut used, tr!("Weight by the stated standard deviations")).on_hover_text(help).changed() {
            let weights = if used { Weights::Sigma } else { Weights::None };
            cx.edits.push(Edit::SetFitOptions(FitOptions { weights, ..fit_options }));
        }
        if fit_options.weights == Weights::None {
            ui.weak(tr!("The file states them. Without the tick all values count alike, as in ΔE of Eq. (18)."));
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
