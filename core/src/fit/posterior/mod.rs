//! Draws from the posterior of a fit: what all surfaces look like that the data allow.
//!
//! [`Posterior`] takes the problem of a fit and priors, and draws by the no-U-turn sampler; a [`PosteriorSample`] says what came of it.
//!
//! ```text
//! Posterior ──► PosteriorDensity = Likelihood (the fit's residuals) × priors, in the coordinates of
//!    │                             Transform (box → ℝᵈ; walls, valley: straight up to the ends)
//!    ▼
//! sampler      chains in parallel; warm-up in windows
//!    ├─ metric, bend     whitened and straightened coordinates, learnt in the warm-up
//!    ├─ nuts             trajectories of macro steps, divided where the density is narrow (WALNUTS)
//!    └─ step_size        dual averaging
//!    ▼
//! PosteriorSample: diagnostics (R̂, effective sizes), evidence (bridge sampling), verdict
//! ```

mod bend;
mod density;
mod depolarised_light;
mod derived;
mod diagnostics;
mod evidence;
mod likelihood;
mod log_density;
mod macro_step;
mod metric;
mod nuts;
mod odds;
mod parts;
mod phase;
mod prior;
mod run;
mod sample;
mod sampler;
mod step_size;
mod transform;
mod valley;
mod walls;

pub use derived::DerivedQuantity;
pub use diagnostics::{Convergence, convergence, quantile};
pub use evidence::LogEvidence;
pub use odds::{Odds, OddsGrade};
pub use parts::PosteriorProblem;
pub use prior::{BoundedPrior, Prior, PriorError};
pub use run::{Posterior, PosteriorError, PosteriorProgress, PosteriorSettings, SampleOf};
pub use sample::{MarginalSummary, NoiseQuantiles, PosteriorDraw, PosteriorSample, PosteriorVerdict};
