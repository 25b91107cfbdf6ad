//! Which parameters a fit changes unless told otherwise.

use crate::fit::options::FitOptions;
use crate::measurement::Measurement;
use crate::model::{DolpFormula, Model, Parameter, ParameterSet};

/// The parameters that a fit changes unless told otherwise: all of the model, but with DoLP alone k_s stays (only ratios of
/// weights enter the consistent formula), and so do those that DoLP does not depend on.
#[must_use]
pub fn free_by_default(model: Model, measurement: &Measurement, choices: &FitOptions) -> ParameterSet {
    if measurement.has_brdf() && !choices.dolp_only {
        return model.parameters();
    }
    let set = model.dolp_parameters();
    match model.dolp_formula {
        DolpFormula::Consistent => set.without(Parameter::Ks),
        DolpFormula::AsPrinted => set,
    }
}
