//! Atomic writing: a crash or a full disk leaves the old file or the new one.

use std::io::{self, Write};
use std::path::Path;

/// Writes a file in one move.
#[cfg(target_arch = "wasm32")]
pub fn write_file(path: &Path, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut bytes = Vec::new();
    body(&mut bytes)?;
    crate::files::disk::write(path, bytes)
}

/// Writes a file atomically: the old file stays until the new one is complete, and on any error.
#[cfg(not(target_arch = "wasm32"))]
pub fn write_file(path: &Path, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    // The target of a link is replaced, not the link. A device, a pipe or a stream of this process cannot
    // be replaced, only written to. What lies under /dev/shm are files.
    let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let is_device = |path: &Path| path.starts_with("/dev") && !path.starts_with("/dev/shm");
    let is_stream = [path, &target].into_iter().any(|path| is_device(path) || path.starts_with("/proc"));
    let path = target.as_path();
    if is_stream || std::fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        let mut out = io::BufWriter::new(std::fs::OpenOptions::new().write(true).open(path)?);
        return body(&mut out).and_then(|()| out.flush());
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // The mode of a new file, less the umask; temporary files are private.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    // The error without the name of the temporary file.
    let file = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
    let mut out = io::BufWriter::new(file);
    body(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::write_file;

    #[test]
    fn a_new_file_in_shared_memory_is_no_stream() {
        // Where the system has no shared memory, there is nothing to write to.
        let Ok(folder) = tempfile::tempdir_in("/dev/shm") else { return };
        let path = folder.path().join("x.csv");
        write_file(&path, |out| out.write_all(b"x")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"x");
    }
}
