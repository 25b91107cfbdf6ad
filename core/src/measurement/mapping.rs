//! Which column of a foreign table holds what, and in which unit.
//!
//! As text, `theta_i=AOI,theta_r=3:radians,dolp=DoLP:percent`: a [`Field`], the name of the column
//! in the header or its number from 1, and the unit where it is not the native one.

use crate::measurement::field::{RELATIVE_NAMES, sigma_rank};
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
    #[error("{0:?} is no field; expected one of {names}", names = Field::ALL.map(Field::key).join(", "))]
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

    /// What the names of a header suggest, by number of the column, and what metadata state where
    /// there is no column. A guess: to be offered, not applied unasked.
    #[must_use]
    pub fn guess(header: &[String], metadata: &[(String, String)]) -> Self {
        let mut mapping = Self::default();
        for field in Field::ALL {
            let ranked = header.iter().enumerate().filter_map(|(index, name)| Some((field.rank(name)?, index)));
            if let Some((_, index)) = ranked.min() {
                let unit = field.unit_in(&header[index]);
                mapping.columns.push(MappedColumn { field, column: ColumnChoice::Number(index + 1), unit });
            }
        }
        mapping.guess_sigma(header);
        let stated = |field: Field, names: usize| {
            let is_it = |key: &str| field.rank(key).is_some_and(|rank| rank < names);
            metadata.iter().filter(|(key, _)| is_it(key)).find_map(|(key, value)| degrees_in(key, value))
        };
        if mapping.find(Field::ThetaI).is_none() {
            mapping.theta_i = stated(Field::ThetaI, usize::MAX).filter(|angle| (0.0..90.0).contains(angle));
        }
        if mapping.find(Field::Dphi).is_none() {
            mapping.dphi = stated(Field::Dphi, RELATIVE_NAMES);
        }
        mapping
    }

    /// Gives a standard deviation of no particular quantity to the only quantity, in the same unit.
    fn guess_sigma(&mut self, header: &[String]) {
        let (value, sigma) = match (self.find(Field::Dolp), self.find(Field::Brdf)) {
            (Some(dolp), None) => (dolp, Field::DolpSigma),
            (None, Some(brdf)) => (brdf, Field::BrdfSigma),
            _ => return,
        };
        let ranked = header.iter().enumerate().filter_map(|(index, name)| Some((sigma_rank(name)?, index)));
        if let (None, Some((_, index))) = (self.find(sigma), ranked.min()) {
            let unit = value.unit;
            self.columns.push(MappedColumn { field: sigma, column: ColumnChoice::Number(index + 1), unit });
            self.columns.sort_by_key(|column| Field::ALL.iter().position(|field| *field == column.field));
        }
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
            }
        }
        Ok(())
    }
}

/// The angle in degrees that a line of metadata states: one number, with or without a unit.
fn degrees_in(key: &str, value: &str) -> Option<f64> {
    let end = value.find(|next: char| !next.is_ascii_digit() && !['.', '-', '+'].contains(&next)).unwrap_or(value.len());
    let number: f64 = value[..end].parse().ok()?;
    match value[end..].trim().to_lowercase().as_str() {
        "" if key.to_lowercase().contains("rad") => Some(number.to_degrees()),
        "" | "°" | "deg" | "degree" | "degrees" => Some(number),
        "rad" | "radian" | "radians" => Some(number.to_degrees()),
        _ => None,
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
            ("psi=1", "\"psi\" is no field"),
            ("theta_i=1:percent", "expected degrees or radians"),
            ("brdf=1:percent", "expected none"),
            ("dolp=1,dolp=2", "dolp is given twice"),
        ] {
            let error = Mapping::from_text(wrong).expect_err(wrong);
            assert!(error.to_string().contains(part), "{wrong}: {error}");
        }
        assert_eq!(Mapping::from_text("dolp=1,dolp=2"), Err(MappingError::Repeated(Field::Dolp)));
    }

    #[test]
    fn a_guess_knows_usual_names_and_units() {
        let header = ["Sample", "AOI [deg]", "View (rad)", "DoLP %", "BRDF [1/sr]"].map(str::to_owned);
        assert_eq!(Mapping::guess(&header, &[]).to_string(), "theta_i=2,theta_r=3:radians,dolp=4:percent,brdf=5");
        let own = ["theta_i", "theta_r", "dphi", "dolp", "dolp_sigma", "brdf", "brdf_sigma", "masked"].map(str::to_owned);
        assert_eq!(Mapping::guess(&own, &[]).columns.len(), 8);
        assert!(Mapping::guess(&["a".to_owned(), "b".to_owned()], &[]).columns.is_empty());
    }

    #[test]
    fn a_guess_knows_what_other_laboratories_write() {
        for (header, guess) in [
            ("inc,view,azimuth,pol", "theta_i=1,theta_r=2,dphi=3,dolp=4"),
            ("Incidence (deg),View zenith,RAA,Reflectance,Reflectance error", "theta_i=1,theta_r=2,dphi=3,brdf=4,brdf_sigma=5"),
            ("SZA,VZA,phi,DOP [%],DOP err [%]", "theta_i=1,theta_r=2,dphi=3,dolp=4:percent,dolp_sigma=5:percent"),
            ("inc_rad,viewing_angle_rad,pol_percent", "theta_i=1:radians,theta_r=2:radians,dolp=3:percent"),
            ("inc,view,pol [%],sd", "theta_i=1,theta_r=2,dolp=3:percent,dolp_sigma=4:percent"),
            ("inc,view,std,BRDF", "theta_i=1,theta_r=2,brdf=4,brdf_sigma=3"),
            ("inc,view,σ,DoLP", "theta_i=1,theta_r=2,dolp=4,dolp_sigma=3"),
            ("inc,view,DoLP,unc,dolp_err", "theta_i=1,theta_r=2,dolp=3,dolp_sigma=5"),
            ("ϑ_i/°,ϑ_r/°,Δϕ/°,DoLP,σ,BRDF 1/sr", "theta_i=1,theta_r=2,dphi=3,dolp=4,brdf=6"),
            // The surer name wins, wherever it stands.
            ("phi,relative azimuth,incident,AOI,pol,DoLP,std_dolp", "theta_i=4,dphi=2,dolp=6,dolp_sigma=7"),
        ] {
            let header: Vec<String> = header.split(',').map(str::to_owned).collect();
            assert_eq!(Mapping::guess(&header, &[]).to_string(), guess, "{header:?}");
        }
    }

    #[test]
    fn a_guess_takes_a_constant_angle_from_metadata_where_there_is_no_column() {
        let header = ["view", "dolp"].map(str::to_owned);
        for (key, value, theta_i, dphi) in [
            ("theta_i", "45", Some(45.0), None),
            ("angle of incidence", "45.5 deg", Some(45.5), None),
            ("AOI (rad)", "0", Some(0.0), None),
            ("incidence", "30°", Some(30.0), None),
            ("relative azimuth", "90 degrees", None, Some(90.0)),
            // Not one angle, no angle of incidence, or perhaps the sample's.
            ("theta_i", "30, 40", None, None),
            ("theta_i", "30:60:10", None, None),
            ("theta_i", "95", None, None),
            ("azimuth", "90", None, None),
            ("material", "45", None, None),
        ] {
            let guess = Mapping::guess(&header, &[(key.to_owned(), value.to_owned())]);
            assert_eq!((guess.theta_i, guess.dphi), (theta_i, dphi), "{key}: {value}");
        }
        let header = ["inc", "view", "dolp"].map(str::to_owned);
        assert_eq!(Mapping::guess(&header, &[("theta_i".to_owned(), "45".to_owned())]).theta_i, None);
    }
}
