//! Sessions open, and exports end.

use crate::app::shell::app::App;
use crate::app::shell::app::autosave::set_aside;
use crate::app::shell::app::open::remember;
use crate::app::shell::app::title::mark_saved;
use crate::app::shell::lessons::LessonSession;
use crate::app::storage::export::ExportKind;
use crate::app::storage::session::SavedFile;
use crate::app::storage::session_file::OpenedSession;
use crate::app::tasks::files::ExportedFile;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::work::edit::Edit;
use crate::files::disk;
use std::path::{Path, PathBuf};
use tr::tr;

/// Puts a session in the place of everything there is; where it cannot be read, all stays.
pub fn session_read(app: &mut App, path: &Path, result: Result<Box<OpenedSession>, String>) {
    let is_kept = app.persistence.is_kept(path);
    let is_resumed = app.persistence.resuming.take_if(|resuming| resuming == path).is_some();
    match result {
        Ok(opened) => {
            // At the start there is nothing of the user's yet.
            if !is_resumed && let Err(sentence) = set_aside(app) {
                app.toasts.error(sentence);
                return;
            }
            app.toasts.dismiss_load_errors();
            app.dialogs.path_entry.clear_if(path);
            let left_out = opened.session.left_out.iter();
            let left_out: Vec<String> = left_out.map(|(number, error)| tr!("fit {0}: {1}", number, error.localized())).collect();
            let file = if is_kept { opened.session.file.clone() } else { Some(SavedFile { path: path.to_owned(), saved: true }) };
            show_session(app, *opened, file.as_ref().map(|file| file.path.clone()));
            if !left_out.is_empty() {
                let left_out = left_out.join(&tr!("; "));
                app.toasts.error(tr!("{0} is opened without fits that are damaged: {1}.", path.display(), left_out));
            }
            if file.is_some_and(|file| file.saved) {
                mark_saved(app);
            }
            if is_resumed {
                app.persistence.autosaved_revision = Some(app.autosave_revision());
            }
            if !is_kept {
                remember(app, path);
            }
        }
        Err(sentence) if is_kept => {
            // The next start would meet it again.
            let aside = path.with_extension("damaged.json");
            let kept = disk::rename(path, &aside).map_or_else(
                |error| tr!("it could not be set aside ({})", error.localized()),
                |()| tr!("it is kept as {}", aside.display()),
            );
            app.toasts.error(tr!("The work of before cannot be opened; {0}. {1}", kept, sentence));
        }
        Err(sentence) => {
            app.window.forget(path);
            app.toasts.load_error(sentence);
        }
    }
}

/// It takes the place of a lesson, and of what that would give back; a lesson that was open goes
/// on.
fn show_session(app: &mut App, mut opened: OpenedSession, file: Option<PathBuf>) {
    app.lessons.session = None;
    let lesson = opened.lesson.take();
    app.show_work(opened.into_work());
    app.work.apply(Edit::SetSessionFile(file));
    let lesson = lesson.and_then(|lesson| Some((app.lessons.find(&lesson.title, lesson.step)?, lesson)));
    if let Some((place, lesson)) = lesson {
        let step = lesson.step;
        let saved = app.show_work(lesson.work.into_work());
        app.lessons.session = Some(Box::new(LessonSession { lesson: place, step, saved }));
    }
}

/// An export has ended.
pub fn exported(app: &mut App, ExportedFile { kind, revision, result }: ExportedFile) {
    match result {
        Ok(path) => {
            app.dialogs.path_entry.clear_if(&path);
            app.toasts.info(tr!("{0} is saved to {1}.", translated(kind.name()), path.display()));
            // What was saved out of a lesson is no file of the work that comes back.
            if kind == ExportKind::Session && app.lessons.session.is_none() {
                let is_unchanged = app.work.revision() == revision;
                app.work.apply(Edit::SetSessionFile(Some(path)));
                app.persistence.saved_session = is_unchanged.then(|| app.work.revision());
            }
        }
        Err(sentence) => app.toasts.error(sentence),
    }
}
