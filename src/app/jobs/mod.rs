//! Jobs: work apart from the window's thread, with progress, cancel and result.
//!
//! This floor knows nothing of fits, files or sessions; the jobs of the program are in `tasks`.

pub mod async_memo;
pub mod job;
pub mod memo;
pub mod slot;
pub mod spawner;
