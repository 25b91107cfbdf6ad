//! The menu bar: the table of commands, sorted into menus.

use crate::app::platform;
use crate::app::shell::app::App;
use crate::app::shell::commands;
use crate::app::shell::commands::{Availability, Command, Menu};
use crate::app::shell::dialogs::Dialogs;
use crate::app::shell::icons::{ICON, Icon, icon_ui};
use crate::app::shell::path_entry::path_in;
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::note_stop;
use crate::app::work::settings::SidePanel;
use egui::containers::menu::MenuConfig;
use egui::{Id, Key, Modifiers, Popup, PopupCloseBehavior, SetOpenCommand, Ui, UiKind, UiStackInfo};
use tr::tr;

/// The letter that opens a menu together with Alt, in every language.
const LETTERS: [(Menu, Key); 7] = [
    (Menu::File, Key::F),
    (Menu::Edit, Key::E),
    (Menu::Measurement, Key::M),
    (Menu::Fit, Key::I),
    (Menu::View, Key::V),
    (Menu::Lesson, Key::L),
    (Menu::Help, Key::H),
];

pub fn menu_ui(app: &mut App, ui: &mut Ui) {
    egui::MenuBar::new().ui(ui, |ui| {
        menus_ui(app, ui);
        tools_ui(app, ui);
    });
}

/// What the icons at the end of the bar order: whether it is on, if it is a switch, and whether it is possible.
fn tools_ui(app: &mut App, ui: &mut Ui) {
    let panels = &app.window.panels;
    let panel = |panel| Action::Window(WindowAction::TogglePanel(panel));
    let tools = [
        (Icon::Undo, tr!("Undo the last step"), Action::Undo, None, app.work.can_undo()),
        (Icon::Redo, tr!("Redo the last step"), Action::Redo, None, app.work.can_redo()),
        (Icon::LeftPanel, tr!("Panel of parameters beside the plots"), panel(SidePanel::Parameters), Some(panels.parameters), true),
        (Icon::RightPanel, tr!("Panel of fits beside the plots"), panel(SidePanel::Fit), Some(panels.fit), true),
        (
            Icon::Present,
            tr!("Presentation (F11): the panes on screen, large, with a few sliders"),
            Action::Window(WindowAction::Present),
            None,
            true,
        ),
    ];
    #[expect(clippy::cast_precision_loss, reason = "a number of icons")]
    let needed = tools.len() as f32 * (ICON + ui.spacing().item_spacing.x);
    let room = ui.available_width() - needed;
    if room < 0.0 {
        return;
    }
    ui.add_space(room);
    for (icon, name, action, is_on, is_possible) in tools {
        let button = ui.add_enabled_ui(is_possible, |ui| icon_ui(icon, &name, is_on, ui)).inner;
        if button.clicked() {
            app.actions.push(action);
        }
    }
}

fn menus_ui(app: &mut App, ui: &mut Ui) {
    for (menu, letter) in LETTERS {
        let f10 = menu == Menu::File && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F10));
        let by_key = f10 || ui.input_mut(|input| input.consume_key(Modifiers::ALT, letter));
        let button = bar_menu_ui(menu.name(), by_key, ui, |ui| match menu {
            Menu::File => file_ui(app, ui),
            Menu::View => view_ui(app, ui),
            _ => {
                let items = commands::items(app);
                items_ui(&items, menu, &mut app.actions, ui);
            }
        });
        if menu == Menu::File {
            note_stop(ui.ctx(), button);
        }
    }
}

/// Of a menu to the lower edge of the window, in points.
const MARGIN: f32 = 24.0;

/// Height of an entry for fingers, in points.
const FINGER: f32 = 32.0;

/// The menu of the bar that is open.
#[derive(Clone, Copy, PartialEq)]
struct Open {
    menu: Id,
    /// Whether it opened under the pointer alone, because a neighbour was open.
    by_hover: bool,
}

/// A menu of the bar with the id of its title, as egui's own, except that a click on the title of one that opened under the
/// pointer does not close it again: the click was meant to open it.
fn bar_menu_ui(title: String, by_key: bool, ui: &mut Ui, content: impl FnOnce(&mut Ui)) -> Id {
    let button = ui.button(title);
    if by_key {
        // The arrows go on from here into the menu.
        button.request_focus();
    }
    let popup = Popup::menu(&button);
    let (menu, bar) = (popup.get_id(), Id::unique("menu bar"));
    let before: Option<Open> = ui.data(|data| data.get_temp(bar)).filter(|open: &Open| Popup::is_id_open(ui.ctx(), open.menu));
    let stays = button.clicked() && before == Some(Open { menu, by_hover: true });
    let opens = !button.clicked() && button.hovered() && before.is_some_and(|open| open.menu != menu);
    let set = match button.clicked() {
        _ if by_key => Some(SetOpenCommand::Toggle),
        true if !stays => Some(SetOpenCommand::Toggle),
        _ => (stays || opens).then_some(SetOpenCommand::Bool(true)),
    };
    if set.is_some() {
        ui.data_mut(|data| data.insert_temp(bar, Open { menu, by_hover: opens }));
    }
    // A click into the path field must not close the menu that it is in.
    let behavior = if stays { PopupCloseBehavior::IgnoreClicks } else { PopupCloseBehavior::CloseOnClickOutside };
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let info = UiStackInfo::new(UiKind::Menu).with_tag_value(MenuConfig::MENU_CONFIG_TAG, config);
    popup.open_memory(set).close_behavior(behavior).info(info).show(|ui| {
        // Many lessons in a low window: the last ones are reached by the wheel.
        let room = ui.ctx().content_rect().bottom() - button.rect.bottom() - MARGIN;
        if platform::has_fingers() {
            ui.spacing_mut().interact_size.y = FINGER;
        }
        // A menu of egui is 400 points high by itself.
        egui::ScrollArea::vertical().max_height(room).min_scrolled_height(room).show(ui, content)
    });
    button.id
}

fn file_ui(app: &mut App, ui: &mut Ui) {
    let (quit, items): (Vec<Command>, Vec<Command>) =
        commands::items(app).into_iter().partition(|item| item.action == Action::Window(WindowAction::Quit));
    let has_recent = !app.window.recent.is_empty() || !app.persistence.kept.is_empty();
    let App { actions, dialogs: Dialogs { path_entry, .. }, .. } = app;
    items_ui(&items, Menu::File, actions, ui);
    ui.separator();
    ui.menu_button(tr!("Examples"), |ui| items_ui(&items, Menu::Example, actions, ui));
    ui.add_enabled_ui(has_recent, |ui| {
        ui.menu_button(tr!("Recent"), |ui| items_ui(&items, Menu::Recent, actions, ui));
    });
    ui.menu_button(tr!("Export"), |ui| {
        let mut chosen = Vec::new();
        items_ui(&items, Menu::Export, &mut chosen, ui);
        actions.extend(chosen.into_iter().map(|command| match command {
            Action::ChooseExport(what) => path_entry.export_command(what).unwrap_or(command),
            other => other,
        }));
        ui.separator();
        let label = if platform::IS_PAGE {
            ui.label(tr!("Or type a name first, such as figure.png, and then choose above:"))
        } else {
            ui.label(tr!("Or type a path first, and then choose above:"))
        };
        ui.add(egui::TextEdit::singleline(&mut path_entry.export).desired_width(260.0)).labelled_by(label.id);
    });
    if platform::IS_PAGE {
        return;
    }
    ui.separator();
    let label = ui.label(tr!("Type a path to open and press Enter:"));
    let field = ui.add(egui::TextEdit::singleline(&mut path_entry.open).desired_width(260.0)).labelled_by(label.id);
    if is_entered(&field, ui)
        && let Some(path) = path_in(&path_entry.open)
    {
        actions.push(Action::OpenMeasurements(vec![path]));
        ui.close();
    }
    let label = ui.label(tr!("Save to a path (.csv the measurement, .json the session), Enter:"));
    let field = ui.add(egui::TextEdit::singleline(&mut path_entry.save).desired_width(260.0)).labelled_by(label.id);
    if is_entered(&field, ui)
        && let Some(command) = path_entry.save_command()
    {
        actions.push(command);
        ui.close();
    }
    ui.separator();
    items_ui(&quit, Menu::File, actions, ui);
}

fn is_entered(field: &egui::Response, ui: &Ui) -> bool {
    field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter))
}

fn view_ui(app: &mut App, ui: &mut Ui) {
    let items = commands::items(app);
    ui.menu_button(Menu::Pane.name(), |ui| items_ui(&items, Menu::Pane, &mut app.actions, ui));
    ui.menu_button(Menu::Program.name(), |ui| items_ui(&items, Menu::Program, &mut app.actions, ui));
    ui.separator();
    items_ui(&items, Menu::View, &mut app.actions, ui);
    ui.separator();
    ui.menu_button(tr!("Theme"), |ui| items_ui(&items, Menu::Theme, &mut app.actions, ui));
    ui.menu_button(tr!("Language"), |ui| items_ui(&items, Menu::Language, &mut app.actions, ui));
}

/// The commands of a menu, with their keys; those that are on have a tick.
fn items_ui(items: &[Command], menu: Menu, actions: &mut Vec<Action>, ui: &mut Ui) {
    for item in items.iter().filter(|item| item.menu == menu) {
        let keys = item.shortcut.map(|shortcut| ui.ctx().format_shortcut(&shortcut)).unwrap_or_default();
        let clicked = match item.status {
            Availability::Off | Availability::On => {
                let button = egui::Button::selectable(item.status == Availability::On, item.text.as_ref()).shortcut_text(keys);
                let response = ui.add(button);
                response.widget_info(|| {
                    egui::WidgetInfo::selected(egui::Role::CheckBox, true, item.status == Availability::On, item.text.as_ref())
                });
                response
            }
            status => ui.add_enabled(status == Availability::Possible, egui::Button::new(item.text.as_ref()).shortcut_text(keys)),
        };
        let why_disabled = item.why_disabled();
        if clicked.on_hover_text(item.tooltip.as_ref()).on_disabled_hover_text(why_disabled).clicked() {
            actions.push(item.action.clone());
            ui.close();
        }
    }
}
