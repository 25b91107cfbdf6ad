//! Sessions in the window: opened, saved, and the working state kept without being asked.

use crate::app::platform::Instant;
use crate::app::shell::app::{App, SAVE_AFTER};
use crate::app::shell::docking::Dock;
use crate::app::storage::export::ExportKind;
use crate::app::storage::session::Session;
use crate::app::storage::session_file::{OpenedSession, save_session};
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::views::Views;
use crate::app::views::action::Action;
use crate::app::work::layout::Layout;
use crate::app::work::settings::Settings;
use std::path::{Path, PathBuf};
use tr::tr;

/// What the working state depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct AutosaveKey {
    settings: Settings,
    layout: Layout,
    generation: u64,
    fits: usize,
}

/// Rows that are kept without being asked: more would be written again and again at every change.
const MOST_ROWS: usize = 20_000;

impl App {
    /// The session as it is shown, that of a lesson included.
    #[cfg(test)]
    pub fn session(&self) -> Session {
        Session::of(&self.work, self.shown_layout())
    }

    /// The session of the user's own work, which a lesson sets aside.
    fn own_session(&self) -> Session {
        Session::of(self.own_work(), self.window.layout.clone())
    }

    /// The layout as it is shown, that of a lesson included.
    pub fn shown_layout(&self) -> Layout {
        self.panes.layout().unwrap_or_else(|| self.window.layout.clone())
    }

    /// Goes on where the program ended the last time, if it left something.
    pub fn resume(&mut self) {
        if let Some(path) = self.working_file.clone().filter(|path| path.exists()) {
            self.actions.push(Action::OpenSession(path));
        }
    }

    fn working(&self) -> AutosaveKey {
        AutosaveKey {
            settings: self.own_work().settings.clone(),
            layout: self.window.layout.clone(),
            generation: self.own_work().document.generation,
            fits: self.own_work().fit_history.made(),
        }
    }

    /// The file of the working state, if it is to be written: not while a job is about to replace what there is.
    fn due(&self) -> Option<(PathBuf, AutosaveKey)> {
        let path = self.working_file.clone().filter(|_| self.own_work().document.measurement.rows.len() <= MOST_ROWS)?;
        let is_waiting = self.jobs.files.session.is_running() || self.jobs.files.autosave.is_running();
        let working = self.working();
        (!is_waiting && self.autosaved.as_ref() != Some(&working)).then_some((path, working))
    }

    pub fn autosave_when_rested(&mut self, ctx: &egui::Context) {
        let Some((path, working)) = self.due() else {
            self.unsaved_since = None;
            return;
        };
        let begun = *self.unsaved_since.get_or_insert_with(Instant::now);
        if begun.elapsed() < SAVE_AFTER {
            ctx.request_repaint_after(SAVE_AFTER);
            return;
        }
        self.unsaved_since = None;
        self.autosaved = Some(working);
        if let Err(sentence) = self.jobs.files.autosave(path, self.own_session()) {
            self.say(sentence);
        }
    }

    /// Writes the working state before the window closes.
    pub fn autosave_now(&mut self) {
        if let Some((path, working)) = self.due()
            && save_session(&path, &self.own_session()).is_ok()
        {
            self.autosaved = Some(working);
        }
    }

    pub fn save_session(&mut self, ctx: &egui::Context) -> Result<(), String> {
        let what = ExportKind::Session;
        let command = self.work.session_file.clone().map_or(Action::ChooseExport(what), |path| Action::Export(what, path));
        self.execute(ctx, command)
    }

    pub fn exported(&mut self, what: ExportKind, result: Result<PathBuf, String>) {
        match result {
            Ok(path) => {
                self.typed.served(&path);
                self.notices.info(tr!("{0} is saved to {1}.", translated(what.name()), path.display()));
                // What was saved out of a lesson is no file of the work that comes back.
                if what == ExportKind::Session && self.lesson_session.is_none() {
                    self.work.session_file = Some(path);
                }
            }
            Err(sentence) => self.say(sentence),
        }
    }

    /// Puts a session in the place of everything there is; where it cannot be read, all stays.
    pub fn session_read(&mut self, path: &Path, result: Result<Box<OpenedSession>, String>) {
        let is_working = self.working_file.as_deref() == Some(path);
        match result {
            Ok(opened) => {
                self.notices.dismiss_load_errors();
                self.typed.served(path);
                let left_out = opened.session.left_out.iter();
                let left_out: Vec<String> = left_out.map(|(number, error)| tr!("fit {0}: {1}", number, error.localized())).collect();
                self.show_session(*opened);
                if !left_out.is_empty() {
                    self.say(tr!("{0} is opened without fits that are damaged: {1}.", path.display(), left_out.join(&tr!("; "))));
                }
                self.work.session_file = (!is_working).then(|| path.to_owned());
                if is_working {
                    self.autosaved = Some(self.working());
                } else {
                    self.window.remember(path);
                }
            }
            Err(sentence) if is_working => {
                // The next autosave would write over it.
                let aside = path.with_extension("damaged.json");
                let kept = std::fs::rename(path, &aside).map_or_else(
                    |error| tr!("it could not be set aside ({})", error.localized()),
                    |()| tr!("it is kept as {}", aside.display()),
                );
                self.say(tr!("The state of the last time cannot be restored; {0}. {1}", kept, sentence));
            }
            Err(sentence) => {
                self.window.forget(path);
                self.notices.load_error(sentence);
            }
        }
    }

    fn show_session(&mut self, opened: OpenedSession) {
        // It takes the place of a lesson, and of what that would give back.
        self.lessons.open = None;
        self.lesson_session = None;
        let OpenedSession { session, fits } = opened;
        self.window.layout = session.layout.clone();
        self.work = session.into_work(fits);
        self.import = None;
        self.views = Views::default();
        self.jobs.fits.abandon();
        self.panes = Dock::new(&self.window.layout);
    }
}
