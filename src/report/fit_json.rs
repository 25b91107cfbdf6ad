//! A fit as JSON. Numbers that do not exist or are not finite are null.

use pbrdf::fit::FitResult;
use pbrdf::model::Preset;
use serde_json::{Value, json};

/// The fit of that preset as a JSON object.
#[must_use]
pub fn fit_json(preset: &Preset, report: &FitResult) -> Value {
    let mut value = json!(report);
    value["model"] = json!(preset.key);
    value
}
