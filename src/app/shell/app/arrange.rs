//! Arranges the panes for the room that there is.

use crate::app::shell::app::App;
use crate::app::shell::docking::Dock;
use crate::app::work::layout::Layout;
use egui::Vec2;

/// Width and height, in points, below which a page is small. Windows of a desktop have a least size, and can be made larger.
const SMALL: Vec2 = Vec2::new(1000.0, 600.0);

/// Arranges the panes for a window of that size. What the work holds of their places stays.
pub fn adapt(app: &mut App, size: Vec2) {
    let room = &mut app.dialogs.room;
    room.is_small = room.may_be_small && (size.x < SMALL.x || size.y < SMALL.y);
    if let Some(embedded) = &room.embedded {
        let panes = app.dock.layout().map(|layout| layout.panes()).unwrap_or_default();
        if !embedded.panes.is_empty() && panes != embedded.panes {
            app.dock = Dock::passing(&embedded.layout(size));
        }
    } else if room.is_small != app.dock.is_passing() && !app.dock.is_presented() {
        app.dock = if room.is_small { one_by_one(&app.dock) } else { Dock::new(app.work.layout()) };
    }
}

/// The same panes with one on screen at a time.
fn one_by_one(dock: &Dock) -> Dock {
    let panes = dock.layout().map(|layout| layout.panes()).unwrap_or_default();
    let shown = dock.on_screen().into_iter().next();
    let active = panes.iter().position(|pane| Some(*pane) == shown).unwrap_or(0);
    Dock::passing(&Layout::Tabs { active, parts: panes.into_iter().map(Layout::Pane).collect() })
}
