//! Messages of `pbrdf::fit`.

use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized;
use pbrdf::fit::{
    AngleChoiceError, BoundsError, CandidateError, DesignError, DistributionComparison, Edge, Evidence, FitError, GeodesicEnd, JointError,
    ProblemError, StopReason, TieError, Undetermined, UndeterminedDirection, UndeterminedReason, UnknownName, Verdict, symbols,
};
use pbrdf::model::Parameter;
use pbrdf::optics::{SlopeDistribution, shortest};
use tr::tr;

impl Localized for StopReason {
    fn localized(&self) -> String {
        match self {
            Self::Converged => tr!("converged"),
            Self::ResidualsZero => tr!("model and data agree to the last digits"),
            Self::NoImprovement => tr!("no further improvement is possible"),
            Self::EvaluationLimit => tr!("too many evaluations"),
            Self::Cancelled => tr!("cancelled; the best so far is shown"),
            Self::Underdetermined => tr!("the data leave some parameters open"),
            Self::NoData => tr!("there are no data to fit"),
            Self::Numerical => tr!("a number beyond the range of f64 came up"),
        }
    }
}

impl<N: UnknownName> Localized for UndeterminedDirection<N> {
    fn localized(&self) -> String {
        let symbols = self.symbols();
        match (self.reason, &self.direction[..]) {
            (UndeterminedReason::NoEffect, _) => tr!("{} has no effect on these data", symbols),
            (UndeterminedReason::RatiosOnly, _) => tr!("{} together: only their ratios enter DoLP", symbols),
            (UndeterminedReason::TradeOff, [(one, _), (other, _)]) => {
                tr!("{0} and {1} trade off: these data fix a combination of them, not each", one.symbol(), other.symbol())
            }
            (UndeterminedReason::TradeOff, _) => tr!("{} together: these data fix combinations of them, not each", symbols),
        }
    }
}

impl<N: UnknownName> Localized for Undetermined<N> {
    fn localized(&self) -> String {
        match self {
            Self::Direction(direction) => direction.localized(),
            Self::Parameters(parameters) => tr!("not determined: {}", symbols(parameters)),
            Self::Poorly(parameters) => tr!("a standard error above half of the value: {}", symbols(parameters)),
        }
    }
}

impl<N: UnknownName> Localized for GeodesicEnd<N> {
    fn localized(&self) -> String {
        match self {
            Self::Bound { unknown, edge, value } => {
                let bound = if *edge == Edge::Lower {
                    tr!("{0} meets its lower bound {1}", unknown.symbol(), value)
                } else {
                    tr!("{0} meets its upper bound {1}", unknown.symbol(), value)
                };
                self.meaning().map_or_else(|| bound.clone(), |meaning| tr!("{0}: {1}", bound, translated(meaning)))
            }
            Self::Misfit => tr!("the data hold every direction: the misfit has reached the limit of 95 % before any bound"),
            Self::NothingMoves => tr!("no parameter can move"),
            Self::Lost => tr!("the direction bends too sharply to be followed any further"),
            Self::Endless => tr!("no bound is met, however far one goes"),
            Self::Cancelled => tr!("cancelled"),
        }
    }
}

impl Localized for ProblemError {
    fn localized(&self) -> String {
        match self {
            Self::MissingSigma { quantity, .. } => {
                tr!("the value of {0} has no {0}_sigma, which weights by standard deviation need", quantity)
            }
            Self::NothingToPredict => tr!("the model predicts DoLP only, and no DoLP is measured"),
            Self::StartOutsideBounds { parameter, value, low, high } => {
                tr!("{0} = {1} is outside its bounds {2} … {3}", parameter.key(), shortest(*value), shortest(*low), shortest(*high))
            }
            Self::Tie(error) => error.localized(),
        }
    }
}

impl Localized for TieError {
    fn localized(&self) -> String {
        match self {
            Self::Circle(parameters) => {
                let names: Vec<&str> = parameters.iter().copied().map(Parameter::symbol).collect();
                tr!("{} is a circle", names.join(" → "))
            }
            Self::Factor(tie) => {
                tr!("{0} = {1} × {2}: expected a factor other than 0", tie.parameter.symbol(), tie.factor, tie.to.symbol())
            }
            Self::Outside(tie) => tr!(
                "{0} = {1} × {2} lies outside its bounds whatever {2} is within its own",
                tie.parameter.symbol(),
                tie.factor,
                tie.to.symbol()
            ),
            other => other.to_string(),
        }
    }
}

impl Localized for FitError {
    fn localized(&self) -> String {
        match self {
            Self::Parameter(error) => error.localized(),
            Self::Bounds(error) => error.localized(),
            Self::Problem(error) => error.localized(),
            other => other.to_string(),
        }
    }
}

impl Localized for JointError {
    fn localized(&self) -> String {
        match self {
            Self::NoMeasurement => tr!("there is no measurement to fit"),
            Self::NameTwice(name) => tr!("two measurements are called {}: rename one of them", name),
            Self::UnknownName { name, known } => tr!("no measurement is called {0}; there are {1}", name, known),
            Self::OwnOfNone(parameter) => {
                tr!("no measurement can have its own {}: the model does not have this parameter", parameter.key())
            }
            Self::SharedDiffers { parameter, set } => {
                tr!("{0} is shared, and what is said of it for {1} differs from the others: make it an own parameter", parameter.key(), set)
            }
            Self::Weight { set, weight } => tr!("the weight of {0} is {1}: expected a number above 0", set, weight),
            Self::Fit { set, error } => tr!("{0}: {1}", set, error.localized()),
            other => other.to_string(),
        }
    }
}

impl Localized for DesignError {
    fn localized(&self) -> String {
        match self {
            Self::Parameters(error) => error.localized(),
            Self::Problem(error) => error.localized(),
        }
    }
}

impl Localized for CandidateError {
    fn localized(&self) -> String {
        match self {
            Self::Geometry(error) => error.localized(),
            Self::TooMany { count } => tr!("the lists make {} pairs of directions; use coarser steps", count),
            Self::Empty => tr!("a list of angles is empty"),
        }
    }
}

impl Localized for AngleChoiceError {
    fn localized(&self) -> String {
        match self {
            Self::TooFewCandidates { candidates, count } => {
                tr!("there are {0} candidates for {1} readings; use finer steps", candidates, count)
            }
            Self::TooFewReadings { values, parameters } => tr!("{0} values cannot determine {1} parameters", values, parameters),
            Self::Undetermined { parameters } => {
                tr!("no choice of these candidates determines {}; fix what is known, or measure more widely", symbols(parameters))
            }
            Self::NotFree { parameter } => tr!("{} is not free: its error cannot be made small", parameter.symbol()),
            Self::SameModel => tr!("a model cannot be told from itself"),
            Self::Nothing => tr!("there is nothing to choose angles for: no surface, no free parameter, or no quantity to measure"),
            Self::Parameters(error) => error.localized(),
            Self::Geometry(error) => error.localized(),
            Self::Problem(error) => error.localized(),
            Self::Cancelled => tr!("cancelled"),
        }
    }
}

impl Localized for BoundsError {
    fn localized(&self) -> String {
        match self {
            Self::Order { parameter, low, high } => {
                tr!(
                    "bounds of {0} are {1} … {2}: the lower one must be below the upper one",
                    parameter.key(),
                    shortest(*low),
                    shortest(*high)
                )
            }
            Self::Domain { parameter, value } => {
                tr!("bound {0} of {1} is not allowed: expected {2}", shortest(*value), parameter.key(), parameter.domain().localized())
            }
        }
    }
}

impl Localized for Evidence {
    fn localized(&self) -> String {
        match self {
            Self::Undefined => tr!("AICc is not defined for so few or so exact data"),
            Self::None => tr!("the data do not tell them apart"),
            Self::Weak => tr!("weak evidence"),
            Self::Considerable => tr!("considerable evidence"),
            Self::Decisive => tr!("essentially no support for the other"),
        }
    }
}

impl Localized for DistributionComparison {
    fn localized(&self) -> String {
        let measure = if self.is_delta_e { "ΔE".to_owned() } else { tr!("sum of squares") };
        let by = if self.ratio().is_finite() {
            tr!("{0} {1} times smaller", measure, format!("{:.4}", self.ratio()))
        } else {
            format!("{measure} 0")
        };
        let aicc = |gain: f64| {
            let lower = if gain > 0.0 { SlopeDistribution::Cauchy } else { SlopeDistribution::Gauss };
            tr!("AICc lower by {0} for {1}", format!("{:.1}", gain.abs()), lower.localized())
        };
        match self.verdict() {
            Verdict::Exact => tr!("Gauss and Cauchy both meet these data to the last digits: there is no winner."),
            Verdict::Alike => {
                let sum = format!("{:.4e}", self.gauss);
                if self.is_nested {
                    tr!(
                        "Gauss and Cauchy describe these data alike ({0} {1}): no evidence for a heavier tail; Gauss needs one parameter less.",
                        measure,
                        sum
                    )
                } else {
                    tr!("Gauss and Cauchy describe these data alike ({0} {1}).", measure, sum)
                }
            }
            Verdict::Bounded => tr!(
                "Gauss, the limit of Cauchy for large q, describes these data as well as Cauchy within its bounds ({0}): no evidence for a heavier tail; Gauss needs one parameter less.",
                by
            ),
            Verdict::NotWorthIt => tr!(
                "Cauchy comes nearer than Gauss ({0}) by too little for its additional parameter ({1}): no evidence for a heavier tail.",
                by,
                aicc(self.aicc_gain.unwrap_or_default())
            ),
            Verdict::Closer(winner) => {
                let other = match winner {
                    SlopeDistribution::Gauss => SlopeDistribution::Cauchy,
                    SlopeDistribution::Cauchy => SlopeDistribution::Gauss,
                };
                let (name, other) = (winner.localized(), other.localized());
                let result = if self.evidence() > Evidence::None {
                    tr!("{0} wins over {1}", name, other)
                } else {
                    tr!("{0} comes nearer than {1}", name, other)
                };
                let evidence = self.evidence().localized();
                let evidence = self.aicc_gain.map_or_else(|| evidence.clone(), |gain| tr!("{0}: {1}", aicc(gain), evidence));
                tr!("{0}: {1}; {2}.", result, by, evidence)
            }
        }
    }
}
