//! The line under the plots, and sentences above them.

use crate::app::command::Command;
use crate::app::theme;
use crate::app::window::Explorer;
use crate::app::words;
use tr::tr;

/// What is open, and ΔE of the sliders.
pub fn status_ui(explorer: &mut Explorer, ui: &mut egui::Ui) {
    let Explorer { derived, document, worker, commands, window, frame_times, .. } = explorer;
    ui.horizontal(|ui| {
        ui.strong(delta_e_text(derived.delta_e())).on_hover_text(format!(
            "{}\n{}",
            tr!("Of the sliders as they stand."),
            words::delta_e_help()
        ));
        ui.separator();
        if let Some(job) = &worker.load {
            let done = job.progress().unwrap_or(0.0);
            #[expect(clippy::cast_possible_truncation, reason = "a fraction for a progress bar")]
            ui.add(egui::ProgressBar::new(done as f32).desired_width(160.0).text(tr!("Reading…")));
            if ui.button(tr!("Cancel reading")).clicked() {
                commands.push(Command::CancelLoading);
            }
            ui.separator();
        }
        if window.show_frame_times {
            ui.label(frame_times.text());
            ui.separator();
        }
        let description = ui.add(egui::Label::new(document.description()).truncate());
        if !document.mask().is_empty() {
            description.on_hover_text(words::mask_help());
        }
        if let Some(left_out) = derived.marks.get().and_then(|marks| marks.left_out.as_ref()) {
            ui.separator();
            ui.label(left_out);
        }
    });
}

/// ΔE as a label.
pub fn delta_e_text(delta_e: Option<f64>) -> String {
    delta_e.map_or_else(|| tr!("ΔE not defined"), |value| format!("ΔE = {value:.4e}"))
}

/// What went wrong, until it is dismissed.
pub fn notice_ui(explorer: &mut Explorer, ui: &mut egui::Ui) {
    let Some(notice) = &explorer.notice else { return };
    let color = theme::warning(ui.visuals().dark_mode);
    egui::Frame::new().stroke(egui::Stroke::new(1.0, color)).inner_margin(6).corner_radius(4).show(ui, |ui| {
        ui.horizontal(|ui| {
            if ui.button(tr!("Dismiss")).clicked() {
                explorer.commands.push(Command::DismissNotice);
            }
            ui.add(egui::Label::new(notice.as_str()).wrap());
        });
    });
}

/// Why there is no curve.
pub fn fault_ui(explorer: &mut Explorer, ui: &mut egui::Ui) {
    if let Some(fault) = explorer.derived.fault() {
        ui.colored_label(theme::warning(ui.visuals().dark_mode), tr!("There is no curve: {}", fault));
    }
}
