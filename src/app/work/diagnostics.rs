//! What is asked about a finished fit: the profile of a parameter, and a bootstrap.

use pbrdf::fit::{BootstrapEstimate, FitResult, Problem, Profile, Weights};
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

/// How each parameter scattered.
pub struct Bootstrap {
    pub replicates: usize,
    pub scatter: Vec<BootstrapEstimate>,
}

impl Default for Diagnostics {
    fn default() -> Self {
        Self { parameter: None, profile: None, replicates: 200, scatter: None }
    }
}

impl Diagnostics {
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
    /// The gain that one standard error makes.
    pub limit: f64,
    /// Where the curve meets it, on either side; none where the scan ends before.
    pub low: Option<f64>,
    pub high: Option<f64>,
    /// The fitted value.
    pub best: f64,
    /// Whether the gain is one of χ².
    pub is_chi2: bool,
}

impl ProfileCurve {
    pub fn new(profile: &Profile, problem: &Problem, report: &FitResult) -> Self {
        let smallest = report.statistics.rss;
        let is_chi2 = problem.options().weights == Weights::Sigma;
        #[expect(clippy::cast_precision_loss, reason = "degrees of freedom")]
        let limit = if is_chi2 { 1.0 } else { smallest / report.statistics.dof.max(1) as f64 };
        let points = profile.points.iter().map(|point| [point.value, point.rss - smallest]);
        Self {
            parameter: profile.parameter,
            points: points.filter(|[_, gain]| gain.is_finite()).collect(),
            limit,
            low: profile.low,
            high: profile.high,
            best: report.parameters[profile.parameter],
            is_chi2,
        }
    }
}
