//! The window as eframe runs it.

use crate::app::shell::app::App;
use crate::app::shell::app::autosave::save_on_exit;
use crate::app::shell::app::{logic, ui};
use crate::app::shell::theme::ground;
use std::io::Write as _;

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        logic::logic(self, ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if let Some(seconds) = frame.info().cpu_usage {
            self.frame_times.push(seconds, self.views.lag(&self.dock.on_screen()));
        }
        ui::ui(self, ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        ground(visuals.dark_mode).to_normalized_gamma_f32()
    }

    #[cfg(target_arch = "wasm32")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(&mut *self)
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        if self.window.show_frame_times {
            // Where drawing is too slow, or switched off, to read the status line.
            let _ = writeln!(std::io::stderr(), "{}", self.frame_times.text());
        }
        save_on_exit(self);
    }
}
