//! Opening a file, with the reason in words where it cannot be.

use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;

/// Opens a file for reading; the error is a phrase without the file's name.
pub fn open_file(path: &Path) -> Result<File, String> {
    if path.is_dir() {
        return Err("this is a directory; expected a file".to_owned());
    }
    File::open(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "permission to read the file is denied".to_owned(),
        _ => format!("the file cannot be opened: {error}"),
    })
}
