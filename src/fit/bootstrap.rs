//! Residual bootstrap: how the fit scatters when its own residuals are dealt out anew.
//!
//! Data of each replicate are the fitted values and residuals drawn with replacement, widened by `√(N/(N − rank))` for what the
//! fit took out of them (Efron and Tibshirani, *An Introduction to the Bootstrap*, 1993, ch. 9). Each replicate is fitted from the solution.

use super::outcome::FitReport;
use super::problem::Problem;
use super::solver::{Effort, Watch, descend};
use crate::model::Parameter;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// How one parameter scatters over the replicates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// Which parameter.
    pub parameter: Parameter,
    /// Standard deviation.
    pub std_error: f64,
    /// 16th percentile.
    pub low: f64,
    /// 84th percentile.
    pub high: f64,
}

/// Refits `replicates` data sets; those that were not reached before a cancel are left out.
#[must_use]
pub fn bootstrap(problem: &Problem, report: &FitReport, replicates: usize, seed: u64, watch: Watch<'_>) -> Vec<Scatter> {
    if problem.is_empty() || problem.free().is_empty() {
        return Vec::new();
    }
    let mut random = Pcg64::seed_from_u64(seed);
    #[expect(clippy::cast_possible_truncation, reason = "the remainder is below the number of residuals")]
    let mut pick = |count: usize| (random.next_u64() % count as u64) as usize;
    #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
    let widen = (problem.len() as f64 / report.dof.max(1) as f64).sqrt();
    let problems: Vec<Problem> = (0..replicates).map(|_| problem.with_start(report.parameters).resampled(widen, &mut pick)).collect();
    let refit = |replicate: &Problem| (!(watch.cancelled)()).then(|| descend(replicate, Effort::Full, watch).parameters);
    #[cfg(feature = "threads")]
    let fits: Vec<_> = {
        use rayon::prelude::*;
        problems.par_iter().filter_map(refit).collect()
    };
    #[cfg(not(feature = "threads"))]
    let fits: Vec<_> = problems.iter().filter_map(refit).collect();
    if fits.is_empty() {
        return Vec::new();
    }
    let scatter = |&parameter: &Parameter| scatter(parameter, fits.iter().map(|fit| fit[parameter]).collect());
    problem.free().iter().map(scatter).collect()
}

fn scatter(parameter: Parameter, mut values: Vec<f64>) -> Scatter {
    values.sort_by(f64::total_cmp);
    #[expect(clippy::cast_precision_loss, reason = "a number of replicates")]
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0).max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index into the values")]
    let at = |fraction: f64| values[((count - 1.0) * fraction).round() as usize];
    Scatter { parameter, std_error: variance.sqrt(), low: at(0.16), high: at(0.84) }
}
