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
use crate::app::storage::fit_record::on_one_line;
use crate::app::storage::saved_fit::{RestoredFit, SavedFit, SavedMeasurement};
use crate::app::storage::session_error::{SESSION_FORMAT, SESSION_VERSION, SavedFitError, SessionError};
use crate::app::storage::settings_file::{SavedSettings, SurfaceOfFile};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::layout::Layout;
use crate::app::work::measurement_list::MeasurementList;
use crate::app::work::open_measurement::{MeasurementStyle, OpenMeasurement, drawn_at_first};
use crate::app::work::settings::Settings;
use crate::app::work::surface::{PinnedSurface, Surface};
use crate::app::work::workspace::Workspace;
use crate::files::export::program;
use pbrdf::measurement::{Measurement, ReadError};
use pbrdf::model::ParameterSet;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
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
    measurements: Vec<Table>,
    #[serde(skip_serializing_if = "is_default")]
    active: usize,
    #[serde(skip_serializing_if = "is_default")]
    shared: ParameterSet,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pinned: &'a [PinnedSurface],
    fits: &'a [SavedFit],
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
    measurement: Option<Table>,
    #[serde(default)]
    measurements: Vec<Table>,
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

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Files that do not say which fit was shown show the newest.
#[expect(clippy::unnecessary_wraps, reason = "the type of the key")]
fn newest() -> Option<usize> {
    Some(0)
}

/// A measurement in the file.
#[derive(Serialize, Deserialize)]
struct Table {
    name: String,
    sha256: Option<String>,
    #[serde(default = "yes")]
    open: bool,
    /// That of an open measurement that is not the active one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surface: Option<Surface>,
    #[serde(default, skip_serializing_if = "is_default")]
    style: MeasurementStyle,
    /// The series that plots show, from 0, if not those that they show at first.
    #[serde(default, skip_serializing_if = "Option::is_none", serialize_with = "on_one_line")]
    drawn: Option<Vec<usize>>,
    /// Which fit is shown while it is active, from 0, if it is not now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shown: Option<usize>,
    /// Whether the next measurement that is opened takes its place.
    #[serde(default, skip_serializing_if = "is_default")]
    placeholder: bool,
    /// The lines of a measurement file.
    table: Vec<String>,
}

fn yes() -> bool {
    true
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
    pub fits: Vec<SavedFit>,
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

impl Session {
    /// The work as it is now, with its fits and the data that they were made from.
    pub fn of(work: &Workspace) -> Self {
        let list = work.measurements();
        let (mut measurements, mut numbers) = (Vec::new(), Vec::new());
        for (index, open) in list.iter().enumerate().filter(|(_, open)| !open.measurement.rows.is_empty()) {
            let surface = (index != list.active_index()).then(|| open.surface.clone());
            let OpenMeasurement { name, sha256, measurement, style, is_placeholder, .. } = open.clone();
            let drawn = (*open.drawn() != drawn_at_first(open.series.len())).then(|| open.drawn().to_vec());
            let saved = SavedMeasurement { name, sha256, surface, style, drawn, is_placeholder, ..SavedMeasurement::of(measurement) };
            measurements.push(saved);
            numbers.push(open.number);
        }
        let (mut fits, mut shown, mut rows) = (Vec::new(), None, 0);
        for fit in work.fit_history().iter() {
            let index = numbers.iter().position(|number| *number == fit.number).unwrap_or_else(|| {
                numbers.push(fit.number);
                numbers.len() - 1
            });
            if index == measurements.len() {
                rows += fit.data.rows.len();
                if rows > MOST_CLOSED_ROWS {
                    break;
                }
                let (name, sha256, measurement) = (fit.document.clone(), fit.sha256.clone(), fit.data.clone());
                let closed = SavedMeasurement { name, sha256, is_open: false, ..SavedMeasurement::of(measurement) };
                measurements.push(closed);
            }
            if work.shown_fit_of(fit.number).is_some_and(|shown| Arc::ptr_eq(fit, shown)) {
                let is_active = fit.number == work.active().number;
                *(if is_active { &mut shown } else { &mut measurements[index].shown_fit }) = Some(fits.len());
            }
            fits.push(SavedFit::new(fit, index));
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

    /// The work that it holds, with its fits restored.
    pub fn into_work(self, fits: Vec<RestoredFit>) -> Workspace {
        let SavedSettings { settings, surface } = self.settings;
        let shown: Vec<Option<usize>> = self.measurements.iter().map(|saved| saved.shown_fit).chain([self.shown]).collect();
        let opened = |saved: SavedMeasurement| {
            let opened = OpenMeasurement::new(saved.name, Arc::unwrap_or_clone(saved.measurement)).of_file(saved.sha256);
            let surface = saved.surface.unwrap_or_else(|| surface.clone());
            let mut opened = opened.with_surface(surface);
            (opened.style, opened.is_placeholder) = (saved.style, saved.is_placeholder);
            if let Some(drawn) = saved.drawn {
                opened.set_drawn(&drawn.into());
            }
            (saved.is_open, opened)
        };
        let measurements: Vec<(bool, OpenMeasurement)> = self.measurements.into_iter().map(opened).collect();
        let entry = |fit: RestoredFit| {
            let (_, about) = &measurements[fit.measurement];
            let OpenMeasurement { ref name, ref sha256, ref measurement, number, generation, .. } = *about;
            // A fit with another mask is of no generation of its measurement.
            let generation = if fit.mask == *about.mask() { generation } else { 0 };
            let RestoredFit { report, problem, before, mask, .. } = fit;
            let (document, sha256, data) = (name.clone(), sha256.clone(), measurement.clone());
            FitEntry { id: 0, report, problem, before, document, sha256, data, number, generation, mask }
        };
        let is_shown = |index| shown.contains(&Some(index));
        let entries = fits.into_iter().enumerate().rev().map(|(index, fit)| (entry(fit), is_shown(index)));
        let entries: Vec<(FitEntry, bool)> = entries.collect();
        let active = measurements.iter().take(self.active).filter(|(is_open, _)| *is_open).count();
        let open: Vec<OpenMeasurement> = measurements.into_iter().filter(|(is_open, _)| *is_open).map(|(_, open)| open).collect();
        let mut list = MeasurementList::several(open, active, self.shared);
        list.active_mut().surface = surface;
        Workspace::restored(settings, self.layout, list, self.pinned, entries)
    }

    fn contents(&self) -> io::Result<Contents<'_>> {
        let table = |measurement: &Arc<Measurement>| -> io::Result<Vec<String>> {
            let mut bytes = Vec::new();
            measurement.write(&mut bytes)?;
            Ok(String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect())
        };
        let measurements = self.measurements.iter().map(|saved| -> io::Result<Table> {
            let SavedMeasurement { name, sha256, is_open, surface, style, drawn, shown_fit, is_placeholder, measurement } = saved.clone();
            let (open, shown, placeholder, table) = (is_open, shown_fit, is_placeholder, table(&measurement)?);
            Ok(Table { name, sha256, open, surface, style, drawn, shown, placeholder, table })
        });
        let lesson = self.lesson.as_ref().map(|lesson| -> io::Result<_> {
            Ok(LessonContents { title: lesson.title.clone(), step: lesson.step, work: Box::new(lesson.work.contents()?) })
        });
        Ok(Contents {
            format: SESSION_FORMAT,
            version: SESSION_VERSION,
            program: program(),
            settings: &self.settings,
            layout: &self.layout,
            measurements: measurements.collect::<io::Result<_>>()?,
            active: self.active,
            shared: self.shared,
            pinned: &self.pinned,
            fits: &self.fits,
            shown: self.shown,
            file: &self.file,
            lesson: lesson.transpose()?,
        })
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
        let measurements = tables.map(|table| -> Result<SavedMeasurement, ReadError> {
            let Table { name, sha256, open: is_open, surface, style, drawn, shown: shown_fit, placeholder: is_placeholder, table } = table;
            let measurement = Arc::new(Measurement::read(table.join("\n").as_bytes())?);
            Ok(SavedMeasurement { name, sha256, is_open, surface, style, drawn, shown_fit, is_placeholder, measurement })
        });
        let mut measurements = measurements.collect::<Result<Vec<_>, _>>().map_err(SessionError::Measurement)?;
        let mut others = measurements.iter().filter_map(|saved| saved.surface.as_ref());
        others.try_for_each(Surface::validate).map_err(SessionError::Settings)?;
        let (mut fits, mut places, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
        for (index, value) in stored.into_iter().enumerate() {
            match SavedFit::read(value, &measurements) {
                Ok(recipe) => {
                    places.push(index);
                    fits.push(recipe);
                }
                Err(error) => left_out.push((index + 1, error)),
            }
        }
        let place_of = |stored: Option<usize>| places.iter().position(|place| Some(*place) == stored);
        measurements.iter_mut().for_each(|saved| saved.shown_fit = place_of(saved.shown_fit));
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
    use super::{Layout, Measurement, MeasurementList, OpenMeasurement, PinnedSurface, Session, Settings, Surface, Workspace};
    use crate::app::work::open_measurement::{EXAMPLES, MeasurementStyle};
    use crate::figure::Symbol;
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
