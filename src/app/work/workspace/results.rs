//! What was found out about each measurement.

use crate::app::work::diagnostics::Diagnostics;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::posterior::DrawnPosterior;
use crate::app::work::predicted_errors::PlannedAngles;
use crate::app::work::weakest_walk::WeakestWalk;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What the window shows of a measurement while it is active.
pub(super) struct Results {
    pub shown_fit: Option<Arc<FitEntry>>,
    pub model_comparison: Vec<ModelFit>,
    /// Of the shown fit.
    pub diagnostics: Diagnostics,
    /// That of this measurement alone, or of all that were drawn together.
    pub posterior: Option<Arc<DrawnPosterior>>,
    /// The angles that were chosen last.
    pub plan: Option<PlannedAngles>,
    /// From the fit along the direction that the data determine least, and how far the sliders have come, 0 to 1.
    pub walk: Option<(Arc<WeakestWalk>, f64)>,
}

impl Results {
    const NONE: Self =
        Self { shown_fit: None, model_comparison: Vec::new(), diagnostics: Diagnostics::NONE, posterior: None, plan: None, walk: None };
}

/// The results by the number of the measurement; those of a closed one wait for undo.
#[derive(Default)]
pub(super) struct ResultsByMeasurement {
    all: BTreeMap<u64, Results>,
}

/// Those of a measurement about which nothing is known.
static NONE: Results = Results::NONE;

impl ResultsByMeasurement {
    pub fn of(&self, number: u64) -> &Results {
        self.all.get(&number).unwrap_or(&NONE)
    }

    pub fn of_mut(&mut self, number: u64) -> &mut Results {
        self.all.entry(number).or_insert(Results::NONE)
    }

    /// Those that show the fit of that id of the measurement of that number.
    pub fn showing(&mut self, id: usize, number: u64) -> impl Iterator<Item = &mut Results> {
        let is_it = move |fit: &Arc<FitEntry>| (fit.id, fit.number) == (id, number);
        self.all.values_mut().filter(move |results| results.shown_fit.as_ref().is_some_and(is_it))
    }

    /// Lets go of what is known about a measurement.
    pub fn forget(&mut self, number: u64) {
        self.all.remove(&number);
    }
}
