//! One fit of a benchmark: what is solved, what came of it, and the median of its repetitions.

use crate::fit::Problem;
use crate::model::Parameters;
use crate::selftest::{Timing, quantile};
use nalgebra::DVector;

/// One improvement along a fit: elapsed milliseconds, objective, distance to the truth.
pub(crate) type TraceStep = [f64; 3];

/// How much is fitted, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BenchmarkSize {
    /// Starts of each problem.
    pub starts: u32,
    /// Repetitions of a fit from one start, after one that warms up.
    pub repetitions: usize,
    /// Repetitions of a fit from many starts.
    pub repetitions_of_many: usize,
}

impl BenchmarkSize {
    /// That of the report. Times of a build with debug assertions say little: there one repetition has to do.
    pub(crate) const WHOLE: Self = if cfg!(debug_assertions) {
        Self { starts: 5, repetitions: 1, repetitions_of_many: 1 }
    } else {
        Self { starts: 5, repetitions: 5, repetitions_of_many: 3 }
    };
}

/// Parameters smaller than this are compared as if they had this size.
pub(crate) const SMALLEST_SIZE: f64 = 1e-3;

/// A problem with its truth.
pub(crate) struct Task<'a> {
    pub problem: &'a Problem,
    /// None where the model is not that of the data.
    pub truth: Option<&'a Parameters>,
}

/// What came of one fit.
#[derive(Debug, Clone)]
pub(crate) struct BenchmarkRun {
    pub elapsed_ms: f64,
    /// Half the distance between the quartiles of its repetitions over their median.
    pub spread: f64,
    /// ΔE.
    pub objective: f64,
    pub parameters: Parameters,
    pub steps: Vec<TraceStep>,
}

impl BenchmarkRun {
    pub(crate) fn begun(problem: &Problem) -> Self {
        Self { elapsed_ms: 0.0, spread: f64::NAN, objective: f64::INFINITY, parameters: *Problem::start(problem), steps: Vec::new() }
    }
}

/// Notes improvements.
pub(crate) struct Trace<'a> {
    pub clock: &'a dyn Fn() -> f64,
    pub truth: Option<&'a Parameters>,
    pub run: BenchmarkRun,
}

impl Trace<'_> {
    pub(crate) fn note(&mut self, problem: &Problem, parameters: Parameters, residuals: &DVector<f64>) {
        let objective = residuals.norm_squared();
        if objective < self.run.objective {
            let distance = self.truth.map_or(f64::NAN, |truth| distance(problem, &parameters, truth));
            self.run.steps.push([(self.clock)(), objective, distance]);
            (self.run.objective, self.run.parameters) = (objective, parameters);
        }
    }
}

/// The largest relative distance of a free parameter from its true value.
pub(crate) fn distance(problem: &Problem, parameters: &Parameters, truth: &Parameters) -> f64 {
    let of = |&parameter: &_| (parameters[parameter] - truth[parameter]).abs() / truth[parameter].abs().max(SMALLEST_SIZE);
    problem.free().iter().map(of).fold(0.0, f64::max)
}

/// The median; NaN of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

/// The repetitions of one fit as one: they take the same steps, at the median of their times.
pub(crate) fn typical(repeated: &[BenchmarkRun]) -> BenchmarkRun {
    let times = Timing::from_repetitions(repeated.iter().map(|run| run.elapsed_ms * 1e6).collect());
    let mut typical = repeated[0].clone();
    for (i, step) in typical.steps.iter_mut().enumerate() {
        step[0] = median(repeated.iter().filter_map(|run| Some(run.steps.get(i)?[0])).collect());
    }
    BenchmarkRun { elapsed_ms: times.median_ns * 1e-6, spread: times.spread, ..typical }
}

#[cfg(test)]
mod tests {
    use super::{BenchmarkRun, typical};
    use crate::model::Parameters;

    #[test]
    fn repetitions_count_by_their_median() {
        let run = |elapsed_ms: f64| BenchmarkRun {
            elapsed_ms,
            spread: f64::NAN,
            objective: 4.0,
            parameters: Parameters::default(),
            steps: vec![[0.5 * elapsed_ms, 9.0, 1.0], [elapsed_ms, 4.0, 1.0]],
        };
        let typical = typical(&[run(2.0), run(40.0), run(3.0)]);
        assert_eq!((typical.elapsed_ms, typical.steps[0][0]), (3.0, 1.5));
    }
}
