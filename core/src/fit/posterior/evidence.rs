//! The evidence of a model, its likelihood averaged over the prior: Meng and Wong's bridge sampling (Statistica Sinica 6, 831 (1996)).
//!
//! The bridge leads from the posterior to a standard Gaussian in the coordinates of the sampler, which are about that already and were
//! fixed before the draws.

use crate::fit::posterior::diagnostics::effective_size_of;
use crate::fit::posterior::log_density::LogDensity;
use crate::fit::posterior::metric::Whitened;
use crate::fit::posterior::sampler::Sampled;
use crate::measurement::Deviates;
use std::f64::consts::TAU;

/// Points of the Gaussian, and of the posterior, at most.
const MOST_POINTS: usize = 8000;
/// Fewer draws make no bridge.
const FEWEST_POINTS: usize = 200;
/// Passes of the fixed point, at most; it gains a digit in each.
const PASSES: usize = 1000;
/// Change of the logarithm below which the fixed point stands.
const SETTLED: f64 = 1e-8;

/// Logarithm of the evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogEvidence {
    /// Natural logarithm, of a likelihood with its constants and of normalised priors.
    pub value: f64,
    /// Its standard error.
    pub std_error: f64,
}

/// Of a density from its draws; none of too few draws, or where the bridge does not settle.
#[expect(clippy::cast_precision_loss, reason = "numbers of draws")]
pub(crate) fn log_evidence<D: LogDensity>(density: &mut D, sampled: &Sampled, seed: u64) -> Option<LogEvidence> {
    let Sampled { chains, metric } = sampled;
    let drawn: usize = chains.iter().map(|chain| chain.points.len()).sum();
    let step = drawn.div_ceil(MOST_POINTS).max(1);
    if drawn < FEWEST_POINTS {
        return None;
    }
    let dimension = density.dimension();
    let half_norm = 0.5 * dimension as f64 * libm::log(TAU);
    let log_gauss = |z: &[f64]| -0.5 * z.iter().map(|z| z * z).sum::<f64>() - half_norm;
    // ln of density over Gaussian, in z, of the draws chain by chain and of points of the Gaussian.
    let volume = metric.log_volume();
    let mut of_draws: Vec<Vec<f64>> = Vec::new();
    for chain in chains {
        let thinned = chain.points.iter().zip(&chain.log_density).step_by(step);
        let ratios: Option<Vec<f64>> =
            thinned.map(|(point, log_density)| metric.to_whitened(point).map(|z| log_density + volume - log_gauss(&z))).collect();
        of_draws.push(ratios?);
    }
    let count = of_draws.iter().map(Vec::len).sum::<usize>();
    let mut deviates = Deviates::new(seed ^ 0x5bd1_e995_9d1b_54a5);
    let mut whitened = Whitened::new(density, metric);
    let (mut z, mut gradient) = (vec![0.0; dimension], vec![0.0; dimension]);
    let mut of_gauss = Vec::with_capacity(count);
    for _ in 0..count {
        for pair in z.chunks_mut(2) {
            let (one, other) = deviates.pair();
            pair.iter_mut().zip([one, other]).for_each(|(slot, deviate)| *slot = deviate);
        }
        let value = whitened.value_and_gradient(&z, &mut gradient);
        let ratio = value + volume - log_gauss(&z);
        of_gauss.push(if ratio.is_nan() { f64::NEG_INFINITY } else { ratio });
    }
    bridge(&of_draws, &of_gauss)
}

/// From the logarithms of the ratio of density to Gaussian at points of either.
#[expect(clippy::cast_precision_loss, reason = "numbers of draws")]
fn bridge(of_draws: &[Vec<f64>], of_gauss: &[f64]) -> Option<LogEvidence> {
    let all: Vec<f64> = of_draws.concat();
    let mut sorted = all.clone();
    sorted.sort_by(f64::total_cmp);
    let center = sorted[sorted.len() / 2];
    let effective = effective_size_of(of_draws)?;
    let share = effective / (effective + of_gauss.len() as f64);
    let mean = |numbers: &[f64]| numbers.iter().sum::<f64>() / numbers.len() as f64;
    // With l the ratio over r: p/(s p + (1 − s) g) of points of the Gaussian, g/(s p + (1 − s) g) of draws.
    let over = |log_ratio: f64, log_r: f64| {
        let l = libm::exp((log_ratio - center - log_r).min(700.0));
        [l / (share * l + 1.0 - share), 1.0 / (share * l + 1.0 - share)]
    };
    let mut log_r = 0.0;
    for _ in 0..PASSES {
        let of_p = mean(&of_gauss.iter().map(|&ratio| over(ratio, log_r)[0]).collect::<Vec<_>>());
        let of_g = mean(&all.iter().map(|&ratio| over(ratio, log_r)[1]).collect::<Vec<_>>());
        let change = libm::log(of_p / of_g);
        log_r += change;
        if !log_r.is_finite() {
            return None;
        }
        if change.abs() < SETTLED {
            break;
        }
    }
    let relative_variance = |numbers: &[f64]| {
        let mean = mean(numbers);
        numbers.iter().map(|number| (number - mean) * (number - mean)).sum::<f64>() / (numbers.len() as f64 * mean * mean)
    };
    // Frühwirth-Schnatter, Econometrics Journal 7, 143 (2004): draws count by their effective number.
    let of_p: Vec<f64> = of_gauss.iter().map(|&ratio| over(ratio, log_r)[0]).collect();
    let of_g: Vec<Vec<f64>> = of_draws.iter().map(|chain| chain.iter().map(|&ratio| over(ratio, log_r)[1]).collect()).collect();
    let effective = effective_size_of(&of_g).unwrap_or(effective);
    let variance = relative_variance(&of_p) / of_p.len() as f64 + relative_variance(&of_g.concat()) / effective;
    Some(LogEvidence { value: center + log_r, std_error: variance.sqrt() })
}

#[cfg(test)]
mod tests {
    use super::log_evidence;
    use crate::fit::posterior::log_density::LogDensity;
    use crate::fit::posterior::sampler::draw_chains;

    /// A skewed density with a known integral: `exp(a u − b eᵘ)` in each coordinate, whose integral is `Γ(a)/bᵃ`.
    #[derive(Clone)]
    struct LogGamma(Vec<(f64, f64)>);

    impl LogDensity for LogGamma {
        fn dimension(&self) -> usize {
            self.0.len()
        }

        fn value_and_gradient(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
            let terms = self.0.iter().zip(at).zip(gradient).map(|((&(a, b), &u), slot)| {
                *slot = a - b * libm::exp(u);
                a * u - b * libm::exp(u)
            });
            terms.sum()
        }
    }

    #[test]
    fn the_evidence_of_a_known_integral_lies_within_its_error() {
        let mut density = LogGamma(vec![(2.0, 3.0), (5.0, 0.1), (1.0, 1.0)]);
        let expected: f64 = density.0.iter().map(|&(a, b)| libm::lgamma(a) - a * libm::log(b)).sum();
        let sampled = draw_chains(&density, &vec![vec![0.0; 3]; 4], 1000, 5, &|| false, &mut |_, _| {}).unwrap();
        let evidence = log_evidence(&mut density, &sampled, 1).unwrap();
        // Four standard errors, and those are small: the bridge is short.
        assert!((evidence.value - expected).abs() < 4.0 * evidence.std_error, "{evidence:?} {expected}");
        assert!(evidence.std_error < 0.05, "{evidence:?}");
    }
}
