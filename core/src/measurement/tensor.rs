//! Mueller matrices over half and difference angles, and slices through them.
//!
//! M is a BRDF in sr⁻¹; its Stokes bases lie perpendicular and parallel to the plane of incidence
//! of the facet whose normal is the half vector. There M is the Fresnel matrix of the facet plus
//! the depolariser, without any rotation.

use crate::measurement::{Measurement, Quantity, Row, WavelengthError, choose_wavelength, rusinkiewicz};
use crate::optics::Geometry;

/// The axes of a tensor.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TensorAxes {
    /// φ_d in radians, ascending.
    pub(crate) phi_d: Vec<f64>,
    /// θ_d in radians, ascending.
    pub(crate) theta_d: Vec<f64>,
    /// θ_h in radians, ascending.
    pub(crate) theta_h: Vec<f64>,
    /// Bands, ascending.
    pub(crate) wavelengths_nm: Vec<f64>,
    /// Names of the grids whose angles the file does not give.
    pub(crate) assumed_grids: Vec<&'static str>,
}

/// A tensor of Mueller matrices.
#[derive(Debug, Clone, PartialEq)]
pub struct Tensor {
    axes: TensorAxes,
    /// The file itself, whose 4-byte numbers from `start` on are M.
    bytes: Vec<u8>,
    start: usize,
}

/// Slices through a tensor as a measurement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TensorSlice {
    /// BRDF and DoLP.
    pub measurement: Measurement,
    /// The band, in nm.
    pub wavelength_nm: f64,
    /// How many geometries have no value (NaN beside them, or no light).
    pub without_value: usize,
    /// How many geometries have a BRDF but a DoLP above 1, which is left out.
    pub beyond_one: usize,
}

/// The f32 of four bytes; NaN of fewer.
pub(crate) fn f32_of(chunk: &[u8]) -> f32 {
    chunk.first_chunk().map_or(f32::NAN, |bytes| f32::from_le_bytes(*bytes))
}

/// Where a value lies on a grid: the index below it and the weight of the index above it. Beyond an
/// end of the grid, that end.
fn place(grid: &[f64], value: f64) -> (usize, f64) {
    let above = grid.partition_point(|&node| node <= value);
    if above == 0 {
        return (0, 0.0);
    }
    match grid.get(above) {
        None => (grid.len() - 1, 0.0),
        Some(high) => (above - 1, (value - grid[above - 1]) / (high - grid[above - 1])),
    }
}

impl Tensor {
    /// A tensor in the bytes of a file, whose matrices begin at `start`.
    pub(crate) fn new(axes: TensorAxes, bytes: Vec<u8>, start: usize) -> Self {
        Self { axes, bytes, start }
    }

    /// The bands in nm, ascending.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.axes.wavelengths_nm
    }

    /// Names of the grids whose number of angles the file gives, but no angles. They are taken to
    /// be even, φ_d from −180° to 180°, the others from 0° to 90°.
    #[must_use]
    pub fn assumed_grids(&self) -> &[&'static str] {
        &self.axes.assumed_grids
    }

    /// Numbers of φ_d, θ_d, θ_h.
    #[must_use]
    pub fn shape(&self) -> [usize; 3] {
        [self.axes.phi_d.len(), self.axes.theta_d.len(), self.axes.theta_h.len()]
    }

    /// M at grid indices, for the element by its number 4 row + column.
    fn entry(&self, at: [usize; 4], element: usize) -> f64 {
        let [phi_d, theta_d, theta_h, band] = at;
        let index =
            ((phi_d * self.axes.theta_d.len() + theta_d) * self.axes.theta_h.len() + theta_h) * self.axes.wavelengths_nm.len() + band;
        let start = self.start + 4 * (16 * index + element);
        self.bytes.get(start..start + 4).map_or(f64::NAN, |chunk| f64::from(f32_of(chunk)))
    }

    /// The first column of M in a band, linear in all three angles; NaN where a neighbour has no
    /// value.
    ///
    /// Nodes with a ray below the horizon have M00 = NaN, or 0 in some files.
    #[must_use]
    pub fn first_column(&self, geometry: Geometry, band: usize) -> [f64; 4] {
        let [phi_d, theta_d, theta_h] = rusinkiewicz(geometry);
        let places = [place(&self.axes.phi_d, phi_d), place(&self.axes.theta_d, theta_d), place(&self.axes.theta_h, theta_h)];
        let mut sums = [0.0; 4];
        for corner in 0..8_usize {
            let (mut at, mut weight) = ([0, 0, 0, band], 1.0);
            for (axis, &(low, share)) in places.iter().enumerate() {
                let is_high = corner >> axis & 1 == 1;
                at[axis] = low + usize::from(is_high);
                weight *= if is_high { share } else { 1.0 - share };
            }
            if weight > 0.0 {
                if self.entry(at, 0) == 0.0 {
                    return [f64::NAN; 4];
                }
                for (row, sum) in sums.iter_mut().enumerate() {
                    *sum += weight * self.entry(at, 4 * row);
                }
            }
        }
        sums
    }

    /// BRDF and DoLP for unpolarised light at those geometries, in the band nearest to the
    /// wavelength asked for. Without a wavelength there has to be one band only.
    ///
    /// # Errors
    /// No band is near the wavelength, or there are several and none was chosen.
    pub fn slice(&self, geometries: &[Geometry], wanted_nm: Option<f64>) -> Result<TensorSlice, WavelengthError> {
        let wavelength_nm = choose_wavelength(&self.axes.wavelengths_nm, wanted_nm)?;
        let band = self.axes.wavelengths_nm.iter().position(|&band| band == wavelength_nm).unwrap_or(0);
        let mut slice = TensorSlice { wavelength_nm, ..TensorSlice::default() };
        for &geometry in geometries {
            let [m00, m10, m20, _] = self.first_column(geometry, band);
            let dolp = libm::hypot(m10, m20) / m00;
            if !(m00 > 0.0 && m00.is_finite() && dolp.is_finite()) {
                slice.without_value += 1;
                continue;
            }
            let is_physical = dolp <= 1.0;
            slice.beyond_one += usize::from(!is_physical);
            slice.measurement.rows.push(Row {
                geometry,
                dolp: is_physical.then_some(Quantity { value: dolp, sigma: None }),
                brdf: Some(Quantity { value: m00, sigma: None }),
                masked: false,
            });
        }
        slice.measurement.metadata = vec![
            ("wavelength_nm".to_owned(), wavelength_nm.to_string()),
            ("quantity".to_owned(), "BRDF and DoLP for unpolarised light, from a tensor of Mueller matrices".to_owned()),
        ];
        Ok(slice)
    }
}
