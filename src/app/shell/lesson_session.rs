//! The user's own work, set aside while a lesson is on: a lesson moves sliders, opens examples and arranges panes, and gives all of it back.
//!
//! What is kept without being asked, the settings and the working state, is the user's own work all the while: a crash in a lesson brings that
//! back, without the lesson.

use crate::app::jobs::worker::ModelFit;
use crate::app::shell::app::{App, Setup};
use crate::app::shell::docking::Dock;
use crate::app::views::Views;
use crate::app::work::diagnostics::Diagnostics;
use crate::app::work::document::Document;
use crate::app::work::fit_history::{FitEntry, FitHistory};
use crate::app::work::history::History;
use crate::app::work::settings::Settings;
use pbrdf::model::Parameters;
use std::path::PathBuf;
use std::rc::Rc;
use tr::tr;

/// What a lesson gives back.
pub struct LessonSession {
    pub settings: Settings,
    pub document: Document,
    pub last_fit: Option<Rc<FitEntry>>,
    pub fit_history: FitHistory,
    panes: Dock,
    comparison: Vec<ModelFit>,
    scans: Diagnostics,
    history: History<Setup>,
    refitted: Option<Parameters>,
    session_file: Option<PathBuf>,
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
        if self.worker.fit.is_some() || self.worker.comparison.is_some() || self.worker.scan.is_some() {
            self.say(tr!("What was being fitted was stopped for the lesson."));
        }
        self.worker.abandon();
        let setup = self.setup();
        self.history.rest(setup);
        let copy = self.panes_at_its_beginning();
        self.aside = Some(Box::new(LessonSession {
            settings: std::mem::replace(&mut self.settings, Settings::for_measurement(&self.document.measurement)),
            document: self.document.clone(),
            last_fit: self.last_fit.take(),
            fit_history: self.fit_history.clone(),
            panes: std::mem::replace(&mut self.panes, copy),
            comparison: std::mem::take(&mut self.comparison),
            scans: std::mem::take(&mut self.scans),
            history: std::mem::take(&mut self.history),
            refitted: self.refitted,
            session_file: self.session_file.take(),
        }));
        self.refitted = Some(self.settings.parameters);
    }

    /// Whether nothing is on its way that belongs to what is shown now: a file would meet the other work.
    fn is_free_for_lessons(&self) -> Result<(), String> {
        if self.worker.load.is_some() || self.worker.session.is_some() {
            return Err(tr!("A file is still being read: begin the lesson when it is there."));
        }
        self.awaits_no_answer()
    }

    /// Whether no question about a file is open and none is being written: the answer would meet the other work.
    fn awaits_no_answer(&self) -> Result<(), String> {
        if self.worker.is_asking() || self.worker.export.is_some() || self.import.is_some() || self.replacing.is_some() {
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
        let own = self.aside.as_ref().map_or(&self.panes, |aside| &aside.panes);
        own.layout().map_or_else(|| Dock::new(&self.window.layout), |layout| Dock::new(&layout))
    }

    /// Closes the lesson; the user's own work is back as it was.
    pub(crate) fn close_lesson(&mut self) {
        self.lessons.open = None;
        let Some(aside) = self.aside.take() else { return };
        let LessonSession { settings, document, last_fit, fit_history, panes, comparison, scans, history, refitted, session_file } = *aside;
        self.worker.abandon();
        self.worker.abandon_load();
        self.worker.session = None;
        self.import = None;
        self.settings = settings;
        self.document = document;
        self.last_fit = last_fit;
        self.fit_history = fit_history;
        self.panes = panes;
        self.comparison = comparison;
        self.scans = scans;
        self.history = history;
        self.refitted = refitted;
        self.session_file = session_file;
        self.views = Views::default();
    }

    /// Closes the lesson and goes on with what it set; undo leads back to the sliders of before.
    pub(crate) fn keep_lesson(&mut self) {
        self.lessons.open = None;
        if let Some(aside) = self.aside.take() {
            self.history = aside.history;
        }
    }

    /// The settings that are the user's own.
    pub(crate) fn own_settings(&self) -> &Settings {
        self.aside.as_ref().map_or(&self.settings, |aside| &aside.settings)
    }

    /// The measurement that is the user's own.
    pub(crate) fn own_document(&self) -> &Document {
        self.aside.as_ref().map_or(&self.document, |aside| &aside.document)
    }

    /// The fits that are the user's own.
    pub(crate) fn own_fits(&self) -> &FitHistory {
        self.aside.as_ref().map_or(&self.fit_history, |aside| &aside.fit_history)
    }
}
