//! Residual bootstrap: how the estimates scatter when the residuals of the fit are resampled.
//!
//! The data of a replicate are the fitted values plus residuals drawn with replacement, widened by `√(N/(N − rank))` because the fit
//! has made them smaller (Efron and Tibshirani, *An Introduction to the Bootstrap*, 1993, ch. 9). Each replicate is fitted from the solution.

use crate::fit::local::solver::{Effort, fit_local};
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::result::FitResult;
use crate::model::{Parameter, Parameters};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// How one parameter scatters over the replicates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BootstrapEstimate {
    /// Which parameter.
    pub parameter: Parameter,
    /// Standard deviation.
    pub std_error: f64,
    /// 16th percentile.
    pub low: f64,
    /// 84th percentile.
    pub high: f64,
}

/// Data sets that are held in memory at once.
const AT_ONCE: usize = 64;

/// Refits `replicates` data sets; those that were not reached before a cancel are left out.
#[must_use]
pub fn bootstrap(problem: &Problem, report: &FitResult, replicates: usize, seed: u64, watch: Observer<'_>) -> Vec<BootstrapEstimate> {
    if problem.is_empty() || problem.free().is_empty() {
        return Vec::new();
    }
    let mut random = Pcg64::seed_from_u64(seed);
    #[expect(clippy::cast_possible_truncation, reason = "the remainder is below the number of residuals")]
    let mut pick = |count: usize| (random.next_u64() % count as u64) as usize;
    #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
    let widen = (problem.len() as f64 / report.statistics.dof.max(1) as f64).sqrt();
    let solution = report.fitted(problem).with_start(report.parameters);
    let refit = |replicate: &Problem| (!(watch.cancelled)()).then(|| fit_local(replicate, Effort::Thorough, watch).parameters);
    let mut fits = Vec::new();
    let mut left = replicates;
    // Data sets are drawn in their order, and no more of them are held than are being fitted.
    while left > 0 && !(watch.cancelled)() {
        let drawn: Vec<Problem> = (0..left.min(AT_ONCE)).map(|_| solution.resampled(widen, &mut pick)).collect();
        left -= drawn.len();
        fits.extend(refit_all(&drawn, &refit));
    }
    if fits.is_empty() {
        return Vec::new();
    }
    let scatter = |&parameter: &Parameter| scatter(parameter, fits.iter().map(|fit| fit[parameter]).collect());
    problem.free().iter().map(scatter).collect()
}

/// Fits of those data sets, in their order; none of those that came after a cancel.
fn refit_all(drawn: &[Problem], refit: &(dyn Fn(&Problem) -> Option<Parameters> + Sync)) -> Vec<Parameters> {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        drawn.par_iter().filter_map(refit).collect()
    }
    #[cfg(not(feature = "threads"))]
    drawn.iter().filter_map(refit).collect()
}

fn scatter(parameter: Parameter, mut values: Vec<f64>) -> BootstrapEstimate {
    values.sort_by(f64::total_cmp);
    #[expect(clippy::cast_precision_loss, reason = "a number of replicates")]
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0).max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index into the values")]
    let at = |fraction: f64| values[((count - 1.0) * fraction).round() as usize];
    BootstrapEstimate { parameter, std_error: variance.sqrt(), low: at(0.16), high: at(0.84) }
}
