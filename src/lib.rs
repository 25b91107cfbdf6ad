//! The headless core: a nine-parameter polarimetric microfacet BRDF of metal surfaces, its measurements and its fits.
#![doc = ""]
pub mod model;
pub mod optics;
