//! One parameter after a fit: its value, and how well the data determine it.

use crate::fit::intervals::interval::Interval;
use crate::fit::intervals::linear::UndeterminedDirection;
use crate::fit::rounding::{decimal_places, significant, with_error};
use crate::model::Parameter;
use serde::Serialize;
use std::fmt;

/// Which bound a parameter rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Edge {
    /// The lower one.
    Lower,
    /// The upper one.
    Upper,
}

/// One parameter of the model after a fit.
///
/// `Display` rounds the value by its standard error: `2.071 ± 0.021`, `2.05 +0.31 −0.24 (68 %)`,
/// `> 1.2 (68 %)`, `not determined`, `at lower bound 0`, `1 (fixed)`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Which.
    pub parameter: Parameter,
    /// Where it started.
    pub start: f64,
    /// Its value, in its own unit.
    pub value: f64,
    /// Whether the fit could change it.
    pub free: bool,
    /// Its standard error, in its own unit; none where the data do not determine it, and on a bound.
    pub std_error: Option<f64>,
    /// The bound it rests on.
    pub at_bound: Option<Edge>,
    /// Its interval at 68.3 %; none where it is fixed or intervals were not asked for.
    pub interval68: Option<Interval>,
    /// Its interval at 95 %.
    pub interval95: Option<Interval>,
    /// Whether the data determine it: with intervals, whether that at 68.3 % is closed on a side. Without degrees of freedom there is
    /// no standard error even so.
    pub determined: bool,
}

/// How well the data determine an estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EstimateStatus {
    /// The fit did not change it.
    Fixed,
    /// It rests on a bound, where there is no standard error, and there is no interval.
    AtBound(Edge),
    /// The data determine it, with this standard error in its own unit.
    Determined(f64),
    /// The data determine it to this interval at 68.3 %, closed on one side at least; a standard error would say something else.
    Within(Interval),
    /// The data determine it, but no degree of freedom is left to estimate the noise from.
    NoDegreesOfFreedom,
    /// The data do not determine it.
    Undetermined,
}

impl Estimate {
    /// How well the data determine it.
    #[must_use]
    pub fn status(&self) -> EstimateStatus {
        match (self.free, self.interval68, self.at_bound, self.std_error) {
            (false, ..) => EstimateStatus::Fixed,
            (true, Some(interval), _, None) if !interval.is_open() => EstimateStatus::Within(interval),
            (true, None, Some(edge), _) => EstimateStatus::AtBound(edge),
            (true, _, _, Some(error)) => EstimateStatus::Determined(error),
            (true, _, _, None) if self.determined => EstimateStatus::NoDegreesOfFreedom,
            (true, _, _, None) => EstimateStatus::Undetermined,
        }
    }

    /// Whether the data determine it, but to no better than half its size.
    #[must_use]
    pub fn is_poorly_determined(&self) -> bool {
        matches!(self.status(), EstimateStatus::Determined(error) if is_poorly_determined(self.parameter, self.value, error))
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.status() {
            EstimateStatus::Fixed => write!(f, "{} (fixed)", self.value),
            EstimateStatus::AtBound(Edge::Lower) => write!(f, "at lower bound {}", self.value),
            EstimateStatus::AtBound(Edge::Upper) => write!(f, "at upper bound {}", self.value),
            EstimateStatus::Determined(error) => {
                let (value, error) = with_error(self.value, Some(error));
                write!(f, "{value} ± {}", error.as_deref().unwrap_or("0"))
            }
            EstimateStatus::NoDegreesOfFreedom => write!(f, "{} (no degrees of freedom)", self.value),
            EstimateStatus::Within(interval) => f.write_str(&within(self.value, interval)),
            EstimateStatus::Undetermined => f.write_str("not determined"),
        }
    }
}

/// The distances of the ends of an interval from a value, `+0.31 −0.24`, rounded by the smaller one, or its only end, `> 1.20`.
#[must_use]
pub fn ends_text(value: f64, interval: Interval) -> String {
    match (interval.low, interval.high) {
        (Some(low), Some(high)) => {
            let places = decimal_places((high - value).min(value - low));
            format!("+{:.places$} −{:.places$}", high - value, value - low)
        }
        (Some(low), None) => format!("> {}", significant(low, 3)),
        (None, Some(high)) => format!("< {}", significant(high, 3)),
        (None, None) => "not determined".to_owned(),
    }
}

/// A value in its interval at 68.3 %: `2.05 +0.31 −0.24 (68 %)`.
fn within(value: f64, interval: Interval) -> String {
    let ends = ends_text(value, interval);
    match (interval.low, interval.high) {
        (Some(low), Some(high)) => format!("{value:.*} {ends} (68 %)", decimal_places((high - value).min(value - low))),
        (None, None) => ends,
        _ => format!("{ends} (68 %)"),
    }
}

/// What the standard error of a parameter is compared with: the distance of its value from where its effect vanishes or, for c,
/// which has no such place, the width of its range.
#[must_use]
pub fn relative_error_base(parameter: Parameter, value: f64) -> f64 {
    match parameter {
        Parameter::Q => value - 1.0,
        Parameter::C => 1.0,
        _ => value.abs(),
    }
}

/// Whether an error is above half of [`relative_error_base`]: then the value says next to nothing.
#[must_use]
pub fn is_poorly_determined(parameter: Parameter, value: f64, error: f64) -> bool {
    error > 0.5 * relative_error_base(parameter, value)
}

/// Something that the data do not determine, or hardly.
#[derive(Debug, Clone, PartialEq)]
pub enum Undetermined {
    /// A direction that they do not determine at all.
    Direction(UndeterminedDirection),
    /// Parameters that they determine with a standard error above half of the value.
    Poorly(Vec<Parameter>),
}

impl Undetermined {
    /// The poorly determined parameters, if there are any.
    #[must_use]
    pub fn poorly(parameters: impl Iterator<Item = Parameter>) -> Option<Self> {
        let parameters: Vec<Parameter> = parameters.collect();
        (!parameters.is_empty()).then_some(Self::Poorly(parameters))
    }
}

impl fmt::Display for Undetermined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Direction(direction) => direction.fmt(f),
            Self::Poorly(parameters) => write!(f, "a standard error above half of the value: {}", symbols(parameters)),
        }
    }
}

/// Symbols of parameters, with commas between them.
#[must_use]
pub fn symbols(parameters: &[Parameter]) -> String {
    parameters.iter().map(|parameter| parameter.symbol()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{Edge, Estimate};
    use crate::fit::Interval;
    use crate::model::Parameter;

    #[test]
    fn an_estimate_says_how_it_is_determined() {
        let free = Estimate {
            parameter: Parameter::N,
            start: 2.0,
            value: 2.0713,
            free: true,
            std_error: Some(0.021),
            at_bound: None,
            interval68: None,
            interval95: None,
            determined: true,
        };
        let within = |low, high| Estimate { std_error: None, interval68: Some(Interval { low, high }), ..free }.to_string();
        assert_eq!(within(Some(1.829), Some(2.382)), "2.07 +0.31 −0.24 (68 %)");
        assert_eq!(within(Some(1.829), None), "> 1.83 (68 %)");
        assert_eq!(within(None, Some(2.382)), "< 2.38 (68 %)");
        assert_eq!(
            Estimate { determined: false, ..Estimate { std_error: None, interval68: Some(Interval::OPEN), ..free } }.to_string(),
            "not determined"
        );
        assert_eq!(free.to_string(), "2.071 ± 0.021");
        assert_eq!(Estimate { std_error: Some(0.0), ..free }.to_string(), "2.0713 ± 0");
        assert_eq!(Estimate { free: false, value: 1.0, ..free }.to_string(), "1 (fixed)");
        assert_eq!(Estimate { at_bound: Some(Edge::Lower), value: 0.0, ..free }.to_string(), "at lower bound 0");
        assert_eq!(Estimate { std_error: None, determined: false, ..free }.to_string(), "not determined");
        assert_eq!(Estimate { std_error: None, ..free }.to_string(), "2.0713 (no degrees of freedom)");
    }
}
