//! Measurements open: at the start, from files, and through the dialog that asks about foreign
//! ones.

use crate::app::platform;
use crate::app::shell::app::App;
use crate::app::shell::app::lesson::close_lesson;
use crate::app::shell::app::title::mark_saved;
use crate::app::shell::import_dialog::ImportDialog;
use crate::app::shell::lessons::{Lessons, own_folder};
use crate::app::storage::export::ExportKind;
use crate::app::storage::folder::measurements_in;
use crate::app::storage::import::{Loaded, Origin, note_source};
use crate::app::tasks::files::{Alike, LoadedFile, Reopened, WithoutFiles};
use crate::app::text::localized::Localized;
use crate::app::views::Views;
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::{EXAMPLES, OpenMeasurement};
use pbrdf::measurement::Measurement;
use pbrdf::measurement::formats::{ImportError, ImportNote, Imported};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tr::tr;

/// Opens the first example, in whose place the first measurement comes.
pub fn begin(app: &mut App) {
    // Tests read no folders of the user.
    let own = app.persistence.settings_path.as_ref().and_then(|_| own_folder());
    read_lessons(app, own.as_deref());
    let example = &EXAMPLES[0];
    match Measurement::read(example.text.as_bytes()) {
        Ok(measurement) => {
            let mut opened = OpenMeasurement::new(example.name.to_owned(), measurement);
            opened.is_placeholder = true;
            open(app, opened);
        }
        Err(error) => app.toasts.error(tr!("The bundled example cannot be read: {}.", error.localized())),
    }
    mark_saved(app);
    // The settings file knows this.
    app.persistence.saved_settings = Some((app.work.revision(), app.window.clone()));
}

/// Reads files, and those of folders: a session first, then the measurements, beside what is open by
/// then.
pub fn open_files(app: &mut App, paths: Vec<PathBuf>) -> Result<(), String> {
    let paths: Vec<PathBuf> = paths.into_iter().flat_map(|path| if path.is_dir() { files_of(app, &path) } else { vec![path] }).collect();
    if paths.is_empty() {
        return Ok(());
    }
    let (sessions, mut measurements): (Vec<PathBuf>, Vec<PathBuf>) =
        paths.into_iter().partition(|path| ExportKind::Session.check(path).is_ok());
    if let Some(session) = sessions.into_iter().next() {
        app.jobs.files.open_session(session)?;
    }
    app.jobs.files.waiting.append(&mut measurements);
    open_waiting(app);
    Ok(())
}

/// The measurements of a folder; where there are none, a sentence says so.
fn files_of(app: &mut App, folder: &Path) -> Vec<PathBuf> {
    match measurements_in(folder) {
        Ok(files) => {
            if files.is_empty() {
                app.toasts.load_error(tr!("{}: there is no measurement in this folder.", folder.display()));
            }
            files
        }
        Err(error) => {
            app.toasts.load_error(tr!("{0}: {1}.", folder.display(), tr!("the folder cannot be read: {}", error.localized())));
            Vec::new()
        }
    }
}

/// Reads the files that wait, once nothing else is being read.
pub fn open_waiting(app: &mut App) {
    if !app.jobs.files.waiting.is_empty() && !app.jobs.files.is_reading() {
        let paths = std::mem::take(&mut app.jobs.files.waiting);
        if let Err(sentence) = app.jobs.files.open(paths) {
            app.toasts.error(sentence);
        }
    }
}

/// The bundled lessons and those of a folder, and a sentence for each that is none.
pub fn read_lessons(app: &mut App, own: Option<&Path>) {
    let (lessons, faults) = Lessons::load(own);
    app.lessons = lessons;
    faults.into_iter().for_each(|sentence| app.toasts.error(sentence));
}

/// Adds a measurement to those that are open.
pub fn open(app: &mut App, opened: OpenMeasurement) {
    for note in &opened.measurement.notes {
        app.toasts.error(format!("{}: {}", opened.name, note.localized()));
    }
    if !opened.measurement.ignored_columns.is_empty() {
        let note = ImportNote::IgnoredColumns { names: opened.measurement.ignored_columns.clone() };
        app.toasts.error(format!("{}: {note}.", opened.name));
    }
    let place = |app: &App| (app.work.settings().theta_i, app.work.settings().dphi);
    let before = place(app);
    app.work.apply(Edit::Open(Box::new(opened)));
    let (theta_i, dphi) = place(app);
    if (theta_i, dphi) != before {
        app.toasts.info(tr!("Lobes are now seen at θi = {0}°, Δφ = {1}°, where something was measured.", theta_i, dphi));
    }
    app.views = Views::default();
}

/// What files hold has been read: measurements open at once, foreign files ask one after the other,
/// what cannot be read is named.
pub fn files_loaded(app: &mut App, files: Vec<LoadedFile>) {
    let (mut first, mut errors) = (None, Vec::new());
    for LoadedFile { origin, result } in files {
        match result {
            Ok(Loaded::Measurement(imported)) => {
                let opened = loaded(app, origin, *imported);
                first = first.or(opened);
            }
            Ok(Loaded::Foreign(file)) => {
                origin.path.iter().for_each(|path| app.dialogs.path_entry.clear_if(path));
                app.dialogs.imports_waiting.push_back(ImportDialog::new(origin, file));
            }
            Err(sentence) => {
                origin.path.iter().for_each(|path| app.window.forget(path));
                errors.push(sentence);
            }
        }
    }
    if let Some(number) = first {
        app.work.apply(Edit::Activate(number));
    }
    errors.into_iter().for_each(|sentence| app.toasts.load_error(sentence));
    ask_next(app);
}

/// Shows the questions of the next foreign file, if none are on screen.
fn ask_next(app: &mut App) {
    if app.dialogs.import.is_some() {
        return;
    }
    let Some(mut import) = app.dialogs.imports_waiting.pop_front() else { return };
    if let Some(shape) = import.shape().cloned() {
        import.recall(app.window.imports.recall(&shape));
        let alike = app.dialogs.imports_waiting.iter().filter(|other| other.shape() == Some(&shape));
        import.alike.opened = alike.filter_map(|other| other.origin.path.clone()).collect();
        // They were chosen together.
        import.alike.are_meant = !import.alike.opened.is_empty();
        let without = WithoutFiles {
            paths: app.dialogs.imports_waiting.iter().filter_map(|other| other.origin.path.clone()).collect(),
            sha256: app.work.measurements().iter().filter_map(|open| open.sha256.clone()).collect(),
        };
        if let Some(path) = import.origin.path.clone()
            && let Err(sentence) = app.jobs.files.find_alike(path, shape, without)
        {
            app.toasts.error(sentence);
        }
    }
    app.dialogs.import = Some(import);
}

/// Files of the folder have been found that the answers may be for too.
pub fn alike_found(app: &mut App, Alike { of, paths }: Alike) {
    if let Some(import) = &mut app.dialogs.import
        && import.origin.path.as_ref() == Some(&of)
    {
        import.alike.folder = paths;
    }
}

/// Reads the cells anew where the options ask for another sheet or thousands separator.
pub fn reopen_if_asked(app: &mut App) {
    let Some(import) = &mut app.dialogs.import else { return };
    if let Some(options) = import.asks_for_other_cells()
        && let Err(sentence) = app.jobs.files.reopen(Arc::clone(&import.file), options)
    {
        app.toasts.error(sentence);
    }
}

pub fn reopened(app: &mut App, Reopened { options, file }: Reopened) {
    if let Some(import) = &mut app.dialogs.import {
        import.reopened(&options, file);
    }
}

/// Reads the whole foreign file with the options.
pub fn start_import(app: &mut App) -> Result<(), String> {
    match &app.dialogs.import {
        Some(import) => app.jobs.files.import(Arc::clone(&import.file), import.options.clone()),
        None => Ok(()),
    }
}

/// Closes the dialog; what is open stays, and the next foreign file asks.
pub fn cancel_import(app: &mut App) {
    if app.dialogs.import.take().is_some() {
        app.jobs.files.import.abandon();
        app.jobs.files.abandon_dialog();
        ask_next(app);
    }
}

pub fn imported(app: &mut App, result: Result<Imported, ImportError>) {
    match (result, app.dialogs.import.take()) {
        (Ok(mut imported), Some(import)) => {
            app.jobs.files.abandon_dialog();
            let answers = import.answers();
            answers.iter().for_each(|answers| app.window.imports.keep(answers));
            note_source(&mut imported, &import.origin.name);
            let alike = if import.alike.are_meant { import.alike.paths().to_vec() } else { Vec::new() };
            if let Some(number) = loaded(app, import.origin, imported) {
                app.work.apply(Edit::Activate(number));
            }
            if let Some(answers) = answers.filter(|_| !alike.is_empty()) {
                app.dialogs.imports_waiting.retain(|other| other.origin.path.as_ref().is_none_or(|path| !alike.contains(path)));
                if let Err(sentence) = app.jobs.files.open_alike(alike, answers) {
                    app.toasts.error(sentence);
                }
            }
            ask_next(app);
        }
        (Err(error), Some(mut import)) => {
            import.error = Some(error);
            app.dialogs.import = Some(import);
        }
        // The dialog was closed meanwhile.
        (_, None) => {}
    }
}

/// A file among the recent ones, where the next start finds it again.
pub fn remember(app: &mut App, path: &Path) {
    if !platform::IS_PAGE {
        app.window.remember(path);
    }
}

/// Adds the measurements that were read; the answer is the number of the first.
fn loaded(app: &mut App, origin: Origin, imported: Imported) -> Option<u64> {
    let Origin { name, path, sha256 } = origin;
    app.toasts.dismiss_load_errors();
    // A file is the user's own work, and takes the place of what was set aside.
    if path.is_some() && app.lessons.session.is_some() {
        close_lesson(app);
        app.toasts.error(tr!("The lesson has ended, because {} was opened.", name));
    }
    if let Some(path) = &path {
        app.dialogs.path_entry.clear_if(path);
        remember(app, path);
    }
    let about = imported.notes.iter().map(Localized::localized).collect::<Vec<_>>().join(" ");
    if !about.is_empty() {
        app.toasts.error(format!("{name}: {about}"));
    }
    let is_single = imported.measurements.len() == 1;
    let mut first = None;
    for measurement in imported.measurements {
        let own = if is_single || measurement.name.is_empty() { name.clone() } else { format!("{name} – {}", measurement.name) };
        let opened = OpenMeasurement::new(own, measurement).of_file(sha256.clone());
        first = first.or(Some(opened.number));
        open(app, opened);
    }
    first
}
