//! Draws from a posterior, and what they say.

use crate::fit::fit_problem::UnknownName;
use crate::fit::posterior::diagnostics::{Convergence, convergence, quantile};
use crate::fit::posterior::evidence::LogEvidence;
use crate::model::{Model, Parameter, Parameters};
use nalgebra::DMatrix;
use std::fmt;

/// R̂ above which chains have not mixed, and effective sizes below which quantiles are rough (Vehtari et al. (2021), section 2.4: 100 for
/// each of four chains).
const LARGEST_RHAT: f64 = 1.01;
const SMALLEST_SIZE: f64 = 400.0;
/// Share of transitions that diverge above which a place is not explored.
const LARGEST_DIVERGING_SHARE: f64 = 0.001;

/// One draw.
#[derive(Debug, Clone, PartialEq)]
pub struct PosteriorDraw<P = Parameters> {
    /// The free parameters, in their order.
    pub unknowns: Vec<f64>,
    /// All parameters of the model, the held ones at their values; of several measurements, those of each.
    pub parameters: P,
    /// Natural logarithm of likelihood × priors there.
    pub log_posterior: f64,
}

/// Median and central 68 % of the standard deviation of one quantity's noise, in the unit of the residual before weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseQuantiles {
    /// 16 % quantile.
    pub q16: f64,
    /// Median.
    pub q50: f64,
    /// 84 % quantile.
    pub q84: f64,
}

/// Draws of all chains.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PosteriorSample<N = Parameter, P = Parameters> {
    /// Which terms there are.
    pub model: Model,
    /// The free parameters.
    pub parameters: Vec<N>,
    /// The draws, chain by chain, all of one length.
    pub chains: Vec<Vec<PosteriorDraw<P>>>,
    /// Evaluations of value and gradient, those of the warm-up among them.
    pub evaluations: usize,
    /// Transitions after the warm-up whose energy ran away.
    pub divergences: usize,
    /// Transitions after the warm-up that were cut at 1,023 steps, divided ones counted once.
    pub cut: usize,
    /// Transitions after the warm-up: one or more from draw to draw, by how far one goes.
    pub transitions: usize,
    /// Mean acceptance probability of the steps before any is divided, 0 to 1.
    pub accepted: f64,
    /// Of the noise of DoLP and of BRDF where it is not stated; none of what is not measured.
    pub noise: [Option<NoiseQuantiles>; 2],
    /// Evidence of the model; none of too few draws.
    pub log_evidence: Option<LogEvidence>,
    /// Milliseconds by the clock of the observer.
    pub elapsed_ms: f64,
}

/// What the draws say of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarginalSummary {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Quantiles at 5, 16, 50, 84 and 95 %.
    pub quantiles: [f64; 5],
    /// How well the chains have explored it; none of too few draws.
    pub convergence: Option<Convergence>,
}

/// Whether the draws are to be trusted; `Display` says it in a sentence.
#[derive(Debug, Clone, PartialEq)]
pub enum PosteriorVerdict<N = Parameter> {
    /// R̂ and effective sizes are good, and next to no transition diverged.
    Converged {
        /// The smallest effective size, bulk or tail.
        size: f64,
    },
    /// Too few draws to tell.
    TooFewDraws,
    /// Chains disagree.
    NotMixed {
        /// On what most.
        parameter: N,
        /// Its R̂.
        rhat: f64,
    },
    /// The draws depend on each other too much.
    SmallSize {
        /// Of what most.
        parameter: N,
        /// Its smaller effective size.
        size: f64,
    },
    /// A narrow place of the posterior is not explored well.
    Diverged {
        /// Transitions that diverged.
        count: usize,
        /// Share of all, 0 to 1.
        share: f64,
    },
}

impl<N: UnknownName> fmt::Display for PosteriorVerdict<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Converged { size } => write!(f, "converged: at least {size:.0} effective draws of each parameter"),
            Self::TooFewDraws => f.write_str("too few draws to tell whether the chains have converged"),
            Self::NotMixed { parameter, rhat } => {
                write!(f, "not converged: the chains disagree on {} (R̂ = {rhat:.3}); draw more", parameter.symbol())
            }
            Self::SmallSize { parameter, size } => {
                write!(f, "rough: {} has {size:.0} effective draws only; draw more", parameter.symbol())
            }
            Self::Diverged { count, share } => write!(
                f,
                "nearly converged: {count} transitions ({:.1} %) diverged in a narrow place, whose weight may be off by as much",
                100.0 * share
            ),
        }
    }
}

impl<N: UnknownName, P> PosteriorSample<N, P> {
    /// Number of draws of all chains.
    #[must_use]
    pub fn len(&self) -> usize {
        self.chains.iter().map(Vec::len).sum()
    }

    /// Whether there is no draw.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Draws that were made elsewhere; what else is known of them is 0 or none.
    #[must_use]
    pub fn of_chains(model: Model, parameters: Vec<N>, chains: Vec<Vec<PosteriorDraw<P>>>) -> Self {
        let (evaluations, divergences, cut, transitions) = (0, 0, 0, 0);
        let (accepted, noise, log_evidence, elapsed_ms) = (0.0, [None; 2], None, 0.0);
        Self { model, parameters, chains, evaluations, divergences, cut, transitions, accepted, noise, log_evidence, elapsed_ms }
    }

    /// The same draws with other names and points.
    #[must_use]
    pub fn map<M, Q>(self, name: impl Fn(N) -> M, point: impl Fn(P) -> Q) -> PosteriorSample<M, Q> {
        let draw = |PosteriorDraw { unknowns, parameters, log_posterior }: PosteriorDraw<P>| PosteriorDraw {
            unknowns,
            parameters: point(parameters),
            log_posterior,
        };
        PosteriorSample {
            model: self.model,
            parameters: self.parameters.into_iter().map(name).collect(),
            chains: self.chains.into_iter().map(|chain| chain.into_iter().map(draw).collect()).collect(),
            evaluations: self.evaluations,
            divergences: self.divergences,
            cut: self.cut,
            transitions: self.transitions,
            accepted: self.accepted,
            noise: self.noise,
            log_evidence: self.log_evidence,
            elapsed_ms: self.elapsed_ms,
        }
    }

    /// All draws, chain after chain.
    pub fn draws(&self) -> impl Iterator<Item = &PosteriorDraw<P>> {
        self.chains.iter().flatten()
    }

    /// What the draws say of a function of the parameters; not finite values make it NaN.
    #[must_use]
    pub fn summary_of(&self, quantity: impl Fn(&P) -> f64) -> MarginalSummary {
        self.summary_by(|draw| quantity(&draw.parameters))
    }

    /// What the draws say of a free parameter; NaN of one that is not free.
    #[must_use]
    pub fn summary(&self, parameter: &N) -> MarginalSummary {
        let place = self.parameters.iter().position(|other| other == parameter);
        self.summary_by(|draw| place.map_or(f64::NAN, |place| draw.unknowns[place]))
    }

    fn summary_by(&self, quantity: impl Fn(&PosteriorDraw<P>) -> f64) -> MarginalSummary {
        let values: Vec<Vec<f64>> = self.chains.iter().map(|chain| chain.iter().map(&quantity).collect()).collect();
        let mut sorted = values.concat();
        sorted.sort_by(f64::total_cmp);
        #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
        let count = sorted.len() as f64;
        let mean = sorted.iter().sum::<f64>() / count;
        let sd = (sorted.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt();
        let quantiles = [0.05, 0.16, 0.5, 0.84, 0.95].map(|share| quantile(&sorted, share));
        MarginalSummary { mean, sd, quantiles, convergence: convergence(&values) }
    }

    /// Correlation coefficients of the free parameters; NaN of one that does not vary.
    #[must_use]
    pub fn correlations(&self) -> DMatrix<f64> {
        let dimension = self.parameters.len();
        #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
        let count = self.len() as f64;
        let value = |draw: &PosteriorDraw<P>, i: usize| draw.unknowns[i];
        let means: Vec<f64> = (0..dimension).map(|i| self.draws().map(|draw| value(draw, i)).sum::<f64>() / count).collect();
        let mut covariance: DMatrix<f64> = DMatrix::zeros(dimension, dimension);
        for draw in self.draws() {
            for i in 0..dimension {
                for j in 0..=i {
                    covariance[(i, j)] += (value(draw, i) - means[i]) * (value(draw, j) - means[j]);
                }
            }
        }
        let of = |i: usize, j: usize| covariance[(i.max(j), i.min(j))];
        DMatrix::from_fn(dimension, dimension, |i, j| if i == j { 1.0 } else { of(i, j) / (of(i, i) * of(j, j)).sqrt() })
    }

    /// Whether the draws are to be trusted.
    #[must_use]
    pub fn verdict(&self) -> PosteriorVerdict<N> {
        let summaries: Vec<MarginalSummary> = self.parameters.iter().map(|parameter| self.summary(parameter)).collect();
        self.verdict_of(&summaries)
    }

    /// The same, given the summary of each parameter in their order.
    #[must_use]
    pub fn verdict_of(&self, summaries: &[MarginalSummary]) -> PosteriorVerdict<N> {
        let each = self.parameters.iter().zip(summaries).map(|(parameter, summary)| Some((parameter.clone(), summary.convergence?)));
        let Some(all) = each.collect::<Option<Vec<(N, Convergence)>>>() else { return PosteriorVerdict::TooFewDraws };
        let size = |of: &Convergence| of.ess_bulk.min(of.ess_tail);
        let worst_rhat = all.iter().max_by(|a, b| a.1.rhat.total_cmp(&b.1.rhat));
        let smallest = all.iter().min_by(|a, b| size(&a.1).total_cmp(&size(&b.1)));
        #[expect(clippy::cast_precision_loss, reason = "a number of draws")]
        let share = self.divergences as f64 / self.transitions.max(1) as f64;
        match (worst_rhat, smallest) {
            (Some((parameter, of)), _) if of.rhat > LARGEST_RHAT || of.rhat.is_nan() => {
                PosteriorVerdict::NotMixed { parameter: parameter.clone(), rhat: of.rhat }
            }
            (_, Some((parameter, of))) if size(of) < SMALLEST_SIZE => {
                PosteriorVerdict::SmallSize { parameter: parameter.clone(), size: size(of) }
            }
            _ if share > LARGEST_DIVERGING_SHARE => PosteriorVerdict::Diverged { count: self.divergences, share },
            (_, Some((_, of))) => PosteriorVerdict::Converged { size: size(of) },
            _ => PosteriorVerdict::TooFewDraws,
        }
    }
}
