//! Floor 4: from a measurement to parameters, and how far they can be trusted.
//!
//! [`Problem`] holds what is minimised, [`fit`] minimises it and returns a [`FitReport`]: a value with parameters, standard errors, what
//! the data leave open, the trace and a typed reason for stopping. Clock, cancel and progress come from outside ([`Watch`]).

mod approach;
mod band;
mod bootstrap;
mod bounds;
mod choices;
mod contest;
mod coordinates;
mod guess;
mod landscape;
mod least_squares;
mod outcome;
mod plan;
mod problem;
mod profile;
mod qr;
mod solver;
mod starts;
mod uncertainty;
mod walk;

pub use band::Band;
pub use bootstrap::{Scatter, bootstrap};
pub use bounds::{Bounds, BoundsError};
pub use choices::{BrdfResiduals, Choices, Eq17, Loss, Weights};
pub use contest::{Contest, HeldGauss};
pub use landscape::{Axis, Landscape};
pub use least_squares::LeastSquares;
pub use outcome::{Edge, Estimate, FitReport, Minimum, Standing, fit, is_loose, loose_in_words, size_of};
pub use plan::{Plan, PlanError, PlannedNoise, Prediction};
pub use problem::{Problem, ProblemError, free_by_default};
pub use profile::{Profile, ProfilePoint, profile};
pub use solver::{Descent, Effort, Solution, StopReason, TracePoint, Watch, descend, minimise};
pub use starts::{Found, Search, Starts, search};
pub use uncertainty::{OpenDirection, RANK_THRESHOLD, Uncertainty};
