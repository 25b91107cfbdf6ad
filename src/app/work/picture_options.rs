//! What the pane *Picture* shows, and under which light.

use crate::report::PictureQuantity;
use pbrdf::model::Shape;
use serde::{Deserialize, Serialize};

/// What stands beside the surface of the sliders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureCompanion {
    #[default]
    Nothing,
    /// The other distribution of slopes, at equal median.
    OtherDistribution,
    /// The pinned surface of that place.
    Pinned(usize),
}

/// What is set of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PictureOptions {
    pub shape: Shape,
    pub quantity: PictureQuantity,
    pub lamp: bool,
    /// Direction of the lamp in degrees: from the camera, and from right to up.
    pub polar: f64,
    pub azimuth: f64,
    pub sky: bool,
    pub sky_radiance: f64,
    /// Angle of the analyser from right to up, degrees.
    pub analyser: f64,
    pub companion: PictureCompanion,
    /// Whether the companion is subtracted, rather than shown as the right half.
    pub difference: bool,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            shape: Shape::Sphere,
            quantity: PictureQuantity::S0,
            lamp: true,
            polar: 30.0,
            azimuth: 135.0,
            sky: false,
            sky_radiance: 0.3,
            analyser: 30.0,
            companion: PictureCompanion::Nothing,
            difference: false,
        }
    }
}

impl PictureOptions {
    /// Whether every value means something.
    pub fn is_sound(&self) -> bool {
        (0.0..=180.0).contains(&self.polar)
            && self.azimuth.is_finite()
            && (self.sky_radiance.is_finite() && self.sky_radiance >= 0.0)
            && self.analyser.is_finite()
    }
}
