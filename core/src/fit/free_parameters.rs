//! Which parameters a fit changes unless told otherwise. Decided here and nowhere else.

use crate::fit::options::FitOptions;
use crate::measurement::Measurement;
use crate::model::{DolpFormula, Model, Parameter, ParameterSet};

/// The parameters that such data depend on: all of the model where there is a BRDF, those of its DoLP otherwise.
#[must_use]
pub fn fittable(model: Model, has_brdf: bool) -> ParameterSet {
    if has_brdf { model.parameters() } else { model.dolp_parameters() }
}

/// The parameters that a fit changes unless told otherwise: those that the data depend on, except that k_s stays where DoLP by the
/// consistent formula is all there is, which only ratios of weights enter.
#[must_use]
pub fn free_by_default(model: Model, measurement: &Measurement, options: &FitOptions) -> ParameterSet {
    let has_brdf = measurement.has_brdf() && !options.dolp_only;
    let set = fittable(model, has_brdf);
    if has_brdf || model.dolp_formula == DolpFormula::AsPrinted { set } else { set.without(Parameter::Ks) }
}
