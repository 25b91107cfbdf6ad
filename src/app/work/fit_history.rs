//! The fits of this session, to look back at and to return to.

use crate::app::work::open_measurement::{Mask, OpenMeasurement};
use pbrdf::fit::{FitResult, Problem};
use pbrdf::measurement::Measurement;
use pbrdf::model::Parameters;
use std::collections::VecDeque;
use std::sync::Arc;

/// A fit as the window remembers it.
#[derive(Clone)]
pub struct FitEntry {
    /// Its number in the session, from 1.
    pub id: usize,
    pub report: FitResult,
    /// What was fitted, for scans around the solution.
    pub problem: Arc<Problem>,
    /// The sliders before it.
    pub before: Parameters,
    /// The measurement's name.
    pub document: String,
    /// SHA-256 of the measurement's file, where there is one.
    pub sha256: Option<String>,
    /// The rows of the measurement; [`Self::mask`] says which were masked.
    pub data: Arc<Measurement>,
    /// Which measurement of the session it was.
    pub number: u64,
    /// The state of that measurement: its mask may have changed since.
    pub generation: u64,
    /// The rows that were masked.
    pub mask: Mask,
}

impl FitEntry {
    /// The measurement that it was made from, as it was then.
    pub fn measurement(&self) -> OpenMeasurement {
        let mut open = OpenMeasurement::new(self.document.clone(), Measurement::clone(&self.data)).of_file(self.sha256.clone());
        open.restore_mask(&self.mask);
        (open.number, open.generation) = (self.number, self.generation);
        open
    }
}

/// Fits that are kept.
const MOST_FITS: usize = 20;

/// Residuals of all kept fits together: each fit holds on to its data.
const MOST_RESIDUALS: usize = 500_000;

/// The last fits, newest first.
#[derive(Clone, Default)]
pub struct FitHistory {
    fits: VecDeque<Arc<FitEntry>>,
    count: usize,
}

impl FitHistory {
    /// Takes a fit in, and gives it back to be shown.
    pub fn push(&mut self, fit: FitEntry) -> Arc<FitEntry> {
        self.count += 1;
        let fit = Arc::new(FitEntry { id: self.count, ..fit });
        self.fits.push_front(fit.clone());
        self.fits.truncate(MOST_FITS);
        let residuals = |fits: &VecDeque<Arc<FitEntry>>| fits.iter().map(|fit| fit.problem.len()).sum::<usize>();
        while self.fits.len() > 1 && residuals(&self.fits) > MOST_RESIDUALS {
            self.fits.pop_back();
        }
        fit
    }

    /// Puts a report in the place of that of a kept fit, and gives the fit back.
    pub fn replace_report(&mut self, id: usize, report: FitResult) -> Option<Arc<FitEntry>> {
        let fit = self.fits.iter_mut().find(|fit| fit.id == id)?;
        Arc::make_mut(fit).report = report;
        Some(fit.clone())
    }

    /// The fit so many before the newest.
    pub fn get(&self, index: usize) -> Option<Arc<FitEntry>> {
        self.fits.get(index).cloned()
    }

    /// How many fits the session has made, those no longer kept among them.
    pub fn count(&self) -> usize {
        self.count
    }

    pub fn iter(&self) -> impl Iterator<Item = &Arc<FitEntry>> {
        self.fits.iter()
    }

    pub fn len(&self) -> usize {
        self.fits.len()
    }

    pub fn is_empty(&self) -> bool {
        self.fits.is_empty()
    }
}
