//! The ladder of models of `compare`, on one measurement or on several together.

use crate::cli::interrupt;
use crate::cli::verdict::NOT_REACHED;
use crate::cli::watched::Watched;
use pbrdf::fit::{Observer, SpecialCases, fit_ladder};
use pbrdf::model::Preset;

/// A model with its problem and its fit, or why there is none.
pub type ModelResult<P> = (&'static Preset, Result<(P, <P as SpecialCases>::Fitted), String>);

/// The fit of each model by `fit`, in the order of the presets, or why there is none.
pub fn ladder_results<P: SpecialCases>(
    presets: &[&'static Preset],
    problems: Vec<Result<P, String>>,
    fit: impl Fn(&P, Observer<'_>) -> P::Fitted,
) -> Vec<ModelResult<P>> {
    let posed: Vec<Option<&P>> = problems.iter().map(|problem| problem.as_ref().ok()).collect();
    let fits = fit_ladder(&posed, |place, problem| {
        (!interrupt::asked()).then(|| {
            let watched = Watched::new(presets[place].key);
            let closures = watched.watch();
            fit(problem, closures.as_watch())
        })
    });
    let fitted = problems.into_iter().zip(fits).map(|(problem, fit)| problem.and_then(|problem| Ok((problem, fit.ok_or(NOT_REACHED)?))));
    presets.iter().copied().zip(fitted).collect()
}
