//! How far a fit can be trusted: linear errors, profile likelihood, bootstrap, prediction bands.

pub(crate) mod band;
pub(crate) mod bootstrap;
pub(crate) mod confidence;
pub(crate) mod held;
pub(crate) mod interval;
pub(crate) mod linear;
pub(crate) mod profile;
pub(crate) mod quantile;
pub(crate) mod walk;
