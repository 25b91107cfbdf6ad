//! Where a descent from one start ended: of any least squares problem, and of a fit.

use crate::fit::observer::TracePoint;
use crate::fit::stop_reason::StopReason;
use crate::model::Parameters;
use nalgebra::DVector;

/// Where a minimisation of a sum of squares ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The best unknowns seen.
    pub x: DVector<f64>,
    /// Sum of squares there; infinite if none was finite.
    pub sum_of_squares: f64,
    /// Why it ended.
    pub stop_reason: StopReason,
    /// Residual evaluations.
    pub evaluations: usize,
    /// The improvements, in their order.
    pub trace: Vec<TracePoint>,
    /// The unknowns at each improvement.
    pub path: Vec<DVector<f64>>,
}

/// Where a fit from one start ended, with the parameters of one surface or of several.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalFit<T = Parameters> {
    /// The best parameters seen.
    pub parameters: T,
    /// Sum of squares of the residuals there, [`crate::fit::Problem::sum_of_squares`]; infinite if none was finite.
    pub sum_of_squares: f64,
    /// Why it ended.
    pub stop_reason: StopReason,
    /// Residual evaluations.
    pub evaluations: usize,
    /// The improvements, in their order.
    pub trace: Vec<TracePoint>,
    /// The parameters at each improvement.
    pub path: Vec<T>,
}

impl<T> LocalFit<T> {
    /// This descent and a further one that began at its end.
    pub(crate) fn followed_by(mut self, further: Self) -> Self {
        self.append(further);
        self
    }

    /// Appends a further descent that began at the end of this one.
    pub(crate) fn append(&mut self, further: Self) {
        let so_far = self.evaluations;
        let shifted = further.trace.into_iter().map(|point| TracePoint { evaluations: so_far + point.evaluations, ..point });
        let last = self.trace.last().map_or(f64::INFINITY, |point| point.objective);
        for (point, parameters) in shifted.zip(further.path).filter(|(point, _)| point.objective < last) {
            self.trace.push(point);
            self.path.push(parameters);
        }
        self.evaluations += further.evaluations;
        if further.sum_of_squares <= self.sum_of_squares {
            self.parameters = further.parameters;
            self.sum_of_squares = further.sum_of_squares;
            self.stop_reason = further.stop_reason;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LocalFit, StopReason, TracePoint};
    use crate::model::Parameters;

    fn local_fit(objectives: [f64; 2]) -> LocalFit {
        let at = |n: f64| Parameters { n, ..Parameters::default() };
        let point = |(evaluations, objective)| TracePoint { elapsed_ms: 0.0, evaluations, objective };
        LocalFit {
            parameters: at(objectives[1]),
            sum_of_squares: objectives[1],
            stop_reason: StopReason::Converged,
            evaluations: 10,
            trace: (1..).zip(objectives).map(point).collect(),
            path: objectives.map(at).to_vec(),
        }
    }

    #[test]
    fn an_appended_descent_adds_its_improvements_with_their_parameters() {
        let mut whole = local_fit([4.0, 2.0]);
        // The first point of the further descent is where the one before ended, or worse.
        whole.append(local_fit([3.0, 1.0]));
        let objectives: Vec<f64> = whole.trace.iter().map(|point| point.objective).collect();
        let path: Vec<f64> = whole.path.iter().map(|parameters| parameters.n).collect();
        assert_eq!((objectives, path), (vec![4.0, 2.0, 1.0], vec![4.0, 2.0, 1.0]));
        assert_eq!((whole.trace[2].evaluations, whole.evaluations), (12, 20));
    }
}
