//! Colours and sizes, in one place.

use crate::figure::CJK;
use egui::Color32;

/// Okabe and Ito's colours, told apart by colour-blind eyes, darkened or lightened for the background.
const SERIES_ON_LIGHT: [(u8, u8, u8); 12] = [
    (0, 92, 160),
    (190, 70, 0),
    (0, 128, 92),
    (158, 70, 122),
    (138, 104, 0),
    (110, 60, 180),
    (80, 80, 80),
    (120, 40, 30),
    (20, 140, 160),
    (40, 100, 30),
    (200, 40, 100),
    (90, 120, 150),
];
const SERIES_ON_DARK: [(u8, u8, u8); 12] = [
    (86, 180, 233),
    (240, 128, 40),
    (40, 190, 140),
    (214, 140, 184),
    (240, 228, 66),
    (190, 140, 255),
    (190, 190, 190),
    (240, 150, 130),
    (110, 220, 230),
    (150, 210, 110),
    (255, 110, 160),
    (150, 190, 210),
];

fn pick(dark: bool, light: (u8, u8, u8), on_dark: (u8, u8, u8)) -> Color32 {
    let (r, g, b) = if dark { on_dark } else { light };
    Color32::from_rgb(r, g, b)
}

/// Colour of the series of that number.
pub fn series(index: usize, dark: bool) -> Color32 {
    let i = index % SERIES_ON_LIGHT.len();
    pick(dark, SERIES_ON_LIGHT[i], SERIES_ON_DARK[i])
}

/// The curve of the sliders, the total of the lobes.
pub fn foreground(dark: bool) -> Color32 {
    pick(dark, (20, 20, 20), (240, 240, 240))
}

pub fn specular(dark: bool) -> Color32 {
    series(3, dark)
}

pub fn diffuse(dark: bool) -> Color32 {
    series(4, dark)
}

pub fn volume(dark: bool) -> Color32 {
    series(5, dark)
}

/// The grid behind a plot.
pub fn grid(dark: bool) -> Color32 {
    pick(dark, (205, 205, 205), (72, 72, 72))
}

/// Masked points.
pub fn muted(dark: bool) -> Color32 {
    pick(dark, (150, 150, 150), (110, 110, 110))
}

/// A correlation from −1 (orange) over 0 (background) to 1 (blue).
pub fn correlation(r: f64, dark: bool) -> Color32 {
    #[expect(clippy::cast_possible_truncation, reason = "a strength from 0 to 1")]
    let strength = r.abs().min(1.0) as f32;
    series(if r < 0.0 { 1 } else { 0 }, dark).gamma_multiply(0.55 * strength)
}

/// What wants attention.
pub fn warning(dark: bool) -> Color32 {
    pick(dark, (160, 60, 0), (255, 170, 80))
}

/// Sets fonts, text sizes and colours of both themes.
pub fn install(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    for theme in [egui::Theme::Light, egui::Theme::Dark] {
        ctx.style_mut_of(theme, |style| {
            style.spacing.slider_width = 100.0;
            style.spacing.item_spacing = egui::vec2(6.0, 4.0);
            // The default text of both themes is fainter than small print should be.
            style.visuals.override_text_color = Some(pick(theme == egui::Theme::Dark, (30, 30, 30), (220, 220, 220)));
        });
    }
}

/// The default fonts, and behind them what they lack: arrows, marks, mathematical signs and Chinese.
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
