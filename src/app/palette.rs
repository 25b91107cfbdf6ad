//! The command palette: every command by a few letters of its name.

use super::command::{self, Item, Status};
use super::language::{self, Language};
use super::window::Explorer;
use egui::{Key, Modifiers, Role, Ui};
use tr::tr;

/// What the palette keeps while it is open.
#[derive(Debug, Default)]
pub struct Palette {
    is_open: bool,
    filter: String,
    chosen: usize,
}

impl Palette {
    /// Opens it empty.
    pub fn open(&mut self) {
        *self = Self { is_open: true, ..Self::default() };
    }

    #[cfg(test)]
    pub fn is_open(&self) -> bool {
        self.is_open
    }
}

/// Commands that are listed at most.
const MOST_LISTED: usize = 14;

/// Draws the palette, if it is open, and orders what is chosen.
pub fn palette_ui(explorer: &mut Explorer, ui: &mut Ui) {
    if !explorer.palette.is_open {
        return;
    }
    let items = matching(command::items(explorer), english_names(explorer), &explorer.palette.filter);
    let Explorer { palette, commands, .. } = explorer;
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
        for (i, item) in items.iter().enumerate() {
            if row_ui(item, i == palette.chosen, ui) {
                clicked = Some(i);
            }
        }
        if items.is_empty() {
            ui.weak(tr!("No command has these letters in this order."));
        }
        clicked.or(enter.then_some(palette.chosen))
    });
    if let Some(item) = response.inner.and_then(|chosen| items.get(chosen)).filter(|item| item.status != Status::Impossible) {
        commands.push(item.command.clone());
        palette.is_open = false;
        ui.ctx().request_repaint();
    } else if response.should_close() {
        palette.is_open = false;
    }
}

fn row_ui(item: &Item, is_chosen: bool, ui: &mut Ui) -> bool {
    let keys = item.shortcut.map(|shortcut| ui.ctx().format_shortcut(&shortcut)).unwrap_or_default();
    let state = if item.status == Status::On { tr!("on") } else { String::new() };
    let button = egui::Button::selectable(is_chosen, item.text.as_ref()).right_text(format!("{state}  {keys}"));
    let button = button.min_size(egui::vec2(ui.available_width(), 0.0));
    ui.add_enabled(item.status != Status::Impossible, button).on_hover_text(item.tooltip.as_ref()).clicked()
}

/// The names of all commands in English, where the window speaks another language.
fn english_names(explorer: &Explorer) -> Option<Vec<String>> {
    let names = || command::items(explorer).into_iter().map(|item| item.text.into_owned()).collect();
    (language::current() != Language::English).then(|| language::in_english(names))
}

/// The commands that fit, the best first; what is impossible now comes last. Those found by their English names show these too.
fn matching(mut items: Vec<Item>, english: Option<Vec<String>>, filter: &str) -> Vec<Item> {
    let misfits: Vec<Option<u32>> = items.iter().map(|item| misfit(&item.text, filter)).collect();
    let misfits: Vec<Option<u32>> = match english {
        None => misfits,
        Some(names) => items.iter_mut().zip(misfits).zip(names).map(|((item, own), name)| with_english(item, own, &name, filter)).collect(),
    };
    let mut ranked: Vec<(u32, Item)> = misfits.into_iter().zip(items).filter_map(|(misfit, item)| Some((misfit?, item))).collect();
    ranked.sort_by_key(|(misfit, item)| (item.status == Status::Impossible, *misfit));
    ranked.truncate(MOST_LISTED);
    ranked.into_iter().map(|(_, item)| item).collect()
}

/// How far a command is from the letters of a filter by its own name or its English one, which is shown where it is the nearer.
fn with_english(item: &mut Item, own: Option<u32>, name: &str, filter: &str) -> Option<u32> {
    let english = misfit(name, filter).filter(|english| !filter.trim().is_empty() && own.is_none_or(|own| *english < own));
    if english.is_some() && item.text != name {
        item.text = format!("{} · {name}", item.text).into();
    }
    english.or(own)
}

/// How far a name is from the letters of a filter; none if it lacks some of them in their order. A letter costs nothing where a word
/// begins, little right after the letter before it, and else the more the further it is away.
fn misfit(name: &str, filter: &str) -> Option<u32> {
    let letters: Vec<char> = name.to_lowercase().chars().collect();
    let begins = |i: usize| i == 0 || !letters[i - 1].is_alphanumeric();
    let mut misfit = 0;
    let mut from = 0;
    for wanted in filter.to_lowercase().chars().filter(|c| !c.is_whitespace()) {
        let is_wanted = |i: &usize| letters[*i] == wanted;
        let next = (from..letters.len()).find(is_wanted)?;
        // The beginning of a later word is worth the jump, if the letters before it are not adjacent.
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
    use super::misfit;

    #[test]
    fn beginnings_of_words_fit_best_and_missing_letters_not_at_all() {
        let best = |filter: &str| {
            let names = ["Reset all parameters", "Reset layout", "Redo", "Logarithmic lobes", "Theme: Dark", "Model: Lambert"];
            names.into_iter().filter_map(|name| Some((misfit(name, filter)?, name))).min().map(|(_, name)| name)
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
}
