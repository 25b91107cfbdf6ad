//! Angles that stay degrees until the last moment.
//!
//! `cos 89.9999°` is `sin 0.0001°`: reducing in degrees, where 90 is a whole number, keeps every digit
//! that a radian near π/2 has already lost. Sine and cosine are exact at the quadrants.

use serde::{Deserialize, Serialize};

/// An angle in degrees.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Degrees(pub f64);

/// π/180 to 106 bits: the nearest double, and what it leaves over.
pub(crate) const RADIANS_PER_DEGREE: f64 = 0.017_453_292_519_943_295;
const RADIANS_PER_DEGREE_REST: f64 = 2.948_652_270_870_168_7e-19;

impl Degrees {
    /// The angle that completes this one to 90°; exact between 45° and 90°.
    #[must_use]
    pub fn complement(self) -> Self {
        Self(90.0 - self.0)
    }

    /// In radians.
    #[must_use]
    pub fn radians(self) -> f64 {
        self.0 * RADIANS_PER_DEGREE
    }

    /// Sine and cosine, each to about one unit in the last place, exact at multiples of 90°.
    ///
    /// The reduction to −45…45° is exact; the rounding of the conversion to radians is carried along
    /// to first order.
    #[must_use]
    pub fn sin_cos(self) -> (f64, f64) {
        let turn = self.0 % 360.0;
        let quadrant = (turn / 90.0).round();
        let rest = turn - 90.0 * quadrant;
        let x = rest * RADIANS_PER_DEGREE;
        let dx = libm::fma(rest, RADIANS_PER_DEGREE, -x) + rest * RADIANS_PER_DEGREE_REST;
        let (s, c) = (libm::sin(x), libm::cos(x));
        let (s, c) = (s + dx * c, c - dx * s);
        match quadrant.rem_euclid(4.0) {
            0.0 => (s, c),
            1.0 => (c, -s),
            2.0 => (-s, -c),
            _ => (-c, s),
        }
    }

    /// Sine; see [`Self::sin_cos`].
    #[must_use]
    pub fn sin(self) -> f64 {
        self.sin_cos().0
    }

    /// Cosine; see [`Self::sin_cos`].
    #[must_use]
    pub fn cos(self) -> f64 {
        self.sin_cos().1
    }
}

#[cfg(test)]
mod tests {
    use super::Degrees;

    #[test]
    fn sine_and_cosine_are_exact_at_the_quadrants() {
        for (degrees, sin, cos) in
            [(0.0, 0.0, 1.0), (90.0, 1.0, 0.0), (180.0, 0.0, -1.0), (-90.0, -1.0, 0.0), (270.0, -1.0, 0.0), (360.0 * 1e6 + 90.0, 1.0, 0.0)]
        {
            let (s, c) = Degrees(degrees).sin_cos();
            assert_eq!((s.abs(), s > 0.0), (f64::abs(sin), sin > 0.0), "sin {degrees}°");
            assert_eq!((c.abs(), c > 0.0), (f64::abs(cos), cos > 0.0), "cos {degrees}°");
        }
    }

    #[test]
    fn cosine_near_ninety_is_the_sine_of_the_complement() {
        let theta = Degrees(89.999_999);
        assert_eq!(theta.cos(), theta.complement().sin());
    }
}
