//! What a column of a table can hold, in which units, and what laboratories call it.

/// What a column can hold.
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
    /// Standard deviation of the DoLP.
    DolpSigma,
    /// BRDF in sr⁻¹.
    Brdf,
    /// Standard deviation of the BRDF.
    BrdfSigma,
    /// 0 or 1.
    Masked,
}

/// The name of the column in this project's own files.
impl std::fmt::Display for Field {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.key())
    }
}

/// The unit of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unit {
    /// The unit that the field has in this project's own files: degrees, a fraction, sr⁻¹.
    Native,
    /// Radians, of an angle.
    Radians,
    /// Percent, of a DoLP or its standard deviation.
    Percent,
}

/// Names of the fields.
const KEYS: [(&str, Field); 8] = [
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
        KEYS.iter().find(|(_, field)| *field == self).map_or("", |(name, _)| name)
    }

    /// The field of that name.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        KEYS.iter().find(|(name, _)| *name == key).map(|(_, field)| *field)
    }

    /// The names of the units that a column of this field can have, its native unit first; none
    /// where there is nothing to choose.
    #[must_use]
    pub fn unit_names(self) -> &'static [(&'static str, Unit)] {
        match self {
            Self::ThetaI | Self::ThetaR | Self::Dphi => &[("degrees", Unit::Native), ("radians", Unit::Radians)],
            Self::Dolp | Self::DolpSigma => &[("fraction", Unit::Native), ("percent", Unit::Percent)],
            Self::Brdf | Self::BrdfSigma | Self::Masked => &[],
        }
    }

    /// The unit of that name.
    #[must_use]
    pub fn unit(self, name: &str) -> Option<Unit> {
        self.unit_names().iter().find(|(known, _)| *known == name).map(|(_, unit)| *unit)
    }

    /// The unit that the name of a column states.
    pub(crate) fn unit_in(self, column: &str) -> Unit {
        let column = column.to_lowercase();
        let marks = [("rad", Unit::Radians), ("%", Unit::Percent), ("percent", Unit::Percent)];
        let stated = marks.iter().find(|(mark, unit)| column.contains(mark) && self.unit_names().iter().any(|(_, known)| known == unit));
        stated.map_or(Unit::Native, |(_, unit)| *unit)
    }

    /// Names of the field elsewhere, as [`stem`] leaves them, the most specific first.
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

    /// The rank of a name among the names of the field, 0 for the most specific; `None` for other
    /// names.
    pub(crate) fn rank(self, name: &str) -> Option<usize> {
        let name = stem(name);
        let place = |name: &str| self.aliases().iter().position(|alias| *alias == name);
        match self {
            Self::DolpSigma | Self::BrdfSigma => {
                let of = SIGMA.iter().filter_map(|mark| name.strip_suffix(mark).or_else(|| name.strip_prefix(mark)));
                of.filter_map(place).min()
            }
            _ => place(&name),
        }
    }
}

/// The rank of a name among those of a standard deviation of no particular quantity.
pub(crate) fn sigma_rank(name: &str) -> Option<usize> {
    SIGMA.iter().position(|mark| *mark == stem(name))
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
    // In metadata, these may be the azimuth of the sample.
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
/// The number of names of Δφ, from the first, that say that the azimuth is relative.
pub(crate) const RELATIVE_NAMES: usize = 7;
/// Marks of the standard deviation of a quantity, before or behind its name.
const SIGMA: &[&str] = &["sigma", "err", "error", "std", "stddev", "sd", "unc", "uncertainty"];

/// A name in small letters and digits, without brackets and what they hold, and without its unit.
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
    use super::Field;

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
