//! A session as a file: everything that the user set, the data with their masks, and the fits, so that it opens on another machine.
//!
//! `*.pbrdf.json` is JSON with the keys `format` ("pbrdf-session"), `version`, `program`, `settings`, `layout`, `measurement` and `fits`. The
//! measurement stands in it as the lines of its CSV, so that its reader checks it and names the line of an error. Of a fit the file holds what it was
//! about, where it ended and how it came about; residuals, errors and what is open follow from that when the file is opened.

use crate::app::storage::earlier_keys::{EarlierFile, EarlierKeys};
use crate::app::storage::fit_record::{FitRecord, FitRecordError, on_one_line};
use crate::app::text::localized::Localized;
use crate::app::work::document::{Mask, masked_rows};
use crate::app::work::fit_history::FitEntry;
use crate::app::work::layout::Layout;
use crate::app::work::settings::{Settings, SettingsError, can_be_set};
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
/// Files of a later version are refused: they may mean something else.
const VERSION: u32 = 1;

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
    measurement: Option<Data>,
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

#[derive(Serialize, Deserialize)]
struct Data {
    name: String,
    sha256: Option<String>,
    /// The lines of a measurement file.
    table: Vec<String>,
}

/// What a fit was about, and where it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedFit {
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

/// A fit of a session, made again.
pub struct RestoredFit {
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
    /// Name of the measurement.
    pub name: String,
    /// Hash of the file that the measurement came from.
    pub sha256: Option<String>,
    pub measurement: Option<Arc<Measurement>>,
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
            Self::Mask => tr!("masked: the rows are not in their order, or not all in the table"),
            Self::Parameters(error) => error.localized(),
            Self::Problem(error) => error.localized(),
        }
    }
}

impl SavedFit {
    pub fn new(fit: &FitEntry) -> Self {
        let problem = &fit.problem;
        let bounds = problem.free().iter().map(|&parameter| {
            let (low, high) = problem.bounds().of(parameter);
            (parameter, low, high)
        });
        let account = FitRecord::new(fit);
        Self {
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

    /// A fit of a file, if it can be one of this measurement.
    fn read(value: serde_json::Value, measurement: &Measurement) -> Result<Self, SavedFitError> {
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
        recipe.problem(measurement).map(|_| recipe)
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
    pub fn again(&self, measurement: &Measurement) -> Option<RestoredFit> {
        let problem = self.problem(measurement).ok()?;
        let report = match &self.account {
            Some(account) => account.report(&problem, &self.free)?,
            None => self.without_account(&problem),
        };
        let mask = self.mask().map_or_else(|| masked_rows(&measurement.rows), Mask::from);
        Some(RestoredFit { report, problem: Arc::new(problem), before: self.before, mask })
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

impl Session {
    /// Writes it: one key, and one row of the table, a line.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let table = |measurement: &Arc<Measurement>| -> io::Result<Vec<String>> {
            let mut bytes = Vec::new();
            measurement.write(&mut bytes)?;
            Ok(String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect())
        };
        let data = |measurement| -> io::Result<Data> {
            Ok(Data { name: self.name.clone(), sha256: self.sha256.clone(), table: table(measurement)? })
        };
        let contents = Contents {
            format: FORMAT.to_owned(),
            version: VERSION,
            program: program(),
            settings: self.settings.clone(),
            layout: self.layout.clone(),
            measurement: self.measurement.as_ref().map(data).transpose()?,
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
            (Some(FORMAT), Some(VERSION)) => {}
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
        let (name, sha256, measurement) = match contents.measurement {
            Some(Data { name, sha256, table }) => {
                let text = table.join("\n");
                (name, sha256, Some(Measurement::read(text.as_bytes()).map_err(SessionError::Measurement)?))
            }
            None => (String::new(), None, None),
        };
        let measurement = measurement.map(Arc::new);
        let Contents { settings, layout, fits: stored, shown: stored_shown, .. } = contents;
        let (mut fits, mut shown, mut left_out) = (Vec::new(), None, Vec::new());
        for (index, value) in stored.into_iter().enumerate() {
            match SavedFit::read(value, measurement.as_deref().unwrap_or(&Measurement::default())) {
                Ok(recipe) => {
                    shown = shown.or_else(|| (stored_shown == Some(index)).then_some(fits.len()));
                    fits.push(recipe);
                }
                Err(error) => left_out.push((index + 1, error)),
            }
        }
        Ok(Self { settings, layout, name, sha256, measurement, fits, shown, left_out: left_out.into() })
    }
}
