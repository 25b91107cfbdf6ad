//! Convergence and effective sizes of draws: Vehtari, Gelman, Simpson, Carpenter and Bürkner, Bayesian Analysis 16, 667 (2021).

use std::f64::consts::SQRT_2;

/// How well the chains have explored one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Rank-normalised split R̂: the larger one of that of the draws and that of their distances from the median; 1 is converged.
    pub rhat: f64,
    /// Effective number of draws for the bulk.
    pub ess_bulk: f64,
    /// Effective number of draws for the 5 % and 95 % quantiles, the smaller one.
    pub ess_tail: f64,
}

/// Of the chains' draws of one quantity, all of one length; none of fewer than 4 draws a chain, or where no draw differs.
#[must_use]
pub fn convergence(chains: &[Vec<f64>]) -> Option<Convergence> {
    let length = chains.first()?.len();
    if length < 4 || chains.iter().any(|chain| chain.len() != length || chain.iter().any(|draw| !draw.is_finite())) {
        return None;
    }
    let halves = split(chains);
    let mut sorted: Vec<f64> = chains.concat();
    sorted.sort_by(f64::total_cmp);
    if sorted.first() == sorted.last() {
        return None;
    }
    let ranked = rank_normalised(&halves);
    let median = quantile(&sorted, 0.5);
    let folded: Vec<Vec<f64>> = halves.iter().map(|chain| chain.iter().map(|draw| (draw - median).abs()).collect()).collect();
    let tail = |share: f64| {
        let cut = quantile(&sorted, share);
        let below = |chain: &Vec<f64>| chain.iter().map(|&draw| f64::from(u8::from(draw <= cut))).collect();
        effective_size(&halves.iter().map(below).collect::<Vec<Vec<f64>>>())
    };
    Some(Convergence {
        rhat: split_rhat(&ranked).max(split_rhat(&rank_normalised(&folded))),
        ess_bulk: effective_size(&ranked),
        ess_tail: tail(0.05).min(tail(0.95)),
    })
}

/// The quantile of sorted numbers, linear between neighbours; NaN of none.
#[must_use]
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index of a list")]
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share.clamp(0.0, 1.0) * last as f64;
    let below = place as usize;
    let above = (below + 1).min(last);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

/// Halves of the chains; the middle draw of an odd chain is left out.
fn split(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let halves = chains.iter().flat_map(|chain| {
        let half = chain.len() / 2;
        [chain[..half].to_vec(), chain[chain.len() - half..].to_vec()]
    });
    halves.collect()
}

/// Normal scores of the ranks among all draws, ties at their mean rank (Blom's 3/8).
#[expect(clippy::cast_precision_loss, reason = "a rank")]
fn rank_normalised(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let all = chains.concat();
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|&a, &b| all[a].total_cmp(&all[b]));
    let mut scores = vec![0.0; all.len()];
    let mut begin = 0;
    while begin < order.len() {
        let tied = order[begin..].iter().take_while(|&&i| all[i] == all[order[begin]]).count();
        let rank = begin as f64 + 0.5 * (tied as f64 + 1.0);
        let score = normal_quantile((rank - 0.375) / (all.len() as f64 + 0.25));
        order[begin..begin + tied].iter().for_each(|&i| scores[i] = score);
        begin += tied;
    }
    let length = chains.first().map_or(1, Vec::len).max(1);
    scores.chunks(length).map(<[f64]>::to_vec).collect()
}

#[expect(clippy::cast_precision_loss, reason = "a number of draws")]
fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

/// Unbiased variance.
#[expect(clippy::cast_precision_loss, reason = "a number of draws")]
fn variance(numbers: &[f64]) -> f64 {
    let mean = mean(numbers);
    numbers.iter().map(|number| (number - mean) * (number - mean)).sum::<f64>() / (numbers.len() as f64 - 1.0)
}

/// Variance within chains, and that of all draws together as an estimate that is too large before the chains have mixed.
#[expect(clippy::cast_precision_loss, reason = "a number of draws")]
fn within_and_total(chains: &[Vec<f64>]) -> (f64, f64) {
    let within = mean(&chains.iter().map(|chain| variance(chain)).collect::<Vec<_>>());
    let between = if chains.len() > 1 { variance(&chains.iter().map(|chain| mean(chain)).collect::<Vec<_>>()) } else { 0.0 };
    let count = chains[0].len() as f64;
    (within, within * (count - 1.0) / count + between)
}

fn split_rhat(chains: &[Vec<f64>]) -> f64 {
    let (within, total) = within_and_total(chains);
    (total / within).sqrt()
}

/// Effective number of draws for the mean of a quantity, given chain by chain; none of fewer than 4 draws a chain.
pub(crate) fn effective_size_of(chains: &[Vec<f64>]) -> Option<f64> {
    let length = chains.iter().map(Vec::len).min()?;
    (length >= 4).then(|| effective_size(&split(&chains.iter().map(|chain| chain[..length].to_vec()).collect::<Vec<_>>())))
}

/// Effective number of draws, by Geyer's initial monotone sequence of autocorrelations of all chains.
#[expect(clippy::cast_precision_loss, reason = "a number of draws")]
fn effective_size(chains: &[Vec<f64>]) -> f64 {
    let length = chains[0].len();
    let all = (chains.len() * length) as f64;
    let (within, total) = within_and_total(chains);
    if total <= 0.0 || total.is_nan() {
        return all;
    }
    let centred: Vec<Vec<f64>> = chains
        .iter()
        .map(|chain| {
            let mean = mean(chain);
            chain.iter().map(|draw| draw - mean).collect()
        })
        .collect();
    let correlation = |lag: usize| {
        let covariance = |chain: &Vec<f64>| chain.iter().zip(&chain[lag..]).map(|(a, b)| a * b).sum::<f64>() / length as f64;
        // Autocovariances are divided by the number of draws, variances by one less.
        1.0 - (within - mean(&centred.iter().map(covariance).collect::<Vec<_>>())) / total
    };
    let mut sum = 0.0;
    let mut smallest = f64::INFINITY;
    let mut lag = 0;
    // The even one of the first pair that is negative, or of the last pair that there is, counts once.
    let last_even = loop {
        let even = if lag == 0 { 1.0 } else { correlation(lag) };
        let pair = even + correlation(lag + 1);
        if pair < 0.0 || lag + 5 > length {
            break even;
        }
        smallest = smallest.min(pair);
        sum += smallest;
        lag += 2;
    };
    let time = -1.0 + 2.0 * sum + last_even.max(0.0);
    // Draws that repel each other count more than once, but no estimate of that is good beyond this (Vehtari et al., section 3.2).
    all / time.max(1.0 / libm::log10(all))
}

/// Quantile of the standard normal distribution, 0 < p < 1: Newton's steps on `erfc` from a first guess.
pub(crate) fn normal_quantile(p: f64) -> f64 {
    if p > 0.5 {
        return -normal_quantile(1.0 - p);
    }
    // Abramowitz and Stegun, 26.2.23: within 4.5e-4, from where Halley's steps converge in two.
    let t = (-2.0 * libm::log(p)).sqrt();
    let numerator = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let denominator = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    let mut x = numerator / denominator - t;
    for _ in 0..2 {
        let error = 0.5 * libm::erfc(-x / SQRT_2) - p;
        let step = error * (2.0 * std::f64::consts::PI).sqrt() * libm::exp(0.5 * x * x);
        x -= step / (1.0 + 0.5 * x * step);
    }
    x
}
