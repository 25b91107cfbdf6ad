//! Many starts: a first guess from linear algebra, points spread over the box, and what they find.
//!
//! For fixed (n, k, σ, q, c, σ_v), `1/DoLP = (1/DoLP_s)(1 + (k_d F^d + k_v F^v)/(k_s F^s))` is linear in k_d and k_v: on a coarse
//! grid of the others those two come from a non-negative least squares in which each row counts by Xm⁴, so that it approximates
//! the objective in DoLP itself.
//!
//! Further starts are a Kronecker sequence on the roots of Roberts' generalised golden ratio, shifted by the seed (Cranley and
//! Patterson, SIAM J. Numer. Anal. 13, 904 (1976)); in turns they are spread by factors and by steps. Starts run in rounds of a fixed
//! size, in parallel where there are threads, and are judged in their order: the result does not depend on the number of threads.

use super::problem::Problem;
use super::solver::{Descent, Effort, StopReason, Watch, descend};
use crate::model::{Diffuse, Parameter, ParameterSet, Parameters, Pbrdf};
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
pub struct Found {
    /// The best descent that ended there.
    pub descent: Descent,
    /// How many ended there.
    pub reached: usize,
}

/// What all starts together found.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// The distinct minima, best first.
    pub found: Vec<Found>,
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
/// Automatic search makes at least so many starts.
const LEAST_STARTS: usize = 36;
/// Minima that are gone on with at the end, how often at most, and the relative gain that is worth another time.
const FINISHED: usize = 4;
const FINISHES: usize = 12;
const FINISH_TOLERANCE: f64 = 1e-8;
/// Objectives nearer than this fraction, or than [`SAME_ABSOLUTE`], belong to one minimum.
const SAME: f64 = 1e-6;
/// Noise-free minima differ by rounding alone.
const SAME_ABSOLUTE: f64 = 1e-20;

/// Fits from many starts.
#[must_use]
pub fn search(problem: &Problem, starts: Starts, seed: u64, watch: Watch<'_>) -> Search {
    let mut search = Search { found: Vec::new(), evaluations: 0 };
    let most = match starts {
        _ if problem.is_empty() || problem.free().is_empty() => 1,
        Starts::One | Starts::Exactly(0) => 1,
        Starts::Automatic => MOST_STARTS,
        Starts::Exactly(count) => count,
    };
    if most == 1 {
        search.add(descend(problem, Effort::Full, watch));
        return search;
    }
    let mut candidates = Candidates::new(problem, seed);
    if most > ALL_THE_WAY {
        search.follow_the_best(problem, &candidates.take(most), watch);
        search.finish(problem, watch);
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
                    queue = search.glance(problem, &candidates.take(GLANCES), watch);
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
    search.finish(problem, watch);
    search
}

impl Search {
    fn best(&self) -> f64 {
        self.found.first().map_or(f64::INFINITY, |found| found.descent.sum_of_squares)
    }

    /// Whether nothing better can be.
    fn is_exact(&self) -> bool {
        self.found.first().is_some_and(|found| found.descent.stop_reason == StopReason::ResidualsZero)
    }

    /// Takes in a descent.
    fn add(&mut self, descent: Descent) {
        self.evaluations += descent.evaluations;
        self.place(Found { descent, reached: 1 });
    }

    /// To a minimum already found, or as a new one, in the order of objectives.
    fn place(&mut self, new: Found) {
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
    fn finish(&mut self, problem: &Problem, watch: Watch<'_>) {
        for _ in 0..FINISHES {
            if self.is_exact() || (watch.cancelled)() {
                return;
            }
            let before = self.best();
            let ends: Vec<Parameters> = self.found.iter().take(FINISHED).map(|found| found.descent.parameters).collect();
            for (i, again) in run_all(problem, &ends, Effort::Finish, watch).into_iter().enumerate() {
                self.evaluations += again.evaluations;
                self.found[i].descent.go_on(again);
            }
            std::mem::take(&mut self.found).into_iter().for_each(|found| self.place(found));
            if self.best() > before * (1.0 - FINISH_TOLERANCE) {
                return;
            }
        }
    }

    /// A few steps from every start; where they led, the best first, each place once.
    fn glance(&mut self, problem: &Problem, starts: &[Parameters], watch: Watch<'_>) -> Vec<Parameters> {
        let mut short = run_all(problem, starts, Effort::Few, watch);
        self.evaluations += short.iter().map(|descent| descent.evaluations).sum::<usize>();
        short.sort_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
        short.dedup_by(|a, b| (a.sum_of_squares - b.sum_of_squares).abs() <= SAME * b.sum_of_squares);
        short.into_iter().map(|descent| descent.parameters).collect()
    }

    /// A few steps from every start, then the best distinct ones to the end.
    fn follow_the_best(&mut self, problem: &Problem, starts: &[Parameters], watch: Watch<'_>) {
        let mut polished = self.glance(problem, starts, watch);
        polished.truncate(if (watch.cancelled)() { 1 } else { POLISHED });
        for descent in run_all(problem, &polished, Effort::Reach, watch) {
            self.add(descent);
        }
    }
}

/// Descents from all those starts, in their order.
fn run_all(problem: &Problem, starts: &[Parameters], effort: Effort, watch: Watch<'_>) -> Vec<Descent> {
    let run = |start: &Parameters| descend(&problem.with_start(*start), effort, watch);
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
        let guesses: Vec<Parameters> = std::iter::once(*problem.start()).chain(first_guesses(problem)).collect();
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

const GRID_N: [f64; 5] = [0.2, 0.6, 1.2, 2.0, 3.5];
const GRID_K: [f64; 6] = [0.3, 1.0, 2.0, 3.2, 4.5, 7.0];
const GRID_SIGMA: [f64; 5] = [0.05, 0.12, 0.25, 0.45, 0.9];
const GRID_Q: [f64; 3] = [1.3, 2.2, 5.0];
const GRID_C: [f64; 2] = [-0.25, -0.7];
const GRID_SIGMA_V: [f64; 2] = [0.35, 0.8];
/// Guesses that become starts.
const GUESSES: usize = 3;
/// Rows that the guess looks at, at most.
const GUESS_ROWS: usize = 64;

/// The best points of a coarse grid, with k_d and k_v from least squares; none where the data have no DoLP or both are fixed.
fn first_guesses(problem: &Problem) -> Vec<Parameters> {
    let free: ParameterSet = problem.free().iter().copied().collect();
    let model = problem.model();
    let linear = free.contains(Parameter::Kd) || free.contains(Parameter::Kv);
    if !problem.knows_only_ratios() || !linear || !model.specular {
        return Vec::new();
    }
    let rows = problem.dolp_rows(GUESS_ROWS);
    let values = |parameter: Parameter, grid: &[f64]| -> Vec<f64> {
        let inside: Vec<f64> = grid.iter().copied().filter(|&value| problem.bounds().contain(parameter, value)).collect();
        if free.contains(parameter) && !inside.is_empty() { inside } else { vec![problem.start()[parameter]] }
    };
    let axes = [
        (Parameter::N, values(Parameter::N, &GRID_N)),
        (Parameter::K, values(Parameter::K, &GRID_K)),
        (Parameter::Sigma, values(Parameter::Sigma, &GRID_SIGMA)),
        (Parameter::Q, values(Parameter::Q, &GRID_Q)),
        (Parameter::C, values(Parameter::C, &GRID_C)),
        (Parameter::SigmaV, values(Parameter::SigmaV, &GRID_SIGMA_V)),
    ];
    let mut points = vec![*problem.start()];
    for (parameter, values) in &axes {
        points = points.into_iter().flat_map(|point| values.iter().map(move |&value| with(point, *parameter, value))).collect();
    }
    let mut guesses: Vec<(f64, Parameters)> = points
        .into_iter()
        .filter_map(|point| {
            let guess = weights_by_least_squares(problem, free, point, &rows)?;
            Some((misfit(problem, &guess, &rows)?, guess))
        })
        .collect();
    guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Of each n the best one: three neighbours on the grid would be one guess.
    let mut best: Vec<(f64, Parameters)> = Vec::new();
    for guess in guesses {
        if best.iter().all(|other| other.1.n != guess.1.n) {
            best.push(guess);
        }
    }
    best.into_iter().take(GUESSES).map(|(_, guess)| guess).collect()
}

fn with(mut parameters: Parameters, parameter: Parameter, value: f64) -> Parameters {
    parameters[parameter] = value;
    parameters
}

/// A row with its measured DoLP.
type DolpRow = (crate::optics::Facet, f64);

/// k_d and k_v that bring 1/DoLP nearest to the measured one.
fn weights_by_least_squares(problem: &Problem, free: ParameterSet, mut point: Parameters, rows: &[DolpRow]) -> Option<Parameters> {
    let model = problem.model();
    let fit_d = free.contains(Parameter::Kd) && model.diffuse != Diffuse::Absent;
    let fit_v = free.contains(Parameter::Kv) && model.volume;
    let unit = |fit: bool, value: f64| if fit { 1.0 } else { value };
    let surface = Pbrdf::new(model, Parameters { kd: unit(fit_d, point.kd), kv: unit(fit_v, point.kv), ..point }).ok()?;
    let (mut dd, mut dv, mut vv, mut dy, mut vy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (facet, measured) in rows {
        let reflection = surface.reflection(facet);
        let limit = surface.fresnel_limit(facet);
        let weight = measured * measured / (limit * reflection.specular);
        if !weight.is_finite() {
            continue;
        }
        let (d, v) = (weight * reflection.diffuse, weight * reflection.volume);
        let fixed = if fit_d { 0.0 } else { d } + if fit_v { 0.0 } else { v };
        let y = measured - measured * measured / limit - fixed;
        let (d, v) = (if fit_d { d } else { 0.0 }, if fit_v { v } else { 0.0 });
        dd += d * d;
        dv += d * v;
        vv += v * v;
        dy += d * y;
        vy += v * y;
    }
    let (kd, kv) = non_negative_least_squares([dd, dv, vv], [dy, vy]);
    if fit_d {
        point.kd = problem.bounds().clamp(Parameter::Kd, kd);
    }
    if fit_v {
        point.kv = problem.bounds().clamp(Parameter::Kv, kv);
    }
    Some(point)
}

/// Minimises `aa x² + 2ab xy + bb y² − 2 ax x − 2 by y` over x, y ≥ 0.
fn non_negative_least_squares([aa, ab, bb]: [f64; 3], [ax, by]: [f64; 2]) -> (f64, f64) {
    let alone = |square: f64, right: f64| if square > 0.0 { (right / square).max(0.0) } else { 0.0 };
    let determinant = aa * bb - ab * ab;
    if determinant > 1e-12 * aa * bb {
        let (x, y) = ((ax * bb - by * ab) / determinant, (by * aa - ax * ab) / determinant);
        if x >= 0.0 && y >= 0.0 {
            return (x, y);
        }
    }
    let (x, y) = (alone(aa, ax), alone(bb, by));
    // Each alone lowers the sum by right²/square.
    if x * ax >= y * by { (x, 0.0) } else { (0.0, y) }
}

fn misfit(problem: &Problem, point: &Parameters, rows: &[DolpRow]) -> Option<f64> {
    let surface = Pbrdf::new(problem.model(), *point).ok()?;
    let sum: f64 = rows.iter().map(|(facet, measured)| (surface.dolp(facet) - measured) * (surface.dolp(facet) - measured)).sum();
    sum.is_finite().then_some(sum)
}

#[cfg(test)]
mod tests {
    use super::{generalised_golden_ratio, non_negative_least_squares};

    #[test]
    fn the_golden_ratio_is_the_golden_ratio() {
        assert!((generalised_golden_ratio(1) - f64::midpoint(1.0, 5.0_f64.sqrt())).abs() < 1e-12);
    }

    #[test]
    fn least_squares_stay_in_the_quadrant() {
        assert_eq!(non_negative_least_squares([1.0, 0.0, 1.0], [2.0, 3.0]), (2.0, 3.0));
        assert_eq!(non_negative_least_squares([1.0, 0.0, 1.0], [2.0, -3.0]), (2.0, 0.0));
        assert_eq!(non_negative_least_squares([1.0, 0.0, 1.0], [-2.0, -3.0]), (0.0, 0.0));
        assert_eq!(non_negative_least_squares([1.0, 1.0, 1.0], [1.0, 2.0]), (0.0, 2.0));
    }
}
