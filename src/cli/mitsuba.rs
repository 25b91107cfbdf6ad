//! `export mitsuba`: the tensor that Mitsuba 3 renders.

use crate::cli::arguments::MitsubaArguments;
use crate::cli::failure::Failure;
use crate::cli::{interrupt, output, simulate};
use pbrdf::measurement::{Columns, TensorGrid, write_tensor};
use std::ops::ControlFlow;
use std::process::ExitCode;

pub fn run(arguments: &MitsubaArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let surface = simulate::surface(&arguments.surface, Columns::Brdf)?;
    let grid = TensorGrid::new(&surface, arguments.resolution);
    let mut progress = output::Progress::new("exporting");
    let mut tell = |done| {
        progress.tell_fraction(done);
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    output::write(Some(&arguments.output), |out| write_tensor(&surface, &grid, arguments.wavelength, &mut tell, out))
        .map_err(|failure| if interrupt::asked() { Failure::interrupted() } else { failure })?;
    Ok(ExitCode::SUCCESS)
}
