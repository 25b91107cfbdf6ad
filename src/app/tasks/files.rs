//! Jobs that read and write files, and wait for file dialogs.

use crate::app::jobs::job::{Job, JobContext};
#[cfg(test)]
use crate::app::jobs::slot::AnySlot;
use crate::app::jobs::slot::Slot;
use crate::app::jobs::spawner::Spawner;
use crate::app::storage::export::{ExportKind, Write};
use crate::app::storage::folder::measurements_in;
use crate::app::storage::import;
use crate::app::storage::import::{Hashing, Loaded, Origin, with_notes};
use crate::app::storage::kept_work::KeptWork;
use crate::app::storage::session::Session;
use crate::app::storage::session_file::{OpenedSession, save_session};
use crate::app::storage::share_link::OpenedLink;
use crate::app::tasks::file_request::{FileReply, FileRequest};
use crate::app::tasks::start_error::start_error;
use crate::app::text::localized::Localized as _;
use crate::app::text::messages::advised;
use crate::app::work::import_memory::{KeptAnswers, TableShape};
use crate::files::disk;
use crate::files::open_file::open_file;
use crate::files::write_file::write_file;
use pbrdf::measurement::foreign::TableOptions;
use pbrdf::measurement::formats::{ForeignFile, ImportError, ImportOptions, Imported};
use pbrdf::measurement::{Measurement, Progress};
use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tr::tr;

/// The answer of a dialog.
pub struct DialogAnswer {
    pub request: FileRequest,
    pub reply: FileReply,
}

/// What a file holds; the error is a sentence.
pub struct LoadedFile {
    pub origin: Origin,
    pub result: Result<Loaded, String>,
}

/// A foreign file with its cells read as those options ask.
pub struct Reopened {
    pub options: TableOptions,
    /// None where they were read so.
    pub file: Result<Option<Box<dyn ForeignFile>>, ImportError>,
}

/// Files that have the shape of another one.
pub struct Alike {
    pub of: PathBuf,
    pub paths: Vec<PathBuf>,
}

/// Files that are open, or are going to be.
pub struct WithoutFiles {
    pub paths: Vec<PathBuf>,
    /// Of their bytes.
    pub sha256: Vec<String>,
}

/// The session of a file; the error is a sentence.
pub struct LoadedSession {
    pub path: PathBuf,
    pub result: Result<Box<OpenedSession>, String>,
}

/// The file of an export; the error is a sentence.
pub struct ExportedFile {
    pub kind: ExportKind,
    /// Of the work that it is of.
    pub revision: u64,
    pub result: Result<PathBuf, String>,
}

/// Slots of the jobs around files.
pub struct FileJobs {
    spawner: Spawner,
    /// Asks for a path; tests answer without a dialog.
    pub ask: fn(FileRequest) -> FileReply,
    pub dialog: Slot<DialogAnswer>,
    /// Reads files or an example; the progress is a fraction.
    pub load: Slot<Vec<LoadedFile>, f64>,
    /// Files that are read after those that are being read.
    pub waiting: Vec<PathBuf>,
    /// Reads a foreign file with the user's options; the progress is a fraction.
    pub import: Slot<Result<Imported, ImportError>, f64>,
    /// Reads the cells of a foreign file anew.
    pub reopen: Slot<Reopened>,
    /// Looks through a folder for files that the answers of the dialog may be for.
    pub alike: Slot<Alike>,
    pub session: Slot<LoadedSession>,
    /// Reads a link; the error is a sentence.
    pub link: Slot<Result<Box<OpenedLink>, String>>,
    /// Writes the measurement; the error is a sentence.
    pub save: Slot<Result<PathBuf, String>>,
    pub export: Slot<ExportedFile>,
    /// Writes the work that is kept without being asked, and looks at that of earlier runs; the error
    /// is a sentence.
    pub autosave: Slot<Result<Vec<KeptWork>, String>>,
}

impl FileJobs {
    pub fn new(spawner: Spawner) -> Self {
        Self {
            spawner,
            ask: |_| Ok(Vec::new()),
            dialog: Slot::default(),
            load: Slot::default(),
            waiting: Vec::new(),
            import: Slot::default(),
            reopen: Slot::default(),
            alike: Slot::default(),
            session: Slot::default(),
            link: Slot::default(),
            save: Slot::default(),
            export: Slot::default(),
            autosave: Slot::default(),
        }
    }

    /// Every slot.
    #[cfg(test)]
    pub fn slots(&mut self) -> Vec<&mut dyn AnySlot> {
        let Self { spawner: _, ask: _, waiting: _, dialog, load, import, reopen, alike, session, link, save, export, autosave } = self;
        vec![dialog, load, import, reopen, alike, session, link, save, export, autosave]
    }

    /// Asks the user for a path, unless a dialog is open.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn ask(&mut self, request: FileRequest) -> Result<(), String> {
        if self.dialog.is_running() {
            return Ok(());
        }
        let ask = self.ask;
        self.dialog
            .start(&self.spawner, "dialog", move |_| DialogAnswer { request: request.clone(), reply: ask(request) })
            .map_err(start_error)
    }

    /// Reads files, one after the other.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn open(&mut self, paths: Vec<PathBuf>) -> Result<(), String> {
        self.abandon_reading();
        self.load.start(&self.spawner, "read measurements", move |context| read_files(&paths, None, context)).map_err(start_error)
    }

    /// Reads foreign files of one shape with the answers that one of them was opened with.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn open_alike(&mut self, paths: Vec<PathBuf>, answers: KeptAnswers) -> Result<(), String> {
        self.abandon_reading();
        let job = move |context: &JobContext<f64>| read_files(&paths, Some(&answers), context);
        self.load.start(&self.spawner, "read alike", job).map_err(start_error)
    }

    /// Reads the cells of a foreign file, which is in memory, as those options ask.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn reopen(&mut self, file: Arc<dyn ForeignFile>, options: TableOptions) -> Result<(), String> {
        let job = move |context: &JobContext| {
            let mut progress = |_| if context.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
            let file = file.reopened(&options, &mut progress);
            Reopened { options, file }
        };
        self.reopen.start(&self.spawner, "read cells", job).map_err(start_error)
    }

    /// Looks in the folder of a foreign file for others of its shape, beside those that are left out.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn find_alike(&mut self, of: PathBuf, shape: TableShape, without: WithoutFiles) -> Result<(), String> {
        let job = move |context: &JobContext| Alike { paths: alike(&of, &shape, &without, context), of };
        self.alike.start(&self.spawner, "look for alike", job).map_err(start_error)
    }

    /// Stops what is done for the questions on screen.
    pub fn abandon_dialog(&mut self) {
        self.reopen.abandon();
        self.alike.abandon();
    }

    /// Reads a text that is in memory.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn open_text(&mut self, name: String, text: &'static str) -> Result<(), String> {
        self.abandon_reading();
        let job = move |context: &JobContext<f64>| {
            let mut progress = reading_progress(context);
            let (at, source) = (PathBuf::from(&name), text.as_bytes());
            vec![read(name, None, Ok((&at, source, None)), None, &mut progress)]
        };
        self.load.start(&self.spawner, "read example", job).map_err(start_error)
    }

    /// Whether files or a session are being read: further files wait.
    pub fn is_reading(&self) -> bool {
        self.load.is_running() || self.import.is_running() || self.session.is_running() || self.link.is_running()
    }

    /// Reads a foreign file, which is in memory, with the user's options.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn import(&mut self, file: Arc<dyn ForeignFile>, options: ImportOptions) -> Result<(), String> {
        self.abandon_load();
        let job = move |context: &JobContext<f64>| {
            let imported = file.import(&options, &mut reading_progress(context));
            imported.map(|imported| with_notes(&*file, imported))
        };
        self.import.start(&self.spawner, "import measurement", job).map_err(start_error)
    }

    /// Reads a session.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn open_session(&mut self, path: PathBuf) -> Result<(), String> {
        self.abandon_reading();
        let job = move |_: &JobContext| {
            let result = OpenedSession::read(&path).map(Box::new);
            LoadedSession { path, result }
        };
        self.session.start(&self.spawner, "read session", job).map_err(start_error)
    }

    /// Reads the link in a text.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn open_link(&mut self, text: String) -> Result<(), String> {
        self.abandon_reading();
        let job = move |_: &JobContext| OpenedLink::read(&text).map(Box::new);
        self.link.start(&self.spawner, "read link", job).map_err(start_error)
    }

    /// Writes a measurement in one move. One job at a time: the last order is the last one written.
    ///
    /// # Errors
    /// A measurement is still being written, or the job does not start; a sentence.
    pub fn save(&mut self, path: PathBuf, measurement: Arc<Measurement>) -> Result<(), String> {
        if self.save.is_running() {
            return Err(tr!("The measurement is still being saved."));
        }
        let job = move |_: &JobContext| match write_file(&path, |out| measurement.write(out)) {
            Ok(()) => Ok(path),
            Err(error) => Err(tr!("{0} cannot be written: {1}.", path.display(), error.localized())),
        };
        self.save.start(&self.spawner, "save measurement", job).map_err(start_error)
    }

    /// Writes an export, one at a time.
    ///
    /// # Errors
    /// An export is still being written, or the job does not start; a sentence.
    pub fn export(&mut self, kind: ExportKind, revision: u64, path: PathBuf, write: Write) -> Result<(), String> {
        if self.export.is_running() {
            return Err(tr!("The export before this one is still being written."));
        }
        let job = move |_: &JobContext| ExportedFile { kind, revision, result: write(&path).map(|()| path) };
        self.export.start(&self.spawner, "export", job).map_err(start_error)
    }

    /// Writes the work that is kept without being asked, and looks at that of earlier runs.
    ///
    /// # Errors
    /// The job does not start; a sentence.
    pub fn autosave(
        &mut self,
        path: PathBuf,
        session: Session,
        kept: impl FnOnce() -> Vec<KeptWork> + Send + 'static,
    ) -> Result<(), String> {
        let job = move |_: &JobContext| save_session(&path, &session).map(|()| kept());
        self.autosave.start(&self.spawner, "autosave", job).map_err(start_error)
    }

    /// The fraction that is read of a measurement, while one is being read.
    pub fn reading_fraction(&self) -> Option<f64> {
        let fractions = [self.load.job().map(Job::progress), self.import.job().map(Job::progress)];
        fractions.into_iter().flatten().next().map(|fraction| fraction.unwrap_or(0.0))
    }

    /// Asks the job that reads a measurement to stop; it ends with an error.
    pub fn cancel_load(&mut self) {
        self.waiting.clear();
        self.load.cancel();
        self.import.cancel();
    }

    /// Stops reading a measurement.
    pub fn abandon_load(&mut self) {
        self.waiting.clear();
        self.load.abandon();
        self.import.abandon();
    }

    /// Stops reading measurements and sessions.
    pub fn abandon_reading(&mut self) {
        self.abandon_load();
        self.session.abandon();
        self.link.abandon();
    }
}

/// The files, until the reading is cancelled.
fn read_files(paths: &[PathBuf], answers: Option<&KeptAnswers>, context: &JobContext<f64>) -> Vec<LoadedFile> {
    let mut files = Vec::new();
    for path in paths {
        #[expect(clippy::cast_precision_loss, reason = "a number of files")]
        let (before, of) = (files.len() as f64, paths.len() as f64);
        let mut progress = |done: f64| {
            context.report((before + done) / of);
            if context.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        let source = open_file(path).map_err(|reason| tr!("{0}: {1}.", path.display(), reason.localized()));
        let source = source.map(|file| {
            let length = disk::length(&file);
            (path.as_path(), file, length)
        });
        files.push(read(name, Some(path.clone()), source, answers, &mut progress));
        if context.is_cancelled() {
            break;
        }
    }
    files
}

/// Bytes of a file that is looked at for its shape; a larger one is left to be opened by itself.
const MOST_BYTES_OF_ALIKE: u64 = 64 << 20;

/// The files beside that one, with the same ending, that are tables of its shape.
fn alike(of: &Path, shape: &TableShape, without: &WithoutFiles, context: &JobContext) -> Vec<PathBuf> {
    let ending = |path: &Path| path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
    let files = of.parent().and_then(|folder| measurements_in(folder).ok()).unwrap_or_default();
    let is_candidate = |path: &PathBuf| path != of && ending(path) == ending(of) && !without.paths.contains(path);
    let mut progress = |_| if context.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let mut found = Vec::new();
    for path in files.into_iter().filter(is_candidate) {
        if context.is_cancelled() {
            break;
        }
        let file = open_file(&path).ok().filter(|file| disk::length(file).is_some_and(|bytes| bytes <= MOST_BYTES_OF_ALIKE));
        let Some(mut source) = file.map(Hashing::new) else { continue };
        let bytes = import::bytes_of(&mut source, None, &mut progress).ok();
        let bytes = bytes.filter(|_| !without.sha256.contains(&source.finish()));
        if let Some(Ok(Loaded::Foreign(file))) = bytes.map(|bytes| import::read(bytes, "", None, &mut progress))
            && TableShape::of(&file.questions()).as_ref() == Some(shape)
        {
            found.push(path);
        }
    }
    found
}

/// A measurement out of a source at that path, of that length.
fn read<R: Read>(
    name: String,
    path: Option<PathBuf>,
    source: Result<(&Path, R, Option<u64>), String>,
    answers: Option<&KeptAnswers>,
    progress: Progress<'_>,
) -> LoadedFile {
    let mut sha256 = None;
    let result = source.and_then(|(at, source, length)| {
        let mut source = Hashing::new(source);
        let sentence = |reason: String| tr!("{0}: {1}.", at.display(), reason);
        let bytes = import::bytes_of(&mut source, length, progress).map_err(|error| sentence(error.localized()))?;
        sha256 = Some(source.finish());
        import::read(bytes, &name, answers, progress).map_err(|error| sentence(advised(&error, error.hint())))
    });
    let sha256 = sha256.filter(|_| path.is_some());
    LoadedFile { origin: Origin { name, path, sha256 }, result }
}

/// Reports the fraction that is read; breaks where the job is cancelled.
fn reading_progress(context: &JobContext<f64>) -> impl FnMut(f64) -> ControlFlow<()> {
    |done| {
        context.report(done);
        if context.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
