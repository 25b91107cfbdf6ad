//! Sines of half an angle in degrees, of whole vectors.
//!
//! `sin ½θ = θ K(θ²)`: for |θ| ≤ 90° with S of degree 6, for 0 ≤ θ ≤ 180° with L of degree 8 (truncation 2·10⁻¹⁷ and 6·10⁻¹⁷, π/360
//! rounded among it), by the script that [`crate::model::batch::elementary`] names. With two roundings a sine is 2 units in the last place
//! off at most.

use crate::model::batch::elementary::{TO_WHOLE, polynomial};
use crate::model::batch::lanes::{V, choose, number};
use fearless_simd::prelude::*;

const S: [f64; 7] = [
    0.008_726_646_259_971_648,
    -1.107_620_194_626_609_2e-7,
    4.217_505_072_365_092_4e-13,
    -7.647_175_661_459_666e-19,
    8.088_409_641_502_522e-25,
    -5.599_229_917_418_983e-31,
    2.698_929_861_778_087e-37,
];

const L: [f64; 9] = [
    0.008_726_646_259_971_648,
    -1.107_620_194_626_616_6e-7,
    4.217_505_072_381_388_7e-13,
    -7.647_175_672_201_263e-19,
    8.088_412_809_936_533e-25,
    -5.599_700_288_167_084e-31,
    2.733_320_867_382_178_6e-37,
    -9.857_472_259_551_184e-44,
    2.298_976_615_594_022_7e-50,
];

/// Sine of half of −90 … 90 degrees.
#[inline(always)]
pub(crate) fn sin_of_half_near_zero<I: Simd>(simd: I, degrees: V<I>) -> V<I> {
    degrees * polynomial(simd, &S, degrees * degrees)
}

/// Sine of half of 0 … 180 degrees.
#[inline(always)]
pub(crate) fn sin_of_half<I: Simd>(simd: I, degrees: V<I>) -> V<I> {
    degrees * polynomial(simd, &L, degrees * degrees)
}

/// Cosine of 0 … 90 degrees: near 90 with all digits.
#[inline(always)]
pub(crate) fn cos_of_quadrant<I: Simd>(simd: I, degrees: V<I>) -> V<I> {
    sin_of_half(simd, -(degrees + degrees) + 180.0)
}

/// sin²½φ and cos²½φ of angles below 10⁹ degrees, each with all digits where it is small.
#[inline(always)]
pub(crate) fn half_angle_squares<I: Simd>(simd: I, degrees: V<I>) -> [V<I>; 2] {
    let turns = degrees.mul_add(number(simd, 1.0 / 360.0), number(simd, TO_WHOLE)) - TO_WHOLE;
    let from_0 = turns.mul_add(number(simd, -360.0), degrees).abs();
    let from_180 = -from_0 + 180.0;
    let sin = sin_of_half_near_zero(simd, from_0.min(from_180));
    let smaller = sin * sin;
    let larger = -smaller + 1.0;
    let is_front = from_0.simd_lt(from_180);
    [choose::<I>(is_front, smaller, larger), choose::<I>(is_front, larger, smaller)]
}

#[cfg(test)]
mod tests {
    use super::{cos_of_quadrant, half_angle_squares, sin_of_half, sin_of_half_near_zero};
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
                let [near, half, cos] = [sin_of_half_near_zero(simd, lanes), sin_of_half(simd, lanes), cos_of_quadrant(simd, lanes)];
                let squares = half_angle_squares(simd, lanes);
                for (lane, &degrees) in degrees.iter().enumerate() {
                    let (half_sin, half_cos) = Degrees(0.5 * degrees).sin_cos();
                    if degrees.abs() <= 90.0 {
                        worst[0] = worst[0].max(error(near.as_slice()[lane], half_sin));
                    }
                    if (0.0..=180.0).contains(&degrees) {
                        worst[0] = worst[0].max(error(half.as_slice()[lane], half_sin));
                    }
                    if (0.0..=90.0).contains(&degrees) {
                        worst[0] = worst[0].max(error(cos.as_slice()[lane], Degrees(degrees).sin_cos().1));
                    }
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
