//! A Stokes vector in every pixel, and what is shown of it.

use crate::optics::{Degrees, Stokes, angle_of_polarisation};
use nalgebra::Vector4;

/// What a polarisation camera sees: `size`² pixels, row by row from the top, NaN where there is no surface. S1 > 0 is polarised along x, S2 > 0 along
/// the diagonal of x and y; S3 is 0, since the light that comes in is unpolarised.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct StokesImage {
    /// Pixels along an edge.
    pub size: usize,
    /// Radiance, for a lamp of irradiance 1 across its beam in sr⁻¹.
    pub s0: Vec<f64>,
    /// Radiance along x less that along y.
    pub s1: Vec<f64>,
    /// Radiance along the diagonal of x and y less that across it.
    pub s2: Vec<f64>,
}

impl StokesImage {
    /// Without any light.
    pub(crate) fn blank(size: usize) -> Self {
        let blank = vec![f64::NAN; size * size];
        Self { size, s0: blank.clone(), s1: blank.clone(), s2: blank }
    }

    /// Of its columns S0, S1 and S2; none where these are not `size`² numbers.
    #[must_use]
    pub fn of_parts(size: usize, [s0, s1, s2]: [Vec<f64>; 3]) -> Option<Self> {
        [&s0, &s1, &s2].iter().all(|part| part.len() == size * size).then_some(Self { size, s0, s1, s2 })
    }

    /// The Stokes vector of a pixel in the camera's frame; none where there is no surface or no such pixel.
    #[must_use]
    pub fn at(&self, row: usize, column: usize) -> Option<Stokes> {
        if row >= self.size || column >= self.size {
            return None;
        }
        let pixel = row * self.size + column;
        let s0 = self.s0[pixel];
        (!s0.is_nan()).then(|| Stokes(Vector4::new(s0, self.s1[pixel], self.s2[pixel], 0.0)))
    }

    /// Degree of linear polarisation of each pixel; NaN without light.
    #[must_use]
    pub fn dolp(&self) -> Vec<f64> {
        self.map(|[s0, s1, s2]| if s0 > 0.0 { (s1 * s1 + s2 * s2).sqrt() / s0 } else { f64::NAN })
    }

    /// Angle of polarisation of each pixel from x towards y, 0 to 180 degrees; NaN where nothing is polarised.
    #[must_use]
    pub fn angle(&self) -> Vec<f64> {
        self.map(|[_, s1, s2]| angle_of_polarisation(s1, s2).unwrap_or(f64::NAN))
    }

    /// Radiance of each pixel through an ideal analyser at that angle from x towards y, (S0 + S1 cos 2γ + S2 sin 2γ)/2.
    #[must_use]
    pub fn through_analyser(&self, angle: Degrees) -> Vec<f64> {
        let (sin, cos) = Degrees(2.0 * angle.0).sin_cos();
        self.map(|[s0, s1, s2]| 0.5 * (s0 + s1 * cos + s2 * sin))
    }

    /// Like [`Self::at`], pixel after pixel.
    fn map(&self, of: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
        self.s0.iter().zip(&self.s1).zip(&self.s2).map(|((s0, s1), s2)| of([*s0, *s1, *s2])).collect()
    }
}
