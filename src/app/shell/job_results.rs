//! What the window does with the results of jobs.

use crate::app::jobs::job::Panicked;
use crate::app::jobs::slot::Slot;
use crate::app::platform::DialogUnavailable;
use crate::app::shell::app::App;
use crate::app::shell::file_dialogs::{command_for, unavailable_text};
use crate::app::shell::import_dialog::ImportDialog;
use crate::app::storage::import::Loaded;
use crate::app::tasks::benchmarks::FinishedBenchmark;
use crate::app::tasks::files::{DialogAnswer, LoadedFile};
use crate::app::tasks::fits::{FinishedBootstrap, FinishedFit};
use crate::app::tasks::jobs::Jobs;
use crate::app::work::diagnostics::{Bootstrap, ProfileCurve};
use crate::app::work::document::Document;
use crate::app::work::edit::Edit;
use crate::app::work::fit_history::FitEntry;
use pbrdf::fit::Profile;
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
        Some(Err(Panicked)) => app.say(panic_text()),
    }
}

/// Takes the results of all jobs that have ended.
#[rustfmt::skip]
pub(crate) fn poll_jobs(app: &mut App) {
    poll(app, |jobs| &mut jobs.files.dialog, dialog_answered, || tr!("The file dialog ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.files.load, file_loaded, reading_panicked);
    poll(app, |jobs| &mut jobs.files.import, App::imported, reading_panicked);
    poll(app, |jobs| &mut jobs.files.session, |app, loaded| app.session_read(&loaded.path, loaded.result), reading_panicked);
    poll(app, |jobs| &mut jobs.files.save, measurement_saved, writing_panicked);
    poll(app, |jobs| &mut jobs.files.export, |app, file| app.exported(file.kind, file.result), writing_panicked);
    poll(app, |jobs| &mut jobs.files.autosave, autosaved,
        || tr!("Saving the working state ended unexpectedly; it is saved again after the next change."));
    poll(app, |jobs| &mut jobs.fits.fit, fitted, fit_panicked);
    poll(app, |jobs| &mut jobs.fits.refit, |app, report| app.work.apply(Edit::Refit(report)), fit_panicked);
    poll(app, |jobs| &mut jobs.fits.compare, |app, fits| app.work.apply(Edit::SetModelComparison(fits)),
        || tr!("The comparison of the models ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.fits.profile, |app, profile| profiled(app, &profile), || tr!("The profile ended unexpectedly; nothing was lost."));
    poll(app, |jobs| &mut jobs.fits.bootstrap, bootstrapped, || tr!("The bootstrap ended unexpectedly; nothing was lost."));
    poll_benchmarks(app);
}

fn reading_panicked() -> String {
    tr!("Reading the file ended unexpectedly; what is open stays.")
}

fn writing_panicked() -> String {
    tr!("Writing the file ended unexpectedly; a file that was there is as it was.")
}

fn fit_panicked() -> String {
    tr!("The fit ended unexpectedly; nothing was lost.")
}

pub(crate) fn dialog_answered(app: &mut App, answer: DialogAnswer) {
    match answer.reply {
        // Before the queued commands: the user chose the path for the work as it was when the dialog opened.
        Ok(path) => drop(app.actions.splice(..0, path.map(|path| command_for(&answer.request, path)))),
        Err(DialogUnavailable) => app.say(unavailable_text(&answer.request)),
    }
}

fn file_loaded(app: &mut App, LoadedFile { origin, result }: LoadedFile) {
    match result {
        Ok(Loaded::Measurement(imported)) => app.loaded(origin, *imported),
        Ok(Loaded::Foreign(file)) => {
            origin.path.iter().for_each(|path| app.typed.served(path));
            app.import = Some(ImportDialog::new(origin, file));
        }
        Err(sentence) => {
            origin.path.iter().for_each(|path| app.window.forget(path));
            app.notices.load_error(sentence);
        }
    }
}

fn measurement_saved(app: &mut App, result: Result<PathBuf, String>) {
    match result {
        Ok(path) => {
            app.typed.served(&path);
            app.notices.info(tr!("The measurement is saved to {}.", path.display()));
        }
        Err(sentence) => app.say(sentence),
    }
}

fn autosaved(app: &mut App, result: Result<(), String>) {
    if let Err(sentence) = result {
        app.working_file = None;
        app.say(sentence);
    }
}

fn fitted(app: &mut App, FinishedFit { report, problem, generation, mask }: FinishedFit) {
    let Document { name, sha256, measurement, number, .. } = &app.work.document;
    let (document, sha256, data, number) = (name.clone(), sha256.clone(), measurement.clone(), *number);
    let before = app.work.settings.parameters;
    // The history numbers its fits.
    let fit = FitEntry { id: 0, report: *report, problem, before, document, sha256, data, number, generation, mask };
    app.work.apply(Edit::AddFit(Box::new(fit)));
    app.jobs.fits.abandon_scan();
}

fn profiled(app: &mut App, profile: &Profile) {
    let curve = app.work.shown_fit.as_ref().map(|fit| ProfileCurve::new(profile, &fit.problem, &fit.report));
    app.work.apply(Edit::SetProfile(curve));
}

fn bootstrapped(app: &mut App, FinishedBootstrap { replicates, scatter }: FinishedBootstrap) {
    app.work.apply(Edit::SetBootstrap(Some(Bootstrap { replicates, scatter })));
}

fn poll_benchmarks(app: &mut App) {
    match app.jobs.benchmarks.poll() {
        None => return,
        Some(Ok(finished)) => benchmark_finished(app, finished),
        Some(Err(Panicked)) => app.say(tr!("The report ended unexpectedly; the one before it stays.")),
    }
    if let Err(sentence) = app.jobs.benchmarks.start_waiting() {
        app.say(sentence);
    }
}

pub(crate) fn benchmark_finished(app: &mut App, FinishedBenchmark { result, is_part }: FinishedBenchmark) {
    app.reports.take(*result, is_part);
}
