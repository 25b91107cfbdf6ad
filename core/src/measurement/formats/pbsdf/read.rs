//! Reads a tensor file: nothing is taken from lengths and offsets that the file does not hold.

use super::error::{TensorAxis, TensorCount, TensorError, TensorErrorKind, TensorShape, TensorType};
use crate::measurement::Tensor;
use crate::measurement::tensor::{TensorAxes, f32_of};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::Read;

/// The first bytes of a tensor file.
pub(super) const MAGIC: &[u8; 12] = b"tensor_file\0";
/// Limits of a header, far above those of any known file.
const LONGEST_NAME: usize = 64;
const MOST_DIMENSIONS: usize = 8;
const MOST_FIELDS: u32 = 64;
/// Rounding of π to f32.
const F32_ROUNDING: f64 = 1e-6;

/// Whether bytes begin like a tensor file.
#[must_use]
pub fn is_tensor(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// A field of the header.
struct TensorField {
    name: String,
    kind: u8,
    offset: u64,
    shape: Vec<u64>,
    /// Offset of its entry in the header.
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

    fn count(&mut self, what: TensorCount, most: usize) -> Result<usize, TensorError> {
        let at = self.at;
        let found = usize::from(u16::from_le_bytes(self.take()?));
        if found > most {
            let kind = TensorErrorKind::TooMany { what, found: found as u64, most: most as u64 };
            return Err(kind.at(Some(at), None));
        }
        Ok(found)
    }

    fn field(&mut self) -> Result<TensorField, TensorError> {
        let entry = self.at;
        let length = self.count(TensorCount::NameLength, LONGEST_NAME)?;
        let mut name = Vec::new();
        for _ in 0..length {
            name.extend(self.take::<1>()?);
        }
        let dimensions = self.count(TensorCount::Dimensions, MOST_DIMENSIONS)?;
        let [kind] = self.take()?;
        let offset = u64::from_le_bytes(self.take()?);
        let mut shape = Vec::new();
        for _ in 0..dimensions {
            shape.push(u64::from_le_bytes(self.take()?));
        }
        Ok(TensorField { name: String::from_utf8_lossy(&name).into_owned(), kind, offset, shape, entry })
    }
}

impl TensorField {
    fn error(&self, kind: TensorErrorKind) -> TensorError {
        kind.at(Some(self.entry), Some(&self.name))
    }

    fn shape_error(&self, expected: TensorShape) -> TensorError {
        self.error(TensorErrorKind::Shape { found: self.shape.clone(), expected })
    }

    fn expect_type(&self, expected: TensorType) -> Result<(), TensorError> {
        if self.kind == expected.code() { Ok(()) } else { Err(self.error(TensorErrorKind::Type { found: self.kind, expected })) }
    }

    /// Where the data of the field lie, by numbers of that many bytes. Lengths and offset are
    /// checked against the file.
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

impl Tensor {
    /// Reads a tensor file.
    ///
    /// # Errors
    /// The source fails, or the file is damaged or of another form.
    pub fn read(mut source: impl Read) -> Result<Self, TensorError> {
        let mut bytes = Vec::new();
        source.read_to_end(&mut bytes).map_err(|error| TensorErrorKind::Io(error).at(None, None))?;
        Self::from_bytes(bytes)
    }

    /// The tensor of a file in memory, without a second copy of it: such files reach a gigabyte.
    ///
    /// # Errors
    /// The file is damaged or of another form.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, TensorError> {
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
            let kind = TensorErrorKind::TooMany { what: TensorCount::Fields, found: count.into(), most: MOST_FIELDS.into() };
            return Err(kind.at(Some(MAGIC.len() + 2), None));
        }
        let fields = (0..count).map(|_| cursor.field()).collect::<Result<Vec<_>, _>>()?;
        let field =
            |name: &str| fields.iter().find(|field| field.name == name).ok_or_else(|| TensorErrorKind::Missing.at(None, Some(name)));
        let mut assumed_grids = Vec::new();
        let mut grid = |name: &'static str, range: (f64, f64)| grid_of(field(name)?, range, &bytes, name, &mut assumed_grids);
        let (phi_d, theta_d, theta_h) = (grid("phi_d", (-PI, PI))?, grid("theta_d", (0.0, FRAC_PI_2))?, grid("theta_h", (0.0, FRAC_PI_2))?);
        let wavelengths_nm = wavelengths_of(field("wvls")?, &bytes)?;
        let m = field("M")?;
        m.expect_type(TensorType::F32)?;
        let lengths = [phi_d.len(), theta_d.len(), theta_h.len(), wavelengths_nm.len(), 4, 4].map(|length| length as u64);
        if m.shape != lengths {
            return Err(m.shape_error(TensorShape::Matrices(lengths)));
        }
        let start = m.range(4, &bytes)?.start;
        Ok(Self::new(TensorAxes { phi_d, theta_d, theta_h, wavelengths_nm, assumed_grids }, bytes, start))
    }
}

/// The angles of a grid, even over their whole range where the file has their number alone.
fn grid_of(
    field: &TensorField,
    (low, high): (f64, f64),
    all: &[u8],
    name: &'static str,
    assumed: &mut Vec<&'static str>,
) -> Result<Vec<f64>, TensorError> {
    field.expect_type(TensorType::F32)?;
    let (&[rows @ (0 | 1), count], true) = (&field.shape[..], field.shape.last().is_some_and(|&count| count > 0)) else {
        return Err(field.shape_error(TensorShape::Angles));
    };
    if rows == 0 {
        // No angles stand behind the number: the file has to be long enough for an M of that
        // length.
        let most = all.len() as u64 / 64;
        if count > most {
            return Err(field.error(TensorErrorKind::TooMany { what: TensorCount::Angles, found: count, most }));
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
            return Err(field.error(TensorErrorKind::Grid { index, found, expected: TensorAxis::Angles }));
        }
        before = found;
    }
    Ok(angles)
}

fn wavelengths_of(field: &TensorField, all: &[u8]) -> Result<Vec<f64>, TensorError> {
    field.expect_type(TensorType::U16)?;
    if field.shape.len() != 1 || field.shape[0] == 0 {
        return Err(field.shape_error(TensorShape::Wavelengths));
    }
    let range = field.range(2, all)?;
    let wavelengths: Vec<f64> = all[range].chunks_exact(2).map(|pair| f64::from(u16::from_le_bytes([pair[0], pair[1]]))).collect();
    let mut before = 0.0;
    for (index, &found) in wavelengths.iter().enumerate() {
        if found <= before {
            return Err(field.error(TensorErrorKind::Grid { index, found, expected: TensorAxis::Wavelengths }));
        }
        before = found;
    }
    Ok(wavelengths)
}
