//! The pinned surfaces: drawn or not, named, taken as sliders, removed.

use crate::app::panels::list_row::{HEIGHT, Renaming, before_ui, button_width, colors_ui, item_ui, row};
use crate::app::panels::tooltip_right::TooltipRight as _;
use crate::app::plots::theme;
use crate::app::views::Cx;
use crate::app::work::edit::Edit;
use crate::app::work::parameter_text;
use crate::app::work::surface::PinnedSurface;
use egui::{CollapsingHeader, Label, Role, ScrollArea, Sense, Shape, Ui, WidgetInfo, vec2};
use tr::tr;

/// What the panel keeps.
#[derive(Debug, Default)]
pub struct PinnedPanel {
    /// By the place of the surface.
    renaming: Option<Renaming<usize>>,
}

/// Room of the sample of its curves.
const SAMPLE: f32 = 26.0;
/// Rows that are seen at once.
const MOST_ROWS: f32 = 4.5;

impl PinnedPanel {
    /// The list, where any surface is pinned.
    pub fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let pins = cx.work.pinned();
        if pins.is_empty() {
            return;
        }
        let header = CollapsingHeader::new(tr!("Pinned surfaces ({})", pins.len())).id_salt("pinned surfaces").default_open(true);
        header.show_unindented(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(4.0, 2.0);
            let scroll = ScrollArea::vertical().id_salt("pinned surfaces").max_height(MOST_ROWS * (HEIGHT + 2.0));
            scroll.auto_shrink([false, true]).show(ui, |ui| {
                pins.iter().enumerate().for_each(|(place, pin)| self.row_ui(place, pin, cx, ui));
            });
        });
    }

    fn row_ui(&mut self, place: usize, pin: &PinnedSurface, cx: &mut Cx<'_>, ui: &mut Ui) {
        row(ui, |ui| {
            let mut shown = pin.shown;
            let checkbox = ui.add(egui::Checkbox::without_text(&mut shown));
            checkbox.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, shown, tr!("Show {}", pin.name)));
            if checkbox.changed() {
                cx.edits.push(Edit::SetPin(place, Box::new(PinnedSurface { shown, ..pin.clone() })));
            }
            checkbox.on_hover_right(ui, tr!("Whether its curves are drawn"));
            let (sample, _) = ui.allocate_exact_size(vec2(SAMPLE, HEIGHT), Sense::hover());
            let ink = theme::series(pin.color, ui.visuals().dark_mode);
            let ends = [sample.left_center() + vec2(1.0, 0.0), sample.right_center() - vec2(1.0, 0.0)];
            ui.painter().extend(Shape::dashed_line(&ends, (1.6, ink), 5.0, 3.0));
            before_ui(button_width("…", ui), ui, |ui| self.name_ui(place, pin, cx, ui));
            let menu = ui.menu_button("…", |ui| self.menu_ui(place, pin, cx, ui)).response;
            menu.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Actions for {}", pin.name)));
        });
    }

    /// The name, or the field that it is typed into.
    fn name_ui(&mut self, place: usize, pin: &PinnedSurface, cx: &mut Cx<'_>, ui: &mut Ui) {
        if let Some(renaming) = self.renaming.as_mut().filter(|renaming| renaming.key == place) {
            if let Some(name) = renaming.ui(&pin.name, &tr!("Name of the surface"), ui) {
                cx.edits.extend(name.map(|name| Edit::SetPin(place, Box::new(PinnedSurface { name, ..pin.clone() }))));
                self.renaming = None;
            }
            return;
        }
        let label = ui.add(Label::new(&pin.name).truncate().sense(Sense::click()));
        if label.double_clicked() {
            self.renaming = Some(Renaming::new(place, pin.name.clone()));
        }
        label.context_menu(|ui| self.menu_ui(place, pin, cx, ui));
        label.on_hover_right(ui, format!("{}\n{}", pin.name, parameter_text::text(&pin.parameters)));
    }

    /// What can be done with a pinned surface.
    fn menu_ui(&mut self, place: usize, pin: &PinnedSurface, cx: &mut Cx<'_>, ui: &mut Ui) {
        if item_ui(ui, tr!("Take as sliders"), true) {
            cx.edits.push(Edit::UsePin(place));
        }
        if item_ui(ui, tr!("Rename"), true) {
            self.renaming = Some(Renaming::new(place, pin.name.clone()));
        }
        let color = colors_ui(pin.color, ui);
        cx.edits.extend(color.map(|color| Edit::SetPin(place, Box::new(PinnedSurface { color, ..pin.clone() }))));
        if item_ui(ui, tr!("Remove"), true) {
            cx.edits.push(Edit::Unpin(place));
        }
    }
}
