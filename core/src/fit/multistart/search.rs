//! Multistart global optimisation: descents from many starts, until the best minimum has been found several times.
//!
//! Automatic search, in rounds of a fixed number of starts: the first round follows the first guesses; each later one half the most
//! promising of many probes and half fresh starts. It ends once the best minimum has been hit often enough and the share of starts that
//! would end in a minimum not seen yet is small, as Boender and Kan expect it. Of many data a part is explored, and the best minima are
//! followed on all. Then the lobes of the best minima are searched again, and the best minima are polished. Descents of a
//! round run in parallel where there are threads and are judged in their order: the result does not depend on the number of threads.

use crate::fit::fit_problem::FitProblem;
use crate::fit::local::solution::LocalFit;
use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::multistart::basin::{Basin, MultistartResult, SAME, is_same};
use crate::fit::multistart::initial_guess::SpecularLobes;
use crate::fit::multistart::sequence::StartSequence;
use crate::fit::multistart::stopping_rule::StoppingRule;
use crate::fit::observer::Observer;
use serde::{Deserialize, Serialize};

/// How many starts.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Starts {
    /// The problem's own start alone.
    One,
    /// The own start, the first guesses, and as many more as find something new.
    #[default]
    Automatic,
    /// The same with a stopping rule of one's own.
    Until(StoppingRule),
    /// Exactly so many, the own start and the first guesses among them.
    Exactly(usize),
}

/// Starts of a round: a multiple of common numbers of cores, and few enough to end early.
const ROUND: usize = 12;
/// Probes of automatic search that its promising starts are chosen from: with nine unknowns a probe takes at most ten evaluations,
/// a coarse descent up to 800.
const PROBES: usize = 96;
/// Probes over the whole box where all starts have not hit the best minimum often enough.
const BROAD_PROBES: usize = 1024;
/// Starts of a round, and the effort of lobe restarts, of a problem whose first guesses come from searches of its parts: what is left to
/// be searched for is how these go together.
const ROUND_OF_COMPOSED: usize = 6;
const LOBE_BASINS_OF_COMPOSED: usize = 4;
const LOBE_EFFORT_OF_COMPOSED: (usize, usize) = (4, 2);
/// Number of starts up to which each is followed to its minimum. With more, each is probed and the best distinct ones are followed.
const MAX_FOLLOWED: usize = 128;
/// Number of the best distinct probes that are followed.
const KEPT_PROBES: usize = 16;
/// Probes that are held in memory at once, however many starts are asked for.
const PROBE_BLOCK: usize = 4096;
/// Residuals beyond which a part of them is explored, and how many that part has.
const MANY_RESIDUALS: usize = 1000;
const SUBSET: usize = 300;
/// Minima of the part that are followed on all data: those within this factor of the best.
const NEAR_BEST: f64 = 1.5;
/// Polishing: number of best minima refined. Polishing may change the order among the best; further down none becomes the best.
const POLISHED_BASINS: usize = 4;
/// Polishing: passes, at most.
const POLISH_PASSES: usize = 12;
/// Polishing: relative improvement of the best minimum below which it stops.
const POLISH_TOLERANCE: f64 = 1e-8;
/// Lobe restarts: number of best minima whose lobes are searched again, the right optical constants being among them.
const LOBE_BASINS: usize = 14;
/// Lobe restarts: numbers as in [`Patience`] where the search has found more distinct minima than `RUGGED`.
const RUGGED_LOBE_EFFORT: (usize, usize) = (14, 4);
/// Guesses of total reflection that are followed from each minimum.
const TOTAL_REFLECTION: usize = 6;
/// Distinct minima beyond which the objective counts as rugged.
const RUGGED: usize = 5;

/// How much a search spends on each start and on each minimum.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patience {
    /// How far a start is followed.
    descent: Effort,
    /// Lobe restarts: number of minima of the lobe grid that are followed for each, and passes, at most; each pass concerns minima
    /// that are new since the last.
    lobes: (usize, usize),
    /// Lobe restarts: from minima within this factor of the best.
    near_best: f64,
}

impl Patience {
    /// For the first search: what finds the best minimum of almost all data.
    pub(crate) const FIRST: Self = Self { descent: Effort::Coarse, lobes: (6, 1), near_best: 4.0 };
    /// For one that looks for what the first has missed.
    pub(crate) const SECOND: Self = Self { descent: Effort::Careful, lobes: (14, 2), near_best: f64::INFINITY };
}

/// Fits from many starts. The seed shifts the points that the starts are spread over.
#[must_use]
pub fn multistart<P: FitProblem>(problem: &P, starts: Starts, seed: u64, observer: Observer<'_>) -> MultistartResult<P::Point> {
    multistart_with(problem, starts, seed, Patience::FIRST, observer)
}

/// The same with more or less patience.
pub(crate) fn multistart_with<P: FitProblem>(
    problem: &P,
    starts: Starts,
    seed: u64,
    patience: Patience,
    observer: Observer<'_>,
) -> MultistartResult<P::Point> {
    let mut found = MultistartResult::default();
    let rule = match starts {
        Starts::Automatic => Some(StoppingRule::of(problem)),
        Starts::Until(rule) => Some(rule),
        Starts::One | Starts::Exactly(_) => None,
    };
    let most = match (rule, starts) {
        (Some(rule), _) => rule.most_starts,
        (None, Starts::Exactly(count)) => count,
        (None, _) => 1,
    };
    let most = if problem.residual_count() == 0 || problem.names().is_empty() { 1 } else { most.max(1) };
    if most == 1 {
        found.add(fit_local(problem, Effort::Thorough, observer));
        found.add_further(further_fits(problem, Effort::Thorough, observer));
        return found;
    }
    let parts = problem.apart();
    if !parts.is_empty() {
        return searched_apart(problem, &parts, starts, seed, observer);
    }
    if problem.residual_count() > MANY_RESIDUALS {
        let explored = multistart_with(&problem.thinned(SUBSET), starts, seed, patience, Observer { progress: &|_| {}, ..observer });
        let mut found = finished_on_all(problem, explored, observer);
        found.add_further(further_fits(problem, Effort::Polish, observer));
        return found;
    }
    let mut search = Search { problem, observer, patience, sequence: StartSequence::new(problem, seed, observer), found };
    if rule.is_none() && most > MAX_FOLLOWED {
        search.keep_best(most);
        search.found.add_further(further_fits(problem, Effort::Thorough, observer));
    } else {
        search.rounds(rule, most);
        search.found.add_further(further_fits(problem, Effort::Thorough, observer));
        if let Some(rule) = rule {
            if search.best_hits() < rule.hits && !search.found.is_exact() && !problem.is_composed() {
                search.keep_best(BROAD_PROBES);
            }
            search.try_total_reflection();
            search.restart_lobes();
        }
    }
    search.polish(POLISH_PASSES);
    search.found.evaluations += search.sequence.evaluations;
    search.found
}

/// Descents from the further starts of the problem. They take no part in the count of hits that ends the rounds: they are no random
/// starts.
fn further_fits<P: FitProblem>(problem: &P, effort: Effort, observer: Observer<'_>) -> Vec<LocalFit<P::Point>> {
    if problem.names().is_empty() {
        return Vec::new();
    }
    problem.further_starts().iter().map(|start| fit_local(&problem.starting_at(start), effort, observer)).collect()
}

/// The minima of problems that do not concern each other: the best of each, and each of the next ones beside the best of the others.
fn searched_apart<P: FitProblem>(
    problem: &P,
    parts: &[P],
    starts: Starts,
    seed: u64,
    observer: Observer<'_>,
) -> MultistartResult<P::Point> {
    let quiet = Observer { progress: &|_| {}, ..observer };
    let searches: Vec<MultistartResult<P::Point>> = parts.iter().map(|part| multistart(part, starts, seed, quiet)).collect();
    let mut found = MultistartResult { basins: Vec::new(), evaluations: searches.iter().map(|search| search.evaluations).sum() };
    let best: Vec<P::Point> = searches.iter().map(|search| search.basins[0].local_fit.parameters.clone()).collect();
    let mut follow = |points: &[P::Point]| {
        found.add(fit_local(&problem.starting_at(&problem.joined(points)), Effort::Polish, observer));
    };
    follow(&best);
    for (place, search) in searches.iter().enumerate() {
        for basin in search.basins.iter().take(POLISHED_BASINS).skip(1) {
            let mut points = best.clone();
            points[place] = basin.local_fit.parameters.clone();
            follow(&points);
        }
    }
    found
}

/// The best minima of a part of the data, followed on all of them.
fn finished_on_all<P: FitProblem>(problem: &P, explored: MultistartResult<P::Point>, observer: Observer<'_>) -> MultistartResult<P::Point> {
    let mut found = MultistartResult { basins: Vec::new(), evaluations: explored.evaluations };
    let best = explored.best();
    let is_near = |basin: &Basin<P::Point>| basin.local_fit.sum_of_squares <= best * NEAR_BEST;
    for Basin { local_fit, hits } in explored.basins.into_iter().take_while(is_near).take(POLISHED_BASINS) {
        let local_fit = fit_local(&problem.starting_at(&local_fit.parameters), Effort::Polish, observer);
        found.evaluations += local_fit.evaluations;
        found.merge(Basin { local_fit, hits });
    }
    found
}

/// A search under way.
struct Search<'a, P: FitProblem> {
    problem: &'a P,
    observer: Observer<'a>,
    patience: Patience,
    sequence: StartSequence<'a, P>,
    found: MultistartResult<P::Point>,
}

impl<P: FitProblem> Search<'_, P> {
    fn is_cancelled(&self) -> bool {
        (self.observer.cancelled)()
    }

    /// Rounds of descents until all starts are used or, in automatic search, little is left to be seen.
    fn rounds(&mut self, rule: Option<StoppingRule>, most: usize) {
        let is_automatic = rule.is_some();
        let mut promising = Vec::new();
        // The own start goes first, also where the search is cancelled: its descent then ends at the start, which is a result. Where it
        // meets the data exactly, no guess is needed.
        let own = self.sequence.take(1);
        self.follow(&own);
        let mut done = 1;
        let in_round = if self.problem.is_composed() { ROUND_OF_COMPOSED } else { ROUND };
        while done < most && !(is_automatic && self.found.is_exact()) && !self.is_cancelled() {
            let count = (in_round - done % in_round).min(most - done);
            let is_mixed = is_automatic && done >= in_round && !self.problem.is_composed();
            let round = if is_mixed { self.mixed_round(count, &mut promising) } else { self.sequence.take(count) };
            done += count;
            self.follow(&round);
            if rule.is_some_and(|rule| self.has_seen_enough(rule)) {
                break;
            }
        }
    }

    fn best_hits(&self) -> usize {
        self.found.basins.first().map_or(0, |basin| basin.hits)
    }

    /// Whether the best minimum was hit often enough and the expected share of unseen minima is small.
    fn has_seen_enough(&self, rule: StoppingRule) -> bool {
        self.best_hits() >= rule.hits && self.found.unseen_share().is_some_and(|share| share < rule.unseen_share)
    }

    /// Half of the starts the most promising of many probes, half fresh ones: a few steps do not tell everything.
    fn mixed_round(&mut self, count: usize, promising: &mut Vec<P::Point>) -> Vec<P::Point> {
        if promising.is_empty() {
            let starts = self.sequence.take(PROBES);
            *promising = distinct(self.probe(&starts)).into_iter().map(|local_fit| local_fit.parameters).collect();
        }
        let mut round: Vec<P::Point> = promising.drain(..(count / 2).min(promising.len())).collect();
        round.extend(self.sequence.take(count - round.len()));
        round
    }

    /// Adds the coarse descents from those starts.
    fn follow(&mut self, starts: &[P::Point]) {
        for local_fit in self.run_all(starts, self.patience.descent) {
            self.found.add(local_fit);
        }
    }

    /// Refines the best minima in passes as long as the best one improves: in a long valley, a solver that starts anew may be
    /// faster than one whose damping is that of the way behind it.
    fn polish(&mut self, passes: usize) {
        for _ in 0..passes {
            if self.found.is_exact() || self.is_cancelled() {
                return;
            }
            let before = self.found.best();
            let best = self.found.basins.iter().take(POLISHED_BASINS);
            let ends: Vec<P::Point> = best.map(|basin| basin.local_fit.parameters.clone()).collect();
            // The others matter only where they soon become the best.
            let (best, others) = ends.split_at(1.min(ends.len()));
            let polished = [self.run_all(best, Effort::Polish), self.run_all(others, Effort::Refine)].concat();
            for (i, further) in polished.into_iter().enumerate() {
                self.found.evaluations += further.evaluations;
                self.found.basins[i].local_fit.append(further);
            }
            std::mem::take(&mut self.found.basins).into_iter().for_each(|basin| self.found.merge(basin));
            if self.found.best() > before * (1.0 - POLISH_TOLERANCE) {
                return;
            }
        }
    }

    /// From the best minimum to those of total reflection with other specular lobes; then from the best minima with the lobes that they
    /// have, because the narrowest minima lie right at a critical angle.
    fn try_total_reflection(&mut self) {
        for (most, lobes) in [(1, SpecularLobes::Any), (POLISHED_BASINS, SpecularLobes::AsThere)] {
            if self.found.is_exact() || self.is_cancelled() {
                return;
            }
            let from = self.found.basins.iter().take(most).map(|basin| &basin.local_fit.parameters);
            let guesses = from.flat_map(|at| self.problem.total_reflection_guesses(at, lobes).into_iter().take(TOTAL_REFLECTION));
            let starts: Vec<P::Point> = guesses.collect();
            self.follow(&starts);
        }
    }

    /// From the best minima with other lobes: where k_v or k_d is small, so is the slope along σ_v or c, and no descent leaves.
    fn restart_lobes(&mut self) {
        let mut seen: Vec<f64> = Vec::new();
        let basins = if self.problem.is_composed() { LOBE_BASINS_OF_COMPOSED } else { LOBE_BASINS };
        let (most, passes) = if self.problem.is_composed() {
            LOBE_EFFORT_OF_COMPOSED
        } else if self.found.basins.len() > RUGGED {
            RUGGED_LOBE_EFFORT
        } else {
            self.patience.lobes
        };
        for _ in 0..passes {
            if self.found.is_exact() || self.is_cancelled() {
                return;
            }
            let limit = self.found.best() * self.patience.near_best;
            let best = || self.found.basins.iter().take(basins).map(|basin| &basin.local_fit).filter(|end| end.sum_of_squares <= limit);
            let is_seen = |end: &&LocalFit<P::Point>| seen.iter().any(|&other| is_same(end.sum_of_squares, other));
            let fresh: Vec<P::Point> = best().filter(|end| !is_seen(end)).map(|end| end.parameters.clone()).collect();
            if fresh.is_empty() {
                return;
            }
            seen.extend(best().map(|end| end.sum_of_squares));
            let guesses = |at: &P::Point| self.problem.lobe_guesses(at).into_iter().take(most);
            let starts: Vec<P::Point> = fresh.iter().flat_map(guesses).collect();
            self.follow(&starts);
            self.polish(1);
        }
    }

    /// A few steps from each start.
    fn probe(&mut self, starts: &[P::Point]) -> Vec<LocalFit<P::Point>> {
        let probes = self.run_all(starts, Effort::Probe);
        self.found.evaluations += probes.iter().map(|probe| probe.evaluations).sum::<usize>();
        probes
    }

    /// Probes so many starts and follows the best distinct ones.
    fn keep_best(&mut self, most: usize) {
        let mut best = Vec::new();
        let mut left = most;
        while left > 0 && (best.is_empty() || !self.is_cancelled()) {
            let count = left.min(PROBE_BLOCK);
            left -= count;
            let starts = self.sequence.take(count);
            best.extend(self.probe(&starts));
            best = distinct(best);
            best.truncate(KEPT_PROBES);
        }
        best.truncate(if self.is_cancelled() { 1 } else { KEPT_PROBES });
        let kept: Vec<P::Point> = best.into_iter().map(|probe| probe.parameters).collect();
        self.follow(&kept);
    }

    /// Descents from all those starts, in their order.
    fn run_all(&self, starts: &[P::Point], effort: Effort) -> Vec<LocalFit<P::Point>> {
        let run = |start: &P::Point| fit_local(&self.problem.starting_at(start), effort, self.observer);
        #[cfg(feature = "threads")]
        {
            use rayon::prelude::*;
            starts.par_iter().map(run).collect()
        }
        #[cfg(not(feature = "threads"))]
        starts.iter().map(run).collect()
    }
}

/// The best first, each minimum once.
fn distinct<T>(mut local_fits: Vec<LocalFit<T>>) -> Vec<LocalFit<T>> {
    local_fits.sort_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
    local_fits.dedup_by(|a, b| (a.sum_of_squares - b.sum_of_squares).abs() <= SAME * b.sum_of_squares);
    local_fits
}
