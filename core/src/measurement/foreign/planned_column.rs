//! A column of a foreign table with what it is taken for.

use crate::measurement::{Field, Unit};

/// A column with what it is taken for.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedColumn {
    /// Its name; its number where the table has no header.
    pub name: String,
    /// What it holds; none for a column that is not used.
    pub field: Option<Field>,
    /// The unit of its cells.
    pub unit: Unit,
    /// Whether the file states the unit.
    pub states_unit: bool,
    /// Angle of incidence of its values in degrees, in a wide table.
    pub theta_i: Option<f64>,
    /// Angle of view of its values in degrees, in a wide table.
    pub theta_r: Option<f64>,
    /// Wavelength of its values in nm, in a wide table.
    pub wavelength_nm: Option<f64>,
    /// How sure the meaning is.
    pub(crate) score: u8,
    /// Whether its reflectance is a BRDF.
    pub(crate) is_brdf: bool,
}

impl PlannedColumn {
    /// What the column is taken for, in words: `theta_i in degrees`, `dolp in percent at 450 nm`.
    #[must_use]
    pub fn description(&self) -> String {
        let Some(field) = self.field else { return "not used".to_owned() };
        let unit = field.unit_names().iter().find(|(_, unit)| *unit == self.unit).map(|(name, _)| format!(" in {name}"));
        let place = |name: &str, value: Option<f64>, unit: &str| value.map(|value| format!(" at {name}{value}{unit}")).unwrap_or_default();
        format!(
            "{field}{}{}{}{}",
            unit.filter(|_| !(field == Field::Dolp && self.unit == Unit::Native)).unwrap_or_default(),
            place("θi = ", self.theta_i, "°"),
            place("θr = ", self.theta_r, "°"),
            place("", self.wavelength_nm, " nm")
        )
    }
}
