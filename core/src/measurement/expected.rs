//! What a reader expects of a cell, a line or a grid.

use crate::model::Domain;

/// What a reader expected where something else stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expected {
    /// Any finite number.
    FiniteNumber,
    /// A number in the domain of a parameter.
    Parameter(Domain),
    /// A refractive index that is not 0.
    Index,
    /// `gauss` or `cauchy`.
    Distribution,
    /// An angle in degrees.
    Angle,
    /// The angle of incidence of a model, 0° ≤ θi < 90°.
    ModelThetaI,
    /// The angle of view of a model, 0° ≤ θr < 90°.
    ModelThetaR,
    /// A measured angle of incidence, 0° ≤ θi < 90°.
    ThetaI,
    /// A measured angle of view, −90° < θr < 90°.
    ThetaR,
    /// A relative azimuth, finite.
    Dphi,
    /// DoLP from 0 to 1.
    Dolp,
    /// DoLP from 0 to 100 percent.
    DolpPercent,
    /// BRDF of 0 sr⁻¹ or more.
    Brdf,
    /// A standard deviation above 0.
    Sigma,
    /// A mask, 0 or 1.
    Mask,
    /// A wavelength above 0.
    Wavelength,
    /// The ellipsometric angle ψ from 0° to 90°.
    Psi,
    /// The ellipsometric angle Δ in degrees.
    Delta,
    /// A standard deviation of 0 or more.
    SigmaOrZero,
    /// A depolarisation in percent.
    Depolarisation,
    /// A line of numbers, or of a quantity and its numbers, in Woollam's text.
    WoollamRow,
    /// The line with the unit of the wavelength in Woollam's text.
    WavelengthUnit,
    /// An angle from the surface normal on either side of the sample, 0° to 180°.
    PolarAngle,
    /// A line of a header or of numbers, by an example of it.
    Line(&'static str),
}

impl std::fmt::Display for Expected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Parameter(domain) => return domain.fmt(f),
            Self::Line(example) => return write!(f, "a line such as {example}"),
            Self::FiniteNumber => "a finite number",
            Self::Index => "n or k above 0",
            Self::Distribution => "gauss or cauchy",
            Self::Angle => "an angle in degrees",
            Self::ModelThetaI => "0 ≤ θi < 90 degrees",
            Self::ModelThetaR => "0 ≤ θr < 90 degrees",
            Self::ThetaI => "an angle of incidence, 0 ≤ θi < 90 degrees",
            Self::ThetaR => "an angle of view, −90 < θr < 90 degrees",
            Self::Dphi => "a finite angle in degrees",
            Self::Dolp => "a DoLP from 0 to 1",
            Self::DolpPercent => "a DoLP from 0 to 100 percent",
            Self::Brdf => "a BRDF of 0 sr⁻¹ or more",
            Self::Sigma => "a standard deviation above 0",
            Self::Mask => "0 or 1",
            Self::Wavelength => "a wavelength above 0",
            Self::Psi => "an angle ψ from 0 to 90 degrees",
            Self::Delta => "an angle Δ in degrees",
            Self::SigmaOrZero => "a standard deviation of 0 or more",
            Self::Depolarisation => "a depolarisation in percent",
            Self::WoollamRow => "a row such as 650 55 43.2 160.0, or a quantity such as dpolE before its numbers",
            Self::WavelengthUnit => "a line with the unit of the wavelength, such as nm or Angstroms, before the rows",
            Self::PolarAngle => "an angle from the surface normal, 0 ≤ θ ≤ 180 degrees",
        })
    }
}
