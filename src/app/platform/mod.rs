//! What differs between a desktop and a browser: threads, the clock, folders of the user, file
//! dialogs, the heap.
//!
//! The functions know nothing of the program; every other floor of the window may call them.

mod file_dialog;
#[cfg(not(target_arch = "wasm32"))]
mod heap;
#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(target_arch = "wasm32")]
pub mod probe;
#[cfg(target_arch = "wasm32")]
mod web;
#[cfg(target_arch = "wasm32")]
pub mod worker;

pub use file_dialog::{Arrival, DialogUnavailable, FileDialog, FileFilter, PathPurpose};
#[cfg(not(target_arch = "wasm32"))]
pub use heap::raise_trim_threshold;
#[cfg(not(target_arch = "wasm32"))]
pub use native::*;
#[cfg(target_arch = "wasm32")]
pub use web::*;
