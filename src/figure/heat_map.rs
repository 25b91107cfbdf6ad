//! Values on a grid as colours.

use crate::figure::axis::Axis;
use crate::figure::palette::ColorMap;

/// Values on a grid of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Borders of the cells along x, ascending: one more than there are columns.
    pub x_edges: Vec<f64>,
    /// Borders of the cells along y, ascending: one more than there are rows.
    pub y_edges: Vec<f64>,
    /// Row by row from the lowest y; what is missing or not finite stays blank.
    pub values: Vec<f64>,
    /// What the colours mean; its range without an own one is that of the values.
    pub color_axis: Axis,
    /// Which colours.
    pub colors: ColorMap,
}
