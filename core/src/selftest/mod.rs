//! Floor 5: what the program says about itself: accuracy against run time, stability, cost.
//!
//! A [`Report`] is a value: rows with named columns, shown as Markdown, as JSON, or in a window. Clock, cancel and progress come
//! from outside ([`Host`]), and so does what is known of the machine.

mod accuracy_vs_time;
mod cost;
mod machine;
mod model_benchmark;
mod reference;
mod reference_lm;
mod solver_benchmark;
mod stability;
mod stability_fits;
mod table;
mod textbook;
mod timing;

pub use accuracy_vs_time::{ErrorVsTime, TaskKind, short_method};
pub use cost::Cost;
pub use machine::Machine;
pub use reference::{Reference, critical_angle_factor, golden, gradient_error, relative_error};
pub use stability::{GRADIENT_BAR, Setting, Stability, VALUE_BAR, digits};
pub use table::{Cell, Curves, Report, Row};
pub use textbook::{textbook_f32, textbook_f64};
pub use timing::{Host, Timing, quantile};
