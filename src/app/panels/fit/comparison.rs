//! The button that fits the ladder of models; its results are in a pane of their own.

use crate::app::views::action::Action;
use crate::app::views::running_model_ui;
use crate::app::work::fit_setup::is_joint;
use crate::app::work::workspace::Workspace;
use egui::Ui;
use tr::tr;

/// Orders the comparison, and says where its results are.
pub fn comparison_ui(work: &Workspace, running: Option<Option<&'static str>>, commands: &mut Vec<Action>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let compare = ui.add_enabled(running.is_none(), egui::Button::new(tr!("Compare models")));
        let help = if is_joint(work.measurements()) {
            tr!("Fit the whole ladder of models to all measurements together; results in the pane Models")
        } else {
            tr!("Fit the whole ladder of models to this measurement; results in the pane Models")
        };
        if compare.on_hover_text(help).clicked() {
            commands.push(Action::CompareModels);
        }
        if running.is_some() && ui.button(tr!("Cancel comparison")).clicked() {
            commands.push(Action::CancelComparison);
        }
    });
    if let Some(at) = running {
        running_model_ui(at, ui);
    } else if !work.model_comparison().is_empty() {
        ui.weak(tr!("The models are compared in the pane Models."));
    }
}
