//! The posterior as the work has it: how it is drawn, and the draws.

use crate::app::work::fit_history::FitEntry;
use crate::report::FittedMark;
use pbrdf::fit::posterior::{
    BoundedPrior, DerivedQuantity, MarginalSummary, PosteriorSample, PosteriorSettings, PosteriorVerdict, Prior, PriorError,
};
use pbrdf::fit::{Bounds, JointUnknown, UnknownName as _};
use pbrdf::model::{Parameter, ParameterSet, Parameters};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// How it is drawn. With the seed of the settings this is all that a session keeps of it: the same draws come again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PosteriorOptions {
    /// Of each chain, after the warm-up.
    pub draws: usize,
    pub chains: usize,
    /// Where they are not uniform within the bounds of a fit; one of a parameter at most.
    pub priors: Vec<(Parameter, Prior)>,
    /// Whether bands of draws are drawn in the plots.
    pub bands: bool,
}

/// Draws of each chain, least and most.
pub const DRAWS: std::ops::RangeInclusive<usize> = 100..=100_000;
/// Chains, least and most.
pub const CHAINS: std::ops::RangeInclusive<usize> = 1..=16;

impl Default for PosteriorOptions {
    fn default() -> Self {
        Self { draws: 4000, chains: 4, priors: Vec::new(), bands: true }
    }
}

impl PosteriorOptions {
    /// Whether its values mean something.
    pub fn is_sound(&self) -> bool {
        let is_finite = |prior: &Prior| match *prior {
            Prior::Flat => true,
            Prior::Uniform { low, high } | Prior::LogUniform { low, high } => low.is_finite() && high.is_finite(),
            Prior::Normal { mean, sd } => mean.is_finite() && sd.is_finite(),
        };
        DRAWS.contains(&self.draws) && CHAINS.contains(&self.chains) && self.priors.iter().all(|(_, prior)| is_finite(prior))
    }

    /// With that seed.
    pub fn settings(&self, seed: u64) -> PosteriorSettings {
        PosteriorSettings { draws: self.draws, chains: self.chains, seed }
    }

    /// The prior of a parameter.
    pub fn prior_of(&self, parameter: Parameter) -> Prior {
        self.priors.iter().find(|(other, _)| *other == parameter).map_or(Prior::Flat, |(_, prior)| *prior)
    }

    /// Gives a parameter another prior.
    pub fn set_prior(&mut self, parameter: Parameter, prior: Prior) {
        self.priors.retain(|(other, _)| *other != parameter);
        if prior != Prior::Flat {
            self.priors.push((parameter, prior));
        }
    }

    /// The priors of what is free; those of other parameters wait.
    pub fn priors_of(&self, free: &[JointUnknown]) -> Vec<(JointUnknown, Prior)> {
        let is_free = |parameter| free.iter().any(|unknown| unknown.parameter() == parameter);
        self.priors.iter().filter(|(parameter, _)| is_free(*parameter)).map(|(parameter, prior)| ((*parameter).into(), *prior)).collect()
    }
}

/// Draws of the parameters of one measurement or several, one set of parameters for each.
pub type Draws = PosteriorSample<JointUnknown, Vec<Parameters>>;

/// What the draws are about, and how they were made.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnFrom {
    /// The measurements by their numbers, in the order of the parameter sets.
    pub numbers: Vec<u64>,
    /// Their states: masks may have changed since.
    pub generations: Vec<u64>,
    /// What they are called.
    pub names: Vec<String>,
    /// The prior of each free parameter.
    pub priors: Vec<BoundedPrior>,
    /// As they were asked for.
    pub prior_options: Vec<(JointUnknown, Prior)>,
    pub settings: PosteriorSettings,
    /// How many values were measured.
    pub values: usize,
}

/// Draws from the posterior of measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnPosterior {
    pub from: DrawnFrom,
    pub draws: Draws,
    /// Of each free parameter.
    pub summaries: Vec<MarginalSummary>,
    /// Of quantities that follow from free parameters, for each measurement.
    pub derived: Vec<(DerivedQuantity, Vec<MarginalSummary>)>,
    /// Whether they are to be trusted.
    pub verdict: PosteriorVerdict<JointUnknown>,
    /// Whether nobody stopped it.
    pub is_complete: bool,
    /// Another number for all other draws.
    pub stamp: u64,
}

/// The stamp of the draws that came last.
static LAST_STAMP: AtomicU64 = AtomicU64::new(0);

impl DrawnPosterior {
    /// Draws with what they say; that takes some milliseconds.
    pub fn new(from: DrawnFrom, draws: Draws, is_complete: bool) -> Self {
        let summaries: Vec<MarginalSummary> = draws.parameters.iter().map(|unknown| draws.summary(unknown)).collect();
        let free: ParameterSet = draws.parameters.iter().map(|unknown| unknown.parameter).collect();
        let follows = |quantity: &DerivedQuantity| !quantity.parameters(draws.model).intersection(free).is_empty();
        let summary = |quantity: DerivedQuantity, set: usize| draws.summary_of(|of| quantity.value(draws.model, &of[set]));
        let of_sets = |quantity| (0..from.numbers.len()).map(|set| summary(quantity, set)).collect();
        let derived = DerivedQuantity::ALL.into_iter().filter(follows).map(|quantity| (quantity, of_sets(quantity))).collect();
        Self::of_parts(from, draws, summaries, derived, is_complete)
    }

    /// Draws with what was found that they say.
    pub fn of_parts(
        from: DrawnFrom,
        draws: Draws,
        summaries: Vec<MarginalSummary>,
        derived: Vec<(DerivedQuantity, Vec<MarginalSummary>)>,
        is_complete: bool,
    ) -> Self {
        let verdict = draws.verdict_of(&summaries);
        Self { from, draws, summaries, derived, verdict, is_complete, stamp: LAST_STAMP.fetch_add(1, Ordering::Relaxed) + 1 }
    }

    /// The place of a measurement among the parameter sets.
    pub fn place_of(&self, number: u64) -> Option<usize> {
        self.from.numbers.iter().position(|other| *other == number)
    }
}

/// What a fit says of each free parameter of draws, where it is of the same model.
pub fn marks_of_fit(fit: Option<&Arc<FitEntry>>, drawn: &DrawnPosterior) -> Vec<Option<FittedMark>> {
    let fit = fit.filter(|fit| fit.report.model == drawn.draws.model);
    let of = |unknown: &JointUnknown| {
        let fit = fit?;
        let estimate = match (&unknown.set, &fit.joint) {
            (None, _) => fit.report.estimate(unknown.parameter)?,
            (Some(name), Some(part)) => {
                let set = part.of.problem.set_names().iter().position(|other| other == name)?;
                part.of.result.estimate(set, unknown.parameter)?
            }
            (Some(_), None) => return None,
        };
        estimate.free.then(|| FittedMark::new(estimate))
    };
    drawn.draws.parameters.iter().map(of).collect()
}

/// Checks priors against the bounds of a surface, so that a wrong one is told beside it.
pub fn check_prior(parameter: Parameter, prior: Prior, bounds: (f64, f64)) -> Result<(), PriorError> {
    let mut all = Bounds::default();
    // Bounds of surfaces are sound.
    let _ = all.set(parameter, bounds.0, bounds.1);
    prior.check(parameter, &all)
}

#[cfg(test)]
mod tests {
    use super::{PosteriorOptions, Prior, check_prior};
    use pbrdf::model::Parameter;

    #[test]
    fn a_parameter_has_one_prior_and_a_flat_one_is_none() {
        let mut options = PosteriorOptions::default();
        let normal = |mean| Prior::Normal { mean, sd: 0.1 };
        options.set_prior(Parameter::N, normal(2.0));
        options.set_prior(Parameter::N, normal(2.1));
        options.set_prior(Parameter::K, normal(3.0));
        assert_eq!((options.priors.len(), options.prior_of(Parameter::N)), (2, normal(2.1)));
        assert_eq!(options.priors_of(&[Parameter::N.into()]), [(Parameter::N.into(), normal(2.1))]);
        options.set_prior(Parameter::N, Prior::Flat);
        assert_eq!(options.prior_of(Parameter::N), Prior::Flat);
        assert!(options.is_sound() && !PosteriorOptions { draws: 3, ..options }.is_sound());
    }

    #[test]
    fn a_prior_outside_the_bounds_is_told() {
        let bounds = (0.5, 3.0);
        assert!(check_prior(Parameter::N, Prior::Uniform { low: 1.0, high: 2.0 }, bounds).is_ok());
        assert!(check_prior(Parameter::N, Prior::Uniform { low: 1.0, high: 4.0 }, bounds).is_err());
        assert!(check_prior(Parameter::N, Prior::Normal { mean: 2.0, sd: 0.0 }, bounds).is_err());
    }
}
