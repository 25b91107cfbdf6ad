//! The panels around the plots.

mod fit;
mod list_row;
mod measurement_list;
mod parameter_slider;
mod parameters;
mod pinned_list;
mod sharing;
mod stepping;
mod ties;
mod tooltip_right;

pub use fit::{delta_e_text, fit_ui};
pub use list_row::{before_ui, button_width};
pub use measurement_list::MeasurementPanel;
pub use parameter_slider::{DirectionAngle, angle_ui, name_ui, slider_ui};
pub use parameters::parameters_ui;
pub use pinned_list::PinnedPanel;
pub use stepping::{SliderStep, step_with_arrows};
