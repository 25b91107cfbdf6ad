//! Values of a surface at arrays of angles.

use crate::error::refused;
use crate::names::{parameter, surface};
use numpy::{PyArray1, PyReadonlyArray1};
use pbrdf::model::{Batch, GradientRequest, ParameterSet, Radiances, Reflection};
use pbrdf::optics::Facet;
use pbrdf::{Geometry, Pbrdf};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Points that are prepared and evaluated at once: few enough that what is prepared stays in a processor's cache of the third level, a
/// multiple of the lanes of any kernel.
const BLOCK: usize = 16_384;
/// Elements of a Mueller matrix.
const MUELLER: usize = 16;

/// What is wanted beside BRDF, DoLP and the specular part of the BRDF.
struct Wanted {
    /// Diffuse and volume part of the BRDF.
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

    /// Numbers of a point in each column: BRDF, DoLP, specular part; diffuse and volume part; Mueller matrix; derivatives of the BRDF, then of
    /// DoLP, in the order of [`Parameter::ALL`].
    fn widths(&self) -> Vec<usize> {
        let mut widths = vec![1; if self.terms { 5 } else { 3 }];
        widths.extend(self.mueller.then_some(MUELLER));
        widths.extend(std::iter::repeat_n(1, 2 * self.by.len()));
        widths
    }
}

/// Fills the columns of [`Wanted::widths`] with the values at prepared points.
fn fill(batch: &Batch, surface: &Pbrdf, wanted: &Wanted, columns: Vec<&mut [f64]>) {
    let mut radiances = Radiances::default();
    batch.radiances(surface, &mut radiances);
    let mut columns = columns.into_iter();
    for values in [&radiances.brdf, &radiances.dolp, &radiances.specular] {
        if let Some(column) = columns.next() {
            column.copy_from_slice(values);
        }
    }
    if wanted.terms {
        for of in [|of: Reflection| of.diffuse, |of: Reflection| of.volume] {
            let column = columns.next().into_iter().flatten();
            column.zip(batch.facets()).for_each(|(out, facet)| *out = of(surface.reflection(facet)));
        }
    }
    if wanted.mueller {
        let matrices = columns.next().map(|column| column.chunks_exact_mut(MUELLER)).into_iter().flatten();
        for (matrix, facet) in matrices.zip(batch.facets()) {
            let mueller = surface.mueller(facet.geometry);
            matrix.iter_mut().enumerate().for_each(|(element, out)| *out = mueller.element(element / 4, element % 4));
        }
    }
    if !wanted.by.is_empty() {
        let by = wanted.by;
        let request = GradientRequest { by, brdf: true, dolp: true };
        let mut columns: Vec<&mut [f64]> = columns.collect();
        for (point, facet) in batch.facets().iter().enumerate() {
            let (_, gradient) = surface.reflection_and_gradient(facet, request);
            let values = by.iter().map(|parameter| gradient.brdf[parameter]).chain(by.iter().map(|parameter| gradient.dolp[parameter]));
            columns.iter_mut().zip(values).for_each(|(column, value)| column[point] = value);
        }
    }
}

/// Why three angles are no geometry, and the number of the point.
struct NoPoint(usize, String);

impl NoPoint {
    /// As an exception that says where the point stands in an array of that shape.
    fn at(self, shape: &[usize]) -> PyErr {
        refused(format_args!("{}{}", self.1, place(self.0, shape)))
    }
}

/// Degrees; a negative θr is the backscatter side, where Δφ says no other.
pub fn geometry(theta_i: f64, theta_r: f64, dphi: f64) -> Result<Geometry, String> {
    if theta_r >= 0.0 || theta_r.is_nan() {
        return Geometry::new(theta_i, theta_r, dphi).map_err(|error| error.to_string());
    }
    if dphi == 180.0 {
        return Geometry::in_plane(theta_i, theta_r).map_err(|error| error.to_string());
    }
    Err(format!("theta_r = {theta_r} with dphi = {dphi}: a negative theta_r is the backscatter side, allowed only where dphi is 180"))
}

/// Angles of points side by side, in degrees.
struct Angles<'a> {
    theta_i: &'a [f64],
    theta_r: &'a [f64],
    dphi: &'a [f64],
}

impl<'a> Angles<'a> {
    /// Of arrays that stand in memory without gaps, all of one length.
    fn new(arrays: [&'a PyReadonlyArray1<'_, f64>; 3]) -> PyResult<Self> {
        let [theta_i, theta_r, dphi] = arrays.map(|array| array.as_slice());
        let angles = Self { theta_i: theta_i?, theta_r: theta_r?, dphi: dphi? };
        if angles.theta_r.len() != angles.len() || angles.dphi.len() != angles.len() {
            return Err(refused("the arrays of angles differ in length"));
        }
        Ok(angles)
    }

    fn len(&self) -> usize {
        self.theta_i.len()
    }

    /// The points of a block, prepared.
    fn block(&self, number: usize) -> Result<Batch, NoPoint> {
        let first = number * BLOCK;
        let points = first..self.len().min(first + BLOCK);
        let at = |point: usize| {
            let facet = geometry(self.theta_i[point], self.theta_r[point], self.dphi[point]).map(Facet::new);
            facet.map_err(|reason| NoPoint(point, reason))
        };
        Ok(Batch::from_facets(points.map(at).collect::<Result<_, _>>()?).single_threaded())
    }

    /// All blocks, or why there is a point that is none.
    fn blocks(&self) -> Result<Vec<Batch>, NoPoint> {
        let blocks: Vec<_> = (0..self.len().div_ceil(BLOCK)).into_par_iter().map(|number| self.block(number)).collect();
        blocks.into_iter().collect()
    }
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

/// Columns of values at that many points, block by block side by side; `evaluate` fills the columns of a block of that number.
fn columns_of(
    points: usize,
    wanted: &Wanted,
    evaluate: impl Fn(usize, Vec<&mut [f64]>) -> Result<(), NoPoint> + Sync,
) -> Result<Vec<Vec<f64>>, NoPoint> {
    let widths = wanted.widths();
    let mut columns: Vec<Vec<f64>> = widths.iter().map(|width| vec![0.0; width * points]).collect();
    let mut parts: Vec<_> = columns.iter_mut().zip(&widths).map(|(column, width)| column.chunks_mut(width * BLOCK)).collect();
    let blocks: Vec<Vec<&mut [f64]>> = (0..points.div_ceil(BLOCK)).map(|_| parts.iter_mut().filter_map(Iterator::next).collect()).collect();
    let outcomes: Vec<_> = blocks.into_par_iter().enumerate().map(|(number, out)| evaluate(number, out)).collect();
    outcomes.into_iter().collect::<Result<(), _>>()?;
    Ok(columns)
}

/// Columns as arrays, without a copy.
fn arrays<'py>(py: Python<'py>, columns: Vec<Vec<f64>>) -> Vec<Bound<'py, PyArray1<f64>>> {
    columns.into_iter().map(|column| PyArray1::from_vec(py, column)).collect()
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

/// Columns of values at angles in degrees, of points in an array of that shape: BRDF, DoLP, specular part; on request diffuse and volume
/// part, the Mueller matrix (16 numbers a point), derivatives of the BRDF, then of DoLP.
#[pyfunction]
pub fn evaluate<'py>(
    py: Python<'py>,
    question: Question,
    theta_i: PyReadonlyArray1<'py, f64>,
    theta_r: PyReadonlyArray1<'py, f64>,
    dphi: PyReadonlyArray1<'py, f64>,
    shape: Vec<usize>,
) -> PyResult<Vec<Bound<'py, PyArray1<f64>>>> {
    let (surface, wanted) = question.surface_and_wanted()?;
    let angles = Angles::new([&theta_i, &theta_r, &dphi])?;
    let columns = py.detach(|| {
        columns_of(angles.len(), &wanted, |number, out| {
            fill(&angles.block(number)?, &surface, &wanted, out);
            Ok(())
        })
    });
    Ok(arrays(py, columns.map_err(|error| error.at(&shape))?))
}

/// Geometries that are prepared once.
#[pyclass(frozen, module = "pbrdf._pbrdf")]
pub struct Prepared {
    points: usize,
    blocks: Vec<Batch>,
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
        let angles = Angles::new([&theta_i, &theta_r, &dphi])?;
        let blocks = py.detach(|| angles.blocks()).map_err(|error| error.at(&shape))?;
        Ok(Self { points: angles.len(), blocks })
    }

    /// As `evaluate` has it.
    fn evaluate<'py>(&self, py: Python<'py>, question: Question) -> PyResult<Vec<Bound<'py, PyArray1<f64>>>> {
        let (surface, wanted) = question.surface_and_wanted()?;
        let columns = py.detach(|| {
            columns_of(self.points, &wanted, |number, out| {
                fill(&self.blocks[number], &surface, &wanted, out);
                Ok(())
            })
        });
        Ok(arrays(py, columns.map_err(|error| error.at(&[]))?))
    }
}
