//! What the lines of a plot mean, in a line above it, where it covers no curve, and a broken line
//! is told from a whole one.

use crate::figure::Symbol;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Align2, Button, Color32, CursorIcon, FontId, PopupCloseBehavior, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};
use egui_plot::LineStyle;
use std::collections::BTreeSet;
use tr::tr;

/// A name with the look of its line.
pub struct KeyEntry {
    pub name: String,
    pub color: Color32,
    pub style: LineStyle,
    /// In points of the screen.
    pub width: f32,
    /// Drawn in the place of a line.
    pub symbol: Option<Symbol>,
    /// Whether the colour is made for a map, which stands behind the sample then.
    pub on_map: bool,
}

/// Size of the letters, length of a sample, and what is free around it.
const LETTERS: f32 = 12.0;
const SAMPLE: f32 = 24.0;
const GAP: f32 = 5.0;
const BETWEEN: f32 = 10.0;
/// Length of a gap over that of a dash, as the plots have it.
const GAP_OVER_DASH: f32 = 0.618;

/// A dark colour of a map.
const MAP: Color32 = Color32::from_rgb(49, 104, 142);

impl KeyEntry {
    /// Room for the sample and the name.
    fn allocate_ui(&self, sense: Sense, ui: &mut Ui) -> egui::Response {
        let galley = ui.painter().layout_no_wrap(self.name.clone(), FontId::proportional(LETTERS), Color32::PLACEHOLDER);
        ui.allocate_exact_size(vec2(SAMPLE + GAP, 0.0) + galley.size(), sense).1
    }

    /// What sample and name take.
    fn width(&self, ui: &Ui) -> f32 {
        SAMPLE + GAP + ui.painter().layout_no_wrap(self.name.clone(), FontId::proportional(LETTERS), Color32::PLACEHOLDER).size().x
    }

    fn paint(&self, rect: Rect, strength: f32, ui: &Ui) {
        let ends = [rect.left_center(), rect.left_center() + vec2(SAMPLE, 0.0)];
        let color = self.color.gamma_multiply(strength);
        let stroke = Stroke::new(self.width, color);
        let middle = rect.left_center() + vec2(0.5 * SAMPLE, 0.0);
        let shapes = match (self.symbol, self.style) {
            (Some(symbol), _) => symbol_shapes(symbol, middle, color),
            (None, LineStyle::Solid) => vec![Shape::line_segment(ends, stroke)],
            (None, LineStyle::Dashed { length }) => Shape::dashed_line(&ends, stroke, length, GAP_OVER_DASH * length),
            (None, LineStyle::Dotted { spacing }) => Shape::dotted_line(&ends, color, spacing, self.width),
        };
        if self.on_map {
            let plate = Rect::from_center_size(middle, vec2(SAMPLE + 4.0, rect.height()));
            ui.painter().rect_filled(plate, 3.0, MAP);
        }
        ui.painter().extend(shapes);
        let ink = ui.visuals().text_color().gamma_multiply(strength);
        ui.painter().text(rect.right_center(), Align2::RIGHT_CENTER, &self.name, FontId::proportional(LETTERS), ink);
    }
}

/// A measured point as plots have it.
pub fn symbol_shapes(symbol: Symbol, at: Pos2, color: Color32) -> Vec<Shape> {
    match symbol {
        Symbol::Disc => vec![Shape::circle_filled(at, 3.0, color)],
        Symbol::Circle => vec![Shape::circle_stroke(at, 3.0, (1.0, color))],
        Symbol::Square => vec![Shape::rect_filled(Rect::from_center_size(at, vec2(5.0, 5.0)), 0.0, color)],
        Symbol::Cross => [vec2(3.0, 3.0), vec2(3.0, -3.0)].map(|arm| Shape::line_segment([at - arm, at + arm], (1.5, color))).into(),
    }
}

/// Below this height of plot and names in points, the plot has the room: names have one line, and
/// those that do not fit on it stand behind a button.
const LOW: f32 = 330.0;
/// Room of that button.
const MORE: f32 = 44.0;

/// Names one after the other, on as many lines as there is room for.
fn lines_ui(widths: &[f32], ui: &mut Ui, mut entry_ui: impl FnMut(usize, &mut Ui)) {
    let mut all_ui = |from: usize, to: usize, ui: &mut Ui| {
        ui.spacing_mut().item_spacing = vec2(BETWEEN, 0.0);
        (from..to).for_each(|i| entry_ui(i, ui));
    };
    if ui.available_height() >= LOW {
        ui.horizontal_wrapped(|ui| all_ui(0, widths.len(), ui));
        return;
    }
    let fitting = fitting(widths, ui.available_width());
    ui.horizontal(|ui| {
        all_ui(0, fitting, ui);
        let hidden = widths.len() - fitting;
        if hidden > 0 {
            let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
            let button = MenuButton::from_button(Button::new(format!("+{hidden}")).small()).config(config);
            let (button, _) = button.ui(ui, |ui| all_ui(fitting, widths.len(), ui));
            button.on_hover_text(tr!("{} more names of what is drawn", hidden));
        }
    });
}

/// How many names of those widths fit on one line.
fn fitting(widths: &[f32], room: f32) -> usize {
    let mut right = 0.0;
    let ends: Vec<f32> = widths
        .iter()
        .map(|width| {
            right += width + BETWEEN;
            right - BETWEEN
        })
        .collect();
    if right - BETWEEN <= room { widths.len() } else { ends.iter().filter(|end| **end + BETWEEN + MORE <= room).count() }
}

/// Names with samples of their lines; none is torn at the end of a line.
pub fn key_line_ui(entries: &[KeyEntry], ui: &mut Ui) {
    let widths: Vec<f32> = entries.iter().map(|entry| entry.width(ui)).collect();
    lines_ui(&widths, ui, |i, ui| {
        let entry = &entries[i];
        let response = entry.allocate_ui(Sense::hover(), ui);
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &entry.name));
        entry.paint(response.rect, 1.0, ui);
    });
}

/// How faint the entry of a line is that is not drawn.
const HIDDEN: f32 = 0.35;

/// The same, where a click on a name takes its lines out of the plot or puts them back. Each line
/// is known by a key.
pub fn switching_key_line_ui<K: Ord + Copy>(entries: &[(K, KeyEntry)], hidden: &mut BTreeSet<K>, ui: &mut Ui) {
    let widths: Vec<f32> = entries.iter().map(|(_, entry)| entry.width(ui)).collect();
    lines_ui(&widths, ui, |i, ui| {
        let (key, entry) = &entries[i];
        let response = entry.allocate_ui(Sense::click(), ui).on_hover_cursor(CursorIcon::PointingHand);
        if response.clicked() && !hidden.remove(key) {
            hidden.insert(*key);
        }
        let is_shown = !hidden.contains(key);
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, is_shown, &entry.name));
        entry.paint(response.rect, if is_shown { 1.0 } else { HIDDEN }, ui);
        response.on_hover_text(if is_shown { tr!("A click hides it") } else { tr!("A click shows it") });
    });
}

#[cfg(test)]
mod tests {
    use super::{Color32, KeyEntry, LineStyle, key_line_ui};
    use egui_kittest::{Harness, kittest::Queryable as _};

    #[test]
    fn names_that_do_not_fit_on_a_line_are_behind_a_button_and_none_is_cut() {
        let entry = |i: usize| KeyEntry {
            name: format!("line {i}"),
            color: Color32::RED,
            style: LineStyle::Solid,
            width: 1.0,
            symbol: None,
            on_map: false,
        };
        let entries: Vec<KeyEntry> = (0..10).map(entry).collect();
        for (width, shown) in [(300.0, 3..6), (1500.0, 10..11)] {
            let ui = |ui: &mut egui::Ui| key_line_ui(&entries, ui);
            let mut harness = Harness::builder().with_size(egui::vec2(width, 150.0)).build_ui(ui);
            harness.run();
            let whole = harness.query_all_by_label_contains("line").filter(|node| node.rect().right() <= width).count();
            assert!(shown.contains(&whole), "{whole} of width {width}");
            assert_eq!(harness.query_all_by_label_contains("line").count(), whole, "no name reaches over the edge");
            if whole < entries.len() {
                harness.get_by_label(&format!("+{}", entries.len() - whole)).click();
                harness.run();
                assert_eq!(harness.query_all_by_label_contains("line").count(), entries.len());
            }
        }
    }
}
