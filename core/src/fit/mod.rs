//! Floor 4: from a measurement to parameters, and how far they can be trusted.
//!
//! [`Problem`] holds what is minimised, [`fit`] minimises it and returns a [`FitReport`]: a value with parameters, standard errors, what
//! the data leave open, the trace and a typed reason for stopping. Clock, cancel and progress come from outside ([`Watch`]).

mod bounds;
mod design;
mod distribution_comparison;
mod intervals;
mod landscape;
mod least_squares;
mod local;
mod multistart;
mod objective;
mod options;
mod result;

pub use bounds::{Bounds, BoundsError};
pub use design::{Plan, PlanError, PlannedNoise, Prediction};
pub use distribution_comparison::{Contest, HeldGauss};
pub use intervals::band::Band;
pub use intervals::bootstrap::{Scatter, bootstrap};
pub use intervals::linear::{OpenDirection, RANK_THRESHOLD, Uncertainty};
pub use intervals::profile::{Profile, ProfilePoint, profile};
pub use landscape::{Axis, Landscape};
pub use least_squares::LeastSquares;
pub use local::solver::{Descent, Effort, Solution, StopReason, TracePoint, Watch, descend, minimise};
pub use multistart::search::{Found, Search, Starts, search};
pub use objective::{Problem, ProblemError, free_by_default};
pub use options::{BrdfResiduals, Choices, Eq17, Loss, Weights};
pub use result::{Edge, Estimate, FitReport, Minimum, Standing, fit, is_loose, loose_in_words, size_of};
