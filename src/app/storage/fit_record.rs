//! How a fit came about, as a session tells it: where its starts ended and the way of the winning
//! one. Data and solution do not tell that again.

use crate::app::text::localized::Localized;
use crate::app::work::fit_history::FitEntry;
use pbrdf::fit::{
    Basin, Course, FitResult, Interval, LocalFit, Loss, MultistartResult, Problem, StopReason, TracePoint, analyse, set_intervals,
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    fn new(report: &FitResult, free: &[Parameter]) -> Option<Self> {
        let of = |parameter: &Parameter| {
            let estimate = report.estimate(*parameter)?;
            Some([estimate.interval68?, estimate.interval95?])
        };
        let Course { intervals_ms: elapsed_ms, intervals_complete, .. } = report.course;
        Some(Self { elapsed_ms, complete: intervals_complete?, of: free.iter().map(of).collect::<Option<_>>()? })
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
        let is_robust = problem.options().loss != Loss::Squared;
        let at = |parameters: &Parameters| free.iter().map(|&parameter| parameters[parameter]).collect();
        let minima = report.course.minima.iter().map(|minimum| Ending {
            reached: minimum.hits,
            stop_reason: minimum.stop_reason,
            at: at(&minimum.parameters),
        });
        let minima: Vec<Ending> = minima.collect();
        let step = |(point, parameters): (&TracePoint, &Parameters)| Step {
            elapsed_ms: point.elapsed_ms,
            evaluations: point.evaluations,
            delta_e: Some(point.objective).filter(|value| value.is_finite()),
            at: at(parameters),
        };
        let account = Self {
            evaluations: report.course.evaluations,
            elapsed_ms: report.course.elapsed_ms,
            masked: mask.to_vec(),
            loss_scales: Some(report.statistics.loss_scales).filter(|scales| is_robust && scales.iter().all(is_loss_scale)),
            block_weights: Some(report.statistics.block_weights).filter(|weights| *weights != [1.0; 2]),
            intervals: SavedIntervals::new(report, free),
            minima,
            way: thinned(report.course.trace.iter().zip(&report.course.path).map(step).collect()),
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
        let places = || self.minima.iter().map(|ending| &ending.at).chain(self.way.iter().map(|step| &step.at));
        let is_size = |value: f64| value >= 0.0;
        if places().any(|at| at.len() != free) {
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

    /// All places that it names, the rest of the parameters as the fit began.
    pub fn places(&self, start: Parameters, free: &[Parameter]) -> impl Iterator<Item = Parameters> {
        let all = self.minima.iter().map(|ending| &ending.at).chain(self.way.iter().map(|step| &step.at));
        all.map(move |at| place(start, free, at))
    }

    /// The report as it was.
    pub fn report(&self, problem: &Problem, free: &[Parameter]) -> Option<FitResult> {
        let problem = self.loss_scales.map_or_else(|| problem.clone(), |scales| problem.with_loss_scales(scales));
        let problem = self.block_weights.map_or_else(|| problem.clone(), |weights| problem.with_block_weights(weights));
        let start = *problem.start();
        let found = self.minima.iter().enumerate().map(|(i, ending)| {
            let parameters = place(start, free, &ending.at);
            // The way is that of the best.
            let way = if i == 0 { self.way.as_slice() } else { &[] };
            let point = |step: &Step| TracePoint {
                elapsed_ms: step.elapsed_ms,
                evaluations: step.evaluations,
                objective: step.delta_e.unwrap_or(f64::NAN),
            };
            let local_fit = LocalFit {
                parameters,
                sum_of_squares: problem.sum_of_squares(&parameters).unwrap_or(f64::INFINITY),
                stop_reason: ending.stop_reason,
                evaluations: way.last().map_or(0, |step| step.evaluations),
                trace: way.iter().map(point).collect(),
                path: way.iter().map(|step| place(start, free, &step.at)).collect(),
            };
            Basin { local_fit, hits: ending.reached }
        });
        let search = MultistartResult::new(found.collect(), self.evaluations)?;
        let mut report = analyse(&problem, search, self.elapsed_ms);
        if let Some(SavedIntervals { elapsed_ms, complete, of }) = &self.intervals {
            set_intervals(&problem, &mut report, of);
            (report.course.intervals_ms, report.course.intervals_complete) = (*elapsed_ms, Some(*complete));
        }
        Some(report)
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
