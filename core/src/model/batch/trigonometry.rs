//! Sine and cosine of angles in degrees, of whole vectors.
//!
//! `θ = 90° k + r`, |r| ≤ 45° exactly; x = r π/180 in two parts; `sin x = x + x³ S(x²)`, `cos x = 1 − x²/2 + x⁴ C(x²)`, S and C of degree 5
//! (truncation 2·10⁻¹⁷), by the script that [`crate::model::batch::elementary`] names.

use crate::model::batch::elementary::TO_WHOLE;
use crate::model::batch::lanes::{V, choose, number};
use crate::optics::{RADIANS_PER_DEGREE, RADIANS_PER_DEGREE_REST};
use fearless_simd::prelude::*;

const S: [f64; 6] = [
    -0.166_666_666_666_666_66,
    0.008_333_333_333_330_948,
    -0.000_198_412_698_367_567_74,
    2.755_731_610_161_787_4e-6,
    -2.505_113_165_023_518e-8,
    1.591_811_526_326_597_4e-10,
];

const C: [f64; 6] = [
    0.041_666_666_666_666_664,
    -0.001_388_888_888_888_739_8,
    2.480_158_729_876_456e-5,
    -2.755_731_727_114_514_4e-7,
    2.087_614_614_655_861e-9,
    -1.138_262_364_746_760_4e-11,
];

/// Polynomial of degree 5.
#[inline(always)]
fn polynomial<L: Simd>(simd: L, of: &[f64; 6], z: V<L>) -> V<L> {
    let pair = |j: usize| z.mul_add(number(simd, of[j + 1]), number(simd, of[j]));
    let z2 = z * z;
    z2.mul_add(z2.mul_add(pair(4), pair(2)), pair(0))
}

/// Radians of −45 … 45 degrees, in two parts.
#[inline(always)]
fn radians<L: Simd>(simd: L, degrees: V<L>) -> [V<L>; 2] {
    let x = degrees * RADIANS_PER_DEGREE;
    [x, degrees.mul_add(number(simd, RADIANS_PER_DEGREE), -x) + degrees * RADIANS_PER_DEGREE_REST]
}

/// Sine of −45 … 45 degrees.
#[inline(always)]
pub(crate) fn sin_near_zero<L: Simd>(simd: L, degrees: V<L>) -> V<L> {
    sine(simd, radians(simd, degrees))
}

/// Sine of −π/4 … π/4 in two parts.
#[inline(always)]
fn sine<L: Simd>(simd: L, [x, dx]: [V<L>; 2]) -> V<L> {
    let z = x * x;
    x + (x * z).mul_add(polynomial(simd, &S, z), dx)
}

/// Sine and cosine of −45 … 45 degrees.
#[inline(always)]
fn sin_cos_near_zero<L: Simd>(simd: L, degrees: V<L>) -> [V<L>; 2] {
    let [x, dx] = radians(simd, degrees);
    let z = x * x;
    let half = z * 0.5;
    let main = -half + 1.0;
    let lost = (-main + 1.0) - half;
    let cos = main + (z * z).mul_add(polynomial(simd, &C, z), lost - x * dx);
    [sine(simd, [x, dx]), cos]
}

/// |sin| and |cos| of angles below 10⁹ degrees.
#[inline(always)]
pub(crate) fn abs_sin_cos<L: Simd>(simd: L, degrees: V<L>) -> [V<L>; 2] {
    let shifted = degrees.mul_add(number(simd, 1.0 / 90.0), number(simd, TO_WHOLE));
    let rest = (shifted - TO_WHOLE).mul_add(number(simd, -90.0), degrees);
    let [sin, cos] = sin_cos_near_zero(simd, rest);
    // Odd multiples of 90° have the low bit: at the place of the sign it makes 1 to −1.
    let parity = V::<L>::from_bits((shifted.to_bits() << 63_u32) | 1.0_f64.to_bits());
    let odd = parity.simd_lt(number(simd, 0.0));
    let sin = sin.abs();
    [choose::<L>(odd, cos, sin), choose::<L>(odd, sin, cos)]
}

#[cfg(test)]
mod tests {
    use super::{abs_sin_cos, sin_near_zero};
    use crate::model::batch::lanes::{Instructions, V, Vectorised, dispatch};
    use crate::optics::Degrees;
    use fearless_simd::prelude::*;

    struct Task<'a> {
        degrees: &'a [f64],
        worst: &'a mut f64,
    }

    impl Vectorised for Task<'_> {
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) {
            for degrees in self.degrees.chunks_exact(V::<S>::LEN) {
                let lanes = V::<S>::from_slice(simd, degrees);
                let [sin, cos] = abs_sin_cos(simd, lanes);
                let near_sin = sin_near_zero(simd, lanes);
                for (lane, &degrees) in degrees.iter().enumerate() {
                    let (expected_sin, expected_cos) = Degrees(degrees).sin_cos();
                    let mut compare = |found: f64, expected: f64| {
                        let error = if expected == 0.0 { found.abs() } else { (found / expected - 1.0).abs() };
                        *self.worst = self.worst.max(error);
                    };
                    compare(sin.as_slice()[lane], expected_sin.abs());
                    compare(cos.as_slice()[lane], expected_cos.abs());
                    if degrees.abs() <= 45.0 {
                        compare(near_sin.as_slice()[lane], expected_sin);
                    }
                }
            }
        }

        fn run_scalar(self) {}
    }

    #[test]
    fn sine_and_cosine_are_those_of_the_scalar_form_with_all_digits() {
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
        ]);
        degrees.resize(degrees.len().next_multiple_of(8), 0.0);
        for instructions in [Instructions::Widest, Instructions::Avx2, Instructions::Portable] {
            let mut worst = 0.0;
            dispatch(instructions, Task { degrees: &degrees, worst: &mut worst });
            // Two units in the last place: one of each form; without fused multiply–add the conversion to radians rounds once more.
            assert!(worst < 5e-16, "{}: {worst:e}", instructions.name());
        }
    }
}
