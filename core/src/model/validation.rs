//! Whether values are those of a surface.

use crate::model::{Parameter, ParameterSet, Parameters};
use crate::optics::{RefractiveIndex, RefractiveIndexError, shortest};

/// A value outside the domain.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// One parameter outside its domain.
    #[error("{} = {} is not allowed: expected {}", .parameter.key(), shortest(*.value), .parameter.domain())]
    Outside {
        /// Which.
        parameter: Parameter,
        /// Its value.
        value: f64,
    },
    /// n and k are both 0.
    #[error("n and k are both 0: a medium needs at least one of them above 0")]
    NoIndex,
}

impl ParameterError {
    /// The parameter to look at.
    #[must_use]
    pub fn parameter(self) -> Parameter {
        match self {
            Self::Outside { parameter, .. } => parameter,
            Self::NoIndex => Parameter::N,
        }
    }
}

impl Parameters {
    /// Checks those parameters against their domains (not the ranges of the sliders).
    ///
    /// # Errors
    ///
    /// The first parameter outside its domain, or n and k where both are 0.
    pub fn validate(&self, used: ParameterSet) -> Result<(), ParameterError> {
        for parameter in used {
            let value = self[parameter];
            if !parameter.domain().contains(value) {
                return Err(ParameterError::Outside { parameter, value });
            }
        }
        match RefractiveIndex::new(self.n, self.k) {
            Err(RefractiveIndexError::Zero) if used.contains(Parameter::N) => Err(ParameterError::NoIndex),
            _ => Ok(()),
        }
    }
}
