//! Fonts and sizes of the window.

use crate::app::platform;
use crate::app::plots;
use crate::app::work::settings::Theme;
use crate::figure::CJK;
#[cfg(any(test, target_arch = "wasm32"))]
use crate::figure::FONT;

/// Light, dark, or as the desktop has it.
pub fn set(ctx: &egui::Context, theme: Theme) {
    ctx.set_theme(match theme {
        Theme::System => egui::ThemePreference::System,
        Theme::Light => egui::ThemePreference::Light,
        Theme::Dark => egui::ThemePreference::Dark,
    });
}

/// Sizes of letters in points, the only ones of panels and dialogs; plots have their own.
const SIZES: [(egui::TextStyle, f32); 5] = [
    (egui::TextStyle::Small, 11.0),
    (egui::TextStyle::Body, 13.0),
    (egui::TextStyle::Button, 13.0),
    (egui::TextStyle::Monospace, 12.0),
    (egui::TextStyle::Heading, 17.0),
];

/// What lies under panels and panes.
pub fn ground(dark: bool) -> egui::Color32 {
    egui::Color32::from_gray(if dark { 27 } else { 248 })
}

/// Sets fonts, text sizes and colours of both themes.
pub fn install(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    // A step of the wheel is a sixth, not a third.
    ctx.options_mut(|options| options.input_options.scroll_zoom_speed = 1.0 / 400.0);
    for theme in [egui::Theme::Light, egui::Theme::Dark] {
        ctx.style_mut_of(theme, |style| {
            style.spacing.slider_width = 100.0;
            for (text, size) in SIZES {
                if let Some(font) = style.text_styles.get_mut(&text) {
                    font.size = size;
                }
            }
            let dark = theme == egui::Theme::Dark;
            style.visuals.selection.bg_fill = plots::theme::accent(dark);
            style.visuals.slider_trailing_fill = true;
            style.visuals.hyperlink_color = plots::theme::series(0, dark);
            // In a page, whose canvas is cleared to the ground of the window, panels need not paint it again: where no graphics card draws,
            // that is a quarter of the time of a frame.
            style.visuals.panel_fill = if platform::IS_PAGE { egui::Color32::TRANSPARENT } else { ground(dark) };
            style.visuals.widgets.noninteractive.bg_stroke.color = plots::theme::separator(dark);
            style.spacing.item_spacing = egui::vec2(6.0, 4.0);
            // The default text of both themes is fainter than small print should be.
            style.visuals.override_text_color =
                Some(if theme == egui::Theme::Dark { egui::Color32::from_gray(220) } else { egui::Color32::from_gray(30) });
        });
    }
}

/// Height of buttons and sliders for fingers, and how far beside them one may touch, in points (WCAG 2.2, 2.5.8: 24 at least).
const FINGER: f32 = 24.0;
const BESIDE: f32 = 12.0;

/// Larger aims, for fingers.
pub fn widen(ctx: &egui::Context) {
    ctx.all_styles_mut(|style| {
        style.spacing.interact_size.y = FINGER;
        style.interaction.interact_radius = BESIDE;
    });
}

/// A font and its name.
type NamedFont = (&'static str, &'static [u8]);

/// Arrows, marks, mathematical signs and Chinese.
const BEHIND: [NamedFont; 2] = [("symbols", include_bytes!("../../../assets/fonts/symbols.ttf")), ("cjk", CJK)];

/// The default fonts, and behind them what they lack. A page has fewer letters, and behind them those of figures.
fn fonts() -> egui::FontDefinitions {
    #[cfg(target_arch = "wasm32")]
    let mut fonts = page_fonts();
    #[cfg(not(target_arch = "wasm32"))]
    let mut fonts = egui::FontDefinitions::default();
    push_behind(&mut fonts, &BEHIND);
    fonts
}

fn push_behind(fonts: &mut egui::FontDefinitions, behind: &[NamedFont]) {
    for (name, data) in behind {
        fonts.font_data.insert((*name).to_owned(), std::sync::Arc::new(egui::FontData::from_static(data)));
        for family in [egui::FontFamily::Proportional, egui::FontFamily::Monospace] {
            fonts.families.entry(family).or_default().push((*name).to_owned());
        }
    }
}

/// What a page has in place of the default fonts: the letters of its own texts, a fifth of the bytes.
#[cfg(any(test, target_arch = "wasm32"))]
fn page_fonts() -> egui::FontDefinitions {
    const TEXT: NamedFont = ("page-text", include_bytes!("../../../assets/fonts/page-text.ttf"));
    const MONO: NamedFont = ("page-mono", include_bytes!("../../../assets/fonts/page-mono.ttf"));
    let mut fonts = egui::FontDefinitions::empty();
    fonts.font_data.insert(MONO.0.to_owned(), std::sync::Arc::new(egui::FontData::from_static(MONO.1)));
    fonts.families.insert(egui::FontFamily::Monospace, vec![MONO.0.to_owned()]);
    push_behind(&mut fonts, &[TEXT, ("figure", FONT)]);
    fonts
}

/// Sets the fonts of a page.
#[cfg(test)]
pub fn install_page_fonts(ctx: &egui::Context) {
    let mut fonts = page_fonts();
    push_behind(&mut fonts, &BEHIND);
    ctx.set_fonts(fonts);
}
