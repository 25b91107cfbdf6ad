//! Floor 5: what the program says about itself: accuracy against run time, stability, cost.
//!
//! A [`Report`] is a value: rows with named columns, shown as Markdown, as JSON, or in a window. Clock, cancel and progress come
//! from outside ([`Host`]), and so does what is known of the machine.

mod accuracy_vs_time;
mod benchmark_problem;
mod benchmark_run;
mod benchmark_solver;
mod cost;
mod error_vs_time;
mod machine;
mod method;
mod model_benchmark;
mod note;
mod reference;
mod reference_lm;
mod solver_benchmark;
mod stability;
mod stability_case;
mod stability_fits;
mod table;
mod textbook;
mod timing;

pub use cost::Cost;
pub use error_vs_time::{ErrorVsTime, TaskKind};
pub use machine::Machine;
pub use method::BenchmarkMethod;
pub use note::Note;
pub use reference::{DARK_BAR, GRADIENT_BAR, Reference, VALUE_BAR, critical_angle_factor, golden, gradient_error, relative_error};
pub use stability::digits;
pub use stability_case::{Setting, Stability, StabilityCase, StabilityOutcome};
pub use table::{BenchmarkCurves, BenchmarkRow, Cell, Report};
pub use textbook::{textbook_f32, textbook_f64};
pub use timing::{Host, Timing, quantile};
