//! Files that command line and window read and write.

pub mod export;
pub mod open_file;
pub mod picture;
pub mod write_file;
