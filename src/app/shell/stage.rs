//! Panes without the tiles: one that fills the window, those of a presentation, and one at a time
//! where a window is too low for two.

use crate::app::panels::{before_ui, button_width};
use crate::app::text::i18n::translated;
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::{Cx, Views, note_stop, spec};
use crate::app::work::pane_id::PaneId;
use egui::scroll_area::ScrollBarVisibility;
use egui::{Rect, Response, RichText, Role, Ui, UiBuilder, WidgetInfo, pos2, vec2};
use tr::tr;

/// What is on screen in the place of the tiles.
#[derive(Debug, Clone, PartialEq)]
pub enum Stage {
    /// One pane alone, without the panels beside it.
    Filled(PaneId),
    /// Those of a presentation, at least one.
    Presented(Vec<PaneId>),
}

/// Panes of a presentation at most.
pub const MOST_PRESENTED: usize = 4;

/// Least height in points for plots one above the other.
pub const LEAST_FOR_TWO: f32 = 500.0;

/// Between panes.
const GAP: f32 = 8.0;

/// By how much the title of a vertical axis begins to the left of its plot: a quarter of the line's height.
const TITLE: i8 = 4;
/// By how much the last number of a horizontal axis ends to the right of its plot.
const NUMBER: i8 = 10;

impl Stage {
    pub fn panes(&self) -> &[PaneId] {
        match self {
            Self::Filled(pane) => std::slice::from_ref(pane),
            Self::Presented(panes) => panes,
        }
    }
}

/// The panes of a presentation, side by side or two by two.
pub fn presented_ui(panes: &[PaneId], views: &mut Views, cx: &mut Cx<'_>, ui: &mut Ui) {
    let room = ui.available_rect_before_wrap().shrink(4.0);
    for (pane, rect) in panes.iter().zip(cells(panes.len(), room)) {
        ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt(("presented", pane.key())), |ui| {
            ui.set_clip_rect(rect.intersect(ui.clip_rect()));
            ui.horizontal(|ui| {
                ui.strong(translated(spec(*pane).title));
                show_menu_ui(*pane, views, cx, ui);
                if panes.len() > 1 && close_ui(*pane, ui).clicked() {
                    cx.actions.push(Action::Window(WindowAction::ClosePane(*pane)));
                }
            });
            let margin = egui::Margin { left: TITLE, right: NUMBER, ..egui::Margin::ZERO };
            egui::Frame::new().inner_margin(margin).show(ui, |ui| views.of(*pane).ui(cx, ui));
        });
    }
    ui.allocate_rect(room, egui::Sense::hover());
}

/// Where so many panes lie in that room.
fn cells(count: usize, room: Rect) -> Vec<Rect> {
    // Plots are wider than they are high.
    let columns = match count {
        0 | 1 => 1,
        2 if room.width() < 1.1 * room.height() => 1,
        _ => 2,
    };
    let rows = count.max(1).div_ceil(columns);
    #[expect(clippy::cast_precision_loss, reason = "a number from 1 to 4")]
    let share = |length: f32, parts: usize| (length - GAP * (parts - 1) as f32) / parts as f32;
    let size = vec2(share(room.width(), columns), share(room.height(), rows));
    #[expect(clippy::cast_precision_loss, reason = "a number from 0 to 3")]
    let at = |i: usize| {
        let (row, column) = (i / columns, i % columns);
        let min = room.min + vec2((size.x + GAP) * column as f32, (size.y + GAP) * row as f32);
        // The last of three has the whole of its row.
        let is_alone = i + 1 == count && column == 0;
        Rect::from_min_max(min, pos2(if is_alone { room.right() } else { min.x + size.x }, min.y + size.y))
    };
    (0..count).map(at).collect()
}

/// One pane alone, under a line with the names of all that are open.
pub fn single_ui(pane: PaneId, is_filled: bool, open: Vec<PaneId>, views: &mut Views, cx: &mut Cx<'_>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let gap = ui.spacing().item_spacing.x;
        let buttons = [has_menu(pane, views, cx).then(|| tr!("Show")), is_filled.then(|| tr!("Back"))];
        let room: f32 = buttons.iter().flatten().map(|text| button_width(text, ui) + gap).sum();
        before_ui(room - gap, ui, |ui| {
            // The wheel moves it: a bar would lie over the names.
            let names = egui::ScrollArea::horizontal().id_salt("names of panes").auto_shrink([false, true]);
            names.scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden).show(ui, |ui| {
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    for other in open {
                        name_ui(other, other == pane, cx, ui);
                    }
                });
            });
        });
        show_menu_ui(pane, views, cx, ui);
        let help = tr!("All panes and panels again; also with a double click on the name, or Escape");
        if is_filled && ui.button(tr!("Back")).on_hover_text(help).clicked() {
            cx.actions.push(Action::Window(WindowAction::FillWindow(pane)));
        }
    });
    egui::Frame::new().inner_margin(egui::Margin { left: TITLE, right: NUMBER, top: 2, bottom: 0 }).show(ui, |ui| {
        views.of(pane).ui(cx, ui);
    });
}

/// The name of a pane that is open: a click shows it, a double click lets it fill the window.
fn name_ui(pane: PaneId, is_shown: bool, cx: &mut Cx<'_>, ui: &mut Ui) {
    let spec = spec(pane);
    let title = translated(spec.title);
    let name = ui.add(egui::Button::selectable(is_shown, &title)).on_hover_text(translated(spec.tooltip));
    name.widget_info(|| WidgetInfo::selected(Role::Tab, true, is_shown, &title));
    if is_shown {
        name.scroll_to_me(None);
        note_stop(&name.ctx, name.id);
    }
    if name.double_clicked() {
        cx.actions.push(Action::Window(WindowAction::FillWindow(pane)));
    } else if name.clicked() {
        cx.actions.push(Action::Window(WindowAction::ShowPane(pane)));
    }
}

/// Whether a pane has switches that it does not show itself.
fn has_menu(pane: PaneId, views: &mut Views, cx: &Cx<'_>) -> bool {
    spec(pane).has_options && !views.of(pane).has_options_beside(cx)
}

/// The button of the switches of a pane, if it has any.
pub fn show_menu_ui(pane: PaneId, views: &mut Views, cx: &mut Cx<'_>, ui: &mut Ui) {
    if !has_menu(pane, views, cx) {
        return;
    }
    // A switch is seldom set alone.
    let config = egui::containers::menu::MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    let button = egui::containers::menu::MenuButton::new(tr!("Show")).config(config);
    let (button, _) = button.ui(ui, |ui| views.of(pane).options_ui(cx, ui));
    let name = tr!("Show in {}", translated(spec(pane).title));
    button
        .on_hover_text(tr!("Switches for what is drawn in this pane"))
        .on_hover_text(tr!("In the plot: drag to move, drag with the right button or Ctrl+wheel to zoom, a double click shows all"))
        .widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
}

fn close_ui(pane: PaneId, ui: &mut Ui) -> Response {
    let button = ui.add(egui::Button::new(RichText::new("×")).frame(false));
    let name = tr!("Close {}", translated(spec(pane).title));
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    button.on_hover_text(name)
}

#[cfg(test)]
mod tests {
    use super::cells;
    use egui::{Rect, pos2};

    #[test]
    fn panes_of_a_presentation_share_the_room_and_none_lies_over_another() {
        let room = Rect::from_min_max(pos2(10.0, 20.0), pos2(910.0, 500.0));
        for count in 1..=4 {
            let cells = cells(count, room);
            assert_eq!(cells.len(), count);
            assert!(cells.iter().all(|cell| room.expand(0.1).contains_rect(*cell)));
            for (i, one) in cells.iter().enumerate() {
                assert!(cells[i + 1..].iter().all(|other| !one.intersects(*other)), "{count}");
                assert!(one.width() > 400.0 && one.height() > 200.0, "{one:?}");
            }
        }
    }
}
