//! Models that are special cases of others, and what a fit of one tells the fit of the other.
//!
//! A model does what its special case does where the lobes that this one lacks have no weight, where a Minnaert lobe has c = 0
//! (Lambert), and, in the limit of large q, where Cauchy has σ = √q σ_Gauss. A fit that starts there too never ends above it.

use crate::fit::joint::problem::JointProblem;
use crate::fit::joint::result::JointResult;
use crate::fit::objective::Problem;
use crate::fit::result::FitResult;
use crate::model::{Diffuse, Model, Parameter, ParameterSet, Parameters};
use crate::optics::SlopeDistribution;

/// The order in which to fit models so that each comes after all its special cases: indices into the models, which keep their order
/// otherwise.
#[must_use]
pub fn special_cases_first(models: &[Model]) -> Vec<usize> {
    let terms = |model: &Model| {
        let diffuse = match model.diffuse {
            Diffuse::Absent => 0,
            Diffuse::Hyde | Diffuse::Lambert => 1,
            Diffuse::Minnaert => 2,
        };
        diffuse + u8::from(model.volume) + u8::from(model.distribution == SlopeDistribution::Cauchy)
    };
    let mut order: Vec<usize> = (0..models.len()).collect();
    order.sort_by_key(|&index| terms(&models[index]));
    order
}

/// Whether the diffuse lobe of `special` is one of `general` at some weight and shape.
fn contains_diffuse(general: Diffuse, special: Diffuse) -> bool {
    match (general, special) {
        // Hyde's lobe has no weight that could be 0.
        (Diffuse::Lambert | Diffuse::Minnaert, Diffuse::Absent) | (Diffuse::Minnaert, Diffuse::Lambert) => true,
        (general, special) => general == special,
    }
}

/// The same problem that starts also where those fits of special cases of its model ended; fits of other models are left aside.
#[must_use]
pub fn with_special_cases<'a>(problem: &Problem, fits: impl IntoIterator<Item = &'a FitResult>) -> Problem {
    let starts = fits.into_iter().filter_map(|fit| start_at_special_case(problem, fit.model, &fit.parameters, f64::INFINITY));
    problem.with_further_starts(starts.collect())
}

/// The same of a joint fit: each measurement starts at its special case.
#[must_use]
pub fn with_special_cases_jointly<'a>(problem: &JointProblem, fits: impl IntoIterator<Item = &'a JointResult>) -> JointProblem {
    let start = |fit: &JointResult| {
        let parts = || problem.parts().iter().zip(&fit.sets);
        let at = |largest_q: f64| -> Option<Vec<Parameters>> {
            parts().map(|(part, set)| start_at_special_case(part, fit.model, &set.parameters, largest_q)).collect()
        };
        let point = at(f64::INFINITY)?;
        // A shared q has to be within reach of every measurement's σ.
        let smallest_q = point.iter().map(|start| start.q).fold(f64::INFINITY, f64::min);
        if problem.own().contains(Parameter::Q) { Some(point) } else { at(smallest_q) }
    };
    problem.with_further_starts(fits.into_iter().filter_map(start).collect::<Vec<_>>())
}

/// A problem whose fit may begin where fits of special cases of its model ended.
pub trait SpecialCases: Sized {
    /// What a fit of it gives.
    type Fitted;

    /// Which terms there are.
    fn terms(&self) -> Model;

    /// The same problem that starts also where those fits of special cases ended.
    #[must_use]
    fn starting_at_special_cases(&self, fits: &[Option<Self::Fitted>]) -> Self;
}

impl SpecialCases for Problem {
    type Fitted = FitResult;

    fn terms(&self) -> Model {
        self.model()
    }

    fn starting_at_special_cases(&self, fits: &[Option<FitResult>]) -> Self {
        with_special_cases(self, fits.iter().flatten())
    }
}

impl SpecialCases for JointProblem {
    type Fitted = JointResult;

    fn terms(&self) -> Model {
        self.model()
    }

    fn starting_at_special_cases(&self, fits: &[Option<JointResult>]) -> Self {
        with_special_cases_jointly(self, fits.iter().flatten())
    }
}

/// The fits of a ladder of models, in the order of their problems; a place without a problem stays empty.
///
/// Each problem comes after those of its special cases and starts also where these ended, so that no fit ends above one of them.
/// `fit` gets the place of a problem and the problem; where it has no answer the ladder ends with what there is.
pub fn fit_ladder<P: SpecialCases>(problems: &[Option<&P>], mut fit: impl FnMut(usize, &P) -> Option<P::Fitted>) -> Vec<Option<P::Fitted>> {
    let (places, models): (Vec<usize>, Vec<Model>) =
        problems.iter().enumerate().filter_map(|(place, problem)| Some((place, (*problem)?.terms()))).unzip();
    let mut fits: Vec<Option<P::Fitted>> = problems.iter().map(|_| None).collect();
    for place in special_cases_first(&models).into_iter().map(|index| places[index]) {
        let Some(problem) = problems[place] else { continue };
        let fitted = fit(place, &problem.starting_at_special_cases(&fits));
        if fitted.is_none() {
            break;
        }
        fits[place] = fitted;
    }
    fits
}

/// Where this model does what its special case does with those parameters, as far as the bounds, a largest q and what is fixed allow; none
/// where the other is no special case.
fn start_at_special_case(problem: &Problem, special: Model, parameters: &Parameters, largest_q: f64) -> Option<Parameters> {
    let general = problem.model();
    // DoLP of mirror facets alone is that of Fresnel: neither their slopes nor masking play a part.
    let is_bare = special.diffuse == Diffuse::Absent && !special.volume && problem.knows_only_ratios();
    let is_limit = general.distribution == SlopeDistribution::Cauchy && special.distribution == SlopeDistribution::Gauss;
    let is_contained = general.dolp_formula == special.dolp_formula
        && general.specular == special.specular
        && contains_diffuse(general.diffuse, special.diffuse)
        && (general.volume || !special.volume)
        && (is_bare || general.masking == special.masking && (is_limit || general.distribution == special.distribution));
    if !is_contained {
        return None;
    }
    let mut start = *problem.start();
    let shared = general.parameters().intersection(special.parameters());
    let idle = if is_bare { [Parameter::Sigma, Parameter::Q].into_iter().collect() } else { ParameterSet::EMPTY };
    for parameter in shared.without_all(idle) {
        start[parameter] = parameters[parameter];
    }
    if special.diffuse == Diffuse::Absent {
        start.kd = 0.0;
    }
    if special.diffuse == Diffuse::Lambert && general.diffuse == Diffuse::Minnaert {
        start.c = 0.0;
    }
    if !special.volume {
        start.kv = 0.0;
    }
    if is_limit && !is_bare {
        // The largest q whose σ lies within the bounds.
        let (_, largest_sigma) = problem.bounds().of(Parameter::Sigma);
        let of_largest_sigma = (largest_sigma / start.sigma) * (largest_sigma / start.sigma);
        start.q = problem.bounds().clamp(Parameter::Q, problem.bounds().of(Parameter::Q).1.min(of_largest_sigma).min(largest_q));
        start.sigma *= start.q.sqrt();
    }
    Some(start)
}
