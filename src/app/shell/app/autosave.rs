//! What is kept without being asked: the settings, and the working state with a lesson that is
//! open.

use crate::app::platform;
use crate::app::platform::Instant;
use crate::app::shell::app::App;
use crate::app::shell::persistence::{AutosaveRevision, SAVE_AFTER};
use crate::app::storage::kept_work::{KeptWork, WorkFile, WorkFolder};
use crate::app::storage::session::{SavedFile, SavedLesson, Session};
use crate::app::storage::session_file::save_session;
use crate::app::storage::settings_file;
use crate::app::storage::settings_file::{SavedSettings, SettingsFile};
use crate::app::text::localized::Localized as _;
use crate::app::views::action::Action;
use crate::app::work::results_options::ResultsOptions;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tr::tr;

/// Rows that are written as soon as the work rests for [`SAVE_AFTER`]; as many more wait as long
/// again, because all are written at every change.
const ROWS_AT_ONCE: usize = 20_000;

/// Goes on with that work.
pub fn resume(app: &mut App, path: PathBuf) {
    app.persistence.resuming = Some(path.clone());
    app.actions.push(Action::OpenSession(path));
}

/// Keeps the work of this run in a file of its own, and goes on with the work of the last one unless
/// the window is to begin anew or another one shows it.
pub fn keep_work(app: &mut App, folder: WorkFolder, begins_anew: bool) {
    // What is there now is what every window begins with.
    app.persistence.autosaved_revision = Some(app.autosave_revision());
    let last = folder.adopt_earlier().and_then(|()| {
        let last = if begins_anew { None } else { folder.take_newest() };
        take_file(app, &folder)?;
        Ok(last)
    });
    match last {
        Ok(Some(last)) => {
            resume(app, last.path.clone());
            app.persistence.work_files.push(last);
        }
        Ok(None) => {}
        Err(error) => app.toasts.error(tr!("Your work will not be kept: {}.", error.localized())),
    }
    app.persistence.kept = folder.kept(&of_this_run(&app.persistence.work_files));
    app.persistence.work_folder = Some(folder);
    if begins_anew && let Some(last) = app.persistence.kept.first() {
        app.toasts.info(tr!("Your earlier work is kept: File › Recent › {}", work_title(last)));
    }
}

/// From now on the work is written into a new file; what the old one holds stays.
fn take_file(app: &mut App, folder: &WorkFolder) -> std::io::Result<()> {
    let file = folder.new_file()?;
    app.persistence.autosave_path = Some(file.path.clone());
    app.persistence.work_files = vec![file];
    folder.tidy();
    Ok(())
}

/// The work that this run went on with, which it has not written itself.
fn of_this_run(files: &[WorkFile]) -> Vec<&Path> {
    files.iter().skip(1).map(|file| file.path.as_path()).collect()
}

/// What kept work is called in menus.
pub fn work_title(work: &KeptWork) -> String {
    const MOST_NAMES: usize = 3;
    let mut names = work.names[..work.names.len().min(MOST_NAMES)].join(", ");
    if work.names.len() > MOST_NAMES {
        names.push('…');
    }
    let time = platform::local_time(work.changed);
    // Of a damaged file the names are not known.
    if names.is_empty() { tr!("Work of {}", time) } else { tr!("Work of {0}: {1}", time, names) }
}

/// Keeps the work as it is now, because other work is about to take its place.
///
/// # Errors
/// It cannot be kept; a sentence.
pub fn set_aside(app: &mut App) -> Result<(), String> {
    let Some(folder) = app.persistence.work_folder.clone() else { return Ok(()) };
    let sentence = |error: std::io::Error| tr!("Your work cannot be kept: {}.", error.localized());
    let revision = app.autosave_revision();
    if app.persistence.autosaved_revision != Some(revision) {
        // What is being written now is older, and may end later.
        if app.jobs.files.autosave.is_running() {
            take_file(app, &folder).map_err(sentence)?;
        }
        if let Some(path) = &app.persistence.autosave_path {
            save_session(path, &working_state(app))?;
        }
        app.persistence.autosaved_revision = Some(revision);
    }
    take_file(app, &folder).map_err(sentence)?;
    app.persistence.kept = folder.kept(&[]);
    Ok(())
}

/// The user's own work, and the lesson over it.
fn working_state(app: &App) -> Session {
    let lesson = app.lessons.session.as_ref().zip(app.lessons.current()).map(|(session, (lesson, _))| {
        let title = lesson.title.original().to_owned();
        Box::new(SavedLesson { title, step: session.step, work: Session::of(&app.work) })
    });
    let own = app.own_work();
    let is_saved = app.persistence.saved_session == Some(own.revision());
    let file = own.session_file().map(|path| SavedFile { path: path.to_owned(), saved: is_saved });
    Session { lesson, file, ..Session::of(own) }
}

impl App {
    /// What the working state depends on.
    pub fn autosave_revision(&self) -> AutosaveRevision {
        let lesson = self.lessons.session.as_ref().map(|_| self.work.revision());
        AutosaveRevision { own: self.own_work().revision(), lesson }
    }
}

/// The file of the working state, if it is to be written: not while a job is about to replace what
/// there is.
fn due(app: &App) -> Option<(PathBuf, AutosaveRevision)> {
    let path = app.persistence.autosave_path.clone()?;
    let is_waiting = app.jobs.files.session.is_running() || app.jobs.files.link.is_running() || app.jobs.files.autosave.is_running();
    let revision = app.autosave_revision();
    (!is_waiting && app.persistence.autosaved_revision != Some(revision)).then_some((path, revision))
}

/// How long the work rests before it is written.
fn rest(app: &App) -> Duration {
    let rows: usize = app.own_work().measurements().iter().map(|open| open.measurement.rows.len()).sum();
    SAVE_AFTER.saturating_mul(u32::try_from(1 + rows / ROWS_AT_ONCE).unwrap_or(u32::MAX))
}

pub fn autosave_when_rested(app: &mut App, ctx: &egui::Context) {
    let Some((path, revision)) = due(app).filter(|_| !app.interacting) else {
        app.persistence.autosave_dirty_since = None;
        return;
    };
    let since = *app.persistence.autosave_dirty_since.get_or_insert_with(Instant::now);
    let rest = rest(app);
    if since.elapsed() < rest {
        ctx.request_repaint_after(rest);
        return;
    }
    app.persistence.autosave_dirty_since = None;
    app.persistence.autosaved_revision = Some(revision);
    let (folder, own) = (app.persistence.work_folder.clone(), of_this_run(&app.persistence.work_files));
    let own: Vec<PathBuf> = own.into_iter().map(Path::to_owned).collect();
    let kept = move || folder.map_or_else(Vec::new, |folder| folder.kept(&own.iter().map(PathBuf::as_path).collect::<Vec<_>>()));
    if let Err(sentence) = app.jobs.files.autosave(path, working_state(app), kept) {
        app.toasts.error(sentence);
    }
}

/// The work has been written, and other windows may have ended meanwhile.
pub fn autosaved(app: &mut App, result: Result<Vec<KeptWork>, String>) {
    match result {
        Ok(kept) => app.persistence.kept = kept,
        Err(sentence) => {
            app.persistence.autosave_path = None;
            app.toasts.error(sentence);
        }
    }
}

/// Whether the settings file holds something else.
fn is_changed(app: &App) -> bool {
    let saved = app.persistence.saved_settings.as_ref();
    saved.is_none_or(|(revision, window)| *revision != app.own_work().revision() || *window != app.window)
}

pub fn save_when_rested(app: &mut App, ctx: &egui::Context) {
    if app.interacting || !is_changed(app) {
        app.persistence.settings_dirty_since = None;
        return;
    }
    let since = *app.persistence.settings_dirty_since.get_or_insert_with(Instant::now);
    if since.elapsed() >= SAVE_AFTER {
        save_settings(app);
    } else {
        ctx.request_repaint_after(SAVE_AFTER);
    }
}

/// Writes the settings now.
pub fn save_settings(app: &mut App) {
    app.persistence.settings_dirty_since = None;
    app.persistence.saved_settings = Some((app.own_work().revision(), app.window.clone()));
    let Some(path) = app.persistence.settings_path.clone() else { return };
    let own = app.own_work();
    let mut settings = SavedSettings { settings: own.settings().clone(), surface: own.surface().clone() };
    // Which columns are hidden belongs to these measurements.
    settings.settings.panes.results = ResultsOptions::default();
    let file = SettingsFile { settings, layout: own.layout().clone(), window: app.window.clone() };
    if let Err(error) = settings_file::save(&path, &file) {
        app.persistence.settings_path = None;
        app.toasts.error(tr!("The settings cannot be saved to {0}: {1}.", path.display(), error.localized()));
    }
}

/// Writes what has changed before the window closes.
pub fn save_on_exit(app: &mut App) {
    if is_changed(app) {
        save_settings(app);
    }
    if let Some((path, revision)) = due(app)
        && save_session(&path, &working_state(app)).is_ok()
    {
        app.persistence.autosaved_revision = Some(revision);
    }
}
