//! What a posterior needs to know of a problem beside what a fit does: its measurements one by one, and bounds that priors narrow.

use crate::fit::bounds::BoundsError;
use crate::fit::fit_problem::FitProblem;
use crate::fit::joint::problem::JointProblem;
use crate::fit::objective::Problem;
use crate::fit::posterior::transform::TransformRole;
use crate::model::{Model, Parameter};

/// One measurement of a posterior.
#[derive(Debug, Clone)]
pub(crate) struct PosteriorPart {
    pub problem: Problem,
    /// The unknown of each of its free parameters.
    pub places: Vec<usize>,
    pub role: TransformRole,
}

/// A problem with a posterior to draw from: [`Problem`] of one measurement, or [`JointProblem`] of several.
pub trait PosteriorProblem: FitProblem + sealed::Parts {
    /// Which terms there are.
    fn model(&self) -> Model;

    /// The same problem with other bounds of an unknown.
    ///
    /// # Errors
    ///
    /// [`BoundsError`] where they are no bounds of that parameter.
    fn with_bounds_of(&self, unknown: usize, bounds: (f64, f64)) -> Result<Self, BoundsError>;
}

pub(crate) mod sealed {
    use super::PosteriorPart;

    /// The measurements of a problem.
    pub trait Parts {
        /// Each by itself; nobody outside can name what this returns.
        #[doc(hidden)]
        #[expect(private_interfaces, reason = "the trait is sealed")]
        fn posterior_parts(&self) -> Vec<PosteriorPart>;
    }
}

fn narrowed(problem: &Problem, parameter: Parameter, (low, high): (f64, f64)) -> Result<Problem, BoundsError> {
    let mut bounds = *problem.bounds();
    bounds.set(parameter, low, high)?;
    let mut start = *problem.start();
    start[parameter] = bounds.clamp(parameter, start[parameter]);
    Ok(problem.with_bounds(bounds).with_start(start))
}

impl PosteriorProblem for Problem {
    fn model(&self) -> Model {
        Self::model(self)
    }

    fn with_bounds_of(&self, unknown: usize, bounds: (f64, f64)) -> Result<Self, BoundsError> {
        narrowed(self, self.free()[unknown], bounds)
    }
}

impl sealed::Parts for Problem {
    #[expect(private_interfaces, reason = "the trait is sealed")]
    fn posterior_parts(&self) -> Vec<PosteriorPart> {
        vec![PosteriorPart { problem: self.clone(), places: (0..self.free().len()).collect(), role: TransformRole::alone(self) }]
    }
}

impl PosteriorProblem for JointProblem {
    fn model(&self) -> Model {
        Self::model(self)
    }

    fn with_bounds_of(&self, unknown: usize, bounds: (f64, f64)) -> Result<Self, BoundsError> {
        let parameter = self.unknowns()[unknown].parameter;
        let set = self.set_of(unknown);
        self.changed(|index, part| if set.is_none_or(|set| set == index) { narrowed(part, parameter, bounds) } else { Ok(part.clone()) })
    }
}

impl sealed::Parts for JointProblem {
    #[expect(private_interfaces, reason = "the trait is sealed")]
    fn posterior_parts(&self) -> Vec<PosteriorPart> {
        let shared_ratios = self.knows_only_ratios();
        let has_shared_ks = self.unknowns().iter().any(|unknown| unknown.parameter == Parameter::Ks && unknown.set.is_none());
        let of_part = |(index, (part, places)): (usize, (&Problem, &Vec<usize>))| PosteriorPart {
            problem: part.clone(),
            places: places.clone(),
            role: TransformRole {
                own: self.own(),
                counted: places.iter().map(|&unknown| self.home(unknown).0 == index).collect(),
                shared_ratios,
                // A shared k_s that other data determine takes the place of k_d and k_v even where there is DoLP alone.
                own_ratios: part.knows_only_ratios() && (shared_ratios || !has_shared_ks),
            },
        };
        self.parts().iter().zip(self.places()).enumerate().map(of_part).collect()
    }
}
