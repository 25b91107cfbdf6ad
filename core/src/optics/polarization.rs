//! Stokes vectors and Mueller matrices.
//!
//! A Stokes vector means nothing without its basis: here [E_s, E_p] with s = k × n and p = k × s for a ray
//! along k, so that S1 = I_s − I_p, S2 = 2 Re(E_s E_p*), S3 = −2 Im(E_s E_p*). Indices run from 0 to 3 as in F00, F10.
//! Signs agree with NIST's SCATMECH.

use crate::optics::{Fresnel, Rotation};
use nalgebra::{Complex, Matrix4, Vector4};
use std::f64::consts::PI;

/// A Stokes vector (S0, S1, S2, S3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stokes(pub Vector4<f64>);

impl Stokes {
    /// Unpolarised light of unit radiance.
    pub const UNPOLARISED: Self = Self(Vector4::new(1.0, 0.0, 0.0, 0.0));

    /// Degree of linear polarisation, `√(S1² + S2²)/S0`; 0 without light.
    #[must_use]
    pub fn dolp(self) -> f64 {
        if self.0[0] > 0.0 { libm::hypot(self.0[1], self.0[2]) / self.0[0] } else { 0.0 }
    }

    /// Angle of polarisation in degrees, 0 to 180, from the first vector of the basis towards the second; none where nothing is polarised.
    #[must_use]
    pub fn angle(self) -> Option<f64> {
        angle_of_polarisation(self.0[1], self.0[2])
    }
}

/// `½ atan2(S2, S1)` in degrees, 0 to 180; none where both are 0.
pub(crate) fn angle_of_polarisation(s1: f64, s2: f64) -> Option<f64> {
    let angle = libm::atan2(s2, s1) * (90.0 / PI);
    // Rounding takes what is barely below 0 to 180.
    (s1 != 0.0 || s2 != 0.0).then(|| if angle < 0.0 { (angle + 180.0) % 180.0 } else { angle % 180.0 })
}

/// A Mueller matrix: how a reflection changes a Stokes vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mueller(pub Matrix4<f64>);

impl Mueller {
    /// Specular reflection at a facet, both rays in the facet's own plane of incidence.
    #[must_use]
    pub fn fresnel(fresnel: &Fresnel) -> Self {
        let mean = fresnel.mean();
        let difference = mean * fresnel.dolp();
        let (re, im) = fresnel.cross();
        Self(Matrix4::new(
            mean, difference, 0.0, 0.0, //
            difference, mean, 0.0, 0.0, //
            0.0, 0.0, re, im, //
            0.0, 0.0, -im, re,
        ))
    }

    /// Turns the polarisation basis by η: S1' = S1 cos 2η + S2 sin 2η, S2' = −S1 sin 2η + S2 cos 2η.
    #[must_use]
    pub fn rotator(rotation: Rotation) -> Self {
        let (c, s) = rotation.double_angle();
        Self(Matrix4::new(
            1.0, 0.0, 0.0, 0.0, //
            0.0, c, s, 0.0, //
            0.0, -s, c, 0.0, //
            0.0, 0.0, 0.0, 1.0,
        ))
    }

    /// A depolariser: passes on radiance, forgets polarisation. Only m00 is not 0.
    #[must_use]
    pub fn depolarizer(m00: f64) -> Self {
        let mut matrix = Matrix4::zeros();
        matrix[(0, 0)] = m00;
        Self(matrix)
    }

    /// Element by row and column, 0 to 3.
    #[must_use]
    pub fn element(&self, row: usize, column: usize) -> f64 {
        self.0[(row, column)]
    }

    /// The smallest eigenvalue of the coherency matrix `H = ¼ Σ m_jk (σ_j ⊗ σ_k*)`: not negative for a matrix that some optical system has (Cloude,
    /// Optik 75, 26 (1986)). With S3 = −2 Im(E_s E_p*) σ_3 stands the other way round than usual.
    #[must_use]
    pub fn smallest_coherency_eigenvalue(&self) -> f64 {
        let (zero, one, i) = (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0), Complex::new(0.0, 1.0));
        let pauli = [[[one, zero], [zero, one]], [[one, zero], [zero, -one]], [[zero, one], [one, zero]], [[zero, i], [-i, zero]]];
        let coherency = Matrix4::from_fn(|a, b| {
            let mut sum = zero;
            for j in 0..4 {
                for k in 0..4 {
                    let element = self.element(j, k);
                    if element != 0.0 {
                        sum += pauli[j][a / 2][b / 2] * pauli[k][a % 2][b % 2].conj() * element;
                    }
                }
            }
            sum * 0.25
        });
        coherency.symmetric_eigenvalues().min()
    }

    /// What becomes of a Stokes vector.
    #[must_use]
    pub fn apply(&self, stokes: Stokes) -> Stokes {
        Stokes(self.0 * stokes.0)
    }
}

impl std::ops::Mul for Mueller {
    type Output = Self;

    fn mul(self, right: Self) -> Self {
        Self(self.0 * right.0)
    }
}

impl std::ops::Mul<f64> for Mueller {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl std::ops::Add for Mueller {
    type Output = Self;

    fn add(self, right: Self) -> Self {
        Self(self.0 + right.0)
    }
}
