//! Takes the results of jobs.

use crate::app::jobs::job::Panicked;
use crate::app::jobs::slot::Slot;
use crate::app::platform::DialogUnavailable;
use crate::app::shell::app::App;
use crate::app::shell::app::autosave::autosaved;
use crate::app::shell::app::fits::{bootstrapped, fitted, intervals_found, profiled};
use crate::app::shell::app::link::link_read;
use crate::app::shell::app::open::{alike_found, files_loaded, imported, reopened};
use crate::app::shell::app::plans::chosen;
use crate::app::shell::app::posteriors::drawn;
use crate::app::shell::app::session::{exported, session_read};
use crate::app::shell::app::walk::walk_found;
use crate::app::shell::file_dialogs::{command_for, unavailable_text};
use crate::app::tasks::benchmarks::FinishedBenchmark;
use crate::app::tasks::files::DialogAnswer;
use crate::app::tasks::fit_work::ComparedModels;
use crate::app::tasks::jobs::Jobs;
use crate::app::work::edit::Edit;
use std::path::PathBuf;
use tr::tr;

/// Takes the result of one slot: where it goes, and what the user is told where the job panicked.
fn poll<T, P>(
    app: &mut App,
    slot: impl Fn(&mut Jobs) -> &mut Slot<T, P>,
    receive: impl FnOnce(&mut App, T),
    panic_text: impl FnOnce() -> String,
) {
    match slot(&mut app.jobs).poll() {
        None => {}
        Some(Ok(result)) => receive(app, result),
        Some(Err(Panicked)) => app.toasts.error(panic_text()),
    }
}

/// Takes the results of all jobs that have ended.
#[rustfmt::skip]
pub fn poll_jobs(app: &mut App) {
    poll(app, |jobs| &mut jobs.files.dialog, dialog_answered, || tr!("The file dialog ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.files.load, files_loaded, reading_panicked);
    poll(app, |jobs| &mut jobs.files.import, imported, reading_panicked);
    poll(app, |jobs| &mut jobs.files.reopen, reopened, looking_panicked);
    poll(app, |jobs| &mut jobs.files.alike, alike_found, looking_panicked);
    poll(app, |jobs| &mut jobs.files.session, |app, loaded| session_read(app, &loaded.path, loaded.result), reading_panicked);
    poll(app, |jobs| &mut jobs.files.link, link_read, reading_panicked);
    poll(app, |jobs| &mut jobs.files.save, measurement_saved, writing_panicked);
    poll(app, |jobs| &mut jobs.files.export, exported, writing_panicked);
    poll(app, |jobs| &mut jobs.files.autosave, autosaved,
        || tr!("Saving the working state ended unexpectedly; it is saved again after the next change."));
    poll(app, |jobs| &mut jobs.fits.fit, fitted, fit_panicked);
    poll(app, |jobs| &mut jobs.fits.intervals, intervals_found, || tr!("The intervals ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.fits.refit, |app, found| app.work.apply(Edit::Refit(found)), fit_panicked);
    poll(app, |jobs| &mut jobs.fits.compare, |app, ComparedModels { numbers, models }| app.work.apply(Edit::SetModelComparison { numbers, models }),
        || tr!("The comparison of the models ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.fits.profile, |app, profile| profiled(app, &profile), || tr!("The profile ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.fits.bootstrap, bootstrapped, || tr!("The bootstrap ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.posteriors.draw, drawn, || tr!("Drawing from the posterior ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.fits.walk, walk_found, || tr!("The weakest direction ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.plans.choose, chosen, || tr!("The choice of angles ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.posteriors.evidence, |app, (number, found)| app.work.apply(Edit::SetEvidence { number, found }),
        || tr!("Drawing from the posterior ended unexpectedly; nothing was lost."));
    poll_benchmarks(app);
}

fn reading_panicked() -> String {
    tr!("Reading the file ended unexpectedly; what is open stays.")
}

fn looking_panicked() -> String {
    tr!("A look at the file ended unexpectedly; what is open stays.")
}

fn writing_panicked() -> String {
    tr!("Writing the file ended unexpectedly; a file that was there is as it was.")
}

fn fit_panicked() -> String {
    tr!("The fit ended unexpectedly; nothing was lost.")
}

pub fn dialog_answered(app: &mut App, answer: DialogAnswer) {
    match answer.reply {
        // Before the queued actions: the user chose the path for the work as it was when the dialog
        // opened.
        Ok(paths) => drop(app.actions.splice(..0, command_for(&answer.request, paths))),
        Err(DialogUnavailable) => app.toasts.error(unavailable_text(&answer.request)),
    }
}

fn measurement_saved(app: &mut App, result: Result<PathBuf, String>) {
    match result {
        Ok(path) => {
            app.dialogs.path_entry.clear_if(&path);
            app.toasts.info(tr!("The measurement is saved to {}.", path.display()));
        }
        Err(sentence) => app.toasts.error(sentence),
    }
}

fn poll_benchmarks(app: &mut App) {
    match app.jobs.benchmarks.poll() {
        None => return,
        Some(Ok(FinishedBenchmark { result, is_part })) => app.benchmarks.take(*result, is_part),
        Some(Err(Panicked)) => app.toasts.error(tr!("The report ended unexpectedly; the one before it stays.")),
    }
    if let Err(sentence) = app.jobs.benchmarks.start_waiting() {
        app.toasts.error(sentence);
    }
}
