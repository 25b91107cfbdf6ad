//! Sines of angles in degrees, of whole vectors.
//!
//! x = θ π/180, `sin x = x + x³ P(x²)`: for |θ| ≤ 45° with S of degree 5, for 0 ≤ θ ≤ 90° with L of degree 7 (truncation 2·10⁻¹⁷ and
//! 4·10⁻¹⁷), by the script that [`crate::model::batch::elementary`] names. Products with π/180 are rounded once: with what a polynomial
//! adds, a sine is 2 units in the last place off at most.

use crate::model::batch::elementary::TO_WHOLE;
use crate::model::batch::lanes::{V, choose, number};
use crate::optics::RADIANS_PER_DEGREE;
use fearless_simd::prelude::*;

const S: [f64; 6] = [
    -0.166_666_666_666_666_66,
    0.008_333_333_333_330_948,
    -0.000_198_412_698_367_567_74,
    2.755_731_610_161_787_4e-6,
    -2.505_113_165_023_518e-8,
    1.591_811_526_326_597_4e-10,
];

const L: [f64; 8] = [
    -0.166_666_666_666_666_66,
    0.008_333_333_333_333_316,
    -0.000_198_412_698_412_549_66,
    2.755_731_921_916_083_3e-6,
    -2.505_210_761_669_045e-8,
    1.605_897_729_264_274_3e-10,
    -7.643_969_663_988_074e-13,
    2.731_436_876_937_989_5e-15,
];

/// Sine of −π/4 … π/4.
#[inline(always)]
fn sin_near_zero_of_radians<I: Simd>(simd: I, x: V<I>) -> V<I> {
    let z = x * x;
    let z2 = z * z;
    let pair = |j: usize| z.mul_add(number(simd, S[j + 1]), number(simd, S[j]));
    (x * z).mul_add(z2.mul_add(z2.mul_add(pair(4), pair(2)), pair(0)), x)
}

/// Sine of −45 … 45 degrees.
#[inline(always)]
pub(crate) fn sin_near_zero<I: Simd>(simd: I, degrees: V<I>) -> V<I> {
    sin_near_zero_of_radians(simd, degrees * RADIANS_PER_DEGREE)
}

/// Sine of 0 … 90 degrees.
#[inline(always)]
pub(crate) fn sin_of_quadrant<I: Simd>(simd: I, degrees: V<I>) -> V<I> {
    let x = degrees * RADIANS_PER_DEGREE;
    let z = x * x;
    let z2 = z * z;
    let pair = |j: usize| z.mul_add(number(simd, L[j + 1]), number(simd, L[j]));
    let (low, high) = (z2.mul_add(pair(2), pair(0)), z2.mul_add(pair(6), pair(4)));
    (x * z).mul_add((z2 * z2).mul_add(high, low), x)
}

/// Cosine of 0 … 90 degrees: near 90 with all digits.
#[inline(always)]
pub(crate) fn cos_of_quadrant<I: Simd>(simd: I, degrees: V<I>) -> V<I> {
    sin_of_quadrant(simd, -degrees + 90.0)
}

/// sin²½φ and cos²½φ of angles below 10⁹ degrees, each with all digits where it is small.
#[inline(always)]
pub(crate) fn half_angle_squares<I: Simd>(simd: I, degrees: V<I>) -> [V<I>; 2] {
    let turns = degrees.mul_add(number(simd, 1.0 / 360.0), number(simd, TO_WHOLE)) - TO_WHOLE;
    let from_0 = turns.mul_add(number(simd, -360.0), degrees).abs();
    let from_180 = -from_0 + 180.0;
    let sin = sin_near_zero_of_radians(simd, from_0.min(from_180) * (0.5 * RADIANS_PER_DEGREE));
    let smaller = sin * sin;
    let larger = -smaller + 1.0;
    let is_front = from_0.simd_lt(from_180);
    [choose::<I>(is_front, smaller, larger), choose::<I>(is_front, larger, smaller)]
}

#[cfg(test)]
mod tests {
    use super::{cos_of_quadrant, half_angle_squares, sin_near_zero, sin_of_quadrant};
    use crate::model::batch::lanes::{Instructions, V, Vectorised, dispatch};
    use crate::optics::Degrees;
    use fearless_simd::prelude::*;

    /// Relative errors of vectors against the scalar form: of sines and cosines, and of squares.
    struct Task<'a> {
        degrees: &'a [f64],
        worst: &'a mut [f64; 2],
    }

    impl Vectorised for Task<'_> {
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) {
            let Self { degrees, worst } = self;
            for degrees in degrees.chunks_exact(V::<S>::LEN) {
                let lanes = V::<S>::from_slice(simd, degrees);
                let [near, sin, cos] = [sin_near_zero(simd, lanes), sin_of_quadrant(simd, lanes), cos_of_quadrant(simd, lanes)];
                let squares = half_angle_squares(simd, lanes);
                for (lane, &degrees) in degrees.iter().enumerate() {
                    let (expected_sin, expected_cos) = Degrees(degrees).sin_cos();
                    if degrees.abs() <= 45.0 {
                        worst[0] = worst[0].max(error(near.as_slice()[lane], expected_sin));
                    }
                    if (0.0..=90.0).contains(&degrees) {
                        worst[0] = worst[0].max(error(sin.as_slice()[lane], expected_sin));
                        worst[0] = worst[0].max(error(cos.as_slice()[lane], expected_cos));
                    }
                    let (half_sin, half_cos) = Degrees(0.5 * degrees).sin_cos();
                    for (square, root) in squares.iter().zip([half_sin, half_cos]) {
                        worst[1] = worst[1].max(error(square.as_slice()[lane], root * root));
                    }
                }
            }
        }

        fn run_scalar(self) {}
    }

    fn error(found: f64, expected: f64) -> f64 {
        if expected == 0.0 { found.abs() } else { (found / expected - 1.0).abs() }
    }

    #[test]
    fn sines_are_those_of_the_scalar_form_with_all_digits() {
        let mut degrees: Vec<f64> = (0..80_000_u32).map(|i| 0.009_f64.mul_add(f64::from(i), -360.0)).collect();
        degrees.extend([
            0.0,
            90.0,
            180.0,
            45.0,
            1e-300,
            1e-9,
            89.999_999_999,
            90.000_000_1,
            123_456_789.0,
            -90.0,
            270.0,
            44.999_999_999,
            135.0,
            179.999_999_999,
            -180.0,
            360.0,
        ]);
        degrees.resize(degrees.len().next_multiple_of(8), 0.0);
        for instructions in [Instructions::Widest, Instructions::Avx2, Instructions::Portable] {
            let mut worst = [0.0; 2];
            dispatch(instructions, Task { degrees: &degrees, worst: &mut worst });
            // Two units in the last place, of both forms together; twice that in squares.
            assert!(worst[0] < 5e-16 && worst[1] < 10e-16, "{}: {worst:?}", instructions.name());
        }
    }
}
