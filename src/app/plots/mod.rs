//! Plots of egui: figures painted on the screen, their axes, names, colours and ranges.

mod axes;
pub mod axis;
mod color_scale;
mod curve_line;
mod figure_plot;
mod key_line;
mod map_image;
mod markers;
mod plot_axis;
mod plot_item;
mod polyline;
mod range;
pub mod theme;

pub use color_scale::{BAR_ROOM, ColorScale, color_bar};
pub use figure_plot::{FigurePlot, PanelPlace, PanelPlot, PanelStyle};
pub use key_line::{KeyEntry, key_line_ui, switching_key_line_ui, symbol_shapes};
pub use plot_axis::PlotAxis;
pub use polyline::{Polyline, finite, line};
pub use range::{AutoRange, Range, nice_ceiling};
