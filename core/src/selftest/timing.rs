//! Times that can be trusted: warmed up, repeated, with median and spread.

/// Where reports get what they cannot know: a clock, a wish to stop, and somebody to tell how far they are.
#[derive(Clone, Copy)]
pub struct Host<'a> {
    /// Milliseconds since some moment, never running backwards.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
    /// Whether to stop with what there is.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Told the done fraction of the report, 0 to 1.
    pub progress: &'a (dyn Fn(f64) + Sync),
}

/// How long something takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Median of the repetitions, in nanoseconds.
    pub median_ns: f64,
    /// Half the distance between the quartiles over the median.
    pub spread: f64,
}

/// Repetitions of which the median is taken.
const REPETITIONS: usize = 11;
/// A repetition lasts so long, so that the clock's own steps do not show.
const REPETITION_MS: f64 = 4.0;

impl Timing {
    /// Of one call of `body`: warmed up, and called as often in each of eleven repetitions as makes some milliseconds.
    #[must_use]
    pub fn of(clock: &dyn Fn() -> f64, mut body: impl FnMut()) -> Self {
        let mut run = |calls: usize| {
            let begun = clock();
            for _ in 0..calls {
                body();
            }
            clock() - begun
        };
        let mut calls = 1;
        // The warm-up is over once a repetition lasts.
        while run(calls) < REPETITION_MS && calls < 1 << 30 {
            calls *= 2;
        }
        #[expect(clippy::cast_precision_loss, reason = "fewer calls than 2^53")]
        let each: Vec<f64> = (0..REPETITIONS).map(|_| run(calls) * 1e6 / calls as f64).collect();
        Self::from_repetitions(each)
    }

    /// From the times of repetitions in nanoseconds, at least one.
    #[must_use]
    pub fn from_repetitions(mut each: Vec<f64>) -> Self {
        each.sort_by(f64::total_cmp);
        let median_ns = quantile(&each, 0.5);
        Self { median_ns, spread: 0.5 * (quantile(&each, 0.75) - quantile(&each, 0.25)) / median_ns }
    }
}

/// Quantile of sorted values, linear between neighbours; NaN of none.
#[must_use]
pub fn quantile(sorted: &[f64], fraction: f64) -> f64 {
    if sorted.is_empty() {
        return f64::NAN;
    }
    #[expect(clippy::cast_precision_loss, reason = "a number of values")]
    let place = fraction * (sorted.len() - 1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place between 0 and the number of values")]
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    let weight = place - place.floor();
    // Equal neighbours, infinite ones too, are their own mean.
    if weight == 0.0 || sorted[below] == sorted[above] { sorted[below] } else { sorted[below] + weight * (sorted[above] - sorted[below]) }
}

#[cfg(test)]
mod tests {
    use super::{Timing, quantile};
    use std::cell::Cell;

    #[test]
    fn a_call_is_timed_by_the_clock_it_is_given() {
        let now = Cell::new(0.0);
        let timing = Timing::of(&|| now.get(), || now.set(now.get() + 0.25));
        // Sums of quarters are exact.
        assert_eq!(timing, Timing { median_ns: 250_000.0, spread: 0.0 });
    }

    #[test]
    fn one_slow_repetition_does_not_move_the_median() {
        let timing = Timing::from_repetitions(vec![2.0, 2.0, 2.0, 2.0, 900.0]);
        assert_eq!(timing, Timing { median_ns: 2.0, spread: 0.0 });
    }

    #[test]
    fn quantiles_lie_between_their_neighbours() {
        assert_eq!(quantile(&[1.0, 2.0, 4.0], 0.75), 3.0);
        assert_eq!(quantile(&[1.0, f64::INFINITY, f64::INFINITY], 0.9), f64::INFINITY);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
