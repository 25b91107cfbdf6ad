//! `plan`: what a choice of angles would determine, before anything is measured.

use super::arguments::{Columns, Plan};
use super::failure::Failure;
use super::output;
use super::simulate::simulation;
use pbrdf::fit::{Bounds, Choices, Problem, Uncertainty, Weights, free_by_default};
use pbrdf::measurement::Simulation;
use pbrdf::model::{Parameter, ParameterSet};
use serde_json::{Map, Value, json};
use std::process::ExitCode;

pub fn run(task: &Plan) -> Result<ExitCode, Failure> {
    let simulation = Simulation {
        noise: task.noise,
        brdf_noise: if matches!(task.columns, Columns::Dolp) { 0.0 } else { task.brdf_noise },
        ..simulation(&task.surface, &task.angles, task.columns)?
    };
    let measurement = simulation.run().map_err(|error| Failure::usage(format!("{error}.")))?;
    let model = task.surface.model.model;
    let choices = Choices { weights: Weights::Sigma, dolp_only: task.surface.model.dolp_only, ..Choices::default() };
    let mut free = free_by_default(model, &measurement, &choices);
    for &parameter in task.fix.iter().chain(&task.free) {
        if !model.parameters().contains(parameter) {
            output::notice(format_args!(
                "The model {} has no parameter {}: what is said of it is ignored.",
                task.surface.model.key,
                parameter.key()
            ));
        }
    }
    let freed: ParameterSet = task.free.iter().copied().collect();
    free = free.without_all(task.fix.iter().copied().collect()).union(freed.intersection(model.parameters()));
    let truth = *simulation.surface.parameters();
    let mut bounds = Bounds::default();
    for parameter in free {
        bounds.widen_to(parameter, truth[parameter]);
    }
    let problem = Problem::new(&measurement, model, truth, free, bounds, choices).map_err(|error| Failure::usage(format!("{error}.")))?;
    let uncertainty = Uncertainty::at(&problem, &truth, 0.0, ParameterSet::EMPTY);
    if task.json {
        let errors: Map<String, Value> =
            free.iter().map(|parameter| (parameter.key().to_owned(), json!(uncertainty.standard_error(parameter)))).collect();
        output::write_json(&json!({ "std_error": errors, "undetermined": uncertainty.open }))?;
        return Ok(ExitCode::SUCCESS);
    }
    output::write(None, |out| {
        writeln!(out, "{} points, predicted standard errors:", measurement.rows.len())?;
        for parameter in free {
            let error = uncertainty.standard_error(parameter).map_or_else(|| "open".to_owned(), |error| format!("{error:.3e}"));
            let (value, unit) = (truth[parameter], Parameter::unit(parameter));
            writeln!(out, "  {:<8} {value:>12.6} ± {error} {unit}", parameter.key())?;
        }
        for direction in &uncertainty.open {
            writeln!(out, "open: {}", direction.text)?;
        }
        Ok(())
    })?;
    Ok(ExitCode::SUCCESS)
}
