//! The user's work as a value: no egui, no files, no threads.

pub mod design;
pub mod diagnostics;
pub mod edit;
pub mod fit_history;
pub mod fit_setup;
pub mod history;
pub mod import_memory;
pub mod layout;
pub mod lesson;
mod lesson_setup;
pub mod measurement_list;
pub mod model_fit;
pub mod open_measurement;
pub mod pane_id;
pub mod parameter_text;
pub mod picture_options;
pub mod picture_scene;
pub mod predicted_errors;
pub mod results_options;
pub mod settings;
pub mod settings_error;
pub mod setup;
pub mod sharing;
pub mod surface;
pub mod workspace;
