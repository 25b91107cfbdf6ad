//! `plan`: predicted standard errors for a choice of angles.

use crate::cli::arguments::PlanArguments;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::cli::simulate::simulation;
use pbrdf::fit::{Design, DesignPrediction, NoiseModel};
use pbrdf::measurement::Columns;
use pbrdf::model::{Parameter, ParameterSet};
use serde_json::{Map, Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

pub fn run(arguments: &PlanArguments) -> Result<ExitCode, Failure> {
    let simulation = simulation(&arguments.surface, &arguments.angles, arguments.columns)?;
    let geometries = simulation.geometries().map_err(|error| Failure::usage(format!("{error}.")))?;
    let noise = NoiseModel {
        dolp: (!matches!(arguments.columns, Columns::Brdf)).then_some(arguments.noise),
        brdf: (!matches!(arguments.columns, Columns::Dolp)).then_some(arguments.brdf_noise),
    };
    let model = simulation.surface.model();
    let mut plan = Design::new(model, *simulation.surface.parameters(), geometries, noise);
    for &parameter in arguments.fix.iter().chain(&arguments.free) {
        if !model.parameters().contains(parameter) {
            output::notice(format_args!(
                "The model {} has no parameter {}: what is said of it is ignored.",
                arguments.surface.model.key,
                parameter.key()
            ));
        }
    }
    let freed: ParameterSet = arguments.free.iter().copied().collect();
    plan.free = plan.free.without_all(arguments.fix.iter().copied().collect()).union(freed.intersection(model.parameters()));
    let prediction = plan.predict().map_err(|error| Failure::usage(format!("{error}.")))?;
    if arguments.json {
        let errors: Map<String, Value> =
            prediction.errors.iter().map(|(parameter, error)| (parameter.key().to_owned(), json!(error))).collect();
        output::write_json(&json!({ "std_error": errors, "undetermined": prediction.undetermined }))?;
    } else {
        output::write(None, |out| print(out, &plan, &prediction))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn print(out: &mut dyn Write, plan: &Design, prediction: &DesignPrediction) -> io::Result<()> {
    let condition = prediction.condition.map_or_else(String::new, |condition| format!(", condition {condition:.1e}"));
    writeln!(
        out,
        "{} points determine {} of {} directions{condition}; predicted standard errors:",
        plan.geometries.len(),
        prediction.rank,
        prediction.errors.len()
    )?;
    for (parameter, error) in &prediction.errors {
        let error = error.map_or_else(|| "open".to_owned(), |error| format!("{error:.3e}"));
        let (value, unit) = (plan.parameters[*parameter], Parameter::unit(*parameter));
        writeln!(out, "  {:<8} {value:>12.6} ± {error} {unit}", parameter.key())?;
    }
    for direction in &prediction.undetermined {
        writeln!(out, "open: {direction}")?;
    }
    Ok(())
}
