//! The measurement: rows, metadata, and the places of the rows in their file.

use crate::measurement::note::ImportNote;
use crate::measurement::{Quantity, Row};

/// A row at |θr| ≥ 90°, where no model has a value; written back as masked, used by nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeyondHorizon {
    /// Degrees.
    pub theta_i: f64,
    /// Degrees, negative on the backscatter side.
    pub theta_r: f64,
    /// Degrees.
    pub dphi: f64,
    /// DoLP.
    pub dolp: Option<Quantity>,
    /// BRDF in sr⁻¹.
    pub brdf: Option<Quantity>,
}

/// A table of measured rows with its metadata.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measurement {
    /// What the column `set` of the file calls it; empty without such a column.
    pub name: String,
    /// `# key: value` lines, in their order.
    pub metadata: Vec<(String, String)>,
    /// The rows, in their order.
    pub rows: Vec<Row>,
    /// The line of the file that each row stands on; empty where there is no file.
    pub lines: Vec<u64>,
    /// Rows at |θr| ≥ 90°.
    pub beyond_horizon: Vec<BeyondHorizon>,
    /// Names of the columns of the file that no row uses.
    pub ignored_columns: Vec<String>,
    /// What the reader has to say besides.
    pub notes: Vec<ImportNote>,
}

impl Measurement {
    /// The metadata value of that key.
    #[must_use]
    pub fn metadata(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// The vacuum wavelength in nm that the metadata state, where it is one number.
    #[must_use]
    pub fn wavelength_nm(&self) -> Option<f64> {
        self.metadata("wavelength_nm").and_then(|value| value.parse().ok()).filter(|&nm: &f64| nm > 0.0 && nm.is_finite())
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

    /// Number of rows that are not masked.
    #[must_use]
    pub fn used_rows(&self) -> usize {
        self.rows.iter().filter(|row| !row.masked).count()
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
