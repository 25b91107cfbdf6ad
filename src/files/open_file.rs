//! Opening a file, with the usual reasons why it cannot be.

use crate::files::disk::{self, OpenedFile};
use std::io::{self, ErrorKind};
use std::path::Path;

/// Why a file cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The path leads to a directory.
    #[error("this is a directory; expected a file")]
    Directory,
    /// Nothing has this path.
    #[error("there is no such file")]
    NotFound,
    /// Nobody may read it here.
    #[error("permission to read the file is denied")]
    Denied,
    /// The system refuses.
    #[error("the file cannot be opened: {0}")]
    Other(io::Error),
}

/// Opens a file for reading.
///
/// # Errors
///
/// [`OpenError`] where the path is a directory or the system refuses.
pub fn open_file(path: &Path) -> Result<OpenedFile, OpenError> {
    if path.is_dir() {
        return Err(OpenError::Directory);
    }
    disk::open(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => OpenError::NotFound,
        ErrorKind::PermissionDenied => OpenError::Denied,
        _ => OpenError::Other(error),
    })
}
