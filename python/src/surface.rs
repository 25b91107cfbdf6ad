//! Values of a surface at arrays of angles.

use crate::error::refused;
use crate::names::{parameter, surface};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pbrdf::model::{AngleColumns, AngleColumnsError, GradientRequest, ParameterSet, PreparedAngles, Reflection};
use pbrdf::optics::Facet;
use pbrdf::{Geometry, Pbrdf};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::ops::Range;

/// Points that are prepared and evaluated at once: few enough that what is prepared stays in a processor's cache of the third level, a
/// multiple of the lanes of any kernel.
const BLOCK: usize = 16_384;
/// Elements of a Mueller matrix.
const MUELLER: usize = 16;

/// What is wanted beside BRDF and DoLP.
struct Wanted {
    /// Specular, diffuse and volume part of the BRDF.
    terms: bool,
    mueller: bool,
    /// Derivatives of BRDF and DoLP by these.
    by: ParameterSet,
}

impl Wanted {
    fn new(terms: bool, mueller: bool, by: &[String]) -> PyResult<Self> {
        let by = by.iter().map(|name| parameter(name)).collect::<PyResult<ParameterSet>>()?;
        Ok(Self { terms, mueller, by })
    }

    /// Numbers of a point in each column: BRDF, DoLP; specular, diffuse and volume part; Mueller matrix; derivatives of the BRDF, then of
    /// DoLP, in the order of [`Parameter::ALL`].
    fn widths(&self) -> Vec<usize> {
        let mut widths = vec![1; if self.terms { 5 } else { 2 }];
        widths.extend(self.mueller.then_some(MUELLER));
        widths.extend(std::iter::repeat_n(1, 2 * self.by.len()));
        widths
    }
}

/// Fills the columns of [`Wanted::widths`] beyond [`radiance_columns`] with the values at points.
fn fill_rest(angles: AngleColumns<'_>, surface: &Pbrdf, wanted: &Wanted, columns: Vec<&mut [f64]>) -> Result<(), AngleColumnsError> {
    if columns.is_empty() {
        return Ok(());
    }
    let facets = (0..angles.len()).map(|point| angles.geometry(point).map(Facet::new)).collect::<Result<Vec<_>, _>>()?;
    let mut columns = columns.into_iter();
    if wanted.terms {
        for of in [|of: Reflection| of.diffuse, |of: Reflection| of.volume] {
            let column = columns.next().into_iter().flatten();
            column.zip(&facets).for_each(|(out, facet)| *out = of(surface.reflection(facet)));
        }
    }
    if wanted.mueller {
        let matrices = columns.next().map(|column| column.chunks_exact_mut(MUELLER)).into_iter().flatten();
        for (matrix, facet) in matrices.zip(&facets) {
            let mueller = surface.mueller(facet.geometry);
            matrix.iter_mut().enumerate().for_each(|(element, out)| *out = mueller.element(element / 4, element % 4));
        }
    }
    if !wanted.by.is_empty() {
        let by = wanted.by;
        let request = GradientRequest { by, brdf: true, dolp: true };
        let mut columns: Vec<&mut [f64]> = columns.collect();
        for (point, facet) in facets.iter().enumerate() {
            let (_, gradient) = surface.reflection_and_gradient(facet, request);
            let values = by.iter().map(|parameter| gradient.brdf[parameter]).chain(by.iter().map(|parameter| gradient.dolp[parameter]));
            columns.iter_mut().zip(values).for_each(|(column, value)| column[point] = value);
        }
    }
    Ok(())
}

/// As an exception that says where the point stands in an array of that shape, which is behind so many others.
fn exception(error: AngleColumnsError, before: usize, shape: &[usize]) -> PyErr {
    match error {
        AngleColumnsError::Lengths(..) => refused(error),
        AngleColumnsError::Side { point, .. } | AngleColumnsError::Point { point, .. } => {
            refused(format_args!("{error}{}", place(before + point, shape)))
        }
    }
}

/// Degrees; a negative θr is the backscatter side, where Δφ says no other.
pub fn geometry(theta_i: f64, theta_r: f64, dphi: f64) -> Result<Geometry, String> {
    let columns = [[theta_i], [theta_r], [dphi]];
    let point = AngleColumns::new(&columns[0], &columns[1], &columns[2]).and_then(|columns| columns.geometry(0));
    point.map_err(|error| error.to_string())
}

/// Where a point stands in an array of that shape: ` (at [2, 5])`; nothing of a single point.
fn place(mut point: usize, shape: &[usize]) -> String {
    let mut index: Vec<String> = Vec::new();
    for &length in shape.iter().rev() {
        index.push((point % length).to_string());
        point /= length;
    }
    index.reverse();
    if index.is_empty() { String::new() } else { format!(" (at [{}])", index.join(", ")) }
}

/// The points of a block of that number.
fn points_of_block(number: usize, points: usize) -> Range<usize> {
    number * BLOCK..points.min((number + 1) * BLOCK)
}

/// What all blocks gave, or the error of the first that has one, with the number of points before that block.
fn in_order<T>(outcomes: Vec<Result<T, AngleColumnsError>>) -> Result<Vec<T>, (usize, AngleColumnsError)> {
    outcomes.into_iter().enumerate().map(|(number, outcome)| outcome.map_err(|error| (number * BLOCK, error))).collect()
}

/// Columns of values at that many points, one behind the other, filled block by block side by side; `evaluate` fills the columns of a
/// block of that number.
fn columns_of<'py>(
    py: Python<'py>,
    shape: &[usize],
    points: usize,
    wanted: &Wanted,
    evaluate: impl Fn(usize, Vec<&mut [f64]>) -> Result<(), AngleColumnsError> + Sync,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let widths = wanted.widths();
    // numpy asks the system for large pages, which a `Vec` does not: half the time of an evaluation would go into small ones. One array
    // for all, because the C library gives several back to the system at once, and takes new pages for the next.
    let numbers = points * widths.iter().sum::<usize>();
    let array = py.import("numpy")?.getattr("empty")?.call1((numbers,))?.cast_into::<PyArray1<f64>>()?;
    let mut borrowed = array.readwrite();
    let mut rest = borrowed.as_slice_mut()?;
    let mut parts = Vec::new();
    for width in &widths {
        let column = rest.split_off_mut(..width * points).unwrap_or_default();
        parts.push(column.chunks_mut(width * BLOCK));
    }
    let blocks: Vec<Vec<&mut [f64]>> = (0..points.div_ceil(BLOCK)).map(|_| parts.iter_mut().filter_map(Iterator::next).collect()).collect();
    let outcome = py.detach(|| in_order(blocks.into_par_iter().enumerate().map(|(number, out)| evaluate(number, out)).collect()));
    drop(borrowed);
    outcome.map_err(|(before, error)| exception(error, before, shape))?;
    Ok(array)
}

/// BRDF, DoLP and its specular part, which is empty where no term is wanted; and the other columns.
fn radiance_columns<'a>(mut columns: Vec<&'a mut [f64]>, wanted: &Wanted) -> ([&'a mut [f64]; 3], Vec<&'a mut [f64]>) {
    let radiances = if wanted.terms { 3 } else { 2 };
    let rest = columns.split_off(radiances.min(columns.len()));
    let mut columns = columns.into_iter();
    (std::array::from_fn(|_| columns.next().unwrap_or_default()), rest)
}

/// What the Python above asks for: a model, values of its parameters by their names, and what is wanted beside BRDF and DoLP.
#[derive(FromPyObject)]
pub struct Question {
    model: String,
    parameters: Vec<(String, f64)>,
    terms: bool,
    mueller: bool,
    gradients: Vec<String>,
}

impl Question {
    fn surface_and_wanted(&self) -> PyResult<(Pbrdf, Wanted)> {
        Ok((surface(&self.model, &self.parameters)?, Wanted::new(self.terms, self.mueller, &self.gradients)?))
    }
}

/// Columns of values at angles in degrees, of points in an array of that shape: BRDF, DoLP; on request specular, diffuse and volume part,
/// the Mueller matrix (16 numbers a point), derivatives of the BRDF, then of DoLP. All in one array, one behind the other.
#[pyfunction]
pub fn evaluate<'py>(
    py: Python<'py>,
    question: Question,
    theta_i: PyReadonlyArray1<'py, f64>,
    theta_r: PyReadonlyArray1<'py, f64>,
    dphi: PyReadonlyArray1<'py, f64>,
    shape: Vec<usize>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (surface, wanted) = question.surface_and_wanted()?;
    let (theta_i, theta_r, dphi) = (theta_i.as_slice()?, theta_r.as_slice()?, dphi.as_slice()?);
    let angles = AngleColumns::new(theta_i, theta_r, dphi).map_err(refused)?;
    columns_of(py, &shape, angles.len(), &wanted, |number, out| {
        let part = angles.part(points_of_block(number, angles.len()));
        let (radiances, rest) = radiance_columns(out, &wanted);
        part.radiances(&surface, radiances)?;
        fill_rest(part, &surface, &wanted, rest)
    })
}

/// Geometries that are prepared once.
#[pyclass(frozen, module = "pbrdf._pbrdf")]
pub struct Prepared {
    points: usize,
    blocks: Vec<PreparedAngles>,
}

#[pymethods]
impl Prepared {
    #[new]
    fn new(
        py: Python<'_>,
        theta_i: PyReadonlyArray1<'_, f64>,
        theta_r: PyReadonlyArray1<'_, f64>,
        dphi: PyReadonlyArray1<'_, f64>,
        shape: Vec<usize>,
    ) -> PyResult<Self> {
        let (theta_i, theta_r, dphi) = (theta_i.as_slice()?, theta_r.as_slice()?, dphi.as_slice()?);
        let angles = AngleColumns::new(theta_i, theta_r, dphi).map_err(refused)?;
        let prepare = |number: usize| angles.part(points_of_block(number, angles.len())).prepare();
        let outcome = py.detach(|| in_order((0..angles.len().div_ceil(BLOCK)).into_par_iter().map(prepare).collect()));
        Ok(Self { points: angles.len(), blocks: outcome.map_err(|(before, error)| exception(error, before, &shape))? })
    }

    /// As `evaluate` has it.
    fn evaluate<'py>(&self, py: Python<'py>, question: Question) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (surface, wanted) = question.surface_and_wanted()?;
        columns_of(py, &[], self.points, &wanted, |number, out| {
            let prepared = &self.blocks[number];
            let (radiances, rest) = radiance_columns(out, &wanted);
            prepared.radiances(&surface, radiances)?;
            fill_rest(prepared.angles(), &surface, &wanted, rest)
        })
    }
}
