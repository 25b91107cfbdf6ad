//! Files that command line and window read and write.

pub mod disk;
pub mod export;
pub mod open_file;
#[cfg(feature = "gui")]
pub mod packed;
pub mod picture;
pub mod write_file;
