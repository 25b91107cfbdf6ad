//! The menu bar: the table of commands, sorted into menus.

use crate::app::command::{self, Command, Item, Menu, Status};
use crate::app::leaving::Outgoing;
use crate::app::window::Explorer;
use egui::Ui;
use std::path::PathBuf;
use tr::tr;

pub fn menu_ui(explorer: &mut Explorer, ui: &mut Ui) {
    // A click into the path field must not close the menu that it is in.
    let config = egui::containers::menu::MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    egui::MenuBar::new().config(config).ui(ui, |ui| {
        ui.menu_button(tr!("File"), |ui| file_ui(explorer, ui));
        for (name, menu) in [(tr!("Edit"), Menu::Edit), (tr!("Fitting"), Menu::Fit)] {
            ui.menu_button(name, |ui| {
                let items = command::items(explorer);
                items_ui(&items, menu, &mut explorer.commands, ui);
            });
        }
        ui.menu_button(tr!("View"), |ui| view_ui(explorer, ui));
        ui.menu_button(tr!("Lessons"), |ui| {
            let items = command::items(explorer);
            items_ui(&items, Menu::Lesson, &mut explorer.commands, ui);
        });
        ui.menu_button(tr!("Help"), |ui| {
            let items = command::items(explorer);
            items_ui(&items, Menu::Help, &mut explorer.commands, ui);
        });
    });
}

fn file_ui(explorer: &mut Explorer, ui: &mut Ui) {
    let items = command::items(explorer);
    let Explorer { commands, typed_path, typed_export, typed_save_path, window, .. } = explorer;
    ui.menu_button(tr!("Examples"), |ui| items_ui(&items, Menu::Example, commands, ui));
    ui.add_enabled_ui(!window.recent.is_empty(), |ui| {
        ui.menu_button(tr!("Recent"), |ui| items_ui(&items, Menu::Recent, commands, ui));
    });
    ui.menu_button(tr!("Export"), |ui| {
        items_ui(&items, Menu::Export, commands, ui);
        ui.separator();
        let label = ui.label(tr!("Or type a path first, and then choose above:"));
        ui.add(egui::TextEdit::singleline(typed_export).desired_width(260.0)).labelled_by(label.id);
    });
    let label = ui.label(tr!("Type a path to open and press Enter:"));
    let field = ui.add(egui::TextEdit::singleline(typed_path).desired_width(260.0)).labelled_by(label.id);
    if field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) && !typed_path.trim().is_empty() {
        commands.push(Command::OpenMeasurement(PathBuf::from(typed_path.trim())));
        ui.close();
    }
    let label = ui.label(tr!("Save to a path (.csv the measurement, .json the session), Enter:"));
    let field = ui.add(egui::TextEdit::singleline(typed_save_path).desired_width(260.0)).labelled_by(label.id);
    if field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) && !typed_save_path.trim().is_empty() {
        commands.push(save_command(PathBuf::from(typed_save_path.trim())));
        ui.close();
    }
    ui.separator();
    items_ui(&items, Menu::File, commands, ui);
}

fn view_ui(explorer: &mut Explorer, ui: &mut Ui) {
    let items = command::items(explorer);
    ui.weak(tr!("Panes"));
    items_ui(&items, Menu::Pane, &mut explorer.commands, ui);
    ui.separator();
    items_ui(&items, Menu::View, &mut explorer.commands, ui);
    ui.separator();
    ui.menu_button(tr!("Theme"), |ui| items_ui(&items, Menu::Theme, &mut explorer.commands, ui));
    ui.menu_button(tr!("Language"), |ui| items_ui(&items, Menu::Language, &mut explorer.commands, ui));
}

/// The commands of a menu, with their keys; those that are on have a tick.
fn items_ui(items: &[Item], menu: Menu, commands: &mut Vec<Command>, ui: &mut Ui) {
    for item in items.iter().filter(|item| item.menu == menu) {
        let keys = item.shortcut.map(|shortcut| ui.ctx().format_shortcut(&shortcut)).unwrap_or_default();
        let clicked = match item.status {
            Status::Off | Status::On => {
                let button = egui::Button::selectable(item.status == Status::On, item.text.as_ref()).shortcut_text(keys);
                let response = ui.add(button);
                response
                    .widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, item.status == Status::On, item.text.as_ref()));
                response
            }
            status => ui.add_enabled(status == Status::Possible, egui::Button::new(item.text.as_ref()).shortcut_text(keys)),
        };
        if clicked.on_hover_text(item.tooltip.as_ref()).clicked() {
            commands.push(item.command.clone());
            ui.close();
        }
    }
}

/// What a typed path is saved as: a session where it ends in .json, else the measurement.
fn save_command(path: PathBuf) -> Command {
    let is_session = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    if is_session { Command::Export(Outgoing::Session, path) } else { Command::SaveMeasurement(path) }
}

#[cfg(test)]
mod tests {
    use super::{Command, Outgoing, save_command};

    #[test]
    fn a_typed_path_says_by_its_ending_what_is_saved() {
        for name in ["a.pbrdf.json", "a.JSON"] {
            assert_eq!(save_command(name.into()), Command::Export(Outgoing::Session, name.into()));
        }
        for name in ["a.csv", "a", "a.json.csv"] {
            assert_eq!(save_command(name.into()), Command::SaveMeasurement(name.into()));
        }
    }
}
