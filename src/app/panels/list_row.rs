//! What the lists of measurements and of pinned surfaces have in common.

use crate::app::plots::theme;
use crate::figure::SERIES;
use egui::{Align, Button, Grid, Key, Layout, RichText, Role, TextEdit, TextStyle, Ui, WidgetInfo, vec2};
use tr::tr;

/// Height of a row.
pub const HEIGHT: f32 = 20.0;

/// One row of fixed height.
pub fn row(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    ui.allocate_ui_with_layout(vec2(ui.available_width(), HEIGHT), Layout::left_to_right(Align::Center), content);
}

/// What begins a row that ends with controls of that width: all are drawn, and reached by the Tab
/// key, from left to right.
pub fn before_ui(rest: f32, ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    let width = (ui.available_width() - rest - ui.spacing().item_spacing.x).max(0.0);
    ui.allocate_ui_with_layout(vec2(width, HEIGHT), Layout::left_to_right(Align::Center), |ui| {
        ui.set_width(width);
        content(ui);
    });
}

/// Width of a button with that text.
pub fn button_width(text: &str, ui: &Ui) -> f32 {
    let font = TextStyle::Button.resolve(ui.style());
    let text = ui.painter().layout_no_wrap(text.to_owned(), font, egui::Color32::PLACEHOLDER).size().x;
    text + 2.0 * ui.spacing().button_padding.x
}

/// An entry of a menu; whether it was chosen.
pub fn item_ui(ui: &mut Ui, text: String, is_possible: bool) -> bool {
    let is_chosen = ui.add_enabled(is_possible, Button::new(text)).clicked();
    if is_chosen {
        ui.close();
    }
    is_chosen
}

/// A submenu of the colours of series; the answer is the number of the chosen one.
pub fn colors_ui(current: usize, ui: &mut Ui) -> Option<usize> {
    let mut chosen = None;
    ui.menu_button(tr!("Colour"), |ui| {
        let dark = ui.visuals().dark_mode;
        Grid::new("colours").num_columns(4).show(ui, |ui| {
            for color in 0..SERIES.len() {
                let text = RichText::new("■").color(theme::series(color, dark)).size(18.0);
                let button = ui.add(Button::selectable(color == current, text));
                button.widget_info(|| WidgetInfo::selected(Role::Button, true, color == current, tr!("Colour {}", color + 1)));
                if button.clicked() {
                    chosen = Some(color);
                    ui.close();
                }
                if color % 4 == 3 {
                    ui.end_row();
                }
            }
        });
    });
    chosen
}

/// A name that is being typed.
#[derive(Debug)]
pub struct Renaming<K> {
    /// Whose name.
    pub key: K,
    name: String,
    /// Whether its field has been given the keys.
    is_focused: bool,
}

impl<K> Renaming<K> {
    pub fn new(key: K, name: String) -> Self {
        Self { key, name, is_focused: false }
    }

    /// The field; once it is left, the name that was typed, or none where that is to stay.
    pub fn ui(&mut self, before: &str, what: &str, ui: &mut Ui) -> Option<Option<String>> {
        let field = ui.add(TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY));
        field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, what));
        if !self.is_focused {
            self.is_focused = true;
            field.request_focus();
        }
        let name = self.name.trim();
        let is_new = !ui.input(|input| input.key_pressed(Key::Escape)) && !name.is_empty() && name != before;
        field.lost_focus().then(|| is_new.then(|| name.to_owned()))
    }
}
