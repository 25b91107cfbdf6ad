//! Numbers that carry their derivatives by up to nine unknowns: a model written once gives its gradient too.

#![allow(clippy::suspicious_arithmetic_impl, reason = "the rules of differentiation mix the operations")]

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its derivatives.
#[derive(Debug, Clone, Copy)]
pub struct Dual {
    pub value: f64,
    pub by: [f64; 9],
}

impl Dual {
    /// The unknown of that number.
    pub fn unknown(value: f64, number: usize) -> Self {
        let mut by = [0.0; 9];
        by[number] = 1.0;
        Self { value, by }
    }

    /// A function of it, given the function's value and slope.
    fn map(self, value: f64, slope: f64) -> Self {
        Self { value, by: self.by.map(|d| slope * d) }
    }

    pub fn exp(self) -> Self {
        let value = libm::exp(self.value);
        self.map(value, value)
    }

    pub fn ln(self) -> Self {
        self.map(libm::log(self.value), 1.0 / self.value)
    }

    pub fn cos(self) -> Self {
        self.map(libm::cos(self.value), -libm::sin(self.value))
    }

    pub fn sin(self) -> Self {
        self.map(libm::sin(self.value), libm::cos(self.value))
    }

    pub fn atan(self) -> Self {
        self.map(libm::atan(self.value), 1.0 / (1.0 + self.value * self.value))
    }

    /// This to that power.
    pub fn pow(self, exponent: Self) -> Self {
        (self.ln() * exponent).exp()
    }
}

impl From<f64> for Dual {
    fn from(value: f64) -> Self {
        Self { value, by: [0.0; 9] }
    }
}

impl<T: Into<Self>> Add<T> for Dual {
    type Output = Self;
    fn add(self, other: T) -> Self {
        let other = other.into();
        Self { value: self.value + other.value, by: std::array::from_fn(|j| self.by[j] + other.by[j]) }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(-self.value, -1.0)
    }
}

impl<T: Into<Self>> Sub<T> for Dual {
    type Output = Self;
    fn sub(self, other: T) -> Self {
        self + -other.into()
    }
}

impl<T: Into<Self>> Mul<T> for Dual {
    type Output = Self;
    fn mul(self, other: T) -> Self {
        let other = other.into();
        let by = std::array::from_fn(|j| self.by[j] * other.value + self.value * other.by[j]);
        Self { value: self.value * other.value, by }
    }
}

impl<T: Into<Self>> Div<T> for Dual {
    type Output = Self;
    fn div(self, other: T) -> Self {
        let other = other.into();
        let value = self.value / other.value;
        Self { value, by: std::array::from_fn(|j| (self.by[j] - value * other.by[j]) / other.value) }
    }
}
