//! The panels around the plots.

mod fit;
mod measurement_list;
mod parameters;
mod stepping;
mod tooltip_right;

pub use fit::{delta_e_text, fit_ui};
pub use measurement_list::MeasurementPanel;
pub use parameters::parameters_ui;
pub use stepping::{SliderStep, step_with_arrows};
