//! Several chains of the no-U-turn sampler, which share what they learn of the density during the warm-up.
//!
//! Warm-up in windows of growing length: within each a chain adapts its step size, after each all chains take the covariance of all their
//! draws of the window for their metric. Chains run in parallel where there are threads, each with its own random numbers, and meet
//! after each block of draws: no draw depends on the number of threads.

use crate::fit::posterior::diagnostics::convergence;
use crate::fit::posterior::log_density::LogDensity;
use crate::fit::posterior::metric::{Metric, Whitened};
use crate::fit::posterior::nuts::Nuts;
use crate::fit::posterior::step_size::DualAveraging;
use crate::measurement::Deviates;

/// Draws of the windows of a warm-up. The first forgets the starts, the last settles the step size.
const WINDOWS: [usize; 6] = [100, 100, 150, 250, 400, 150];
/// What exp(−|ΔE|) of an undivided step is on average, ΔE its change of the energy.
const ACCEPTANCE: f64 = 0.8;
/// Effective draws of the worst coordinate that one draw is to be worth, at least.
const WORTH: f64 = 0.15;
/// Thinning: transitions from one draw to the next, at most.
const MOST_THINNING: f64 = 8.0;
/// Draws of each chain between two meetings after the warm-up.
const BLOCK: usize = 250;

/// Draws of one chain after the warm-up, in ℝᵈ.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ChainDraws {
    pub points: Vec<Vec<f64>>,
    /// Logarithm of the density at each, in ℝᵈ.
    pub log_density: Vec<f64>,
    pub divergences: usize,
    /// Trajectories that were cut at their greatest length.
    pub cut: usize,
    /// Transitions: one or more from draw to draw.
    pub transitions: usize,
    /// Sum over the transitions of [`Transition::acceptance`](crate::fit::posterior::nuts::Transition).
    pub acceptance: f64,
    /// Evaluations of value and gradient, those of the warm-up among them.
    pub evaluations: usize,
}

/// Draws of all chains, and the coordinates that they were made in.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sampled {
    pub chains: Vec<ChainDraws>,
    pub metric: Metric,
}

/// A chain under way.
struct Chain<D> {
    density: D,
    position: Vec<f64>,
    deviates: Deviates,
    step_size: f64,
    evaluations: usize,
    /// Draws of the present window.
    window: ChainDraws,
}

/// How the chains step.
#[derive(Debug, Clone, Copy)]
struct Pace {
    /// Whether the step size is adapted.
    adapts: bool,
    /// Transitions from one draw to the next.
    thinning: usize,
}

/// How far the chains are, 0 to 1, the warm-up being a part of it.
pub(crate) type ReportProgress<'a> = &'a mut dyn FnMut(f64, &[ChainDraws]);

impl<D: LogDensity> Chain<D> {
    /// Draws with that metric; adapts the step size if asked to. Ends early where cancelled.
    fn run(&mut self, metric: &Metric, count: usize, pace: Pace, cancelled: &(dyn Fn() -> bool + Sync)) {
        let Self { density, position, deviates, step_size, evaluations, window } = self;
        let mut whitened = Whitened::new(density, metric);
        let Some(here) = metric.to_whitened(position) else { return };
        let mut nuts = Nuts::new(&mut whitened, &here);
        let mut adapted = None;
        if pace.adapts {
            adapted = Some(DualAveraging::new(nuts.reasonable_step_size(&mut whitened, deviates), ACCEPTANCE));
        }
        *window = ChainDraws::default();
        for _ in 0..count {
            if cancelled() {
                break;
            }
            for _ in 0..pace.thinning {
                let transition = nuts.advance(&mut whitened, adapted.map_or(*step_size, |adapted| adapted.step_size()), deviates);
                if let Some(adapted) = &mut adapted {
                    adapted.update(transition.acceptance);
                }
                window.divergences += usize::from(transition.diverged);
                window.cut += usize::from(transition.cut);
                window.acceptance += transition.acceptance;
            }
            window.transitions += pace.thinning;
            metric.to_density(nuts.position(), position);
            window.points.push(position.clone());
            window.log_density.push(nuts.log_density());
        }
        if let Some(adapted) = adapted {
            *step_size = adapted.average();
        }
        *evaluations += whitened.evaluations;
    }
}

/// Draws so many after the warm-up from each start; none where the density is not finite around the first start.
///
/// Cancelled, it returns the draws so far.
pub(crate) fn draw_chains<D: LogDensity + Clone + Send>(
    density: &D,
    starts: &[Vec<f64>],
    draws: usize,
    seed: u64,
    cancelled: &(dyn Fn() -> bool + Sync),
    progress: ReportProgress<'_>,
) -> Option<Sampled> {
    let mut metric = Metric::of_curvature(&mut density.clone(), starts.first()?)?;
    let mut chains: Vec<Chain<D>> = starts.iter().enumerate().map(|(i, start)| Chain::new(density, start, seed, i)).collect();
    let mut drawn = vec![ChainDraws::default(); chains.len()];
    #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
    let share = |done: usize| done as f64 / (WINDOWS.iter().sum::<usize>() + draws) as f64;
    let mut done = 0;
    let mut pace = Pace { adapts: true, thinning: 1 };
    for (i, &window) in WINDOWS.iter().enumerate() {
        run_all(&mut chains, |chain| chain.run(&metric, window, pace, cancelled));
        done += window;
        progress(share(done), &drawn);
        let points: Vec<Vec<f64>> = chains.iter().flat_map(|chain| chain.window.points.iter().cloned()).collect();
        if i + 1 < WINDOWS.len() {
            metric = metric.of_draws(&points).unwrap_or(metric);
        }
        if i + 2 == WINDOWS.len() {
            pace.thinning = thinning(&chains);
        }
    }
    pace.adapts = false;
    let mut left = draws;
    while left > 0 && !cancelled() {
        let block = left.min(BLOCK);
        run_all(&mut chains, |chain| chain.run(&metric, block, pace, cancelled));
        for (all, chain) in drawn.iter_mut().zip(&mut chains) {
            all.append(std::mem::take(&mut chain.window));
            all.evaluations = chain.evaluations;
        }
        left -= block;
        done += block;
        progress(share(done), &drawn);
    }
    Some(Sampled { chains: drawn, metric })
}

/// Transitions from one draw to the next, by the effective draws of the present window.
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "numbers of draws")]
fn thinning<D>(chains: &[Chain<D>]) -> usize {
    let of = |coordinate: usize| {
        let columns = chains.iter().map(|chain| chain.window.points.iter().map(|point| point[coordinate]).collect());
        convergence(&columns.collect::<Vec<Vec<f64>>>())
    };
    let dimension = chains.first().map_or(0, |chain| chain.position.len());
    let worst = (0..dimension).filter_map(of).map(|found| found.ess_bulk).fold(f64::INFINITY, f64::min);
    let drawn: usize = chains.iter().map(|chain| chain.window.points.len()).sum();
    (WORTH * drawn as f64 / worst).ceil().clamp(1.0, MOST_THINNING) as usize
}

impl<D: LogDensity + Clone> Chain<D> {
    fn new(density: &D, start: &[f64], seed: u64, number: usize) -> Self {
        // The seeds of the chains of one run, and those of neighbouring runs, share nothing after this multiplication (Knuth).
        let own = (seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)).wrapping_add(number as u64).wrapping_mul(0xd134_2543_de82_ef95);
        Self {
            density: density.clone(),
            position: start.to_vec(),
            deviates: Deviates::new(own),
            step_size: 1.0,
            evaluations: 0,
            window: ChainDraws::default(),
        }
    }
}

impl ChainDraws {
    fn append(&mut self, mut other: Self) {
        self.points.append(&mut other.points);
        self.log_density.append(&mut other.log_density);
        self.divergences += other.divergences;
        self.cut += other.cut;
        self.transitions += other.transitions;
        self.acceptance += other.acceptance;
    }
}

fn run_all<D: Send>(chains: &mut [Chain<D>], run: impl Fn(&mut Chain<D>) + Send + Sync) {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        chains.par_iter_mut().for_each(run);
    }
    #[cfg(not(feature = "threads"))]
    chains.iter_mut().for_each(run);
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::draw_chains;
    use crate::fit::posterior::diagnostics::convergence;
    use crate::fit::posterior::log_density::LogDensity;
    use nalgebra::{DMatrix, DVector};

    /// A Gaussian with that precision matrix.
    #[derive(Clone)]
    struct Gaussian {
        mean: DVector<f64>,
        precision: DMatrix<f64>,
    }

    impl LogDensity for Gaussian {
        fn dimension(&self) -> usize {
            self.mean.len()
        }

        fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
            let off = DVector::from_column_slice(at) - &self.mean;
            let force = &self.precision * &off;
            gradient.iter_mut().zip(force.iter()).for_each(|(slot, force)| *slot = -force);
            -0.5 * off.dot(&force)
        }
    }

    #[test]
    fn a_correlated_gaussian_has_its_moments() {
        let deviation = [1e-2, 1.0, 30.0];
        let correlation = DMatrix::from_row_slice(3, 3, &[1.0, 0.95, -0.3, 0.95, 1.0, -0.2, -0.3, -0.2, 1.0]);
        let covariance = DMatrix::from_fn(3, 3, |i, j| correlation[(i, j)] * deviation[i] * deviation[j]);
        let mean = DVector::from_vec(vec![5.0, -1.0, 100.0]);
        let density = Gaussian { mean: mean.clone(), precision: covariance.clone().try_inverse().unwrap() };
        let starts = vec![vec![5.0, -1.0, 100.0], vec![5.1, 1.0, 50.0], vec![4.9, -3.0, 150.0], vec![5.0, 0.0, 90.0]];
        let chains = draw_chains(&density, &starts, 5000, 7, &|| false, &mut |_, _| {}).unwrap().chains;
        let points: Vec<DVector<f64>> =
            chains.iter().flat_map(|chain| &chain.points).map(|point| DVector::from_column_slice(point)).collect();
        let count = points.len() as f64;
        let average = points.iter().sum::<DVector<f64>>() / count;
        for i in 0..3 {
            // Nearly independent: 20,000 draws have a mean within five standard errors of 1/√10,000, variances within √2 of that.
            assert!((average[i] - mean[i]).abs() < 0.05 * deviation[i], "mean {i}: {}", average[i]);
            for j in 0..3 {
                let sum: f64 = points.iter().map(|point| (point[i] - mean[i]) * (point[j] - mean[j])).sum();
                let scale = deviation[i] * deviation[j];
                assert!((sum / count - covariance[(i, j)]).abs() < 0.07 * scale, "{i} {j}: {}", sum / count / scale);
            }
        }
        assert_eq!(chains.iter().map(|chain| chain.divergences).sum::<usize>(), 0);
    }

    /// y is normal of deviation 1.5, and x of deviation e^y: the width in x varies by four orders of magnitude.
    #[derive(Clone)]
    struct Funnel;

    impl LogDensity for Funnel {
        fn dimension(&self) -> usize {
            2
        }

        fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
            const PRECISION: f64 = 1.0 / (1.5 * 1.5);
            let square = at[0] * at[0] * libm::exp(-2.0 * at[1]);
            gradient[0] = -at[0] * libm::exp(-2.0 * at[1]);
            gradient[1] = square - 1.0 - PRECISION * at[1];
            -0.5 * square - at[1] - 0.5 * PRECISION * at[1] * at[1]
        }
    }

    #[test]
    fn a_funnel_has_its_quantiles_in_its_neck_too() {
        let sampled = draw_chains(&Funnel, &vec![vec![0.0, 0.0]; 4], 5000, 11, &|| false, &mut |_, _| {}).unwrap();
        let chains: Vec<Vec<f64>> = sampled.chains.iter().map(|chain| chain.points.iter().map(|point| point[1] / 1.5).collect()).collect();
        let found = convergence(&chains).unwrap();
        assert!(found.rhat < 1.01 && found.ess_bulk > 1000.0, "{found:?}");
        let all: Vec<f64> = chains.concat();
        // Normal quantiles, and five standard errors of a share of so many effective draws.
        for (quantile, share) in [(-2.326_347_9, 0.01), (-1.281_551_6, 0.1), (0.0, 0.5), (1.281_551_6, 0.9), (2.326_347_9, 0.99)] {
            let below = all.iter().filter(|&&y| y < quantile).count() as f64 / all.len() as f64;
            let error = 5.0 * f64::sqrt(share * (1.0 - share) / found.ess_bulk.min(found.ess_tail));
            assert!((below - share).abs() < error, "{share}: {below} ± {error}");
        }
    }

    #[test]
    fn the_seed_alone_decides() {
        let density = Gaussian { mean: DVector::zeros(2), precision: DMatrix::identity(2, 2) };
        let run = |seed| draw_chains(&density, &vec![vec![0.0; 2]; 2], 50, seed, &|| false, &mut |_, _| {}).unwrap().chains;
        assert_eq!(run(3), run(3));
        assert_ne!(run(3)[0].points, run(4)[0].points);
        assert_ne!(run(3)[0].points, run(3)[1].points);
    }
}
