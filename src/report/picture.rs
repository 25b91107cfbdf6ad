//! What is shown of a picture: a number in every pixel, with its axis and its colours.

use crate::figure::{Axis, ColorMap, Figure, HeatMap, Panel, Series};
use pbrdf::model::StokesImage;
use pbrdf::optics::Degrees;
use serde::{Deserialize, Serialize};

/// A quantity of a Stokes vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PictureQuantity {
    /// Radiance.
    #[default]
    S0,
    /// Degree of linear polarisation.
    Dolp,
    /// Angle of polarisation.
    Aop,
    /// Radiance through an analyser.
    Analyser,
    /// Radiance along x less that along y.
    S1,
    /// Radiance along the diagonal less that across it.
    S2,
}

/// What is white or at the end of the colours is brighter than this share of the pixels: a highlight does not darken the rest.
const WHITE: f64 = 0.995;
/// DoLP ends at a multiple of this.
const DOLP_STEP: f64 = 0.05;

impl PictureQuantity {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::S0, Self::Dolp, Self::Aop, Self::Analyser, Self::S1, Self::S2];

    /// The quantity of that name in files.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        let keys = ["s0", "dolp", "aop", "analyser", "s1", "s2"];
        Self::ALL.into_iter().zip(keys).find(|(_, own)| *own == key).map(|(quantity, _)| quantity)
    }

    /// Its value in each pixel, row by row from the top; `analyser` is the angle of the analyser in degrees.
    #[must_use]
    pub fn values(self, image: &StokesImage, analyser: f64) -> Vec<f64> {
        match self {
            Self::S0 => image.s0.clone(),
            Self::Dolp => image.dolp(),
            Self::Aop => image.angle(),
            Self::Analyser => image.through_analyser(Degrees(analyser)),
            Self::S1 => image.s1.clone(),
            Self::S2 => image.s2.clone(),
        }
    }

    /// Its colours.
    #[must_use]
    pub fn colors(self) -> ColorMap {
        match self {
            Self::S0 | Self::Analyser => ColorMap::Light,
            Self::Dolp => ColorMap::Sequential,
            Self::Aop => ColorMap::Cyclic,
            Self::S1 | Self::S2 => ColorMap::Diverging,
        }
    }

    /// Its axis without ends, in English.
    #[must_use]
    pub fn axis(self) -> Axis {
        match self {
            Self::S0 => Axis::linear("Radiance S0", "sr⁻¹"),
            Self::Dolp => Axis::linear("DoLP", ""),
            Self::Aop => {
                let ticks = [0.0, 45.0, 90.0, 135.0, 180.0].map(|angle: f64| (angle, angle.to_string()));
                Axis { ticks: Some(ticks.into()), ..Axis::linear("Angle of polarisation", "°") }
            }
            Self::Analyser => Axis::linear("Radiance through the analyser", "sr⁻¹"),
            Self::S1 => Axis::linear("S1", "sr⁻¹"),
            Self::S2 => Axis::linear("S2", "sr⁻¹"),
        }
    }

    /// Ends of its colours that suit an image: those of radiances do not depend on the analyser, so that they can be compared.
    #[must_use]
    pub fn range(self, image: &StokesImage) -> (f64, f64) {
        match self {
            Self::S0 | Self::Analyser => (0.0, end(image.s0.iter().copied())),
            Self::Dolp => {
                let most = image.dolp().into_iter().filter(|dolp| dolp.is_finite()).fold(0.0, f64::max);
                (0.0, ((most / DOLP_STEP).ceil() * DOLP_STEP).clamp(DOLP_STEP, 1.0))
            }
            Self::Aop => (0.0, 180.0),
            Self::S1 | Self::S2 => {
                let end = end(image.s1.iter().chain(&image.s2).map(|component| component.abs()));
                (-end, end)
            }
        }
    }

    /// The image as a map of colours, with those ends.
    #[must_use]
    pub fn map(self, image: &StokesImage, analyser: f64, (low, high): (f64, f64)) -> HeatMap {
        picture_map(&self.values(image, analyser), image.size, self.axis().between(low, high), self.colors())
    }
}

/// Numbers of `size`² pixels, row by row from the top, as a map of colours.
#[must_use]
pub fn picture_map(values: &[f64], size: usize, color_axis: Axis, colors: ColorMap) -> HeatMap {
    let values = values.chunks(size.max(1)).rev().flatten().copied().collect();
    HeatMap { x_edges: edges(size), y_edges: edges(size), values, color_axis, colors }
}

/// A map as a figure with square axes.
#[must_use]
pub fn picture_figure(title: String, map: HeatMap) -> Figure {
    let panel = Panel {
        x: Axis::linear("x", "").between(-1.0, 1.0),
        y: Axis::linear("y", "").between(-1.0, 1.0),
        series: vec![Series::heat_map(map)],
        equal_aspect: true,
        ..Panel::default()
    };
    Figure { title, panels: vec![panel], width_mm: 130.0, ..Figure::default() }
}

/// Borders of pixels from −1 to 1.
#[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
fn edges(size: usize) -> Vec<f64> {
    (0..=size).map(|edge| 2.0 * edge as f64 / size as f64 - 1.0).collect()
}

/// The value that [`WHITE`] of the lit pixels stay below; 1 without light.
#[expect(clippy::cast_possible_truncation, clippy::cast_precision_loss, clippy::cast_sign_loss, reason = "a number of pixels")]
fn end(values: impl Iterator<Item = f64>) -> f64 {
    let mut lit: Vec<f64> = values.filter(|value| *value > 0.0 && value.is_finite()).collect();
    if lit.is_empty() {
        return 1.0;
    }
    let place = ((lit.len() - 1) as f64 * WHITE) as usize;
    *lit.select_nth_unstable_by(place, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::{PictureQuantity, end};
    use crate::figure::ColorMap;
    use pbrdf::model::{Lamp, Lighting, Model, Parameters, Pbrdf, Picture, Shape};

    #[test]
    fn maps_stand_upright_and_their_ends_suit_the_image() {
        let picture = Picture::new(Shape::Sphere, 32, &|| false).expect("not cancelled");
        let surface = Pbrdf::new(Model::CAUCHY, Parameters::default()).expect("the defaults");
        let lighting = Lighting { lamp: Some(Lamp::new(60.0, 90.0).expect("a direction")), sky: None };
        let image = picture.stokes(&surface, &lighting, &|| false).expect("not cancelled");
        let map = |quantity: PictureQuantity| quantity.map(&image, 0.0, quantity.range(&image));
        let radiance = map(PictureQuantity::S0);
        // Lit from above: the upper half, the last rows of a map, is brighter.
        let half = radiance.values.len() / 2;
        let sum = |values: &[f64]| values.iter().filter(|value| value.is_finite()).sum::<f64>();
        assert!(sum(&radiance.values[half..]) > 2.0 * sum(&radiance.values[..half]));
        assert_eq!(map(PictureQuantity::Analyser).color_axis.range, radiance.color_axis.range);
        let (low, high) = map(PictureQuantity::S1).color_axis.range.expect("ends");
        assert!(low == -high && high > 0.0);
        assert_eq!(map(PictureQuantity::Aop).colors, ColorMap::Cyclic);
        let (_, most) = map(PictureQuantity::Dolp).color_axis.range.expect("ends");
        assert!(image.dolp().iter().filter(|dolp| dolp.is_finite()).all(|dolp| *dolp <= most) && most <= 1.0);
    }

    #[test]
    fn a_highlight_does_not_set_the_white() {
        let values = (0..1000).map(|i| if i < 3 { 1e6 } else { 1.0 });
        assert_eq!(end(values), 1.0);
        assert_eq!(end([f64::NAN, 0.0].into_iter()), 1.0);
    }
}
