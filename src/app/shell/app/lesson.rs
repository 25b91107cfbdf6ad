//! Lessons begin, go on and end.
//!
//! Settings file and autosave hold the user's own workspace beside that of the lesson, so that a
//! crash in a lesson loses nothing of it.

use crate::app::shell::app::App;
use crate::app::shell::app::autosave::set_aside;
use crate::app::shell::docking::Dock;
use crate::app::shell::lessons::LessonSession;
use crate::app::views::Views;
use crate::app::work::lesson::Step;
use crate::app::work::pane_id::PaneId;
use tr::tr;

/// Data, sliders and views as a step of a lesson wants them.
pub fn show_step(app: &mut App, lesson: usize, step: usize) -> Result<(), String> {
    let Some(steps) = app.lessons.all.get(lesson).and_then(|lesson| lesson.steps.get(..=step)).map(<[Step]>::to_vec) else {
        return Ok(());
    };
    let begins = app.lessons.open().is_none_or(|(open, _)| open != lesson);
    if begins {
        is_free_for_lessons(app)?;
        close_lesson(app);
        begin(app, lesson);
    }
    if let Some(session) = &mut app.lessons.session {
        session.step = step;
    }
    set_up_step(app, &steps, begins);
    Ok(())
}

/// Keeps the user's own work, and goes on with the same panes and no fit; data and sliders are then
/// the lesson's.
fn begin(app: &mut App, lesson: usize) {
    if app.jobs.fits.fit.is_running() || app.jobs.fits.compare.is_running() || app.jobs.fits.is_scanning() {
        app.toasts.error(tr!("What was being fitted was stopped for the lesson."));
    }
    app.apply_edits();
    app.work.record_step();
    let work = app.work.for_lesson();
    let saved = app.show_work(work);
    app.lessons.session = Some(Box::new(LessonSession { lesson, step: 0, saved }));
}

/// Sets up the last of these steps, whichever way the user came to it: its data and settings, and
/// its panes as they lie at the lesson's beginning.
fn set_up_step(app: &mut App, steps: &[Step], begins: bool) {
    app.jobs.fits.abandon();
    let open = app.work.active().number;
    app.work.set_up_lesson(steps, begins);
    if app.work.active().number != open {
        app.dialogs.import = None;
        app.dialogs.imports_waiting.clear();
        app.views = Views::default();
    }
    let mut dock = Dock::new(app.own_work().layout());
    for step in steps {
        let named: Vec<PaneId> = step.panes.iter().filter_map(|name| PaneId::try_from(name.clone()).ok()).collect();
        dock.show_together(&named);
    }
    // An arrangement that is right already keeps what the user has unfolded in it.
    if dock.layout() != app.dock.layout() {
        app.dock.rearrange(dock);
    }
}

/// Whether nothing is on its way that belongs to what is shown now: a file would meet the other
/// work.
pub fn is_free_for_lessons(app: &App) -> Result<(), String> {
    if app.jobs.files.reading_fraction().is_some() || app.jobs.files.session.is_running() || app.jobs.files.link.is_running() {
        return Err(tr!("A file is still being read: begin the lesson when it is there."));
    }
    awaits_no_answer(app)
}

/// Whether no question about a file is open and none is being written: the answer would meet the
/// other work.
fn awaits_no_answer(app: &App) -> Result<(), String> {
    let (files, dialogs) = (&app.jobs.files, &app.dialogs);
    if files.dialog.is_running() || files.export.is_running() || dialogs.import.is_some() || dialogs.overwrite.is_some() {
        return Err(tr!("A file is being chosen or written: lessons begin and end when that is done."));
    }
    Ok(())
}

/// Closes the lesson, if no answer is awaited that belongs to it; what is being read for it is not
/// wanted any more.
pub fn end_lesson(app: &mut App) -> Result<(), String> {
    awaits_no_answer(app)?;
    close_lesson(app);
    Ok(())
}

/// Closes the lesson; the user's own work is back as it was.
pub fn close_lesson(app: &mut App) {
    if let Some(session) = app.lessons.session.take() {
        app.jobs.files.abandon_reading();
        app.show_work(session.saved);
    }
}

/// Closes the lesson and goes on with what it set; undo leads back to the sliders of before.
///
/// # Errors
/// The work of before cannot be kept; a sentence.
pub fn keep_lesson(app: &mut App) -> Result<(), String> {
    if app.lessons.session.is_some() {
        set_aside(app)?;
    }
    if let Some(session) = app.lessons.session.take() {
        app.work.continue_undo_of(session.saved);
    }
    Ok(())
}
