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
    longer_first(&mut items);
    // Escape leaves what lies above first, and is nobody's while there is nothing to dismiss.
    let is_covered = is_covered(ctx);
    items.retain(|item| {
        item.action != Action::Window(WindowAction::DismissToasts) || (item.status == Availability::Possible && !is_covered)
    });
    let Some(item) = items.iter().find(|item| is_hit(item, ctx)) else {
        let leaves = !is_covered && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        return leaves.then(|| leaving(app)).flatten();
    };
    (item.status != Availability::Impossible).then(|| item.action.clone())
}

/// The same while a value is typed into a field: the keys that a field has a use for are its own.
pub fn pressed_while_typing(app: &App, ctx: &egui::Context) -> Option<Action> {
    let is_any = ctx.input(|input| {
        let is_free =
            |event: &egui::Event| matches!(event, egui::Event::Key { key, pressed: true, modifiers, .. } if is_free(*key, *modifiers));
        input.events.iter().any(is_free)
    });
    if !is_any || is_covered(ctx) {
        return None;
    }
    let mut items = items(app);
    longer_first(&mut items);
    items.retain(|item| item.shortcut.is_some_and(|shortcut| is_free(shortcut.logical_key, shortcut.modifiers)));
    items.iter().find(|item| is_hit(item, ctx)).filter(|item| item.status != Availability::Impossible).map(|item| item.action.clone())
}

/// What a field does with a letter together with Ctrl: all, copy, paste, cut, undo, redo, and the deletions of a shell.
const EDITING: [Key; 10] = [Key::A, Key::C, Key::V, Key::X, Key::Z, Key::Y, Key::U, Key::K, Key::W, Key::H];

/// Whether a field has no use for those keys.
fn is_free(key: Key, modifiers: Modifiers) -> bool {
    let is_letter_or_digit = key.name().chars().count() == 1;
    let is_function = key.name().strip_prefix('F').is_some_and(|number| number.parse::<u8>().is_ok());
    is_function || modifiers.command && is_letter_or_digit && !EDITING.contains(&key)
}

/// The longer shortcut first: egui takes the shorter one for a part of it.
fn longer_first(items: &mut [Command]) {
    items.sort_by_key(|item| item.shortcut.is_none_or(|shortcut| !shortcut.modifiers.shift));
}

fn is_hit(item: &Command, ctx: &egui::Context) -> bool {
    item.shortcut.is_some_and(|shortcut| ctx.input_mut(|input| input.consume_shortcut(&shortcut)))
}

/// Whether a dialog or a menu lies over the window.
fn is_covered(ctx: &egui::Context) -> bool {
    ctx.memory(|memory| memory.top_modal_layer().is_some()) || egui::Popup::is_any_open(ctx)
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
