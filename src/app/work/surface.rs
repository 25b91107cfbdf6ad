//! A surface: a model with its nine values, and what a fit may do with them.

use crate::app::work::settings_error::SettingsError;
use pbrdf::fit::{Bounds, BoundsError, Tie, TieError, apply_ties, resolve_ties};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Model, Parameter, ParameterError, ParameterSet, Parameters};
use pbrdf::optics::SlopeDistribution;
use serde::{Deserialize, Serialize};

/// The surface of a measurement: what its sliders show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Surface {
    pub parameters: Parameters,
    pub model: Model,
    /// Parameters that a fit leaves alone.
    pub locked: ParameterSet,
    /// Bounds of fits where they are not the slider's range: parameter, lower, upper.
    pub bounds: Vec<(Parameter, f64, f64)>,
    /// Parameters that are another one times a factor.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ties: Vec<Tie>,
}

impl Default for Surface {
    fn default() -> Self {
        Self {
            parameters: Parameters::default(),
            model: Model::full(SlopeDistribution::Cauchy),
            locked: ParameterSet::EMPTY.with(Parameter::Ks),
            bounds: Vec::new(),
            ties: Vec::new(),
        }
    }
}

/// A snapshot of a surface, to be drawn beside others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PinnedSurface {
    pub name: String,
    /// Number of its colour among those of series.
    #[serde(default)]
    pub color: usize,
    pub model: Model,
    pub parameters: Parameters,
    /// Whether it is drawn.
    #[serde(default = "yes")]
    pub shown: bool,
}

fn yes() -> bool {
    true
}

/// Colours of pinned surfaces in the order in which they are pinned, by their numbers among those of
/// series: the few series of a measurement do not have them.
const PIN_COLORS: [usize; 8] = [5, 10, 8, 7, 9, 3, 11, 6];

impl PinnedSurface {
    /// A snapshot under that name, with a number where one of the others has it, in a colour that
    /// neither they nor measurements have, while there is one.
    pub fn new(name: &str, model: Model, parameters: Parameters, others: &[Self], of_measurements: &[usize]) -> Self {
        let is_free = |color: &&usize| others.iter().all(|other| other.color != **color);
        let is_unseen = |color: &&usize| is_free(color) && !of_measurements.contains(*color);
        let color = PIN_COLORS.iter().find(is_unseen).or_else(|| PIN_COLORS.iter().find(is_free));
        let color = color.copied().unwrap_or(PIN_COLORS[others.len() % PIN_COLORS.len()]);
        let is_taken = |name: &str| others.iter().any(|other| other.name == name);
        let mut names = [name.to_owned()].into_iter().chain((2..).map(|number| format!("{name} ({number})")));
        let name = names.find(|name| !is_taken(name)).unwrap_or_default();
        Self { name, color, model, parameters, shown: true }
    }
}

/// The distribution that a model does not have.
pub fn another(distribution: SlopeDistribution) -> SlopeDistribution {
    match distribution {
        SlopeDistribution::Gauss => SlopeDistribution::Cauchy,
        SlopeDistribution::Cauchy => SlopeDistribution::Gauss,
    }
}

/// σ of the other distribution with the same median slope.
pub fn sigma_of_equal_median(own: SlopeDistribution, sigma: f64, q: f64) -> f64 {
    match own {
        SlopeDistribution::Gauss => SlopeDistribution::cauchy_of_equal_median(sigma, q),
        SlopeDistribution::Cauchy => SlopeDistribution::gauss_of_equal_median(sigma, q),
    }
}

/// Whether sliders can hold these parameters. They can stand at n = k = 0, which is no surface:
/// then the window says so.
pub fn can_be_set(parameters: &Parameters, used: ParameterSet) -> Result<(), ParameterError> {
    match parameters.validate(used) {
        Err(ParameterError::NoIndex) => Ok(()),
        other => other,
    }
}

impl Surface {
    /// The same with the other distribution of slopes, so that half of the facets stay below the same
    /// slope; none without a specular lobe.
    pub fn of_equal_median(&self) -> Option<(Model, Parameters)> {
        let own = self.model.distribution;
        let sigma = sigma_of_equal_median(own, self.parameters.sigma, self.parameters.q);
        let model = Model { distribution: another(own), ..self.model };
        self.model.specular.then_some((model, Parameters { sigma, ..self.parameters }))
    }

    /// The defaults for data with or without a BRDF.
    pub fn for_measurement(measurement: &Measurement) -> Self {
        let mut surface = Self::default();
        surface.adapt_to(measurement);
        surface
    }

    /// With DoLP alone only ratios of the weights enter: k_s stays as it is. A BRDF lifts this.
    pub fn adapt_to(&mut self, measurement: &Measurement) {
        self.locked = if measurement.has_brdf() { self.locked.without(Parameter::Ks) } else { self.locked.with(Parameter::Ks) };
    }

    /// Checks that every value means something: a file can be well-formed and still hold nonsense.
    ///
    /// # Errors
    /// The first value that means nothing.
    pub fn validate(&self) -> Result<(), SettingsError> {
        can_be_set(&self.parameters, ParameterSet::ALL).map_err(SettingsError::Parameters)?;
        let set = |&(parameter, low, high): &(Parameter, f64, f64)| Bounds::default().set(parameter, low, high);
        self.bounds.iter().try_for_each(set).map_err(SettingsError::Bounds)?;
        resolve_ties(&self.ties).map(|_| ()).map_err(SettingsError::Ties)
    }

    /// What a parameter is tied to.
    pub fn tie_of(&self, parameter: Parameter) -> Option<Tie> {
        self.ties.iter().copied().find(|tie| tie.parameter == parameter)
    }

    /// The parameters that are tied to others.
    pub fn tied(&self) -> ParameterSet {
        self.ties.iter().map(|tie| tie.parameter).collect()
    }

    /// Ties a parameter, or unties it.
    ///
    /// # Errors
    /// The tie leads back to the parameter, or its factor is 0; those of before stay.
    pub fn set_tie(&mut self, parameter: Parameter, tie: Option<Tie>) -> Result<(), TieError> {
        let others = self.ties.iter().copied().filter(|tie| tie.parameter != parameter);
        let ties: Vec<Tie> = others.chain(tie).collect();
        resolve_ties(&ties)?;
        self.ties = ties;
        self.follow_ties();
        Ok(())
    }

    /// Moves tied parameters to where their ties have them.
    pub fn follow_ties(&mut self) {
        // Only sound ties are taken.
        self.parameters = apply_ties(&resolve_ties(&self.ties).unwrap_or_default(), self.parameters);
    }

    /// Lower and upper bound of a parameter in fits.
    pub fn bounds_of(&self, parameter: Parameter) -> (f64, f64) {
        let own = self.bounds.iter().find(|(other, ..)| *other == parameter);
        own.map_or_else(|| Bounds::default().of(parameter), |&(_, low, high)| (low, high))
    }

    /// Whether a parameter's bounds are other ones than its slider's range.
    pub fn has_own_bounds(&self, parameter: Parameter) -> bool {
        self.bounds.iter().any(|(other, ..)| *other == parameter)
    }

    /// Sets the bounds of a parameter.
    ///
    /// # Errors
    /// They are no bounds, as [`Bounds::set`] has it; those of before stay.
    pub fn set_bounds(&mut self, parameter: Parameter, low: f64, high: f64) -> Result<(), BoundsError> {
        let default = Bounds::default().of(parameter);
        Bounds::default().set(parameter, low, high)?;
        self.reset_bounds(parameter);
        if (low, high) != default {
            self.bounds.push((parameter, low, high));
        }
        Ok(())
    }

    /// Takes a parameter over from another surface: its value, and what a fit may do with it.
    pub fn take(&mut self, parameter: Parameter, other: &Self) {
        self.parameters[parameter] = other.parameters[parameter];
        self.locked = if other.locked.contains(parameter) { self.locked.with(parameter) } else { self.locked.without(parameter) };
        if self.bounds_of(parameter) != other.bounds_of(parameter) {
            self.reset_bounds(parameter);
            self.bounds.extend(other.bounds.iter().filter(|(of, ..)| *of == parameter));
        }
    }

    /// Back to the slider's range.
    pub fn reset_bounds(&mut self, parameter: Parameter) {
        self.bounds.retain(|(other, ..)| *other != parameter);
    }
}

#[cfg(test)]
mod tests {
    use super::Surface;
    use pbrdf::model::Parameter;

    #[test]
    fn bounds_that_mean_nothing_change_nothing() {
        let mut surface = Surface::default();
        assert!(surface.set_bounds(Parameter::N, 3.0, 1.0).is_err());
        assert!(!surface.has_own_bounds(Parameter::N));
    }
}
