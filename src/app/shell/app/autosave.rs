//! What is kept without being asked: the settings, and the working state with a lesson that is
//! open.

use crate::app::platform::Instant;
use crate::app::shell::app::App;
use crate::app::shell::persistence::{AutosaveRevision, SAVE_AFTER};
use crate::app::storage::session::{SavedLesson, Session};
use crate::app::storage::session_file::save_session;
use crate::app::storage::settings_file;
use crate::app::storage::settings_file::{SavedSettings, SettingsFile};
use crate::app::text::localized::Localized as _;
use crate::app::views::action::Action;
use std::path::PathBuf;
use tr::tr;

/// Rows that are kept without being asked: more would be written again and again at every change.
const MOST_ROWS: usize = 20_000;

/// Goes on where the program ended the last time, if it left something.
pub fn resume(app: &mut App) {
    let path = app.persistence.autosave_path.clone().filter(|path| path.exists());
    app.actions.extend(path.map(Action::OpenSession));
}

/// The user's own work, and the lesson over it.
fn working_state(app: &App) -> Session {
    let lesson = app.lessons.session.as_ref().zip(app.lessons.current()).map(|(session, (lesson, _))| {
        let title = lesson.title.original().to_owned();
        Box::new(SavedLesson { title, step: session.step, work: Session::of(&app.work) })
    });
    Session { lesson, ..Session::of(app.own_work()) }
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
    let rows: usize = app.own_work().measurements().iter().map(|open| open.measurement.rows.len()).sum();
    let path = app.persistence.autosave_path.clone().filter(|_| rows <= MOST_ROWS)?;
    let is_waiting = app.jobs.files.session.is_running() || app.jobs.files.autosave.is_running();
    let revision = app.autosave_revision();
    (!is_waiting && app.persistence.autosaved_revision != Some(revision)).then_some((path, revision))
}

pub fn autosave_when_rested(app: &mut App, ctx: &egui::Context) {
    let Some((path, revision)) = due(app) else {
        app.persistence.autosave_dirty_since = None;
        return;
    };
    let since = *app.persistence.autosave_dirty_since.get_or_insert_with(Instant::now);
    if since.elapsed() < SAVE_AFTER {
        ctx.request_repaint_after(SAVE_AFTER);
        return;
    }
    app.persistence.autosave_dirty_since = None;
    app.persistence.autosaved_revision = Some(revision);
    if let Err(sentence) = app.jobs.files.autosave(path, working_state(app)) {
        app.toasts.error(sentence);
    }
}

/// The working state has been written.
pub fn autosaved(app: &mut App, result: Result<(), String>) {
    if let Err(sentence) = result {
        app.persistence.autosave_path = None;
        app.toasts.error(sentence);
    }
}

/// Whether the settings file holds something else.
fn is_changed(app: &App) -> bool {
    let saved = app.persistence.saved_settings.as_ref();
    saved.is_none_or(|(revision, window)| *revision != app.own_work().revision() || *window != app.window)
}

pub fn save_when_rested(app: &mut App, ctx: &egui::Context) {
    if !is_changed(app) {
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
    let settings = SavedSettings { settings: own.settings().clone(), surface: own.surface().clone() };
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
