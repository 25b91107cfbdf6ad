//! `picture`: what a polarisation camera sees of a surface.

use crate::cli::arguments::PictureArguments;
use crate::cli::failure::Failure;
use crate::cli::{interrupt, output, simulate};
use crate::files::picture::{StokesFileKind, stokes_file_kind, write_colors, write_exr, write_table};
use pbrdf::measurement::Columns;
use pbrdf::model::{Lamp, Lighting, Pbrdf, Picture, Quality, SkyTable};
use std::process::ExitCode;

/// Where the lamp is without `--lamp` and `--sky`.
const DEFAULT_LAMP: [f64; 2] = [30.0, 135.0];
/// Any angle at which the sky's light on a surface is finite, if it is anywhere.
const SOMEWHERE: f64 = 45.0;

pub fn run(arguments: &PictureArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let surface = simulate::surface(&arguments.surface, Columns::Brdf)?;
    let kind = stokes_file_kind(&arguments.output).map_err(|error| Failure::usage(format!("{error}.")))?;
    let lamp = match (arguments.lamp, arguments.sky) {
        (None, None) => Lamp::new(DEFAULT_LAMP[0], DEFAULT_LAMP[1]).ok(),
        (lamp, _) => lamp,
    };
    let table = arguments.sky.map(|radiance| sky(&surface).map(|table| (radiance, table))).transpose()?;
    let lighting = Lighting { lamp, sky: table.as_ref().map(|(radiance, table)| (*radiance, table)) };
    let cancelled = interrupt::asked;
    let painted = output::while_waiting("painting", || {
        let picture = Picture::new(arguments.shape, arguments.size, &cancelled)?;
        let image = picture.stokes(&surface, &lighting, &cancelled)?;
        Some((picture, image))
    });
    let (picture, image) = painted.ok_or_else(Failure::interrupted)?;
    output::write(Some(&arguments.output), |out| match kind {
        StokesFileKind::Png => {
            let map = arguments.show.map(&image, arguments.analyser, arguments.show.range(&image));
            write_colors(&map, out)
        }
        StokesFileKind::Exr => write_exr(&image, out),
        StokesFileKind::Csv => write_table(&picture, &image, lamp.as_ref(), arguments.sky.is_some(), out),
    })?;
    Ok(ExitCode::SUCCESS)
}

/// What a surface shows under the sky.
fn sky(surface: &Pbrdf) -> Result<SkyTable, Failure> {
    let table = SkyTable::new(surface, Quality::Fine);
    if table.at(SOMEWHERE)[0].is_finite() {
        return Ok(table);
    }
    let c = surface.parameters().c;
    Err(Failure::usage(format!("With c = {c} the diffuse term makes infinite light of a sky; expected c above -2 under --sky.")))
}
