//! The distinct minima that a multistart search has found.

use crate::fit::local::solution::LocalFit;
use crate::fit::stop_reason::StopReason;
use crate::model::Parameters;

/// One minimum and how many starts led to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Basin<T = Parameters> {
    /// The best descent that ended there.
    pub local_fit: LocalFit<T>,
    /// How many starts ended there.
    pub hits: usize,
}

/// What all starts together have found: at least one minimum.
#[derive(Debug, Clone, PartialEq)]
pub struct MultistartResult<T = Parameters> {
    /// The distinct minima, best first.
    pub(crate) basins: Vec<Basin<T>>,
    /// Residual evaluations of all starts.
    pub(crate) evaluations: usize,
}

/// Minima whose sums of squares differ by less than this fraction are the same: far more than the tolerance of the solver leaves
/// open, far less than data can tell.
pub(crate) const SAME: f64 = 1e-6;
/// Sums of squares that differ by less than this are the same: of noise-free data, rounding alone is left.
pub(crate) const SAME_ABSOLUTE: f64 = 1e-20;

/// Whether two sums of squares are those of one minimum.
pub(crate) fn is_same(value: f64, other: f64) -> bool {
    (value - other).abs() <= (SAME * other.abs()).max(SAME_ABSOLUTE)
}

/// Relative difference of sums of squares that is rounding.
const ROUNDING: f64 = 1e-12;

/// The expected share of starts that end in minima not seen yet, `w(w + 1)/(n(n − 1))` of w distinct minima after n starts (Boender
/// and Kan, Math. Program. 37, 59 (1987)); none after a single start.
pub(crate) fn unseen_share(minima: usize, starts: usize) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "numbers of starts")]
    let (w, n) = (minima as f64, starts as f64);
    (starts > 1).then(|| (w * (w + 1.0) / (n * (n - 1.0))).min(1.0))
}

impl<T> Default for MultistartResult<T> {
    fn default() -> Self {
        Self { basins: Vec::new(), evaluations: 0 }
    }
}

impl<T> MultistartResult<T> {
    /// Of the distinct minima, best first, and the residual evaluations of all starts; none without a minimum.
    #[must_use]
    pub fn new(basins: Vec<Basin<T>>, evaluations: usize) -> Option<Self> {
        (!basins.is_empty()).then_some(Self { basins, evaluations })
    }

    /// The smallest sum of squares; infinite before the first descent.
    pub(crate) fn best(&self) -> f64 {
        self.basins.first().map_or(f64::INFINITY, |basin| basin.local_fit.sum_of_squares)
    }

    /// [`unseen_share`] of these minima.
    pub(crate) fn unseen_share(&self) -> Option<f64> {
        unseen_share(self.basins.len(), self.basins.iter().map(|basin| basin.hits).sum())
    }

    /// Whether the best minimum is at rounding, so that no better one can be.
    pub(crate) fn is_exact(&self) -> bool {
        self.basins.first().is_some_and(|basin| basin.local_fit.stop_reason == StopReason::ResidualsZero)
    }

    /// Adds the descent of one start.
    pub(crate) fn add(&mut self, local_fit: LocalFit<T>) {
        self.evaluations += local_fit.evaluations;
        self.merge(Basin { local_fit, hits: 1 });
    }

    /// Adds the descents of further starts. One that ends in a minimum already found, and no lower, tells nothing.
    pub(crate) fn add_further(&mut self, local_fits: Vec<LocalFit<T>>) {
        for local_fit in local_fits {
            let sum = local_fit.sum_of_squares;
            let is_known = |basin: &Basin<T>| {
                let known = basin.local_fit.sum_of_squares;
                is_same(sum, known) && sum >= known * (1.0 - ROUNDING)
            };
            if self.basins.iter().any(is_known) {
                self.evaluations += local_fit.evaluations;
            } else {
                self.add(local_fit);
            }
        }
    }

    /// Merges a minimum into one already found, or adds it, in the order of sums of squares.
    pub(crate) fn merge(&mut self, new: Basin<T>) {
        let value = new.local_fit.sum_of_squares;
        if let Some(i) = self.basins.iter().position(|basin| is_same(value, basin.local_fit.sum_of_squares)) {
            self.basins[i].hits += new.hits;
            if value < self.basins[i].local_fit.sum_of_squares {
                self.basins[i].local_fit = new.local_fit;
            }
        } else {
            self.basins.push(new);
        }
        self.basins.sort_by(|a, b| a.local_fit.sum_of_squares.total_cmp(&b.local_fit.sum_of_squares));
    }
}
