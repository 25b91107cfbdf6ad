//! The ladder of models on the open measurement.

use crate::app::command::Command;
use crate::app::language::translated;
use crate::app::words::{aicc_help, delta_e_help};
use crate::app::worker::Rung;
use egui::{Grid, Ui};
use tr::tr;

/// The ladder of models on the open measurement: what each added term buys.
pub fn comparison_ui(comparison: &[Rung], running: Option<Option<&'static str>>, commands: &mut Vec<Command>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if ui
            .add_enabled(running.is_none(), egui::Button::new(tr!("Compare models")))
            .on_hover_text(tr!("Fit the whole ladder of models to this measurement"))
            .clicked()
        {
            commands.push(Command::CompareModels);
        }
        if running.is_some() && ui.button(tr!("Cancel comparison")).clicked() {
            commands.push(Command::CancelComparison);
        }
    });
    if let Some(at) = running {
        ui.label(tr!("Fitting: {}", at.unwrap_or("…")));
    }
    if comparison.is_empty() {
        return;
    }
    Grid::new("comparison").num_columns(4).striped(true).show(ui, |ui| {
        ui.strong(tr!("model"));
        ui.strong("ΔE").on_hover_text(delta_e_help());
        ui.strong(tr!("AICc")).on_hover_text(aicc_help());
        ui.strong("n, k");
        ui.end_row();
        for Rung { preset, result } in comparison {
            let Ok(report) = result else { continue };
            ui.label(preset.key).on_hover_text([preset.name, preset.citation, report.stop_reason.text()].map(translated).join("\n"));
            // Narrower than letters of one width, which would widen the panel.
            ui.label(report.objective.map_or_else(|| "-".to_owned(), |value| format!("{value:.3e}")));
            ui.label(report.aicc.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}")));
            ui.label(format!("{:.2}, {:.2}", report.parameters.n, report.parameters.k));
            ui.end_row();
        }
    });
}
