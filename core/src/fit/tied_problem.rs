//! A problem with tied parameters.

use crate::fit::objective::Problem;
use crate::fit::problem_error::ProblemError;
use crate::fit::ties::{Tie, TieError, apply_ties, resolve_ties};
use crate::model::ParameterSet;

impl Problem {
    /// The same problem with tied parameters. What is tied is not free; what it is tied to stays where both are within their bounds.
    ///
    /// # Errors
    ///
    /// [`ProblemError::Tie`] where ties are a circle, a factor is 0, or bounds leave no room.
    pub fn with_ties(&self, ties: &[Tie]) -> Result<Self, ProblemError> {
        let ties: Vec<Tie> = resolve_ties(ties)?.into_iter().filter(|tie| self.model().parameters().contains(tie.parameter)).collect();
        let mut free: ParameterSet = self.free().iter().copied().collect();
        ties.iter().for_each(|tie| free = free.without(tie.parameter));
        let (mut bounds, mut start) = (*self.bounds(), *self.start());
        for tie in &ties {
            if free.contains(tie.to) {
                let (low, high) = tie.narrowed(&bounds).ok_or(TieError::Outside(*tie))?;
                bounds.set(tie.to, low, high).map_err(|_| TieError::Outside(*tie))?;
                start[tie.to] = bounds.clamp(tie.to, start[tie.to]);
            } else if !tie.parameter.domain().contains(tie.factor * start[tie.to]) {
                return Err(TieError::Outside(*tie).into());
            }
        }
        Ok(self.with_free(free).with_bounds(bounds).with_start(apply_ties(&ties, start)).tied_by(ties))
    }
}
