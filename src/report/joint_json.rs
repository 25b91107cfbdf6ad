//! A joint fit as JSON. Numbers that do not exist or are not finite are null.

use pbrdf::fit::JointResult;
use pbrdf::model::Preset;
use serde_json::{Value, json};

/// The joint fit of that preset as a JSON object; of each measurement its file and the number of its rows in use.
#[must_use]
pub fn joint_json(preset: &Preset, result: &JointResult, sources: &[(String, usize)]) -> Value {
    let mut value = json!(result);
    value["model"] = json!(preset.key);
    for (index, (file, rows)) in sources.iter().enumerate() {
        let set = &mut value["sets"][index];
        set["file"] = json!(file);
        set["rows"] = json!(rows);
    }
    value
}
