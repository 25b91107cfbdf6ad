//! Reading a foreign table by saying which of its columns is what, and in which unit.
//!
//! As text, `theta_i=AOI,theta_r=3:radians,dolp=DoLP:percent`: a column of [`crate::measurement::read()`], the name in the header or its number from
//! 1, and the unit where it is not the usual one. [`Mapping::guess`] proposes; nothing is applied that nobody chose.

use crate::measurement::table::ReadError;
use crate::measurement::{ReadErrorKind, Table};

/// What a column can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
    /// Angle of incidence.
    ThetaI,
    /// Angle of view, negative on the backscatter side.
    ThetaR,
    /// Relative azimuth.
    Dphi,
    /// Degree of linear polarisation.
    Dolp,
    /// Its standard deviation.
    DolpSigma,
    /// BRDF in sr⁻¹.
    Brdf,
    /// Its standard deviation.
    BrdfSigma,
    /// 0 or 1.
    Masked,
}

/// In what a column is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unit {
    /// Degrees; a fraction; sr⁻¹: whatever the field has in this project's own files.
    Usual,
    /// Radians, of an angle.
    Radians,
    /// Percent, of DoLP or its standard deviation.
    Percent,
}

/// Which column.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum ColumnChoice {
    /// By its name in the header.
    Name(String),
    /// By its number, from 1.
    Number(usize),
}

/// A column with its meaning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MappedColumn {
    /// What it is.
    pub field: Field,
    /// Which it is.
    pub column: ColumnChoice,
    /// In what it is stated.
    pub unit: Unit,
}

/// Which columns of a foreign table mean what, and what stands in for a column that it lacks.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mapping {
    /// The columns, each field at most once.
    pub columns: Vec<MappedColumn>,
    /// Angle of incidence of every row in degrees, where no column is one.
    pub theta_i: Option<f64>,
    /// Relative azimuth of every row in degrees, where no column is one; 180 without.
    pub dphi: Option<f64>,
}

/// Why a text is no mapping.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MappingError {
    /// Not of the form field=column.
    #[error("found {0:?}, expected field=column, such as theta_i=AOI or dolp=3:percent")]
    Form(String),
    /// A field that there is not.
    #[error("{0:?} is no field; expected one of {names}", names = FIELDS.map(|(name, _)| name).join(", "))]
    Field(String),
    /// A unit that the field does not have.
    #[error("{unit:?} is no unit of {field}; expected {expected}")]
    Unit {
        /// Its name.
        field: &'static str,
        /// The unit.
        unit: String,
        /// Those it has.
        expected: &'static str,
    },
    /// A field twice.
    #[error("{0} is given twice")]
    Repeated(&'static str),
}

/// Names of the fields.
const FIELDS: [(&str, Field); 8] = [
    ("theta_i", Field::ThetaI),
    ("theta_r", Field::ThetaR),
    ("dphi", Field::Dphi),
    ("dolp", Field::Dolp),
    ("dolp_sigma", Field::DolpSigma),
    ("brdf", Field::Brdf),
    ("brdf_sigma", Field::BrdfSigma),
    ("masked", Field::Masked),
];

impl Field {
    /// All, in the order of files.
    pub const ALL: [Self; 8] =
        [Self::ThetaI, Self::ThetaR, Self::Dphi, Self::Dolp, Self::DolpSigma, Self::Brdf, Self::BrdfSigma, Self::Masked];

    /// Name of the column in this project's own files.
    #[must_use]
    pub fn key(self) -> &'static str {
        FIELDS.iter().find(|(_, field)| *field == self).map_or("", |(name, _)| name)
    }

    /// The field of that name.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        FIELDS.iter().find(|(name, _)| *name == key).map(|(_, field)| *field)
    }

    /// The units it can be stated in, the usual one first.
    #[must_use]
    pub fn units(self) -> &'static [Unit] {
        match self {
            Self::ThetaI | Self::ThetaR | Self::Dphi => &[Unit::Usual, Unit::Radians],
            Self::Dolp | Self::DolpSigma => &[Unit::Usual, Unit::Percent],
            Self::Brdf | Self::BrdfSigma | Self::Masked => &[Unit::Usual],
        }
    }

    fn unit(self, text: &str) -> Result<Unit, MappingError> {
        let (names, expected): (&[(&str, Unit)], _) = match self {
            Self::ThetaI | Self::ThetaR | Self::Dphi => (&[("degrees", Unit::Usual), ("radians", Unit::Radians)], "degrees or radians"),
            Self::Dolp | Self::DolpSigma => (&[("fraction", Unit::Usual), ("percent", Unit::Percent)], "fraction or percent"),
            Self::Brdf | Self::BrdfSigma | Self::Masked => (&[], "none"),
        };
        let found = names.iter().find(|(name, _)| *name == text).map(|(_, unit)| *unit);
        found.ok_or_else(|| MappingError::Unit { field: self.key(), unit: text.to_owned(), expected })
    }

    /// What others call it, in small letters and digits alone, the surest name first.
    fn aliases(self) -> &'static [&'static str] {
        match self {
            Self::ThetaI => THETA_I,
            Self::ThetaR => THETA_R,
            Self::Dphi => DPHI,
            Self::Dolp | Self::DolpSigma => DOLP,
            Self::Brdf | Self::BrdfSigma => BRDF,
            Self::Masked => &["masked", "mask", "excluded"],
        }
    }

    /// The place of a name in small letters and digits among the names of this field, if it is one.
    fn rank(self, name: &str) -> Option<usize> {
        let place = |name: &str| self.aliases().iter().position(|alias| *alias == name);
        match self {
            Self::DolpSigma | Self::BrdfSigma => {
                let of = SIGMA.iter().filter_map(|mark| name.strip_suffix(mark).or_else(|| name.strip_prefix(mark)));
                of.filter_map(place).min()
            }
            _ => place(name),
        }
    }
}

const THETA_I: &[&str] = &[
    "thetai",
    "thetain",
    "thetainc",
    "thetaincident",
    "aoi",
    "angleofincidence",
    "incidenceangle",
    "incidentangle",
    "incidence",
    "incident",
    "inc",
    "incangle",
    "incidencezenith",
    "incidentzenith",
    "incidencezenithangle",
    "incidentzenithangle",
    "illuminationangle",
    "illumination",
    "sourceangle",
    "sza",
    "solarzenith",
    "solarzenithangle",
    "sunzenith",
    "sunzenithangle",
    "ti",
];
const THETA_R: &[&str] = &[
    "thetar",
    "thetav",
    "thetas",
    "thetaout",
    "thetarefl",
    "thetaview",
    "viewangle",
    "viewingangle",
    "view",
    "viewing",
    "vza",
    "viewzenith",
    "viewingzenith",
    "viewzenithangle",
    "viewingzenithangle",
    "angleofview",
    "angleofreflection",
    "reflectionangle",
    "observationangle",
    "observation",
    "detectorangle",
    "detector",
    "emissionangle",
    "emergenceangle",
    "exitangle",
    "tr",
];
const DPHI: &[&str] = &[
    "dphi",
    "deltaphi",
    "relativeazimuth",
    "relativeazimuthangle",
    "relazimuth",
    "relaz",
    "raa",
    // In a comment, these may be how the sample was turned.
    "azimuth",
    "azimuthangle",
    "azim",
    "az",
    "phi",
];
const DOLP: &[&str] = &[
    "dolp",
    "dlp",
    "degreeoflinearpolarization",
    "degreeoflinearpolarisation",
    "linearpolarization",
    "linearpolarisation",
    "dop",
    "degreeofpolarization",
    "degreeofpolarisation",
    "polarization",
    "polarisation",
    "pol",
];
const BRDF: &[&str] = &["brdf", "brdf1", "brdf1sr", "brdfsr1", "fr", "reflectance"];
/// So many names of Δφ say that it is relative.
const RELATIVE: usize = 7;
/// What marks the standard deviation of a quantity, before or behind its name.
const SIGMA: &[&str] = &["sigma", "err", "error", "std", "stddev", "sd", "unc", "uncertainty"];

impl Mapping {
    /// Reads the form of the module's head.
    pub fn from_text(text: &str) -> Result<Self, MappingError> {
        let mut mapping = Self::default();
        for part in text.split(',') {
            let (name, column) = part.split_once('=').ok_or_else(|| MappingError::Form(part.trim().to_owned()))?;
            let field = Field::from_key(name.trim()).ok_or_else(|| MappingError::Field(name.trim().to_owned()))?;
            let (column, unit) = match column.rsplit_once(':') {
                Some((column, unit)) => (column.trim(), field.unit(unit.trim())?),
                None => (column.trim(), Unit::Usual),
            };
            if column.is_empty() {
                return Err(MappingError::Form(part.trim().to_owned()));
            }
            if mapping.find(field).is_some() {
                return Err(MappingError::Repeated(field.key()));
            }
            let column = column.parse().map_or_else(|_| ColumnChoice::Name(column.to_owned()), ColumnChoice::Number);
            mapping.columns.push(MappedColumn { field, column, unit });
        }
        Ok(mapping)
    }

    /// What the names of a header suggest, by number of the column, and metadata where there is no column; to be offered, not applied.
    #[must_use]
    pub fn guess(header: &[String], metadata: &[(String, String)]) -> Self {
        let mut mapping = Self::default();
        for field in Field::ALL {
            let ranked = header.iter().enumerate().filter_map(|(index, name)| Some((field.rank(&stem(name))?, index)));
            if let Some((_, index)) = ranked.min() {
                let name = header[index].to_lowercase();
                let is = |unit: Unit, mark: &str| field.units().contains(&unit) && name.contains(mark);
                let unit = if is(Unit::Radians, "rad") {
                    Unit::Radians
                } else if is(Unit::Percent, "%") || is(Unit::Percent, "percent") {
                    Unit::Percent
                } else {
                    Unit::Usual
                };
                mapping.columns.push(MappedColumn { field, column: ColumnChoice::Number(index + 1), unit });
            }
        }
        mapping.guess_sigma(header);
        let stated = |field: Field, names: usize| {
            let is_it = |key: &str| field.rank(&stem(key)).is_some_and(|rank| rank < names);
            metadata.iter().filter(|(key, _)| is_it(key)).find_map(|(key, value)| degrees_in(key, value))
        };
        if mapping.find(Field::ThetaI).is_none() {
            mapping.theta_i = stated(Field::ThetaI, usize::MAX).filter(|angle| (0.0..90.0).contains(angle));
        }
        if mapping.find(Field::Dphi).is_none() {
            mapping.dphi = stated(Field::Dphi, RELATIVE);
        }
        mapping
    }

    /// A column that is a standard deviation and does not say of what belongs to the only quantity, in the same unit.
    fn guess_sigma(&mut self, header: &[String]) {
        let (value, sigma) = match (self.find(Field::Dolp), self.find(Field::Brdf)) {
            (Some(dolp), None) => (dolp, Field::DolpSigma),
            (None, Some(brdf)) => (brdf, Field::BrdfSigma),
            _ => return,
        };
        let rank = |name: &str| SIGMA.iter().position(|mark| *mark == stem(name));
        let ranked = header.iter().enumerate().filter_map(|(index, name)| Some((rank(name)?, index)));
        if let (None, Some((_, index))) = (self.find(sigma), ranked.min()) {
            let unit = value.unit;
            self.columns.push(MappedColumn { field: sigma, column: ColumnChoice::Number(index + 1), unit });
            self.columns.sort_by_key(|column| Field::ALL.iter().position(|field| *field == column.field));
        }
    }

    /// Whether something measured is named.
    #[must_use]
    pub fn has_quantity(&self) -> bool {
        self.find(Field::Dolp).is_some() || self.find(Field::Brdf).is_some()
    }

    /// What stands in for a column of that field, in degrees.
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

    /// Index and unit of the column of a field in a table.
    pub(crate) fn place(&self, field: Field, table: &Table) -> Result<Option<(usize, Unit)>, ReadError> {
        let Some(MappedColumn { column, unit, .. }) = self.find(field) else { return Ok(None) };
        let header = table.header();
        let unknown = |found: String| {
            let names = table.titles();
            table.header_error(ReadErrorKind::UnknownColumn { field: field.key(), found, names })
        };
        let index = match column {
            ColumnChoice::Name(name) => table.find(name)?.ok_or_else(|| unknown(format!("{name:?}")))?,
            ColumnChoice::Number(number) => {
                let index = number.checked_sub(1).filter(|&index| index < header.len());
                index.ok_or_else(|| unknown(format!("number {number}")))?
            }
        };
        Ok(Some((index, *unit)))
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
                Unit::Usual => {}
                Unit::Radians => write!(f, ":radians")?,
                Unit::Percent => write!(f, ":percent")?,
            }
        }
        Ok(())
    }
}

/// The angle in degrees that a line of metadata states, if it is one number, with or without a unit.
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

/// A name in small letters and digits, without what stands in brackets and without its unit.
fn stem(name: &str) -> String {
    let name = name.split(['(', '[', '/']).next().unwrap_or(name).to_lowercase();
    let letters: String = name
        .replace(['θ', 'ϑ'], "theta")
        .replace(['φ', 'ϕ'], "phi")
        .replace('δ', "delta")
        .replace('σ', "sigma")
        .chars()
        .filter(char::is_ascii_alphanumeric)
        .collect();
    let without = ["degrees", "deg", "radians", "rad", "percent"].iter().find_map(|unit| letters.strip_suffix(unit));
    without.unwrap_or(&letters).to_owned()
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
        assert_eq!(Mapping::from_text("dolp=1,dolp=2"), Err(MappingError::Repeated("dolp")));
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

    #[test]
    fn no_name_stands_for_two_fields() {
        for field in Field::ALL {
            for name in field.aliases() {
                let fields = Field::ALL.iter().filter(|other| other.rank(name).is_some()).count();
                assert_eq!(fields, 1, "{name}");
            }
        }
    }
}
