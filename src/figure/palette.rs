//! Colours of series and of maps, distinct for colour-blind readers.
//!
//! Series: Okabe and Ito's palette (jfly.uni-koeln.de/color), darkened for a white page. Maps:
//! matplotlib's `viridis` and `twilight` (CC0) and ColorBrewer's `RdBu` (Apache 2.0), interpolated
//! linearly between anchors.

/// Red, green and blue, 0 to 255.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// The colour that shows on white paper at that opacity, from 0 to 1.
    #[must_use]
    pub fn on_white(self, opacity: f64) -> Self {
        if opacity >= 1.0 {
            return self;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
        let mix = |byte: u8| (255.0 + opacity.max(0.0) * (f64::from(byte) - 255.0)).round() as u8;
        Self(mix(self.0), mix(self.1), mix(self.2))
    }
}

/// Colours of series on a light background, in their order.
pub const SERIES: [Rgb; 12] = [
    Rgb(0, 92, 160),
    Rgb(190, 70, 0),
    Rgb(0, 128, 92),
    Rgb(158, 70, 122),
    Rgb(138, 104, 0),
    Rgb(110, 60, 180),
    Rgb(80, 80, 80),
    Rgb(120, 40, 30),
    Rgb(20, 140, 160),
    Rgb(40, 100, 30),
    Rgb(200, 40, 100),
    Rgb(90, 120, 150),
];

/// Black and white, for ink on the colours of a map.
const INKS: [Rgb; 2] = [Rgb(0, 0, 0), Rgb(255, 255, 255)];

/// Colours of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ColorMap {
    /// From dark to light, for values from small to large: viridis.
    #[default]
    Sequential,
    /// From blue over white to red, for values on both sides of a centre: RdBu, reversed.
    Diverging,
    /// Cyclic, for angles: twilight.
    Cyclic,
    /// From black to white as light is: even steps of light, in the bytes of sRGB.
    Light,
}

const VIRIDIS: [Rgb; 17] = [
    Rgb(68, 1, 84),
    Rgb(72, 24, 106),
    Rgb(71, 45, 123),
    Rgb(66, 64, 134),
    Rgb(59, 82, 139),
    Rgb(51, 99, 141),
    Rgb(44, 114, 142),
    Rgb(38, 130, 142),
    Rgb(33, 145, 140),
    Rgb(31, 160, 136),
    Rgb(40, 174, 128),
    Rgb(63, 188, 115),
    Rgb(94, 201, 98),
    Rgb(132, 212, 75),
    Rgb(173, 220, 48),
    Rgb(216, 226, 25),
    Rgb(253, 231, 37),
];

const RED_BLUE: [Rgb; 11] = [
    Rgb(5, 48, 97),
    Rgb(32, 101, 171),
    Rgb(67, 147, 195),
    Rgb(144, 196, 221),
    Rgb(209, 229, 240),
    Rgb(247, 247, 247),
    Rgb(253, 219, 199),
    Rgb(243, 164, 129),
    Rgb(214, 96, 77),
    Rgb(177, 24, 43),
    Rgb(103, 0, 31),
];

const TWILIGHT: [Rgb; 17] = [
    Rgb(226, 217, 226),
    Rgb(196, 206, 212),
    Rgb(149, 181, 199),
    Rgb(114, 151, 193),
    Rgb(98, 118, 186),
    Rgb(94, 81, 173),
    Rgb(89, 42, 143),
    Rgb(69, 19, 92),
    Rgb(47, 20, 54),
    Rgb(74, 19, 66),
    Rgb(116, 30, 79),
    Rgb(152, 53, 80),
    Rgb(178, 86, 82),
    Rgb(194, 124, 99),
    Rgb(204, 163, 137),
    Rgb(216, 199, 190),
    Rgb(226, 217, 226),
];

impl ColorMap {
    /// Black or white, whichever is easier to read on the colour at a fraction from 0 to 1.
    #[must_use]
    pub fn ink_on(self, fraction: f64) -> Rgb {
        let Rgb(r, g, b) = self.at(fraction);
        // Rec. 709.
        let luma = 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        INKS[usize::from(luma <= 130.0)]
    }

    /// The colour at a fraction from 0 to 1; values outside are clamped.
    #[must_use]
    pub fn at(self, fraction: f64) -> Rgb {
        let anchors: &[Rgb] = match self {
            Self::Sequential => &VIRIDIS,
            Self::Diverging => &RED_BLUE,
            Self::Cyclic => &TWILIGHT,
            Self::Light => return grey(fraction),
        };
        let last = anchors.len() - 1;
        #[expect(clippy::cast_precision_loss, reason = "a number of anchors")]
        let place = if fraction.is_finite() { fraction.clamp(0.0, 1.0) * last as f64 } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the number of anchors")]
        let below = (place.floor() as usize).min(last - 1);
        #[expect(clippy::cast_precision_loss, reason = "a number of anchors")]
        let share = place - below as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
        let between = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
        let (Rgb(r, g, b), Rgb(r2, g2, b2)) = (anchors[below], anchors[below + 1]);
        Rgb(between(r, r2), between(g, g2), between(b, b2))
    }
}

/// Grey of that share of the light of white, by the transfer curve of sRGB (IEC 61966-2-1).
fn grey(light: f64) -> Rgb {
    let light = if light.is_finite() { light.clamp(0.0, 1.0) } else { 0.0 };
    let coded = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
    let byte = (255.0 * coded).round() as u8;
    Rgb(byte, byte, byte)
}

#[cfg(test)]
mod tests {
    use super::{ColorMap, RED_BLUE, Rgb, TWILIGHT, VIRIDIS};

    #[test]
    fn maps_begin_and_end_with_their_anchors() {
        assert_eq!(ColorMap::Sequential.at(0.0), VIRIDIS[0]);
        assert_eq!(ColorMap::Sequential.at(1.0), VIRIDIS[16]);
        assert_eq!(ColorMap::Diverging.at(0.5), RED_BLUE[5]);
        assert_eq!(ColorMap::Cyclic.at(0.0), ColorMap::Cyclic.at(1.0));
        assert_eq!(ColorMap::Cyclic.at(0.5), TWILIGHT[8]);
        assert_eq!(ColorMap::Sequential.at(7.0), VIRIDIS[16]);
        assert_eq!((ColorMap::Light.at(0.0), ColorMap::Light.at(1.0)), (Rgb(0, 0, 0), Rgb(255, 255, 255)));
        // A fifth of the light is half of the bytes, nearly.
        assert_eq!(ColorMap::Light.at(0.2159), Rgb(128, 128, 128));
        assert_eq!(ColorMap::Sequential.at(f64::NAN), VIRIDIS[0]);
    }

    /// Luminance, for a grey copy.
    fn luma(Rgb(r, g, b): Rgb) -> f64 {
        0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
    }

    #[test]
    fn a_sequential_map_only_gets_brighter() {
        let steps: Vec<f64> = (0..=100).map(|i| luma(ColorMap::Sequential.at(f64::from(i) / 100.0))).collect();
        assert!(steps.windows(2).all(|pair| pair[1] >= pair[0] - 1.0), "{steps:?}");
        assert!(steps[100] - steps[0] > 150.0);
    }
}
