//! Gauss against Cauchy on one data set: which distribution of slopes describes it better, and by how much.
//!
//! The measure is ΔE where both fits can be compared by it, and for the evidence the difference of AICc (Burnham and Anderson, *Model
//! Selection and Multimodel Inference*, 2002, sec. 2.6: up to 2 is no difference, from 4 on the worse one has considerably less support,
//! from 10 on essentially none).
//!
//! Gauss is the limit q → ∞ of Cauchy at σ_Gauss = σ/√q. Where q is free, Cauchy therefore cannot lose but by the bound of q, and an AICc
//! that is lower for Gauss is the price of the parameter that Cauchy has more: it is no evidence. Evidence is for a heavier tail, or none.
//!
//! Equal σ means different widths, so that Cauchy may win by its width alone. Gauss is therefore fitted twice more beside Cauchy's
//! (σ, q): with σ held at Cauchy's σ, and at the σ of equal median slope, where peak and tail differ: Cauchy has more flat and more steep
//! facets, and fewer between.

use crate::fit::joint::builder::fit_jointly;
use crate::fit::joint::problem::JointProblem;
use crate::fit::joint::result::JointResult;
use crate::fit::multistart::search::Starts;
use crate::fit::objective::Problem;
use crate::fit::observer::Observer;
use crate::fit::options::Intervals;
use crate::fit::result::{FitResult, Statistics};
use crate::fit::solve::fit;
use crate::model::{Parameter, ParameterSet, Parameters};
use crate::optics::SlopeDistribution;
use std::fmt;

/// Both fits side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistributionComparison {
    /// ΔE that Gauss came down to, or its sum of squares.
    pub gauss: f64,
    /// The same of Cauchy.
    pub cauchy: f64,
    /// AICc of Gauss less that of Cauchy; none where either has none.
    pub aicc_gain: Option<f64>,
    /// Whether the measure is ΔE.
    pub is_delta_e: bool,
    /// Whether q is free, so that Cauchy has Gauss as its limit and one parameter more.
    pub is_nested: bool,
    /// Whether both meet the data to the last digits, [`FitResult::is_exact`].
    pub is_exact: bool,
}

/// Gauss with its σ held by Cauchy's fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussAtFixedSigma {
    /// Cauchy's σ, at which Gauss was held, and the measure of [`DistributionComparison`] there.
    pub equal_sigma: (f64, f64),
    /// The σ of equal median slope, and the measure there.
    pub equal_median: (f64, f64),
}

/// Measures whose relative difference is smaller are the same: of 100 residuals, it moves AICc by 0.1.
const SAME: f64 = 1e-3;
/// Difference of AICc below which it is no evidence.
const NO_EVIDENCE: f64 = 2.0;

/// What of a fit is compared.
struct Compared<'a> {
    objective: Option<f64>,
    statistics: &'a Statistics,
    /// The parameters that are free.
    free: ParameterSet,
    is_exact: bool,
}

impl<'a> Compared<'a> {
    fn single(fit: &'a FitResult) -> Self {
        let free = fit.estimates.iter().filter(|estimate| estimate.free).map(|estimate| estimate.parameter).collect();
        Self { objective: fit.objective, statistics: &fit.statistics, free, is_exact: fit.is_exact() }
    }

    fn joint(fit: &'a JointResult) -> Self {
        let free = fit.estimates().filter(|(_, estimate)| estimate.free).map(|(name, _)| name.parameter).collect();
        Self { objective: fit.objective, statistics: &fit.statistics, free, is_exact: fit.is_exact() }
    }

    /// ΔE of the fit, or its sum of squares.
    fn measure(&self, is_delta_e: bool) -> f64 {
        self.objective.filter(|_| is_delta_e).unwrap_or(self.statistics.rss)
    }
}

/// Whether ΔE is the measure: it is what both minimised, or each weighted its sum by variances or loss scales of its own.
fn are_compared_by_delta_e(gauss: &Compared<'_>, cauchy: &Compared<'_>) -> bool {
    let (a, b) = (gauss.statistics, cauchy.statistics);
    let is_one_sum = a.loss_scales == b.loss_scales && a.block_weights == b.block_weights;
    gauss.objective.is_some() && cauchy.objective.is_some() && (!is_one_sum || a.minimises_delta_e && b.minimises_delta_e)
}

impl DistributionComparison {
    /// Of two fits of the same data by the same choices; none where a sum is not finite.
    #[must_use]
    pub fn new(gauss: &FitResult, cauchy: &FitResult) -> Option<Self> {
        Self::of(&Compared::single(gauss), &Compared::single(cauchy))
    }

    /// The same of two joint fits.
    #[must_use]
    pub fn jointly(gauss: &JointResult, cauchy: &JointResult) -> Option<Self> {
        Self::of(&Compared::joint(gauss), &Compared::joint(cauchy))
    }

    fn of(gauss: &Compared<'_>, cauchy: &Compared<'_>) -> Option<Self> {
        let is_delta_e = are_compared_by_delta_e(gauss, cauchy);
        let sums = [gauss, cauchy].map(|fit| fit.measure(is_delta_e));
        sums.iter().all(|sum| sum.is_finite()).then(|| Self {
            gauss: sums[0],
            cauchy: sums[1],
            aicc_gain: gauss.statistics.aicc.zip(cauchy.statistics.aicc).map(|(gauss, cauchy)| gauss - cauchy),
            is_delta_e,
            is_nested: cauchy.free.contains(Parameter::Q),
            is_exact: gauss.is_exact && cauchy.is_exact,
        })
    }

    /// The larger measure over the smaller; infinite where the smaller is 0.
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
            Some(gain) if gain < NO_EVIDENCE => Evidence::None,
            Some(gain) if gain < 4.0 => Evidence::Weak,
            Some(gain) if gain < 10.0 => Evidence::Considerable,
            Some(_) => Evidence::Decisive,
        }
    }

    /// Which of both describes the data better.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let is_same = (self.gauss - self.cauchy).abs() <= SAME * self.gauss.max(self.cauchy);
        let closer = if self.cauchy < self.gauss { SlopeDistribution::Cauchy } else { SlopeDistribution::Gauss };
        // What AICc says against Cauchy is the price of q, where q is free.
        let gain = self.aicc_gain.map(|gain| if self.is_nested { gain.max(0.0) } else { gain });
        match gain {
            _ if self.is_exact => Verdict::Exact,
            // DoLP and BRDF by variances of their own are judged by AICc, not by ΔE.
            Some(gain) if gain >= NO_EVIDENCE => Verdict::Closer(SlopeDistribution::Cauchy),
            Some(gain) if gain <= -NO_EVIDENCE => Verdict::Closer(SlopeDistribution::Gauss),
            _ if is_same => Verdict::Alike,
            _ if self.is_nested && closer == SlopeDistribution::Gauss => Verdict::Bounded,
            Some(_) if self.is_nested => Verdict::NotWorthIt,
            _ => Verdict::Closer(closer),
        }
    }
}

/// What a difference of AICc between two models of the same data is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
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
    /// Both meet the data to the last digits: rounding decides nothing.
    Exact,
    /// The measure is the same, and so is the evidence but for the price of a parameter.
    Alike,
    /// Cauchy, whose limit is Gauss, is kept from it by a bound.
    Bounded,
    /// Cauchy comes nearer, by too little for the parameter that it has more.
    NotWorthIt,
    /// One describes the data better: as much as [`DistributionComparison::evidence`] says.
    Closer(SlopeDistribution),
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
        let smaller = || if self.ratio().is_finite() { format!("{:.4} times smaller", self.ratio()) } else { "0".to_owned() };
        let aicc = |gain: f64| format!("AICc lower by {:.1} for {}", gain.abs(), if gain > 0.0 { "Cauchy" } else { "Gauss" });
        match self.verdict() {
            Verdict::Exact => f.write_str("Gauss and Cauchy both meet these data to the last digits: there is no winner."),
            Verdict::Alike => {
                write!(f, "Gauss and Cauchy describe these data alike ({measure} {:.4e})", self.gauss)?;
                f.write_str(if self.is_nested { ": no evidence for a heavier tail; Gauss needs one parameter less." } else { "." })
            }
            Verdict::Bounded => write!(
                f,
                "Gauss, the limit of Cauchy for large q, describes these data as well as Cauchy within its bounds ({measure} {}): no \
                 evidence for a heavier tail; Gauss needs one parameter less.",
                smaller()
            ),
            Verdict::NotWorthIt => write!(
                f,
                "Cauchy comes nearer than Gauss ({measure} {}) by too little for its additional parameter ({}): no evidence for a heavier \
                 tail.",
                smaller(),
                aicc(self.aicc_gain.unwrap_or_default())
            ),
            Verdict::Closer(winner) => {
                let (name, other) = match winner {
                    SlopeDistribution::Gauss => ("Gauss", "Cauchy"),
                    SlopeDistribution::Cauchy => ("Cauchy", "Gauss"),
                };
                let verb = if self.evidence() > Evidence::None { "wins over" } else { "comes nearer than" };
                write!(f, "{name} {verb} {other}: {measure} {}; ", smaller())?;
                self.aicc_gain.map_or(Ok(()), |gain| write!(f, "{}: ", aicc(gain)))?;
                write!(f, "{}.", self.evidence())
            }
        }
    }
}

impl GaussAtFixedSigma {
    /// Fits Gauss again from its own solution with σ held; none where σ is not free in both fits or the equal median lies beyond f64.
    #[must_use]
    pub fn new(problem: &Problem, gauss: &FitResult, cauchy: &FitResult, watch: Observer<'_>) -> Option<Self> {
        let rest: ParameterSet = problem.free().iter().copied().filter(|&parameter| parameter != Parameter::Sigma).collect();
        let held = |sigma: f64, is_delta_e: bool| {
            let start = Parameters { sigma, ..gauss.parameters };
            let fit = fit(&problem.with_free(rest).with_start(start), Starts::One, 0, watch);
            Compared::single(&fit).measure(is_delta_e)
        };
        Self::of(&Compared::single(gauss), &Compared::single(cauchy), &cauchy.parameters, &held)
    }

    /// The same of joint fits; none where measurements have their own σ or q.
    #[must_use]
    pub fn jointly(problem: &JointProblem, gauss: &JointResult, cauchy: &JointResult, watch: Observer<'_>) -> Option<Self> {
        let shape = ParameterSet::EMPTY.with(Parameter::Sigma).with(Parameter::Q);
        if !problem.own().intersection(shape).is_empty() {
            return None;
        }
        let rest = Parameter::ALL.into_iter().filter(|&parameter| parameter != Parameter::Sigma).collect();
        let held = |sigma: f64, is_delta_e: bool| {
            let start: Vec<Parameters> = gauss.points().into_iter().map(|parameters| Parameters { sigma, ..parameters }).collect();
            let fit = fit_jointly(&problem.with_start(&start).with_free(rest), Starts::One, 0, Intervals::Linear, watch);
            Compared::joint(&fit).measure(is_delta_e)
        };
        Self::of(&Compared::joint(gauss), &Compared::joint(cauchy), &cauchy.sets.first()?.parameters, &held)
    }

    /// Given what Gauss comes down to with σ held.
    fn of(gauss: &Compared<'_>, cauchy: &Compared<'_>, of_cauchy: &Parameters, held: &dyn Fn(f64, bool) -> f64) -> Option<Self> {
        let Parameters { sigma, q, .. } = *of_cauchy;
        let median = SlopeDistribution::gauss_of_equal_median(sigma, q);
        let is_a_sigma = median.is_finite() && median > 0.0;
        if !(gauss.free.contains(Parameter::Sigma) && cauchy.free.contains(Parameter::Sigma) && is_a_sigma) {
            return None;
        }
        let is_delta_e = are_compared_by_delta_e(gauss, cauchy);
        let [equal_sigma, equal_median] = [sigma, median].map(|sigma| (sigma, held(sigma, is_delta_e)));
        Some(Self { equal_sigma, equal_median })
    }

    /// In a sentence.
    #[must_use]
    pub fn text(&self, contest: &DistributionComparison) -> String {
        let times =
            |sum: f64| if contest.cauchy > 0.0 { format!("{:.4} times Cauchy's", sum / contest.cauchy) } else { format!("{sum:.4e}") };
        let ((equal, on_equal), (median, on_median)) = (self.equal_sigma, self.equal_median);
        format!(
            "Gauss held at Cauchy's σ = {equal:.5}: {}; at equal median slope, σ = {median:.5}, where peak and tail differ: {}.",
            times(on_equal),
            times(on_median)
        )
    }
}
