//! What differs between a desktop and a browser: threads, the clock, folders of the user, file
//! dialogs, the heap.
//!
//! The functions know nothing of the program; every other floor of the window may call them.

mod heap;
mod native;

pub use heap::raise_trim_threshold;
pub use native::{
    DialogUnavailable, FileDialog, FileFilter, Instant, PathPurpose, config_folder, data_folder, local_data_folder, local_time,
    show_file_dialog, spawn,
};
