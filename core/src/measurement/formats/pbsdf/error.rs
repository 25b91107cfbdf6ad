//! Why a tensor file cannot be read, and where.

/// Why a tensor file cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}{kind}", Place(*byte, field.as_deref()))]
pub struct TensorError {
    /// Offset in bytes from 0, where the fault has one.
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
    /// The file begins with other bytes.
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
    /// A count or length that no such file has.
    #[error("{what} is {found}; expected at most {most}")]
    TooMany {
        /// What is counted.
        what: TensorCount,
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
        /// What was expected.
        expected: TensorType,
    },
    /// A field of another shape.
    #[error("the shape is {found}; expected {expected}", found = Lengths(.found))]
    Shape {
        /// The lengths of the field.
        found: Vec<u64>,
        /// What was expected.
        expected: TensorShape,
    },
    /// Angles or wavelengths out of order, out of range or not finite.
    #[error("entry {index} is {found}; expected ascending {expected}")]
    Grid {
        /// Number from 0.
        index: usize,
        /// Its value.
        found: f64,
        /// What was expected.
        expected: TensorAxis,
    },
    /// The source failed.
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

impl TensorErrorKind {
    pub(super) fn at(self, byte: Option<usize>, field: Option<&str>) -> TensorError {
        TensorError { byte: byte.map(|byte| byte as u64), field: field.map(str::to_owned), kind: self }
    }
}

/// What a tensor file counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TensorCount {
    /// Fields of the file.
    Fields,
    /// Letters of a name.
    NameLength,
    /// Dimensions of a field.
    Dimensions,
    /// Angles of a grid.
    Angles,
}

impl std::fmt::Display for TensorCount {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Fields => "the number of fields",
            Self::NameLength => "the length of a name",
            Self::Dimensions => "the number of dimensions",
            Self::Angles => "the number of angles",
        })
    }
}

/// The type of the numbers of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TensorType {
    /// Unsigned, 16 bits.
    U16,
    /// Floating point, 32 bits.
    F32,
}

impl TensorType {
    /// Its number in the file.
    #[must_use]
    pub fn code(self) -> u8 {
        match self {
            Self::U16 => 3,
            Self::F32 => 10,
        }
    }
}

impl std::fmt::Display for TensorType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = match self {
            Self::U16 => "u16",
            Self::F32 => "f32",
        };
        write!(f, "{} ({name})", self.code())
    }
}

/// The shape that a field has to have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TensorShape {
    /// A grid of angles: 1 × their number.
    Angles,
    /// A list of wavelengths: their number.
    Wavelengths,
    /// The matrices: the lengths of the grids, 4 and 4.
    Matrices([u64; 6]),
}

impl std::fmt::Display for TensorShape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Angles => f.write_str("1 × the number of angles"),
            Self::Wavelengths => f.write_str("the number of wavelengths"),
            Self::Matrices(lengths) => Lengths(lengths).fmt(f),
        }
    }
}

/// Lengths with × between them.
struct Lengths<'a>(&'a [u64]);

impl std::fmt::Display for Lengths<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.iter().map(u64::to_string).collect::<Vec<_>>().join(" × "))
    }
}

/// What an axis of a tensor holds, ascending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TensorAxis {
    /// Angles in radians, within ±π.
    Angles,
    /// Wavelengths in nm.
    Wavelengths,
}

impl std::fmt::Display for TensorAxis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Angles => "angles in radians, within ±π",
            Self::Wavelengths => "wavelengths in nm",
        })
    }
}
