//! One parameter after a fit: its value, and how well the data determine it.

use crate::fit::fit_problem::UnknownName;
use crate::fit::intervals::interval::Interval;
use crate::fit::intervals::linear::UndeterminedDirection;
use crate::fit::rounding::{significant, trimmed, with_error};
use crate::fit::ties::Tie;
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
    /// The data determine it, but how well is unknown: no degree of freedom is left to estimate the noise from, or none was asked for.
    UncertaintyUnknown,
    /// The data do not determine it.
    Undetermined,
}

impl Estimate {
    /// Of a parameter that a fit held at a value.
    pub(crate) fn fixed(parameter: Parameter, value: f64) -> Self {
        let (std_error, at_bound, interval68, interval95) = (None, None, None, None);
        Self { parameter, start: value, value, free: false, std_error, at_bound, interval68, interval95, determined: false }
    }

    /// That of a parameter tied to this one.
    pub(crate) fn of_tied(&self, tie: &Tie) -> Self {
        let factor = tie.factor;
        let scaled = |interval: Interval| {
            let [low, high] = [interval.low, interval.high].map(|end| end.map(|end| factor * end));
            if factor > 0.0 { Interval { low, high } } else { Interval { low: high, high: low } }
        };
        Self {
            parameter: tie.parameter,
            start: factor * self.start,
            value: factor * self.value,
            std_error: self.std_error.map(|error| factor.abs() * error),
            interval68: self.interval68.map(scaled),
            interval95: self.interval95.map(scaled),
            ..*self
        }
    }

    /// How well the data determine it.
    #[must_use]
    pub fn status(&self) -> EstimateStatus {
        match (self.free, self.interval68, self.at_bound, self.std_error) {
            (false, ..) => EstimateStatus::Fixed,
            (true, Some(interval), _, None) if !interval.is_open() => EstimateStatus::Within(interval),
            (true, None, Some(edge), _) => EstimateStatus::AtBound(edge),
            (true, _, _, Some(error)) => EstimateStatus::Determined(error),
            (true, _, _, None) if self.determined => EstimateStatus::UncertaintyUnknown,
            (true, _, _, None) => EstimateStatus::Undetermined,
        }
    }

    /// Whether, without an interval that says more, the data determine it to no better than half its size.
    #[must_use]
    pub fn is_poorly_determined(&self) -> bool {
        let is_poor = |error| is_poorly_determined(self.parameter, self.value, error);
        self.interval68.is_none() && matches!(self.status(), EstimateStatus::Determined(error) if is_poor(error))
    }

    /// The value with the digits that its uncertainty leaves: to the second one of its error or of the nearer end of its interval;
    /// three where it is not determined or an interval has one end, six where there is no uncertainty.
    #[must_use]
    pub fn value_text(&self) -> String {
        match self.status() {
            EstimateStatus::Determined(error) => with_error(self.value, Some(error)).0,
            EstimateStatus::Within(Interval { low: Some(low), high: Some(high) }) => {
                with_error(self.value, Some(nearer(self.value, low, high))).0
            }
            EstimateStatus::Within(_) | EstimateStatus::Undetermined => trimmed(self.value, 3),
            EstimateStatus::Fixed | EstimateStatus::AtBound(_) | EstimateStatus::UncertaintyUnknown => trimmed(self.value, 6),
        }
    }

    /// How uncertain it is, to two digits: `± 0.021`, `+0.31 −0.24`, `> 1.20`; none where words say it.
    #[must_use]
    pub fn uncertainty_text(&self) -> Option<String> {
        match self.status() {
            EstimateStatus::Determined(error) => Some(format!("± {}", if error > 0.0 { significant(error, 2) } else { "0".to_owned() })),
            EstimateStatus::Within(interval) => Some(ends_text(self.value, interval)),
            _ => None,
        }
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.status() {
            EstimateStatus::Fixed => write!(f, "{} (fixed)", self.value),
            EstimateStatus::AtBound(Edge::Lower) => write!(f, "at lower bound {}", self.value),
            EstimateStatus::AtBound(Edge::Upper) => write!(f, "at upper bound {}", self.value),
            EstimateStatus::Determined(_) => write!(f, "{} {}", self.value_text(), self.uncertainty_text().unwrap_or_default()),
            EstimateStatus::UncertaintyUnknown => write!(f, "{} (uncertainty unknown)", self.value),
            EstimateStatus::Within(interval) => {
                let value = if interval.is_closed() { self.value_text() + " " } else { String::new() };
                write!(f, "{value}{} (68 %)", ends_text(self.value, interval))
            }
            EstimateStatus::Undetermined => f.write_str("not determined"),
        }
    }
}

/// The distances of the ends of an interval from a value, `+0.31 −0.24`, each to its second digit, `± 0.31` where both agree, or
/// its only end, `> 1.20`.
#[must_use]
pub fn ends_text(value: f64, interval: Interval) -> String {
    match (interval.low, interval.high) {
        (Some(low), Some(high)) => match [high - value, value - low].map(|distance| significant(distance, 2)) {
            [above, below] if above == below => format!("± {above}"),
            [above, below] => format!("+{above} −{below}"),
        },
        (Some(low), None) => format!("> {}", significant(low, 3)),
        (None, Some(high)) => format!("< {}", significant(high, 3)),
        (None, None) => "not determined".to_owned(),
    }
}

/// The distance of the end that is nearer to the value, or of the other where the value rests on that end.
fn nearer(value: f64, low: f64, high: f64) -> f64 {
    let [below, above] = [value - low, high - value];
    if below > 0.0 && above > 0.0 { below.min(above) } else { below.max(above) }
}

/// Whether a standard error, of a parameter with those bounds, says something about a value: it is at most half of max(|value|, 0.1)
/// and half of the box.
#[must_use]
pub fn is_determined(value: f64, error: f64, (low, high): (f64, f64)) -> bool {
    error <= 0.5 * value.abs().max(SMALLEST_SIZE).min(high - low)
}

/// Size, in units of the parameter, that smaller values count as where an error is compared with them.
pub(crate) const SMALLEST_SIZE: f64 = 0.1;

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
pub enum Undetermined<N = Parameter> {
    /// A direction that they do not determine at all.
    Direction(UndeterminedDirection<N>),
    /// Parameters whose interval at 68.3 % is open on both sides.
    Parameters(Vec<N>),
    /// Parameters that they determine with a standard error above half of the value.
    Poorly(Vec<N>),
}

impl<N: UnknownName> Undetermined<N> {
    /// Whether it names nothing.
    pub(crate) fn is_empty(&self) -> bool {
        matches!(self, Self::Parameters(parameters) | Self::Poorly(parameters) if parameters.is_empty())
    }
}

impl<N: UnknownName> fmt::Display for Undetermined<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Direction(direction) => direction.fmt(f),
            Self::Parameters(parameters) => write!(f, "not determined: {}", symbols(parameters)),
            Self::Poorly(parameters) => write!(f, "a standard error above half of the value: {}", symbols(parameters)),
        }
    }
}

/// Symbols of parameters, with commas between them.
#[must_use]
pub fn symbols<N: UnknownName>(names: &[N]) -> String {
    names.iter().map(|name| name.symbol()).collect::<Vec<_>>().join(", ")
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
        assert_eq!(within(Some(1.763), Some(2.382)), "2.07 ± 0.31 (68 %)");
        assert_eq!(within(Some(2.0713), Some(2.382)), "2.07 +0.31 −0 (68 %)", "it rests on its lower end");
        assert_eq!(
            Estimate { determined: false, ..Estimate { std_error: None, interval68: Some(Interval::OPEN), ..free } }.to_string(),
            "not determined"
        );
        assert_eq!(free.to_string(), "2.071 ± 0.021");
        assert_eq!(Estimate { std_error: Some(0.0), ..free }.to_string(), "2.0713 ± 0");
        assert_eq!(Estimate { free: false, value: 1.0, ..free }.to_string(), "1 (fixed)");
        assert_eq!(Estimate { at_bound: Some(Edge::Lower), value: 0.0, ..free }.to_string(), "at lower bound 0");
        assert_eq!(Estimate { std_error: None, determined: false, ..free }.to_string(), "not determined");
        assert_eq!(Estimate { std_error: None, ..free }.to_string(), "2.0713 (uncertainty unknown)");
    }
}
