//! The panels around the plots.

mod beside;
mod fit;
mod import;
mod lesson;
mod menu;
mod parameters;
mod status;

pub use fit::fit_ui;
pub use import::import_ui;
pub use lesson::lesson_panel;
pub use menu::menu_ui;
pub use parameters::{parameters_ui, significant};
pub use status::{fault_ui, notice_ui, status_ui};
