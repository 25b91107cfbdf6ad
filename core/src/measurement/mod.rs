//! Floor 3: measurements, read, written, simulated and imported.
//!
//! The file format is documented at [`read()`]. Readers take any `impl Read`: opening files, and naming them in messages, is left
//! to whoever calls.

mod mapping;
mod read;
mod series;
mod simulate;
mod table;
mod tensor;
mod tensor_write;
mod wavelength;
mod woollam;
mod write;

pub use mapping::{ColumnChoice, Field, MappedColumn, Mapping, MappingError, Unit};
pub use read::{read, read_mapped};
pub use series::{DataPoint, Series};
pub use simulate::{Columns, Simulation, grid_geometries};
pub use table::{Column, Progress, ReadError, ReadErrorKind, Record, Table};
pub use tensor::{Tensor, TensorError, TensorErrorKind, TensorSlice, is_tensor, read_tensor, rusinkiewicz, tensor_from_bytes};
pub use tensor_write::{TensorGrid, TensorResolution, write_tensor};
pub use wavelength::{WavelengthError, choose_wavelength};
pub use woollam::{Depolarisation, Ellipsometry, PsiDelta, SpecularDolp, is_woollam, read_woollam};
pub use write::{append_columns, exact, write};

use crate::optics::Geometry;

/// A measured value and, where stated, its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// The value: DoLP from 0 to 1, or BRDF in sr⁻¹.
    pub value: f64,
    /// Its standard deviation, > 0, in the same unit.
    pub sigma: Option<f64>,
}

/// What was measured under one geometry; at least one of the two quantities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Directions of incidence and view.
    pub geometry: Geometry,
    /// Degree of linear polarisation, 0 to 1.
    pub dolp: Option<Quantity>,
    /// BRDF in sr⁻¹.
    pub brdf: Option<Quantity>,
    /// Kept and shown, but used by no statistic.
    pub masked: bool,
}

/// A table of measured rows with what is said about them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measurement {
    /// `# key: value` lines, in their order.
    pub metadata: Vec<(String, String)>,
    /// The rows, in their order.
    pub rows: Vec<Row>,
    /// The line of the file that each row stands on; empty where there is no file.
    pub lines: Vec<u64>,
    /// Names of columns that were there but mean nothing here.
    pub ignored_columns: Vec<String>,
}

impl Measurement {
    /// The metadata value of that key.
    #[must_use]
    pub fn metadata(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// The columns that mean nothing here, in words.
    #[must_use]
    pub fn ignored_notice(&self) -> String {
        let names: Vec<String> =
            self.ignored_columns.iter().map(|name| if name.is_empty() { "without a name".to_owned() } else { name.clone() }).collect();
        format!("ignored the {} {}", if names.len() == 1 { "column" } else { "columns" }, names.join(", "))
    }

    /// Whether any row has a DoLP.
    #[must_use]
    pub fn has_dolp(&self) -> bool {
        self.rows.iter().any(|row| row.dolp.is_some())
    }

    /// Whether any row has a BRDF.
    #[must_use]
    pub fn has_brdf(&self) -> bool {
        self.rows.iter().any(|row| row.brdf.is_some())
    }

    /// Whether every value that is not masked comes with its standard deviation.
    #[must_use]
    pub fn states_sigmas(&self) -> bool {
        let used = self.rows.iter().filter(|row| !row.masked);
        used.flat_map(|row| [row.dolp, row.brdf]).flatten().all(|quantity| quantity.sigma.is_some())
    }

    /// The different angles of incidence in degrees, ascending.
    #[must_use]
    pub fn incidence_angles(&self) -> Vec<f64> {
        let mut angles: Vec<f64> = self.rows.iter().map(|row| row.geometry.theta_i().0).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        angles
    }
}
