//! A fit as JSON: the keys that other programs rely on. Numbers that do not exist or are not finite are null.

use pbrdf::fit::{Edge, FitResult};
use pbrdf::model::Preset;
use serde_json::{Map, Value, json};

/// The fit of that preset as a JSON object.
#[must_use]
pub fn fit_json(preset: &Preset, report: &FitResult) -> Value {
    let parameters: Map<String, Value> = report
        .estimates
        .iter()
        .map(|estimate| {
            let at_bound = estimate.at_bound.map(|edge| match edge {
                Edge::Lower => "lower",
                Edge::Upper => "upper",
            });
            let value = json!({
                "value": estimate.value,
                "free": estimate.free,
                "std_error": estimate.std_error,
                "at_bound": at_bound,
            });
            (estimate.parameter.key().to_owned(), value)
        })
        .collect();
    let names: Vec<&str> = report.determined.iter().map(|parameter| parameter.key()).collect();
    let matrix: Vec<Vec<f64>> = report.correlations.row_iter().map(|row| row.iter().copied().collect()).collect();
    let starts: Vec<Value> = report
        .minima
        .iter()
        .map(|minimum| json!({ "objective": minimum.objective, "stop_reason": minimum.stop_reason, "reached": minimum.hits }))
        .collect();
    json!({
        "model": preset.key,
        "distribution": report.model.distribution.key(),
        "objective": report.objective,
        "sum_of_squares": report.sum_of_squares,
        "chi2": report.chi2,
        "dof": report.dof,
        "aicc": report.aicc,
        "stop_reason": report.stop_reason,
        "evaluations": report.evaluations,
        "elapsed_ms": report.elapsed_ms,
        "parameters": parameters,
        "undetermined": report.undetermined,
        "correlations": { "names": names, "matrix": matrix },
        "starts": starts,
        "trace": report.trace,
    })
}
