//! Shapes in front of the camera, by their normals.

use crate::model::picture::height_field::HeightField;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_SQRT_2;

/// What the camera sees. Coordinates are those of the camera: x to the right, y upwards, z towards it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Shape {
    /// A sphere of radius 1.
    #[default]
    Sphere,
    /// A cylinder of radius 1 along y, longer than the image is high.
    Cylinder,
    /// A square of side 2, tilted by 45° towards +x: its normal lies halfway between z and x.
    Plate,
    /// [`HeightField::relief`] over the whole image.
    Relief,
}

impl Shape {
    /// All shapes.
    pub const ALL: [Self; 4] = [Self::Sphere, Self::Cylinder, Self::Plate, Self::Relief];

    /// Name in options.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Cylinder => "cylinder",
            Self::Plate => "plate",
            Self::Relief => "relief",
        }
    }

    /// The unit normal where the line of sight through (x, y) meets the shape, x and y in −1…1; none where it passes by.
    #[must_use]
    pub fn normal(self, x: f64, y: f64) -> Option<[f64; 3]> {
        match self {
            Self::Sphere => upright(x, y),
            Self::Cylinder => upright(x, 0.0),
            Self::Plate => (x.abs() <= FRAC_1_SQRT_2).then_some([FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2]),
            Self::Relief => {
                let [along_x, along_y] = HeightField::relief().slopes(x, y);
                let length = (1.0 + along_x * along_x + along_y * along_y).sqrt();
                Some([-along_x / length, -along_y / length, 1.0 / length])
            }
        }
    }
}

/// The unit vector with those two components that looks at the camera.
fn upright(x: f64, y: f64) -> Option<[f64; 3]> {
    let z_sq = 1.0 - x * x - y * y;
    (z_sq > 0.0).then(|| [x, y, z_sq.sqrt()])
}
