//! How a narrow coordinate follows wider ones: its mean is a cubic of them, fitted to draws.

use nalgebra::{DMatrix, DVector};

/// Coordinates that the mean depends on, at most: the widest.
const WIDEST: usize = 8;
/// Size, in standard deviations, that is seen of a coordinate at most, so that the mean goes on evenly beyond the draws.
const REACH: f64 = 4.0;
/// Ridge of the regression, in draws.
const RIDGE: f64 = 1.0;

/// `w = mean(wider coordinates) + scale z`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bend {
    scale: f64,
    /// Of 1, then for each i of h_i, h_i³, and of h_i h_j for j ≤ i.
    mean: Vec<f64>,
}

/// A coordinate as the mean sees it, h, and its derivative.
fn limited(w: f64) -> (f64, f64) {
    let over = 1.0 / (1.0 + (w / REACH) * (w / REACH));
    let root = over.sqrt();
    (w * root, over * root)
}

impl Bend {
    /// Of each coordinate by those before it; none where a regression is singular.
    pub(crate) fn fit_all(points: &[Vec<f64>]) -> Option<Vec<Self>> {
        (0..points.first()?.len()).map(|j| Self::fit(points, j)).collect()
    }

    fn fit(points: &[Vec<f64>], coordinate: usize) -> Option<Self> {
        let count = Self::terms(coordinate);
        let mut normal = DMatrix::identity(count, count) * RIDGE;
        let mut right = DVector::zeros(count);
        let rows: Vec<DVector<f64>> = points.iter().map(|point| mean_terms(&point[..coordinate])).collect();
        for (row, point) in rows.iter().zip(points) {
            normal.ger(1.0, row, row, 1.0);
            right.axpy(point[coordinate], row, 1.0);
        }
        let mean = normal.cholesky()?.solve(&right);
        let left: f64 = rows.iter().zip(points).map(|(row, point)| (point[coordinate] - row.dot(&mean)).powi(2)).sum();
        #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
        let scale = (left / points.len().saturating_sub(count) as f64).sqrt();
        (scale > 0.0 && scale.is_finite()).then(|| Self { scale, mean: mean.as_slice().to_vec() })
    }

    /// Number of terms with so many wider coordinates.
    pub(crate) fn terms(wider: usize) -> usize {
        let wider = wider.min(WIDEST);
        1 + 2 * wider + wider * (wider + 1) / 2
    }

    /// Logarithm of a change of w per change of z.
    pub(crate) fn log_scale(&self) -> f64 {
        libm::log(self.scale)
    }

    /// w of a z.
    pub(crate) fn apply(&self, wider: &[f64], z: f64) -> f64 {
        self.mean_at(wider) + self.scale * z
    }

    /// z of a w.
    pub(crate) fn invert(&self, wider: &[f64], w: f64) -> f64 {
        (w - self.mean_at(wider)) / self.scale
    }

    fn mean_at(&self, wider: &[f64]) -> f64 {
        let mut h = [0.0; WIDEST];
        let mut mean = self.mean[0];
        let mut coefficients = self.mean[1..].iter();
        let mut next = || coefficients.next().copied().unwrap_or(0.0);
        for (i, &w) in wider.iter().take(WIDEST).enumerate() {
            h[i] = limited(w).0;
            mean += h[i] * (next() + h[i] * h[i] * next());
            mean += h[i] * h[..=i].iter().map(|other| other * next()).sum::<f64>();
        }
        mean
    }

    /// Adds to the derivatives by the wider coordinates, given that by w; returns that by z.
    pub(crate) fn pull_back(&self, wider: &[f64], by_w: f64, by_wider: &mut [f64]) -> f64 {
        let mut h = [(0.0, 0.0); WIDEST];
        let mut by_h = [0.0; WIDEST];
        let mut coefficients = self.mean[1..].iter();
        let mut next = || coefficients.next().copied().unwrap_or(0.0);
        for (i, &w) in wider.iter().take(WIDEST).enumerate() {
            h[i] = limited(w);
            let at = h[i].0;
            by_h[i] += next() + 3.0 * at * at * next();
            for j in 0..=i {
                let coefficient = next();
                by_h[i] += coefficient * h[j].0;
                by_h[j] += coefficient * at;
            }
        }
        for ((slot, by_h), (_, slope)) in by_wider.iter_mut().zip(by_h).zip(h) {
            *slot += by_w * by_h * slope;
        }
        by_w * self.scale
    }
}

/// Terms of the mean, 1 first.
fn mean_terms(wider: &[f64]) -> DVector<f64> {
    let h: Vec<f64> = wider.iter().take(WIDEST).map(|&w| limited(w).0).collect();
    let of = |i: usize| [h[i], h[i] * h[i] * h[i]].into_iter().chain(h[..=i].iter().map(|other| other * h[i]).collect::<Vec<_>>());
    DVector::from_iterator(Bend::terms(h.len()), std::iter::once(1.0).chain((0..h.len()).flat_map(of)))
}

#[cfg(test)]
mod tests {
    use super::{Bend, mean_terms};
    use crate::measurement::Deviates;

    /// The third coordinate follows a product of the first two.
    fn points() -> Vec<Vec<f64>> {
        let mut deviates = Deviates::new(1);
        let mut point = || {
            let ((a, b), (c, _)) = (deviates.pair(), deviates.pair());
            vec![a, b, 0.3 * a * b + 0.1 * c]
        };
        (0..4000).map(|_| point()).collect()
    }

    #[test]
    fn a_bend_is_found_and_undone() {
        let points = points();
        let bends = Bend::fit_all(&points).expect("regular");
        // h falls short of w by 1/32 of its cube: at one standard deviation the mean is told within a tenth.
        for (a, b) in [(0.0, 0.0), (1.0, -1.0), (-1.0, 0.5)] {
            let mean = bends[2].mean_at(&[a, b]);
            assert!((mean - 0.3 * a * b).abs() < 0.03, "{a} {b}: {mean}");
        }
        assert!((bends[2].scale - 0.1).abs() < 0.05, "{}", bends[2].scale);
        for point in &points {
            let z = bends[2].invert(&point[..2], point[2]);
            assert!((bends[2].apply(&point[..2], z) - point[2]).abs() < 1e-12);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_map() {
        const STEP: f64 = 1e-5;
        let bend = Bend::fit_all(&points()).expect("regular").remove(2);
        assert_eq!(mean_terms(&[1.0, 2.0]).len(), Bend::terms(2));
        for wider in [[0.3, -1.2], [5.0, 2.0], [-0.1, 0.0]] {
            let mut by_wider = [0.0; 2];
            let by_z = bend.pull_back(&wider, 1.0, &mut by_wider);
            assert!((bend.apply(&wider, 1.0) - bend.apply(&wider, 0.0) - by_z).abs() < 1e-12);
            for i in 0..2 {
                let at = |h: f64| {
                    let mut there = wider;
                    there[i] += h;
                    bend.apply(&there, 0.7)
                };
                // h² of a third derivative of order 1, and rounding over h.
                let expected = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                assert!((expected - by_wider[i]).abs() < 1e-9, "{wider:?} {i}: {} instead of {expected}", by_wider[i]);
            }
        }
    }
}
