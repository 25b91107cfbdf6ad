//! The files of the system.

use std::fs::File;
use std::io;
use std::path::Path;
use std::time::SystemTime;
#[cfg(feature = "gui")]
use std::{fs::TryLockError, path::PathBuf, time::UNIX_EPOCH};

pub use std::fs::File as OpenedFile;

#[cfg(feature = "gui")]
pub use std::fs::{create_dir_all, read, remove_file};

/// Another name for a file.
#[cfg(feature = "gui")]
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    std::fs::rename(from, to)
}

/// Opens a file for reading.
pub fn open(path: &Path) -> io::Result<OpenedFile> {
    File::open(path)
}

/// Bytes of an opened file, where they are known before it is read.
#[cfg(feature = "gui")]
pub fn length(file: &OpenedFile) -> Option<u64> {
    file.metadata().ok().map(|data| data.len())
}

/// Bytes of a file; none where there is no such file.
#[cfg(feature = "gui")]
pub fn length_at(path: &Path) -> Option<u64> {
    std::fs::metadata(path).ok().map(|data| data.len())
}

/// What a folder holds, with the time of the last change; nothing where it cannot be read.
#[cfg(feature = "gui")]
pub fn entries(folder: &Path) -> Vec<(PathBuf, SystemTime)> {
    let changed = |entry: &std::fs::DirEntry| entry.metadata().and_then(|metadata| metadata.modified()).unwrap_or(UNIX_EPOCH);
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| (entry.path(), changed(&entry))).collect()
}

/// A lock on a file: the system lets go of it when the program ends, also in a crash.
#[cfg(feature = "gui")]
#[derive(Debug)]
pub struct FileLock(#[expect(dead_code, reason = "held until it is dropped")] File);

/// Locks a file, which is made where it is not there; waits for others that ask about the lock.
#[cfg(feature = "gui")]
pub fn lock(path: &Path) -> io::Result<FileLock> {
    let file = File::create(path)?;
    file.lock()?;
    Ok(FileLock(file))
}

/// The same unless somebody else has the lock.
#[cfg(feature = "gui")]
pub fn try_lock(path: &Path) -> Option<FileLock> {
    let file = File::create(path).ok()?;
    file.try_lock().is_ok().then_some(FileLock(file))
}

/// Whether somebody has the lock. Asking takes a lock that does not stop others from asking.
#[cfg(feature = "gui")]
pub fn is_locked(path: &Path) -> bool {
    File::open(path).is_ok_and(|lock| matches!(lock.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// The clock of the wall.
pub fn now() -> SystemTime {
    SystemTime::now()
}
