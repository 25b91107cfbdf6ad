//! Reads a file into a measurement, or into a foreign file that has questions.

use crate::files::export;
use pbrdf::measurement::formats::{self, ForeignFile, ImportError, ImportOptions, Imported, Opened};
use pbrdf::measurement::{Progress, ReadError, ReadErrorKind};
use sha2::{Digest as _, Sha256};
use std::io::Read;
use std::path::PathBuf;
use std::sync::Arc;

/// Where a measurement comes from.
#[derive(Debug, Clone)]
pub struct Origin {
    pub name: String,
    /// The file, if there is one.
    pub path: Option<PathBuf>,
    /// SHA-256 of its bytes, of a file.
    pub sha256: Option<String>,
}

/// What came out of a file.
pub enum Loaded {
    Measurement(Box<Imported>),
    /// A file with questions; shared with jobs.
    Foreign(Arc<dyn ForeignFile>),
}

/// Bytes between two reports of progress.
const CHUNK: usize = 1 << 20;

/// A reader that hashes the bytes that it hands on.
pub struct Hashing<R> {
    source: R,
    hash: Sha256,
}

impl<R> Hashing<R> {
    pub fn new(source: R) -> Self {
        Self { source, hash: Sha256::new() }
    }

    /// SHA-256 of the bytes, hexadecimal.
    pub fn finish(self) -> String {
        export::hexadecimal(&self.hash.finalize())
    }
}

impl<R: Read> Read for Hashing<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.source.read(buffer)?;
        self.hash.update(&buffer[..read]);
        Ok(read)
    }
}

/// All bytes of a source of that length; `progress` may stop the reading.
pub fn bytes_of(mut source: impl Read, length: Option<u64>, progress: Progress<'_>) -> Result<Vec<u8>, ReadError> {
    let anywhere = |kind| ReadError { line: None, column: None, kind };
    let mut bytes = Vec::new();
    loop {
        let read = source.by_ref().take(CHUNK as u64).read_to_end(&mut bytes).map_err(|error| anywhere(ReadErrorKind::Io(error)))?;
        #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress bar")]
        let done = length.map_or(0.0, |length| (bytes.len() as f64 / length.max(1) as f64).min(1.0));
        if progress(done).is_break() {
            return Err(anywhere(ReadErrorKind::Cancelled));
        }
        if read < CHUNK {
            return Ok(bytes);
        }
    }
}

/// Reads the bytes of a file; a foreign file without questions is imported at once.
pub fn read(bytes: Vec<u8>, progress: Progress<'_>) -> Result<Loaded, ImportError> {
    match formats::open(bytes, progress)? {
        Opened::Measurements(measurements) => Ok(Loaded::Measurement(Box::new(Imported { measurements, notes: Vec::new() }))),
        Opened::Foreign(file) if file.questions().is_empty() => {
            file.import(&ImportOptions::default(), progress).map(|imported| Loaded::Measurement(Box::new(with_notes(&*file, imported))))
        }
        Opened::Foreign(file) => Ok(Loaded::Foreign(Arc::from(file))),
    }
}

/// The import with the notices of the file itself.
pub fn with_notes(file: &dyn ForeignFile, mut imported: Imported) -> Imported {
    imported.notes.extend(file.notes());
    imported
}
