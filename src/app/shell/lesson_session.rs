//! A lesson works on a workspace of its own; the user's workspace is saved meanwhile and comes back when the lesson ends.
//!
//! Settings file and autosave always hold the user's workspace, so that a crash in a lesson loses nothing of it.

use crate::app::shell::app::App;
use crate::app::shell::docking::Dock;
use crate::app::views::Views;
use crate::app::work::workspace::Workspace;
use tr::tr;

/// The user's work while a lesson is open.
pub struct LessonSession {
    /// The user's own work as it was when the lesson began.
    pub saved: Workspace,
    panes: Dock,
}

impl App {
    /// Data, sliders and views as a step of a lesson wants them.
    pub(crate) fn show_step(&mut self, lesson: usize, step: usize) -> Result<(), String> {
        if self.lessons.all.get(lesson).is_none_or(|lesson| step >= lesson.steps.len()) {
            return Ok(());
        }
        let begins = self.lessons.open.is_none_or(|(open, _)| open != lesson);
        if begins {
            self.is_free_for_lessons()?;
            self.close_lesson();
            self.set_aside();
        }
        self.lessons.open = Some((lesson, step));
        self.set_up_step(lesson, step, begins);
        Ok(())
    }

    /// Keeps the user's own work, and goes on with the same panes and no fit; data and sliders are then the lesson's.
    fn set_aside(&mut self) {
        if self.jobs.fits.fit.is_running() || self.jobs.fits.compare.is_running() || self.jobs.fits.is_scanning() {
            self.say(tr!("What was being fitted was stopped for the lesson."));
        }
        self.jobs.fits.abandon();
        self.work.record_step();
        let copy = self.panes_at_its_beginning();
        let lesson = self.work.for_lesson();
        self.lesson_session = Some(Box::new(LessonSession {
            saved: std::mem::replace(&mut self.work, lesson),
            panes: std::mem::replace(&mut self.panes, copy),
        }));
    }

    /// Whether nothing is on its way that belongs to what is shown now: a file would meet the other work.
    fn is_free_for_lessons(&self) -> Result<(), String> {
        if self.jobs.files.reading_fraction().is_some() || self.jobs.files.session.is_running() {
            return Err(tr!("A file is still being read: begin the lesson when it is there."));
        }
        self.awaits_no_answer()
    }

    /// Whether no question about a file is open and none is being written: the answer would meet the other work.
    fn awaits_no_answer(&self) -> Result<(), String> {
        if self.jobs.files.dialog.is_running() || self.jobs.files.export.is_running() || self.import.is_some() || self.replacing.is_some() {
            return Err(tr!("A file is being chosen or written: lessons begin and end when that is done."));
        }
        Ok(())
    }

    /// Closes the lesson, if no answer is awaited that belongs to it; what is being read for it is not wanted any more.
    pub(crate) fn end_lesson(&mut self) -> Result<(), String> {
        self.awaits_no_answer()?;
        self.close_lesson();
        Ok(())
    }

    /// The panes as a lesson finds them.
    pub(crate) fn panes_at_its_beginning(&self) -> Dock {
        let own = self.lesson_session.as_ref().map_or(&self.panes, |session| &session.panes);
        own.layout().map_or_else(|| Dock::new(&self.window.layout), |layout| Dock::new(&layout))
    }

    /// Closes the lesson; the user's own work is back as it was.
    pub(crate) fn close_lesson(&mut self) {
        self.lessons.open = None;
        let Some(session) = self.lesson_session.take() else { return };
        let LessonSession { saved, panes } = *session;
        self.jobs.fits.abandon();
        self.jobs.files.abandon_reading();
        self.import = None;
        self.work = saved;
        self.panes = panes;
        self.views = Views::default();
    }

    /// Closes the lesson and goes on with what it set; undo leads back to the sliders of before.
    pub(crate) fn keep_lesson(&mut self) {
        self.lessons.open = None;
        if let Some(session) = self.lesson_session.take() {
            self.work.undo = session.saved.undo;
        }
    }

    /// The user's own work, also while a lesson is open.
    pub(crate) fn own_work(&self) -> &Workspace {
        self.lesson_session.as_ref().map_or(&self.work, |session| &session.saved)
    }
}
