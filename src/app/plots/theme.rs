//! Colours of plots and panels, on a light and on a dark background.

use crate::figure::{Rgb, SERIES};
use egui::Color32;

/// The colours of series on a dark background, in the order of [`SERIES`].
const SERIES_ON_DARK: [Rgb; SERIES.len()] = [
    Rgb(86, 180, 233),
    Rgb(240, 128, 40),
    Rgb(40, 190, 140),
    Rgb(214, 140, 184),
    Rgb(240, 228, 66),
    Rgb(190, 140, 255),
    Rgb(190, 190, 190),
    Rgb(240, 150, 130),
    Rgb(110, 220, 230),
    Rgb(150, 210, 110),
    Rgb(255, 110, 160),
    Rgb(150, 190, 210),
];

/// Ink of what is no series: totals, rays, marks.
pub const FOREGROUND: Rgb = Rgb(20, 20, 20);
/// Ink of what stands behind, and of masked points.
pub const MUTED: Rgb = Rgb(150, 150, 150);
/// Ink of a curve that wants attention.
pub const ALARM: Rgb = Rgb(190, 30, 30);

/// Ink on dark maps.
pub const WHITE: Rgb = Rgb(255, 255, 255);
/// Ink of marks that are told apart on a map of whichever colour and on the page.
pub const MARK: Rgb = Rgb(235, 50, 60);

/// Ink on maps that are white in their middle, also on a dark page.
pub const DARK: Rgb = Rgb(60, 60, 60);

/// Other inks than those of series, each with its colour on a dark background.
const ON_DARK: [(Rgb, Rgb); 3] = [(FOREGROUND, Rgb(240, 240, 240)), (MUTED, Rgb(110, 110, 110)), (ALARM, Rgb(255, 170, 80))];

/// An ink of a figure on the screen. Inks are made for a light page; what is meant for a map is the
/// same on both.
pub fn on_screen(ink: Rgb, dark: bool) -> Color32 {
    let other = SERIES.into_iter().zip(SERIES_ON_DARK).chain(ON_DARK).find(|(light, _)| *light == ink).map(|(_, other)| other);
    let Rgb(r, g, b) = other.filter(|_| dark).unwrap_or(ink);
    Color32::from_rgb(r, g, b)
}

/// The first colour on a light background, the second on a dark one.
fn pick(dark: bool, light: (u8, u8, u8), on_dark: (u8, u8, u8)) -> Color32 {
    let (r, g, b) = if dark { on_dark } else { light };
    Color32::from_rgb(r, g, b)
}

/// Colour of the series of that number.
pub fn series(index: usize, dark: bool) -> Color32 {
    on_screen(SERIES[index % SERIES.len()], dark)
}

/// The curve of the sliders, the total of the lobes.
pub fn foreground(dark: bool) -> Color32 {
    on_screen(FOREGROUND, dark)
}

/// The grid behind a plot.
pub fn grid(dark: bool) -> Color32 {
    pick(dark, (205, 205, 205), (72, 72, 72))
}

/// Behind words on a map.
pub fn plate(dark: bool) -> Color32 {
    if dark { Color32::from_black_alpha(170) } else { Color32::from_white_alpha(190) }
}

/// Masked points.
pub fn muted(dark: bool) -> Color32 {
    on_screen(MUTED, dark)
}

/// A correlation from −1 (orange) over 0 (background) to 1 (blue).
pub fn correlation(r: f64, dark: bool) -> Color32 {
    #[expect(clippy::cast_possible_truncation, reason = "a strength from 0 to 1")]
    let strength = r.abs().min(1.0) as f32;
    series(if r < 0.0 { 1 } else { 0 }, dark).gamma_multiply(0.55 * strength)
}

/// The one colour of what is chosen: marked rows, the filled part of sliders, what the tour frames.
pub fn accent(dark: bool) -> Color32 {
    pick(dark, (120, 190, 205), (16, 96, 116))
}

/// Lines between panels.
pub fn separator(dark: bool) -> Color32 {
    pick(dark, (218, 218, 218), (52, 52, 52))
}

/// Text that wants attention.
pub fn warning(dark: bool) -> Color32 {
    pick(dark, (160, 60, 0), (255, 170, 80))
}

#[cfg(test)]
mod tests {
    use super::{FOREGROUND, on_screen, series};
    use crate::figure::{Rgb, SERIES};
    use egui::Color32;

    #[test]
    fn inks_have_colours_of_their_own_on_a_dark_background() {
        assert_eq!((series(0, false), series(12, false)), (Color32::from_rgb(0, 92, 160), Color32::from_rgb(0, 92, 160)));
        for ink in SERIES.into_iter().chain([FOREGROUND]) {
            assert_ne!(on_screen(ink, true), on_screen(ink, false));
        }
        assert_eq!(on_screen(Rgb(1, 2, 3), true), Color32::from_rgb(1, 2, 3));
    }
}
