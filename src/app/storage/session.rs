//! A session as a file: everything that the user set, the data with their masks, and the fits, so
//! that it opens on another machine.
//!
//! `*.pbrdf.json` is JSON with the keys `format` ("pbrdf-session"), `version`, `program`, `settings`, `layout`, `measurements` and `fits`.
//! A measurement stands in it as the lines of its CSV, so that its reader checks it and names the
//! line of an error. Beside the open measurement the list holds those that only fits belong to. Of
//! a fit the file holds which measurement it was about, from where it began, where it ended and how
//! it came about; residuals and errors follow from that when the file is opened.
//!
//! `settings` holds the surface of the active measurement among the rest; of several open measurements the others have a `surface` each.
//! Work that is kept without being asked names in `file` the session file that the user gave it.
//! Where a lesson is open, `lesson` holds its title, the step, and the lesson's own work as a
//! session; the rest is the user's work.
//!
//! Version 1 has one `measurement` instead of the list, and all fits are about it.

use crate::app::storage::earlier_keys::EarlierFile;
use crate::app::storage::measurement_table::{MeasurementTable, is_default};
use crate::app::storage::saved_comparison::SavedComparison;
use crate::app::storage::saved_entry::{RestoredEntry, SavedEntry};
use crate::app::storage::saved_fit::SavedMeasurement;
use crate::app::storage::session_error::{SESSION_FORMAT, SESSION_VERSION, SavedFitError, SessionError};
use crate::app::storage::settings_file::{SavedSettings, SurfaceOfFile};
use crate::app::work::fit_history::{FitEntry, KeptFit};
use crate::app::work::layout::Layout;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::{OpenMeasurement, drawn_at_first};
use crate::app::work::settings::Settings;
use crate::app::work::surface::{PinnedSurface, Surface};
use crate::app::work::workspace::Workspace;
use crate::files::export::program;

use pbrdf::model::{ParameterSet, Preset};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::mem;
use std::path::PathBuf;
use std::sync::Arc;

/// What the first look at a file asks.
#[derive(Deserialize)]
struct Header {
    format: Option<String>,
    version: Option<u32>,
}

/// The file, key by key, as it is written.
#[derive(Serialize)]
struct Contents<'a> {
    format: &'static str,
    version: u32,
    program: String,
    settings: &'a SavedSettings,
    layout: &'a Layout,
    measurements: Vec<MeasurementTable>,
    #[serde(skip_serializing_if = "is_default")]
    active: usize,
    #[serde(skip_serializing_if = "is_default")]
    shared: ParameterSet,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pinned: &'a [PinnedSurface],
    fits: &'a [SavedEntry],
    /// Which of them was shown, from 0.
    shown: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: &'a Option<SavedFile>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lesson: Option<LessonContents<Box<Contents<'a>>>>,
}

/// The file, key by key, as it is read.
#[derive(Deserialize)]
struct StoredContents {
    settings: Settings,
    #[serde(deserialize_with = "Layout::lenient")]
    layout: Layout,
    /// The one of version 1.
    #[serde(default)]
    measurement: Option<MeasurementTable>,
    #[serde(default)]
    measurements: Vec<MeasurementTable>,
    #[serde(default)]
    active: usize,
    #[serde(default)]
    shared: ParameterSet,
    #[serde(default)]
    pinned: Vec<PinnedSurface>,
    fits: Vec<serde_json::Value>,
    #[serde(default = "newest")]
    shown: Option<usize>,
    #[serde(default)]
    file: Option<SavedFile>,
    #[serde(default)]
    lesson: Option<LessonContents<serde_json::Value>>,
}

/// A lesson in the file: its title, the step from 0, and its work as a session.
#[derive(Serialize, Deserialize)]
struct LessonContents<W> {
    title: String,
    step: usize,
    work: W,
}

/// Of work that is kept without being asked: the file that the user saved it in, and whether that
/// holds all of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SavedFile {
    pub path: PathBuf,
    pub saved: bool,
}

/// Files that do not say which fit was shown show the newest.
#[expect(clippy::unnecessary_wraps, reason = "the type of the key")]
fn newest() -> Option<usize> {
    Some(0)
}

/// A session.
#[derive(Debug, Clone)]
pub struct Session {
    /// With the surface of the active measurement.
    pub settings: SavedSettings,
    pub layout: Layout,
    /// The open ones, and those that fits are about.
    pub measurements: Vec<SavedMeasurement>,
    /// Which of them is active.
    pub active: usize,
    /// The parameters that all open measurements share.
    pub shared: ParameterSet,
    pub pinned: Vec<PinnedSurface>,
    /// The newest first.
    pub fits: Vec<SavedEntry>,
    /// Which of them is shown.
    pub shown: Option<usize>,
    /// The fits of its file that are not among them, by number from 1; none of it is written.
    pub left_out: Arc<[(usize, SavedFitError)]>,
    pub file: Option<SavedFile>,
    /// The lesson that is open over this work.
    pub lesson: Option<Box<SavedLesson>>,
}

/// A lesson that is open: its title, the step from 0, and its work.
#[derive(Debug, Clone)]
pub struct SavedLesson {
    pub title: String,
    pub step: usize,
    pub work: Session,
}

/// Rows of closed measurements that a session keeps for their fits; fits of older ones are left
/// out.
const MOST_CLOSED_ROWS: usize = 20_000;

/// The measurements of a session that is put together.
struct Tables {
    measurements: Vec<SavedMeasurement>,
    /// Which measurements of the work they are.
    numbers: Vec<u64>,
    /// Rows of those that are not open.
    closed_rows: usize,
}

impl Tables {
    /// The place of the measurement that a fit is about; a closed one is added, while there is room.
    fn place_of(&mut self, fit: &FitEntry) -> Option<usize> {
        if let Some(place) = self.numbers.iter().position(|number| *number == fit.number) {
            return Some(place);
        }
        self.closed_rows += fit.data.rows.len();
        if self.closed_rows > MOST_CLOSED_ROWS {
            return None;
        }
        let (name, sha256, measurement) = (fit.document.clone(), fit.sha256.clone(), fit.data.clone());
        self.measurements.push(SavedMeasurement { name, sha256, is_open: false, ..SavedMeasurement::of(measurement) });
        self.numbers.push(fit.number);
        Some(self.numbers.len() - 1)
    }
}

impl Session {
    /// The work as it is now, with its fits and the data that they were made from.
    pub fn of(work: &Workspace) -> Self {
        let list = work.measurements();
        let (mut measurements, mut numbers) = (Vec::new(), Vec::new());
        for (index, open) in list.iter().enumerate().filter(|(_, open)| !open.measurement.rows.is_empty()) {
            let surface = (index != list.active_index()).then(|| open.surface.clone());
            let OpenMeasurement { name, sha256, measurement, style, weight, is_placeholder, .. } = open.clone();
            let drawn = (*open.drawn() != drawn_at_first(open.series.len())).then(|| open.drawn().to_vec());
            let saved =
                SavedMeasurement { name, sha256, surface, style, weight, drawn, is_placeholder, ..SavedMeasurement::of(measurement) };
            measurements.push(saved);
            numbers.push(open.number);
        }
        let mut tables = Tables { measurements, numbers, closed_rows: 0 };
        let (mut fits, mut ids, mut shown) = (Vec::new(), Vec::new(), None);
        for row in work.fit_history().rows(work.active().number) {
            let mut parts: Vec<&FitEntry> = work.fit_history().parts(row.id).map(|fit| &**fit).collect();
            parts.sort_by_key(|fit| fit.joint.as_ref().map(|part| part.set));
            let placed: Option<Vec<(&FitEntry, usize)>> = parts.iter().map(|&fit| Some((fit, tables.place_of(fit)?))).collect();
            let Some(placed) = placed else { break };
            let Some(saved) = SavedEntry::new(&placed) else { continue };
            let is_shown = |fit: &FitEntry| work.shown_fit_of(fit.number).is_some_and(|shown| shown.id == fit.id);
            for (fit, place) in placed.into_iter().filter(|(fit, _)| is_shown(fit)) {
                let is_active = fit.number == work.active().number;
                *(if is_active { &mut shown } else { &mut tables.measurements[place].shown_fit }) = Some(fits.len());
            }
            fits.push(saved);
            ids.push(row.id);
        }
        let Tables { mut measurements, numbers, .. } = tables;
        for (saved, &number) in measurements.iter_mut().zip(&numbers).filter(|(saved, _)| saved.is_open) {
            let place_of = |id: usize| ids.iter().position(|saved| *saved == id);
            saved.compared = SavedComparison::new(work.model_comparison_of(number), place_of);
        }
        Self {
            settings: SavedSettings { settings: work.settings().clone(), surface: work.surface().clone() },
            layout: work.layout().clone(),
            measurements,
            active: numbers.iter().position(|number| *number == work.active().number).unwrap_or(0),
            shared: list.shared(),
            pinned: work.pinned().to_vec(),
            fits,
            shown,
            left_out: Arc::default(),
            file: None,
            lesson: None,
        }
    }

    /// The work that it holds, with its fits restored, each in its place.
    pub fn into_work(self, fits: Vec<Option<RestoredEntry>>) -> Workspace {
        let SavedSettings { settings, surface } = self.settings;
        let mut shown: Vec<Option<usize>> = self.measurements.iter().map(|saved| saved.shown_fit).collect();
        if let Some(active) = shown.get_mut(self.active) {
            *active = self.shown.or(*active);
        }
        let opened = |saved: SavedMeasurement| {
            let opened = OpenMeasurement::new(saved.name, Arc::unwrap_or_clone(saved.measurement)).of_file(saved.sha256);
            let surface = saved.surface.unwrap_or_else(|| surface.clone());
            let mut opened = opened.with_surface(surface);
            (opened.style, opened.weight, opened.is_placeholder) = (saved.style, saved.weight, saved.is_placeholder);
            if let Some(drawn) = saved.drawn {
                opened.set_drawn(&drawn.into());
            }
            opened
        };
        let compared = |(measurement, saved): (usize, &SavedMeasurement)| {
            let is_fit_of =
                |fit: usize, preset: &Preset| fits.get(fit).and_then(Option::as_ref).is_some_and(|entry| entry.is_of(measurement, preset));
            saved.compared.presets(is_fit_of)
        };
        let compared: Vec<_> = self.measurements.iter().enumerate().map(compared).collect();
        let is_open: Vec<bool> = self.measurements.iter().map(|saved| saved.is_open).collect();
        let measurements: Vec<OpenMeasurement> = self.measurements.into_iter().map(opened).collect();
        let mut entries = Vec::new();
        for (index, fit) in fits.into_iter().enumerate().rev() {
            let parts = fit.into_iter().flat_map(|fit| fit.into_entries(&measurements));
            entries.extend(parts.map(|(measurement, fit)| {
                let (is_shown, compared_as) = (shown[measurement] == Some(index), compared[measurement].get(&index).copied());
                KeptFit { fit, is_shown, compared_as }
            }));
        }
        let active = is_open.iter().take(self.active).filter(|is_open| **is_open).count();
        let open = measurements.into_iter().zip(is_open).filter(|(_, is_open)| *is_open).map(|(measurement, _)| measurement);
        let mut list = MeasurementList::several(open.collect(), active, self.shared);
        list.active_mut().surface = surface;
        Workspace::restored(settings, self.layout, list, self.pinned, entries)
    }

    fn contents(&self) -> io::Result<Contents<'_>> {
        let lesson = self.lesson.as_ref().map(|lesson| -> io::Result<_> {
            Ok(LessonContents { title: lesson.title.clone(), step: lesson.step, work: Box::new(lesson.work.contents()?) })
        });
        Ok(Contents {
            format: SESSION_FORMAT,
            version: SESSION_VERSION,
            program: program(),
            settings: &self.settings,
            layout: &self.layout,
            measurements: self.measurements.iter().map(MeasurementTable::new).collect::<io::Result<_>>()?,
            active: self.active,
            shared: self.shared,
            pinned: &self.pinned,
            fits: &self.fits,
            shown: self.shown,
            file: &self.file,
            lesson: lesson.transpose()?,
        })
    }

    /// Measurements and fits of them, without the rest of a work.
    #[cfg(any(test, target_arch = "wasm32"))]
    pub fn of_fits(measurements: Vec<SavedMeasurement>, fits: Vec<SavedEntry>) -> Self {
        Self {
            settings: SavedSettings::default(),
            layout: Layout::default(),
            measurements,
            active: 0,
            shared: ParameterSet::EMPTY,
            pinned: Vec::new(),
            fits,
            shown: None,
            left_out: Arc::default(),
            file: None,
            lesson: None,
        }
    }

    /// The session on one line.
    ///
    /// # Errors
    /// Memory takes no more.
    pub fn to_json(&self) -> io::Result<String> {
        Ok(serde_json::to_string(&self.contents()?)?)
    }

    /// The same without fits, and without the measurements that only fits are about.
    pub fn without_fits(&self) -> Self {
        let mut session = Self { fits: Vec::new(), shown: None, ..self.clone() };
        // Those that are not open stand behind the open ones: the active one keeps its place.
        session.measurements.retain(|saved| saved.is_open);
        session.measurements.iter_mut().for_each(|saved| (saved.shown_fit, saved.compared) = (None, SavedComparison::default()));
        session
    }

    /// The same without any measurement: the surface of the active one, and what is pinned.
    pub fn without_measurements(&self) -> Self {
        Self { measurements: Vec::new(), active: 0, shared: ParameterSet::EMPTY, ..self.without_fits() }
    }

    /// Writes it: one key, and one row of the table, a line.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *out, &self.contents()?)?;
        writeln!(out)
    }

    /// Reads it, and checks that every value means something; a fit that does not is left out.
    pub fn read(text: &str) -> Result<Self, SessionError> {
        let header: Header = from_json(text)?;
        match (header.format.as_deref(), header.version) {
            (Some(SESSION_FORMAT), Some(1..=SESSION_VERSION)) => {}
            (Some(SESSION_FORMAT), Some(found)) => return Err(SessionError::Version { found }),
            _ => return Err(SessionError::Format),
        }
        let StoredContents {
            settings,
            layout,
            measurement,
            measurements,
            active,
            shared,
            pinned,
            fits: stored,
            shown: stored_shown,
            file,
            lesson,
        } = from_json(text)?;
        let SurfaceOfFile { settings: mut surface } = from_json(text)?;
        from_json::<EarlierFile>(text)?.apply(&mut surface);
        surface.validate().and_then(|()| settings.validate()).map_err(SessionError::Settings)?;
        let tables = measurement.into_iter().chain(measurements);
        let mut measurements =
            tables.map(MeasurementTable::into_measurement).collect::<Result<Vec<_>, _>>().map_err(SessionError::Measurement)?;
        let mut others = measurements.iter().filter_map(|saved| saved.surface.as_ref());
        others.try_for_each(Surface::validate).map_err(SessionError::Settings)?;
        let (mut fits, mut places, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
        for (index, value) in stored.into_iter().enumerate() {
            match SavedEntry::read(value, &measurements) {
                Ok(recipe) => {
                    places.push(index);
                    fits.push(recipe);
                }
                Err(error) => left_out.push((index + 1, error)),
            }
        }
        let place_of = |stored: Option<usize>| places.iter().position(|place| Some(*place) == stored);
        for saved in &mut measurements {
            saved.shown_fit = place_of(saved.shown_fit);
            saved.compared = mem::take(&mut saved.compared).moved(|fit| place_of(Some(fit)));
        }
        let shown = place_of(stored_shown);
        // The user's own work opens also where that of the lesson does not.
        let lesson = lesson.and_then(|LessonContents { title, step, work }| {
            let work = Self::read(&work.to_string()).ok()?;
            Some(Box::new(SavedLesson { title, step, work }))
        });
        let settings = SavedSettings { settings, surface };
        Ok(Self { settings, layout, measurements, active, shared, pinned, fits, shown, left_out: left_out.into(), file, lesson })
    }
}

/// What a file holds, or where it does not.
fn from_json<T: DeserializeOwned>(text: &str) -> Result<T, SessionError> {
    let mut json = serde_json::Deserializer::from_str(text);
    serde_path_to_error::deserialize(&mut json).map_err(|error| SessionError::Json(error.into()))
}

#[cfg(test)]
mod tests {
    use super::{Layout, MeasurementList, OpenMeasurement, PinnedSurface, Session, Settings, Surface, Workspace};
    use crate::app::work::open_measurement::{EXAMPLES, MeasurementStyle};
    use crate::figure::Symbol;
    use pbrdf::measurement::Measurement;
    use pbrdf::model::{Parameter, ParameterSet, Parameters};

    fn opened(example: usize, n: f64, style: MeasurementStyle) -> OpenMeasurement {
        let measurement = Measurement::read(EXAMPLES[example].text.as_bytes()).expect("an example is a measurement");
        let surface = Surface { parameters: Parameters { n, ..Parameters::default() }, ..Surface::for_measurement(&measurement) };
        let mut opened = OpenMeasurement::new(EXAMPLES[example].name.to_owned(), measurement).with_surface(surface);
        opened.style = style;
        opened
    }

    #[test]
    fn several_measurements_come_back_each_with_its_surface_and_what_they_share() {
        let hidden = MeasurementStyle { color: 3, marker: Symbol::Square, shown: false };
        let open = vec![opened(0, 1.5, hidden), opened(1, 2.5, MeasurementStyle::default()), opened(2, 3.5, hidden)];
        let shared = ParameterSet::EMPTY.with(Parameter::Sigma).with(Parameter::Q);
        let pinned = PinnedSurface::new("steel", Surface::default().model, Parameters::default(), &[], &[]);
        let list = MeasurementList::several(open, 1, shared);
        let before = Workspace::restored(Settings::default(), Layout::default(), list, vec![pinned], []);
        let mut text = Vec::new();
        Session::of(&before).write(&mut text).expect("memory takes everything");
        let session = Session::read(std::str::from_utf8(&text).expect("JSON")).expect("a session");
        let after = session.into_work(Vec::new());
        let of = |work: &Workspace| -> Vec<(String, Surface, MeasurementStyle)> {
            work.measurements().iter().map(|open| (open.name.clone(), open.surface.clone(), open.style)).collect()
        };
        assert_eq!(of(&after), of(&before));
        assert_eq!((after.active().name.as_str(), after.measurements().shared()), (EXAMPLES[1].name, shared));
        assert_eq!(after.pinned(), before.pinned());
    }
}
