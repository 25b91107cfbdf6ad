//! The fit: start it, watch it, read it, take it or leave it.

use super::parameters::significant;
use super::status::delta_e_text;
use crate::app::command::Command;
use crate::app::derived::Outlook;
use crate::app::theme;
use crate::app::window::{Explorer, LastFit};
use egui::{Grid, Ui};
use pbrdf::fit::{Edge, Estimate, FitReport, StopReason};
use pbrdf::model::{Parameter, ParameterSet, Preset};

pub fn fit_ui(explorer: &mut Explorer, ui: &mut Ui) {
    let free = explorer.free();
    let Explorer { worker, commands, derived, last_fit, document, settings, comparison, outlook_is_shown, .. } = explorer;
    egui::ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            let running = worker.fit.is_some();
            let fit = ui.add_enabled(!running, egui::Button::new(egui::RichText::new("Fit").strong()).min_size(egui::vec2(84.0, 26.0)));
            if fit.on_hover_text("Levenberg–Marquardt from the sliders, all parameters that are not fixed").clicked() {
                commands.push(Command::StartFit);
            }
            if ui
                .add_enabled(running, egui::Button::new("Cancel").min_size(egui::vec2(64.0, 26.0)))
                .on_hover_text("Stop and keep the best so far")
                .clicked()
            {
                commands.push(Command::CancelFit);
            }
            if running {
                ui.spinner();
            }
        });
        ui.weak(free_text(free));
        ui.checkbox(&mut settings.refit_live, "keep refitting while I drag")
            .on_hover_text("Fixed parameters follow their sliders, the others are fitted again at once");
        match worker.fit.as_ref().map(super::super::worker::Job::progress) {
            Some(Some(point)) => ui.label(format!("{} evaluations, ΔE = {:.4e}", point.evaluations, point.objective)),
            Some(None) => ui.label("Fitting…"),
            None => ui.label(format!("Sliders: {}", delta_e_text(derived.delta_e))),
        };
        let outlook = ui.collapsing("What these data determine", |ui| outlook_ui(derived.outlook.as_ref(), ui));
        let was_shown = std::mem::replace(outlook_is_shown, outlook.openness > 0.0);
        if *outlook_is_shown != was_shown {
            // It is made before the next frame.
            ui.ctx().request_repaint();
        }
        ui.separator();
        match last_fit.as_ref().filter(|fit| fit.generation == document.generation) {
            Some(fit) => {
                if fit.report.model != settings.model {
                    ui.colored_label(theme::warning(ui.visuals().dark_mode), "This fit is of another model than the sliders show.");
                }
                result_ui(fit, commands, ui);
            }
            None => {
                ui.label("Move the sliders until the curves are near the points, then press Fit.");
            }
        }
        ui.separator();
        comparison_ui(comparison, worker.comparison.as_ref().map(super::super::worker::Job::progress), commands, ui);
    });
}

/// Minima that are listed at most.
const MOST_MINIMA: usize = 8;

/// Standard errors that a fit from the sliders would have, before it is made.
fn outlook_ui(outlook: Option<&Outlook>, ui: &mut Ui) {
    let Some(outlook) = outlook else {
        ui.label("…");
        return;
    };
    let basis = if outlook.from_stated { "from the stated standard deviations" } else { "if the noise is as large as the present misfit" };
    ui.weak(format!("Standard errors at the sliders, {basis}:"));
    Grid::new("outlook").num_columns(2).show(ui, |ui| {
        for (parameter, error) in &outlook.errors {
            ui.label(parameter.symbol());
            ui.label(error.map_or_else(|| "open".to_owned(), |error| format!("± {} {}", significant(error), parameter.unit())));
            ui.end_row();
        }
    });
    for direction in &outlook.open {
        ui.add(egui::Label::new(format!("• {}", direction.text)).wrap());
    }
}

fn free_text(free: ParameterSet) -> String {
    let names: Vec<&str> = free.iter().map(Parameter::symbol).collect();
    if names.is_empty() { "Nothing is free: all parameters are fixed.".to_owned() } else { format!("Free: {}", names.join(", ")) }
}

fn result_ui(fit: &LastFit, commands: &mut Vec<Command>, ui: &mut Ui) {
    let report = &fit.report;
    ui.horizontal(|ui| {
        if ui.button("Use as sliders").on_hover_text("The fitted values to the sliders").clicked() {
            commands.push(Command::UseFit);
        }
        if ui.button("Back").on_hover_text("The sliders as they were before the fit").clicked() {
            commands.push(Command::Back);
        }
    });
    ui.add_space(4.0);
    let text = report.stop_reason.text();
    let capital: String = text.chars().take(1).flat_map(char::to_uppercase).chain(text.chars().skip(1)).collect();
    if matches!(report.stop_reason, StopReason::Converged | StopReason::ResidualsZero) {
        ui.strong(capital);
    } else {
        ui.colored_label(theme::warning(ui.visuals().dark_mode), capital);
    }
    Grid::new("fit summary").num_columns(2).show(ui, |ui| {
        for (name, value) in [
            ("Before", delta_e_text(report.start_objective)),
            ("After", delta_e_text(report.objective)),
            ("Minimised", minimised_text(report)),
            ("Time", format!("{:.2} ms, {} evaluations", report.elapsed_ms, report.evaluations)),
        ] {
            if !value.is_empty() {
                ui.label(name);
                ui.label(value);
                ui.end_row();
            }
        }
    });
    ui.add_space(6.0);
    Grid::new("fit result").num_columns(4).striped(true).min_col_width(44.0).show(ui, |ui| {
        for heading in ["", "start", "value", "± std. error"] {
            ui.strong(heading);
        }
        ui.end_row();
        for estimate in &report.estimates {
            ui.label(estimate.parameter.symbol()).on_hover_text(estimate.parameter.name());
            ui.monospace(significant(estimate.start));
            ui.monospace(significant(estimate.value));
            ui.label(error_text(estimate, report));
            ui.end_row();
        }
    });
    ui.add_space(6.0);
    minima_ui(report, ui);
    correlations_ui(report, ui);
    if !report.undetermined.is_empty() {
        ui.add_space(6.0);
        ui.strong("The data leave open:");
        for direction in &report.undetermined {
            ui.add(egui::Label::new(format!("• {}", direction.text)).wrap());
        }
    }
}

/// The ladder of models on the open measurement: what each added term buys.
fn comparison_ui(
    comparison: &[(&'static Preset, FitReport)],
    running: Option<Option<&'static str>>,
    commands: &mut Vec<Command>,
    ui: &mut Ui,
) {
    ui.horizontal(|ui| {
        if ui
            .add_enabled(running.is_none(), egui::Button::new("Compare models"))
            .on_hover_text("Fit the whole ladder of models to this measurement")
            .clicked()
        {
            commands.push(Command::CompareModels);
        }
        if running.is_some() && ui.button("Cancel comparison").clicked() {
            commands.push(Command::CancelComparison);
        }
    });
    if let Some(at) = running {
        ui.label(format!("Fitting: {}", at.unwrap_or("…")));
    }
    if comparison.is_empty() {
        return;
    }
    Grid::new("comparison").num_columns(4).striped(true).show(ui, |ui| {
        for heading in ["model", "ΔE", "AICc", "n, k"] {
            ui.strong(heading);
        }
        ui.end_row();
        for (preset, report) in comparison {
            ui.label(preset.key).on_hover_text(format!("{}\n{}\n{}", preset.name, preset.citation, report.stop_reason.text()));
            ui.monospace(report.objective.map_or_else(|| "-".to_owned(), |value| format!("{value:.3e}")));
            ui.monospace(report.aicc.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}")));
            ui.monospace(format!("{:.2}, {:.2}", report.parameters.n, report.parameters.k));
            ui.end_row();
        }
    });
}

/// What fell, where that was not ΔE: measured lobes are fitted by relative residuals.
fn minimised_text(report: &FitReport) -> String {
    match report.start_sum_of_squares {
        Some(start) if !report.minimises_delta_e => format!("relative residuals, Σ² {start:.3e} to {:.3e}", report.sum_of_squares),
        _ => String::new(),
    }
}

/// Where the starts led: distinct minima, best first.
fn minima_ui(report: &FitReport, ui: &mut Ui) {
    let starts: usize = report.minima.iter().map(|minimum| minimum.reached).sum();
    ui.collapsing(format!("{} minima from {starts} starts", report.minima.len()), |ui| {
        Grid::new("minima").num_columns(3).striped(true).show(ui, |ui| {
            for heading in ["ΔE", "reached", "stop"] {
                ui.strong(heading);
            }
            ui.end_row();
            for minimum in report.minima.iter().take(MOST_MINIMA) {
                ui.monospace(format!("{:.5e}", minimum.objective));
                ui.label(format!("{} ×", minimum.reached));
                ui.add(egui::Label::new(minimum.stop_reason.text()).truncate());
                ui.end_row();
            }
        });
    });
}

/// Correlations of the determined parameters as a coloured table: blue where two rise together, orange where one makes up for the other.
fn correlations_ui(report: &FitReport, ui: &mut Ui) {
    if report.determined.len() < 2 {
        return;
    }
    ui.collapsing("Correlations", |ui| {
        let dark = ui.visuals().dark_mode;
        Grid::new("correlations").spacing([2.0, 2.0]).show(ui, |ui| {
            ui.label("");
            for parameter in &report.determined {
                ui.label(parameter.symbol());
            }
            ui.end_row();
            for (i, parameter) in report.determined.iter().enumerate() {
                ui.label(parameter.symbol());
                for (j, other) in report.determined.iter().enumerate() {
                    let r = report.correlations[(i, j)];
                    let (rect, response) = ui.allocate_exact_size(egui::vec2(30.0, 20.0), egui::Sense::hover());
                    ui.painter().rect_filled(rect, 2.0, theme::correlation(r, dark));
                    ui.painter().text(
                        rect.center(),
                        egui::Align2::CENTER_CENTER,
                        short_correlation(r),
                        egui::FontId::proportional(11.0),
                        ui.visuals().text_color(),
                    );
                    response.on_hover_text(format!("{} and {}: r = {r:.4}", parameter.symbol(), other.symbol()));
                }
                ui.end_row();
            }
        });
    });
}

/// Two decimals without the leading zero.
fn short_correlation(r: f64) -> String {
    if r.is_nan() { "-".to_owned() } else { format!("{r:.2}").replace("0.", ".") }
}

fn error_text(estimate: &Estimate, report: &FitReport) -> String {
    let unit = estimate.parameter.unit();
    match (estimate.free, estimate.at_bound, estimate.std_error) {
        (false, ..) => "fixed".to_owned(),
        (true, Some(Edge::Lower), _) => "at lower bound".to_owned(),
        (true, Some(Edge::Upper), _) => "at upper bound".to_owned(),
        (true, None, Some(error)) => format!("{error:.1e} {unit}").trim_end().to_owned(),
        (true, None, None) if report.determined.contains(&estimate.parameter) => "no d.o.f.".to_owned(),
        (true, None, None) => "open".to_owned(),
    }
}
