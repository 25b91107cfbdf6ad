//! What a polarisation camera sees of a surface.

use crate::error::refused;
use crate::names::surface;
use crate::watched::watched;
use numpy::PyArray1;
use pbrdf::model::{Lamp, Lighting, Picture, Quality, Shape, SkyTable};
use pyo3::prelude::*;

/// How a picture is asked for.
#[derive(FromPyObject)]
pub struct PictureRequest {
    model: String,
    parameters: Vec<(String, f64)>,
    shape: String,
    /// Angle from z and from x towards y, degrees.
    lamp: Option<(f64, f64)>,
    /// Radiance.
    sky: Option<f64>,
    size: usize,
}

/// The shape of that name.
pub fn shape_of(name: &str) -> PyResult<Shape> {
    Shape::ALL.into_iter().find(|shape| shape.key() == name).ok_or_else(|| {
        let known: Vec<&str> = Shape::ALL.iter().map(|shape| shape.key()).collect();
        refused(format_args!("{name:?} is no shape; expected one of {}", known.join(", ")))
    })
}

/// S0, S1, S2 and the three components of the normal in each pixel, row by row from the top; NaN where there is no surface.
#[pyfunction]
pub fn picture(py: Python<'_>, request: PictureRequest) -> PyResult<Vec<Bound<'_, PyArray1<f64>>>> {
    let surface = surface(&request.model, &request.parameters)?;
    let shape = shape_of(&request.shape)?;
    let lamp = request.lamp.map(|(polar, azimuth)| Lamp::new(polar, azimuth)).transpose().map_err(refused)?;
    let columns = watched(py, None, |watch| {
        watch.observe(|observer| {
            let sky = request.sky.map(|radiance| (radiance, SkyTable::new(&surface, Quality::Fine)));
            let lighting = Lighting { lamp, sky: sky.as_ref().map(|(radiance, table)| (*radiance, table)) };
            let picture = Picture::new(shape, request.size, observer.cancelled)?;
            let image = picture.stokes(&surface, &lighting, observer.cancelled)?;
            let pixels = || (0..request.size * request.size).map(|pixel| (pixel / request.size, pixel % request.size));
            let normals: Vec<[f64; 3]> = pixels().map(|(row, column)| picture.normal(row, column).unwrap_or([f64::NAN; 3])).collect();
            let component = |index: usize| normals.iter().map(|normal| normal[index]).collect::<Vec<f64>>();
            Some([image.s0, image.s1, image.s2, component(0), component(1), component(2)])
        })
    })?;
    Ok(columns.into_iter().flatten().map(|column| PyArray1::from_vec(py, column)).collect())
}
