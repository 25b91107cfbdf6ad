//! Reads a file into a measurement, or into a foreign file that has questions.

use crate::app::work::import_memory::KeptAnswers;
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

/// Reads the bytes of a file of that name; a foreign file without questions is imported at once, and one of a shape that was asked about
/// before with those answers.
pub fn read(bytes: Vec<u8>, name: &str, answers: Option<&KeptAnswers>, progress: Progress<'_>) -> Result<Loaded, ImportError> {
    let file = match formats::open(bytes, progress)? {
        Opened::Measurements(measurements) => {
            return Ok(Loaded::Measurement(Box::new(Imported { measurements, notes: Vec::new() })));
        }
        Opened::Foreign(file) => file,
    };
    let questions = file.questions();
    let imported = if questions.is_empty() {
        file.import(&ImportOptions::default(), progress)?
    } else if let Some(options) = answers.and_then(|answers| answers.of(&questions)) {
        let mut imported = file.import(&options, progress)?;
        note_source(&mut imported, name);
        imported
    } else {
        return Ok(Loaded::Foreign(Arc::from(file)));
    };
    Ok(Loaded::Measurement(Box::new(with_notes(&*file, imported))))
}

/// Writes into the metadata which file it was.
pub fn note_source(imported: &mut Imported, name: &str) {
    let source = ("imported_from".to_owned(), name.replace(char::is_control, " "));
    imported.measurements.iter_mut().for_each(|measurement| measurement.metadata.push(source.clone()));
}

/// The import with the notices of the file itself.
pub fn with_notes(file: &dyn ForeignFile, mut imported: Imported) -> Imported {
    imported.notes.extend(file.notes());
    imported
}
