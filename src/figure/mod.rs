//! A figure as a plain value, drawn as SVG and, with the feature `figures`, as PNG.
//!
//! A figure has panels; a panel has two axes and series. Coordinates are those of the axes. Sizes of the
//! page are millimetres; text and lines are in points (1/72 inch). Text is outlined, so a figure looks the
//! same in every viewer, and the same figure gives the same bytes on every machine. Values that are not
//! finite, and values ≤ 0 on a logarithmic axis, split a curve and are otherwise left out.

mod axis;
mod canvas;
#[cfg(feature = "figures")]
mod color_key;
mod contours;
mod heat_map;
mod layout;
mod palette;
mod panel;
#[cfg(feature = "figures")]
mod png;
mod range;
mod series;
mod shapes;
mod svg;
mod text;
mod ticks;

pub use axis::{Axis, Scale, with_unit};
pub(crate) use canvas::escape;
pub use contours::Heights;
pub use heat_map::HeatMap;
pub use palette::{ColorMap, Rgb, SERIES};
pub use panel::{Figure, Panel};
#[cfg(feature = "figures")]
pub use png::{Image, PngError, icon};
pub use series::{Dash, Mark, Point, Series, Symbol};
pub use text::{CJK, FONT};
