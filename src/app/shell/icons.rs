//! Icons of one size: letters of the bundled font of symbols, each with a name for the tooltip and for a screen reader.

use egui::{Button, Response, RichText, Role, Ui, WidgetInfo, vec2};

/// What an icon stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Icon {
    Undo,
    Redo,
    LeftPanel,
    RightPanel,
    Present,
    Fold,
    Unfold,
}

impl Icon {
    fn letter(self) -> &'static str {
        match self {
            Self::Undo => "↶",
            Self::Redo => "↷",
            Self::LeftPanel => "◧",
            Self::RightPanel => "◨",
            Self::Present => "▶",
            Self::Fold => "▼",
            Self::Unfold => "▲",
        }
    }
}

/// Width of a button, and size of its letter, in points.
pub const ICON: f32 = 24.0;
const LETTER: f32 = 14.0;

/// A button with an icon; one of a switch is filled while that is on.
pub fn icon_ui(icon: Icon, name: &str, is_on: Option<bool>, ui: &mut Ui) -> Response {
    let button = Button::selectable(is_on == Some(true), RichText::new(icon.letter()).size(LETTER));
    let response = ui.add(button.min_size(vec2(ICON, ui.spacing().interact_size.y)));
    let is_enabled = response.enabled();
    response.widget_info(|| match is_on {
        Some(is_on) => WidgetInfo::selected(Role::CheckBox, is_enabled, is_on, name),
        None => WidgetInfo::labeled(Role::Button, is_enabled, name),
    });
    response.on_hover_text(name).on_disabled_hover_text(name)
}
