//! The fits of this session, to look back at and to return to.

use crate::app::work::open_measurement::{Mask, OpenMeasurement};
use pbrdf::fit::{FitResult, JointProblem, JointResult, Minimum, Problem};
use pbrdf::measurement::Measurement;
use pbrdf::model::{ParameterSet, Parameters, Preset};
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
    /// The fit of several measurements that this one is a part of.
    pub joint: Option<JointPart>,
}

/// A fit of several measurements together.
pub struct JointEntry {
    pub result: JointResult,
    pub problem: Arc<JointProblem>,
    /// The parameters that surfaces shared.
    pub shared: ParameterSet,
}

/// One measurement of a joint fit.
#[derive(Clone)]
pub struct JointPart {
    pub of: Arc<JointEntry>,
    /// Its place among the measurements of the fit.
    pub set: usize,
}

impl JointPart {
    /// The fit as that of this measurement: its surface, and where the fit had it on its way. Objectives on the way are of all rows.
    fn report(&self) -> FitResult {
        let Self { of, set } = self;
        let mut report = of.result.of_set(*set);
        let course = &of.result.course;
        let minimum = |minimum: &Minimum<Vec<Parameters>>| Minimum {
            parameters: minimum.parameters[*set],
            objective: minimum.objective,
            stop_reason: minimum.stop_reason,
            hits: minimum.hits,
        };
        report.course.minima = course.minima.iter().map(minimum).collect();
        report.course.trace.clone_from(&course.trace);
        report.course.path = course.path.iter().map(|point| point[*set]).collect();
        report
    }
}

impl FitEntry {
    /// A fit of one measurement.
    pub fn new(about: OpenMeasurement, problem: Arc<Problem>, report: FitResult) -> Self {
        let mask = about.mask().clone();
        let OpenMeasurement { name: document, sha256, measurement: data, number, generation, surface, .. } = about;
        let before = surface.parameters;
        Self { id: 0, report, problem, before, document, sha256, data, number, generation, mask, joint: None }
    }

    /// A joint fit as those of its measurements.
    pub fn of_joint(about: Vec<OpenMeasurement>, joint: JointEntry) -> Vec<Self> {
        let of = Arc::new(joint);
        let entry = |(set, about)| {
            let part = JointPart { of: of.clone(), set };
            Self { joint: Some(part.clone()), ..Self::new(about, Arc::new(of.problem.parts()[set].clone()), part.report()) }
        };
        about.into_iter().enumerate().map(entry).collect()
    }

    /// The preset that was fitted, if its terms are those of one.
    pub fn preset(&self) -> Option<&'static Preset> {
        Preset::of_fit(self.report.model, self.problem.options().dolp_only)
    }

    /// Whether both are of one joint fit.
    fn is_joined_with(&self, other: &Self) -> bool {
        self.joint.as_ref().zip(other.joint.as_ref()).is_some_and(|(one, other)| Arc::ptr_eq(&one.of, &other.of))
    }

    /// How many values were fitted, and how many unknowns, of all measurements of the fit.
    pub fn counts(&self) -> (usize, usize) {
        let joint = self.joint.as_ref().map(|part| &part.of.problem);
        joint.map_or_else(|| (self.problem.len(), self.problem.free().len()), |problem| (problem.len(), problem.unknowns().len()))
    }

    /// The measurement that it was made from, as it was then.
    pub fn measurement(&self) -> OpenMeasurement {
        let mut open = OpenMeasurement::new(self.document.clone(), Measurement::clone(&self.data)).of_file(self.sha256.clone());
        open.restore_mask(&self.mask);
        (open.number, open.generation) = (self.number, self.generation);
        open
    }
}

/// A fit that a session brings back.
pub struct KeptFit {
    pub fit: FitEntry,
    /// Whether its measurement shows it.
    pub is_shown: bool,
    /// The model as which it stands in the comparison of its measurement.
    pub compared_as: Option<&'static Preset>,
}

/// Fits that are kept.
const MOST_FITS: usize = 60;

/// Residuals of all kept fits together: each fit holds on to its data.
const MOST_RESIDUALS: usize = 500_000;

/// The last fits, newest first.
#[derive(Clone, Default)]
pub struct FitHistory {
    fits: VecDeque<Arc<FitEntry>>,
    count: usize,
}

impl FitHistory {
    /// Takes a fit in, and gives it back to be shown. Those of one joint fit come one after the other, and have one number.
    pub fn push(&mut self, fit: FitEntry) -> Arc<FitEntry> {
        self.count += usize::from(!self.fits.front().is_some_and(|newest| newest.is_joined_with(&fit)));
        let fit = Arc::new(FitEntry { id: self.count, ..fit });
        self.fits.push_front(fit.clone());
        let residuals = |fits: &VecDeque<Arc<FitEntry>>| fits.iter().map(|fit| fit.problem.len()).sum::<usize>();
        while self.len() > 1 && (self.len() > MOST_FITS || residuals(&self.fits) > MOST_RESIDUALS) {
            let oldest = self.fits.back().map(|fit| fit.id);
            self.fits.retain(|fit| Some(fit.id) != oldest);
        }
        fit
    }

    /// Makes fits of the file with that hash and name, whose measurement is open no more, fits of the
    /// measurement that was opened from it again; the newest with the same mask is given back.
    pub fn reattach(&mut self, opened: &OpenMeasurement, is_open: impl Fn(u64) -> bool) -> Option<Arc<FitEntry>> {
        let sha256 = opened.sha256.as_ref()?;
        let is_same = |fit: &FitEntry| {
            fit.sha256.as_ref() == Some(sha256) && fit.document == opened.name && fit.data.rows.len() == opened.measurement.rows.len()
        };
        for fit in self.fits.iter_mut().filter(|fit| is_same(fit) && !is_open(fit.number)) {
            let has_mask = fit.mask == *opened.mask();
            let fit = Arc::make_mut(fit);
            fit.number = opened.number;
            // A fit with another mask is of no generation of its measurement.
            fit.generation = if has_mask { opened.generation } else { 0 };
        }
        self.fits.iter().find(|fit| fit.number == opened.number && fit.generation == opened.generation).cloned()
    }

    /// Puts a report in the place of that of a kept fit, and gives the fit back.
    pub fn replace_report(&mut self, id: usize, report: FitResult) -> Option<Arc<FitEntry>> {
        let fit = self.fits.iter_mut().find(|fit| fit.id == id)?;
        Arc::make_mut(fit).report = report;
        Some(fit.clone())
    }

    /// The same of a joint fit; the fits of its measurements are the answer.
    pub fn replace_joint(&mut self, id: usize, result: JointResult) -> Vec<Arc<FitEntry>> {
        let part = self.fits.iter().find(|fit| fit.id == id).and_then(|fit| fit.joint.as_ref());
        let Some(JointEntry { problem, shared, .. }) = part.map(|part| &*part.of) else { return Vec::new() };
        let of = Arc::new(JointEntry { result, problem: problem.clone(), shared: *shared });
        let parts = self.fits.iter_mut().filter(|fit| fit.id == id);
        let replaced = parts.filter_map(|fit| {
            let part = JointPart { of: of.clone(), set: fit.joint.as_ref()?.set };
            let entry = Arc::make_mut(fit);
            entry.report = part.report();
            entry.joint = Some(part);
            Some(fit.clone())
        });
        replaced.collect()
    }

    /// The fit so many before the newest, as that of the measurement of that number if it is one of a joint fit.
    pub fn get(&self, index: usize, number: u64) -> Option<Arc<FitEntry>> {
        self.rows(number).nth(index).cloned()
    }

    /// Every fit once, the newest first: a joint one as that of the measurement of that number, or of its first.
    pub fn rows(&self, number: u64) -> impl Iterator<Item = &Arc<FitEntry>> {
        let is_row = move |fit: &&Arc<FitEntry>| {
            let is_about = |part: &Arc<FitEntry>| part.number == number;
            fit.joint.as_ref().is_none_or(|part| {
                let is_first_alone = part.set == 0 && !self.parts(fit.id).any(is_about);
                is_about(fit) || is_first_alone
            })
        };
        self.fits.iter().filter(is_row)
    }

    /// The fits of the measurements that were fitted together under that number; one, if that was no joint fit.
    pub fn parts(&self, id: usize) -> impl Iterator<Item = &Arc<FitEntry>> {
        self.fits.iter().filter(move |fit| fit.id == id)
    }

    /// How many fits the session has made, those no longer kept among them.
    pub fn count(&self) -> usize {
        self.count
    }

    /// All, a joint one as often as it has measurements.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<FitEntry>> {
        self.fits.iter()
    }

    /// How many fits are kept.
    pub fn len(&self) -> usize {
        let (mut fits, mut ids) = (0, None);
        for fit in &self.fits {
            fits += usize::from(ids != Some(fit.id));
            ids = Some(fit.id);
        }
        fits
    }

    pub fn is_empty(&self) -> bool {
        self.fits.is_empty()
    }
}
