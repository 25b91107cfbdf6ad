//! A fit of a session: what it was about, where it ended, and the fit again.

use crate::app::storage::earlier_keys::EarlierKeys;
use crate::app::storage::fit_record::{FitRecord, on_one_line};
use crate::app::storage::saved_comparison::SavedComparison;
use crate::app::storage::session_error::SavedFitError;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::open_measurement::{Mask, MeasurementStyle, masked_rows};
use crate::app::work::surface::{Surface, can_be_set};
use pbrdf::fit::{Bounds, Course, FitOptions, FitResult, Observer, Problem, Starts, Tie, fit};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// What a fit was about, and where it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedFit {
    /// Which measurement of the session, from 0.
    #[serde(default)]
    pub measurement: usize,
    model: Model,
    start: Parameters,
    free: Vec<Parameter>,
    bounds: Vec<(Parameter, f64, f64)>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    ties: Vec<Tie>,
    #[serde(rename = "choices")]
    fit_options: FitOptions,
    /// The solution.
    parameters: Parameters,
    /// The sliders before it.
    before: Parameters,
    /// How it came about; older files do not tell.
    #[serde(default)]
    account: Option<FitRecord>,
    /// The rows that were masked, from 0, where no account tells; without, those that the
    /// measurement has masked.
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
    /// Of an open one that is not active.
    pub surface: Option<Surface>,
    pub style: MeasurementStyle,
    /// How often its squared residuals count in joint fits.
    pub weight: f64,
    /// The series that plots show, if not those that they show at first.
    pub drawn: Option<Vec<usize>>,
    /// Which fit is shown while it is active, if it is not now.
    pub shown_fit: Option<usize>,
    /// The comparison of models on it.
    pub compared: SavedComparison,
    /// Whether the program opened it by itself and nothing was done with it yet.
    pub is_placeholder: bool,
    pub measurement: Arc<Measurement>,
}

impl SavedMeasurement {
    /// An open one, without what may be known of it.
    pub fn of(measurement: Arc<Measurement>) -> Self {
        let (name, style) = (String::new(), MeasurementStyle::default());
        Self {
            name,
            sha256: None,
            is_open: true,
            surface: None,
            style,
            weight: 1.0,
            drawn: None,
            shown_fit: None,
            compared: SavedComparison::default(),
            is_placeholder: false,
            measurement,
        }
    }
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

impl SavedFit {
    /// A fit about the measurement of that number in the session, from 0.
    pub fn new(fit: &FitEntry, measurement: usize) -> Self {
        let account = FitRecord::new(fit);
        Self {
            masked: account.is_none().then(|| fit.mask.to_vec()),
            parameters: fit.report.parameters,
            before: fit.before,
            account,
            ..Self::to_be_made(&fit.problem, measurement, &fit.mask)
        }
    }

    /// A fit that is still to be made of the measurement of that number, from 0.
    pub fn to_be_made(problem: &Problem, measurement: usize, mask: &Mask) -> Self {
        let bounds = problem.free().iter().map(|&parameter| {
            let (low, high) = problem.bounds().of(parameter);
            (parameter, low, high)
        });
        Self {
            measurement,
            masked: Some(mask.to_vec()),
            model: problem.model(),
            start: *problem.start(),
            free: problem.free().to_vec(),
            bounds: bounds.collect(),
            ties: problem.ties().to_vec(),
            fit_options: *problem.options(),
            parameters: *problem.start(),
            before: *problem.start(),
            account: None,
        }
    }

    /// A fit of a file, if it can be one of its measurement.
    ///
    /// # Errors
    /// It is none.
    pub fn read(value: serde_json::Value, measurements: &[SavedMeasurement]) -> Result<Self, SavedFitError> {
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
        self.mask().map_or(Cow::Borrowed(measurement), |mask| with_mask(measurement, mask))
    }

    /// What was fitted, or is to be.
    ///
    /// # Errors
    /// It cannot be fitted to this measurement.
    pub fn problem(&self, measurement: &Measurement) -> Result<Problem, SavedFitError> {
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
        let problem = Problem::new(&self.masked(measurement), self.model, self.start, free, bounds, self.fit_options);
        let tied = |problem: Problem| if self.ties.is_empty() { Ok(problem) } else { problem.with_ties(&self.ties) };
        problem.and_then(tied).map_err(SavedFitError::Problem)
    }

    /// The fit again. None where the data of the session are no longer such that there is one.
    pub fn restore(&self, measurements: &[SavedMeasurement]) -> Option<RestoredFit> {
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

/// The measurement with exactly those rows masked.
pub fn with_mask<'a>(measurement: &'a Measurement, mask: &[usize]) -> Cow<'a, Measurement> {
    let mut masked = Cow::Borrowed(measurement);
    let is_masked = |row: usize| mask.binary_search(&row).is_ok();
    if measurement.rows.iter().enumerate().any(|(i, row)| row.masked != is_masked(i)) {
        masked.to_mut().rows.iter_mut().enumerate().for_each(|(i, row)| row.masked = is_masked(i));
    }
    masked
}

/// Whether these are rows of a table of so many, each once and in their order.
pub fn is_mask(rows: &[usize], of: usize) -> bool {
    rows.is_sorted_by(|one, next| one < next) && rows.last().is_none_or(|&last| last < of)
}
