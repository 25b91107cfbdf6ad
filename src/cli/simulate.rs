//! `simulate`: a simulated measurement, marked as such in its metadata.

use crate::cli::arguments::{AngleArguments, SimulateArguments, SurfaceArguments};
use crate::cli::failure::Failure;
use crate::cli::import_command::quoted;
use crate::cli::output;
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::model::{Parameters, Pbrdf};
use std::process::ExitCode;

pub fn run(arguments: &SimulateArguments) -> Result<ExitCode, Failure> {
    let simulation = Simulation {
        noise: arguments.noise,
        brdf_noise: arguments.brdf_noise,
        seed: arguments.seed,
        ..simulation(&arguments.surface, &arguments.angles, arguments.columns)?
    };
    let mut measurement = simulation.run().map_err(|error| Failure::usage(format!("{error}.")))?;
    let command = command_without_output(std::env::args().skip(1));
    measurement.metadata.insert(1, ("command".to_owned(), command));
    output::write(Some(&arguments.output), |out| measurement.write(out))?;
    Ok(ExitCode::SUCCESS)
}

/// A simulation without noise.
pub fn simulation(surface: &SurfaceArguments, angles: &AngleArguments, columns: Columns) -> Result<Simulation, Failure> {
    Ok(Simulation {
        model_name: surface.model.key.to_owned(),
        surface: self::surface(surface, columns)?,
        theta_i: angles.theta_i.0.clone(),
        theta_r: angles.theta_r.0.clone(),
        dphi: angles.dphi,
        columns,
        noise: 0.0,
        brdf_noise: 0.0,
        seed: 0,
    })
}

/// A model with its values, if it predicts those columns.
pub fn surface(surface: &SurfaceArguments, columns: Columns) -> Result<Pbrdf, Failure> {
    let mut parameters = Parameters::default();
    let preset = surface.model;
    if preset.dolp_only && !matches!(columns, Columns::Dolp) {
        return Err(Failure::usage(format!("The model {} predicts DoLP only, not a BRDF.", preset.key)));
    }
    for &(parameter, value) in &surface.set {
        if !preset.model.parameters().contains(parameter) {
            output::notice(format_args!("The model {} has no parameter {}: its value is ignored.", preset.key, parameter.key()));
        }
        parameters[parameter] = value;
    }
    Pbrdf::new(preset.model, parameters).map_err(|error| Failure::usage(format!("{error}.")))
}

/// The command without its output path, so that the same command gives the same bytes in any folder.
fn command_without_output(arguments: impl Iterator<Item = String>) -> String {
    let mut words = vec!["pbrdf-explorer".to_owned()];
    let mut skip_next = false;
    for argument in arguments {
        if skip_next {
            skip_next = false;
        } else if matches!(argument.as_str(), "-o" | "--output") {
            skip_next = true;
        } else if !(argument.starts_with("--output=") || (argument.starts_with("-o") && !argument.starts_with("--"))) {
            words.push(quoted(&argument));
        }
    }
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::command_without_output;

    #[test]
    fn the_command_is_kept_without_its_output() {
        let words = ["simulate", "--set", "n=2,k=3", "-o", "/tmp/a b.csv", "--theta-r=-60:60:5", "--output=x"];
        let command = command_without_output(words.map(str::to_owned).into_iter());
        assert_eq!(command, "pbrdf-explorer simulate --set n=2,k=3 --theta-r=-60:60:5");
    }
}
