//! The `.pbsdf` tensor files of the KAIST data base (Baek et al., ACM Trans. Graph. 39(4), 139
//! (2020)), which Mitsuba 3 renders with its plugin `measured_polarized`.
//!
//! `tensor_file` 1.0, little endian: the 12 bytes `tensor_file\0`, two bytes of version, the number
//! of fields (`u32`), and for each field: `u16` length and name, `u16` number of dimensions, `u8`
//! type (3 is u16, 10 is f32), `u64` offset, `u64` lengths. Fields: `phi_d`, `theta_d`, `theta_h`
//! (1 × N, radians, ascending), `wvls` (nm), `M` (φ_d × θ_d × θ_h × wavelength × 4 × 4, sr⁻¹). The
//! angles are those of [`rusinkiewicz`](crate::measurement::rusinkiewicz()).

mod error;
mod format;
mod read;
mod write;

pub use error::{TensorAxis, TensorCount, TensorError, TensorErrorKind, TensorShape, TensorType};
pub(super) use format::Pbsdf;
pub use read::is_tensor;
pub use write::{TensorGrid, TensorResolution, write_tensor};
