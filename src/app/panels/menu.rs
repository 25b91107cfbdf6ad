//! The menu bar.

use crate::app::command::Command;
use crate::app::document::EXAMPLES;
use crate::app::language::Language;
use crate::app::state::Theme;
use crate::app::window::Explorer;
use std::path::PathBuf;
use tr::tr;

pub fn menu_ui(explorer: &mut Explorer, ui: &mut egui::Ui) {
    let Explorer { settings, commands, typed_path, history, .. } = explorer;
    let mut push = |ui: &mut egui::Ui, command| {
        commands.push(command);
        ui.close();
    };
    // A click into the path field must not close the menu that it is in.
    let config = egui::containers::menu::MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    egui::MenuBar::new().config(config).ui(ui, |ui| {
        ui.menu_button(tr!("File"), |ui| {
            if ui.add(egui::Button::new("Open measurement…").shortcut_text("Ctrl+O")).clicked() {
                push(ui, Command::ChooseMeasurement);
            }
            if ui.add(egui::Button::new("Save measurement as…").shortcut_text("Ctrl+S")).clicked() {
                push(ui, Command::ChooseSave);
            }
            ui.menu_button("Examples", |ui| {
                for (index, example) in EXAMPLES.iter().enumerate() {
                    if ui.button(example.name).clicked() {
                        push(ui, Command::OpenExample(index));
                    }
                }
            });
            ui.separator();
            let label = ui.label("Or type a path and press Enter:");
            let field = ui.add(egui::TextEdit::singleline(typed_path).desired_width(260.0)).labelled_by(label.id);
            if field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) && !typed_path.trim().is_empty() {
                push(ui, Command::OpenMeasurement(PathBuf::from(typed_path.trim())));
            }
            ui.separator();
            if ui.button("Quit").clicked() {
                push(ui, Command::Quit);
            }
        });
        ui.menu_button(tr!("Edit"), |ui| {
            for (name, possible, command) in [("Undo", history.can_undo(), Command::Undo), ("Redo", history.can_redo(), Command::Redo)] {
                let keys = if command == Command::Undo { "Ctrl+Z" } else { "Ctrl+Shift+Z" };
                if ui.add_enabled(possible, egui::Button::new(name).shortcut_text(keys)).clicked() {
                    push(ui, command);
                }
            }
        });
        ui.menu_button(tr!("View"), |ui| {
            ui.checkbox(&mut settings.log_brdf, "Logarithmic BRDF");
            ui.checkbox(&mut settings.show_limit, "Fresnel limit");
            ui.checkbox(&mut settings.show_backscatter, "Backscatter side");
            ui.checkbox(&mut settings.show_frame_times, "Frame times");
            ui.separator();
            ui.label("Theme");
            for theme in Theme::ALL {
                if ui.radio(settings.theme == theme, theme.name()).clicked() {
                    push(ui, Command::SetTheme(theme));
                }
            }
            ui.separator();
            ui.label(tr!("Language"));
            for language in Language::ALL {
                ui.radio_value(&mut settings.language, language, language.name());
            }
        });
    });
}
