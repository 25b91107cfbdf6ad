//! Measurements open: at the start, from files, and through the dialog that asks about foreign
//! ones.

use crate::app::shell::app::App;
use crate::app::shell::app::lesson::close_lesson;
use crate::app::shell::import_dialog::ImportDialog;
use crate::app::shell::lessons::{Lessons, own_folder};
use crate::app::storage::import::{Loaded, Origin};
use crate::app::tasks::files::LoadedFile;
use crate::app::text::localized::Localized;
use crate::app::views::Views;
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use crate::app::work::open_measurement::{EXAMPLES, OpenMeasurement};
use pbrdf::measurement::Measurement;
use pbrdf::measurement::formats::{ImportError, ImportNote, Imported};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tr::tr;

/// Opens the first example, and then the file if there is one: if that cannot be read, the example
/// stays.
pub fn begin(app: &mut App, file: Option<PathBuf>) {
    // Tests read no folders of the user.
    let own = app.persistence.settings_path.as_ref().and_then(|_| own_folder());
    read_lessons(app, own.as_deref());
    let example = &EXAMPLES[0];
    match Measurement::read(example.text.as_bytes()) {
        Ok(measurement) => open(app, OpenMeasurement::new(example.name.to_owned(), measurement)),
        Err(error) => app.toasts.error(tr!("The bundled example cannot be read: {}.", error.localized())),
    }
    // The settings file knows this.
    app.persistence.saved_settings = Some((app.work.revision(), app.window.clone()));
    app.actions.extend(file.map(Action::OpenMeasurement));
}

/// The bundled lessons and those of a folder, and a sentence for each that is none.
pub fn read_lessons(app: &mut App, own: Option<&Path>) {
    let (lessons, faults) = Lessons::load(own);
    app.lessons = lessons;
    faults.into_iter().for_each(|sentence| app.toasts.error(sentence));
}

/// Puts a measurement in the place of the active one.
pub fn open(app: &mut App, opened: OpenMeasurement) {
    app.dialogs.import = None;
    for note in &opened.measurement.notes {
        app.toasts.error(format!("{}: {}", opened.name, note.localized()));
    }
    if !opened.measurement.ignored_columns.is_empty() {
        let note = ImportNote::IgnoredColumns { names: opened.measurement.ignored_columns.clone() };
        app.toasts.error(format!("{}: {note}.", opened.name));
    }
    app.work.apply(Edit::Open(Box::new(opened)));
    app.views = Views::default();
    app.jobs.fits.abandon();
}

/// What a file holds has been read.
pub fn file_loaded(app: &mut App, LoadedFile { origin, result }: LoadedFile) {
    match result {
        Ok(Loaded::Measurement(imported)) => loaded(app, origin, *imported),
        Ok(Loaded::Foreign(file)) => {
            origin.path.iter().for_each(|path| app.dialogs.path_entry.clear_if(path));
            let mut import = ImportDialog::new(origin, file);
            app.dialogs.import_memory.recall(&mut import);
            app.dialogs.import = Some(import);
        }
        Err(sentence) => {
            origin.path.iter().for_each(|path| app.window.forget(path));
            app.toasts.load_error(sentence);
        }
    }
}

/// Reads the whole foreign file with the options.
pub fn start_import(app: &mut App) -> Result<(), String> {
    match &app.dialogs.import {
        Some(import) => app.jobs.files.import(Arc::clone(&import.file), import.options.clone()),
        None => Ok(()),
    }
}

/// Closes the dialog; the open measurement stays.
pub fn cancel_import(app: &mut App) {
    if app.dialogs.import.take().is_some() {
        app.jobs.files.abandon_load();
    }
}

pub fn imported(app: &mut App, result: Result<Imported, ImportError>) {
    match (result, app.dialogs.import.take()) {
        (Ok(mut imported), Some(import)) => {
            app.dialogs.import_memory.keep(&import);
            let name = import.origin.name.replace(char::is_control, " ");
            let source = ("imported_from".to_owned(), name);
            imported.measurements.iter_mut().for_each(|measurement| measurement.metadata.push(source.clone()));
            loaded(app, import.origin, imported);
        }
        (Err(error), Some(import)) => app.dialogs.import = Some(ImportDialog { error: Some(error), ..import }),
        // The dialog was closed meanwhile.
        (_, None) => {}
    }
}

/// Replaces the open measurement by one that was read.
fn loaded(app: &mut App, origin: Origin, imported: Imported) {
    let Origin { name, path, sha256 } = origin;
    app.toasts.dismiss_load_errors();
    // A file is the user's own work, and takes the place of what was set aside.
    if path.is_some() && app.lessons.session.is_some() {
        close_lesson(app);
        app.toasts.error(tr!("The lesson has ended, because {} was opened.", name));
    }
    if let Some(path) = &path {
        app.dialogs.path_entry.clear_if(path);
        app.window.remember(path);
    }
    let about = imported.notes.iter().map(Localized::localized).collect::<Vec<_>>().join(" ");
    if !about.is_empty() {
        app.toasts.error(format!("{name}: {about}"));
    }
    let is_single = imported.measurements.len() == 1;
    // The first is opened last, and so is the active one.
    for measurement in imported.measurements.into_iter().rev() {
        let own = if is_single || measurement.name.is_empty() { name.clone() } else { format!("{name} – {}", measurement.name) };
        open(app, OpenMeasurement::new(own, measurement).of_file(sha256.clone()));
    }
    app.work.apply(Edit::SetSessionFile(None));
}
