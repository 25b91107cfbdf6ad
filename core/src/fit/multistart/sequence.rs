//! Starts of a multistart search, the most promising first: the problem's own start, the first guesses, then points spread over the
//! box.
//!
//! The points are a Kronecker sequence on the roots of Roberts' generalised golden ratio, shifted by the seed (Cranley and
//! Patterson, SIAM J. Numer. Anal. 13, 904 (1976)). Every other point is spread logarithmically, the others linearly.

use crate::fit::multistart::initial_guess::grid_minima;
use crate::fit::objective::Problem;
use crate::model::{Parameter, Parameters};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Minima of the grid that become starts, the lowest ones: five rounds, before the sequence has its turn.
const GUESSES: usize = 64;

/// The starts of a search, in their order.
pub(crate) struct StartSequence<'a> {
    problem: &'a Problem,
    /// Whether the problem's own start was taken.
    has_begun: bool,
    /// First guesses, once they are asked for.
    guesses: Option<std::vec::IntoIter<Parameters>>,
    shift: [f64; Parameter::COUNT],
    next: u32,
}

impl<'a> StartSequence<'a> {
    pub(crate) fn new(problem: &'a Problem, seed: u64) -> Self {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut shift = [0.0; Parameter::COUNT];
        // 32 bits are more than a shift needs.
        shift.fill_with(|| f64::from(random.next_u32()) / 4_294_967_296.0);
        Self { problem, has_begun: false, guesses: None, shift, next: 0 }
    }

    /// The next starts.
    pub(crate) fn take(&mut self, count: usize) -> Vec<Parameters> {
        (0..count).map(|_| self.following()).collect()
    }

    fn following(&mut self) -> Parameters {
        if !std::mem::replace(&mut self.has_begun, true) {
            return *self.problem.start();
        }
        let guesses = self.guesses.get_or_insert_with(|| {
            let lowest = grid_minima(self.problem).into_iter().take(GUESSES).map(|guess| guess.parameters);
            lowest.collect::<Vec<Parameters>>().into_iter()
        });
        guesses.next().unwrap_or_else(|| self.spread())
    }

    /// The next point of the shifted Kronecker sequence in the box of the free parameters.
    fn spread(&mut self) -> Parameters {
        self.next += 1;
        let free = self.problem.free();
        let ratio = generalised_golden_ratio(free.len());
        let mut start = *self.problem.start();
        let mut step = 1.0;
        for (j, &parameter) in free.iter().enumerate() {
            step /= ratio;
            let fraction = (self.shift[j] + f64::from(self.next) * step).fract();
            let bounds = self.problem.bounds();
            // Either spread alone seldom visits some corner of the box.
            start[parameter] =
                if self.next.is_multiple_of(2) { bounds.spread(parameter, fraction) } else { bounds.at(parameter, fraction) };
        }
        start
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
