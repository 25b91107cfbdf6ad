//! Elementary functions of whole vectors: no branch, no table, nothing that a lane's neighbours could change. Exponents are those of 2, so
//! that nothing is reduced by ln 2.
//!
//! - 2^t: t = m + f, |f| ≤ ½, `2^f = 1 + f Q(f)` with Q of degree 10 (truncation 2·10⁻¹⁷), times 2^m by its exponent bits.
//! - log₂(1 + w): 1 + w = 2^m (1 + f) with √½ ≤ 1 + f < √2, where `f = 2^−m w + (2^−m − 1)` is rounded once and is w itself at m = 0, so
//!   that small w keep their digits; with s = f/(2 + f), `ln(1 + f) = f − (f²/2 − s (f²/2 + s² R(s²)))`, R of degree 6 (truncation 5·10⁻¹⁸).
//!
//! Q and R interpolate (2^f − 1)/f and (ln((1 + s)/(1 − s)) − 2s)/s³ at Chebyshev nodes in 50-digit arithmetic
//! (`assets/reference/make_batch_polynomials.py`). The reduction of the logarithm is that of W. J. Cody and W. Waite, *Software Manual for
//! the Elementary Functions* (1980), chapter 5.

use crate::model::batch::lanes::{Bits, V, choose, number};
use fearless_simd::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, LN_2, LOG2_E};

/// 1.5 · 2⁵²: adding it leaves the nearest whole number in the low bits.
pub(crate) const TO_WHOLE: f64 = 6_755_399_441_055_744.0;
/// 2⁵²: whole numbers below it, put into its low bits, are themselves once it is taken off.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// The least exponent: 2^m times a mantissa from √½ on is no subnormal number. What is smaller counts as this small.
const FAINTEST: f64 = -1021.0;

/// Q, its even and its odd coefficients.
const Q_EVEN: [f64; 6] = [
    LN_2,
    0.055_504_108_664_821_6,
    0.001_333_355_814_641_692_7,
    1.525_273_382_985_159_6e-5,
    1.017_806_243_641_276_5e-7,
    4.454_962_484_633_212_5e-10,
];
const Q_ODD: [f64; 5] =
    [0.240_226_506_959_100_97, 0.009_618_129_107_606_871, 0.000_154_035_304_417_650_88, 1.321_544_257_022_465e-6, 7.072_589_488_396_345e-9];

const R: [f64; 7] = [
    0.666_666_666_666_667,
    0.399_999_999_998_994_44,
    0.285_714_286_260_032_7,
    0.222_222_111_302_598_78,
    0.181_828_894_556_749_47,
    0.153_317_106_182_107_73,
    0.146_165_854_248_886_23,
];

/// The polynomial of those coefficients, lowest first.
#[inline(always)]
pub(crate) fn polynomial<S: Simd, const N: usize>(simd: S, coefficients: &[f64; N], x: V<S>) -> V<S> {
    let mut sum = number(simd, coefficients[N - 1]);
    for &coefficient in coefficients.iter().rev().skip(1) {
        sum = sum.mul_add(x, number(simd, coefficient));
    }
    sum
}

/// 2^t for t ≤ 1023; 2^−1021 below −1021.
#[inline(always)]
pub(crate) fn exp2<S: Simd>(simd: S, t: V<S>) -> V<S> {
    let t = t.max(number(simd, FAINTEST));
    let shifted = t + TO_WHOLE;
    let f = t - (shifted - TO_WHOLE);
    let f_sq = f * f;
    let q = polynomial(simd, &Q_ODD, f_sq).mul_add(f, polynomial(simd, &Q_EVEN, f_sq));
    let mantissa = q.mul_add(f, number(simd, 1.0));
    V::<S>::from_bits(mantissa.to_bits() + (shifted.to_bits() << 52_u32))
}

/// log₂(1 + w) for 0 ≤ w < 10³⁰⁰.
#[inline(always)]
pub(crate) fn log2_1p<S: Simd>(simd: S, w: V<S>) -> V<S> {
    let [m, two_to_minus_m] = exponent(simd, w + 1.0);
    log2_of_parts(simd, m, two_to_minus_m.mul_add(w, two_to_minus_m - 1.0))
}

/// log₂ y for 10⁻³⁰⁰ < y < 10³⁰⁰, given y − 1 with all its digits where that is small.
#[inline(always)]
pub(crate) fn log2<S: Simd>(simd: S, y: V<S>, y_minus_1: V<S>) -> V<S> {
    let [m, two_to_minus_m] = exponent(simd, y);
    let f = two_to_minus_m.mul_add(y, number(simd, -1.0));
    log2_of_parts(simd, m, choose::<S>(m.simd_eq(number(simd, 0.0)), y_minus_1, f))
}

/// m and 2^−m, with √½ ≤ 2^−m y < √2.
#[inline(always)]
fn exponent<S: Simd>(simd: S, y: V<S>) -> [V<S>; 2] {
    // m + 1023 stands where an exponent stands.
    let biased = y.to_bits() + (1.0_f64.to_bits() - FRAC_1_SQRT_2.to_bits());
    let m = V::<S>::from_bits((biased >> 52_u32) | TWO_52.to_bits()) - (TWO_52 + 1023.0);
    let twice_the_bias: Bits<S> = (2 * 1.0_f64.to_bits()).simd_into(simd);
    [m, V::<S>::from_bits(twice_the_bias - (biased & !(u64::MAX >> 12)))]
}

/// log₂(2^m (1 + f)) = m + log₂(1 + f).
#[inline(always)]
fn log2_of_parts<S: Simd>(simd: S, m: V<S>, f: V<S>) -> V<S> {
    let s = f / (f + 2.0);
    let s_sq = s * s;
    let half_f_sq = f * f * 0.5;
    let rest = s * polynomial(simd, &R, s_sq).mul_add(s_sq, half_f_sq);
    (f - (half_f_sq - rest)).mul_add(number(simd, LOG2_E), m)
}
