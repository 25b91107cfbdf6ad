//! How far a fit can be trusted: linear errors, profile likelihood, bootstrap, prediction bands.

pub(crate) mod band;
pub(crate) mod bootstrap;
pub(crate) mod linear;
pub(crate) mod profile;
