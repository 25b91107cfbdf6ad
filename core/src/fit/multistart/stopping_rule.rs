//! When a multistart search has seen enough.

use crate::fit::fit_problem::FitProblem;
use serde::{Deserialize, Serialize};

/// When a search of as many starts as needed ends: the best minimum was hit `hits` times and the expected share of starts that would
/// end in minima not seen yet, `w(w + 1)/(n(n − 1))` of w distinct minima after n starts (Boender and Kan, Math. Program. 37, 59 (1987)),
/// is below `unseen_share`; or all starts are used.
///
/// The defaults are those of [`Starts::Automatic`](crate::fit::Starts) for data of DoLP alone. With a BRDF, whose lobes of more
/// free weights have narrower basins, the automatic search waits for a share of 0.004.
///
/// ```
/// use pbrdf::fit::{Starts, StoppingRule};
/// use pbrdf::{Fit, Measurement, Model};
///
/// let data = Measurement::read("theta_i,theta_r,dolp\n40,20,0.11\n40,40,0.24\n40,60,0.42".as_bytes())?;
/// let patient = StoppingRule { hits: 5, unseen_share: 1e-3, ..StoppingRule::default() };
/// let result = Fit::new(&data, Model::SPECULAR).starts(Starts::Until(patient)).run()?;
/// assert!(result.course.minima[0].hits >= 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct StoppingRule {
    /// Starts, at most; at least 1. By default 96.
    pub most_starts: usize,
    /// Hits of the best minimum, at least. By default 3: two may be chance, where starts are neighbours.
    pub hits: usize,
    /// Expected share of starts that would end in minima not seen yet, from 0 to 1. By default 0.025.
    pub unseen_share: f64,
}

/// With a BRDF.
const UNSEEN_SHARE_OF_BRDF: f64 = 0.004;
/// A problem whose first guesses come from searches of its parts: what is left to be searched for is how these go together.
const COMPOSED: StoppingRule = StoppingRule { most_starts: 36, hits: 3, unseen_share: 0.07 };

impl Default for StoppingRule {
    fn default() -> Self {
        Self { most_starts: 96, hits: 3, unseen_share: 0.025 }
    }
}

impl StoppingRule {
    /// That of the automatic search of a problem.
    pub(crate) fn of<P: FitProblem>(problem: &P) -> Self {
        if problem.is_composed() {
            COMPOSED
        } else if problem.knows_only_ratios() {
            Self::default()
        } else {
            Self { unseen_share: UNSEEN_SHARE_OF_BRDF, ..Self::default() }
        }
    }
}
