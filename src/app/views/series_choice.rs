//! Which angles of incidence are drawn.

use crate::app::plots::theme;
use crate::app::views::curves::series_ink;
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::OpenMeasurement;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Checkbox, PopupCloseBehavior, RichText, ScrollArea, Ui};
use tr::tr;

/// Height of the list in points.
const HEIGHT: f32 = 320.0;

/// A menu with a tick box for every angle of incidence of a measurement.
pub fn series_choice_ui(open: &OpenMeasurement, edits: &mut Vec<Edit>, ui: &mut Ui) {
    if open.series.len() < 2 {
        return;
    }
    let text = tr!("Angles of incidence ({0} of {1})", open.drawn().len(), open.series.len());
    ui.menu_button(text, |ui| choice_ui(open, edits, ui));
}

/// The same outside of a menu, under another text: it stays open while boxes are ticked.
pub fn choice_menu_ui(text: String, open: &OpenMeasurement, edits: &mut Vec<Edit>, ui: &mut Ui) {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    MenuButton::new(text).config(config).ui(ui, |ui| choice_ui(open, edits, ui));
}

/// The tick boxes.
fn choice_ui(open: &OpenMeasurement, edits: &mut Vec<Edit>, ui: &mut Ui) {
    let count = open.series.len();
    let choose = |drawn: Vec<usize>| Edit::SetDrawnSeries { number: open.number, drawn: drawn.into() };
    ui.horizontal(|ui| {
        if ui.button(tr!("All")).clicked() {
            edits.push(choose((0..count).collect()));
        }
        if ui.button(tr!("Every other one")).clicked() {
            edits.push(choose((0..count).step_by(2).collect()));
        }
        if ui.button(tr!("None of them")).clicked() {
            edits.push(choose(Vec::new()));
        }
    });
    ScrollArea::vertical().max_height(HEIGHT).show(ui, |ui| {
        for (index, series) in open.series.iter().enumerate() {
            let mut is_drawn = open.drawn().contains(&index);
            let ink = theme::on_screen(series_ink(index, count), ui.visuals().dark_mode);
            let text = RichText::new(series.name()).color(ink);
            if ui.add(Checkbox::new(&mut is_drawn, text)).changed() {
                let others = open.drawn().iter().copied().filter(|other| *other != index);
                let mut drawn: Vec<usize> = others.chain(is_drawn.then_some(index)).collect();
                drawn.sort_unstable();
                edits.push(choose(drawn));
            }
        }
    });
}
