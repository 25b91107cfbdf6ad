//! Fonts and sizes of the window.

use crate::app::work::settings::Theme;
use crate::figure::CJK;

/// Light, dark, or as the desktop has it.
pub fn set(ctx: &egui::Context, theme: Theme) {
    ctx.set_theme(match theme {
        Theme::System => egui::ThemePreference::System,
        Theme::Light => egui::ThemePreference::Light,
        Theme::Dark => egui::ThemePreference::Dark,
    });
}

/// Sets fonts, text sizes and colours of both themes.
pub fn install(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    for theme in [egui::Theme::Light, egui::Theme::Dark] {
        ctx.style_mut_of(theme, |style| {
            style.spacing.slider_width = 100.0;
            style.spacing.item_spacing = egui::vec2(6.0, 4.0);
            // The default text of both themes is fainter than small print should be.
            style.visuals.override_text_color =
                Some(if theme == egui::Theme::Dark { egui::Color32::from_gray(220) } else { egui::Color32::from_gray(30) });
        });
    }
}

/// The default fonts, and behind them what they lack: arrows, marks, mathematical signs and
/// Chinese.
fn fonts() -> egui::FontDefinitions {
    let mut fonts = egui::FontDefinitions::default();
    for (name, data) in [("symbols", &include_bytes!("../../../assets/fonts/symbols.ttf")[..]), ("cjk", CJK)] {
        fonts.font_data.insert(name.to_owned(), std::sync::Arc::new(egui::FontData::from_static(data)));
        for family in [egui::FontFamily::Proportional, egui::FontFamily::Monospace] {
            fonts.families.entry(family).or_default().push(name.to_owned());
        }
    }
    fonts
}
