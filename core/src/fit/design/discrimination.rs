//! Angles that tell a model from a rival: T-optimal, Atkinson and Fedorov, Biometrika 62, 57 (1975).
//!
//! T of a set is the sum of squares, in units of the noise, that the best fit of the rival leaves. For known rivals the best set is that of
//! the largest smallest sum, a matrix game; its best fit is one more rival, until the game's bound is met. The game is solved by
//! multiplicative weights (Freund and Schapire, Games Econ. Behav. 29, 79 (1999)), and its set improved by exchange.

use crate::fit::bounds::Bounds;
use crate::fit::design::candidates::CandidateGrid;
use crate::fit::design::choice::{AngleChoice, AngleChoiceError, ChosenAngles, DesignCriterion, repeated};
use crate::fit::free_parameters::free_by_default;
use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::multistart::search::{Starts, multistart};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::{FitOptions, Weights};
use crate::measurement::{Measurement, Quantity, Row};
use crate::model::{Model, Parameter, ParameterSet, Parameters, Pbrdf};
use crate::optics::{Facet, GeometryError, SlopeDistribution};

/// Candidates, at most; evenly picked from more.
const MOST_CANDIDATES: usize = 4000;
/// Rivals of a surface, at most: the bound is met long before.
const MOST_RIVALS: usize = 60;
/// Share of the bound that ends the search.
const ENOUGH: f64 = 0.995;
/// Rounds of the matrix game, and the exponent of its weights.
const GAME_ROUNDS: usize = 600;
const GAME_RATE: f64 = 4.0;
/// Rivals that a new fit begins at, those with the smallest sums.
const STARTS: usize = 4;
/// Starts of a thorough fit of a set that may be the answer.
const THOROUGH: usize = 24;

/// A search for angles.
pub(crate) struct Discrimination<'a> {
    pub choice: &'a AngleChoice,
    pub surfaces: &'a [Pbrdf],
    pub rival: Model,
    pub fixed: ParameterSet,
}

/// A rival of one surface: its values, and the square of its residual at each candidate, in units of the noise.
struct Rival {
    surface: usize,
    parameters: Parameters,
    squares: Vec<f64>,
    /// The sum over what is given.
    given: f64,
}

/// A set of places among the candidates, sorted, and its T, averaged over the surfaces.
#[derive(Debug, Clone, PartialEq)]
struct Answer {
    places: Vec<usize>,
    value: f64,
}

impl<'a> Discrimination<'a> {
    /// That of a choice that asks for it.
    pub(crate) fn of(choice: &'a AngleChoice, surfaces: &'a [Pbrdf]) -> Result<Option<Self>, AngleChoiceError> {
        match choice.criterion {
            DesignCriterion::Discrimination { rival, .. } if rival == choice.model => Err(AngleChoiceError::SameModel),
            DesignCriterion::Discrimination { rival, fixed } => Ok(Some(Self { choice, surfaces, rival, fixed })),
            _ => Ok(None),
        }
    }

    pub(crate) fn run(&self, observer: Observer<'_>, goes_on: &dyn Fn(f64) -> bool) -> Result<ChosenAngles, AngleChoiceError> {
        let grid = &self.choice.grid;
        let candidates: Vec<usize> = (0..grid.len()).step_by(grid.len().div_ceil(MOST_CANDIDATES)).collect();
        let mut rivals: Vec<Rival> = Vec::new();
        // Each once, as many as there are.
        let all: Vec<usize> = (0..candidates.len()).collect();
        let of_all = self.fitted(&candidates, &all, &mut rivals, Some(THOROUGH), observer)?;
        let mut best = Answer { places: Vec::new(), value: f64::NEG_INFINITY };
        let mut bound = f64::INFINITY;
        for round in 0..MOST_RIVALS {
            #[expect(clippy::cast_precision_loss, reason = "a number of rounds")]
            let share = (round + 1) as f64 / MOST_RIVALS as f64;
            if !goes_on(share) {
                break;
            }
            let (places, game) = self.game(&rivals, candidates.len());
            bound = bound.min(game);
            let mut value = self.fitted(&candidates, &places, &mut rivals, None, observer)?;
            // Whether a fit from afar is better is worth knowing of an answer only.
            if value > best.value {
                value = value.min(self.fitted(&candidates, &places, &mut rivals, Some(THOROUGH), observer)?);
            }
            if value > best.value {
                best = Answer { places, value };
            }
            if best.value >= ENOUGH * bound {
                break;
            }
        }
        if best.places.is_empty() {
            return Err(AngleChoiceError::Cancelled);
        }
        Ok(ChosenAngles {
            angles: repeated(best.places.iter().map(|&place| grid.angles(candidates[place]))),
            value: best.value,
            of_all_candidates: of_all,
            efficiency: if of_all > 0.0 { best.value / of_all } else { 0.0 },
            left_out: 0,
        })
    }

    /// The squares by which the best fit of the rival to what is given misses the surface at each candidate, averaged over the surfaces; where
    /// so few values are given that the rival meets all of them, its best fit to all candidates.
    pub(crate) fn next_squares(&self, observer: Observer<'_>) -> Result<Vec<f64>, AngleChoiceError> {
        let all: Vec<usize> = (0..self.choice.grid.len()).collect();
        let places: &[usize] = if self.choice.given_values() > self.rival.parameters().len() { &[] } else { &all };
        let mut rivals = Vec::new();
        self.fitted(&all, places, &mut rivals, Some(THOROUGH), observer)?;
        if (observer.cancelled)() || rivals.is_empty() {
            return Err(AngleChoiceError::Cancelled);
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
        let count = rivals.len() as f64;
        Ok(all.iter().map(|&place| rivals.iter().map(|rival| rival.squares[place]).sum::<f64>() / count).collect())
    }

    /// T of a set, averaged over the surfaces; its best fits become rivals. From so many starts, or from the rivals that are known.
    fn fitted(
        &self,
        candidates: &[usize],
        places: &[usize],
        rivals: &mut Vec<Rival>,
        starts: Option<usize>,
        observer: Observer<'_>,
    ) -> Result<f64, AngleChoiceError> {
        let mut sum = 0.0;
        for (i, surface) in self.surfaces.iter().enumerate() {
            let measurement = self.measurement(surface, candidates, places)?;
            let problem = self.problem(surface, &measurement)?;
            let mut known: Vec<(f64, Parameters)> = rivals
                .iter()
                .filter(|rival| rival.surface == i)
                .map(|rival| (places.iter().map(|&place| rival.squares[place]).sum::<f64>() + rival.given, rival.parameters))
                .collect();
            known.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut found: Option<(f64, Parameters)> = None;
            let mut add = |value: f64, parameters: Parameters| {
                if found.is_none_or(|(best, _)| value < best) {
                    found = Some((value, parameters));
                }
            };
            if let Some(count) = starts {
                let basins = multistart(&problem, Starts::Exactly(count), 1, observer).basins;
                basins.first().into_iter().for_each(|basin| add(basin.local_fit.sum_of_squares, basin.local_fit.parameters));
            }
            for (_, parameters) in known.iter().take(STARTS) {
                let fit = fit_local(&problem.with_start(*parameters), Effort::Polish, observer);
                add(fit.sum_of_squares, fit.parameters);
            }
            if let Some((value, parameters)) = found {
                sum += value;
                rivals.push(self.rival(i, parameters, candidates)?);
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
        let count = self.surfaces.len() as f64;
        Ok(sum / count)
    }

    /// The values to be expected at places, each with its standard deviation, and what is given.
    fn measurement(&self, surface: &Pbrdf, candidates: &[usize], places: &[usize]) -> Result<Measurement, GeometryError> {
        let mut rows = Vec::with_capacity(places.len());
        for &place in places {
            rows.push(self.row(surface, self.choice.grid.geometry(candidates[place])?));
        }
        // What is given is taken as the surface has it: its noise tells nothing of the rival.
        rows.extend(self.choice.given.iter().filter(|row| !row.masked).map(|row| self.row(surface, row.geometry)));
        Ok(Measurement { rows, ..Measurement::default() })
    }

    fn row(&self, surface: &Pbrdf, geometry: crate::optics::Geometry) -> Row {
        let reflection = surface.reflection(&Facet::new(geometry));
        let quantity = |value: f64, sigma: f64| (sigma > 0.0).then_some(Quantity { value, sigma: Some(sigma) });
        let noise = self.choice.noise;
        Row {
            geometry,
            dolp: noise.dolp.and_then(|sigma| quantity(reflection.dolp, sigma)),
            brdf: noise.brdf.and_then(|relative| quantity(reflection.brdf, relative * reflection.brdf)),
            masked: false,
        }
    }

    fn problem(&self, surface: &Pbrdf, measurement: &Measurement) -> Result<Problem, AngleChoiceError> {
        let options = FitOptions { weights: Weights::Sigma, ..FitOptions::default() };
        let free = free_by_default(self.rival, measurement, &options).without_all(self.fixed);
        let bounds = Bounds::default();
        let truth = *surface.parameters();
        let mut start = truth;
        if self.rival.distribution == SlopeDistribution::Gauss && surface.model().distribution == SlopeDistribution::Cauchy {
            // The Gauss distribution of the same curvature at the peak.
            start.sigma = truth.sigma / truth.q.sqrt();
        }
        for parameter in free {
            start[parameter] = bounds.clamp(parameter, start[parameter]);
        }
        for parameter in Parameter::ALL.into_iter().filter(|&parameter| self.fixed.contains(parameter)) {
            start[parameter] = truth[parameter];
        }
        Ok(Problem::new(measurement, self.rival, start, free, bounds, options)?)
    }

    fn rival(&self, surface: usize, parameters: Parameters, candidates: &[usize]) -> Result<Rival, AngleChoiceError> {
        let other = Pbrdf::new(self.rival, parameters)?;
        let square = |geometry: crate::optics::Geometry| {
            let (row, rival) = (self.row(&self.surfaces[surface], geometry), other.reflection(&Facet::new(geometry)));
            let of = |quantity: Option<Quantity>, value: f64| {
                quantity.map_or(0.0, |quantity| ((value - quantity.value) / quantity.sigma.unwrap_or(f64::INFINITY)).powi(2))
            };
            of(row.dolp, rival.dolp) + of(row.brdf, rival.brdf)
        };
        let grid: &CandidateGrid = &self.choice.grid;
        let squares: Result<Vec<f64>, GeometryError> = candidates.iter().map(|&candidate| grid.geometry(candidate).map(square)).collect();
        let given = self.choice.given.iter().filter(|row| !row.masked).map(|row| square(row.geometry)).sum();
        Ok(Rival { surface, parameters, squares: squares?, given })
    }

    /// The set with the largest smallest sum over the rivals, averaged over surfaces, and a bound that no set passes.
    fn game(&self, rivals: &[Rival], candidates: usize) -> (Vec<usize>, f64) {
        let count = self.choice.count;
        #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
        let surfaces = self.surfaces.len() as f64;
        let scale = rivals.iter().map(|rival| rival.squares.iter().copied().fold(0.0, f64::max)).fold(f64::MIN_POSITIVE, f64::max);
        let mut payoff = vec![0.0; rivals.len()];
        let mut often = vec![0_u32; candidates];
        let mut bound = f64::INFINITY;
        let mut order: Vec<usize> = (0..candidates).collect();
        for round in 0..GAME_ROUNDS {
            let weights = self.weights(rivals, &payoff, round);
            let worth = |place: usize| rivals.iter().zip(&weights).map(|(rival, weight)| weight * rival.squares[place]).sum::<f64>();
            let worths: Vec<f64> = (0..candidates).map(worth).collect();
            order.sort_by(|&a, &b| worths[b].total_cmp(&worths[a]).then(a.cmp(&b)));
            let taken: Vec<usize> = if self.choice.repeats { vec![order[0]; count] } else { order[..count].to_vec() };
            let given: f64 = rivals.iter().zip(&weights).map(|(rival, weight)| weight * rival.given).sum();
            bound = bound.min((taken.iter().map(|&place| worths[place]).sum::<f64>() + given) / surfaces);
            for (slot, rival) in payoff.iter_mut().zip(rivals) {
                *slot += (taken.iter().map(|&place| rival.squares[place]).sum::<f64>() + rival.given) / scale;
            }
            taken.iter().for_each(|&place| often[place] += 1);
        }
        let mut set = self.rounded(&often, count);
        self.improve(rivals, &mut set, candidates);
        set.sort_unstable();
        (set, bound)
    }

    /// Weights of the rivals, those of one surface adding up to 1: exponentials of their mean payoff so far, the smaller the heavier.
    fn weights(&self, rivals: &[Rival], payoff: &[f64], round: usize) -> Vec<f64> {
        #[expect(clippy::cast_precision_loss, reason = "a number of rounds")]
        let rate = GAME_RATE / ((round + 1) as f64).sqrt();
        let mut weights = vec![0.0; rivals.len()];
        for surface in 0..self.surfaces.len() {
            let own = || (0..rivals.len()).filter(|&k| rivals[k].surface == surface);
            let least = own().map(|k| payoff[k]).fold(f64::INFINITY, f64::min);
            own().for_each(|k| weights[k] = libm::exp(-rate * (payoff[k] - least)));
            let sum: f64 = own().map(|k| weights[k]).sum();
            own().for_each(|k| weights[k] /= sum);
        }
        weights
    }

    /// The set that was taken most often.
    fn rounded(&self, often: &[u32], count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..often.len()).collect();
        order.sort_by(|&a, &b| often[b].cmp(&often[a]).then(a.cmp(&b)));
        if !self.choice.repeats {
            return order[..count].to_vec();
        }
        // Each by its share, the largest remainders first.
        let whole: u64 = often.iter().map(|&times| u64::from(times)).sum();
        let share = |place: usize| u64::from(often[place]) * count as u64;
        let mut set: Vec<usize> =
            order.iter().flat_map(|&place| std::iter::repeat_n(place, usize::try_from(share(place) / whole.max(1)).unwrap_or(0))).collect();
        order.sort_by_key(|&place| std::cmp::Reverse(share(place) % whole.max(1)));
        set.extend(order.iter().copied().cycle().take(count.saturating_sub(set.len())));
        set
    }

    /// Exchanges readings while the smallest sum grows.
    fn improve(&self, rivals: &[Rival], set: &mut [usize], candidates: usize) {
        let mut sums: Vec<f64> =
            rivals.iter().map(|rival| set.iter().map(|&place| rival.squares[place]).sum::<f64>() + rival.given).collect();
        let mut is_taken = vec![false; candidates];
        set.iter().for_each(|&place| is_taken[place] = true);
        let mut value = self.smallest(rivals, &mut sums.iter().copied());
        loop {
            let mut gained = false;
            for slot in &mut *set {
                let own = *slot;
                let mut best = (own, value);
                for place in (0..candidates).filter(|&place| self.choice.repeats || !is_taken[place]) {
                    let mut changed = sums.iter().zip(rivals).map(|(sum, rival)| sum + rival.squares[place] - rival.squares[own]);
                    let other = self.smallest(rivals, &mut changed);
                    if other > best.1 * (1.0 + 1e-9) {
                        best = (place, other);
                    }
                }
                if best.0 != own {
                    sums.iter_mut().zip(rivals).for_each(|(sum, rival)| *sum += rival.squares[best.0] - rival.squares[own]);
                    is_taken[own] = false;
                    is_taken[best.0] = true;
                    *slot = best.0;
                    value = best.1;
                    gained = true;
                }
            }
            if !gained {
                return;
            }
        }
    }

    /// The smallest sum of each surface, averaged.
    fn smallest(&self, rivals: &[Rival], sums: &mut dyn Iterator<Item = f64>) -> f64 {
        let mut least = vec![f64::INFINITY; self.surfaces.len()];
        for (rival, sum) in rivals.iter().zip(sums) {
            least[rival.surface] = least[rival.surface].min(sum);
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
        let count = least.len() as f64;
        least.iter().sum::<f64>() / count
    }
}
