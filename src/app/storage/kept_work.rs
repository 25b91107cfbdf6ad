//! The work of the last runs of the program, kept without being asked: every run writes a file of
//! its own, so that two windows at once and the next start write over nothing.
//!
//! Beside `NAME.pbrdf.json` lies `NAME.lock`, which the run that writes it holds locked. The system
//! lets go of it when the run ends, also in a crash: what nobody holds can be gone on with.

use crate::app::platform;
use crate::app::storage::settings_file::APP;
use crate::files::disk::{self, Lock};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

/// How a file of work ends.
const ENDING: &str = ".pbrdf.json";
/// Ended runs whose work is kept.
const MOST_KEPT: usize = 5;
/// Bytes of a file that is looked into for its names.
const MOST_BYTES: u64 = 20_000_000;

/// The folder with the work of the last runs.
#[derive(Debug, Clone)]
pub struct WorkFolder(PathBuf);

/// The file of the work of a run, which no other run takes while this lives.
#[derive(Debug)]
pub struct WorkFile {
    pub path: PathBuf,
    _lock: Lock,
}

/// The work of an earlier run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeptWork {
    pub path: PathBuf,
    /// When it was written last.
    pub changed: SystemTime,
    /// Of the measurements that are open in it.
    pub names: Vec<String>,
    /// How many fits it has.
    pub fits: usize,
}

/// What is read of a file to tell what it holds.
#[derive(Deserialize)]
struct Glance {
    #[serde(default)]
    measurements: Vec<GlanceAtMeasurement>,
    #[serde(default)]
    fits: Vec<IgnoredAny>,
}

#[derive(Deserialize)]
struct GlanceAtMeasurement {
    name: String,
    #[serde(default = "yes")]
    open: bool,
}

fn yes() -> bool {
    true
}

impl WorkFolder {
    pub fn new(folder: PathBuf) -> Self {
        Self(folder)
    }

    /// The user's, if the machine has a place for it.
    pub fn of_user() -> Option<Self> {
        platform::local_data_folder(APP).map(|folder| Self::new(folder.join("work")))
    }

    /// Takes in the one file that earlier releases kept, beside the folder.
    ///
    /// # Errors
    /// The file is there and cannot be moved, or the folder cannot be made.
    pub fn adopt_earlier(&self) -> io::Result<()> {
        disk::create_dir_all(&self.0)?;
        match disk::rename(&self.0.with_file_name("working.pbrdf.json"), &self.0.join("earlier.pbrdf.json")) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }

    /// A name that no run has yet. The file is written when there is something to keep.
    ///
    /// # Errors
    /// The folder cannot be made or takes no file.
    pub fn new_file(&self) -> io::Result<WorkFile> {
        static LAST: AtomicU64 = AtomicU64::new(0);
        disk::create_dir_all(&self.0)?;
        let time = disk::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_millis());
        let name = format!("{time}-{}-{}{ENDING}", process(), LAST.fetch_add(1, Ordering::Relaxed));
        let path = self.0.join(name);
        // Waits for somebody who may just be asking whether it is held.
        let lock = disk::lock(&lock_of(&path))?;
        Ok(WorkFile { path, _lock: lock })
    }

    /// The newest work of all, if no window shows it.
    pub fn take_newest(&self) -> Option<WorkFile> {
        let (path, _) = self.files().into_iter().next()?;
        disk::try_lock(&lock_of(&path)).map(|lock| WorkFile { path, _lock: lock })
    }

    /// The work of the last runs that have ended, the newest first, and that of these files.
    pub fn kept(&self, of_this_run: &[&Path]) -> Vec<KeptWork> {
        let is_listed = |path: &Path| of_this_run.contains(&path) || !is_in_use(path);
        let files = self.files().into_iter().filter(|(path, _)| is_listed(path)).take(MOST_KEPT);
        files.map(|(path, changed)| KeptWork::glance(path, changed)).collect()
    }

    /// Removes the oldest of the work that nobody shows, and what runs that kept nothing left.
    pub fn tidy(&self) {
        let ended = self.files().into_iter().filter(|(path, _)| !is_in_use(path));
        for (path, _) in ended.skip(MOST_KEPT) {
            let _ = disk::remove_file(&path);
        }
        let entries = disk::entries(&self.0).into_iter().map(|(path, _)| path);
        for lock in entries.filter(|path| path.extension().is_some_and(|extension| extension == "lock")) {
            let work = lock.with_extension(&ENDING[1..]);
            if disk::length_at(&work).is_none() && !is_in_use(&work) {
                let _ = disk::remove_file(&lock);
            }
        }
    }

    /// Every file of work with the time of its last change, the newest first.
    fn files(&self) -> Vec<(PathBuf, SystemTime)> {
        let is_work = |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(ENDING));
        let mut files = disk::entries(&self.0);
        files.retain(|(path, _)| is_work(path));
        // Names begin with the time of the run: they tell two of the same moment apart.
        files.sort_by(|(one, at), (other, other_at)| other_at.cmp(at).then_with(|| other.cmp(one)));
        files
    }
}

/// The lock of a file of work.
fn lock_of(path: &Path) -> PathBuf {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{}.lock", name.trim_end_matches(ENDING)))
}

/// Whether a window shows it.
fn is_in_use(path: &Path) -> bool {
    disk::is_locked(&lock_of(path))
}

/// A number that no other run of the same moment has.
fn process() -> u32 {
    // Pages have none: there the moment has to do.
    if cfg!(target_arch = "wasm32") { 0 } else { std::process::id() }
}

impl KeptWork {
    fn glance(path: PathBuf, changed: SystemTime) -> Self {
        let is_small = disk::length_at(&path).is_some_and(|length| length <= MOST_BYTES);
        let text = if is_small { disk::read(&path).unwrap_or_default() } else { Vec::new() };
        let glance = serde_json::from_slice(&text).unwrap_or(Glance { measurements: Vec::new(), fits: Vec::new() });
        let names = glance.measurements.into_iter().filter(|measurement| measurement.open).map(|measurement| measurement.name);
        Self { path, changed, names: names.collect(), fits: glance.fits.len() }
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST_KEPT, WorkFile, WorkFolder};
    use std::path::PathBuf;
    use std::time::{Duration, SystemTime};

    /// Files of as many runs, the newest last, each a second older than the next.
    fn runs(folder: &WorkFolder, count: u32) -> Vec<WorkFile> {
        let run = |i: u32| {
            let run = folder.new_file().expect("a folder to write in");
            let text = format!(r#"{{"measurements": [{{"name": "run {i}"}}, {{"name": "closed", "open": false}}], "fits": [{{}}]}}"#);
            std::fs::write(&run.path, text).expect("a file");
            let file = std::fs::File::options().write(true).open(&run.path).expect("the file");
            file.set_modified(SystemTime::now() - Duration::from_secs(u64::from(count - i))).expect("a clock");
            run
        };
        (0..count).map(run).collect()
    }

    fn names(folder: &WorkFolder, of_this_run: &[&std::path::Path]) -> Vec<String> {
        folder.kept(of_this_run).into_iter().flat_map(|work| work.names).collect()
    }

    #[test]
    fn work_in_use_is_neither_listed_nor_taken_and_comes_back_when_its_run_ends() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = WorkFolder::new(place.path().join("work"));
        let mut runs = runs(&folder, 3);
        assert!(names(&folder, &[]).is_empty() && folder.take_newest().is_none());
        assert_eq!(names(&folder, &[&runs[0].path]), ["run 0"]);
        let newest = runs.pop().expect("three runs");
        let path = newest.path.clone();
        drop(newest);
        assert_eq!(names(&folder, &[]), ["run 2"]);
        let taken = folder.take_newest().expect("nobody holds it");
        assert_eq!(taken.path, path);
        assert!(folder.take_newest().is_none(), "one window alone goes on with it");
        drop(runs);
        assert!(folder.take_newest().is_none(), "the newest is still shown, older work is not what was open last");
        drop(taken);
        assert_eq!(names(&folder, &[]), ["run 2", "run 1", "run 0"]);
    }

    #[test]
    fn the_last_five_are_kept_and_what_is_in_use() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = WorkFolder::new(place.path().to_owned());
        let mut all = runs(&folder, 9);
        let oldest = all.remove(0);
        drop(all);
        // A run that kept nothing.
        drop(folder.new_file().expect("a folder to write in"));
        folder.tidy();
        assert_eq!(names(&folder, &[]), ["run 8", "run 7", "run 6", "run 5", "run 4"]);
        assert!(oldest.path.exists());
        let locks = std::fs::read_dir(place.path()).expect("the folder").flatten().map(|entry| entry.path());
        let locks: Vec<PathBuf> = locks.filter(|path| path.extension().is_some_and(|extension| extension == "lock")).collect();
        assert_eq!(locks.len(), MOST_KEPT + 1, "{locks:?}");
    }

    #[test]
    fn the_file_of_earlier_releases_is_taken_in() {
        let place = tempfile::tempdir().expect("a folder");
        std::fs::write(place.path().join("working.pbrdf.json"), r#"{"measurements": [{"name": "yesterday"}]}"#).expect("a file");
        let folder = WorkFolder::new(place.path().join("work"));
        for _ in 0..2 {
            folder.adopt_earlier().expect("a folder to write in");
            assert_eq!(names(&folder, &[]), ["yesterday"]);
        }
    }
}
