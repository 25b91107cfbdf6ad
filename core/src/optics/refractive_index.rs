//! The complex refractive index N = n + i k_m.

use crate::optics::shortest;
use serde::{Deserialize, Serialize};

/// Complex refractive index n + i k_m relative to the medium of incidence; fields vary as exp(−iωt).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RefractiveIndex {
    n: f64,
    k_m: f64,
}

/// Why a pair of numbers is no refractive index.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RefractiveIndexError {
    /// n is outside its range.
    #[error("n = {} is outside 0 ≤ n ≤ 1e10", shortest(*.0))]
    N(f64),
    /// k is outside its range.
    #[error("k = {} is outside 0 ≤ k ≤ 1e10", shortest(*.0))]
    K(f64),
    /// A medium without any refractive index.
    #[error("n and k are both 0")]
    Zero,
}

impl RefractiveIndex {
    /// Largest n and k: no medium has a larger one, and the fourth powers of these are far from the end of f64.
    pub const LARGEST: f64 = 1e10;

    /// From the real part n and the imaginary part k_m, both from 0 to [`Self::LARGEST`] and not both 0.
    ///
    /// # Errors
    ///
    /// [`RefractiveIndexError`] where n or k_m lies outside, or both are 0.
    pub fn new(n: f64, k_m: f64) -> Result<Self, RefractiveIndexError> {
        if !(0.0..=Self::LARGEST).contains(&n) {
            Err(RefractiveIndexError::N(n))
        } else if !(0.0..=Self::LARGEST).contains(&k_m) {
            Err(RefractiveIndexError::K(k_m))
        } else if n == 0.0 && k_m == 0.0 {
            Err(RefractiveIndexError::Zero)
        } else {
            Ok(Self { n, k_m })
        }
    }

    /// Refractive index n, the real part.
    #[must_use]
    pub fn n(self) -> f64 {
        self.n
    }

    /// Extinction coefficient k_m, the imaginary part.
    #[must_use]
    pub fn k_m(self) -> f64 {
        self.k_m
    }

    /// Whether light does not see the surface at all: N = 1.
    #[must_use]
    pub fn is_vacuum(self) -> bool {
        self.n == 1.0 && self.k_m == 0.0
    }
}
