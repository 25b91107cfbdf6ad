//! From keys to commands.

use crate::app::shell::app::App;
use crate::app::shell::commands::{Availability, Command, items};
use crate::app::views::action::{Action, WindowAction};
use egui::{Key, Modifiers};

/// The command whose keys are pressed, if it is possible now.
pub fn pressed(app: &App, ctx: &egui::Context) -> Option<Action> {
    let any_key = ctx.input(|input| input.events.iter().any(|event| matches!(event, egui::Event::Key { pressed: true, .. })));
    if !any_key {
        return None;
    }
    if app.work.can_redo() && ctx.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Y)) {
        // As other programs have it.
        return Some(Action::Redo);
    }
    let mut items = items(app);
    // Escape leaves what lies above first, and is nobody's while there is nothing to dismiss.
    let is_covered = ctx.memory(|memory| memory.top_modal_layer().is_some()) || egui::Popup::is_any_open(ctx);
    items.retain(|item| {
        item.action != Action::Window(WindowAction::DismissToasts) || (item.status == Availability::Possible && !is_covered)
    });
    // The longer shortcut first: egui takes the shorter one for a part of it.
    items.sort_by_key(|item| item.shortcut.is_none_or(|shortcut| !shortcut.modifiers.shift));
    let hit = |item: &Command| item.shortcut.is_some_and(|shortcut| ctx.input_mut(|input| input.consume_shortcut(&shortcut)));
    let Some(item) = items.iter().find(|item| hit(item)) else {
        let leaves = !is_covered && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        return leaves.then(|| leaving(app)).flatten();
    };
    (item.status != Availability::Impossible).then(|| item.action.clone())
}

/// What Escape does where nothing else wants it.
fn leaving(app: &App) -> Option<Action> {
    if app.dock.is_presented() {
        return Some(Action::Window(WindowAction::Present));
    }
    if app.dialogs.tour.is_some() {
        return Some(Action::Window(WindowAction::EndTour));
    }
    app.dock.on_screen().first().filter(|_| app.dock.is_filled()).map(|pane| Action::Window(WindowAction::FillWindow(*pane)))
}
