//! The command palette: every command by words of its name and its menu.

use crate::app::shell::app::App;
use crate::app::shell::commands;
use crate::app::shell::commands::{Availability, Command};
use crate::app::shell::dialogs::Dialogs;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::views::action::{Action, WindowAction};
use egui::{Key, Modifiers, Role, Ui};
use tr::tr;

/// Height that the list has at most.
const LIST_HEIGHT: f32 = 400.0;

/// Draws the palette, if it is open, and orders what is chosen.
pub fn palette_ui(app: &mut App, ui: &mut Ui) {
    if !app.dialogs.palette.is_open {
        return;
    }
    let items = matching(found(app), english_names(app), &app.dialogs.palette.filter);
    let App { dialogs: Dialogs { palette, .. }, actions, .. } = app;
    let area = egui::Modal::default_area(egui::Id::unique("palette")).anchor(egui::Align2::CENTER_TOP, egui::vec2(0.0, 80.0));
    let response = egui::Modal::new(egui::Id::unique("palette")).area(area).show(ui.ctx(), |ui| {
        ui.set_width(520.0);
        // The arrows choose: a field with one line has no use for them.
        let down = ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, Key::ArrowDown));
        let up = ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, Key::ArrowUp));
        palette.chosen = (palette.chosen + down).saturating_sub(up).min(items.len().saturating_sub(1));
        let enter = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));

        let field =
            egui::TextEdit::singleline(&mut palette.filter).hint_text(tr!("Type a few letters of a command")).desired_width(f32::INFINITY);
        let field = ui.add(field);
        field.widget_info(|| egui::WidgetInfo::labeled(Role::TextInput, true, tr!("Find a command")));
        field.request_focus();
        if field.changed() {
            palette.chosen = 0;
        }
        let mut clicked = None;
        // The least height as well: a list that was short once is not kept short.
        let height = LIST_HEIGHT.min(ui.ctx().content_rect().height() - 160.0);
        egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height).auto_shrink([false, true]).show(ui, |ui| {
            for (i, found) in items.iter().enumerate() {
                let row = row_ui(found, i == palette.chosen, ui);
                if i == palette.chosen && (down > 0 || up > 0) {
                    row.scroll_to_me(None);
                }
                if row.clicked() {
                    clicked = Some(i);
                }
            }
        });
        if items.is_empty() {
            ui.weak(tr!("No command has these letters in this order."));
        }
        clicked.or(enter.then_some(palette.chosen))
    });
    if let Some(item) =
        response.inner.and_then(|chosen| items.get(chosen)).map(|found| &found.item).filter(|item| item.status != Availability::Impossible)
    {
        actions.push(item.action.clone());
        palette.is_open = false;
        ui.ctx().request_repaint();
    } else if response.should_close() {
        palette.is_open = false;
    }
}

fn row_ui(found: &Found, is_chosen: bool, ui: &mut Ui) -> egui::Response {
    let item = &found.item;
    let keys = item.shortcut.map(|shortcut| ui.ctx().format_shortcut(&shortcut)).unwrap_or_default();
    let state = if item.status == Availability::On { tr!("on") } else { String::new() };
    let button = egui::Button::selectable(is_chosen, found.shown()).right_text(format!("{state}  {keys}"));
    let button = button.min_size(egui::vec2(ui.available_width(), 0.0));
    let why_disabled = item.why_disabled();
    ui.add_enabled(item.status != Availability::Impossible, button)
        .on_hover_text(item.tooltip.as_ref())
        .on_disabled_hover_text(why_disabled)
}

/// A command with what it is found by.
struct Found {
    item: Command,
    name: Name,
    /// Its English text, where that found it in another language.
    english: Option<String>,
}

/// What a command is called: its menu, its text, and what else finds it.
struct Name {
    menu: String,
    text: String,
    alias: &'static str,
}

impl Found {
    fn shown(&self) -> String {
        let own = if self.name.menu.is_empty() { self.name.text.clone() } else { format!("{} › {}", self.name.menu, self.name.text) };
        self.english.as_ref().map_or_else(|| own.clone(), |english| format!("{own} · {english}"))
    }
}

/// Every command, as the menus have them.
fn found(app: &App) -> Vec<Found> {
    let mut items = commands::items(app);
    items.sort_by_key(|item| (item.menu, item.action == Action::Window(WindowAction::Quit)));
    let found = |item: Command| {
        let alias = if let Action::Window(WindowAction::SetLanguage(language)) = item.action { language.english_name() } else { "" };
        Found { name: Name { menu: item.menu.name(), text: item.text.to_string(), alias }, item, english: None }
    };
    items.into_iter().map(found).collect()
}

/// The names of all commands in English, where the window speaks another language.
fn english_names(app: &App) -> Option<Vec<Name>> {
    let names = || found(app).into_iter().map(|found| found.name).collect();
    (i18n::current() != Language::English).then(|| i18n::in_english(names))
}

/// The commands that fit, the best first; what is impossible now comes last. Scattered letters
/// count where no command has the words. Those found by their English names show these too.
fn matching(found: Vec<Found>, english: Option<Vec<Name>>, filter: &str) -> Vec<Found> {
    let english: Vec<Option<Name>> =
        english.map_or_else(|| found.iter().map(|_| None).collect(), |names| names.into_iter().map(Some).collect());
    let rank = |misfit: fn(&Name, &str) -> Option<u32>| -> Vec<Option<(u32, bool)>> {
        let by_name = |(found, english): (&Found, &Option<Name>)| {
            let own = misfit(&found.name, filter);
            let other = english.as_ref().and_then(|name| misfit(name, filter)).filter(|other| own.is_none_or(|own| *other < own));
            other.map(|other| (other, true)).or(own.map(|own| (own, false)))
        };
        found.iter().zip(&english).map(by_name).collect()
    };
    let mut ranks = rank(misfit_of_words);
    if ranks.iter().all(Option::is_none) {
        ranks = rank(|name, filter| misfit_of_letters(&name.text, filter));
    }
    let fits = ranks.into_iter().zip(found).zip(english).filter_map(|((rank, mut found), english)| {
        let (misfit, is_english) = rank?;
        found.english = english.map(|name| name.text).filter(|text| is_english && *text != found.name.text);
        Some((misfit, found))
    });
    let mut ranked: Vec<(u32, Found)> = fits.collect();
    ranked.sort_by_key(|(misfit, found)| (found.item.status == Availability::Impossible, *misfit));
    ranked.into_iter().map(|(_, found)| found).collect()
}

/// How far a name is from having the words of a filter; none if one is nowhere. The whole name fits best, then the beginnings of
/// its own words, then what stands inside of them, then what its menu is called.
fn misfit_of_words(name: &Name, filter: &str) -> Option<u32> {
    let [menu, text, alias] = [&name.menu, &name.text, name.alias].map(str::to_lowercase);
    let filter = filter.trim().to_lowercase();
    if text == filter {
        return Some(0);
    }
    let begins = |text: &str, word: &str| {
        let before = |at: usize| text[..at].chars().next_back();
        text.match_indices(word).any(|(at, _)| before(at).is_none_or(|c| !c.is_alphanumeric()))
    };
    let misfit = |word: &str| {
        let places = [text.starts_with(word), begins(&text, word) || begins(&alias, word), text.contains(word)];
        let menus = [begins(&menu, word), menu.contains(word) || alias.contains(word)];
        let at = places.into_iter().chain(menus).position(|fits| fits)?;
        u32::try_from(at).ok()
    };
    let of_words: Option<u32> = filter.split_whitespace().map(misfit).sum();
    of_words.map(|sum| 1 + sum)
}

/// How far a name is from the letters of a filter; none if it lacks some of them in their order. A
/// letter costs nothing where a word begins, little right after the letter before it, and else the
/// more the further it is away.
fn misfit_of_letters(name: &str, filter: &str) -> Option<u32> {
    let letters: Vec<char> = name.to_lowercase().chars().collect();
    let begins = |i: usize| i == 0 || !letters[i - 1].is_alphanumeric();
    let mut misfit = 0;
    let mut from = 0;
    for wanted in filter.to_lowercase().chars().filter(|c| !c.is_whitespace()) {
        let is_wanted = |i: &usize| letters[*i] == wanted;
        let next = (from..letters.len()).find(is_wanted)?;
        // The beginning of a later word is worth the jump, if the letters before it are not
        // adjacent.
        let word = (from..letters.len()).filter(is_wanted).find(|&i| begins(i));
        let at = if from > 0 && next == from { next } else { word.unwrap_or(next) };
        misfit += match at {
            at if begins(at) => 0,
            at if at == from => 1,
            at => 2 + u32::try_from(at - from).unwrap_or(1000),
        };
        from = at + 1;
    }
    // Of two that fit alike, the shorter name.
    Some(1000 * misfit + u32::try_from(letters.len()).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::{Name, misfit_of_letters, misfit_of_words};

    #[test]
    fn beginnings_of_words_fit_best_and_missing_letters_not_at_all() {
        let best = |filter: &str| {
            let names = ["Reset all parameters", "Reset layout", "Redo", "Logarithmic lobes", "Theme: Dark", "Model: Lambert"];
            names.into_iter().filter_map(|name| Some((misfit_of_letters(name, filter)?, name))).min().map(|(_, name)| name)
        };
        for (filter, expected) in [
            ("rl", Some("Reset layout")),
            ("rap", Some("Reset all parameters")),
            ("redo", Some("Redo")),
            ("log", Some("Logarithmic lobes")),
            ("DARK", Some("Theme: Dark")),
            ("lam", Some("Model: Lambert")),
            ("zz", None),
        ] {
            assert_eq!(best(filter), expected, "{filter}");
        }
    }

    #[test]
    fn words_fit_best_where_they_begin_and_menus_count_too() {
        let misfit = |menu: &str, text: &str, filter: &str| {
            misfit_of_words(&Name { menu: menu.to_owned(), text: text.to_owned(), alias: "Chinese" }, filter)
        };
        let inside = misfit("Edit", "Undo", "do").expect("inside of a word");
        assert!(misfit("Edit", "Do it", "do").expect("its beginning") < inside);
        assert!(inside < misfit("Dot", "Other", "do").expect("the menu"));
        assert_eq!(misfit("Edit", "Undo", "uo"), None, "scattered letters");
        assert!(misfit("Language", "简体中文", "chin").is_some() && misfit("Export", "Curves as CSV…", "csv exp").is_some());
        assert_eq!(misfit("Edit", "Undo", " "), misfit("Edit", "Redo", ""), "without words all fit alike");
        assert!(misfit("Panes", "Picture", "picture ") < misfit("Export", "Picture as image…", "picture "), "the whole name");
    }
}
