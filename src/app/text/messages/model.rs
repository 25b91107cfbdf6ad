//! Messages of `pbrdf::optics` and `pbrdf::model`.

use crate::app::text::localized::Localized;
use pbrdf::model::{AssignmentError, Check, Domain, Finding, Parameter, ParameterError};
use pbrdf::optics::{GeometryError, SlopeDistribution, shortest};
use tr::tr;

impl Localized for SlopeDistribution {
    fn localized(&self) -> String {
        match self {
            Self::Gauss => tr!("Gauss"),
            Self::Cauchy => tr!("Cauchy"),
        }
    }
}

impl Localized for GeometryError {
    fn localized(&self) -> String {
        match self {
            Self::ThetaI(found) => tr!("theta_i = {} is outside 0 ≤ θi < 90 degrees", shortest(*found)),
            Self::ThetaR(found) => tr!("theta_r = {} is outside 0 ≤ θr < 90 degrees", shortest(*found)),
            Self::SignedThetaR(found) => tr!("theta_r = {} is outside −90 < θr < 90 degrees", shortest(*found)),
            Self::Dphi(found) => tr!("dphi = {} is not a finite angle", shortest(*found)),
        }
    }
}

impl Localized for Domain {
    fn localized(&self) -> String {
        let (low, high) = self.ends();
        match self {
            Self::Between(..) => tr!("a number from {0} to {1}", low, high),
            Self::ZeroOrBetween(..) => tr!("0 or a number from {0} to {1}", low, high),
        }
    }
}

impl Localized for ParameterError {
    fn localized(&self) -> String {
        match self {
            Self::Outside { parameter, value } => outside(*parameter, *value, parameter.domain()),
            Self::NoIndex => tr!("n and k are both 0: a medium needs at least one of them above 0"),
        }
    }
}

fn outside(parameter: Parameter, value: f64, expected: Domain) -> String {
    tr!("{0} = {1} is not allowed: expected {2}", parameter.key(), shortest(value), expected.localized())
}

impl Localized for AssignmentError {
    fn localized(&self) -> String {
        match self {
            Self::Form(found) => tr!("expected name=value, such as n=2, found {}", quoted(found)),
            Self::Name(found) => tr!("{0} is no parameter; expected one of {1}", quoted(found), Parameter::keys()),
            Self::Number(found) => tr!("{} is not a finite number", quoted(found)),
            Self::Outside { parameter, value, expected } => outside(*parameter, *value, *expected),
            Self::Twice(parameter) => tr!("{} is given twice", parameter.key()),
        }
    }
}

/// What somebody wrote, in quotes, with control characters escaped.
pub fn quoted(found: &str) -> String {
    format!("{found:?}")
}

impl Localized for Finding {
    fn localized(&self) -> String {
        match (self.check, self.pass) {
            (Check::SpecularReciprocity, true) => {
                tr!("P, G and the Fresnel reflection stay when the directions change places; tested on the radiance, F00.")
            }
            (Check::SpecularReciprocity, false) => {
                tr!("The specular term should be the same both ways: this is a fault of the program.")
            }
            (Check::DiffuseReciprocity, true) => tr!("cos θi and cos θr enter as a product: they may change places."),
            (Check::DiffuseReciprocity, false) => {
                tr!("Hyde's balance depends on the angle of incidence alone: seen the other way round it is another.")
            }
            (Check::VolumeReciprocity, true) => tr!("The volume lobe is absent, or so wide that it hardly depends on any angle."),
            (Check::VolumeReciprocity, false) => tr!("The volume term depends on the angle of view alone: it cannot be reciprocal."),
            (Check::Reflectance, true) => tr!("No more light leaves the surface than falls on it."),
            (Check::Reflectance, false) => tr!(
                "More light leaves the surface than falls on it: nothing in the model keeps k_s, k_d and k_v together below that, and for c < 0 the Minnaert term grows without end at grazing incidence."
            ),
            (Check::FresnelLimit, true) => tr!("The depolarising terms add radiance without polarisation: they can only lower DoLP."),
            (Check::FresnelLimit, false) => tr!("DoLP above that of the bare facets: this is a fault of the program."),
            (Check::Admissibility, true) => {
                tr!("A Fresnel reflection and depolarisers with positive weights add up to a matrix that some optical system has.")
            }
            (Check::Admissibility, false) => tr!("No optical system has this matrix: this is a fault of the program."),
            (Check::Normalisation, true) => tr!("The facets, projected, cover their surface exactly once."),
            (Check::Normalisation, false) => {
                tr!("The projected facets should cover the surface once: this is a fault of the program.")
            }
        }
    }
}
