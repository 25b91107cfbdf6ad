//! Floor 4: from a measurement to parameters, and how far they can be trusted.
//!
//! [`Problem`] holds what is minimised, [`fit`] minimises it and returns a [`FitResult`]: a value with parameters, standard errors, what
//! the data leave open, the trace and a typed reason for stopping. Clock, cancel and progress come from outside ([`Observer`]).

mod analysis;
mod bounds;
mod design;
mod distribution_comparison;
mod estimate;
mod free_parameters;
mod intervals;
mod landscape;
mod least_squares;
mod local;
mod loss;
mod multistart;
mod objective;
mod observations;
mod observer;
mod options;
mod result;
mod solve;
mod stop_reason;

pub use analysis::analyse;
pub use bounds::{Bounds, BoundsError};
pub use design::{Design, DesignError, DesignPrediction, NoiseModel};
pub use distribution_comparison::{DistributionComparison, GaussAtFixedSigma};
pub use estimate::{Edge, Estimate, EstimateStatus, Undetermined, is_poorly_determined, relative_error_base, symbols, with_error};
pub use free_parameters::free_by_default;
pub use intervals::band::PredictionBand;
pub use intervals::bootstrap::{BootstrapEstimate, bootstrap};
pub use intervals::linear::{RANK_THRESHOLD, Uncertainty, UndeterminedDirection};
pub use intervals::profile::{Profile, ProfilePoint, profile};
pub use landscape::{Axis, Landscape};
pub use least_squares::LeastSquares;
pub use local::solution::{LocalFit, Solution};
pub use local::solver::{Effort, fit_local, minimise};
pub use multistart::basin::{Basin, MultistartResult};
pub use multistart::search::{Starts, multistart};
pub use objective::{Problem, ProblemError};
pub use observer::{Observer, TracePoint};
pub use options::{BrdfResiduals, FitOptions, Loss, Weights};
pub use result::{Correlations, Course, FitResult, Minimum, Statistics};
pub use solve::fit;
pub use stop_reason::StopReason;
