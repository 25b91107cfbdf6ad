//! The headless core: a nine-parameter polarimetric microfacet BRDF of metal surfaces, its measurements and its fits.
#![doc = ""]
pub mod fit;
pub mod model;
pub mod optics;
pub mod measurement;
