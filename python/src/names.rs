//! Models and parameters by their names.

use crate::error::refused;
use pbrdf::Pbrdf;
use pbrdf::model::{AssignmentError, PRESETS, Parameter, Parameters, Preset};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

/// The preset of that name.
pub fn preset(name: &str) -> PyResult<&'static Preset> {
    Preset::from_key(name).ok_or_else(|| {
        let known: Vec<&str> = PRESETS.iter().map(|preset| preset.key).collect();
        refused(format_args!("{name:?} is no model; expected one of {}", known.join(", ")))
    })
}

/// The parameter of that name.
pub fn parameter(name: &str) -> PyResult<Parameter> {
    Parameter::from_key(name).ok_or_else(|| refused(AssignmentError::Name(name.to_owned())))
}

/// The surface of a model with those values; the others have their defaults.
pub fn surface(model: &str, values: &[(String, f64)]) -> PyResult<Pbrdf> {
    let mut parameters = Parameters::default();
    for (name, value) in values {
        parameters[parameter(name)?] = *value;
    }
    Pbrdf::new(preset(model)?.model, parameters).map_err(refused)
}

/// One of the words of an option.
pub fn choice<T: DeserializeOwned>(option: &str, word: &str) -> PyResult<T> {
    serde_json::from_value(word.into())
        .map_err(|error| refused(format_args!("{option}: {error}").to_string().replace("unknown variant", "there is no")))
}

/// A row of the table of models: name, what it is, where it comes from, its parameters.
type ModelRow = (&'static str, &'static str, &'static str, Vec<&'static str>);
/// A row of the table of parameters: name, words, unit, default, range of sliders and fits, what it means.
type ParameterRow = (&'static str, &'static str, &'static str, f64, (f64, f64), &'static str);

/// All models.
#[pyfunction]
pub fn models() -> Vec<ModelRow> {
    PRESETS
        .iter()
        .map(|preset| (preset.key, preset.name, preset.citation, preset.model.parameters().iter().map(Parameter::key).collect()))
        .collect()
}

/// All parameters.
#[pyfunction]
pub fn parameters() -> Vec<ParameterRow> {
    let of = |parameter: Parameter| {
        let range = parameter.range();
        let ends = (*range.start(), *range.end());
        (parameter.key(), parameter.name(), parameter.unit(), parameter.default_value(), ends, parameter.help())
    };
    Parameter::ALL.map(of).into()
}
