//! Where the search of a joint fit starts, and what search, analysis and intervals need to know of it.
//!
//! The measurements are first fitted by themselves. Each of their minima proposes the shared parameters, and the own parameters of the other
//! measurements are fitted to that proposal. Beside them, the grid of all rows under one surface makes guesses.

use crate::fit::fit_problem::FitProblem;
use crate::fit::joint::problem::JointProblem;
use crate::fit::joint::unknown::JointUnknown;
use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::multistart::search::{Starts, multistart};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::FitOptions;
use crate::model::{Parameter, ParameterSet, Parameters};
use nalgebra::DVector;

/// Minima of all measurements that become starts, at most.
const DONORS: usize = 24;
/// Minima of one measurement that become starts, at most.
const DONORS_OF_ONE: usize = 6;
/// Own minima of a measurement that its own parameters are fitted from, at most.
const OWN_STARTS: usize = 2;
/// Minima of the grid of all rows that become starts, at most.
const GRID_GUESSES: usize = 24;
/// Guesses of other lobes, at most.
const LOBE_GUESSES: usize = 6;
/// Guesses with an unknown held, at most.
const HELD_GUESSES: usize = 4;

impl JointProblem {
    /// All rows under one surface.
    fn pooled(&self) -> Option<Problem> {
        Problem::pooled(self.parts()).map(|pooled| pooled.with_start(Self::start(self)[0]))
    }

    fn has_own(&self) -> bool {
        self.parts().len() > 1 && self.unknowns().iter().any(|unknown| unknown.set.is_some())
    }

    /// A measurement by itself, k_s held where its data know ratios only.
    fn alone(&self, part: usize) -> Problem {
        let problem = self.parts()[part].with_start(Self::start(self)[part]);
        let free: ParameterSet = problem.free().iter().copied().collect();
        if problem.knows_only_ratios() { problem.with_free(free.without(Parameter::Ks)) } else { problem }
    }

    /// The point with the shared parameters of one measurement's surface, and all of its parameters for that measurement.
    fn proposed(&self, base: &[Parameters], part: usize, surface: &Parameters) -> Vec<Parameters> {
        let mut point = base.to_vec();
        for parameter in self.unknowns().iter().filter(|unknown| unknown.set.is_none()).map(|unknown| unknown.parameter) {
            point.iter_mut().for_each(|parameters| parameters[parameter] = surface[parameter]);
        }
        for &parameter in self.parts()[part].free().iter().filter(|&&parameter| self.own().contains(parameter)) {
            point[part][parameter] = surface[parameter];
        }
        point
    }

    /// The point with the own parameters of the other measurements fitted, from where they are and from those surfaces.
    fn with_own_fitted(
        &self,
        mut point: Vec<Parameters>,
        except: usize,
        from: &dyn Fn(usize) -> Vec<Parameters>,
        observer: Observer<'_>,
    ) -> (Vec<Parameters>, usize) {
        let mut evaluations = 0;
        for part in (0..point.len()).filter(|&part| part != except) {
            let own: ParameterSet = self.parts()[part].free().iter().copied().collect::<ParameterSet>().intersection(self.own());
            let problem = self.parts()[part].with_free(own);
            if own.is_empty() || problem.is_empty() {
                continue;
            }
            let start_of = |surface: &Parameters| {
                let mut start = point[part];
                own.iter().for_each(|parameter| start[parameter] = surface[parameter]);
                start
            };
            let starts: Vec<Parameters> = from(part).iter().map(start_of).chain([point[part]]).collect();
            let fits = starts.iter().map(|start| fit_local(&problem.with_start(*start), Effort::Coarse, observer));
            let mut best = (f64::INFINITY, point[part]);
            for fit in fits {
                evaluations += fit.evaluations;
                if fit.sum_of_squares < best.0 {
                    best = (fit.sum_of_squares, fit.parameters);
                }
            }
            point[part] = best.1;
        }
        (point, evaluations)
    }

    /// Starts from the minima of each measurement by itself, the best of each first.
    fn donors(&self, seed: u64, observer: Observer<'_>) -> (Vec<Vec<Parameters>>, usize) {
        let quiet = Observer { progress: &|_| {}, ..observer };
        let mut minima: Vec<Vec<Parameters>> = Vec::new();
        let mut evaluations = 0;
        for part in 0..self.parts().len() {
            let search = multistart(&self.alone(part), Starts::Automatic, seed, quiet);
            evaluations += search.evaluations;
            minima.push(search.basins.iter().map(|basin| basin.local_fit.parameters).collect());
        }
        let each = (DONORS / minima.len()).clamp(1, DONORS_OF_ONE);
        let from = |part: usize| minima[part].iter().take(OWN_STARTS).copied().collect::<Vec<Parameters>>();
        let mut starts = Vec::new();
        for rank in 0..each {
            for (part, surface) in minima.iter().enumerate().filter_map(|(part, minima)| Some((part, minima.get(rank)?))) {
                let best: Vec<Parameters> = minima.iter().map(|minima| minima[0]).collect();
                let point = self.proposed(&best, part, surface);
                let (point, taken) = self.with_own_fitted(point, part, &from, quiet);
                evaluations += taken;
                starts.push(point);
            }
        }
        (starts, evaluations)
    }

    /// Starts from the grid of all rows under one surface.
    fn grid_starts(&self, seed: u64, observer: Observer<'_>) -> Vec<Vec<Parameters>> {
        let guesses = self.pooled().map_or_else(Vec::new, |pooled| pooled.first_guesses(seed, observer).0);
        let everywhere = |surface: &Parameters| {
            (0..self.parts().len()).fold(Self::start(self).to_vec(), |point, part| self.proposed(&point, part, surface))
        };
        let most = if self.has_own() { GRID_GUESSES } else { guesses.len() };
        guesses.iter().take(most).map(everywhere).collect()
    }
}

/// One of each list after the other.
fn in_turns<T>(lists: Vec<Vec<T>>) -> Vec<T> {
    let mut lists: Vec<_> = lists.into_iter().map(Vec::into_iter).collect();
    let mut all = Vec::new();
    loop {
        let before = all.len();
        all.extend(lists.iter_mut().filter_map(Iterator::next));
        if all.len() == before {
            return all;
        }
    }
}

impl FitProblem for JointProblem {
    type Name = JointUnknown;
    type Point = Vec<Parameters>;

    fn names(&self) -> &[JointUnknown] {
        self.unknowns()
    }

    fn start_point(&self) -> &Vec<Parameters> {
        self.start_list()
    }

    fn starting_at(&self, point: &Vec<Parameters>) -> Self {
        self.with_start(point)
    }

    fn point_at(&self, x: &DVector<f64>) -> Vec<Parameters> {
        self.parameters_of(x)
    }

    fn unknowns_of(&self, point: &Vec<Parameters>) -> DVector<f64> {
        self.unknowns_at(point)
    }

    fn options(&self) -> &FitOptions {
        Self::options(self)
    }

    fn knows_only_ratios(&self) -> bool {
        Self::knows_only_ratios(self)
    }

    fn is_composed(&self) -> bool {
        self.has_own()
    }

    fn apart(&self) -> Vec<Self> {
        if self.is_separable() { self.split() } else { Vec::new() }
    }

    fn joined(&self, points: &[Vec<Parameters>]) -> Vec<Parameters> {
        points.concat()
    }

    fn first_guesses(&self, seed: u64, observer: Observer<'_>) -> (Vec<Vec<Parameters>>, usize) {
        let grid = self.grid_starts(seed, observer);
        if !self.has_own() {
            return (grid, 0);
        }
        let (donors, evaluations) = self.donors(seed, observer);
        let all = donors.len() + grid.len();
        let sum = |point: &Vec<Parameters>| self.sum_of_squares_at(&self.unknowns_at(point)).unwrap_or(f64::INFINITY);
        let mut ranked: Vec<(f64, Vec<Parameters>)> = donors.into_iter().chain(grid).map(|point| (sum(&point), point)).collect();
        ranked.sort_by(|one, other| one.0.total_cmp(&other.0));
        ranked.dedup_by(|one, other| one.0 == other.0);
        (ranked.into_iter().map(|(_, point)| point).collect(), evaluations + all)
    }

    fn lobe_guesses(&self, at: &Vec<Parameters>) -> Vec<Vec<Parameters>> {
        if let Some(pooled) = self.pooled().filter(|_| !self.has_own()) {
            return pooled.lobe_guesses(&at[0]).iter().map(|guess| vec![*guess; at.len()]).collect();
        }
        let of_part = |part: usize| {
            let guesses = self.alone(part).lobe_guesses(&at[part]);
            guesses.into_iter().take(LOBE_GUESSES).map(|guess| (part, guess)).collect()
        };
        let guesses = in_turns((0..at.len()).map(of_part).collect());
        let fitted = |(part, surface): &(usize, Parameters)| {
            self.with_own_fitted(self.proposed(at, *part, surface), *part, &|_| Vec::new(), Observer::NONE).0
        };
        guesses.iter().take(LOBE_GUESSES).map(fitted).collect()
    }

    fn guesses_with_held(&self, unknown: usize, x: &DVector<f64>) -> Vec<Vec<Parameters>> {
        let point = self.parameters_of(x);
        let parts: Vec<usize> = self.set_of(unknown).map_or_else(|| (0..point.len()).collect(), |set| vec![set]);
        let held = self.unknowns()[unknown].parameter;
        let of_part = |&part: &usize| {
            let alone = self.alone(part).with_start(point[part]);
            let rest: ParameterSet = alone.free().iter().copied().filter(|&free| free != held).collect();
            let guesses = alone.with_free(rest).first_guesses(0, Observer::NONE).0;
            guesses.into_iter().take(HELD_GUESSES).map(|guess| (part, guess)).collect()
        };
        let guesses = in_turns(parts.iter().map(of_part).collect());
        let fitted = |(part, surface): &(usize, Parameters)| {
            self.with_own_fitted(self.proposed(&point, *part, surface), *part, &|_| Vec::new(), Observer::NONE).0
        };
        guesses.iter().take(HELD_GUESSES).map(fitted).collect()
    }

    fn spread(&self, unknown: usize, fraction: f64, by_factors: bool) -> f64 {
        let (part, place) = self.home(unknown);
        self.parts()[part].spread(place, fraction, by_factors)
    }

    fn thinned(&self, most: usize) -> Self {
        Self::thinned(self, most)
    }

    fn further_starts(&self) -> Vec<Vec<Parameters>> {
        Self::further_starts(self).to_vec()
    }

    fn resampled(&self, widen: f64, pick: &mut dyn FnMut(usize) -> usize) -> Self {
        Self::resampled(self, widen, pick)
    }

    fn with_squared_loss(&self) -> Self {
        Self::with_squared_loss(self)
    }

    fn with_loss_scale_of(&self, point: &Vec<Parameters>) -> Self {
        Self::with_loss_scale_of(self, point)
    }

    fn with_loss_scales(&self, loss_scales: [f64; 2]) -> Self {
        Self::with_loss_scales(self, loss_scales)
    }

    fn with_block_weights(&self, block_weights: [f64; 2]) -> Self {
        Self::with_block_weights(self, block_weights)
    }

    fn block_weights(&self) -> [f64; 2] {
        self.parts()[0].block_weights()
    }

    fn loss_scales(&self) -> [f64; 2] {
        self.parts()[0].loss_scales()
    }

    fn scales(&self) -> [f64; 2] {
        self.parts()[0].observations().scales()
    }

    fn block_sums(&self, point: &Vec<Parameters>) -> [(f64, usize); 2] {
        Self::block_sums(self, point)
    }

    fn has_both_quantities(&self) -> bool {
        self.has() == [true; 2]
    }

    fn loss_scales_of_rows(&self) -> Vec<f64> {
        self.parts().iter().flat_map(Problem::loss_scales_of_rows).collect()
    }

    fn predictions(&self, point: &Vec<Parameters>) -> Option<Vec<f64>> {
        Self::predictions(self, point)
    }

    fn delta_e(&self, point: &Vec<Parameters>) -> Option<f64> {
        Self::delta_e(self, point)
    }

    fn rss_scale(&self) -> f64 {
        Self::rss_scale(self)
    }

    fn minimises_delta_e(&self) -> bool {
        Self::minimises_delta_e(self)
    }
}
