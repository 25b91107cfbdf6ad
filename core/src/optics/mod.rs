//! Floor 1: light and surfaces, before any parameter of the model.
//!
//! Directions point away from the surface; `dphi = φr − φi` is 180° on the forward (specular) side.
//! Fields vary as exp(−iωt), the refractive index is N = n + i k_m, and Stokes components refer to the
//! basis [E_s, E_p] with s = k × n, p = k × s for a ray along k, so that S1 = I_s − I_p.

mod angle;
mod facet;
mod fresnel;
mod geometry;
mod masking;
mod metals;
mod polarization;
mod quadrature;
mod refractive_index;
mod shortest;
mod slope_distribution;
mod v_grooves;

pub use angle::Degrees;
pub(crate) use angle::RADIANS_PER_DEGREE;
pub use facet::Facet;
pub use fresnel::{Fresnel, FresnelGradient};
pub use geometry::{Geometry, GeometryError, Rotation};
pub use masking::Masking;
pub use metals::{Metal, MetalSource, MetalsError, MetalsErrorKind, OutsideRange, Sample, metal, metal_named_in, metals, read_metals};
pub(crate) use polarization::angle_of_polarisation;
pub use polarization::{Mueller, Stokes};
pub(crate) use quadrature::{Order, pieces};
pub use refractive_index::{RefractiveIndex, RefractiveIndexError};
pub use shortest::shortest;
pub use slope_distribution::SlopeDistribution;
pub(crate) use slope_distribution::reduced_slope_sq;
pub(crate) use v_grooves::VGrooves;
