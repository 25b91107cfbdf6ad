//! What follows from the parameters of a surface and is asked for more often than they are.

use crate::model::{Model, Parameter, ParameterSet, Parameters};
use crate::optics::SlopeDistribution;

/// A quantity that follows from the parameters of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DerivedQuantity {
    /// n/(n² + k²): what DoLP at moderate angles determines of a metal's index, also where it leaves n and k open.
    IndexRatio,
    /// The tilt in degrees at which the facet density P has fallen to half of P(0); 90 where it does not fall so far.
    LobeHalfWidth,
    /// The reflectance of a smooth surface at normal incidence, ((n − 1)² + k²)/((n + 1)² + k²).
    NormalReflectance,
}

/// Halvings of an interval of tilts: 90° over 2⁵⁰ is rounding.
const HALVINGS: usize = 50;
/// Steps in which the first place is looked for where P is half of P(0).
const STEPS: u32 = 90;

impl DerivedQuantity {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::IndexRatio, Self::LobeHalfWidth, Self::NormalReflectance];

    /// Name in files.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::IndexRatio => "index_ratio",
            Self::LobeHalfWidth => "lobe_half_width",
            Self::NormalReflectance => "normal_reflectance",
        }
    }

    /// What it is called beside a number.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::IndexRatio => "n/(n² + k²)",
            Self::LobeHalfWidth => "lobe half-width",
            Self::NormalReflectance => "R at normal incidence",
        }
    }

    /// Its unit behind a number; empty for a pure number.
    #[must_use]
    pub fn unit(self) -> &'static str {
        if self == Self::LobeHalfWidth { "°" } else { "" }
    }

    /// The parameters that it follows from, those that the model has.
    #[must_use]
    pub fn parameters(self, model: Model) -> ParameterSet {
        let of: ParameterSet = match self {
            Self::IndexRatio | Self::NormalReflectance => [Parameter::N, Parameter::K].into_iter().collect(),
            Self::LobeHalfWidth => [Parameter::Sigma, Parameter::Q].into_iter().collect(),
        };
        of.intersection(model.parameters())
    }

    /// Its value; NaN where there is no index.
    #[must_use]
    pub fn value(self, model: Model, parameters: &Parameters) -> f64 {
        let Parameters { n, k, sigma, q, .. } = *parameters;
        match self {
            Self::IndexRatio => n / (n * n + k * k),
            Self::LobeHalfWidth => half_width(model.distribution, sigma, q),
            Self::NormalReflectance => ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k),
        }
    }
}

fn half_width(distribution: SlopeDistribution, sigma: f64, q: f64) -> f64 {
    let half = 0.5 * distribution.facet_density(0.0, sigma, q);
    let is_below = |tilt: f64| {
        let tan = libm::tan(tilt.to_radians());
        distribution.facet_density(tan * tan, sigma, q) < half
    };
    // Steps are even in the tilt over the median tilt, then in degrees: narrow lobes end within the first.
    let narrow = libm::atan(distribution.median_slope(sigma, q)).to_degrees() / f64::from(STEPS);
    let wide = 90.0 / f64::from(STEPS);
    let tilts = (1..4 * STEPS).map(|i| f64::from(i) * narrow).take_while(|tilt| *tilt < 90.0);
    let rest = (1..STEPS).map(|i| f64::from(i) * wide).filter(|tilt| *tilt >= 4.0 * f64::from(STEPS) * narrow);
    let mut before = 0.0;
    for tilt in tilts.chain(rest) {
        if is_below(tilt) {
            let (mut low, mut high) = (before, tilt);
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(low, high);
                if is_below(middle) { high = middle } else { low = middle }
            }
            return high;
        }
        before = tilt;
    }
    90.0
}

#[cfg(test)]
mod tests {
    use super::DerivedQuantity;
    use crate::model::{Model, Parameter, Parameters};
    use crate::optics::{Degrees, Facet, Fresnel, Geometry, RefractiveIndex};

    #[test]
    fn the_reflectance_is_fresnels_at_normal_incidence() {
        let parameters = Parameters { n: 0.4, k: 2.95, ..Parameters::default() };
        let facet = Facet::new(Geometry::new(0.0, 0.0, 180.0).unwrap());
        let fresnel = Fresnel::new(RefractiveIndex::new(0.4, 2.95).unwrap(), &facet).mean();
        let found = DerivedQuantity::NormalReflectance.value(Model::CAUCHY, &parameters);
        assert!((found - fresnel).abs() < 1e-14, "{found} {fresnel}");
        assert!((DerivedQuantity::IndexRatio.value(Model::CAUCHY, &parameters) - 0.4 / (0.16 + 8.7025)).abs() < 1e-15);
    }

    #[test]
    fn at_the_half_width_the_density_is_half() {
        for model in [Model::GAUSS, Model::CAUCHY] {
            for sigma in [0.003, 0.05, 0.2, 0.4] {
                let parameters = Parameters { sigma, q: 2.2, ..Parameters::default() };
                let width = DerivedQuantity::LobeHalfWidth.value(model, &parameters);
                let (sin, cos) = Degrees(width).sin_cos();
                let ratio =
                    model.distribution.facet_density((sin / cos).powi(2), sigma, 2.2) / model.distribution.facet_density(0.0, sigma, 2.2);
                assert!((ratio - 0.5).abs() < 1e-9, "{model:?} {sigma}: {width}° {ratio}");
            }
        }
        // P of Cauchy goes as tan^(3 − 2q) α towards the horizon: with q below 1.5 it rises.
        let wide = Parameters { sigma: 3.0, q: 1.2, ..Parameters::default() };
        assert_eq!(DerivedQuantity::LobeHalfWidth.value(Model::CAUCHY, &wide), 90.0);
    }

    #[test]
    fn it_follows_from_what_the_model_has() {
        let of = |quantity: DerivedQuantity, model| quantity.parameters(model).iter().collect::<Vec<_>>();
        assert_eq!(of(DerivedQuantity::LobeHalfWidth, Model::GAUSS), [Parameter::Sigma]);
        assert_eq!(of(DerivedQuantity::IndexRatio, Model::CAUCHY), [Parameter::N, Parameter::K]);
    }
}
