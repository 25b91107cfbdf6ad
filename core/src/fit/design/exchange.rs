//! Fedorov's exchange: each reading in turn is given up for the candidate that is worth most, until none is worth more.
//!
//! V. V. Fedorov, *Theory of Optimal Experiments* (1972); in turn: Cook and Nachtsheim, Technometrics 22, 315 (1980). It begins at
//! several random sets, and then again at disturbed copies of the best one. Runs go in parallel where there are threads and are judged
//! in their order: the result does not depend on the number of threads.

use crate::fit::design::information::MOST;
use crate::measurement::Deviates;
use nalgebra::{DMatrix, DVector};

/// Random beginnings, and rounds of disturbed copies of the best, at most.
const BEGINNINGS: usize = 32;
const ROUNDS: usize = 6;
const COPIES: usize = 8;
/// Share of the readings that a copy is disturbed by: one in so many.
const DISTURBED: usize = 4;
/// Candidates that are judged in all, about: fewer beginnings where there are many candidates.
const EFFORT: usize = 20_000_000;
/// Passes of one exchange, at most; it ends long before.
const PASSES: usize = 60;
/// Gain of an exchange that is worth it.
const GAIN: f64 = 1e-9;
/// Information that is added in every direction, over that of average readings: sets that leave a direction open can be compared.
const RIDGE: f64 = 1e-9;

/// A square matrix of up to nine directions.
type Matrix = [[f64; MOST]; MOST];

/// What is to be large.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Objective {
    /// ln det of the information.
    LogDet,
    /// Less the logarithm of a sum of variances.
    LogVariance,
}

/// The candidates as one surface sees them.
#[derive(Debug, Clone)]
pub(crate) struct Scenario {
    /// Rows of the candidates, one after the other.
    pub rows: Vec<f64>,
    /// Information that is there already.
    pub base: DMatrix<f64>,
    /// What the variances are formed from.
    pub contrasts: Vec<DVector<f64>>,
}

/// Readings to be chosen.
#[derive(Debug, Clone)]
pub(crate) struct Exchange {
    pub scenarios: Vec<Scenario>,
    pub candidates: usize,
    /// Rows of a candidate, 1 or 2.
    pub rows_each: usize,
    pub count: usize,
    /// Whether a candidate may be chosen more than once.
    pub repeats: bool,
    pub objective: Objective,
}

/// Chosen candidates, sorted, and the mean of the objective over the scenarios.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chosen {
    pub candidates: Vec<usize>,
    pub value: f64,
}

impl Exchange {
    fn directions(&self) -> usize {
        self.scenarios.first().map_or(0, |scenario| scenario.base.nrows())
    }

    /// The best set that was found, hearing of the share that is done; ends early where told to.
    pub(crate) fn run(&self, goes_on: &(dyn Fn(f64) -> bool + Sync)) -> Chosen {
        let each = self.candidates * self.count * self.scenarios.len() * 6;
        let beginnings = (EFFORT / each.max(1)).clamp(2, BEGINNINGS);
        let rounds = (beginnings * ROUNDS / BEGINNINGS).max(1);
        #[expect(clippy::cast_precision_loss, reason = "a number of runs")]
        let share = |done: usize| done as f64 / (beginnings + rounds * COPIES) as f64;
        let starts: Vec<Vec<usize>> = (0..beginnings).map(|number| self.random_set(number as u64)).collect();
        let mut best = self.best_of(starts, goes_on);
        for round in 0..rounds {
            if !goes_on(share(beginnings + round * COPIES)) {
                break;
            }
            let copies = (0..COPIES).map(|copy| self.disturbed(&best.candidates, (beginnings + round * COPIES + copy) as u64));
            let other = self.best_of(copies.collect(), goes_on);
            if other.value > best.value + GAIN {
                best = other;
            }
        }
        best
    }

    /// What single candidates would add to a set, one after the other.
    pub(crate) fn scores(&self, chosen: &[usize]) -> impl Fn(&[&[f64]]) -> f64 + '_ {
        let inverses: Vec<Matrix> = self.scenarios.iter().map(|scenario| self.inverse(scenario, chosen)).collect();
        move |rows| {
            self.scenarios.iter().zip(&inverses).zip(rows).map(|((scenario, inverse), rows)| self.score_in(scenario, inverse, rows)).sum()
        }
    }

    /// The best of the exchanges from those sets; the first of equals.
    fn best_of(&self, starts: Vec<Vec<usize>>, goes_on: &(dyn Fn(f64) -> bool + Sync)) -> Chosen {
        let run = |start: Vec<usize>| self.exchanged(start, goes_on);
        #[cfg(feature = "threads")]
        let found: Vec<Chosen> = {
            use rayon::prelude::*;
            starts.into_par_iter().map(run).collect()
        };
        #[cfg(not(feature = "threads"))]
        let found: Vec<Chosen> = starts.into_iter().map(run).collect();
        let nothing = Chosen { candidates: Vec::new(), value: f64::NEG_INFINITY };
        let better = |best: Chosen, other: Chosen| if other.value > best.value || best.candidates.is_empty() { other } else { best };
        found.into_iter().fold(nothing, better)
    }

    fn random_set(&self, seed: u64) -> Vec<usize> {
        let mut deviates = Deviates::new(seed);
        let mut chosen = Vec::with_capacity(self.count);
        let mut is_chosen = vec![false; self.candidates];
        while chosen.len() < self.count {
            let candidate = pick(&mut deviates, self.candidates);
            if self.repeats || !std::mem::replace(&mut is_chosen[candidate], true) {
                chosen.push(candidate);
            }
        }
        chosen
    }

    fn disturbed(&self, chosen: &[usize], seed: u64) -> Vec<usize> {
        let mut deviates = Deviates::new(seed);
        let mut copy = chosen.to_vec();
        for _ in 0..copy.len().div_ceil(DISTURBED) {
            let place = pick(&mut deviates, copy.len());
            let candidate = pick(&mut deviates, self.candidates);
            if self.repeats || !copy.contains(&candidate) {
                copy[place] = candidate;
            }
        }
        copy
    }

    /// Exchanges until nothing is gained.
    fn exchanged(&self, mut chosen: Vec<usize>, goes_on: &(dyn Fn(f64) -> bool + Sync)) -> Chosen {
        let mut times = vec![0_u32; self.candidates];
        chosen.iter().for_each(|&candidate| times[candidate] += 1);
        for _ in 0..PASSES {
            let mut gained = false;
            for place in 0..chosen.len() {
                let own = chosen[place];
                let without: Vec<usize> = chosen.iter().enumerate().filter(|(i, _)| *i != place).map(|(_, &candidate)| candidate).collect();
                let inverses: Vec<Matrix> = self.scenarios.iter().map(|scenario| self.inverse(scenario, &without)).collect();
                let mut best = (own, self.score(&inverses, own) + GAIN);
                for (candidate, &times) in times.iter().enumerate() {
                    if (self.repeats || times == 0) && candidate != own {
                        let score = self.score(&inverses, candidate);
                        if score > best.1 {
                            best = (candidate, score);
                        }
                    }
                }
                if best.0 != own {
                    times[own] -= 1;
                    times[best.0] += 1;
                    chosen[place] = best.0;
                    gained = true;
                }
            }
            if !gained || !goes_on(0.0) {
                break;
            }
        }
        chosen.sort_unstable();
        let value = self.value(&chosen);
        Chosen { candidates: chosen, value }
    }

    fn matrix(&self, scenario: &Scenario, chosen: &[usize]) -> DMatrix<f64> {
        let directions = self.directions();
        let mut matrix = scenario.base.clone();
        let length = self.rows_each * directions;
        for &candidate in chosen {
            for row in scenario.rows[candidate * length..(candidate + 1) * length].chunks(directions) {
                for i in 0..directions {
                    for j in 0..directions {
                        matrix[(i, j)] += row[i] * row[j];
                    }
                }
            }
        }
        matrix
    }

    fn inverse(&self, scenario: &Scenario, chosen: &[usize]) -> Matrix {
        let directions = self.directions();
        let mut out = [[0.0; MOST]; MOST];
        #[expect(clippy::cast_precision_loss, reason = "numbers of readings")]
        let ridge = RIDGE * self.count as f64 / self.candidates as f64;
        let matrix = self.matrix(scenario, chosen) + DMatrix::identity(directions, directions) * ridge;
        if let Some(cholesky) = matrix.cholesky() {
            let inverse = cholesky.inverse();
            for i in 0..directions {
                for j in 0..directions {
                    out[i][j] = inverse[(i, j)];
                }
            }
        }
        out
    }

    /// Mean of the objective; −∞ where a direction is left open.
    #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
    pub(crate) fn value(&self, chosen: &[usize]) -> f64 {
        let of = |scenario: &Scenario| {
            let Some(cholesky) = self.matrix(scenario, chosen).cholesky() else { return f64::NEG_INFINITY };
            match self.objective {
                Objective::LogDet => cholesky.ln_determinant(),
                Objective::LogVariance => -libm::log(scenario.contrasts.iter().map(|v| v.dot(&cholesky.solve(v))).sum::<f64>()),
            }
        };
        self.scenarios.iter().map(of).sum::<f64>() / self.scenarios.len().max(1) as f64
    }

    /// What a candidate adds to the sum of the objective, but for what all add, given the inverses without it.
    fn score(&self, inverses: &[Matrix], candidate: usize) -> f64 {
        let length = self.rows_each * self.directions();
        let of = |(scenario, inverse): (&Scenario, &Matrix)| {
            let rows = &scenario.rows[candidate * length..(candidate + 1) * length];
            self.score_in(scenario, inverse, rows)
        };
        self.scenarios.iter().zip(inverses).map(of).sum()
    }

    fn score_in(&self, scenario: &Scenario, inverse: &Matrix, rows: &[f64]) -> f64 {
        let directions = self.directions();
        let (one, other) = rows.split_at(directions);
        let y = times(inverse, one);
        let d11 = 1.0 + dot(one, &y);
        if other.is_empty() {
            return match self.objective {
                Objective::LogDet => libm::log(d11),
                Objective::LogVariance => {
                    let gain = |v: &DVector<f64>| dot(v.as_slice(), &y) * dot(v.as_slice(), &y) / d11;
                    -libm::log(left(scenario, inverse, gain))
                }
            };
        }
        let z = times(inverse, other);
        let (d22, d12) = (1.0 + dot(other, &z), dot(one, &z));
        let det = d11 * d22 - d12 * d12;
        match self.objective {
            Objective::LogDet => libm::log(det),
            Objective::LogVariance => {
                let gain = |v: &DVector<f64>| {
                    let (a, b) = (dot(v.as_slice(), &y), dot(v.as_slice(), &z));
                    (a * a * d22 - 2.0 * a * b * d12 + b * b * d11) / det
                };
                -libm::log(left(scenario, inverse, gain))
            }
        }
    }
}

/// The sum of variances that is left.
fn left(scenario: &Scenario, inverse: &Matrix, gain: impl Fn(&DVector<f64>) -> f64) -> f64 {
    scenario.contrasts.iter().map(|v| dot(v.as_slice(), &times(inverse, v.as_slice())) - gain(v)).sum()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn times(matrix: &Matrix, x: &[f64]) -> [f64; MOST] {
    let mut y = [0.0; MOST];
    for (slot, row) in y.iter_mut().zip(matrix).take(x.len()) {
        *slot = dot(x, row);
    }
    y
}

/// An index below a count.
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index of a list")]
fn pick(deviates: &mut Deviates, count: usize) -> usize {
    ((deviates.uniform() * count as f64) as usize).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::{Exchange, Objective, Scenario};
    use nalgebra::{DMatrix, DVector};

    /// Polynomials of degree 2 on −1 … 1: D-optimal designs put the readings at −1, 0 and 1.
    fn quadratic(count: usize, repeats: bool, objective: Objective) -> Exchange {
        let rows = (0..=20).flat_map(|i| {
            let x = f64::from(i) / 10.0 - 1.0;
            [1.0, x, x * x]
        });
        let scenario =
            Scenario { rows: rows.collect(), base: DMatrix::zeros(3, 3), contrasts: vec![DVector::from_vec(vec![0.0, 0.0, 1.0])] };
        Exchange { scenarios: vec![scenario], candidates: 21, rows_each: 1, count, repeats, objective }
    }

    #[test]
    fn optimal_designs_of_a_parabola_are_found() {
        let chosen = quadratic(6, true, Objective::LogDet).run(&|_| true);
        assert_eq!(chosen.candidates, [0, 0, 10, 10, 20, 20]);
        // For the curvature alone half of the readings lie in the middle.
        let chosen = quadratic(8, true, Objective::LogVariance).run(&|_| true);
        assert_eq!(chosen.candidates, [0, 0, 10, 10, 10, 10, 20, 20]);
    }

    #[test]
    fn no_candidate_is_chosen_twice_without_repeats() {
        let chosen = quadratic(9, false, Objective::LogDet).run(&|_| true);
        let mut once = chosen.candidates.clone();
        once.dedup();
        assert_eq!(once.len(), 9);
    }

    #[test]
    fn scores_are_differences_of_the_objective() {
        for (objective, rows_each) in
            [(Objective::LogDet, 1), (Objective::LogVariance, 1), (Objective::LogDet, 2), (Objective::LogVariance, 2)]
        {
            let exchange = Exchange { rows_each, candidates: 20 / rows_each, ..quadratic(5, true, objective) };
            let set = [0, 4, 9 / rows_each, 7];
            let inverses = vec![exchange.inverse(&exchange.scenarios[0], &set)];
            let with = |candidate: usize| exchange.value(&[&set[..], &[candidate]].concat());
            for candidate in [1, 5, 8] {
                let difference = exchange.score(&inverses, candidate) - exchange.score(&inverses, 2);
                // The ridge of the inverses is left.
                assert!((difference - (with(candidate) - with(2))).abs() < 1e-6, "{objective:?} {rows_each} {candidate}");
            }
        }
    }
}
