//! The fit of one measurement as search, analysis and intervals see it.

use crate::fit::fit_problem::FitProblem;
use crate::fit::multistart::initial_guess::{Guess, SpecularLobes, grid_minima, lobe_grid_minima, total_reflection_minima};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::FitOptions;
use crate::model::{Parameter, ParameterSet, Parameters};
use nalgebra::DVector;

/// Minima of the lobe grid that are followed: those within this factor of the lowest.
const NEAR_LOWEST: f64 = 30.0;

fn points(guesses: Vec<Guess>) -> Vec<Parameters> {
    guesses.into_iter().map(|guess| guess.parameters).collect()
}

impl FitProblem for Problem {
    type Name = Parameter;
    type Point = Parameters;

    fn names(&self) -> &[Parameter] {
        self.free()
    }

    fn start_point(&self) -> &Parameters {
        Self::start(self)
    }

    fn starting_at(&self, point: &Parameters) -> Self {
        self.with_start(*point)
    }

    fn point_at(&self, x: &DVector<f64>) -> Parameters {
        self.parameters_at(x)
    }

    fn options(&self) -> &FitOptions {
        Self::options(self)
    }

    fn knows_only_ratios(&self) -> bool {
        Self::knows_only_ratios(self)
    }

    fn joined(&self, points: &[Parameters]) -> Parameters {
        points.first().copied().unwrap_or(*Self::start(self))
    }

    fn first_guesses(&self, _seed: u64, _observer: Observer<'_>) -> (Vec<Parameters>, usize) {
        (points(grid_minima(self)), 0)
    }

    fn further_starts(&self) -> Vec<Parameters> {
        Self::further_starts(self).to_vec()
    }

    fn lobe_guesses(&self, at: &Parameters) -> Vec<Parameters> {
        let guesses = lobe_grid_minima(self, at);
        let highest = guesses.first().map_or(0.0, |lowest| NEAR_LOWEST * lowest.misfit);
        guesses.into_iter().take_while(|guess| guess.misfit <= highest).map(|guess| guess.parameters).collect()
    }

    fn total_reflection_guesses(&self, at: &Parameters, lobes: SpecularLobes) -> Vec<Parameters> {
        points(total_reflection_minima(self, at, lobes))
    }

    fn guesses_with_held(&self, unknown: usize, x: &DVector<f64>) -> Vec<Parameters> {
        let held = self.free()[unknown];
        let rest: ParameterSet = self.free().iter().copied().filter(|&free| free != held).collect();
        points(grid_minima(&self.with_free(rest).with_start(self.parameters_at(x))))
    }

    fn spread(&self, unknown: usize, fraction: f64, by_factors: bool) -> f64 {
        let parameter = self.free()[unknown];
        if by_factors { self.bounds().spread(parameter, fraction) } else { self.bounds().at(parameter, fraction) }
    }

    fn thinned(&self, most: usize) -> Self {
        Self::thinned(self, most)
    }

    fn resampled(&self, widen: f64, pick: &mut dyn FnMut(usize) -> usize) -> Self {
        Self::resampled(self, widen, pick)
    }

    fn with_squared_loss(&self) -> Self {
        Self::with_squared_loss(self)
    }

    fn with_loss_scale_of(&self, point: &Parameters) -> Self {
        Self::with_loss_scale_of(self, point)
    }

    fn with_loss_scales(&self, loss_scales: [f64; 2]) -> Self {
        Self::with_loss_scales(self, loss_scales)
    }

    fn with_block_weights(&self, block_weights: [f64; 2]) -> Self {
        Self::with_block_weights(self, block_weights)
    }

    fn block_weights(&self) -> [f64; 2] {
        Self::block_weights(self)
    }

    fn loss_scales(&self) -> [f64; 2] {
        Self::loss_scales(self)
    }

    fn scales(&self) -> [f64; 2] {
        self.observations().scales()
    }

    fn block_sums(&self, point: &Parameters) -> [(f64, usize); 2] {
        Self::block_sums(self, point)
    }

    fn has_both_quantities(&self) -> bool {
        self.observations().has_dolp() && self.observations().has_brdf()
    }

    fn loss_scales_of_rows(&self) -> Vec<f64> {
        Self::loss_scales_of_rows(self)
    }

    fn predictions(&self, point: &Parameters) -> Option<Vec<f64>> {
        Self::predictions(self, point)
    }

    fn delta_e(&self, point: &Parameters) -> Option<f64> {
        Self::delta_e(self, point)
    }

    fn rss_scale(&self) -> f64 {
        Self::rss_scale(self)
    }

    fn minimises_delta_e(&self) -> bool {
        Self::minimises_delta_e(self)
    }
}
