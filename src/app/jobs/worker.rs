//! Work that is not done on the window's thread: waiting for dialogs, reading, fitting.
//!
//! Jobs and results are values. Each job has a flag to stop it, and wakes the window when there is something to see; results of a job
//! that was replaced meanwhile are dropped by its number.

use crate::app::jobs::kind::JobKind;
use crate::app::shell::benchmarks::{BenchmarkId, BenchmarkResult};
use crate::app::shell::file_dialogs::{FileReply, FileRequest};
use crate::app::shell::import_dialog::Origin;
use crate::app::storage::export::{ExportKind, Write};
use crate::app::storage::import;
use crate::app::storage::import::{Hashing, Loaded, with_notes};
use crate::app::storage::session::{RestoredFit, SavedFit, Session};
use crate::app::text::i18n::phrase;
use crate::app::text::messages::Localized as _;
use crate::app::work::document::{Document, Mask};
use crate::app::work::model_fit::ModelFit;
use crate::open_file::open_file;
use crate::write_file::write_file;
use pbrdf::fit::{BootstrapEstimate, FitResult, Observer, Problem, ProblemError, Profile, Starts, TracePoint, fit};
use pbrdf::fit::{bootstrap, profile};
use pbrdf::measurement::Measurement;
use pbrdf::measurement::formats::{ForeignFile, ImportError, ImportOptions, Imported};
use pbrdf::model::{Parameter, Preset};
use pbrdf::selftest::Host;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tr::tr;

/// What a job has come to.
pub enum Event {
    /// A path was chosen in a dialog, or none.
    Answered(FileRequest, FileReply),
    /// A measurement was written there, or why not.
    Saved(Result<PathBuf, String>),
    /// An export was written there, or why not.
    Exported(ExportKind, Result<PathBuf, String>),
    /// The working state was written, or why not.
    Autosaved(Result<(), String>),
    /// A session was read, or why not.
    SessionRead {
        path: PathBuf,
        result: Result<Box<OpenedSession>, String>,
    },
    /// A file was read, or why not, as a sentence.
    Loaded {
        origin: Origin,
        result: Result<Loaded, String>,
    },
    /// A foreign file was read as it was chosen, or why not, as a phrase.
    ImportResult(Result<Imported, ImportError>),
    Fitted {
        report: Box<FitResult>,
        problem: Arc<Problem>,
        generation: u64,
        mask: Mask,
    },
    /// A fit from the sliders while they move.
    Refitted(Box<FitResult>),
    /// The ladder of models.
    Compared(Vec<ModelFit>),
    Profiled(Profile),
    /// A report of the program about itself, and whether it was stopped before its end.
    Reported {
        made: Box<BenchmarkResult>,
        is_part: bool,
    },
    /// How the parameters scatter over so many data sets.
    Scattered {
        replicates: usize,
        scatter: Vec<BootstrapEstimate>,
    },
    /// A job panicked: there is nothing else to hear of it.
    Broken(JobKind),
}

/// A session with its fits made again, the newest first.
pub struct OpenedSession {
    pub session: Session,
    pub fits: Vec<RestoredFit>,
}

impl OpenedSession {
    /// Reads a session; the error is a sentence.
    pub fn read(path: &Path) -> Result<Self, String> {
        let mut text = String::new();
        let said = |reason: &dyn std::fmt::Display| tr!("{0}: {1}.", path.display(), phrase(reason));
        let mut file = open_file(path).map_err(|reason| said(&reason.localized()))?;
        file.read_to_string(&mut text).map_err(|error| said(&tr!("the file cannot be read: {}", error.localized())))?;
        let session = Session::read(&text).map_err(|error| said(&error))?;
        Ok(Self::new(session))
    }

    /// With the fits made again that its data still allow.
    pub fn new(session: Session) -> Self {
        let again = |recipe: &SavedFit| recipe.again(session.measurement.as_ref()?);
        let fits = session.fits.iter().filter_map(again).collect();
        Self { session, fits }
    }
}

/// A job on its way.
pub struct Job<P> {
    number: u64,
    stop: Arc<AtomicBool>,
    progress: Arc<Mutex<Option<P>>>,
}

impl<P: Copy> Job<P> {
    /// How far it is.
    pub fn progress(&self) -> Option<P> {
        // A job that panicked while telling has nothing more to tell.
        self.progress.lock().ok().and_then(|progress| *progress)
    }

    /// Asks it to stop.
    pub fn cancel(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// How often a running job wakes the window.
const WAKE_EVERY: Duration = Duration::from_millis(60);

/// Runs jobs and collects their results.
pub struct Worker {
    ctx: egui::Context,
    sender: SyncSender<(u64, Event)>,
    receiver: Receiver<(u64, Event)>,
    jobs: u64,
    pub fit: Option<Job<TracePoint>>,
    pub load: Option<Job<f64>>,
    pub refit: Option<Job<()>>,
    pub comparison: Option<Job<&'static str>>,
    pub save: Option<Job<()>>,
    pub export: Option<Job<()>>,
    pub autosave: Option<Job<()>>,
    pub session: Option<Job<()>>,
    pub scan: Option<Job<()>>,
    dialog: Option<u64>,
    /// Asks for a path; no dialog where there is nobody to answer it.
    pub ask: fn(FileRequest) -> FileReply,
}

/// What a job tells its progress to.
struct ProgressSender<P> {
    ctx: egui::Context,
    progress: Arc<Mutex<Option<P>>>,
    last: Mutex<Instant>,
}

/// Sends what a job has come to and wakes the window, also when the job panics.
struct Completion {
    ctx: egui::Context,
    sender: SyncSender<(u64, Event)>,
    number: u64,
    task: JobKind,
    event: Option<Event>,
}

impl Drop for Completion {
    fn drop(&mut self) {
        let event = self.event.take().unwrap_or(Event::Broken(self.task));
        // The window may be gone.
        let _ = self.sender.send((self.number, event));
        self.ctx.request_repaint();
    }
}

impl<P> ProgressSender<P> {
    fn tell(&self, progress: P) {
        if let (Ok(mut slot), Ok(mut last)) = (self.progress.lock(), self.last.lock()) {
            *slot = Some(progress);
            if last.elapsed() >= WAKE_EVERY {
                *last = Instant::now();
                self.ctx.request_repaint();
            }
        }
    }
}

impl Worker {
    pub fn new(ctx: &egui::Context) -> Self {
        let (sender, receiver) = sync_channel(16);
        Self {
            ctx: ctx.clone(),
            sender,
            receiver,
            jobs: 0,
            fit: None,
            load: None,
            refit: None,
            comparison: None,
            save: None,
            export: None,
            autosave: None,
            session: None,
            scan: None,
            dialog: None,
            ask: |_| Ok(None),
        }
    }

    /// Begins a job on a thread of its own; none if the machine refuses a thread.
    fn spawn<P: Send + 'static>(
        &mut self,
        task: JobKind,
        body: impl FnOnce(&ProgressSender<P>, &AtomicBool) -> Event + Send + 'static,
    ) -> Result<Job<P>, String> {
        self.jobs += 1;
        let number = self.jobs;
        let job = Job { number, stop: Arc::default(), progress: Arc::new(Mutex::new(None)) };
        let teller = ProgressSender { ctx: self.ctx.clone(), progress: job.progress.clone(), last: Mutex::new(Instant::now()) };
        let (ctx, sender, stop) = (self.ctx.clone(), self.sender.clone(), job.stop.clone());
        #[cfg(test)]
        let language = crate::app::text::i18n::current();
        let run = move || {
            // Each thread of a test has a language of its own.
            #[cfg(test)]
            crate::app::text::i18n::set(language);
            let mut ending = Completion { ctx, sender, number, task, event: None };
            ending.event = Some(body(&teller, &stop));
        };
        match std::thread::Builder::new().name(task.name().to_owned()).spawn(run) {
            Ok(_) => Ok(job),
            Err(error) => Err(tr!("The job cannot be started: {}.", error.localized())),
        }
    }

    /// Whether a dialog of the desktop is open.
    pub fn is_asking(&self) -> bool {
        self.dialog.is_some()
    }

    /// Asks the desktop, one question at a time.
    pub fn ask(&mut self, question: FileRequest) -> Result<(), String> {
        if self.dialog.is_none() {
            let ask = self.ask;
            let job: Job<()> = self.spawn(JobKind::Dialog, move |_, _| Event::Answered(question.clone(), ask(question)))?;
            self.dialog = Some(job.number);
        }
        Ok(())
    }

    /// Writes an export, one at a time.
    pub fn export(&mut self, what: ExportKind, path: PathBuf, write: Write) -> Result<(), String> {
        if self.export.is_some() {
            return Err(tr!("The export before this one is still being written."));
        }
        let job = self.spawn(JobKind::Export, move |_: &ProgressSender<()>, _| Event::Exported(what, write(&path).map(|()| path)))?;
        self.export = Some(job);
        Ok(())
    }

    /// Writes the working state.
    pub fn autosave(&mut self, path: PathBuf, session: Session) -> Result<(), String> {
        let job = self.spawn(JobKind::Autosave, move |_: &ProgressSender<()>, _| Event::Autosaved(save_session(&path, &session)))?;
        self.autosave = Some(job);
        Ok(())
    }

    /// Reads a session.
    pub fn open_session(&mut self, path: PathBuf) -> Result<(), String> {
        self.abandon_load();
        let job = self.spawn(JobKind::ReadSession, move |_: &ProgressSender<()>, _| {
            let result = OpenedSession::read(&path).map(Box::new);
            Event::SessionRead { path, result }
        })?;
        self.session = Some(job);
        Ok(())
    }

    /// Writes a measurement in one move; one at a time, so that the last one asked for is the last one written.
    pub fn save(&mut self, path: PathBuf, measurement: Arc<Measurement>) -> Result<(), String> {
        if self.save.is_some() {
            return Err(tr!("The measurement is still being saved."));
        }
        let job = self.spawn(JobKind::Save, move |_: &ProgressSender<()>, _| {
            let written = write_file(&path, |out| measurement.write(out));
            Event::Saved(match written {
                Ok(()) => Ok(path),
                Err(error) => Err(tr!("{0} cannot be written: {1}.", path.display(), error.localized())),
            })
        })?;
        self.save = Some(job);
        Ok(())
    }

    /// Reads a file.
    pub fn open(&mut self, path: PathBuf) -> Result<(), String> {
        let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        self.read(name, Some(path.clone()), move || {
            let file = open_file(&path).map_err(|reason| tr!("{0}: {1}.", path.display(), reason.localized()))?;
            let length = file.metadata().ok().map(|data| data.len());
            Ok((path, file, length))
        })
    }

    /// Reads a text that is at hand.
    pub fn open_text(&mut self, name: String, text: &'static str) -> Result<(), String> {
        let path = PathBuf::from(&name);
        self.read(name, None, move || Ok((path, text.as_bytes(), None)))
    }

    fn read<R: Read>(
        &mut self,
        name: String,
        path: Option<PathBuf>,
        source: impl FnOnce() -> Result<(PathBuf, R, Option<u64>), String> + Send + 'static,
    ) -> Result<(), String> {
        self.abandon_load();
        // A session that is still being read is not wanted any more.
        self.session = None;
        let job = self.spawn(JobKind::Read, move |teller: &ProgressSender<f64>, stop| {
            let mut progress = while_reading(teller, stop);
            let mut sha256 = None;
            let result = source().and_then(|(at, source, length)| {
                let mut source = Hashing::new(source);
                let said = |reason: &dyn std::fmt::Display| tr!("{0}: {1}.", at.display(), phrase(reason));
                let bytes = import::bytes_of(&mut source, length, &mut progress).map_err(|error| said(&error))?;
                sha256 = Some(source.finish());
                import::read(bytes, &mut progress).map_err(|reason| said(&reason))
            });
            let sha256 = sha256.filter(|_| path.is_some());
            Event::Loaded { origin: Origin { name, path, sha256 }, result }
        })?;
        self.load = Some(job);
        Ok(())
    }

    /// Reads a foreign file, which is in memory, as it was chosen.
    pub fn import(&mut self, file: Arc<dyn ForeignFile>, options: ImportOptions) -> Result<(), String> {
        self.abandon_load();
        let job = self.spawn(JobKind::ImportDialog, move |teller: &ProgressSender<f64>, stop| {
            let imported = file.import(&options, &mut while_reading(teller, stop));
            Event::ImportResult(imported.map(|imported| with_notes(&*file, imported)))
        })?;
        self.load = Some(job);
        Ok(())
    }

    /// Stops reading; what was read is not wanted any more.
    pub fn abandon_load(&mut self) {
        if let Some(job) = self.load.take() {
            job.cancel();
        }
    }

    /// Fits a document as it is, from so many starts.
    pub fn start_fit(&mut self, problem: Problem, document: &Document, starts: Starts, seed: u64) -> Result<(), String> {
        if let Some(job) = self.fit.take() {
            job.cancel();
        }
        let (generation, mask) = (document.generation, document.mask().clone());
        let job = self.spawn(JobKind::Fit, move |teller: &ProgressSender<TracePoint>, stop| {
            let begun = Instant::now();
            let watch = Observer {
                clock: &|| begun.elapsed().as_secs_f64() * 1e3,
                cancelled: &|| stop.load(Ordering::Relaxed),
                progress: &|point| teller.tell(point),
            };
            let report = Box::new(fit(&problem, starts, seed, watch));
            Event::Fitted { report, problem: Arc::new(problem), generation, mask }
        })?;
        self.fit = Some(job);
        Ok(())
    }

    /// Fits from the sliders alone, for a window that follows while they move.
    pub fn start_refit(&mut self, problem: Problem) -> Result<(), String> {
        let job = self.spawn(JobKind::Refit, move |_: &ProgressSender<()>, stop| {
            let watch = Observer { cancelled: &|| stop.load(Ordering::Relaxed), ..Observer::NONE };
            Event::Refitted(Box::new(fit(&problem, Starts::One, 0, watch)))
        })?;
        self.refit = Some(job);
        Ok(())
    }

    /// Fits several models, one after the other; those without a problem go along with the reason.
    pub fn start_comparison(
        &mut self,
        problems: Vec<(&'static Preset, Result<Problem, ProblemError>)>,
        starts: Starts,
        seed: u64,
    ) -> Result<(), String> {
        let job = self.spawn(JobKind::Compare, move |teller: &ProgressSender<&'static str>, stop| {
            let mut rungs = Vec::new();
            for (preset, problem) in problems {
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                teller.tell(preset.name);
                let begun = Instant::now();
                let watch = Observer {
                    clock: &|| begun.elapsed().as_secs_f64() * 1e3,
                    cancelled: &|| stop.load(Ordering::Relaxed),
                    ..Observer::NONE
                };
                rungs.push(ModelFit { preset, result: problem.map(|problem| Box::new(fit(&problem, starts, seed, watch))) });
            }
            Event::Compared(rungs)
        })?;
        self.comparison = Some(job);
        Ok(())
    }

    /// Diagnostics a parameter of a finished fit.
    pub fn start_profile(&mut self, problem: Problem, report: FitResult, parameter: Parameter) -> Result<(), String> {
        self.scan(JobKind::Profile, move |watch| Event::Profiled(profile(&problem, &report, parameter, watch)))
    }

    /// Fits the data of a finished fit again with its residuals dealt out anew.
    pub fn start_bootstrap(&mut self, problem: Problem, report: FitResult, replicates: usize, seed: u64) -> Result<(), String> {
        let run =
            move |watch: Observer<'_>| Event::Scattered { replicates, scatter: bootstrap(&problem, &report, replicates, seed, watch) };
        self.scan(JobKind::Bootstrap, run)
    }

    fn scan(&mut self, task: JobKind, run: impl FnOnce(Observer<'_>) -> Event + Send + 'static) -> Result<(), String> {
        if let Some(job) = self.scan.take() {
            job.cancel();
        }
        let job = self.spawn(task, move |_: &ProgressSender<()>, stop| {
            run(Observer { cancelled: &|| stop.load(Ordering::Relaxed), ..Observer::NONE })
        })?;
        self.scan = Some(job);
        Ok(())
    }

    /// Makes a report; the caller keeps its job.
    pub fn start_report(&mut self, subject: BenchmarkId) -> Result<Job<f64>, String> {
        self.spawn(JobKind::Report, move |teller: &ProgressSender<f64>, stop| {
            let begun = Instant::now();
            let surroundings = Host {
                clock: &|| begun.elapsed().as_secs_f64() * 1e3,
                cancelled: &|| stop.load(Ordering::Relaxed),
                progress: &|done| teller.tell(done),
            };
            let made = Box::new(subject.make(surroundings));
            Event::Reported { made, is_part: stop.load(Ordering::Relaxed) }
        })
    }

    /// Stops a scan whose fit is not shown any more.
    pub fn abandon_scan(&mut self) {
        if let Some(job) = self.scan.take() {
            job.cancel();
        }
    }

    /// Stops all work on the measurement that is being replaced; what it still sends is dropped by its number.
    pub fn abandon(&mut self) {
        if let Some(job) = self.fit.take() {
            job.cancel();
        }
        if let Some(job) = self.refit.take() {
            job.cancel();
        }
        if let Some(job) = self.comparison.take() {
            job.cancel();
        }
        self.abandon_scan();
    }

    /// The next result that still matters.
    pub fn next(&mut self) -> Option<Event> {
        while let Ok((number, event)) = self.receiver.try_recv() {
            let matters = match event {
                Event::Exported(..) => self.export.take_if(|job| job.number == number).is_some(),
                Event::Autosaved(_) => self.autosave.take_if(|job| job.number == number).is_some(),
                Event::SessionRead { .. } => self.session.take_if(|job| job.number == number).is_some(),
                Event::Answered(..) => self.dialog.take_if(|dialog| *dialog == number).is_some(),
                Event::Profiled(_) | Event::Scattered { .. } => self.scan.take_if(|job| job.number == number).is_some(),
                // One at a time, and never replaced: each one matters.
                Event::Reported { .. } => true,
                Event::Saved(_) => self.save.take_if(|job| job.number == number).is_some(),
                Event::Loaded { .. } | Event::ImportResult(_) => self.load.take_if(|job| job.number == number).is_some(),
                Event::Refitted(_) => self.refit.take_if(|job| job.number == number).is_some(),
                Event::Compared(_) => self.comparison.take_if(|job| job.number == number).is_some(),
                Event::Fitted { .. } => self.fit.take_if(|job| job.number == number).is_some(),
                Event::Broken(task) => self.is_missed(task, number),
            };
            if matters {
                return Some(event);
            }
        }
        None
    }

    /// Whether somebody waits for the job of that number, which will not answer; nobody does any more.
    fn is_missed(&mut self, task: JobKind, number: u64) -> bool {
        fn is_missed<P>(slot: &mut Option<Job<P>>, number: u64) -> bool {
            slot.take_if(|job| job.number == number).is_some()
        }
        match task {
            JobKind::Dialog => self.dialog.take_if(|dialog| *dialog == number).is_some(),
            JobKind::Read | JobKind::ImportDialog => is_missed(&mut self.load, number),
            JobKind::ReadSession => is_missed(&mut self.session, number),
            JobKind::Save => is_missed(&mut self.save, number),
            JobKind::Export => is_missed(&mut self.export, number),
            JobKind::Autosave => is_missed(&mut self.autosave, number),
            JobKind::Fit => is_missed(&mut self.fit, number),
            JobKind::Refit => is_missed(&mut self.refit, number),
            JobKind::Compare => is_missed(&mut self.comparison, number),
            JobKind::Profile | JobKind::Bootstrap => is_missed(&mut self.scan, number),
            // Kept by who asked for it.
            JobKind::Report => true,
        }
    }

    /// Begins a job that panics.
    #[cfg(test)]
    pub fn start_broken<P: Send + 'static>(&mut self, task: JobKind) -> Job<P> {
        self.spawn(task, |_: &ProgressSender<P>, _| std::panic::panic_any("on purpose")).expect("a thread")
    }

    /// Whether a job is on its way.
    #[cfg(test)]
    pub fn is_busy(&self) -> bool {
        self.fit.is_some()
            || self.load.is_some()
            || self.save.is_some()
            || self.export.is_some()
            || self.autosave.is_some()
            || self.session.is_some()
            || self.dialog.is_some()
            || self.scan.is_some()
            || self.refit.is_some()
            || self.comparison.is_some()
    }
}

/// Writes a session in one move; the error is a sentence.
pub fn save_session(path: &Path, session: &Session) -> Result<(), String> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let written = std::fs::create_dir_all(folder).and_then(|()| write_file(path, |out| session.write(out)));
    written.map_err(|error| tr!("{0} cannot be written: {1}.", path.display(), error.localized()))
}

/// Tells how much is read, and stops when asked to.
fn while_reading(teller: &ProgressSender<f64>, stop: &AtomicBool) -> impl FnMut(f64) -> ControlFlow<()> {
    move |done| {
        teller.tell(done);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
