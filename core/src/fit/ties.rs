//! Ties: a parameter that is another one times a factor.

use crate::fit::bounds::Bounds;
use crate::model::{Parameter, Parameters, PerParameter};
use serde::{Deserialize, Serialize};

/// A parameter that is another one times a factor; it is no unknown of the fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tie {
    /// What is tied.
    pub parameter: Parameter,
    /// What the other one is multiplied by.
    pub factor: f64,
    /// The other one.
    pub to: Parameter,
}

/// Why parameters cannot be tied.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TieError {
    /// Ties that lead back to where they began: the parameters in their order, the first one at the end again.
    #[error("{} is a circle", arrows(.0))]
    Circle(Vec<Parameter>),
    /// A factor that is 0 or no number.
    #[error("{} = {} × {}: expected a factor other than 0", .0.parameter.key(), .0.factor, .0.to.key())]
    Factor(Tie),
    /// No value of the other one puts the parameter inside its bounds.
    #[error("{} = {} × {} lies outside its bounds whatever {} is within its own", .0.parameter.key(), .0.factor, .0.to.key(), .0.to.key())]
    Outside(Tie),
}

/// The keys of parameters with arrows between them.
fn arrows(parameters: &[Parameter]) -> String {
    parameters.iter().map(|parameter| parameter.key()).collect::<Vec<_>>().join(" → ")
}

/// The ties, each to a parameter that is tied to none; of two ties of one parameter the later counts, and a tie to what the model does not
/// have holds the parameter.
///
/// # Errors
///
/// [`TieError::Circle`], and [`TieError::Factor`] where a factor is 0 or not finite.
pub fn resolve_ties(ties: &[Tie]) -> Result<Vec<Tie>, TieError> {
    let mut by_parameter: PerParameter<Option<Tie>> = PerParameter::default();
    for tie in ties {
        if tie.factor == 0.0 || !tie.factor.is_finite() {
            return Err(TieError::Factor(*tie));
        }
        by_parameter[tie.parameter] = Some(*tie);
    }
    let to_root = |tie: Tie| {
        let (mut whole, mut path) = (tie, vec![tie.parameter]);
        loop {
            let seen = path.iter().position(|&parameter| parameter == whole.to);
            path.push(whole.to);
            if let Some(first) = seen {
                return Err(TieError::Circle(path.split_off(first)));
            }
            let Some(next) = by_parameter[whole.to] else { return Ok(whole) };
            whole = Tie { factor: whole.factor * next.factor, to: next.to, ..whole };
        }
    };
    Parameter::ALL.into_iter().filter_map(|parameter| by_parameter[parameter]).map(to_root).collect()
}

/// The parameters as resolved ties have them.
#[must_use]
pub fn apply_ties(ties: &[Tie], mut parameters: Parameters) -> Parameters {
    for tie in ties {
        parameters[tie.parameter] = tie.parameter.domain().flush_to_zero(tie.factor * parameters[tie.to]);
    }
    parameters
}

impl Tie {
    /// The box of the other one with room for this one; none if there is no room.
    pub(crate) fn narrowed(&self, bounds: &Bounds) -> Option<(f64, f64)> {
        let [low, high] = [bounds.of(self.parameter).0, bounds.of(self.parameter).1].map(|bound| bound / self.factor);
        let (low, high) = (low.min(high), low.max(high));
        let (own_low, own_high) = bounds.of(self.to);
        let (low, high) = (low.max(own_low), high.min(own_high));
        (low < high).then_some((low, high))
    }
}

#[cfg(test)]
mod tests {
    use super::{Tie, TieError, resolve_ties};
    use crate::model::Parameter::{K, Kd, Kv, N};

    const fn tie(parameter: crate::model::Parameter, factor: f64, to: crate::model::Parameter) -> Tie {
        Tie { parameter, factor, to }
    }

    #[test]
    fn chains_of_ties_lead_to_one_parameter() {
        let ties = resolve_ties(&[tie(Kv, 2.0, Kd), tie(Kd, 0.5, K), tie(Kv, 4.0, Kd)]).unwrap();
        assert_eq!(ties, [tie(Kd, 0.5, K), tie(Kv, 2.0, K)], "the later tie of k_v counts");
    }

    #[test]
    fn circles_and_factors_that_mean_nothing_are_refused() {
        for (ties, text) in [
            (vec![tie(N, 2.0, N)], "n → n is a circle"),
            (vec![tie(N, 2.0, K), tie(K, 0.5, N)], "n → k → n is a circle"),
            (vec![tie(Kv, 1.0, N), tie(N, 2.0, K), tie(K, 0.5, N)], "n → k → n is a circle"),
        ] {
            assert_eq!(resolve_ties(&ties).unwrap_err().to_string(), text);
        }
        assert_eq!(resolve_ties(&[tie(N, 0.0, K)]), Err(TieError::Factor(tie(N, 0.0, K))));
        assert_eq!(resolve_ties(&[tie(N, f64::INFINITY, K)]).unwrap_err().to_string(), "n = inf × k: expected a factor other than 0");
    }
}
