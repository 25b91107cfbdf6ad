//! Text as outlines, independent of the fonts of the viewer.
//!
//! The fonts are subsets of DejaVu Sans and, for Chinese, Droid Sans Fallback (`assets/fonts`), which the
//! window uses too. Characters that both lack are `<text>` elements in an SVG and empty boxes in a PNG.

use std::fmt::Write as _;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Letters of Europe, Greek and mathematical signs.
pub static FONT: &[u8] = include_bytes!("../../assets/fonts/figure.ttf");
/// Chinese characters.
pub static CJK: &[u8] = include_bytes!("../../assets/fonts/cjk.ttf");

/// The fonts, searched in their order.
pub struct Font {
    /// Empty only if the bundled files are damaged; then figures have no text.
    faces: Vec<Face<'static>>,
}

/// Width of a character without a font, as a fraction of the size.
const GUESSED_WIDTH: f64 = 0.6;

impl Font {
    pub fn new() -> Self {
        Self { faces: [FONT, CJK].into_iter().filter_map(|font| Face::parse(font, 0).ok()).collect() }
    }

    /// The glyph of the first font that has it; else the empty box of the first font.
    fn glyph(&self, letter: char) -> Option<(&Face<'static>, GlyphId)> {
        let found = self.faces.iter().find_map(|face| Some((face, face.glyph_index(letter)?)));
        found.or_else(|| self.faces.first().map(|face| (face, GlyphId(0))))
    }

    /// Whether the fonts have every character of a text.
    pub fn covers(&self, text: &str) -> bool {
        text.chars().all(|letter| self.faces.iter().any(|face| face.glyph_index(letter).is_some()))
    }

    fn advance(&self, letter: char) -> f64 {
        let share = |(face, glyph): (&Face<'_>, GlyphId)| Some(f64::from(face.glyph_hor_advance(glyph)?) / f64::from(face.units_per_em()));
        self.glyph(letter).and_then(share).unwrap_or(GUESSED_WIDTH)
    }

    /// Width of a text of that size.
    pub fn width(&self, text: &str, size: f64) -> f64 {
        size * text.chars().map(|letter| self.advance(letter)).sum::<f64>()
    }

    /// The text as the data of an SVG path, its baseline beginning at that point.
    pub fn outline(&self, text: &str, size: f64, x: f64, y: f64) -> String {
        let mut pen = Pen { data: String::new(), x, y, scale: 1.0 };
        for letter in text.chars() {
            if let Some((face, glyph)) = self.glyph(letter) {
                pen.scale = size / f64::from(face.units_per_em());
                // Blanks have no outline.
                let _ = face.outline_glyph(glyph, &mut pen);
            }
            pen.x += size * self.advance(letter);
        }
        pen.data
    }
}

/// Writes outlines at the position of the pen.
struct Pen {
    data: String,
    x: f64,
    y: f64,
    scale: f64,
}

/// A coordinate with at most two decimals.
pub fn short(number: f64) -> String {
    let text = format!("{number:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

impl Pen {
    fn put(&mut self, letter: char, points: &[(f32, f32)]) {
        self.data.push(letter);
        for (i, &(x, y)) in points.iter().enumerate() {
            let separator = if i == 0 { "" } else { " " };
            let (x, y) = (self.x + self.scale * f64::from(x), self.y - self.scale * f64::from(y));
            // Writing to a string does not fail.
            let _ = write!(self.data, "{separator}{} {}", short(x), short(y));
        }
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.put('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.put('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.put('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.put('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.data.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::{Font, short};
    use pbrdf::model::Parameter;

    #[test]
    fn the_font_has_what_labels_are_made_of() {
        let font = Font::new();
        for text in ["DoLP / %", "θr / °", "BRDF / sr⁻¹", "10⁻¹⁷ ⁰¹²³⁴⁵⁶⁷⁸⁹", "−0.5·10³", "ΔE ≤ √2 ∞ α β Δφ σ → × ± … – “é” Ж µm"]
        {
            assert!(font.covers(text), "{text}");
        }
        for parameter in Parameter::ALL {
            assert!(font.covers(parameter.symbol()) && font.covers(parameter.name()), "{parameter:?}");
        }
        assert!(font.covers("钢的 DoLP：θr = 30°") && !font.covers("강"));
    }

    #[test]
    fn widths_add_up() {
        let font = Font::new();
        let sum = font.width("D", 9.0) + font.width("o", 9.0);
        assert!((font.width("Do", 9.0) - sum).abs() < 1e-12);
        assert!(font.width("W", 9.0) > 2.0 * font.width("i", 9.0));
    }

    #[test]
    fn coordinates_are_short() {
        assert_eq!(["1.5", "0", "0", "-3", "10"], [1.5, 0.0, -0.001, -3.0, 10.0].map(short).each_ref().map(String::as_str));
    }
}
