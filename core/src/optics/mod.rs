//! Floor 1: light and surfaces, before any parameter of the model.
//!
//! Directions point away from the surface; `dphi = φr − φi` is 180° on the forward (specular) side.
//! Fields vary as exp(−iωt), the refractive index is N = n + i k_m, and Stokes components refer to the
//! basis [E_s, E_p] with s = k × n, p = k × s for a ray along k, so that S1 = I_s − I_p.

mod angle;
mod double;
mod facets;
mod fresnel;
mod geometry;
mod grooves;
mod metals;
mod polarization;
mod quadrature;
mod refractive_index;
mod sharp_facet;

pub use angle::Degrees;
pub(crate) use double::{Double, LN_2, two_sum};
pub use facets::SlopeDistribution;
pub(crate) use facets::reduced_slope_sq;
pub use fresnel::{Fresnel, FresnelGradient};
pub use geometry::{Facet, Geometry, GeometryError, Rotation};
pub(crate) use grooves::Grooves;
pub use metals::{Metal, MetalsError, MetalsErrorKind, OutsideRange, Sample, Source, metal, metal_named_in, metals, read_metals};
pub use polarization::{Mueller, Stokes};
pub(crate) use quadrature::Order;
pub use refractive_index::{RefractiveIndex, RefractiveIndexError};
pub(crate) use sharp_facet::SharpFacet;
