//! One measured row: a geometry and what was measured there.

use crate::optics::Geometry;

/// A measured value and, where stated, its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// The value: DoLP from 0 to 1, or BRDF in sr⁻¹.
    pub value: f64,
    /// Its standard deviation, > 0, in the same unit.
    pub sigma: Option<f64>,
}

/// What was measured under one geometry; at least one of the two quantities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Directions of incidence and view.
    pub geometry: Geometry,
    /// Degree of linear polarisation, 0 to 1.
    pub dolp: Option<Quantity>,
    /// BRDF in sr⁻¹.
    pub brdf: Option<Quantity>,
    /// Kept and shown, but used by no statistic.
    pub masked: bool,
}
