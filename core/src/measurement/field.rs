//! What a column of a table can hold, and in which units.

/// A quantity of a polarimeter, an ellipsometer or a Mueller matrix that DoLP is computed from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Channel {
    /// Stokes S0.
    S0,
    /// Stokes S1.
    S1,
    /// Stokes S2.
    S2,
    /// Intensity behind a polariser at 0°.
    I0,
    /// Intensity behind a polariser at 45°.
    I45,
    /// Intensity behind a polariser at 90°.
    I90,
    /// Intensity behind a polariser at 135°.
    I135,
    /// Reflectance or intensity of s-polarised light.
    Rs,
    /// Reflectance or intensity of p-polarised light.
    Rp,
    /// Ellipsometric angle ψ.
    Psi,
    /// Mueller element of row 0, column 0.
    M00,
    /// Mueller element of row 1, column 0.
    M10,
    /// Mueller element of row 2, column 0.
    M20,
}

/// What a column can hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
    /// Angle of incidence.
    ThetaI,
    /// Angle of view, negative on the backscatter side.
    ThetaR,
    /// Relative azimuth.
    Dphi,
    /// Azimuth of incidence; Δφ is the azimuth of view less it.
    PhiI,
    /// Azimuth of view.
    PhiR,
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
    /// Name of the measurement that the row belongs to.
    Set,
    /// Vacuum wavelength.
    Wavelength,
    /// What DoLP is computed from.
    Channel(Channel),
    /// Its standard deviation.
    ChannelSigma(Channel),
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
    /// The unit that the field has in this project's own files: degrees, a fraction, sr⁻¹, nm.
    Native,
    /// Radians, of an angle.
    Radians,
    /// Percent, of a DoLP, a reflectance or their standard deviation.
    Percent,
    /// Micrometres, of a wavelength.
    Micrometers,
    /// Ångströms, of a wavelength.
    Angstroms,
}

/// Names of the fields, in the order of files.
const KEYS: [(&str, Field); 38] = [
    ("theta_i", Field::ThetaI),
    ("theta_r", Field::ThetaR),
    ("dphi", Field::Dphi),
    ("dolp", Field::Dolp),
    ("dolp_sigma", Field::DolpSigma),
    ("brdf", Field::Brdf),
    ("brdf_sigma", Field::BrdfSigma),
    ("masked", Field::Masked),
    ("set", Field::Set),
    ("wavelength_nm", Field::Wavelength),
    ("phi_i", Field::PhiI),
    ("phi_r", Field::PhiR),
    ("s0", Field::Channel(Channel::S0)),
    ("s1", Field::Channel(Channel::S1)),
    ("s2", Field::Channel(Channel::S2)),
    ("i0", Field::Channel(Channel::I0)),
    ("i45", Field::Channel(Channel::I45)),
    ("i90", Field::Channel(Channel::I90)),
    ("i135", Field::Channel(Channel::I135)),
    ("rs", Field::Channel(Channel::Rs)),
    ("rp", Field::Channel(Channel::Rp)),
    ("psi", Field::Channel(Channel::Psi)),
    ("m00", Field::Channel(Channel::M00)),
    ("m10", Field::Channel(Channel::M10)),
    ("m20", Field::Channel(Channel::M20)),
    ("s0_sigma", Field::ChannelSigma(Channel::S0)),
    ("s1_sigma", Field::ChannelSigma(Channel::S1)),
    ("s2_sigma", Field::ChannelSigma(Channel::S2)),
    ("i0_sigma", Field::ChannelSigma(Channel::I0)),
    ("i45_sigma", Field::ChannelSigma(Channel::I45)),
    ("i90_sigma", Field::ChannelSigma(Channel::I90)),
    ("i135_sigma", Field::ChannelSigma(Channel::I135)),
    ("rs_sigma", Field::ChannelSigma(Channel::Rs)),
    ("rp_sigma", Field::ChannelSigma(Channel::Rp)),
    ("psi_sigma", Field::ChannelSigma(Channel::Psi)),
    ("m00_sigma", Field::ChannelSigma(Channel::M00)),
    ("m10_sigma", Field::ChannelSigma(Channel::M10)),
    ("m20_sigma", Field::ChannelSigma(Channel::M20)),
];

impl Field {
    /// All, in the order of files.
    pub fn all() -> impl Iterator<Item = Self> {
        KEYS.iter().map(|(_, field)| *field)
    }

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
            Self::ThetaI | Self::ThetaR | Self::Dphi | Self::PhiI | Self::PhiR => &[("degrees", Unit::Native), ("radians", Unit::Radians)],
            Self::Channel(Channel::Psi) | Self::ChannelSigma(Channel::Psi) => &[("degrees", Unit::Native), ("radians", Unit::Radians)],
            Self::Dolp | Self::DolpSigma => &[("fraction", Unit::Native), ("percent", Unit::Percent)],
            Self::Brdf | Self::BrdfSigma => &[("1/sr", Unit::Native), ("percent", Unit::Percent)],
            Self::Wavelength => &[("nm", Unit::Native), ("um", Unit::Micrometers), ("angstroms", Unit::Angstroms)],
            Self::Masked | Self::Set | Self::Channel(_) | Self::ChannelSigma(_) => &[],
        }
    }

    /// The unit of that name.
    #[must_use]
    pub fn unit(self, name: &str) -> Option<Unit> {
        self.unit_names().iter().find(|(known, _)| *known == name).map(|(_, unit)| *unit)
    }

    /// The standard deviation of a quantity.
    pub(crate) fn sigma(self) -> Option<Self> {
        match self {
            Self::Dolp => Some(Self::DolpSigma),
            Self::Brdf => Some(Self::BrdfSigma),
            Self::Channel(channel) => Some(Self::ChannelSigma(channel)),
            _ => None,
        }
    }

    /// Whether a column of it holds something measured: a quantity, or a standard deviation.
    pub(crate) fn is_measured(self) -> bool {
        matches!(self, Self::Dolp | Self::DolpSigma | Self::Brdf | Self::BrdfSigma | Self::Channel(_) | Self::ChannelSigma(_))
    }
}

/// A percentage as a fraction: the decimal number moved by two digits, without a rounding error.
pub(crate) fn hundredth(percent: f64) -> f64 {
    format!("{percent}e-2").parse().unwrap_or(percent / 100.0)
}

#[cfg(test)]
mod tests {
    use super::Field;

    #[test]
    fn a_percentage_is_its_decimal_number() {
        assert_eq!([2.34, 0.4, 11.79, 100.0].map(super::hundredth), [0.0234, 0.004, 0.1179, 1.0]);
    }

    #[test]
    fn every_field_has_a_key_of_its_own() {
        for field in Field::all() {
            assert_eq!(Field::from_key(field.key()), Some(field));
            assert!(field.sigma().is_none_or(|sigma| sigma.key() == format!("{}_sigma", field.key())));
        }
    }
}
