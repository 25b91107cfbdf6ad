//! The objective over a grid of two parameters, the others where they are: where minima lie, and how flat the valley is.
//!
//! The number at a node is ΔE of Eq. (18), as [`Problem::delta_e`] has it, or what the problem's own choices minimise. Where that is ΔE
//! itself (no weights, squares, absolute differences) both are the same. The batch kernel evaluates the rows of data; only ΔE under other
//! choices goes through the problem node by node. Masked rows play no part in either.

use crate::fit::objective::Problem;
use crate::model::{Parameter, Parameters};

/// One side of a landscape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandscapeAxis {
    /// What changes along it.
    pub parameter: Parameter,
    /// The first value.
    pub low: f64,
    /// The last value.
    pub high: f64,
    /// How many values.
    pub count: usize,
    /// In equal ratios instead of equal steps; both ends are then above 0.
    pub logarithmic: bool,
}

impl LandscapeAxis {
    /// The values along it, both ends included.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        (0..self.count).map(|index| self.value(index)).collect()
    }

    fn value(&self, index: usize) -> f64 {
        let last = self.count.saturating_sub(1).max(1);
        #[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
        let fraction = index as f64 / last as f64;
        if index == 0 {
            self.low
        } else if index == last {
            self.high
        } else if self.logarithmic {
            self.low * libm::exp(fraction * libm::log(self.high / self.low))
        } else {
            self.low + fraction * (self.high - self.low)
        }
    }
}

/// The objective over two parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Landscape {
    /// Along a row.
    pub across: LandscapeAxis,
    /// From row to row.
    pub up: LandscapeAxis,
    /// The objective, row by row; NaN where the parameters are no surface or nothing is measured.
    pub objective: Vec<f64>,
}

impl Landscape {
    /// ΔE of a problem around its start; none if it is cancelled. The rows are shared among threads.
    #[must_use]
    pub fn new(problem: &Problem, across: LandscapeAxis, up: LandscapeAxis, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        Self::of(problem, Height::DeltaE, across, up, cancelled)
    }

    /// The same of what the problem minimises, [`Problem::sum_of_squares`].
    #[must_use]
    pub fn minimised(problem: &Problem, across: LandscapeAxis, up: LandscapeAxis, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        Self::of(problem, Height::Minimised, across, up, cancelled)
    }

    fn of(
        problem: &Problem,
        height: Height,
        across: LandscapeAxis,
        up: LandscapeAxis,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Option<Self> {
        let columns = across.values();
        let row = |value: f64| {
            if cancelled() {
                return None;
            }
            let mut parameters = *problem.start();
            parameters[up.parameter] = value;
            Some(height.row(problem, parameters, across.parameter, &columns))
        };
        let rows = map_rows(&up.values(), &row).into_iter().collect::<Option<Vec<_>>>()?;
        Some(Self { across, up, objective: rows.concat() })
    }

    /// The lowest node: along a row, from row to row; none where no node has a value.
    #[must_use]
    pub fn lowest(&self) -> Option<(usize, usize)> {
        let finite = self.objective.iter().enumerate().filter(|(_, objective)| objective.is_finite());
        finite.min_by(|a, b| a.1.total_cmp(b.1)).map(|(index, _)| (index % self.across.count, index / self.across.count))
    }
}

/// What the numbers at the nodes are.
#[derive(Clone, Copy, PartialEq)]
enum Height {
    DeltaE,
    Minimised,
}

impl Height {
    fn row(self, problem: &Problem, mut parameters: Parameters, across: Parameter, columns: &[f64]) -> Vec<f64> {
        if self == Self::Minimised || problem.minimises_delta_e() {
            return problem.sums_of_squares_along(&parameters, across, columns);
        }
        let mut node = |value: f64| {
            parameters[across] = value;
            problem.delta_e(&parameters).filter(|objective| objective.is_finite()).unwrap_or(f64::NAN)
        };
        columns.iter().map(|&value| node(value)).collect()
    }
}

/// One row of nodes for each value, on all threads.
fn map_rows<T: Send>(values: &[f64], of: &(dyn Fn(f64) -> T + Sync)) -> Vec<T> {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        values.par_iter().map(|&value| of(value)).collect()
    }
    #[cfg(not(feature = "threads"))]
    values.iter().map(|&value| of(value)).collect()
}
