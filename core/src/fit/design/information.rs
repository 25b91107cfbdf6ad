//! What readings tell of the free parameters of one surface: rows of the Jacobian, in coordinates in which all candidates together have
//! the unit matrix as information.
//!
//! A row is the derivative of a reading over its standard deviation, times that of the unit (`NoiseModel::unit`). All rows stacked,
//! columns scaled to length 1, are `U S Vᵀ`; directions with a singular value below [`RANK_THRESHOLD`] of the largest are left out.

use crate::fit::design::candidates::CandidateGrid;
use crate::fit::design::prediction::NoiseModel;
use crate::fit::estimate::SMALLEST_SIZE;
use crate::fit::intervals::linear::RANK_THRESHOLD;
use crate::measurement::Row;
use crate::model::{Batch, DolpGradients, GradientRequest, Parameter, Parameters, Pbrdf};
use crate::optics::{Facet, GeometryError};
use nalgebra::{DMatrix, DVector};

/// Numbers of a row, at most.
pub(crate) const MOST: usize = Parameter::COUNT;
/// Candidates whose rows are formed at once.
const CHUNK: usize = 512;
/// Share in a direction that is left out from which a parameter is not determined.
const UNDETERMINED_SHARE: f64 = 1e-3;

/// A surface and its free parameters, as a design sees them.
pub(crate) struct Reading<'a> {
    pub surface: &'a Pbrdf,
    pub free: &'a [Parameter],
    pub noise: NoiseModel,
}

impl Reading<'_> {
    /// Rows of a candidate: one for each measured quantity.
    pub(crate) fn rows_each(&self) -> usize {
        self.noise.quantities()
    }

    /// Rows of candidates, one after the other; those of a BRDF of 0 are 0.
    fn rows(&self, grid: &CandidateGrid, candidates: &[usize]) -> Result<Vec<f64>, GeometryError> {
        let facets: Result<Vec<Facet>, GeometryError> =
            candidates.iter().map(|&candidate| grid.geometry(candidate).map(Facet::new)).collect();
        let facets = facets?;
        let width = self.free.len();
        let mut rows = Vec::with_capacity(facets.len() * width * self.rows_each());
        if self.noise.brdf.is_none() {
            let mut gradients = DolpGradients::default();
            Batch::from_facets(facets).single_threaded().dolp_gradients(self.surface, &mut gradients);
            for i in 0..gradients.dolp.len() {
                rows.extend(self.free.iter().map(|&parameter| gradients.by[parameter][i]));
            }
            return Ok(rows);
        }
        for facet in &facets {
            let (reflection, gradient) = self.surface.reflection_and_gradient(facet, GradientRequest::ALL);
            if self.noise.dolp.is_some() {
                rows.extend(self.free.iter().map(|&parameter| gradient.dolp[parameter]));
            }
            let weight = self.noise.brdf_weight(reflection.brdf);
            rows.extend(self.free.iter().map(|&parameter| gradient.brdf[parameter] * weight));
        }
        Ok(rows)
    }

    /// Rows of values that are measured already, by their own standard deviations where they state them.
    fn given_rows(&self, given: &[Row]) -> Vec<f64> {
        let mut rows = Vec::new();
        let unit = self.noise.unit();
        for row in given.iter().filter(|row| !row.masked) {
            let (reflection, gradient) = self.surface.reflection_and_gradient(&Facet::new(row.geometry), GradientRequest::ALL);
            if let Some(sigma) = row.dolp.and_then(|dolp| dolp.sigma.or(self.noise.dolp)) {
                rows.extend(self.free.iter().map(|&parameter| gradient.dolp[parameter] * unit / sigma));
            }
            let relative = self.noise.brdf.map(|relative| relative * reflection.brdf);
            if let Some(sigma) = row.brdf.and_then(|brdf| brdf.sigma.or(relative)).filter(|&sigma| sigma > 0.0) {
                rows.extend(self.free.iter().map(|&parameter| gradient.brdf[parameter] * unit / sigma));
            }
        }
        rows
    }
}

/// All candidates' information on one surface, and the coordinates in which it is the unit matrix.
#[derive(Debug, Clone)]
pub(crate) struct Information {
    /// From a row to those coordinates, columns by direction.
    to_unit: DMatrix<f64>,
    /// ln det of all candidates' information on the parameters, each times its size.
    pub log_det: f64,
    /// Information of what is given, in those coordinates.
    pub given: DMatrix<f64>,
    /// Parameters that all candidates together leave open.
    pub undetermined: Vec<Parameter>,
    /// Of each free parameter: what its variance is formed from, in units of its size.
    contrasts: DMatrix<f64>,
}

/// The size that a parameter's error is relative to.
pub(crate) fn size(parameters: &Parameters, parameter: Parameter) -> f64 {
    parameters[parameter].abs().max(SMALLEST_SIZE)
}

impl Information {
    /// Of all candidates of a grid and what is given; hears of the share that is done, and stops where told to.
    pub(crate) fn new(
        reading: &Reading<'_>,
        grid: &CandidateGrid,
        given: &[Row],
        goes_on: &dyn Fn(f64) -> bool,
    ) -> Result<Option<Self>, GeometryError> {
        let width = reading.free.len();
        let given_rows = reading.given_rows(given);
        let mut triangle = reduced(&DMatrix::zeros(0, width), &given_rows, width);
        let candidates: Vec<usize> = (0..grid.len()).collect();
        for (i, chunk) in candidates.chunks(CHUNK).enumerate() {
            triangle = reduced(&triangle, &reading.rows(grid, chunk)?, width);
            #[expect(clippy::cast_precision_loss, reason = "a number of candidates")]
            let share = (i * CHUNK) as f64 / grid.len() as f64;
            if !goes_on(share) {
                return Ok(None);
            }
        }
        Ok(Some(Self::of_triangle(reading, &triangle, &given_rows)))
    }

    fn of_triangle(reading: &Reading<'_>, triangle: &DMatrix<f64>, given_rows: &[f64]) -> Self {
        let width = reading.free.len();
        let lengths: Vec<f64> = (0..width).map(|j| triangle.column(j).norm()).collect();
        let scaled = DMatrix::from_fn(width, width, |i, j| {
            let element = if i < triangle.nrows() { triangle[(i, j)] / lengths[j] } else { 0.0 };
            if element.is_finite() { element } else { 0.0 }
        });
        let svd = scaled.svd(false, true);
        let v_t = svd.v_t.unwrap_or_else(|| DMatrix::identity(width, width));
        let largest = svd.singular_values.max();
        let kept: Vec<usize> = (0..width).filter(|&i| largest > 0.0 && svd.singular_values[i] > RANK_THRESHOLD * largest).collect();
        let share = |j: usize| (0..width).filter(|i| !kept.contains(i)).map(|i| v_t[(i, j)] * v_t[(i, j)]).sum::<f64>().sqrt();
        let undetermined = (0..width).filter(|&j| lengths[j] == 0.0 || share(j) > UNDETERMINED_SHARE).map(|j| reading.free[j]).collect();
        let to_unit = DMatrix::from_fn(width, kept.len(), |j, i| {
            if lengths[j] > 0.0 { v_t[(kept[i], j)] / (svd.singular_values[kept[i]] * lengths[j]) } else { 0.0 }
        });
        let sizes: Vec<f64> = reading.free.iter().map(|&parameter| size(reading.surface.parameters(), parameter)).collect();
        let contrasts = DMatrix::from_fn(width, kept.len(), |j, i| to_unit[(j, i)] / sizes[j]);
        let logs = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(libm::log).sum::<f64>();
        let log_det = 2.0
            * (logs(&mut kept.iter().map(|&i| svd.singular_values[i]))
                + logs(&mut lengths.iter().copied())
                + logs(&mut sizes.iter().copied()));
        let given_unit = DMatrix::from_row_slice(given_rows.len() / width.max(1), width, given_rows) * &to_unit;
        Self { given: given_unit.transpose() * &given_unit, to_unit, log_det, undetermined, contrasts }
    }

    /// Number of directions that all candidates together determine.
    pub(crate) fn rank(&self) -> usize {
        self.to_unit.ncols()
    }

    /// Rows of candidates in the coordinates of the unit matrix, one after the other.
    pub(crate) fn rows(&self, reading: &Reading<'_>, grid: &CandidateGrid, candidates: &[usize]) -> Result<Vec<f64>, GeometryError> {
        let mut out = Vec::with_capacity(candidates.len() * reading.rows_each() * self.rank());
        for chunk in candidates.chunks(CHUNK) {
            let rows = reading.rows(grid, chunk)?;
            for row in rows.chunks(reading.free.len()) {
                out.extend(self.to_unit.column_iter().map(|column| column.iter().zip(row).map(|(a, b)| a * b).sum::<f64>()));
            }
        }
        Ok(out)
    }

    /// What the relative variance of a parameter is formed from, in those coordinates: `vᵀ M⁻¹ v`.
    pub(crate) fn contrast(&self, reading: &Reading<'_>, parameter: Parameter) -> Option<DVector<f64>> {
        let j = reading.free.iter().position(|&other| other == parameter)?;
        Some(self.contrasts.row(j).transpose())
    }
}

/// The triangle of a QR decomposition of a triangle and rows below it.
fn reduced(triangle: &DMatrix<f64>, rows: &[f64], width: usize) -> DMatrix<f64> {
    let count = rows.len() / width.max(1);
    let below = triangle.nrows();
    let stacked = DMatrix::from_fn(below + count, width, |i, j| {
        let element = if i < below { triangle[(i, j)] } else { rows[(i - below) * width + j] };
        if element.is_finite() { element } else { 0.0 }
    });
    stacked.qr().unpack_r()
}
