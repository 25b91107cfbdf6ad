//! Starts of a multistart search, the most promising first: the problem's own start, the first guesses, then points spread over the
//! box.
//!
//! The points are a Kronecker sequence on the roots of Roberts' generalised golden ratio, shifted by the seed (Cranley and
//! Patterson, SIAM J. Numer. Anal. 13, 904 (1976)). Every other point is spread logarithmically, the others linearly.

use crate::fit::fit_problem::FitProblem;
use crate::fit::observer::Observer;
use crate::model::Parameter;
use nalgebra::DVector;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Minima of the grid that become starts, the lowest ones: five rounds, before the sequence has its turn.
const GUESSES: usize = 64;

/// The starts of a search, in their order.
pub(crate) struct StartSequence<'a, P: FitProblem> {
    problem: &'a P,
    seed: u64,
    observer: Observer<'a>,
    /// Whether the problem's own start was taken.
    has_begun: bool,
    /// First guesses, once they are asked for.
    guesses: Option<std::vec::IntoIter<P::Point>>,
    /// Residual evaluations that the first guesses took.
    pub evaluations: usize,
    /// Of each unknown.
    shift: Vec<f64>,
    next: u32,
}

impl<'a, P: FitProblem> StartSequence<'a, P> {
    pub(crate) fn new(problem: &'a P, seed: u64, observer: Observer<'a>) -> Self {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut shift = vec![0.0; problem.names().len().max(Parameter::COUNT)];
        // 32 bits are more than a shift needs.
        shift.fill_with(|| f64::from(random.next_u32()) / 4_294_967_296.0);
        Self { problem, seed, observer, has_begun: false, guesses: None, evaluations: 0, shift, next: 0 }
    }

    /// The next starts.
    pub(crate) fn take(&mut self, count: usize) -> Vec<P::Point> {
        (0..count).map(|_| self.following()).collect()
    }

    fn following(&mut self) -> P::Point {
        if !std::mem::replace(&mut self.has_begun, true) {
            return self.problem.start_point().clone();
        }
        let guesses = self.guesses.get_or_insert_with(|| {
            let (mut lowest, evaluations) = self.problem.first_guesses(self.seed, self.observer);
            self.evaluations = evaluations;
            lowest.truncate(GUESSES);
            lowest.into_iter()
        });
        let guess = guesses.next();
        guess.unwrap_or_else(|| self.spread())
    }

    /// The next point of the shifted Kronecker sequence in the box of the free parameters.
    fn spread(&mut self) -> P::Point {
        self.next += 1;
        let count = self.problem.names().len();
        let ratio = generalised_golden_ratio(count);
        // Either spread alone seldom visits some corner of the box.
        let by_factors = self.next.is_multiple_of(2);
        let mut step = 1.0;
        let start = DVector::from_fn(count, |j, _| {
            step /= ratio;
            self.problem.spread(j, (self.shift[j] + f64::from(self.next) * step).fract(), by_factors)
        });
        self.problem.point_at(&start)
    }
}

/// The root above 1 of `x^(d+1) = x + 1`: its powers make the most even Kronecker sequence known in d dimensions (M. Roberts, 2018).
fn generalised_golden_ratio(dimensions: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "at most as many dimensions as parameters")]
    let exponent = 1.0 / (dimensions as f64 + 1.0);
    // The iteration contracts by more than half a step: 40 steps are beyond f64.
    (0..40).fold(2.0, |x, _| libm::pow(1.0 + x, exponent))
}

#[cfg(test)]
mod tests {
    use super::generalised_golden_ratio;

    #[test]
    fn in_one_dimension_the_ratio_is_the_golden_ratio() {
        assert!((generalised_golden_ratio(1) - f64::midpoint(1.0, 5.0_f64.sqrt())).abs() < 1e-12);
    }
}
