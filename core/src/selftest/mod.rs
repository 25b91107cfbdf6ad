//! Floor 5: what the program says about itself: accuracy against run time, stability, cost.
//!
//! A [`Report`] is a value: rows with named columns, shown as Markdown, as JSON, or in a window. Clock, cancel and progress come
//! from outside ([`Host`]), and so does what is known of the machine.

mod accuracy_vs_time;
mod cost;
mod machine;
mod method;
mod model_benchmark;
mod note;
mod reference;
mod reference_lm;
mod solver_benchmark;
mod stability;
mod stability_fits;
mod table;
mod textbook;
mod timing;

pub use accuracy_vs_time::{ErrorVsTime, TaskKind};
pub use cost::Cost;
pub use machine::Machine;
pub use method::BenchmarkMethod;
pub use note::Note;
pub use reference::{Reference, critical_angle_factor, golden, gradient_error, relative_error};
pub use stability::{GRADIENT_BAR, Setting, Stability, StabilityCase, StabilityOutcome, VALUE_BAR, digits};
pub use table::{BenchmarkRow, Cell, Curves, Report};
pub use textbook::{textbook_f32, textbook_f64};
pub use timing::{Host, Timing, quantile};
