//! Floor 5: results in the forms that leave the program, and what the program says about itself.
//!
//! A [`Report`] is a value: rows with named columns, shown as Markdown, as JSON, or in the window. Clock, cancel and progress come
//! from outside ([`Surroundings`]), and so does what is known of the machine.

mod cost;
mod curves;
mod document;
mod error_vs_time;
pub mod figure;
mod fit_document;
mod fit_figures;
mod fit_json;
mod fit_race;
mod fitted;
mod ladder_race;
mod machine;
mod palette;
mod reference;
mod stability;
mod stiff_fits;
mod table;
mod textbook;
mod timing;
mod yardstick;

pub use cost::Cost;
pub use curves::{CurvePoint, curve, directions, write_curves};
pub use document::{Block, Document};
pub use error_vs_time::{ErrorVsTime, TaskKind};
pub use fit_document::{FitDocument, Source};
pub use fit_figures::FitFigures;
pub use fit_json::fit_json;
pub use fitted::{FITTED_COLUMNS, dolp_divisor, fitted_cells, write_fitted};
pub use machine::Machine;
pub use reference::{Reference, critical_angle_factor, golden, gradient_error, relative_error};
pub use stability::{GRADIENT_BAR, Setting, Stability, VALUE_BAR, digits};
pub use table::{Cell, Report, Row};
pub use textbook::{textbook_f32, textbook_f64};
pub use timing::{Surroundings, Timing, quantile};
