//! The residuals as a surface over the coordinates of the unknowns that move, and steps of a geodesic on it.

use crate::fit::estimate::Edge;
use crate::fit::fit_problem::{FitProblem, UnknownName as _};
use crate::fit::intervals::linear::RANK_THRESHOLD;
use crate::fit::local::reparametrisation::origin;
use nalgebra::{DMatrix, DVector, SVD};

/// Half the distance of the two Jacobians that r″ is the difference of: their rounding over it and its square times a fourth derivative
/// are both about 1e-10.
const HALF_STEP: f64 = 1e-5;
/// Error of a step in u and in its direction, at most.
const TOLERANCE: f64 = 1e-5;
/// Longest step: a path is drawn point by point.
pub(super) const LONGEST_STEP: f64 = 0.05;
/// Shortest step: where it does not suffice, the line bends too sharply to be followed.
const SHORTEST_STEP: f64 = 1e-9;
/// Unit of a coordinate without a logarithm, at least.
const LEAST_UNIT: f64 = 0.1;

/// A step that was taken.
pub(super) struct Advanced {
    pub at: DVector<f64>,
    pub heading: DVector<f64>,
    pub length: f64,
}

/// The residuals over the coordinates of the unknowns that move.
pub(super) struct Manifold<'a, P> {
    problem: &'a P,
    /// All unknowns at the beginning.
    x: DVector<f64>,
    pub moving: Vec<usize>,
    /// Origin of the logarithm, or none, and the unit of each moving coordinate.
    scales: Vec<(Option<f64>, f64)>,
}

impl<'a, P: FitProblem> Manifold<'a, P> {
    pub fn new(problem: &'a P, x: DVector<f64>, moving: Vec<usize>) -> Self {
        let scale = |&j: &usize| match origin(problem.names()[j].parameter()) {
            Some(origin) => (Some(origin), 1.0),
            None => (None, x[j].abs().max(LEAST_UNIT)),
        };
        let scales = moving.iter().map(scale).collect();
        Self { problem, x, moving, scales }
    }

    fn coordinate(&self, i: usize, value: f64) -> f64 {
        let (origin, unit) = self.scales[i];
        origin.map_or(value / unit, |origin| libm::log(value - origin))
    }

    pub fn start(&self) -> DVector<f64> {
        DVector::from_iterator(self.moving.len(), self.moving.iter().enumerate().map(|(i, &j)| self.coordinate(i, self.x[j])))
    }

    /// All unknowns.
    pub fn unknowns(&self, u: &DVector<f64>) -> DVector<f64> {
        let mut x = self.x.clone();
        for (i, &j) in self.moving.iter().enumerate() {
            let (origin, unit) = self.scales[i];
            let (low, high) = self.problem.bounds_of(j);
            // Rounding may lead past a bound.
            x[j] = origin.map_or(u[i] * unit, |origin| origin + libm::exp(u[i])).clamp(low, high);
        }
        x
    }

    pub fn sum_of_squares(&self, u: &DVector<f64>) -> f64 {
        self.problem.sum_of_squares_at(&self.unknowns(u)).unwrap_or(f64::NAN)
    }

    /// ∂r/∂u.
    pub fn jacobian(&self, u: &DVector<f64>) -> Option<DMatrix<f64>> {
        let x = self.unknowns(u);
        let (_, by_all) = self.problem.linearised_at(&x)?;
        let slope = |i: usize| {
            let (origin, unit) = self.scales[i];
            origin.map_or(unit, |origin| x[self.moving[i]] - origin)
        };
        Some(DMatrix::from_fn(by_all.nrows(), self.moving.len(), |row, i| by_all[(row, self.moving[i])] * slope(i)))
    }

    /// The direction of the smallest singular value, and how many are above rounding.
    pub fn weakest(&self, u: &DVector<f64>) -> Option<(DVector<f64>, usize)> {
        let jacobian = self.jacobian(u)?;
        let (rows, columns) = jacobian.shape();
        // Rows of zeros make a wide matrix square, so that the thin decomposition has all of V.
        let square = jacobian.resize_vertically(rows.max(columns), 0.0);
        let svd = SVD::new(square, false, true);
        let v_t = svd.v_t?;
        let largest = svd.singular_values.max();
        let rank = svd.singular_values.iter().filter(|value| **value > RANK_THRESHOLD * largest).count();
        let (weakest, _) = svd.singular_values.argmin();
        Some((v_t.row(weakest).transpose(), rank))
    }

    /// The geodesic's ü for a u̇ of length 1.
    pub fn acceleration(&self, u: &DVector<f64>, heading: &DVector<f64>) -> Option<DVector<f64>> {
        let [after, before] = [HALF_STEP, -HALF_STEP].map(|h| Some(self.jacobian(&(u + heading * h))? * heading));
        let bend = (after? - before?) / (2.0 * HALF_STEP);
        let jacobian = self.jacobian(u)?;
        let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
        let inverse = |i: usize| if lengths[i] > 0.0 { 1.0 / lengths[i] } else { 0.0 };
        let scaled = DMatrix::from_fn(jacobian.nrows(), jacobian.ncols(), |row, i| jacobian[(row, i)] * inverse(i));
        let svd = SVD::new(scaled, true, true);
        let cut = RANK_THRESHOLD * svd.singular_values.max();
        let by_scaled = svd.solve(&bend, cut).ok()?;
        Some(DVector::from_fn(heading.len(), |i, _| -by_scaled[i] * inverse(i)))
    }

    /// Whether parameters move faster and faster that way along a direction; where the surface does not bend, whether the next bound is
    /// nearer that way.
    pub fn forward(&self, u: &DVector<f64>, direction: &DVector<f64>) -> Option<bool> {
        let along = self.acceleration(u, direction)?.dot(direction);
        let nearer = || self.to_bound(u, direction).0 <= self.to_bound(u, &-direction).0;
        Some(if along.abs() < f64::EPSILON.sqrt() { nearer() } else { along > 0.0 })
    }

    /// How the direction turns: ü at right angles to it.
    fn turning(&self, u: &DVector<f64>, heading: &DVector<f64>) -> Option<DVector<f64>> {
        let unit = heading.normalize();
        let acceleration = self.acceleration(u, &unit)?;
        Some(&acceleration - &unit * acceleration.dot(&unit))
    }

    /// How far the first bound is straight ahead, and whose it is.
    pub fn to_bound(&self, u: &DVector<f64>, heading: &DVector<f64>) -> (f64, (usize, Edge)) {
        let mut nearest = (f64::INFINITY, (0, Edge::Upper));
        for (i, &j) in self.moving.iter().enumerate() {
            let (low, high) = self.problem.bounds_of(j);
            let (end, edge) = if heading[i] < 0.0 { (low, Edge::Lower) } else { (high, Edge::Upper) };
            let away = (self.coordinate(i, end) - u[i]) / heading[i];
            if away.is_finite() && away < nearest.0 {
                nearest = (away.max(0.0), (i, edge));
            }
        }
        nearest
    }

    /// One step of Bogacki and Shampine's pair of orders 2 and 3 (Appl. Math. Lett. 2, 321 (1989)), shortened until it is good enough
    /// and ends before the bound; the next one's size is left in `step`.
    pub fn advance(&self, u: &DVector<f64>, heading: &DVector<f64>, step: &mut f64, to_bound: f64) -> Option<Advanced> {
        let mut h = step.min(LONGEST_STEP);
        while h >= SHORTEST_STEP {
            // Not past the bound, where there may be no model.
            let tried = h.min(to_bound);
            let Some((at, ahead, error)) = self.tried(u, heading, tried) else {
                h *= 0.25;
                continue;
            };
            if error <= TOLERANCE {
                *step = (tried * (0.9 * libm::cbrt(TOLERANCE / error.max(1e-3 * TOLERANCE))).min(3.0)).min(LONGEST_STEP);
                return Some(Advanced { at, heading: ahead.normalize(), length: tried });
            }
            h = tried * (0.9 * libm::cbrt(TOLERANCE / error)).clamp(0.1, 0.7);
        }
        None
    }

    /// A step of that length: place and direction, and the larger of their errors.
    fn tried(&self, u: &DVector<f64>, v: &DVector<f64>, h: f64) -> Option<(DVector<f64>, DVector<f64>, f64)> {
        let v1 = v;
        let a1 = self.turning(u, v1)?;
        let v2 = v + &a1 * (0.5 * h);
        let a2 = self.turning(&(u + v1 * (0.5 * h)), &v2)?;
        let v3 = v + &a2 * (0.75 * h);
        let a3 = self.turning(&(u + &v2 * (0.75 * h)), &v3)?;
        let at = u + (v1 * (2.0 / 9.0) + &v2 * (1.0 / 3.0) + &v3 * (4.0 / 9.0)) * h;
        let v4 = v + (&a1 * (2.0 / 9.0) + &a2 * (1.0 / 3.0) + &a3 * (4.0 / 9.0)) * h;
        let a4 = self.turning(&at, &v4)?;
        let weights = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];
        let off = |parts: [&DVector<f64>; 4]| {
            parts.into_iter().zip(weights).map(|(part, weight)| part * (weight * h)).sum::<DVector<f64>>().amax()
        };
        let error = off([v1, &v2, &v3, &v4]).max(off([&a1, &a2, &a3, &a4]));
        (error.is_finite() && v4.norm() > 0.0).then_some((at, v4, error))
    }
}
