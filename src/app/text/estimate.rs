//! Estimates of a fit in words: how uncertain each is, or why nothing is known.

use crate::app::text::glossary;
use pbrdf::fit::{Edge, Estimate, EstimateStatus, Interval};
use pbrdf::rounding::significant;
use tr::tr;

/// The uncertainty of an estimate at 68.3 %, `+0.31 −0.24`, or why there is none.
pub fn uncertainty_text(estimate: &Estimate) -> String {
    match estimate.status() {
        EstimateStatus::Fixed => tr!("fixed"),
        EstimateStatus::AtBound(edge) => bound_text(edge),
        EstimateStatus::Determined(_) | EstimateStatus::Within(_) => estimate.uncertainty_text().unwrap_or_default(),
        EstimateStatus::UncertaintyUnknown => tr!("no d.o.f."),
        EstimateStatus::Undetermined => tr!("not determined"),
    }
}

/// Which bound it rests on.
pub fn bound_text(edge: Edge) -> String {
    match edge {
        Edge::Lower => tr!("at lower bound"),
        Edge::Upper => tr!("at upper bound"),
    }
}

/// The same in full: what the uncertainty means, and both intervals.
pub fn uncertainty_help(estimate: &Estimate) -> String {
    let mut lines = vec![glossary::standing_help(estimate.status())];
    if let (Some(at_68), Some(at_95)) = (estimate.interval68, estimate.interval95) {
        lines.push(tr!("68.3 %: {}", interval_text(at_68)));
        lines.push(tr!("95 %: {}", interval_text(at_95)));
        lines.extend(estimate.at_bound.map(bound_text));
    }
    lines.join("\n")
}

/// What the shown fit says of a parameter, for who cannot see its table: its value with unit and
/// interval.
pub fn estimate_text(estimate: &Estimate) -> String {
    let value = format!("{} {}", significant(estimate.value, 5), estimate.parameter.unit());
    let value = value.trim_end();
    match estimate.interval68 {
        Some(interval) => tr!("Fitted: {0}, interval at 68.3 %: {1}", value, interval_text(interval)),
        None => tr!("Fitted: {0}, {1}", value, uncertainty_text(estimate)),
    }
}

/// An interval by its ends.
pub fn interval_text(interval: Interval) -> String {
    let end = |value: f64| significant(value, 4);
    match (interval.low, interval.high) {
        (Some(low), Some(high)) => format!("{} … {}", end(low), end(high)),
        (Some(low), None) => tr!("above {}", end(low)),
        (None, Some(high)) => tr!("below {}", end(high)),
        (None, None) => tr!("open on both sides"),
    }
}
