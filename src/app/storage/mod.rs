//! What is kept or leaves the program: sessions, autosave, settings, imports, exports.

mod earlier_keys;
pub mod export;
pub mod fit_record;
pub mod folder;
pub mod import;
pub mod kept_work;
mod measurement_table;
mod saved_comparison;
pub mod saved_entry;
pub mod saved_fit;
pub mod saved_joint_fit;
pub mod session;
pub mod session_error;
pub mod session_file;
pub mod settings_file;
pub mod share_link;
