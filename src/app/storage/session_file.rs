//! Sessions on disk.

use crate::app::storage::saved_entry::RestoredEntry;
use crate::app::storage::session::{SavedLesson, Session};
use crate::app::text::localized::Localized as _;
use crate::app::work::workspace::Workspace;
use crate::files::disk;
use crate::files::open_file::open_file;
use crate::files::write_file::write_file;
use std::io::Read as _;
use std::path::Path;
use tr::tr;

/// A session with its fits restored, the newest first.
pub struct OpenedSession {
    pub session: Session,
    /// In their order; none where the data of the session no longer allow one.
    pub fits: Vec<Option<RestoredEntry>>,
    /// The lesson that was open.
    pub lesson: Option<Box<OpenedLesson>>,
}

/// A lesson that was open: its title, the step from 0, and its work.
pub struct OpenedLesson {
    pub title: String,
    pub step: usize,
    pub work: OpenedSession,
}

impl OpenedSession {
    /// Reads a session.
    ///
    /// # Errors
    /// The file cannot be read or is no session; a sentence.
    pub fn read(path: &Path) -> Result<Self, String> {
        let mut text = String::new();
        let sentence = |reason: String| tr!("{0}: {1}.", path.display(), reason);
        let mut file = open_file(path).map_err(|reason| sentence(reason.localized()))?;
        file.read_to_string(&mut text).map_err(|error| sentence(tr!("the file cannot be read: {}", error.localized())))?;
        let session = Session::read(&text).map_err(|error| sentence(error.localized()))?;
        Ok(Self::new(session))
    }

    /// Restores the fits that the data of the session still allow.
    pub fn new(mut session: Session) -> Self {
        let fits = session.fits.iter().map(|fit| fit.restore(&session.measurements)).collect();
        let lesson = session.lesson.take().map(|lesson| {
            let SavedLesson { title, step, work } = *lesson;
            Box::new(OpenedLesson { title, step, work: Self::new(work) })
        });
        Self { session, fits, lesson }
    }

    /// The work that it holds.
    pub fn into_work(self) -> Workspace {
        self.session.into_work(self.fits)
    }
}

/// Writes a session in one move, and makes its folder.
///
/// # Errors
/// The file cannot be written; a sentence.
pub fn save_session(path: &Path, session: &Session) -> Result<(), String> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let written = disk::create_dir_all(folder).and_then(|()| write_file(path, |out| session.write(out)));
    written.map_err(|error| tr!("{0} cannot be written: {1}.", path.display(), error.localized()))
}
