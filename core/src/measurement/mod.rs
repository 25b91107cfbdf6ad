//! Floor 3: measurements, read, written, simulated and imported.
//!
//! The table of this project is documented at [`Measurement::read`]. Readers take any `impl Read`:
//! opening files, and naming them in messages, is left to the caller. A foreign file becomes a
//! measurement by its form in [`formats`].

mod brdf_meaning;
mod ellipsometry;
mod error;
mod expected;
mod field;
pub mod foreign;
pub mod formats;
mod hint;
mod mapping;
#[expect(clippy::module_inception, reason = "each type stands in a file of its name, the type of the floor too")]
mod measurement;
mod note;
mod polarimeter;
mod progress;
mod row;
mod rows;
mod rusinkiewicz;
mod series;
mod simulation;
mod table;
mod tensor;
mod wavelength;

pub use brdf_meaning::BrdfMeaning;
pub use ellipsometry::{Depolarisation, Ellipsometry, PsiDelta, SpecularDolp};
pub use error::{ColumnPlace, ReadError, ReadErrorKind, is_not_measured, quote};
pub use expected::Expected;
pub use field::{Channel, Field, Unit};
pub use formats::{
    TensorAxis, TensorCount, TensorError, TensorErrorKind, TensorGrid, TensorResolution, TensorShape, TensorType, append_columns,
    is_tensor, is_woollam, write_measurements, write_tensor,
};
pub use hint::Hint;
pub use mapping::{ColumnChoice, MappedColumn, Mapping, MappingError};
pub use measurement::{BeyondHorizon, Measurement};
pub use note::{ImportNote, LineList};
pub use polarimeter::Polarimeter;
pub use progress::{Progress, unwatched};
pub use row::{Quantity, Row};
pub use rusinkiewicz::rusinkiewicz;
pub(crate) use series::plane_of;
pub use series::{DataPoint, IncidenceSeries};
pub(crate) use simulation::Deviates;
pub use simulation::{Columns, Simulation, grid_geometries};
pub use table::{Record, Table};
pub use tensor::{Tensor, TensorSlice};
pub use wavelength::{WavelengthError, choose_wavelength};
