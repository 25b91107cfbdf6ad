//! What is asked about a finished fit: the profile of a parameter, and a bootstrap.

use crate::app::work::fit_history::FitEntry;
use pbrdf::fit::{Bootstrap, Interval, Profile, Weights};
use pbrdf::model::Parameter;

/// Diagnostics around the fit that is shown.
pub struct Diagnostics {
    /// The parameter to scan next.
    pub parameter: Option<Parameter>,
    pub profile: Option<ProfileCurve>,
    /// How many data sets the next bootstrap deals out.
    pub replicates: usize,
    pub scatter: Option<Bootstrap>,
}

impl Diagnostics {
    /// Before anything was asked.
    pub const NONE: Self = Self { parameter: None, profile: None, replicates: 200, scatter: None };

    /// Lets go of what belongs to another fit.
    pub fn forget(&mut self) {
        self.profile = None;
        self.scatter = None;
    }
}

/// A profile as it is drawn: what the sum of squares gains over its minimum.
pub struct ProfileCurve {
    pub parameter: Parameter,
    /// Value and gain.
    pub points: Vec<[f64; 2]>,
    /// The gains at 68.3 and at 95 %; infinite where no degree of freedom is left.
    pub limits: [f64; 2],
    /// The intervals between the places where the curve meets them.
    pub intervals: [Interval; 2],
    /// Whether it was followed to its ends.
    pub is_complete: bool,
    /// The fitted value.
    pub best: f64,
    /// Whether the gain is one of χ².
    pub is_chi2: bool,
}

impl ProfileCurve {
    /// Of a parameter of that fit; the sum of squares is that of all its measurements.
    pub fn new(profile: &Profile, fit: &FitEntry) -> Self {
        let (problem, report) = (&fit.problem, &fit.report);
        let smallest = fit.joint.as_ref().map_or(report.statistics.rss, |part| part.of.result.statistics.rss);
        let is_chi2 = problem.options().weights == Weights::Sigma;
        let points = profile.points.iter().map(|point| [point.value, point.rss - smallest]);
        Self {
            parameter: profile.parameter,
            points: points.filter(|[_, gain]| gain.is_finite()).collect(),
            limits: profile.limits.map(|limit| limit - smallest),
            intervals: [profile.interval68, profile.interval95],
            is_complete: profile.is_complete,
            best: report.parameters[profile.parameter],
            is_chi2,
        }
    }
}
