//! A measurement as it stands in a session file: the lines of its CSV, and what the session knows of it.

use crate::app::storage::fit_record::on_one_line;
use crate::app::storage::saved_comparison::SavedComparison;
use crate::app::storage::saved_fit::SavedMeasurement;
use crate::app::work::open_measurement::MeasurementStyle;
use crate::app::work::surface::Surface;
use pbrdf::measurement::{Measurement, ReadError};
use serde::{Deserialize, Serialize};
use std::io;
use std::sync::Arc;

/// A measurement in the file.
#[derive(Serialize, Deserialize)]
pub struct MeasurementTable {
    name: String,
    sha256: Option<String>,
    #[serde(default = "yes")]
    open: bool,
    /// That of an open measurement that is not the active one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surface: Option<Surface>,
    #[serde(default, skip_serializing_if = "is_default")]
    style: MeasurementStyle,
    /// How often its squared residuals count in joint fits.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    weight: f64,
    /// The series that plots show, from 0, if not those that they show at first.
    #[serde(default, skip_serializing_if = "Option::is_none", serialize_with = "on_one_line")]
    drawn: Option<Vec<usize>>,
    /// Which fit is shown while it is active, from 0, if it is not now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shown: Option<usize>,
    /// Its comparison of models; fits are counted from 0.
    #[serde(default, skip_serializing_if = "SavedComparison::is_empty", serialize_with = "on_one_line")]
    compared: SavedComparison,
    /// Whether the next measurement that is opened takes its place.
    #[serde(default, skip_serializing_if = "is_default")]
    placeholder: bool,
    /// The lines of a measurement file.
    table: Vec<String>,
}

impl MeasurementTable {
    /// Of a measurement of a session.
    ///
    /// # Errors
    /// Memory takes no more.
    pub fn new(saved: &SavedMeasurement) -> io::Result<Self> {
        let saved = saved.clone();
        let mut bytes = Vec::new();
        saved.measurement.write(&mut bytes)?;
        let table = String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect();
        Ok(Self {
            name: saved.name,
            sha256: saved.sha256,
            open: saved.is_open,
            surface: saved.surface,
            style: saved.style,
            weight: saved.weight,
            drawn: saved.drawn,
            shown: saved.shown_fit,
            compared: saved.compared,
            placeholder: saved.is_placeholder,
            table,
        })
    }

    /// With the data of its lines.
    ///
    /// # Errors
    /// The lines are no measurement.
    pub fn into_measurement(self) -> Result<SavedMeasurement, ReadError> {
        let measurement = Arc::new(Measurement::read(self.table.join("\n").as_bytes())?);
        Ok(SavedMeasurement {
            name: self.name,
            sha256: self.sha256,
            is_open: self.open,
            surface: self.surface,
            style: self.style,
            weight: self.weight,
            drawn: self.drawn,
            shown_fit: self.shown,
            compared: self.compared,
            is_placeholder: self.placeholder,
            measurement,
        })
    }
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_one(weight: &f64) -> bool {
    *weight == 1.0
}

/// Whether a key can be left out.
pub fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
