//! How a fit came about, as a session tells it: where its starts ended and the way of the winning
//! one. Data and solution do not tell that again.

use crate::app::text::localized::Localized;
use crate::app::work::fit_history::{FitEntry, JointEntry};
use pbrdf::fit::{
    Basin, Course, FitOptions, FitResult, Interval, JointProblem, JointResult, JointUnknown, LocalFit, Loss, Minimum, MultistartResult,
    Problem, Statistics, StopReason, TracePoint, analyse, analyse_jointly, set_intervals,
};
use pbrdf::model::{Parameter, Parameters};
use serde::ser::{Error as _, SerializeSeq as _};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::value::to_raw_value;
use std::ops::RangeInclusive;
use tr::tr;

/// Steps of a way that are kept: a longer one is thinned.
const MOST_STEPS: usize = 120;

/// Scales of a loss that squares of residuals over them stay finite with. 0 is a quantity without
/// residuals.
const LOSS_SCALES: RangeInclusive<f64> = 1e-100..=1e100;

fn is_loss_scale(scale: &f64) -> bool {
    *scale == 0.0 || LOSS_SCALES.contains(scale)
}

/// How a fit came about.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FitRecord {
    /// Of the residuals, by all starts.
    evaluations: usize,
    elapsed_ms: f64,
    /// The rows that were masked, from 0.
    #[serde(serialize_with = "on_one_line")]
    masked: Vec<usize>,
    /// Where a robust loss changed from squares to sizes, for DoLP and BRDF.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    loss_scales: Option<[f64; 2]>,
    /// What residuals of DoLP and BRDF were multiplied by, where that was not 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    block_weights: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    intervals: Option<SavedIntervals>,
    /// The best first.
    #[serde(serialize_with = "one_a_line")]
    minima: Vec<Ending>,
    #[serde(serialize_with = "one_a_line")]
    way: Vec<Step>,
}

/// The intervals of a fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SavedIntervals {
    elapsed_ms: f64,
    /// Whether all were followed to their ends.
    complete: bool,
    /// At 68.3 and at 95 %, of the free parameters in the order of the fit's list of them.
    #[serde(serialize_with = "one_a_line")]
    of: Vec<[Interval; 2]>,
}

impl SavedIntervals {
    fn new<T>(course: &Course<T>, of: Option<Vec<[Interval; 2]>>) -> Option<Self> {
        let Course { intervals_ms: elapsed_ms, intervals_complete, .. } = *course;
        Some(Self { elapsed_ms, complete: intervals_complete?, of: of? })
    }

    fn is_sound(&self, free: usize) -> bool {
        let are_ordered = |interval: &Interval| interval.low.zip(interval.high).is_none_or(|(low, high)| low <= high);
        self.of.len() == free && self.elapsed_ms >= 0.0 && self.of.iter().flatten().all(are_ordered)
    }
}

/// A minimum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Ending {
    /// How many starts ended there.
    reached: usize,
    stop_reason: StopReason,
    /// The free parameters, in the order of the fit's list of them.
    at: Vec<f64>,
}

/// An improvement on the way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Step {
    elapsed_ms: f64,
    evaluations: usize,
    /// None where it is not defined.
    delta_e: Option<f64>,
    /// The free parameters, in the order of the fit's list of them.
    at: Vec<f64>,
}

/// Each element on a line of its own, however the rest is laid out.
fn one_a_line<T: Serialize, S: Serializer>(elements: &[T], serializer: S) -> Result<S::Ok, S::Error> {
    let mut list = serializer.serialize_seq(Some(elements.len()))?;
    for element in elements {
        list.serialize_element(&to_raw_value(element).map_err(S::Error::custom)?)?;
    }
    list.end()
}

pub fn on_one_line<T: Serialize, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    to_raw_value(value).map_err(S::Error::custom)?.serialize(serializer)
}

/// Why the record of a fit cannot be that of the fit it stands at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FitRecordError {
    /// A place has not one value for each free parameter.
    Place,
    /// The numbers of starts add up to more than can be counted.
    Starts,
    /// A scale of the loss is out of range.
    LossScale,
    /// A weight of DoLP or BRDF is out of range.
    BlockWeight,
    /// There is not one pair of intervals for each free parameter, or an end is on the wrong side.
    Intervals,
    /// A time or a ΔE is negative.
    Negative,
}

impl Localized for FitRecordError {
    fn localized(&self) -> String {
        match self {
            Self::Place => tr!("account: a place has not one value for each free parameter"),
            Self::Starts => tr!("account.minima: more starts than can be counted"),
            Self::LossScale => tr!("account: a scale of the loss is out of range"),
            Self::BlockWeight => tr!("account: a weight of DoLP or BRDF is out of range"),
            Self::Intervals => {
                tr!("account.intervals: expected two intervals for each free parameter, each from its lower to its upper end")
            }
            Self::Negative => tr!("account: a time or a ΔE is negative"),
        }
    }
}

impl FitRecord {
    /// What is known of a fit; none where nothing is.
    pub fn new(fit: &FitEntry) -> Option<Self> {
        let FitEntry { report, problem, mask, .. } = fit;
        let free = problem.free();
        let both = |parameter: &Parameter| {
            let estimate = report.estimate(*parameter)?;
            Some([estimate.interval68?, estimate.interval95?])
        };
        let intervals = SavedIntervals::new(&report.course, free.iter().map(both).collect());
        let at = |parameters: &Parameters| free.iter().map(|&parameter| parameters[parameter]).collect();
        Self::of_course(&report.course, &report.statistics, problem.options(), intervals, at)
            .map(|record| Self { masked: mask.to_vec(), ..record })
    }

    /// The same of a joint fit, whose measurements have masks of their own.
    pub fn of_joint(JointEntry { result, problem, .. }: &JointEntry) -> Option<Self> {
        let both = |unknown: &JointUnknown| {
            let (_, estimate) = result.estimates().find(|(name, _)| name == unknown)?;
            Some([estimate.interval68?, estimate.interval95?])
        };
        let intervals = SavedIntervals::new(&result.course, problem.unknowns().iter().map(both).collect());
        let at = |point: &Vec<Parameters>| problem.values_at(point);
        Self::of_course(&result.course, &result.statistics, problem.options(), intervals, at)
    }

    fn of_course<T>(
        course: &Course<T>,
        statistics: &Statistics,
        fit_options: &FitOptions,
        intervals: Option<SavedIntervals>,
        at: impl Fn(&T) -> Vec<f64>,
    ) -> Option<Self> {
        let is_robust = fit_options.loss != Loss::Squared;
        let ending = |minimum: &Minimum<T>| Ending { reached: minimum.hits, stop_reason: minimum.stop_reason, at: at(&minimum.parameters) };
        let step = |(point, parameters): (&TracePoint, &T)| Step {
            elapsed_ms: point.elapsed_ms,
            evaluations: point.evaluations,
            delta_e: Some(point.objective).filter(|value| value.is_finite()),
            at: at(parameters),
        };
        let account = Self {
            evaluations: course.evaluations,
            elapsed_ms: course.elapsed_ms,
            masked: Vec::new(),
            loss_scales: Some(statistics.loss_scales).filter(|scales| is_robust && scales.iter().all(is_loss_scale)),
            block_weights: Some(statistics.block_weights).filter(|weights| *weights != [1.0; 2]),
            intervals,
            minima: course.minima.iter().map(ending).collect(),
            way: thinned(course.trace.iter().zip(&course.path).map(step).collect()),
        };
        Some(account).filter(|account| !account.is_empty())
    }

    /// Whether it tells nothing but the mask.
    pub fn is_empty(&self) -> bool {
        self.minima.is_empty()
    }

    /// The rows that were masked.
    pub fn mask(&self) -> &[usize] {
        &self.masked
    }

    /// The same of an account that is of no further use.
    pub fn into_mask(self) -> Vec<usize> {
        self.masked
    }

    /// Why it can be the account of no fit with so many free parameters.
    pub fn fault(&self, free: usize) -> Option<FitRecordError> {
        let is_size = |value: f64| value >= 0.0;
        if self.all_places().any(|at| at.len() != free) {
            Some(FitRecordError::Place)
        } else if self.minima.iter().try_fold(0_usize, |sum, ending| sum.checked_add(ending.reached)).is_none() {
            Some(FitRecordError::Starts)
        } else if !self.loss_scales.iter().flatten().all(is_loss_scale) {
            Some(FitRecordError::LossScale)
        } else if !self.block_weights.iter().flatten().all(|weight| LOSS_SCALES.contains(weight)) {
            Some(FitRecordError::BlockWeight)
        } else if self.intervals.as_ref().is_some_and(|intervals| !intervals.is_sound(free)) {
            Some(FitRecordError::Intervals)
        } else if !is_size(self.elapsed_ms) || !self.way.iter().all(|step| is_size(step.elapsed_ms) && step.delta_e.is_none_or(is_size)) {
            Some(FitRecordError::Negative)
        } else {
            None
        }
    }

    /// All places that it names.
    fn all_places(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.minima.iter().map(|ending| &ending.at).chain(self.way.iter().map(|step| &step.at))
    }

    /// All places that it names, the rest of the parameters as the fit began.
    pub fn places(&self, start: Parameters, free: &[Parameter]) -> impl Iterator<Item = Parameters> {
        self.all_places().map(move |at| place(start, free, at))
    }

    /// The same of a joint fit.
    pub fn points(&self, problem: &JointProblem) -> impl Iterator<Item = Vec<Parameters>> {
        self.all_places().map(|at| problem.point_with(at))
    }

    /// What the starts had found.
    fn search<T>(&self, place: impl Fn(&[f64]) -> T, sum_of_squares: impl Fn(&T) -> Option<f64>) -> Option<MultistartResult<T>> {
        let point = |step: &Step| TracePoint {
            elapsed_ms: step.elapsed_ms,
            evaluations: step.evaluations,
            objective: step.delta_e.unwrap_or(f64::NAN),
        };
        let found = self.minima.iter().enumerate().map(|(i, ending)| {
            let parameters = place(&ending.at);
            // The way is that of the best.
            let way = if i == 0 { self.way.as_slice() } else { &[] };
            let local_fit = LocalFit {
                sum_of_squares: sum_of_squares(&parameters).unwrap_or(f64::INFINITY),
                parameters,
                stop_reason: ending.stop_reason,
                evaluations: way.last().map_or(0, |step| step.evaluations),
                trace: way.iter().map(point).collect(),
                path: way.iter().map(|step| place(&step.at)).collect(),
            };
            Basin { local_fit, hits: ending.reached }
        });
        MultistartResult::new(found.collect(), self.evaluations)
    }

    /// The report as it was.
    pub fn report(&self, problem: &Problem, free: &[Parameter]) -> Option<FitResult> {
        let problem = self.loss_scales.map_or_else(|| problem.clone(), |scales| problem.with_loss_scales(scales));
        let problem = self.block_weights.map_or_else(|| problem.clone(), |weights| problem.with_block_weights(weights));
        let start = *problem.start();
        let search = self.search(|at| place(start, free, at), |parameters| problem.sum_of_squares(parameters))?;
        let mut report = analyse(&problem, search, self.elapsed_ms);
        if let Some(SavedIntervals { elapsed_ms, complete, of }) = &self.intervals {
            set_intervals(&problem, &mut report, of);
            (report.course.intervals_ms, report.course.intervals_complete) = (*elapsed_ms, Some(*complete));
        }
        Some(report)
    }

    /// The result of a joint fit as it was.
    pub fn joint_result(&self, problem: &JointProblem) -> Option<JointResult> {
        let problem = self.loss_scales.map_or_else(|| problem.clone(), |scales| problem.with_loss_scales(scales));
        let problem = self.block_weights.map_or_else(|| problem.clone(), |weights| problem.with_block_weights(weights));
        let search = self.search(|at| problem.point_with(at), |point| problem.sum_of_squares(point))?;
        let intervals = self.intervals.as_ref();
        let mut result = analyse_jointly(&problem, search, self.elapsed_ms, intervals.map(|intervals| &intervals.of[..]));
        if let Some(SavedIntervals { elapsed_ms, complete, .. }) = intervals {
            (result.course.intervals_ms, result.course.intervals_complete) = (*elapsed_ms, Some(*complete));
        }
        Some(result)
    }
}

fn place(start: Parameters, free: &[Parameter], at: &[f64]) -> Parameters {
    let mut parameters = start;
    for (&parameter, &value) in free.iter().zip(at) {
        parameters[parameter] = parameter.domain().flush_to_zero(value);
    }
    parameters
}

/// At most so many, evenly chosen, both ends among them.
fn thinned(steps: Vec<Step>) -> Vec<Step> {
    let last = steps.len().saturating_sub(1);
    if last < MOST_STEPS {
        return steps;
    }
    let mut kept = (0..MOST_STEPS).map(|i| i * last / (MOST_STEPS - 1)).peekable();
    let is_kept = |(i, step)| kept.next_if_eq(&i).map(|_| step);
    steps.into_iter().enumerate().filter_map(is_kept).collect()
}

#[cfg(test)]
mod tests {
    use super::{MOST_STEPS, Step, thinned};

    #[test]
    fn a_long_way_keeps_its_ends_and_a_short_one_every_step() {
        let steps = |count: usize| -> Vec<Step> {
            (1..=count).map(|evaluations| Step { elapsed_ms: 0.0, evaluations, delta_e: None, at: Vec::new() }).collect()
        };
        for count in [0, 1, MOST_STEPS] {
            assert_eq!(thinned(steps(count)), steps(count));
        }
        for count in [MOST_STEPS + 1, 1000] {
            let kept = thinned(steps(count));
            let ends = (kept.first().map(|step| step.evaluations), kept.last().map(|step| step.evaluations));
            assert_eq!((kept.len(), ends), (MOST_STEPS, (Some(1), Some(count))));
        }
    }
}
