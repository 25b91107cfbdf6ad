//! Pictures of Stokes vectors as files: colours with a key, images of numbers, tables.

use crate::figure::HeatMap;
use crate::files::export::{EndingError, Endings, extension};
use exr::prelude::{SpecificChannels, WritableImage as _};
use pbrdf::model::{Lamp, Picture, StokesImage};
use pbrdf::optics::shortest;
use std::io::{self, Cursor, Write};
use std::path::Path;

/// Resolution that a PNG states, in dots an inch: that of a screen.
const SCREEN_DPI: f64 = 96.0;

/// How a picture is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StokesFileKind {
    /// Colours.
    Png,
    /// 32-bit numbers.
    Exr,
    /// A row for each pixel.
    Csv,
}

/// The format of a picture by the ending of its file name.
pub fn stokes_file_kind(path: &Path) -> Result<StokesFileKind, EndingError> {
    match extension(path).as_str() {
        "png" => Ok(StokesFileKind::Png),
        "exr" => Ok(StokesFileKind::Exr),
        "csv" => Ok(StokesFileKind::Csv),
        _ => Err(EndingError::new(path, Endings::Stokes)),
    }
}

/// A map of colours with its key, one pixel a cell.
pub fn write_colors(map: &HeatMap, out: &mut dyn Write) -> io::Result<()> {
    let bytes = map.image_with_key().and_then(|image| image.png(SCREEN_DPI)).map_err(io::Error::other)?;
    out.write_all(&bytes)
}

/// An image of numbers: channels S0, S1, S2 and S3, 0 where there is no surface.
pub fn write_exr(image: &StokesImage, out: &mut dyn Write) -> io::Result<()> {
    let number = |component: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "the format's own numbers")]
        let number = component as f32;
        if number.is_nan() { 0.0 } else { number }
    };
    let channels = SpecificChannels::build().with_channel("S0").with_channel("S1").with_channel("S2").with_channel("S3").with_pixel_fn(
        |at: exr::prelude::Vec2<usize>| {
            let pixel = at.y() * image.size + at.x();
            (number(image.s0[pixel]), number(image.s1[pixel]), number(image.s2[pixel]), 0.0_f32)
        },
    );
    // The format's writer goes back to fill in where its lines are.
    let mut bytes = Cursor::new(Vec::new());
    let image = exr::prelude::Image::from_channels((image.size, image.size), channels);
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    out.write_all(bytes.get_ref())
}

/// A row for each lit pixel: its centre, the angles of the lamp, empty where only the sky lights it, and its Stokes vector.
pub fn write_table(picture: &Picture, image: &StokesImage, lamp: Option<&Lamp>, has_sky: bool, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "x,y,theta_i,theta_r,dphi,s0,s1,s2,s3")?;
    for (row, column) in (0..image.size).flat_map(|row| (0..image.size).map(move |column| (row, column))) {
        let Some((stokes, normal)) = image.at(row, column).zip(picture.normal(row, column)) else { continue };
        let (x, y) = picture.center(row, column);
        let angles = match lamp.and_then(|lamp| lamp.geometry(normal)) {
            Some(at) => [at.theta_i(), at.theta_r(), at.dphi()].map(|angle| shortest(angle.0)).join(","),
            None if has_sky => ",,".to_owned(),
            None => continue,
        };
        let [s0, s1, s2, s3] = [0, 1, 2, 3].map(|component| shortest(stokes.0[component]));
        writeln!(out, "{},{},{angles},{s0},{s1},{s2},{s3}", shortest(x), shortest(y))?;
    }
    Ok(())
}
