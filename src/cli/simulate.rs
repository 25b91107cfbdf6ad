//! `simulate`: a simulated measurement, marked as such in its metadata.

use crate::cli::arguments::{AngleArguments, SimulateArguments, SurfaceArguments};
use crate::cli::failure::Failure;
use crate::cli::import_command::quoted;
use crate::cli::output::{self, Progress};
use crate::cli::{interrupt, values};
use pbrdf::measurement::{Columns, Simulation, grid_geometries};
use pbrdf::model::{Parameters, Pbrdf};
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::process::ExitCode;

/// Output that tells how many of its rows are written, and ends on an interruption.
struct Watched<'a> {
    out: &'a mut dyn Write,
    lines: usize,
    rows: usize,
    progress: &'a mut Progress,
}

impl Write for Watched<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if interrupt::asked() {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        let written = self.out.write(bytes)?;
        self.lines += bytes[..written].iter().filter(|&&byte| byte == b'\n').count();
        #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress line")]
        self.progress.tell(|| format!("{:.0} %", 100.0 * (self.lines as f64 / self.rows as f64).min(1.0)));
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

pub fn run(arguments: &SimulateArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let simulation = Simulation {
        noise: arguments.noise,
        brdf_noise: arguments.brdf_noise,
        seed: arguments.seed,
        ..simulation(&arguments.surface, arguments.columns)?
    };
    let AngleArguments { theta_i, theta_r, dphi } = &arguments.angles;
    let rows = values::row_count(&[theta_i, dphi, theta_r]).map_err(Failure::usage)?;
    // Series after series: the planes of one angle of incidence stand together.
    let planes = theta_i.0.iter().flat_map(|&theta_i| dphi.0.iter().map(move |&dphi| (theta_i, dphi)));
    let geometries = planes.map(|(theta_i, dphi)| grid_geometries(&[theta_i], &theta_r.0, dphi)).collect::<Result<Vec<_>, _>>();
    let geometries = geometries.map_err(|error| Failure::usage(format!("{error}.")))?.concat();
    let mut progress = Progress::new("simulating");
    let mut watch = |done: f64| {
        progress.tell_fraction(done);
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut measurement = simulation.run_at(&geometries, &mut watch).ok_or_else(Failure::interrupted)?;
    drop(progress);
    let command = command_without_output(std::env::args().skip(1));
    measurement.metadata.insert(1, ("command".to_owned(), command));
    let mut progress = Progress::new("writing");
    output::write(Some(&arguments.output), |out| measurement.write(&mut Watched { out, lines: 0, rows, progress: &mut progress }))
        .map_err(|failure| if interrupt::asked() { Failure::interrupted() } else { failure })?;
    Ok(ExitCode::SUCCESS)
}

/// A simulation without noise, and without angles.
fn simulation(surface: &SurfaceArguments, columns: Columns) -> Result<Simulation, Failure> {
    Ok(Simulation {
        model_name: surface.model.key.to_owned(),
        surface: self::surface(surface, columns)?,
        theta_i: Vec::new(),
        theta_r: Vec::new(),
        dphi: 180.0,
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
    if let Some(parameter) = values::twice(surface.set.iter().map(|&(parameter, _)| parameter)) {
        return Err(Failure::usage(format!("--set names {} twice.", parameter.key())));
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
