//! The coordinates of a sampler: a map to ones in which the density has about unit covariance and straight valleys.
//!
//! With the eigenvectors of the covariance as columns of B, each times its standard deviation, the widest first, `u = center + B w`. The
//! unit matrix as mass matrix in w is the dense mass matrix of the inverse covariance in u. Beyond that, a narrow coordinate follows
//! the wide ones: [`crate::fit::posterior::bend`]. The volume that the map changes by is constant. The sampler moves in z.

use crate::fit::posterior::bend::Bend;
use crate::fit::posterior::log_density::LogDensity;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Weight of the covariance of the map before, in draws, and what it is multiplied by (as Stan shrinks towards the unit matrix).
const PRIOR_DRAWS: f64 = 5.0;
const PRIOR_VARIANCE: f64 = 1e-3;
/// Curvatures of a first map lie above this: the coordinates of bounded parameters have variances of the order of 3.
const SMALLEST_CURVATURE: f64 = 0.2;
/// Step of the differences that give curvatures.
const DIFFERENCE: f64 = 1e-4;
/// Draws for each term of a cubic, at least.
const DRAWS_PER_TERM: usize = 10;

/// A map from whitened coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Metric {
    center: Vec<f64>,
    /// B, row by row.
    axes: Vec<f64>,
    /// How each w_j is made; none where w = z.
    bends: Vec<Bend>,
}

impl Metric {
    /// From a center and a covariance; none where the covariance is not positive definite.
    fn new(center: Vec<f64>, covariance: &DMatrix<f64>) -> Option<Self> {
        // The decomposition of a matrix that is not finite does not terminate.
        if center.iter().chain(covariance.iter()).any(|element| !element.is_finite()) {
            return None;
        }
        // Equilibrated, so that a narrow coordinate beside a wide one keeps its digits.
        let scales: Vec<f64> = (0..center.len()).map(|i| covariance[(i, i)].sqrt()).collect();
        let correlation = DMatrix::from_fn(center.len(), center.len(), |i, j| covariance[(i, j)] / (scales[i] * scales[j]));
        if correlation.iter().any(|element| !element.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::new(correlation);
        let mut order: Vec<usize> = (0..center.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        if eigen.eigenvalues.iter().any(|&variance| variance <= 0.0) {
            return None;
        }
        let axis = |i: usize, j: usize| scales[i] * eigen.eigenvectors[(i, j)] * eigen.eigenvalues[j].sqrt();
        let axes = (0..center.len()).flat_map(|i| order.iter().map(move |&j| (i, j))).map(|(i, j)| axis(i, j)).collect();
        Some(Self { center, axes, bends: Vec::new() })
    }

    /// From the curvature of a density around a point; curvatures that are small or of the wrong sign are raised.
    pub(crate) fn of_curvature(density: &mut impl LogDensity, at: &[f64]) -> Option<Self> {
        let dimension = at.len();
        let mut curvature = DMatrix::zeros(dimension, dimension);
        let (mut there, mut above, mut below) = (at.to_vec(), vec![0.0; dimension], vec![0.0; dimension]);
        for j in 0..dimension {
            there[j] = at[j] + DIFFERENCE;
            density.value_and_gradient(&there, &mut above);
            there[j] = at[j] - DIFFERENCE;
            density.value_and_gradient(&there, &mut below);
            there[j] = at[j];
            for i in 0..dimension {
                curvature[(i, j)] = (below[i] - above[i]) / (2.0 * DIFFERENCE);
            }
        }
        let symmetric = 0.5 * (&curvature + curvature.transpose());
        if symmetric.iter().any(|element| !element.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::new(symmetric);
        let variances = eigen.eigenvalues.map(|curvature| 1.0 / curvature.abs().max(SMALLEST_CURVATURE));
        let covariance = &eigen.eigenvectors * DMatrix::from_diagonal(&variances) * eigen.eigenvectors.transpose();
        Self::new(at.to_vec(), &covariance)
    }

    /// From draws, shrunk a little towards the map before; none where they are too few or do not spread.
    pub(crate) fn of_draws(&self, draws: &[Vec<f64>]) -> Option<Self> {
        let dimension = self.center.len();
        if draws.len() < 2 * dimension {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
        let count = draws.len() as f64;
        let mean = draws.iter().fold(DVector::zeros(dimension), |sum, draw| sum + DVector::from_column_slice(draw)) / count;
        let mut covariance = DMatrix::zeros(dimension, dimension);
        for draw in draws {
            let off = DVector::from_column_slice(draw) - &mean;
            covariance.ger(1.0 / (count - 1.0), &off, &off, 1.0);
        }
        let axes = DMatrix::from_row_slice(dimension, dimension, &self.axes);
        let prior = &axes * axes.transpose() * PRIOR_VARIANCE;
        let shrunk = (covariance * count + prior * PRIOR_DRAWS) / (count + PRIOR_DRAWS);
        let mut metric = Self::new(mean.as_slice().to_vec(), &shrunk)?;
        if draws.len() >= DRAWS_PER_TERM * Bend::terms(dimension.saturating_sub(1)) {
            let points: Option<Vec<Vec<f64>>> = draws.iter().map(|draw| metric.unbent(draw)).collect();
            metric.bends = points.and_then(|points| Bend::fit_all(&points)).unwrap_or_default();
        }
        Some(metric)
    }

    /// Writes u of a z, and w.
    fn to_density_with(&self, z: &[f64], w: &mut [f64], u: &mut [f64]) {
        w.copy_from_slice(z);
        for (j, bend) in self.bends.iter().enumerate() {
            let (before, rest) = w.split_at_mut(j);
            rest[0] = bend.apply(before, rest[0]);
        }
        for ((slot, center), axes) in u.iter_mut().zip(&self.center).zip(self.axes.chunks(z.len())) {
            *slot = center + axes.iter().zip(&*w).map(|(axis, w)| axis * w).sum::<f64>();
        }
    }

    /// Writes u of a z.
    pub(crate) fn to_density(&self, z: &[f64], u: &mut [f64]) {
        self.to_density_with(z, &mut vec![0.0; z.len()], u);
    }

    /// Logarithm of the volume of u per volume of z.
    pub(crate) fn log_volume(&self) -> f64 {
        let dimension = self.center.len();
        let axes = DMatrix::from_row_slice(dimension, dimension, &self.axes);
        libm::log(axes.determinant().abs()) + self.bends.iter().map(Bend::log_scale).sum::<f64>()
    }

    /// The w of a u; none where rounding makes B singular.
    fn unbent(&self, u: &[f64]) -> Option<Vec<f64>> {
        let axes = DMatrix::from_row_slice(u.len(), u.len(), &self.axes);
        let off = DVector::from_iterator(u.len(), u.iter().zip(&self.center).map(|(u, center)| u - center));
        axes.lu().solve(&off).map(|w| w.as_slice().to_vec())
    }

    /// The z of a u; none where rounding makes B singular.
    pub(crate) fn to_whitened(&self, u: &[f64]) -> Option<Vec<f64>> {
        let w = self.unbent(u)?;
        if self.bends.is_empty() {
            return Some(w);
        }
        Some(self.bends.iter().enumerate().map(|(j, bend)| bend.invert(&w[..j], w[j])).collect())
    }

    /// Writes the gradient by z.
    fn pull_back(&self, w: &[f64], by_u: &[f64], by_z: &mut [f64]) {
        by_z.fill(0.0);
        for (&slope, axes) in by_u.iter().zip(self.axes.chunks(w.len())) {
            by_z.iter_mut().zip(axes).for_each(|(slot, axis)| *slot += axis * slope);
        }
        for (j, bend) in self.bends.iter().enumerate().rev() {
            let (before, rest) = by_z.split_at_mut(j);
            rest[0] = bend.pull_back(&w[..j], rest[0], before);
        }
    }
}

/// A density in the coordinates of a metric.
pub(crate) struct Whitened<'a, D> {
    density: &'a mut D,
    metric: &'a Metric,
    u: Vec<f64>,
    w: Vec<f64>,
    by_u: Vec<f64>,
    /// How often value and gradient were evaluated.
    pub(crate) evaluations: usize,
}

impl<'a, D: LogDensity> Whitened<'a, D> {
    pub(crate) fn new(density: &'a mut D, metric: &'a Metric) -> Self {
        let zeros = || vec![0.0; metric.center.len()];
        Self { density, metric, u: zeros(), w: zeros(), by_u: zeros(), evaluations: 0 }
    }
}

impl<D: LogDensity> LogDensity for Whitened<'_, D> {
    fn dimension(&self) -> usize {
        self.u.len()
    }

    fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
        self.evaluations += 1;
        self.metric.to_density_with(at, &mut self.w, &mut self.u);
        let value = self.density.value_and_gradient(&self.u, &mut self.by_u);
        self.metric.pull_back(&self.w, &self.by_u, gradient);
        value
    }
}
