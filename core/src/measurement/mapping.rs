//! Which column of a foreign table holds what, and in which unit.
//!
//! As text, `theta_i=AOI,theta_r=3:radians,dolp=DoLP:percent`: a [`Field`], the name of the column
//! in the header or its number from 1, and the unit where it is not the native one.

use crate::measurement::{Field, Unit};

/// Which column.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum ColumnChoice {
    /// By its name in the header.
    Name(String),
    /// By its number, from 1.
    Number(usize),
}

/// As a message has it: `"AOI"` or `number 3`.
impl std::fmt::Display for ColumnChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Name(name) => write!(f, "{name:?}"),
            Self::Number(number) => write!(f, "number {number}"),
        }
    }
}

/// A column with its meaning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MappedColumn {
    /// What the column holds.
    pub field: Field,
    /// Which column.
    pub column: ColumnChoice,
    /// The unit of its cells.
    pub unit: Unit,
}

/// Which columns of a foreign table hold what, and the angles that no column holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mapping {
    /// The columns, each field at most once.
    pub columns: Vec<MappedColumn>,
    /// Angle of incidence of every row in degrees, where no column holds it.
    pub theta_i: Option<f64>,
    /// Relative azimuth of every row in degrees, where no column holds it; 180 without.
    pub dphi: Option<f64>,
}

/// Why a text is no mapping.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MappingError {
    /// Not of the form field=column.
    #[error("found {0:?}, expected field=column, such as theta_i=AOI or dolp=3:percent")]
    Form(String),
    /// A field that there is not.
    #[error("{0:?} is no field; expected one of {names}", names = FieldNames)]
    Field(String),
    /// A unit that the field does not have.
    #[error("{unit:?} is no unit of {field}; expected {expected}", expected = UnitNames(*.field))]
    Unit {
        /// The field.
        field: Field,
        /// The unit.
        unit: String,
    },
    /// A field twice.
    #[error("{0} is given twice")]
    Repeated(Field),
}

/// The names of all fields.
struct FieldNames;

impl std::fmt::Display for FieldNames {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&Field::all().map(Field::key).collect::<Vec<_>>().join(", "))
    }
}

/// The units of a field, in words.
struct UnitNames(Field);

impl std::fmt::Display for UnitNames {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0.unit_names() {
            [] => f.write_str("none"),
            names => f.write_str(&names.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(" or ")),
        }
    }
}

impl Mapping {
    /// Reads the text form of the module's head.
    ///
    /// # Errors
    /// A part that is not `field=column`, a field or a unit that there is not, or a field twice.
    pub fn from_text(text: &str) -> Result<Self, MappingError> {
        let mut mapping = Self::default();
        for part in text.split(',') {
            let (name, column) = part.split_once('=').ok_or_else(|| MappingError::Form(part.trim().to_owned()))?;
            let field = Field::from_key(name.trim()).ok_or_else(|| MappingError::Field(name.trim().to_owned()))?;
            let (column, unit) = match column.rsplit_once(':') {
                Some((column, unit)) => {
                    let unit = unit.trim();
                    let known = field.unit(unit).ok_or_else(|| MappingError::Unit { field, unit: unit.to_owned() })?;
                    (column.trim(), known)
                }
                None => (column.trim(), Unit::Native),
            };
            if column.is_empty() {
                return Err(MappingError::Form(part.trim().to_owned()));
            }
            if mapping.find(field).is_some() {
                return Err(MappingError::Repeated(field));
            }
            let column = column.parse().map_or_else(|_| ColumnChoice::Name(column.to_owned()), ColumnChoice::Number);
            mapping.columns.push(MappedColumn { field, column, unit });
        }
        Ok(mapping)
    }

    /// Whether a quantity is named.
    #[must_use]
    pub fn has_quantity(&self) -> bool {
        self.find(Field::Dolp).is_some() || self.find(Field::Brdf).is_some()
    }

    /// The angle in degrees that stands in for a column of that field.
    #[must_use]
    pub fn constant(&self, field: Field) -> Option<f64> {
        match field {
            Field::ThetaI => self.theta_i,
            Field::Dphi => self.dphi,
            _ => None,
        }
    }

    /// The column of that field.
    #[must_use]
    pub fn find(&self, field: Field) -> Option<&MappedColumn> {
        self.columns.iter().find(|column| column.field == field)
    }
}

/// The form that [`Mapping::from_text`] reads.
impl std::fmt::Display for Mapping {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, MappedColumn { field, column, unit }) in self.columns.iter().enumerate() {
            write!(f, "{}{}=", if i == 0 { "" } else { "," }, field.key())?;
            match column {
                ColumnChoice::Name(name) => write!(f, "{name}")?,
                ColumnChoice::Number(number) => write!(f, "{number}")?,
            }
            match unit {
                Unit::Native => {}
                Unit::Radians => write!(f, ":radians")?,
                Unit::Percent => write!(f, ":percent")?,
                Unit::Micrometers => write!(f, ":um")?,
                Unit::Angstroms => write!(f, ":angstroms")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{ColumnChoice, Field, Mapping, MappingError, Unit};

    #[test]
    fn a_mapping_as_text_reads_back() {
        let text = "theta_i=AOI,theta_r=3:radians,dolp=DoLP:percent,brdf=f r";
        let mapping = Mapping::from_text(text).expect("a mapping");
        assert_eq!(mapping.to_string(), text);
        let dolp = mapping.find(Field::Dolp).expect("it is there");
        assert_eq!((&dolp.column, dolp.unit), (&ColumnChoice::Name("DoLP".to_owned()), Unit::Percent));
        assert_eq!(mapping.find(Field::ThetaR).map(|column| column.column.clone()), Some(ColumnChoice::Number(3)));
        for (wrong, part) in [
            ("", "expected field=column"),
            ("theta_i", "expected field=column"),
            ("theta_i=", "expected field=column"),
            ("chi=1", "\"chi\" is no field"),
            ("theta_i=1:percent", "expected degrees or radians"),
            ("masked=1:percent", "expected none"),
            ("dolp=1,dolp=2", "dolp is given twice"),
        ] {
            let error = Mapping::from_text(wrong).expect_err(wrong);
            assert!(error.to_string().contains(part), "{wrong}: {error}");
        }
        assert_eq!(Mapping::from_text("dolp=1,dolp=2"), Err(MappingError::Repeated(Field::Dolp)));
    }
}
