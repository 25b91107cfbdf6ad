//! Floor 4: from a measurement to parameters, and how far they can be trusted.
//!
//! [`Fit`] describes a fit and runs it. Beneath, [`Problem`] holds what is minimised, [`fit`] minimises it, and a [`FitResult`] says
//! what came of it: estimates, standard errors, what the data leave undetermined, and a typed reason for stopping. Clock, cancel
//! flag and progress come from outside ([`Observer`]).
//!
//! # The chain of a fit
//!
//! ```text
//! Fit ──► Problem = Observations (shared) + model + free parameters + bounds + start
//!           │
//! fit ──► multistart                                   multistart global optimisation
//!           │  ├─ initial_guess   variable projection on a grid (separable least squares)
//!           │  ├─ sequence        Kronecker low-discrepancy sequence with a Cranley–Patterson shift
//!           │  └─ search          probes, rounds of descents, lobe restarts, polishing
//!           ▼
//!         fit_local, from each start
//!           ├─ minpack            Levenberg–Marquardt (MINPACK's lmder) under a sin² transform
//!           └─ bounded_lm         active-set Levenberg–Marquardt with geodesic acceleration,
//!               │                 stopped by Bates and Watts' relative offset
//!               ├─ reparametrisation   local coordinates that straighten valleys, and their retraction
//!               └─ qr                  Householder QR, damped least squares in a box
//!           ▼
//!         analyse ──► FitResult   rank by SVD, pseudo-inverse covariance, AICc
//!
//! profile, bootstrap              profile likelihood, residual bootstrap
//! PredictionBand                  delta method
//! posterior                       draws from the posterior (no-U-turn sampler), evidence
//! Design, choose                  predicted errors of a choice of angles, and the choice
//! DistributionComparison          Gauss against Cauchy by AICc
//! Landscape                       the objective over two parameters
//! ```

mod analysis;
mod bounds;
mod builder;
mod design;
mod distribution_comparison;
mod estimate;
mod fit_problem;
mod free_parameters;
mod geodesic;
mod intervals;
mod joint;
mod landscape;
mod least_squares;
mod local;
mod loss;
mod many;
mod multistart;
mod objective;
mod objective_scale;
mod observations;
mod observer;
mod options;
pub mod posterior;
mod problem_error;
mod result;
pub mod rounding;
mod row;
mod single;
mod solve;
mod special_cases;
mod stop_reason;
mod tied_problem;
mod ties;

pub use analysis::analyse;
pub use bounds::{Bounds, BoundsError};
pub use builder::{Fit, FitError};
pub use design::{
    AngleChoice, AngleChoiceError, CandidateError, CandidateGrid, ChosenAngles, Design, DesignCriterion, DesignError, DesignPrediction,
    NoiseModel, choose, next_gains,
};
pub use distribution_comparison::{DistributionComparison, Evidence, GaussAtFixedSigma, Verdict};
pub use estimate::{
    Edge, Estimate, EstimateStatus, Undetermined, ends_text, is_determined, is_poorly_determined, relative_error_base, symbols,
};
pub use fit_problem::{FitProblem, UnknownName};
pub use free_parameters::{fittable, free_by_default};
pub use geodesic::{Geodesic, GeodesicEnd, GeodesicPoint, GeodesicWay, weakest_geodesic};
pub use intervals::band::PredictionBand;
pub use intervals::bootstrap::{Bootstrap, BootstrapEstimate, bootstrap};
pub use intervals::interval::Interval;
pub use intervals::linear::{RANK_THRESHOLD, Uncertainty, UndeterminedDirection, UndeterminedReason};
pub use intervals::profile::{LEVELS, Profile, ProfilePoint, profile, set_intervals, with_intervals};
pub use joint::builder::{JointError, JointFit, fit_jointly};
pub use joint::problem::JointProblem;
pub use joint::result::{JointResult, SetResult, analyse_jointly, bootstrap_jointly, profile_jointly, with_intervals_jointly};
pub use joint::unknown::JointUnknown;
pub use landscape::{Landscape, LandscapeAxis};
pub use least_squares::LeastSquares;
#[cfg(feature = "selftest")]
pub(crate) use local::sin_squared::SinSquared;
pub use local::solution::{LocalFit, Solution};
pub use local::solver::{Effort, fit_local, minimise};
pub use many::{on_one_thread, thread_count};
pub use multistart::basin::{Basin, MultistartResult};
pub use multistart::search::{Starts, multistart};
pub use multistart::stopping_rule::StoppingRule;
pub use objective::Problem;
pub use observer::{Observer, TracePoint};
pub use options::{BrdfResiduals, FitOptions, FitRange, Intervals, Loss, Weights};
pub use problem_error::ProblemError;
pub use result::{Correlations, Course, FitResult, Minimum, Statistics};
pub use row::{RowCell, row_columns};
pub use solve::fit;
pub use special_cases::{SpecialCases, fit_ladder, special_cases_first, with_special_cases, with_special_cases_jointly};
pub use stop_reason::StopReason;
pub use ties::{Tie, TieError, apply_ties, resolve_ties};
