//! The measurement: rows, metadata, and the places of the rows in their file.

use crate::measurement::Row;

/// A table of measured rows with its metadata.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measurement {
    /// `# key: value` lines, in their order.
    pub metadata: Vec<(String, String)>,
    /// The rows, in their order.
    pub rows: Vec<Row>,
    /// The line of the file that each row stands on; empty where there is no file.
    pub lines: Vec<u64>,
    /// Names of the columns of the file that no row uses.
    pub ignored_columns: Vec<String>,
}

impl Measurement {
    /// The metadata value of that key.
    #[must_use]
    pub fn metadata(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
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
