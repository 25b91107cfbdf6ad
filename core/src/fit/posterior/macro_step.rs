//! A macro step of a trajectory, divided into micro steps where the density is narrow: the within-orbit adaptive leapfrog of WALNUTS
//! (Bou-Rabee, Carpenter, Kleppe and Liu, arXiv:2506.18746 (2025)).
//!
//! A macro step of length h is 2ˡ leapfrog steps of h/2ˡ, the micro steps. From a point, l* is the smallest l for which the energy varies by at most
//! [`TOLERANCE`] on the way. The macro step takes l*, or with a small probability l* + 1. From its end backwards, l* can be smaller; so the
//! weight of all that lies beyond is multiplied by p(l from the end)/p(l from the beginning), which keeps the density invariant.

use crate::fit::posterior::log_density::LogDensity;
use crate::fit::posterior::phase::Phase;
use crate::measurement::Deviates;

/// How much the energy may vary within a macro step.
const TOLERANCE: f64 = 0.3;
/// Halvings at most: where steps of h/128 do not do, the trajectory has diverged.
const MOST_HALVINGS: u32 = 7;
/// Probability of l* + 1, where l* = 0 and elsewhere: without it, a macro step that l* − 1 would take back has no way back.
const SHORTER_THAN_WHOLE: f64 = 0.1;
const SHORTER: f64 = 0.3;

/// What became of a macro step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MacroStepOutcome {
    Taken,
    /// No macro step from its end leads back by the same micro steps.
    OneWay,
    /// The energy runs away even in the shortest steps.
    Diverged,
}

/// Takes macro steps; holds the buffers for them.
#[derive(Debug, Clone)]
pub(crate) struct MacroStep {
    begin: Phase,
    back: Phase,
}

/// Probability of one halving more than l*.
fn one_more(halvings: u32) -> f64 {
    if halvings == 0 { SHORTER_THAN_WHOLE } else { SHORTER }
}

/// Probability of so many halvings where l* are the least that do.
fn probability(halvings: u32, least: u32) -> f64 {
    if halvings == least {
        1.0 - one_more(least)
    } else if halvings == least + 1 {
        one_more(least)
    } else {
        0.0
    }
}

/// Goes 2ˡ steps; returns whether the energy varies little enough, and its change. Ends early where it does not.
fn go(walker: &mut Phase, density: &mut impl LogDensity, length: f64, halvings: u32) -> (bool, f64) {
    let begin = walker.energy();
    let (mut low, mut high) = (begin, begin);
    let steps = 1_u32 << halvings;
    for _ in 0..steps {
        walker.step(density, length / f64::from(steps));
        let energy = walker.energy();
        (low, high) = (low.min(energy), high.max(energy));
        // Not a number varies too much.
        if energy.is_nan() || high - low > TOLERANCE {
            return (false, energy - begin);
        }
    }
    (true, walker.energy() - begin)
}

impl MacroStep {
    pub(crate) fn new(dimension: usize) -> Self {
        Self { begin: Phase::new(dimension), back: Phase::new(dimension) }
    }

    /// Moves a walker on, backwards for a negative length; returns the change of the energy in one undivided step too.
    pub(crate) fn take(
        &mut self,
        walker: &mut Phase,
        density: &mut impl LogDensity,
        length: f64,
        deviates: &mut Deviates,
    ) -> (MacroStepOutcome, f64) {
        self.begin.copy_from(walker);
        let (whole_does, change) = go(walker, density, length, 0);
        let change = if change.is_nan() { f64::INFINITY } else { change };
        let mut least = Some(0);
        if !whole_does {
            least = (1..=MOST_HALVINGS).find(|&halvings| {
                walker.copy_from(&self.begin);
                go(walker, density, length, halvings).0
            });
        }
        let Some(least) = least else { return (MacroStepOutcome::Diverged, change) };
        let mut taken = least;
        if deviates.uniform() < one_more(least) {
            taken += 1;
            walker.copy_from(&self.begin);
            if !go(walker, density, length, taken).0 {
                return (MacroStepOutcome::OneWay, change);
            }
        }
        // The way back by the same steps does.
        let least_back = (0..taken).find(|&halvings| {
            self.back.copy_from(walker);
            go(&mut self.back, density, -length, halvings).0
        });
        let ratio = probability(taken, least_back.unwrap_or(taken)) / probability(taken, least);
        walker.log_ratio += libm::log(ratio);
        (if ratio > 0.0 { MacroStepOutcome::Taken } else { MacroStepOutcome::OneWay }, change)
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST_HALVINGS, MacroStep, MacroStepOutcome, probability};
    use crate::fit::posterior::log_density::LogDensity;
    use crate::fit::posterior::phase::Phase;
    use crate::measurement::Deviates;

    /// Narrow at the left of 0, wide at the right: ln density −x²/2 e^(−2y), −y²/2.
    #[derive(Clone)]
    struct Funnel;

    impl LogDensity for Funnel {
        fn dimension(&self) -> usize {
            2
        }

        fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
            let precision = libm::exp(-2.0 * at[1]);
            gradient[0] = -at[0] * precision;
            gradient[1] = at[0] * at[0] * precision - at[1] - 1.0;
            -0.5 * at[0] * at[0] * precision - 0.5 * at[1] * at[1] - at[1]
        }
    }

    fn at(position: [f64; 2], momentum: [f64; 2]) -> Phase {
        let mut phase = Phase::new(2);
        phase.position.copy_from_slice(&position);
        phase.momentum.copy_from_slice(&momentum);
        phase.log_density = Funnel.value_and_gradient(&position, &mut phase.gradient);
        phase
    }

    #[test]
    fn probabilities_sum_to_one() {
        for least in 0..MOST_HALVINGS {
            let sum: f64 = (0..=MOST_HALVINGS + 1).map(|halvings| probability(halvings, least)).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{least}: {sum}");
        }
    }

    #[test]
    fn a_macro_step_that_is_taken_back_by_the_same_steps_has_a_ratio_of_one() {
        let mut deviates = Deviates::new(3);
        let (mut returned, mut uneven) = (0, 0);
        for _ in 0..5000 {
            let ((x, y), (p, r)) = (deviates.pair(), deviates.pair());
            let begin = at([x * libm::exp(y), y], [p, r]);
            let mut walker = begin.clone();
            let mut macro_step = MacroStep::new(2);
            if macro_step.take(&mut walker, &mut Funnel, 0.8, &mut deviates).0 != MacroStepOutcome::Taken {
                continue;
            }
            let ratio = walker.log_ratio;
            let outcome = macro_step.take(&mut walker, &mut Funnel, -0.8, &mut deviates).0;
            // Other steps lead elsewhere; rounding alone is far below this.
            let is_back = walker.position.iter().zip(&begin.position).all(|(a, b)| (a - b).abs() < 1e-10 * (1.0 + b.abs()));
            if outcome == MacroStepOutcome::Taken && is_back {
                assert!(walker.log_ratio.abs() < 1e-12, "{ratio} {}", walker.log_ratio);
                returned += 1;
                uneven += usize::from(ratio.abs() > 0.1);
            }
        }
        assert!(returned > 1000 && uneven > 10, "{returned} {uneven}");
    }

    #[test]
    fn no_step_is_short_enough_for_a_wall() {
        #[derive(Clone)]
        struct Wall;
        impl LogDensity for Wall {
            fn dimension(&self) -> usize {
                1
            }
            fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
                gradient[0] = 0.0;
                if at[0] > 0.0 { f64::NEG_INFINITY } else { 0.0 }
            }
        }
        let mut walker = Phase::new(1);
        (walker.position[0], walker.momentum[0], walker.log_density) = (-0.01, 1.0, 0.0);
        let outcome = MacroStep::new(1).take(&mut walker, &mut Wall, 1.0, &mut Deviates::new(1)).0;
        assert_eq!(outcome, MacroStepOutcome::Diverged);
    }
}
