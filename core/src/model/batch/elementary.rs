//! Elementary functions of whole vectors: no branch, no table, nothing that a lane's neighbours could change.
//!
//! - e^x: x = m ln 2 + r, |r| ≤ ln 2/2, `e^r = 1 + r + r² Q(r)` with Q of degree 9 (truncation 2·10⁻¹⁷), times 2^m by its exponent bits.
//! - ln(1 + w): 1 + w = 2^m (1 + f) with √½ ≤ 1 + f < √2, where `f = 2^−m w + (2^−m − 1)` is rounded once and is w itself at m = 0, so that
//!   small w keep their digits; with s = f/(2 + f), `ln(1 + f) = f − (f²/2 − s (f²/2 + s² R(s²)))`, R of degree 6 (truncation 5·10⁻¹⁸).
//!
//! Q and R interpolate (e^r − 1 − r)/r² and (ln((1 + s)/(1 − s)) − 2s)/s³ at Chebyshev nodes in 50-digit arithmetic
//! (`assets/reference/make_batch_polynomials.py`). The reductions are W. J. Cody and W. Waite, *Software Manual for the Elementary
//! Functions* (1980), chapters 5 and 6.

use crate::model::batch::lanes::{Bits, V, choose, number};
use fearless_simd::prelude::*;

/// 1.5 · 2⁵²: adding it leaves the nearest whole number in the low bits.
pub(crate) const TO_WHOLE: f64 = 6_755_399_441_055_744.0;
/// 2⁵²: whole numbers below it, put into its low bits, are themselves once it is taken off.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// ln 2 in two parts; the first has 21 trailing zero bits, so that its product with an exponent is exact.
const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// Below this e^x is subnormal: what is smaller counts as this small.
const FAINTEST: f64 = -708.0;

const Q: [f64; 10] = [
    0.500_000_000_000_000_1,
    0.166_666_666_666_666_69,
    0.041_666_666_666_624_13,
    0.008_333_333_333_330_062,
    0.001_388_888_891_721_371_7,
    0.000_198_412_698_630_536_18,
    2.480_152_129_595_437_6e-5,
    2.755_726_845_999_706_4e-6,
    2.762_008_844_540_974_6e-7,
    2.510_038_549_551_032e-8,
];

const R: [f64; 7] = [
    0.666_666_666_666_667,
    0.399_999_999_998_994_44,
    0.285_714_286_260_032_7,
    0.222_222_111_302_598_78,
    0.181_828_894_556_749_47,
    0.153_317_106_182_107_73,
    0.146_165_854_248_886_23,
];

/// e^x for x ≤ 709; e^−708 below −708.
#[inline(always)]
pub(crate) fn exp<S: Simd>(simd: S, x: V<S>) -> V<S> {
    let of = |value| number(simd, value);
    let x = x.max(of(FAINTEST));
    let shifted = x.mul_add(of(std::f64::consts::LOG2_E), of(TO_WHOLE));
    let m = shifted - TO_WHOLE;
    let r = m.mul_add(of(-LN_2_LOW), m.mul_add(of(-LN_2_HIGH), x));
    let r2 = r * r;
    let r4 = r2 * r2;
    let pair = |j: usize| r.mul_add(of(Q[j + 1]), of(Q[j]));
    let low = pair(2).mul_add(r2, pair(0));
    let high = pair(8).mul_add(r4, pair(6).mul_add(r2, pair(4)));
    let q = high.mul_add(r4, low);
    let mantissa = q.mul_add(r2, r) + 1.0;
    V::<S>::from_bits(mantissa.to_bits() + (shifted.to_bits() << 52_u32))
}

/// ln(1 + w) for 0 ≤ w < 10³⁰⁰.
#[inline(always)]
pub(crate) fn ln_1p<S: Simd>(simd: S, w: V<S>) -> V<S> {
    let [m, two_to_minus_m] = exponent(simd, w + 1.0);
    ln_of_parts(simd, m, two_to_minus_m.mul_add(w, two_to_minus_m - 1.0))
}

/// ln y for 10⁻³⁰⁰ < y < 10³⁰⁰, given y − 1 with all its digits where that is small.
#[inline(always)]
pub(crate) fn ln<S: Simd>(simd: S, y: V<S>, y_minus_1: V<S>) -> V<S> {
    let [m, two_to_minus_m] = exponent(simd, y);
    let f = two_to_minus_m.mul_add(y, number(simd, -1.0));
    ln_of_parts(simd, m, choose::<S>(m.simd_eq(number(simd, 0.0)), y_minus_1, f))
}

/// m and 2^−m, with √½ ≤ 2^−m y < √2.
#[inline(always)]
fn exponent<S: Simd>(simd: S, y: V<S>) -> [V<S>; 2] {
    // m + 1023 stands where an exponent stands.
    let biased = y.to_bits() + (1.0_f64.to_bits() - std::f64::consts::FRAC_1_SQRT_2.to_bits());
    let m = V::<S>::from_bits((biased >> 52_u32) | TWO_52.to_bits()) - (TWO_52 + 1023.0);
    let twice_the_bias: Bits<S> = (2 * 1.0_f64.to_bits()).simd_into(simd);
    [m, V::<S>::from_bits(twice_the_bias - (biased & !(u64::MAX >> 12)))]
}

/// ln(2^m (1 + f)) = m ln 2 + ln(1 + f).
#[inline(always)]
fn ln_of_parts<S: Simd>(simd: S, m: V<S>, f: V<S>) -> V<S> {
    let of = |value| number(simd, value);
    let s = f / (f + 2.0);
    let z = s * s;
    let z2 = z * z;
    let pair = |j: usize| z.mul_add(of(R[j + 1]), of(R[j]));
    let r = z2.mul_add(of(R[6]), pair(4)).mul_add(z2, pair(2)).mul_add(z2, pair(0));
    let half_f_sq = f * f * 0.5;
    let rest = m.mul_add(of(LN_2_LOW), s * r.mul_add(z, half_f_sq));
    m.mul_add(of(LN_2_HIGH), f - (half_f_sq - rest))
}
