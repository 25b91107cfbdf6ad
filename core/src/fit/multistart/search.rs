//! Many starts: first guesses ([`crate::fit::multistart::initial_guess`]), points spread over the box, and what they find.
//!
//! Further starts are a Kronecker sequence on the roots of Roberts' generalised golden ratio, shifted by the seed (Cranley and
//! Patterson, SIAM J. Numer. Anal. 13, 904 (1976)); in turns they are spread by factors and by steps. Starts run in rounds of a fixed
//! size, in parallel where there are threads, and are judged in their order: the result does not depend on the number of threads.

use crate::fit::local::solver::{Effort, LocalFit, Observer, StopReason, fit_local};
use crate::fit::multistart::initial_guess::{grid_minima, lobe_grid_minima};
use crate::fit::objective::Problem;
use crate::model::Parameters;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// How many starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Starts {
    /// The problem's own start alone.
    One,
    /// The own start, the first guesses, and as many more as find something new.
    #[default]
    Automatic,
    /// Exactly so many, the own start and the first guesses among them.
    Exactly(usize),
}

/// One minimum and how often it was reached.
#[derive(Debug, Clone, PartialEq)]
pub struct Basin {
    /// The best descent that ended there.
    pub descent: LocalFit,
    /// How many ended there.
    pub reached: usize,
}

/// What all starts together found.
#[derive(Debug, Clone, PartialEq)]
pub struct MultistartResult {
    /// The distinct minima, best first.
    pub found: Vec<Basin>,
    /// Residual evaluations of all starts.
    pub evaluations: usize,
}

/// Starts of a round.
const ROUND: usize = 12;
/// Automatic search glances at so many starts, and half of those it follows are the most promising of them.
const GLANCES: usize = 256;
/// Automatic search ends after so many starts at the latest.
const MOST_STARTS: usize = 96;
/// It ends when the best minimum was reached so often…
const REACHED_ENOUGH: usize = 3;
/// …and so many rounds brought nothing better.
const QUIET_ROUNDS: usize = 2;
/// Above so many starts each is first followed for a few steps only, and the best distinct ones to the end.
const ALL_THE_WAY: usize = 128;
/// How many of those.
const POLISHED: usize = 16;
/// Followed for a few steps at once: any number of starts can be asked for, and memory holds so many.
const BLOCK: usize = 4096;
/// Automatic search makes at least so many starts.
const LEAST_STARTS: usize = 36;
/// Floors of the grid of first guesses that become starts.
const GUESSES: usize = 64;
/// Minima that are gone on with at the end, how often at most, and the relative gain that is worth another time.
const FINISHED: usize = 4;
const FINISHES: usize = 12;
const FINISH_TOLERANCE: f64 = 1e-8;
/// Minima whose lobes are looked at again, how many low points of each are followed, and how often that is done at most.
const LOOKED_AT: usize = 14;
const FLOORS: usize = 14;
const LOOKS: usize = 4;
/// Objectives nearer than this fraction, or than [`SAME_ABSOLUTE`], belong to one minimum.
const SAME: f64 = 1e-6;
/// Noise-free minima differ by rounding alone.
const SAME_ABSOLUTE: f64 = 1e-20;

/// Fits from many starts.
#[must_use]
pub fn search(problem: &Problem, starts: Starts, seed: u64, watch: Observer<'_>) -> MultistartResult {
    let mut search = MultistartResult { found: Vec::new(), evaluations: 0 };
    let most = match starts {
        _ if problem.is_empty() || problem.free().is_empty() => 1,
        Starts::One | Starts::Exactly(0) => 1,
        Starts::Automatic => MOST_STARTS,
        Starts::Exactly(count) => count,
    };
    if most == 1 {
        search.add(fit_local(problem, Effort::Full, watch));
        return search;
    }
    let mut candidates = Candidates::new(problem, seed);
    if most > ALL_THE_WAY {
        search.keep_best(problem, &mut candidates, most, watch);
        search.finish(problem, FINISHES, watch);
        return search;
    }
    let mut queue = Vec::new();
    let mut quiet = 0;
    let mut done = 0;
    // The first round runs even if nobody waits for it any more: each of its descents ends at its start, and that is an answer.
    while done < most && quiet < QUIET_ROUNDS && (done == 0 || !(watch.cancelled)()) {
        let count = ROUND.min(most - done);
        let round = match starts {
            Starts::Automatic if done > 0 => {
                if queue.is_empty() {
                    let seen = distinct(search.probe(problem, &candidates.take(GLANCES), watch));
                    queue = seen.into_iter().map(|descent| descent.parameters).collect();
                }
                // In equal parts the promising and the fresh: a few steps do not tell everything.
                let promising = queue.drain(..(count / 2).min(queue.len())).collect::<Vec<_>>();
                let fresh = candidates.take(count - promising.len());
                promising.into_iter().chain(fresh).collect()
            }
            _ => candidates.take(count),
        };
        done += count;
        let before = search.best();
        for descent in run_all(problem, &round, Effort::Reach, watch) {
            search.add(descent);
        }
        let improved = search.best() < before - SAME_ABSOLUTE && search.best() < before * (1.0 - SAME);
        let reached = search.found.first().map_or(0, |found| found.reached);
        quiet = if starts != Starts::Automatic || improved || reached < REACHED_ENOUGH || done < LEAST_STARTS { 0 } else { quiet + 1 };
        if starts == Starts::Automatic && search.is_exact() {
            break;
        }
    }
    if starts == Starts::Automatic {
        search.restart_lobes(problem, watch);
    }
    search.finish(problem, FINISHES, watch);
    search
}

impl MultistartResult {
    fn best(&self) -> f64 {
        self.found.first().map_or(f64::INFINITY, |found| found.descent.sum_of_squares)
    }

    /// Whether nothing better can be.
    fn is_exact(&self) -> bool {
        self.found.first().is_some_and(|found| found.descent.stop_reason == StopReason::ResidualsZero)
    }

    /// Takes in a descent.
    fn add(&mut self, descent: LocalFit) {
        self.evaluations += descent.evaluations;
        self.place(Basin { descent, reached: 1 });
    }

    /// To a minimum already found, or as a new one, in the order of objectives.
    fn place(&mut self, new: Basin) {
        let value = new.descent.sum_of_squares;
        let same = |other: f64| (value - other).abs() <= (SAME * other.abs()).max(SAME_ABSOLUTE);
        if let Some(i) = self.found.iter().position(|found| same(found.descent.sum_of_squares)) {
            self.found[i].reached += new.reached;
            if value < self.found[i].descent.sum_of_squares {
                self.found[i].descent = new.descent;
            }
        } else {
            self.found.push(new);
        }
        self.found.sort_by(|a, b| a.descent.sum_of_squares.total_cmp(&b.descent.sum_of_squares));
    }

    /// Goes on from the best minima as long as that brings anything: the solver's memory of a long valley can be worse than none.
    fn finish(&mut self, problem: &Problem, times: usize, watch: Observer<'_>) {
        for _ in 0..times {
            if self.is_exact() || (watch.cancelled)() {
                return;
            }
            let before = self.best();
            let ends: Vec<Parameters> = self.found.iter().take(FINISHED).map(|found| found.descent.parameters).collect();
            for (i, again) in run_all(problem, &ends, Effort::Finish, watch).into_iter().enumerate() {
                self.evaluations += again.evaluations;
                self.found[i].descent.append(again);
            }
            std::mem::take(&mut self.found).into_iter().for_each(|found| self.place(found));
            if self.best() > before * (1.0 - FINISH_TOLERANCE) {
                return;
            }
        }
    }

    /// From the best minima with other lobes: where k_v or k_d is small, the slope along σ_v or c is, and no descent gets away from there.
    fn restart_lobes(&mut self, problem: &Problem, watch: Observer<'_>) {
        let mut seen: Vec<f64> = Vec::new();
        for _ in 0..LOOKS {
            if self.is_exact() || (watch.cancelled)() {
                return;
            }
            let fresh: Vec<Parameters> = self
                .found
                .iter()
                .take(LOOKED_AT)
                .filter(|found| !seen.contains(&found.descent.sum_of_squares))
                .map(|found| found.descent.parameters)
                .collect();
            if fresh.is_empty() {
                return;
            }
            seen.extend(self.found.iter().take(LOOKED_AT).map(|found| found.descent.sum_of_squares));
            let starts: Vec<Parameters> =
                fresh.iter().flat_map(|at| lobe_grid_minima(problem, at).into_iter().take(FLOORS).map(|guess| guess.parameters)).collect();
            for descent in run_all(problem, &starts, Effort::Reach, watch) {
                self.add(descent);
            }
            self.finish(problem, 1, watch);
        }
    }

    /// A few steps from every start.
    fn probe(&mut self, problem: &Problem, starts: &[Parameters], watch: Observer<'_>) -> Vec<LocalFit> {
        let short = run_all(problem, starts, Effort::Few, watch);
        self.evaluations += short.iter().map(|descent| descent.evaluations).sum::<usize>();
        short
    }

    /// A few steps from so many starts, then the best distinct ones to the end.
    fn keep_best(&mut self, problem: &Problem, candidates: &mut Candidates<'_>, most: usize, watch: Observer<'_>) {
        let mut best = Vec::new();
        let mut left = most;
        while left > 0 && (best.is_empty() || !(watch.cancelled)()) {
            let count = left.min(BLOCK);
            left -= count;
            best.extend(self.probe(problem, &candidates.take(count), watch));
            best = distinct(best);
            best.truncate(POLISHED);
        }
        best.truncate(if (watch.cancelled)() { 1 } else { POLISHED });
        let polished: Vec<Parameters> = best.into_iter().map(|descent| descent.parameters).collect();
        for descent in run_all(problem, &polished, Effort::Reach, watch) {
            self.add(descent);
        }
    }
}

/// The best first, each place once.
fn distinct(mut descents: Vec<LocalFit>) -> Vec<LocalFit> {
    descents.sort_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
    descents.dedup_by(|a, b| (a.sum_of_squares - b.sum_of_squares).abs() <= SAME * b.sum_of_squares);
    descents
}

/// Descents from all those starts, in their order.
fn run_all(problem: &Problem, starts: &[Parameters], effort: Effort, watch: Observer<'_>) -> Vec<LocalFit> {
    let run = |start: &Parameters| fit_local(&problem.with_start(*start), effort, watch);
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        starts.par_iter().map(run).collect()
    }
    #[cfg(not(feature = "threads"))]
    starts.iter().map(run).collect()
}

/// Starts, the most promising first.
struct Candidates<'a> {
    problem: &'a Problem,
    guesses: std::vec::IntoIter<Parameters>,
    shift: [f64; 9],
    next: u32,
}

impl<'a> Candidates<'a> {
    fn new(problem: &'a Problem, seed: u64) -> Self {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut shift = [0.0; 9];
        // 32 bits are more than a shift needs.
        shift.fill_with(|| f64::from(random.next_u32()) / 4_294_967_296.0);
        let guesses = grid_minima(problem).into_iter().take(GUESSES).map(|guess| guess.parameters);
        let guesses: Vec<Parameters> = std::iter::once(*problem.start()).chain(guesses).collect();
        Self { problem, guesses: guesses.into_iter(), shift, next: 0 }
    }

    fn take(&mut self, count: usize) -> Vec<Parameters> {
        (0..count).map(|_| self.guesses.next().unwrap_or_else(|| self.spread())).collect()
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
            // In turns by factors and by steps: either way alone seldom visits some corner of the box.
            start[parameter] =
                if self.next.is_multiple_of(2) { bounds.spread(parameter, fraction) } else { bounds.at(parameter, fraction) };
        }
        start
    }
}

/// The root above 1 of `x^(d+1) = x + 1`: its powers make the most even Kronecker sequence known in d dimensions (M. Roberts, 2018).
fn generalised_golden_ratio(dimensions: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "at most nine dimensions")]
    let exponent = 1.0 / (dimensions as f64 + 1.0);
    (0..40).fold(2.0, |x, _| libm::pow(1.0 + x, exponent))
}

#[cfg(test)]
mod tests {
    use super::generalised_golden_ratio;

    #[test]
    fn the_golden_ratio_is_the_golden_ratio() {
        assert!((generalised_golden_ratio(1) - f64::midpoint(1.0, 5.0_f64.sqrt())).abs() < 1e-12);
    }
}
