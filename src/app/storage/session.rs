//! A session as a file: everything that the user set, the data with their masks, and the fits, so that it opens on another machine.
//!
//! `*.pbrdf.json` is JSON with the keys `format` ("pbrdf-session"), `version`, `program`, `settings`, `layout`, `measurements` and `fits`.
//! A measurement stands in it as the lines of its CSV, so that its reader checks it and names the line of an error. Beside the open
//! measurement the list holds those that only fits belong to. Of a fit the file holds which measurement it was about, from where it
//! began, where it ended and how it came about; residuals and errors follow from that when the file is opened.
//!
//! Version 1 has one `measurement` instead of the list, and all fits are about it.

use crate::app::storage::earlier_keys::{EarlierFile, EarlierKeys};
use crate::app::storage::fit_record::{FitRecord, FitRecordError, on_one_line};
use crate::app::text::localized::Localized;
use crate::app::work::document::{Document, Mask, masked_rows};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::layout::Layout;
use crate::app::work::settings::{Settings, SettingsError, can_be_set};
use crate::app::work::workspace::Workspace;
use crate::files::export::program;
use pbrdf::fit::{Bounds, BoundsError, Course, FitOptions, FitResult, Observer, Problem, ProblemError, Starts, fit};
use pbrdf::measurement::{Measurement, ReadError};
use pbrdf::model::{Model, Parameter, ParameterError, ParameterSet, Parameters};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::{self, Write};
use std::sync::Arc;
use tr::tr;

const FORMAT: &str = "pbrdf-session";
/// Files of a later version are refused: they may mean something else. Earlier ones are read.
const VERSION: u32 = 2;

/// What the first look at a file asks.
#[derive(Deserialize)]
struct Header {
    format: Option<String>,
    version: Option<u32>,
}

/// The file, key by key.
#[derive(Serialize, Deserialize)]
struct Contents<F> {
    format: String,
    version: u32,
    program: String,
    settings: Settings,
    #[serde(deserialize_with = "Layout::lenient")]
    layout: Layout,
    /// The one of version 1.
    #[serde(default, skip_serializing)]
    measurement: Option<Table>,
    #[serde(default)]
    measurements: Vec<Table>,
    fits: Vec<F>,
    /// Which of them was shown, from 0.
    #[serde(default = "newest")]
    shown: Option<usize>,
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
    /// The lines of a measurement file.
    table: Vec<String>,
}

fn yes() -> bool {
    true
}

/// What a fit was about, and where it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedFit {
    /// Which measurement of the session, from 0.
    #[serde(default)]
    measurement: usize,
    model: Model,
    start: Parameters,
    free: Vec<Parameter>,
    bounds: Vec<(Parameter, f64, f64)>,
    choices: FitOptions,
    /// The solution.
    parameters: Parameters,
    /// The sliders before it.
    before: Parameters,
    /// How it came about; older files do not tell.
    #[serde(default)]
    account: Option<FitRecord>,
    /// The rows that were masked, from 0, where no account tells; without, those that the measurement has masked.
    #[serde(default, skip_serializing_if = "Option::is_none", serialize_with = "on_one_line")]
    masked: Option<Vec<usize>>,
}

/// A measurement of a session.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedMeasurement {
    pub name: String,
    /// Hash of the file that it came from.
    pub sha256: Option<String>,
    /// Whether it is open; if not, a fit is about it.
    pub is_open: bool,
    pub measurement: Arc<Measurement>,
}

/// A fit of a session, made again.
pub struct RestoredFit {
    /// Which measurement of the session, from 0.
    pub measurement: usize,
    pub report: FitResult,
    pub problem: Arc<Problem>,
    /// The sliders before it.
    pub before: Parameters,
    /// The rows that were masked.
    pub mask: Mask,
}

/// A session.
#[derive(Debug, Clone)]
pub struct Session {
    pub settings: Settings,
    pub layout: Layout,
    /// The open one, if there is one, and those that fits are about.
    pub measurements: Vec<SavedMeasurement>,
    /// The newest first.
    pub fits: Vec<SavedFit>,
    /// Which of them is shown.
    pub shown: Option<usize>,
    /// The fits of its file that are not among them, by number from 1; none of it is written.
    pub left_out: Arc<[(usize, SavedFitError)]>,
}

/// Why a file is no session.
#[derive(Debug)]
pub enum SessionError {
    /// It is no JSON, or JSON of something else.
    Json(JsonError),
    /// It does not say that it is a session.
    Format,
    /// It is of a version that this program does not read.
    Version { found: u32 },
    /// A setting means nothing.
    Settings(SettingsError),
    /// Its table cannot be read.
    Measurement(ReadError),
}

/// A place in JSON, and what is wrong there.
#[derive(Debug)]
pub struct JsonError {
    path: String,
    error: serde_json::Error,
}

/// Why a fit of a session is left out.
#[derive(Debug)]
pub enum SavedFitError {
    Json(JsonError),
    Bounds(BoundsError),
    Record(FitRecordError),
    /// The session has no measurement of its number.
    Measurement,
    /// Its masked rows are not in their order, or not all in the table.
    Mask,
    Parameters(ParameterError),
    Problem(ProblemError),
}

impl From<serde_path_to_error::Error<serde_json::Error>> for JsonError {
    fn from(error: serde_path_to_error::Error<serde_json::Error>) -> Self {
        Self { path: error.path().to_string(), error: error.into_inner() }
    }
}

impl From<serde_json::Error> for JsonError {
    fn from(error: serde_json::Error) -> Self {
        Self { path: String::new(), error }
    }
}

impl Localized for JsonError {
    fn localized(&self) -> String {
        match self.path.as_str() {
            "" | "." | "?" => self.error.localized(),
            path => tr!("{0}: {1}", path, self.error.localized()),
        }
    }
}

impl Localized for SessionError {
    fn localized(&self) -> String {
        match self {
            Self::Json(error) => error.localized(),
            Self::Format => tr!("this is no session: expected JSON with \"format\": \"{}\"", FORMAT),
            Self::Version { found } => tr!("the session is of version {0}; this program reads version {1}", found, VERSION),
            Self::Settings(error) => format!("settings.{}", error.localized()),
            Self::Measurement(error) => tr!("{0}: {1}", "measurement.table", error.localized()),
        }
    }
}

impl Localized for SavedFitError {
    fn localized(&self) -> String {
        match self {
            Self::Json(error) => error.localized(),
            Self::Bounds(error) => error.localized(),
            Self::Record(error) => error.localized(),
            Self::Measurement => tr!("measurement: the session has none of that number"),
            Self::Mask => tr!("masked: the rows are not in their order, or not all in the table"),
            Self::Parameters(error) => error.localized(),
            Self::Problem(error) => error.localized(),
        }
    }
}

impl SavedFit {
    /// A fit about the measurement of that number in the session, from 0.
    pub fn new(fit: &FitEntry, measurement: usize) -> Self {
        let problem = &fit.problem;
        let bounds = problem.free().iter().map(|&parameter| {
            let (low, high) = problem.bounds().of(parameter);
            (parameter, low, high)
        });
        let account = FitRecord::new(fit);
        Self {
            measurement,
            masked: account.is_none().then(|| fit.mask.to_vec()),
            model: problem.model(),
            start: *problem.start(),
            free: problem.free().to_vec(),
            bounds: bounds.collect(),
            choices: *problem.options(),
            parameters: fit.report.parameters,
            before: fit.before,
            account,
        }
    }

    /// A fit of a file, if it can be one of its measurement.
    fn read(value: serde_json::Value, measurements: &[SavedMeasurement]) -> Result<Self, SavedFitError> {
        let earlier = EarlierKeys::deserialize(&value).map_err(|error| SavedFitError::Json(error.into()));
        let mut recipe: Self = serde_path_to_error::deserialize(value).map_err(|error| SavedFitError::Json(error.into()))?;
        earlier?.apply(&mut recipe.model);
        // Earlier releases took weights of any size.
        for parameters in [&mut recipe.start, &mut recipe.parameters, &mut recipe.before] {
            *parameters = parameters.flushed_to_zero();
        }
        // Some files have an account that tells of the mask alone.
        if let Some(account) = recipe.account.take_if(|account| account.is_empty()) {
            recipe.masked = Some(account.into_mask());
        }
        let measurement = measurements.get(recipe.measurement).ok_or(SavedFitError::Measurement)?;
        recipe.problem(&measurement.measurement).map(|_| recipe)
    }

    /// The rows that were masked, where the file tells.
    fn mask(&self) -> Option<&[usize]> {
        self.account.as_ref().map(FitRecord::mask).or(self.masked.as_deref())
    }

    /// The measurement with the mask that it had.
    fn masked<'a>(&self, measurement: &'a Measurement) -> Cow<'a, Measurement> {
        let mut masked = Cow::Borrowed(measurement);
        let Some(mask) = self.mask() else { return masked };
        let is_masked = |row: usize| mask.binary_search(&row).is_ok();
        if measurement.rows.iter().enumerate().any(|(i, row)| row.masked != is_masked(i)) {
            masked.to_mut().rows.iter_mut().enumerate().for_each(|(i, row)| row.masked = is_masked(i));
        }
        masked
    }

    fn problem(&self, measurement: &Measurement) -> Result<Problem, SavedFitError> {
        let mut bounds = Bounds::default();
        for &(parameter, low, high) in &self.bounds {
            bounds.set(parameter, low, high).map_err(SavedFitError::Bounds)?;
        }
        if let Some(fault) = self.account.as_ref().and_then(|account| account.fault(self.free.len())) {
            return Err(SavedFitError::Record(fault));
        }
        if self.mask().is_some_and(|mask| !is_mask(mask, measurement.rows.len())) {
            return Err(SavedFitError::Mask);
        }
        let places = self.account.iter().flat_map(|account| account.places(self.start, &self.free));
        for parameters in [self.start, self.parameters, self.before].into_iter().chain(places) {
            can_be_set(&parameters, self.model.parameters()).map_err(SavedFitError::Parameters)?;
        }
        let free: ParameterSet = self.free.iter().copied().collect();
        let problem = Problem::new(&self.masked(measurement), self.model, self.start, free, bounds, self.choices);
        problem.map_err(SavedFitError::Problem)
    }

    /// The fit again. None where the data of the session are no longer such that there is one.
    pub fn again(&self, measurements: &[SavedMeasurement]) -> Option<RestoredFit> {
        let measurement = &measurements.get(self.measurement)?.measurement;
        let problem = self.problem(measurement).ok()?;
        let report = match &self.account {
            Some(account) => account.report(&problem, &self.free)?,
            None => self.without_account(&problem),
        };
        let mask = self.mask().map_or_else(|| masked_rows(&measurement.rows), Mask::from);
        Some(RestoredFit { measurement: self.measurement, report, problem: Arc::new(problem), before: self.before, mask })
    }

    /// From its solution, where it stays; how it got there is not known.
    fn without_account(&self, problem: &Problem) -> FitResult {
        let mut report = fit(&problem.with_start(self.parameters), Starts::One, 0, Observer::NONE);
        for estimate in &mut report.estimates {
            estimate.start = self.start[estimate.parameter];
        }
        report.start_objective = problem.delta_e(&self.start);
        report.statistics.start_rss = problem.rss(&self.start);
        report.course = Course::default();
        report
    }
}

/// Whether these are rows of a table of so many, each once and in their order.
fn is_mask(rows: &[usize], of: usize) -> bool {
    rows.is_sorted_by(|one, next| one < next) && rows.last().is_none_or(|&last| last < of)
}

/// Rows of closed measurements that a session keeps for their fits; fits of older ones are left out.
const MOST_CLOSED_ROWS: usize = 20_000;

impl Session {
    /// The work as it is now, with its fits and the data that they were made from.
    pub fn of(work: &Workspace, layout: Layout) -> Self {
        let Workspace { settings, document, fit_history, shown_fit, .. } = work;
        let mut measurements = Vec::new();
        let mut numbers = Vec::new();
        if !document.measurement.rows.is_empty() {
            let (name, sha256, measurement) = (document.name.clone(), document.sha256.clone(), document.measurement.clone());
            measurements.push(SavedMeasurement { name, sha256, is_open: true, measurement });
            numbers.push(document.number);
        }
        let (mut fits, mut shown, mut rows) = (Vec::new(), None, 0);
        for fit in fit_history.iter() {
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
                measurements.push(SavedMeasurement { name, sha256, is_open: false, measurement });
            }
            if shown_fit.as_ref().is_some_and(|shown| Arc::ptr_eq(fit, shown)) {
                shown = Some(fits.len());
            }
            fits.push(SavedFit::new(fit, index));
        }
        Self { settings: settings.clone(), layout, measurements, fits, shown, left_out: Arc::default() }
    }

    /// The work that it holds, with its fits restored.
    pub fn into_work(self, fits: Vec<RestoredFit>) -> Workspace {
        let document = |saved: SavedMeasurement| Document::new(saved.name, Arc::unwrap_or_clone(saved.measurement)).of_file(saved.sha256);
        let open = self.measurements.iter().position(|saved| saved.is_open);
        let mut documents: Vec<Document> = self.measurements.into_iter().map(document).collect();
        let entry = |fit: RestoredFit| {
            let Document { ref name, ref sha256, ref measurement, number, generation, .. } = documents[fit.measurement];
            // A fit with another mask is of no generation of its measurement.
            let generation = if fit.mask == *documents[fit.measurement].mask() { generation } else { 0 };
            let RestoredFit { report, problem, before, mask, .. } = fit;
            let (document, sha256, data) = (name.clone(), sha256.clone(), measurement.clone());
            FitEntry { id: 0, report, problem, before, document, sha256, data, number, generation, mask }
        };
        let shown = self.shown;
        let entries = fits.into_iter().enumerate().rev().map(|(index, fit)| (entry(fit), shown == Some(index)));
        let entries: Vec<(FitEntry, bool)> = entries.collect();
        let open = open.map_or_else(|| Document::new(String::new(), Measurement::default()), |open| documents.swap_remove(open));
        Workspace::restored(self.settings, open, entries)
    }

    /// Writes it: one key, and one row of the table, a line.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let table = |measurement: &Arc<Measurement>| -> io::Result<Vec<String>> {
            let mut bytes = Vec::new();
            measurement.write(&mut bytes)?;
            Ok(String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect())
        };
        let measurements = self.measurements.iter().map(|saved| -> io::Result<Table> {
            let SavedMeasurement { name, sha256, is_open, measurement } = saved;
            Ok(Table { name: name.clone(), sha256: sha256.clone(), open: *is_open, table: table(measurement)? })
        });
        let contents = Contents {
            format: FORMAT.to_owned(),
            version: VERSION,
            program: program(),
            settings: self.settings.clone(),
            layout: self.layout.clone(),
            measurement: None,
            measurements: measurements.collect::<io::Result<_>>()?,
            fits: self.fits.iter().collect(),
            shown: self.shown,
        };
        serde_json::to_writer_pretty(&mut *out, &contents)?;
        writeln!(out)
    }

    /// Reads it, and checks that every value means something; a fit that does not is left out.
    pub fn read(text: &str) -> Result<Self, SessionError> {
        let header: Header = serde_json::from_str(text).map_err(|error| SessionError::Json(error.into()))?;
        match (header.format.as_deref(), header.version) {
            (Some(FORMAT), Some(1..=VERSION)) => {}
            (Some(FORMAT), Some(found)) => return Err(SessionError::Version { found }),
            _ => return Err(SessionError::Format),
        }
        let mut json = serde_json::Deserializer::from_str(text);
        let mut contents: Contents<serde_json::Value> =
            serde_path_to_error::deserialize(&mut json).map_err(|error| SessionError::Json(error.into()))?;
        let earlier: EarlierFile = serde_json::from_str(text).map_err(|error| SessionError::Json(error.into()))?;
        earlier.apply(&mut contents.settings);
        if let Some(fault) = contents.settings.fault() {
            return Err(SessionError::Settings(fault));
        }
        let Contents { settings, layout, measurement, measurements, fits: stored, shown: stored_shown, .. } = contents;
        let tables = measurement.into_iter().chain(measurements);
        let measurements = tables.map(|Table { name, sha256, open, table }| -> Result<SavedMeasurement, ReadError> {
            let measurement = Arc::new(Measurement::read(table.join("\n").as_bytes())?);
            Ok(SavedMeasurement { name, sha256, is_open: open, measurement })
        });
        let measurements = measurements.collect::<Result<Vec<_>, _>>().map_err(SessionError::Measurement)?;
        let (mut fits, mut shown, mut left_out) = (Vec::new(), None, Vec::new());
        for (index, value) in stored.into_iter().enumerate() {
            match SavedFit::read(value, &measurements) {
                Ok(recipe) => {
                    shown = shown.or_else(|| (stored_shown == Some(index)).then_some(fits.len()));
                    fits.push(recipe);
                }
                Err(error) => left_out.push((index + 1, error)),
            }
        }
        Ok(Self { settings, layout, measurements, fits, shown, left_out: left_out.into() })
    }
}
