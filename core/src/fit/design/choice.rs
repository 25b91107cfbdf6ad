//! Which angles to measure: the request, and what came of it.

use crate::fit::design::candidates::CandidateGrid;
use crate::fit::design::prediction::NoiseModel;
use crate::fit::estimate::symbols;
use crate::fit::problem_error::ProblemError;
use crate::measurement::Row;
use crate::model::{Model, Parameter, ParameterError, ParameterSet, Parameters, Pbrdf};
use crate::optics::GeometryError;

/// What the angles are to be good for.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum DesignCriterion {
    /// All free parameters: the largest ln det of the information on them, each in units of max(|value|, 0.1), of unit noise.
    Determinant,
    /// These: the smallest sum of their variances, each over max(|value|, 0.1)².
    Variances(Vec<Parameter>),
    /// Telling the surface's model from a rival: the largest sum of squares, in units of the noise, that the best fit of the rival leaves.
    Discrimination {
        /// The rival.
        rival: Model,
        /// Parameters that the rival's fit holds at the surface's values.
        fixed: ParameterSet,
    },
}

/// A request for angles.
#[derive(Debug, Clone)]
pub struct AngleChoice {
    /// Which terms the surface has.
    pub model: Model,
    /// Its supposed values; of several, the criterion is averaged: ln det, the logarithm of variances, the sum of squares.
    pub surfaces: Vec<Parameters>,
    /// How well is measured.
    pub noise: NoiseModel,
    /// The parameters that the fit is to find.
    pub free: ParameterSet,
    /// Where could be measured.
    pub grid: CandidateGrid,
    /// What is measured already.
    pub given: Vec<Row>,
    /// How many readings, beside those that are given.
    pub count: usize,
    /// Whether a pair of directions may be measured more than once.
    pub repeats: bool,
    /// What they are to be good for.
    pub criterion: DesignCriterion,
}

impl AngleChoice {
    /// Refuses to ask for no error, or for that of a parameter that is not free.
    pub(crate) fn check_asked(&self) -> Result<(), AngleChoiceError> {
        let asked = match &self.criterion {
            DesignCriterion::Variances(asked) => asked.clone(),
            _ => self.free.iter().collect(),
        };
        if self.free.is_empty() || asked.is_empty() {
            return Err(AngleChoiceError::Nothing);
        }
        match asked.into_iter().find(|&parameter| !self.free.contains(parameter)) {
            Some(parameter) => Err(AngleChoiceError::NotFree { parameter }),
            None => Ok(()),
        }
    }

    /// The surface of every so many sets of parameters.
    pub(crate) fn every(&self, step: usize) -> Result<Vec<Pbrdf>, ParameterError> {
        self.surfaces.iter().step_by(step).map(|&parameters| Pbrdf::new(self.model, parameters)).collect()
    }

    /// Number of values that are measured already.
    pub(crate) fn given_values(&self) -> usize {
        let used = self.given.iter().filter(|row| !row.masked);
        used.map(|row| usize::from(row.dolp.is_some()) + usize::from(row.brdf.is_some())).sum()
    }
}

/// Angles, and how good they are.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ChosenAngles {
    /// θi, θr and Δφ in degrees as the grid has them, and how often, in the order of the grid.
    pub angles: Vec<([f64; 3], usize)>,
    /// The criterion of these angles with what is given: ln det; sum of relative variances; sum of squares over the noise's variance.
    pub value: f64,
    /// The same of all candidates, each once.
    pub of_all_candidates: f64,
    /// How much of what all candidates tell these readings tell, 0 to 1, or a little more with repeats: the ratio of the determinants to
    /// the power of one over the number of parameters, the ratio of the variances, or that of the sums of squares.
    pub efficiency: f64,
    /// Surfaces that the average leaves out: no choice determines all parameters there.
    pub left_out: usize,
}

/// Why no angles can be chosen.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AngleChoiceError {
    /// More readings than candidates.
    #[error("there are {candidates} candidates for {count} readings; use finer steps, or allow repeats")]
    TooFewCandidates {
        /// Number of candidates.
        candidates: usize,
        /// Number of readings.
        count: usize,
    },
    /// Fewer values than parameters.
    #[error("{values} values cannot determine {parameters} parameters")]
    TooFewReadings {
        /// Values that would be measured, those that are given among them.
        values: usize,
        /// Number of free parameters.
        parameters: usize,
    },
    /// No choice of the candidates determines what is asked for.
    #[error("no choice of these candidates determines {}; fix what is known, or measure more widely", symbols(.parameters))]
    Undetermined {
        /// Parameters that stay open.
        parameters: Vec<Parameter>,
    },
    /// A parameter is asked for that is not free.
    #[error("{} is not free: its error cannot be made small", .parameter.key())]
    NotFree {
        /// Which parameter.
        parameter: Parameter,
    },
    /// The rival is the model itself.
    #[error("a model cannot be told from itself")]
    SameModel,
    /// There is no surface, no free parameter, or no quantity to measure.
    #[error("there is nothing to choose angles for: no surface, no free parameter, or no quantity to measure")]
    Nothing,
    /// The parameters are no surface.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// An angle is outside its range.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The rival cannot be fitted.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The choice was cancelled before there was an answer.
    #[error("cancelled before there was an answer")]
    Cancelled,
}

/// Angles that stand side by side as one, with how often.
pub(crate) fn repeated(angles: impl Iterator<Item = [f64; 3]>) -> Vec<([f64; 3], usize)> {
    let mut out: Vec<([f64; 3], usize)> = Vec::new();
    for angle in angles {
        match out.last_mut() {
            Some((last, times)) if *last == angle => *times += 1,
            _ => out.push((angle, 1)),
        }
    }
    out
}
