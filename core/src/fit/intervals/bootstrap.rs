//! Residual bootstrap: how the estimates scatter when the residuals of the fit are resampled.
//!
//! The data of a replicate are the fitted values plus residuals drawn with replacement, widened by `√(N/(N − rank))` because the fit
//! has made them smaller (Efron and Tibshirani, *An Introduction to the Bootstrap*, 1993, ch. 9). Each replicate is fitted
//! from several starts, the solution among them.

use crate::fit::analysis::Analysis;
use crate::fit::fit_problem::FitProblem;
use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::multistart::sequence::StartSequence;
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::result::FitResult;
use crate::model::Parameter;
use nalgebra::DVector;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// How one parameter scatters over the replicates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BootstrapEstimate<N = Parameter> {
    /// Which parameter.
    pub parameter: N,
    /// Standard deviation.
    pub std_error: f64,
    /// 16th percentile.
    pub low: f64,
    /// 84th percentile.
    pub high: f64,
}

/// How the parameters scatter over the replicates.
#[derive(Debug, Clone, PartialEq)]
pub struct Bootstrap<N = Parameter> {
    /// How many data sets were asked for.
    pub asked: usize,
    /// How many were fitted to the end: fewer after a cancel.
    pub replicates: usize,
    /// The free parameters; empty without a replicate.
    pub estimates: Vec<BootstrapEstimate<N>>,
}

impl<N> Bootstrap<N> {
    /// Whether all data sets were fitted that were asked for.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.replicates == self.asked
    }
}

/// Data sets that are held in memory at once.
const AT_ONCE: usize = 64;
/// Starts of each refit: the solution, and so many more of the other minima of the fit and of the points a search begins at. Noise may
/// make another minimum the best.
const STARTS: usize = 4;

/// Refits `replicates` data sets, each from several starts within the bounds; those that were not fitted to the end before a cancel are
/// left out.
#[must_use]
pub fn bootstrap(problem: &Problem, report: &FitResult, replicates: usize, seed: u64, watch: Observer<'_>) -> Bootstrap {
    bootstrap_of(problem, &Analysis::of_result(problem, report.clone()), replicates, seed, watch)
}

/// The same of any problem.
pub(crate) fn bootstrap_of<P: FitProblem>(
    problem: &P,
    analysis: &Analysis<P>,
    replicates: usize,
    seed: u64,
    watch: Observer<'_>,
) -> Bootstrap<P::Name> {
    let none = Bootstrap { asked: replicates, replicates: 0, estimates: Vec::new() };
    if problem.residual_count() == 0 || problem.names().is_empty() {
        return none;
    }
    let mut random = Pcg64::seed_from_u64(seed);
    #[expect(clippy::cast_possible_truncation, reason = "the remainder is below the number of residuals")]
    let mut pick = |count: usize| (random.next_u64() % count as u64) as usize;
    #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
    let widen = (problem.residual_count() as f64 / analysis.statistics.dof.max(1) as f64).sqrt();
    let solution = analysis.fitted(problem).starting_at(&problem.point_at(&analysis.x));
    let starts = starts(problem, analysis, seed);
    let refit = |replicate: &P| {
        let fits = starts.iter().map(|start| fit_local(&replicate.starting_at(start), Effort::Thorough, watch));
        let best = fits.min_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares))?;
        // A descent that a cancel has cut short is no refit.
        (best.sum_of_squares.is_finite() && !(watch.cancelled)()).then(|| replicate.unknowns_of(&best.parameters))
    };
    let mut fits: Vec<DVector<f64>> = Vec::new();
    let mut left = replicates;
    // Data sets are drawn in their order, and no more of them are held than are being fitted.
    while left > 0 && !(watch.cancelled)() {
        let drawn: Vec<P> = (0..left.min(AT_ONCE)).map(|_| solution.resampled(widen, &mut pick)).collect();
        left -= drawn.len();
        fits.extend(refit_all(&drawn, &refit));
    }
    if fits.is_empty() {
        return none;
    }
    let scatter = |(unknown, name): (usize, &P::Name)| scatter(name.clone(), fits.iter().map(|fit| fit[unknown]).collect());
    Bootstrap { replicates: fits.len(), estimates: problem.names().iter().enumerate().map(scatter).collect(), ..none }
}

/// The solution, the next best minima of the fit, and points that a search begins at.
fn starts<P: FitProblem>(problem: &P, analysis: &Analysis<P>, seed: u64) -> Vec<P::Point> {
    let minima = analysis.course.minima.iter().skip(1).map(|minimum| minimum.parameters.clone());
    let mut starts: Vec<P::Point> = std::iter::once(problem.point_at(&analysis.x)).chain(minima).take(STARTS).collect();
    if starts.len() < STARTS {
        let further = StartSequence::new(problem, seed, Observer::NONE).take(STARTS - starts.len());
        starts.extend(further);
    }
    starts
}

/// Fits of those data sets, in their order; none of those that came after a cancel.
fn refit_all<P: FitProblem>(drawn: &[P], refit: &(dyn Fn(&P) -> Option<DVector<f64>> + Sync)) -> Vec<DVector<f64>> {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        drawn.par_iter().filter_map(refit).collect()
    }
    #[cfg(not(feature = "threads"))]
    drawn.iter().filter_map(refit).collect()
}

fn scatter<N>(parameter: N, mut values: Vec<f64>) -> BootstrapEstimate<N> {
    values.sort_by(f64::total_cmp);
    #[expect(clippy::cast_precision_loss, reason = "a number of replicates")]
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0).max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index into the values")]
    let at = |fraction: f64| values[((count - 1.0) * fraction).round() as usize];
    BootstrapEstimate { parameter, std_error: variance.sqrt(), low: at(0.16), high: at(0.84) }
}
