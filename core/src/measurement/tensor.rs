//! Mueller matrices over half and difference angles: the `.pbsdf` tensor files of the KAIST data base (Baek et al., ACM Trans. Graph.
//! 39(4), 139 (2020)) that Mitsuba 3 renders with its plugin `measured_polarized`.
//!
//! `tensor_file` 1.0, little endian: the 12 bytes `tensor_file\0`, two of version, `u32` fields, each with `u16` length and name, `u16`
//! dimensions, `u8` type (3 is u16, 10 is f32), `u64` offset, `u64` lengths. Fields: `phi_d`, `theta_d`, `theta_h` (1 × N, radians,
//! ascending), `wvls` (nm), `M` (φ_d × θ_d × θ_h × wavelength × 4 × 4, sr⁻¹).
//!
//! Conventions, as the plugin has them (Rusinkiewicz angles of the ray towards the light i and towards the eye r): h ∝ i + r,
//! `θ_h` its zenith angle, `θ_d` the angle between h and i, and `φ_d` the azimuth of i about h from t = b × h, b ∝ n × h:
//! `i = h cos θ_d + (t cos φ_d + b sin φ_d) sin θ_d`. Stokes bases lie perpendicular and parallel to the plane of i and r, which is the
//! facet's plane of incidence: there M is the Fresnel matrix of the facet plus the depolariser, without any rotation. M is a BRDF: the
//! plugin multiplies it by the cosine of the light's zenith angle.

use crate::measurement::wavelength::{WavelengthError, choose_wavelength};
use crate::measurement::{Measurement, Quantity, Row};
use crate::optics::{Degrees, Geometry};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::Read;

/// What every such file begins with.
pub(crate) const MAGIC: &[u8; 12] = b"tensor_file\0";
pub(crate) const U16: u8 = 3;
pub(crate) const F32: u8 = 10;
/// What a name or a number of dimensions may not exceed: far above what any file has.
const LONGEST_NAME: usize = 64;
const MOST_DIMENSIONS: usize = 8;
const MOST_FIELDS: u32 = 64;

/// Why a tensor file cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}{kind}", Place(*byte, field.as_deref()))]
pub struct TensorError {
    /// Where, counted in bytes from 0, if there is such a place.
    pub byte: Option<u64>,
    /// The field, where it is known.
    pub field: Option<String>,
    /// What is wrong.
    pub kind: TensorErrorKind,
}

struct Place<'a>(Option<u64>, Option<&'a str>);

impl std::fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.0, self.1) {
            (Some(byte), Some(field)) => write!(f, "byte {byte}, field {field}: "),
            (Some(byte), None) => write!(f, "byte {byte}: "),
            (None, Some(field)) => write!(f, "field {field}: "),
            (None, None) => Ok(()),
        }
    }
}

/// What is wrong with a tensor file.
#[derive(Debug, thiserror::Error)]
pub enum TensorErrorKind {
    /// Other first bytes.
    #[error("this is no tensor file; expected it to begin with tensor_file")]
    NoTensor,
    /// Another version.
    #[error("the version is {0}.{1}; expected 1.0")]
    Version(u8, u8),
    /// The file ends before what its header announces.
    #[error("the file ends early: {expected} bytes were announced here, {found} are there")]
    Truncated {
        /// How many should be there.
        expected: u64,
        /// How many are.
        found: u64,
    },
    /// Counts and lengths that no such file has.
    #[error("{what} is {found}; expected at most {most}")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        found: u64,
        /// The limit.
        most: u64,
    },
    /// A field that has to be there.
    #[error("the field is missing")]
    Missing,
    /// A field of another type.
    #[error("the type is {found}; expected {expected}")]
    Type {
        /// Number of the type.
        found: u8,
        /// Number and name of what was expected.
        expected: &'static str,
    },
    /// A field of another shape.
    #[error("the shape is {found}; expected {expected}")]
    Shape {
        /// Lengths, with × between.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// Angles or wavelengths out of order, out of range or not finite.
    #[error("entry {index} is {found}; expected ascending {expected}")]
    Grid {
        /// Number from 0.
        index: usize,
        /// Its value.
        found: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// The source failed.
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

impl TensorErrorKind {
    fn at(self, byte: Option<usize>, field: Option<&str>) -> TensorError {
        TensorError { byte: byte.map(|byte| byte as u64), field: field.map(str::to_owned), kind: self }
    }
}

/// What π may gain in f32.
const F32_ROUNDING: f64 = 1e-6;

/// A tensor file in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Tensor {
    phi_d: Vec<f64>,
    theta_d: Vec<f64>,
    theta_h: Vec<f64>,
    wavelengths_nm: Vec<f64>,
    /// The file itself, whose 4-byte numbers from `start` on are M.
    bytes: Vec<u8>,
    start: usize,
    assumed_grids: Vec<&'static str>,
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
    /// How many have a BRDF but a DoLP above 1, which is left out.
    pub beyond_one: usize,
}

/// Whether bytes begin like such a file.
#[must_use]
pub fn is_tensor(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// A field of the header.
struct Field {
    name: String,
    kind: u8,
    offset: u64,
    shape: Vec<u64>,
    /// Where its entry in the header begins.
    entry: usize,
}

/// Walks the header.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], TensorError> {
        let rest = self.bytes.get(self.at..).unwrap_or(&[]);
        let Some((taken, _)) = rest.split_first_chunk::<N>() else {
            let kind = TensorErrorKind::Truncated { expected: N as u64, found: rest.len() as u64 };
            return Err(kind.at(Some(self.at), None));
        };
        self.at += N;
        Ok(*taken)
    }

    fn count(&mut self, what: &'static str, most: usize) -> Result<usize, TensorError> {
        let at = self.at;
        let found = usize::from(u16::from_le_bytes(self.take()?));
        if found > most {
            let kind = TensorErrorKind::TooMany { what, found: found as u64, most: most as u64 };
            return Err(kind.at(Some(at), None));
        }
        Ok(found)
    }

    fn field(&mut self) -> Result<Field, TensorError> {
        let entry = self.at;
        let length = self.count("the length of a name", LONGEST_NAME)?;
        let mut name = Vec::new();
        for _ in 0..length {
            name.extend(self.take::<1>()?);
        }
        let dimensions = self.count("the number of dimensions", MOST_DIMENSIONS)?;
        let [kind] = self.take()?;
        let offset = u64::from_le_bytes(self.take()?);
        let mut shape = Vec::new();
        for _ in 0..dimensions {
            shape.push(u64::from_le_bytes(self.take()?));
        }
        Ok(Field { name: String::from_utf8_lossy(&name).into_owned(), kind, offset, shape, entry })
    }
}

impl Field {
    fn error(&self, kind: TensorErrorKind) -> TensorError {
        kind.at(Some(self.entry), Some(&self.name))
    }

    fn shape_error(&self, expected: impl Into<String>) -> TensorError {
        let found: Vec<String> = self.shape.iter().map(u64::to_string).collect();
        self.error(TensorErrorKind::Shape { found: found.join(" × "), expected: expected.into() })
    }

    /// Where its data lie: nothing is believed of lengths and offset that the file does not hold.
    fn range(&self, size: u64, all: &[u8]) -> Result<std::ops::Range<usize>, TensorError> {
        let length = self.shape.iter().try_fold(size, |product, &length| product.checked_mul(length)).unwrap_or(u64::MAX);
        let found = (all.len() as u64).saturating_sub(self.offset);
        if length > found {
            return Err(self.error(TensorErrorKind::Truncated { expected: length, found }));
        }
        // Both lie within the file, which is in memory.
        let start = usize::try_from(self.offset).unwrap_or(all.len()).min(all.len());
        let end = start + usize::try_from(length).unwrap_or(0);
        Ok(start..end)
    }
}

/// Reads a tensor file.
pub fn read_tensor(mut source: impl Read) -> Result<Tensor, TensorError> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes).map_err(|error| TensorErrorKind::Io(error).at(None, None))?;
    tensor_from_bytes(bytes)
}

/// The tensor of a file that is in memory, without a second copy of it: such files reach a gigabyte.
pub fn tensor_from_bytes(bytes: Vec<u8>) -> Result<Tensor, TensorError> {
    if !is_tensor(&bytes) {
        return Err(TensorErrorKind::NoTensor.at(Some(0), None));
    }
    let mut cursor = Cursor { bytes: &bytes, at: MAGIC.len() };
    let [major, minor] = cursor.take()?;
    if (major, minor) != (1, 0) {
        return Err(TensorErrorKind::Version(major, minor).at(Some(MAGIC.len()), None));
    }
    let count = u32::from_le_bytes(cursor.take()?);
    if count > MOST_FIELDS {
        let kind = TensorErrorKind::TooMany { what: "the number of fields", found: count.into(), most: MOST_FIELDS.into() };
        return Err(kind.at(Some(MAGIC.len() + 2), None));
    }
    let fields = (0..count).map(|_| cursor.field()).collect::<Result<Vec<_>, _>>()?;
    let field = |name: &str| fields.iter().find(|field| field.name == name).ok_or_else(|| TensorErrorKind::Missing.at(None, Some(name)));
    let mut assumed_grids = Vec::new();
    let mut grid = |name: &'static str, range: (f64, f64)| grid_of(field(name)?, range, &bytes, name, &mut assumed_grids);
    let (phi_d, theta_d, theta_h) = (grid("phi_d", (-PI, PI))?, grid("theta_d", (0.0, FRAC_PI_2))?, grid("theta_h", (0.0, FRAC_PI_2))?);
    let wavelengths_nm = wavelengths_of(field("wvls")?, &bytes)?;
    let m = field("M")?;
    if m.kind != F32 {
        return Err(m.error(TensorErrorKind::Type { found: m.kind, expected: "10 (f32)" }));
    }
    let lengths = [phi_d.len(), theta_d.len(), theta_h.len(), wavelengths_nm.len(), 4, 4];
    if !m.shape.iter().copied().eq(lengths.iter().map(|&length| length as u64)) {
        return Err(m.shape_error(lengths.map(|length| length.to_string()).join(" × ")));
    }
    let start = m.range(4, &bytes)?.start;
    Ok(Tensor { phi_d, theta_d, theta_h, wavelengths_nm, bytes, start, assumed_grids })
}

/// The angles of a grid; spread evenly over their whole range where the file has their number alone.
fn grid_of(
    field: &Field,
    (low, high): (f64, f64),
    all: &[u8],
    name: &'static str,
    assumed: &mut Vec<&'static str>,
) -> Result<Vec<f64>, TensorError> {
    const ANGLES: &str = "angles in radians, within ±π";
    if field.kind != F32 {
        return Err(field.error(TensorErrorKind::Type { found: field.kind, expected: "10 (f32)" }));
    }
    let (&[rows @ (0 | 1), count], true) = (&field.shape[..], field.shape.last().is_some_and(|&count| count > 0)) else {
        return Err(field.shape_error("1 × the number of angles"));
    };
    if rows == 0 {
        // Nothing stands behind the number: it has to be one that M could have.
        let most = all.len() as u64 / 64;
        if count > most {
            return Err(field.error(TensorErrorKind::TooMany { what: "the number of angles", found: count, most }));
        }
        assumed.push(name);
        let last = count.saturating_sub(1).max(1);
        #[expect(clippy::cast_precision_loss, reason = "grids have few angles")]
        return Ok((0..count).map(|i| low + (high - low) * (i as f64 / last as f64)).collect());
    }
    let range = field.range(4, all)?;
    let angles: Vec<f64> = all[range].chunks_exact(4).map(|chunk| f64::from(f32_of(chunk))).collect();
    let mut before = f64::NEG_INFINITY;
    for (index, &found) in angles.iter().enumerate() {
        // f32 rounds π up.
        if !(found.abs() <= PI + F32_ROUNDING && found > before) {
            return Err(field.error(TensorErrorKind::Grid { index, found, expected: ANGLES }));
        }
        before = found;
    }
    Ok(angles)
}

fn wavelengths_of(field: &Field, all: &[u8]) -> Result<Vec<f64>, TensorError> {
    if field.kind != U16 {
        return Err(field.error(TensorErrorKind::Type { found: field.kind, expected: "3 (u16)" }));
    }
    if field.shape.len() != 1 || field.shape[0] == 0 {
        return Err(field.shape_error("the number of wavelengths"));
    }
    let range = field.range(2, all)?;
    let wavelengths: Vec<f64> = all[range].chunks_exact(2).map(|pair| f64::from(u16::from_le_bytes([pair[0], pair[1]]))).collect();
    let mut before = 0.0;
    for (index, &found) in wavelengths.iter().enumerate() {
        if found <= before {
            return Err(field.error(TensorErrorKind::Grid { index, found, expected: "wavelengths in nm" }));
        }
        before = found;
    }
    Ok(wavelengths)
}

/// Of four bytes; of fewer, NaN.
fn f32_of(chunk: &[u8]) -> f32 {
    chunk.first_chunk().map_or(f32::NAN, |bytes| f32::from_le_bytes(*bytes))
}

/// Where a value lies on a grid: the index below it and the share of the one above; beyond the ends, the end.
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
    /// The bands in nm, ascending.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// Names of the grids that the file gives the number of, but no values: they are taken to be even, φ_d from −180° to 180°, the
    /// others from 0° to 90°.
    #[must_use]
    pub fn assumed_grids(&self) -> &[&'static str] {
        &self.assumed_grids
    }

    /// Numbers of φ_d, θ_d, θ_h.
    #[must_use]
    pub fn shape(&self) -> [usize; 3] {
        [self.phi_d.len(), self.theta_d.len(), self.theta_h.len()]
    }

    /// M at grid indices, for the element by its number 4 row + column.
    fn entry(&self, at: [usize; 4], element: usize) -> f64 {
        let [phi_d, theta_d, theta_h, band] = at;
        let index = ((phi_d * self.theta_d.len() + theta_d) * self.theta_h.len() + theta_h) * self.wavelengths_nm.len() + band;
        let start = self.start + 4 * (16 * index + element);
        self.bytes.get(start..start + 4).map_or(f64::NAN, |chunk| f64::from(f32_of(chunk)))
    }

    /// The first column of M in a band, linear in all three angles; NaN where a neighbour has no value.
    ///
    /// Nodes with a ray below the horizon have M00 = NaN, or 0 in some files.
    #[must_use]
    pub fn first_column(&self, geometry: Geometry, band: usize) -> [f64; 4] {
        let [phi_d, theta_d, theta_h] = rusinkiewicz(geometry);
        let places = [place(&self.phi_d, phi_d), place(&self.theta_d, theta_d), place(&self.theta_h, theta_h)];
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

    /// BRDF and DoLP for unpolarised light at those geometries, in the band nearest to the wavelength asked for.
    pub fn slice(&self, geometries: &[Geometry], wanted_nm: Option<f64>) -> Result<TensorSlice, WavelengthError> {
        let wavelength_nm = choose_wavelength(&self.wavelengths_nm, wanted_nm)?;
        let band = self.wavelengths_nm.iter().position(|&band| band == wavelength_nm).unwrap_or(0);
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

/// φ_d, θ_d, θ_h in radians; see the module's head. φ_d is 0 where h is the normal or both rays are one.
#[must_use]
pub fn rusinkiewicz(geometry: Geometry) -> [f64; 3] {
    let (sin_i, cos_i) = geometry.theta_i().sin_cos();
    let (sin_r, cos_r) = geometry.theta_r().sin_cos();
    let (sin_dphi, cos_dphi) = geometry.dphi().sin_cos();
    let (i, r) = ([sin_i, 0.0, cos_i], [sin_r * cos_dphi, sin_r * sin_dphi, cos_r]);
    let h = unit([i[0] + r[0], i[1] + r[1], i[2] + r[2]]);
    let tilt = libm::hypot(h[0], h[1]);
    let (b, t) = if tilt > 0.0 {
        let b = [-h[1] / tilt, h[0] / tilt, 0.0];
        (b, [b[1] * h[2], -b[0] * h[2], b[0] * h[1] - b[1] * h[0]])
    } else {
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (along, across) = (dot(t, i), dot(b, i));
    [libm::atan2(across, along), libm::atan2(libm::hypot(along, across), dot(h, i)), libm::atan2(tilt, h[2])]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = libm::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    v.map(|x| x / length)
}

/// Directions of light and eye from φ_d, θ_d, θ_h; one below the horizon is lifted to `highest` zenith angle, so that
/// values on the far side continue those of the rim.
pub(crate) fn geometry_of([phi_d, theta_d, theta_h]: [f64; 3], highest: f64) -> Option<Geometry> {
    let degrees = |radians: f64| Degrees(radians.to_degrees());
    let ((sin_p, cos_p), (sin_d, cos_d), (sin_h, cos_h)) =
        (degrees(phi_d).sin_cos(), degrees(theta_d).sin_cos(), degrees(theta_h).sin_cos());
    // h = (sin θ_h, 0, cos θ_h), t = (cos θ_h, 0, −sin θ_h), b = (0, 1, 0).
    let ray = |sign: f64| {
        let (along, across) = (sign * sin_d * cos_p, sign * sin_d * sin_p);
        let (x, z) = (sin_h * cos_d + cos_h * along, cos_h * cos_d - sin_h * along);
        let zenith = libm::atan2(libm::hypot(x, across), z).to_degrees();
        (zenith.min(highest), libm::atan2(across, x).to_degrees())
    };
    let ((theta_i, phi_i), (theta_r, phi_r)) = (ray(1.0), ray(-1.0));
    Geometry::new(theta_i, theta_r, phi_r - phi_i).ok()
}
