//! The panels around the plots.

mod beside;
mod fit;
mod help;
mod import;
mod lesson;
mod menu;
mod parameters;
mod replace;
mod status;
mod stepping;

pub use fit::fit_ui;
pub use help::help_ui;
pub use import::import_ui;
pub use lesson::lesson_panel;
pub use menu::menu_ui;
pub use parameters::{parameters_ui, significant};
pub use replace::replace_ui;
pub use status::{notices_ui, status_ui};
pub use stepping::{Step, step_with_arrows};
