//! Gauss against Cauchy on one data set: which distribution of slopes describes it better, and by how much.
//!
//! The measure is what both fits minimised, and for the evidence the difference of AICc (Burnham and Anderson, *Model Selection and Multimodel
//! Inference*, 2002, sec. 2.6: up to 2 is no difference, from 4 on the worse one has considerably less support, from 10 on essentially none).
//!
//! Equal σ means different widths, so that the better of two fits may win by its width alone. Gauss is therefore fitted twice more beside
//! Cauchy's (σ, q): with σ held at Cauchy's σ, and at the σ of equal median slope, where only the tail differs.

use crate::fit::multistart::search::Starts;
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::result::FitResult;
use crate::fit::solve::fit;
use crate::model::{Parameter, ParameterSet, Parameters};
use crate::optics::SlopeDistribution;
use std::fmt;

/// Both fits side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistributionComparison {
    /// Sum of squares that Gauss came down to.
    pub gauss: f64,
    /// The same of Cauchy.
    pub cauchy: f64,
    /// AICc of Gauss less that of Cauchy; none where either has none.
    pub aicc_gain: Option<f64>,
    /// Whether the sums of squares are ΔE up to a factor that both share.
    pub is_delta_e: bool,
}

/// Gauss with its σ held by Cauchy's fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussAtFixedSigma {
    /// Cauchy's σ, at which Gauss was held, and the sum of squares there.
    pub equal_sigma: (f64, f64),
    /// The σ of equal median slope, and the sum of squares there.
    pub equal_median: (f64, f64),
}

/// Sums of squares whose ratio is nearer to 1 are the same: two descents along one flat valley end no nearer to each other.
const SAME: f64 = 1e-4;

impl DistributionComparison {
    /// Of two fits of the same data by the same choices; none where a sum is not finite.
    #[must_use]
    pub fn new(gauss: &FitResult, cauchy: &FitResult) -> Option<Self> {
        let sums = [gauss.statistics.rss, cauchy.statistics.rss];
        sums.iter().all(|sum| sum.is_finite()).then(|| Self {
            gauss: sums[0],
            cauchy: sums[1],
            aicc_gain: gauss.statistics.aicc.zip(cauchy.statistics.aicc).map(|(gauss, cauchy)| gauss - cauchy),
            is_delta_e: gauss.statistics.minimises_delta_e && cauchy.statistics.minimises_delta_e,
        })
    }

    /// The distribution with the smaller sum of squares; none where they are the same.
    #[must_use]
    pub fn winner(&self) -> Option<SlopeDistribution> {
        let larger = self.gauss.max(self.cauchy);
        if (self.gauss - self.cauchy).abs() <= SAME * larger {
            None
        } else if self.cauchy < self.gauss {
            Some(SlopeDistribution::Cauchy)
        } else {
            Some(SlopeDistribution::Gauss)
        }
    }

    /// The larger sum of squares over the smaller; infinite where the smaller is 0.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        let (smaller, larger) = (self.gauss.min(self.cauchy), self.gauss.max(self.cauchy));
        if larger == 0.0 { 1.0 } else { larger / smaller }
    }

    /// What the difference of AICc is worth.
    #[must_use]
    pub fn evidence(&self) -> Evidence {
        match self.aicc_gain.map(f64::abs) {
            None => Evidence::Undefined,
            Some(gain) if gain < 2.0 => Evidence::None,
            Some(gain) if gain < 4.0 => Evidence::Weak,
            Some(gain) if gain < 10.0 => Evidence::Considerable,
            Some(_) => Evidence::Decisive,
        }
    }

    /// Which of both describes the data better.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match self.winner() {
            None => Verdict::Alike { gauss_preferred: self.aicc_gain.is_some_and(|gain| gain < 0.0) },
            // A smaller sum that AICc does not think worth its parameter is no victory.
            Some(winner) => Verdict::Closer {
                winner,
                confirmed: self.aicc_gain.is_none_or(|gain| (gain > 0.0) == (winner == SlopeDistribution::Cauchy)),
            },
        }
    }
}

/// What a difference of AICc between two models of the same data is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evidence {
    /// AICc is not defined for one of them.
    Undefined,
    /// Below 2: none.
    None,
    /// From 2 to 4.
    Weak,
    /// From 4 to 10.
    Considerable,
    /// From 10 on.
    Decisive,
}

/// Which of two distributions describes the data better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Both sums of squares are the same.
    Alike {
        /// Whether AICc is lower for Gauss, which has one parameter less.
        gauss_preferred: bool,
    },
    /// One sum of squares is smaller.
    Closer {
        /// Whose.
        winner: SlopeDistribution,
        /// Whether AICc is lower for the same distribution, or not defined.
        confirmed: bool,
    },
}

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Undefined => "AICc is not defined for so few or so exact data",
            Self::None => "the data do not tell them apart",
            Self::Weak => "weak evidence",
            Self::Considerable => "considerable evidence",
            Self::Decisive => "essentially no support for the other",
        })
    }
}

/// Who wins and by how much, in a sentence.
impl fmt::Display for DistributionComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let measure = if self.is_delta_e { "ΔE" } else { "sum of squares" };
        let (winner, confirmed) = match self.verdict() {
            Verdict::Alike { gauss_preferred } => {
                let fewer = if gauss_preferred { ": Cauchy's tail exponent buys nothing here" } else { "" };
                return write!(f, "Gauss and Cauchy describe these data alike ({measure} {:.4e}){fewer}.", self.gauss);
            }
            Verdict::Closer { winner, confirmed } => (winner, confirmed),
        };
        let (name, other) = match winner {
            SlopeDistribution::Gauss => ("Gauss", "Cauchy"),
            SlopeDistribution::Cauchy => ("Cauchy", "Gauss"),
        };
        let verb = if confirmed { "wins over" } else { "comes nearer than" };
        let ratio = if self.ratio().is_finite() { format!("{:.4} times smaller", self.ratio()) } else { "0".to_owned() };
        write!(f, "{name} {verb} {other}: {measure} {ratio}; ")?;
        if let Some(gain) = self.aicc_gain {
            let lower = if gain > 0.0 { "Cauchy" } else { "Gauss" };
            write!(f, "AICc lower by {:.1} for {lower}: ", gain.abs())?;
        }
        write!(f, "{}.", self.evidence())
    }
}

impl GaussAtFixedSigma {
    /// Fits Gauss again from its own solution with σ held; none where σ is not free in both fits or the equal median lies beyond f64.
    #[must_use]
    pub fn new(problem: &Problem, gauss: &FitResult, cauchy: &FitResult, watch: Observer<'_>) -> Option<Self> {
        let is_free = |report: &FitResult| report.estimates.iter().any(|estimate| estimate.parameter == Parameter::Sigma && estimate.free);
        let Parameters { sigma, q, .. } = cauchy.parameters;
        let median = SlopeDistribution::gauss_of_equal_median(sigma, q);
        let is_a_sigma = median.is_finite() && median > 0.0;
        if !(is_free(gauss) && is_free(cauchy) && is_a_sigma) {
            return None;
        }
        let rest: ParameterSet = problem.free().iter().copied().filter(|&parameter| parameter != Parameter::Sigma).collect();
        let held = |sigma: f64| {
            let start = Parameters { sigma, ..gauss.parameters };
            (sigma, fit(&problem.with_free(rest).with_start(start), Starts::One, 0, watch).statistics.rss)
        };
        Some(Self { equal_sigma: held(sigma), equal_median: held(median) })
    }

    /// In a sentence.
    #[must_use]
    pub fn text(&self, contest: &DistributionComparison) -> String {
        let times =
            |sum: f64| if contest.cauchy > 0.0 { format!("{:.4} times Cauchy's", sum / contest.cauchy) } else { format!("{sum:.4e}") };
        let ((equal, on_equal), (median, on_median)) = (self.equal_sigma, self.equal_median);
        format!(
            "Gauss held at Cauchy's σ = {equal:.5}: {}; at equal median slope, σ = {median:.5}, where only the tail differs: {}.",
            times(on_equal),
            times(on_median)
        )
    }
}
