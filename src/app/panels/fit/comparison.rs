//! The button that fits the ladder of models; its results are in a pane of their own.

use crate::app::views::action::Action;
use crate::app::views::running_model_ui;
use crate::app::work::model_fit::ModelFit;
use egui::Ui;
use tr::tr;

/// Orders the comparison, and says where its results are.
pub fn comparison_ui(comparison: &[ModelFit], running: Option<Option<&'static str>>, commands: &mut Vec<Action>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let compare = ui.add_enabled(running.is_none(), egui::Button::new(tr!("Compare models")));
        if compare.on_hover_text(tr!("Fit the whole ladder of models to this measurement; results in the pane Models")).clicked() {
            commands.push(Action::CompareModels);
        }
        if running.is_some() && ui.button(tr!("Cancel comparison")).clicked() {
            commands.push(Action::CancelComparison);
        }
    });
    if let Some(at) = running {
        running_model_ui(at, ui);
    } else if !comparison.is_empty() {
        ui.weak(tr!("The models are compared in the pane Models."));
    }
}
