//! Double-double arithmetic: numbers as the unevaluated sum of two f64, some 31 digits.
//!
//! T. J. Dekker, Numer. Math. 18, 224 (1971); Y. Hida, X. S. Li, D. H. Bailey, ARITH-15, 155 (2001). Slow beside f64: for the rare
//! places where an f64 cannot hold what is needed.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo`, with lo at most half a unit in the last place of hi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Double {
    /// The nearest f64.
    pub hi: f64,
    /// What it leaves over.
    pub lo: f64,
}

/// π/180 and ln 2 to 106 bits.
const RADIANS_PER_DEGREE: Double = Double { hi: 0.017_453_292_519_943_295, lo: 2.948_652_270_870_168_7e-19 };
pub(crate) const LN_2: Double = Double { hi: std::f64::consts::LN_2, lo: 2.319_046_813_846_299_6e-17 };

/// Terms of the sine and cosine series that 45° needs.
const ANGLE_TERMS: u32 = 14;
/// How often ln 2 / 2 is halved, and the terms of the exponential series that it then needs.
const HALVINGS: u32 = 6;
const EXPONENTIAL_TERMS: u32 = 12;
/// Below this the first three terms of ln(1 + w) are all there is.
const SMALL: f64 = 1e-9;

/// Sum and its exact rounding error.
pub(crate) fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let virtual_b = hi - a;
    Double { hi, lo: (a - (hi - virtual_b)) + (b - virtual_b) }
}

/// The same where |a| ≥ |b|.
fn quick_two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double { hi, lo: b - (hi - a) }
}

impl From<f64> for Double {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.hi, other.hi), two_sum(self.lo, other.lo));
        let sum = quick_two_sum(high.hi, high.lo + low.hi);
        quick_two_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let hi = self.hi * other.hi;
        // Exact on every platform, and one instruction where the processor has it.
        let error = self.hi.mul_add(other.hi, -hi);
        quick_two_sum(hi, error + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Mul<f64> for Double {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self * Self::from(factor)
    }
}

impl Div for Double {
    type Output = Self;

    fn div(self, divisor: Self) -> Self {
        let first = self.hi / divisor.hi;
        let rest = self - divisor * first;
        let second = rest.hi / divisor.hi;
        let third = (rest - divisor * second).hi / divisor.hi;
        quick_two_sum(first, second) + Self::from(third)
    }
}

impl Div<f64> for Double {
    type Output = Self;

    fn div(self, divisor: f64) -> Self {
        let first = self.hi / divisor;
        // What the quotient leaves of hi is an f64.
        let rest = (-first).mul_add(divisor, self.hi) + self.lo;
        quick_two_sum(first, rest / divisor)
    }
}

impl Double {
    pub(crate) const ONE: Self = Self { hi: 1.0, lo: 0.0 };

    /// In radians, for degrees.
    pub(crate) fn radians(self) -> Self {
        self * RADIANS_PER_DEGREE
    }

    /// Sine and cosine of degrees.
    pub(crate) fn sin_cos_degrees(self) -> (Self, Self) {
        let turn = self.hi % 360.0;
        let quadrant = (turn / 90.0).round();
        let x = (Self::from(turn - 90.0 * quadrant) + Self::from(self.lo)).radians();
        let square = x * x;
        let (mut sin, mut cos) = (Self::ONE, Self::ONE);
        // From the last term inwards: sin x / x and cos x.
        for i in (1..=ANGLE_TERMS).rev().map(f64::from) {
            sin = Self::ONE - square * sin / (2.0 * i * (2.0 * i + 1.0));
            cos = Self::ONE - square * cos / ((2.0 * i - 1.0) * 2.0 * i);
        }
        let sin = x * sin;
        match quadrant.rem_euclid(4.0) {
            0.0 => (sin, cos),
            1.0 => (cos, -sin),
            2.0 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    /// Natural logarithm of a positive number: that of f64, and what it leaves over.
    pub(crate) fn ln(self) -> Self {
        let guess = libm::log(self.hi);
        let power = (guess / LN_2.hi).round();
        // e^(−guess) = 2^(−power) e^r
        let r = LN_2 * power - Self::from(guess);
        // e^r − 1 of a 64th of r, and from there by (1 + x)² − 1 = x (2 + x).
        let part = r * (1.0 / f64::from(1 << HALVINGS));
        let series = (2..=EXPONENTIAL_TERMS).rev().map(f64::from).fold(Self::ONE, |sum, i| Self::ONE + part * sum / i);
        let exponential = (0..HALVINGS).fold(part * series, |x, _| x * (x + Self::from(2.0))) + Self::ONE;
        #[expect(clippy::cast_possible_truncation, reason = "a binary exponent of f64")]
        let shift = -(power as i32);
        let scaled = Self { hi: libm::ldexp(self.hi, shift), lo: libm::ldexp(self.lo, shift) };
        let rest = scaled * exponential - Self::ONE;
        Self::from(guess) + (rest - rest * rest * 0.5)
    }

    /// ln(1 + w) for w ≥ 0.
    pub(crate) fn ln_1p(self) -> Self {
        if self.hi < SMALL { self * (Self::ONE - self * 0.5 + self * self / 3.0) } else { (Self::ONE + self).ln() }
    }
}

#[cfg(test)]
mod tests {
    use super::{Double, LN_2};

    /// A few units in the 31st digit.
    const ROUNDING: f64 = 1e-30;

    fn assert_near(value: Double, expected: Double) {
        let error = ((value - expected).hi / expected.hi).abs();
        assert!(error < ROUNDING, "{value:?} instead of {expected:?}: {error:e}");
    }

    #[test]
    fn sines_have_thirty_digits() {
        // From mpmath, each argument being the f64 that is written here.
        let (sin, cos) = Double::from(40.1).sin_cos_degrees();
        assert_near(sin, Double { hi: 0.6441236297613865, lo: 4.106712148169023e-17 });
        assert_near(sin * sin + cos * cos, Double::ONE);
        assert_near(Double::from(30.0).sin_cos_degrees().0, Double::from(0.5));
        let (sin, cos) = (Double::from(300.0) + Double::from(1e-15)).sin_cos_degrees();
        assert_near(sin * sin + cos * cos, Double::ONE);
        assert_near(cos, Double { hi: 0.5, lo: 1.5114994701951816e-17 });
    }

    #[test]
    fn logarithms_have_thirty_digits() {
        assert_near(Double::from(2.0).ln(), LN_2);
        assert_near(Double::from(1024.0).ln(), LN_2 * 10.0);
        // The smallest number of f64 is 2^−1074.
        assert_near(Double::from(5e-324).ln(), LN_2 * -1074.0);
        assert_near(Double::from(0.7).ln(), Double { hi: -0.35667494393873245, lo: 4.82556379937662e-18 });
        // 1 + 1e-5 leaves five digits fewer to w.
        let small = Double::from(1e-5).ln_1p() - Double { hi: 9.999950000333332e-06, lo: -2.3868637284493416e-22 };
        assert!(small.hi.abs() < 1e-31, "{small:?}");
    }

    #[test]
    fn division_undoes_multiplication() {
        let third = Double::ONE / 3.0;
        assert_near(third * 3.0, Double::ONE);
        assert!(third.lo != 0.0);
    }
}
