//! A posterior to draw from: problem and priors, and the run.

use crate::fit::bounds::{Bounds, BoundsError};
use crate::fit::fit_problem::{FitProblem, UnknownName as _};
use crate::fit::joint::unknown::JointUnknown;
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::Weights;
use crate::fit::posterior::density::PosteriorDensity;
use crate::fit::posterior::diagnostics::quantile;
use crate::fit::posterior::evidence::log_evidence;
use crate::fit::posterior::parts::PosteriorProblem;
use crate::fit::posterior::prior::{BoundedPrior, Prior, PriorError};
use crate::fit::posterior::sample::{NoiseQuantiles, PosteriorDraw, PosteriorSample};
use crate::fit::posterior::sampler::{ChainDraws, Sampled, draw_chains};
use crate::measurement::Deviates;
use nalgebra::DVector;

/// Draws of each chain, at least: fewer tell nothing of convergence.
const FEWEST_DRAWS: usize = 100;
/// Chains start from minima whose likelihood lies at most this far below the best one, in its logarithm: the others hold e⁻¹⁰ of it.
const FARTHEST_START: f64 = 10.0;
/// Draws that the quantiles of the noise are taken from.
const NOISE_DRAWS: usize = 2000;

/// How much is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PosteriorSettings {
    /// Draws of each chain after the warm-up, at least 100.
    pub draws: usize,
    /// Chains, at least 1.
    pub chains: usize,
    /// The draws depend on this alone, not on the number of threads.
    pub seed: u64,
}

impl Default for PosteriorSettings {
    fn default() -> Self {
        Self { draws: 4000, chains: 4, seed: 1 }
    }
}

/// Why nothing can be drawn.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PosteriorError {
    /// A prior is none.
    #[error(transparent)]
    Prior(#[from] PriorError),
    /// The bounds of a prior are none.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
    /// No parameter is free.
    #[error("no parameter is free: there is nothing to draw")]
    NothingFree,
    /// No value is measured.
    #[error("there are no data: the posterior is the prior")]
    NoData,
    /// Too few draws or no chain.
    #[error("{draws} draws of {chains} chains are too few: at least {FEWEST_DRAWS} draws of one chain are needed")]
    TooFewDraws {
        /// Draws of each chain.
        draws: usize,
        /// Chains.
        chains: usize,
    },
    /// The density is not finite where the chains begin.
    #[error("the likelihood is not finite at the fit, so no chain can begin there")]
    NotFinite,
}

/// Posterior of the free parameters of a problem, of one measurement or of several.
///
/// ```
/// use pbrdf::fit::posterior::{Posterior, PosteriorSettings, Prior};
/// use pbrdf::fit::{Observer, Starts, fit};
/// use pbrdf::{Fit, Measurement, Model, Parameter::{K, N}};
///
/// let table = "theta_i,theta_r,dolp\n30,40,0.127\n40,40,0.166\n50,50,0.268\n60,60,0.398\n70,60,0.466\n70,70,0.525\n";
/// let data = Measurement::read(table.as_bytes())?;
/// let problem = Fit::new(&data, Model::SPECULAR).free(N).problem()?;
/// let settings = PosteriorSettings { draws: 500, ..PosteriorSettings::default() };
/// let posterior = Posterior::new(&problem, &[(K.into(), Prior::Normal { mean: 2.9, sd: 0.5 })], settings)?;
/// let start = fit(posterior.problem(), Starts::One, 1, Observer::NONE).parameters;
/// let sample = posterior.run(&[start], Observer::NONE, &mut |_, _| {})?;
/// println!("{}: {}", sample.verdict(), sample.summary(&N).mean);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Posterior<P = Problem> {
    problem: P,
    /// Of each unknown.
    priors: Vec<BoundedPrior>,
    settings: PosteriorSettings,
}

/// The sample of a problem's posterior.
pub type SampleOf<P> = PosteriorSample<<P as FitProblem>::Name, <P as FitProblem>::Point>;

/// Hears of the share that is done, 0 to 1, and can ask for the draws so far.
pub type PosteriorProgress<'a, P = Problem> = &'a mut dyn FnMut(f64, &dyn Fn() -> SampleOf<P>);

impl<P: PosteriorProblem> Posterior<P> {
    /// Of a problem, with priors on some unknowns, those of one measurement alone named so; the others are equally likely within their
    /// bounds. The last prior of an unknown counts.
    ///
    /// # Errors
    ///
    /// [`PosteriorError`] where a prior is none or on a parameter that is not free, where nothing is free or measured, and of too few
    /// draws.
    pub fn new(problem: &P, priors: &[(JointUnknown, Prior)], settings: PosteriorSettings) -> Result<Self, PosteriorError> {
        let PosteriorSettings { draws, chains, .. } = settings;
        if draws < FEWEST_DRAWS || chains == 0 {
            return Err(PosteriorError::TooFewDraws { draws, chains });
        }
        if problem.names().is_empty() {
            return Err(PosteriorError::NothingFree);
        }
        if problem.residual_count() == 0 {
            return Err(PosteriorError::NoData);
        }
        let is_of = |unknown: &JointUnknown, name: &P::Name| {
            unknown.parameter == name.parameter() && unknown.set.as_deref().is_none_or(|set| name.set() == Some(set))
        };
        if let Some((unknown, _)) = priors.iter().find(|(unknown, _)| !problem.names().iter().any(|name| is_of(unknown, name))) {
            return Err(PriorError::NotFree { parameter: unknown.parameter }.into());
        }
        let mut bounded_problem = problem.clone();
        let mut bounded = Vec::new();
        for (index, name) in problem.names().iter().enumerate() {
            let prior = priors.iter().rev().find(|(unknown, _)| is_of(unknown, name)).map_or(Prior::Flat, |(_, prior)| *prior);
            let (low, high) = problem.bounds_of(index);
            let mut bounds = Bounds::default();
            bounds.set(name.parameter(), low, high)?;
            let ends = prior.narrowed(name.parameter(), &bounds)?;
            bounded_problem = bounded_problem.with_bounds_of(index, ends)?;
            bounded.push(BoundedPrior::new(prior, ends));
        }
        Ok(Self { problem: bounded_problem, priors: bounded, settings })
    }

    /// The problem within the bounds of the priors: its minima are where the chains begin.
    #[must_use]
    pub fn problem(&self) -> &P {
        &self.problem
    }

    /// The prior of each unknown, in their order.
    #[must_use]
    pub fn priors(&self) -> &[BoundedPrior] {
        &self.priors
    }

    /// How much is drawn.
    #[must_use]
    pub fn settings(&self) -> PosteriorSettings {
        self.settings
    }

    /// Draws, in chains that begin at those minima of the problem, the best one first.
    ///
    /// Cancelled, it returns the draws so far, of which there may be none.
    ///
    /// # Errors
    ///
    /// [`PosteriorError`] where the density is not finite at any of the minima.
    pub fn run(
        &self,
        minima: &[P::Point],
        observer: Observer<'_>,
        progress: PosteriorProgress<'_, P>,
    ) -> Result<SampleOf<P>, PosteriorError> {
        let PosteriorSettings { draws, chains, seed } = self.settings;
        let best = minima.first().unwrap_or(self.problem.start_point());
        let mut density = PosteriorDensity::new(&self.problem, self.priors.clone(), best);
        let starts = starts(&mut density, minima).ok_or(PosteriorError::NotFinite)?;
        let starts: Vec<Vec<f64>> = (0..chains).map(|i| starts[i % starts.len()].clone()).collect();
        let mut tell = |share: f64, chains: &[ChainDraws]| progress(share, &|| self.sample(&density, chains));
        let sampled = draw_chains(&density, &starts, draws, seed, observer.cancelled, &mut tell).ok_or(PosteriorError::NotFinite)?;
        let mut result = self.sample(&density, &sampled.chains);
        self.conclude(&mut density, &sampled, seed, &mut result);
        result.elapsed_ms = (observer.clock)();
        Ok(result)
    }

    /// What takes all draws: noise and evidence.
    fn conclude(&self, density: &mut PosteriorDensity<P>, sampled: &Sampled, seed: u64, result: &mut SampleOf<P>) {
        if self.problem.options().weights == Weights::None {
            result.noise = noise(density, result, seed);
        }
        result.log_evidence = log_evidence(density, sampled, seed);
    }

    #[expect(clippy::cast_precision_loss, reason = "a number of transitions")]
    fn sample(&self, density: &PosteriorDensity<P>, chains: &[ChainDraws]) -> SampleOf<P> {
        let length = chains.iter().map(|chain| chain.points.len()).min().unwrap_or(0);
        let draw = |point: &Vec<f64>, log_density: f64| {
            let (x, log_jacobian) = density.unknowns_at(point);
            let parameters = self.problem.point_at(&x);
            PosteriorDraw { unknowns: x.as_slice().to_vec(), parameters, log_posterior: log_density - log_jacobian }
        };
        let of_chain = |chain: &ChainDraws| -> Vec<PosteriorDraw<P::Point>> {
            chain.points.iter().zip(&chain.log_density).take(length).map(|(point, &log)| draw(point, log)).collect()
        };
        let sum = |of: fn(&ChainDraws) -> usize| chains.iter().map(of).sum();
        let transitions: usize = sum(|chain| chain.transitions);
        PosteriorSample {
            model: self.problem.model(),
            parameters: self.problem.names().to_vec(),
            evaluations: sum(|chain| chain.evaluations),
            divergences: sum(|chain| chain.divergences),
            cut: sum(|chain| chain.cut),
            transitions,
            accepted: chains.iter().map(|chain| chain.acceptance).sum::<f64>() / transitions.max(1) as f64,
            chains: chains.iter().map(of_chain).collect(),
            noise: [None; 2],
            log_evidence: None,
            elapsed_ms: 0.0,
        }
    }
}

/// Places of the minima in ℝᵈ, without those whose likelihood is next to nothing; none where it is not finite at any.
fn starts<P: PosteriorProblem>(density: &mut PosteriorDensity<P>, minima: &[P::Point]) -> Option<Vec<Vec<f64>>> {
    let mut best = None;
    let mut starts = Vec::new();
    for minimum in minima {
        let Some((value, place)) = density.start_at(minimum) else { continue };
        if value >= *best.get_or_insert(value) - FARTHEST_START {
            starts.push(place);
        }
    }
    (!starts.is_empty()).then_some(starts)
}

/// Quantiles of the unknown standard deviation of each quantity: given the parameters, `s² = SS/χ²_N`.
fn noise<P: PosteriorProblem>(density: &mut PosteriorDensity<P>, sample: &SampleOf<P>, seed: u64) -> [Option<NoiseQuantiles>; 2] {
    let counts = density.counts();
    let step = sample.len().div_ceil(NOISE_DRAWS).max(1);
    let mut deviates = Deviates::new(seed ^ 0x9e37_79b9_7f4a_7c15);
    let mut drawn: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    for draw in sample.draws().step_by(step) {
        let sums = density.square_sums(&DVector::from_column_slice(&draw.unknowns));
        for block in [0, 1] {
            #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
            let half = 0.5 * counts[block] as f64;
            if half > 0.0 {
                drawn[block].push((0.5 * sums[block] / gamma(half, &mut deviates)).sqrt());
            }
        }
    }
    drawn.map(|mut values| {
        values.sort_by(f64::total_cmp);
        let at = |share| quantile(&values, share);
        (!values.is_empty()).then(|| NoiseQuantiles { q16: at(0.16), q50: at(0.5), q84: at(0.84) })
    })
}

/// A gamma deviate of that shape, > 0, and scale 1 (Marsaglia and Tsang, ACM Trans. Math. Softw. 26, 363 (2000)).
fn gamma(shape: f64, deviates: &mut Deviates) -> f64 {
    if shape < 1.0 {
        let power = libm::pow(deviates.uniform(), 1.0 / shape);
        return gamma(shape + 1.0, deviates) * power;
    }
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    loop {
        let x = deviates.pair().0;
        let v = (1.0 + c * x) * (1.0 + c * x) * (1.0 + c * x);
        if v > 0.0 && libm::log(deviates.uniform()) < 0.5 * x * x + d * (1.0 - v + libm::log(v)) {
            return d * v;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::gamma;
    use crate::measurement::Deviates;

    #[test]
    fn gamma_deviates_have_their_moments() {
        for shape in [0.5, 3.0, 72.0] {
            let mut deviates = Deviates::new(3);
            let drawn: Vec<f64> = (0..20_000).map(|_| gamma(shape, &mut deviates)).collect();
            let mean = drawn.iter().sum::<f64>() / 20_000.0;
            let variance = drawn.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 20_000.0;
            // Five standard errors of the mean, and ten per cent of the variance, whose kurtosis is 3 + 6/shape.
            assert!((mean - shape).abs() < 5.0 * (shape / 20_000.0).sqrt(), "{shape}: {mean}");
            assert!((variance / shape - 1.0).abs() < 0.1, "{shape}: {variance}");
        }
    }
}
