//! The nine parameters, declared once: sliders, file headers, options, bounds and help derive from here.

use crate::optics::{RefractiveIndex, RefractiveIndexError};
use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut, RangeInclusive};

macro_rules! parameters {
    ($($variant:ident $field:ident {
        key: $key:literal, symbol: $symbol:literal, name: $name:literal, unit: $unit:literal,
        range: $low:literal..=$high:literal, domain: $domain:expr, default: $default:literal, logarithmic: $log:literal,
        help: $help:literal $(,)?
    })*) => {
        /// Which of the nine parameters.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Parameter { $(#[doc = $help] $variant,)* }

        /// Values of the nine parameters.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        #[serde(default)]
        pub struct Parameters { $(#[doc = $help] pub $field: f64,)* }

        impl Default for Parameters {
            fn default() -> Self { Self { $($field: $default,)* } }
        }

        impl Parameter {
            /// All nine, in the order of files and tables.
            pub const ALL: [Self; 9] = [$(Self::$variant,)*];

            /// Name in files, options and JSON.
            #[must_use]
            pub fn key(self) -> &'static str { match self { $(Self::$variant => $key,)* } }

            /// Symbol in the literature.
            #[must_use]
            pub fn symbol(self) -> &'static str { match self { $(Self::$variant => $symbol,)* } }

            /// What it is called in words.
            #[must_use]
            pub fn name(self) -> &'static str { match self { $(Self::$variant => $name,)* } }

            /// Unit; empty for a pure number.
            #[must_use]
            pub fn unit(self) -> &'static str { match self { $(Self::$variant => $unit,)* } }

            /// Range of sliders and, unless told otherwise, of fits.
            #[must_use]
            pub fn range(self) -> RangeInclusive<f64> { match self { $(Self::$variant => $low..=$high,)* } }

            /// Values that the formulas allow; finite ones only.
            #[must_use]
            pub fn domain(self) -> Domain { match self { $(Self::$variant => $domain,)* } }

            /// Value to begin with.
            #[must_use]
            pub fn default_value(self) -> f64 { match self { $(Self::$variant => $default,)* } }

            /// Whether its range is best walked by factors rather than by steps.
            #[must_use]
            pub fn is_logarithmic(self) -> bool { match self { $(Self::$variant => $log,)* } }

            /// What it means and does, in a sentence or two.
            #[must_use]
            pub fn help(self) -> &'static str { match self { $(Self::$variant => $help,)* } }
        }

        impl Index<Parameter> for Parameters {
            type Output = f64;
            fn index(&self, parameter: Parameter) -> &f64 { match parameter { $(Parameter::$variant => &self.$field,)* } }
        }

        impl IndexMut<Parameter> for Parameters {
            fn index_mut(&mut self, parameter: Parameter) -> &mut f64 {
                match parameter { $(Parameter::$variant => &mut self.$field,)* }
            }
        }
    };
}

/// Values that the formulas allow for a parameter; always finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Domain {
    /// From this value on.
    From(f64),
    /// Above this value.
    Above(f64),
    /// Any finite number.
    Finite,
}

impl Domain {
    /// Whether a value lies in it.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::From(low) => value >= low,
                Self::Above(low) => value > low,
                Self::Finite => true,
            }
    }
}

impl std::fmt::Display for Domain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::From(low) => write!(f, "a finite number ≥ {low}"),
            Self::Above(low) => write!(f, "a finite number > {low}"),
            Self::Finite => write!(f, "a finite number"),
        }
    }
}

parameters! {
    N n {
        key: "n", symbol: "n", name: "refractive index", unit: "",
        range: 0.01..=10.0, domain: Domain::From(0.0), default: 2.0, logarithmic: true,
        help: "Real part of the complex refractive index N = n + i k of the metal. With k it sets the Fresnel limit that DoLP cannot exceed.",
    }
    K k {
        key: "k", symbol: "k", name: "extinction coefficient", unit: "",
        range: 0.0..=20.0, domain: Domain::From(0.0), default: 3.0, logarithmic: false,
        help: "Imaginary part of the complex refractive index N = n + i k. For a good metal it is larger than n, and DoLP knows little more than n/(n² + k²).",
    }
    Sigma sigma {
        key: "sigma", symbol: "σ", name: "surface slope", unit: "",
        range: 0.001..=3.0, domain: Domain::Above(0.0), default: 0.3, logarithmic: true,
        help: "Scale of the facet slopes: larger is rougher and gives a wider specular lobe. A slope, without unit; not a height in µm.",
    }
    Ks ks {
        key: "ks", symbol: "k_s", name: "specular coefficient", unit: "",
        range: 0.0..=10.0, domain: Domain::From(0.0), default: 1.0, logarithmic: true,
        help: "Weight of the specular lobe, the only one that polarises. DoLP depends on k_d/k_s and k_v/k_s alone: fix k_s = 1 unless the BRDF is measured too.",
    }
    Kd kd {
        key: "kd", symbol: "k_d", name: "diffuse coefficient", unit: "",
        range: 0.0..=10.0, domain: Domain::From(0.0), default: 0.1, logarithmic: true,
        help: "Weight of the Minnaert lobe, which depolarises.",
    }
    Kv kv {
        key: "kv", symbol: "k_v", name: "volume coefficient", unit: "",
        range: 0.0..=10.0, domain: Domain::From(0.0), default: 0.1, logarithmic: true,
        help: "Weight of the volume lobe around the surface normal, which depolarises.",
    }
    Q q {
        key: "q", symbol: "q", name: "tail exponent", unit: "",
        range: 1.0001..=20.0, domain: Domain::Above(1.0), default: 2.0, logarithmic: true,
        help: "Tail of the Cauchy slope distribution, which falls off as slope to the power −2q: smaller is a heavier tail. q = 2 is GGX.",
    }
    C c {
        key: "c", symbol: "c", name: "Minnaert exponent", unit: "",
        range: -1.0..=0.0, domain: Domain::Finite, default: -0.5, logarithmic: false,
        help: "Exponent of (cos θi cos θr) in the Minnaert lobe. c = 0 is Lambert; towards −1 the lobe brightens at grazing angles.",
    }
    SigmaV sigma_v {
        key: "sigma_v", symbol: "σ_v", name: "volume width", unit: "rad",
        range: 0.01..=3.0, domain: Domain::Above(0.0), default: 0.5, logarithmic: true,
        help: "Standard deviation of the volume lobe in the angle of view θr.",
    }
}

impl Parameter {
    /// The parameter of that name in files and options.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|parameter| parameter.key() == key)
    }

    /// All names in files and options, for messages.
    #[must_use]
    pub fn keys() -> String {
        Self::ALL.map(Self::key).join(", ")
    }
}

/// A value that the formulas do not allow.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// One parameter outside its mathematical domain.
    #[error("{} = {value} is not allowed: expected {}", .parameter.key(), .parameter.domain())]
    Outside {
        /// Which.
        parameter: Parameter,
        /// Its value.
        value: f64,
    },
    /// n and k are both 0.
    #[error("n and k are both 0: a medium needs at least one of them above 0")]
    NoIndex,
}

impl ParameterError {
    /// The parameter to look at.
    #[must_use]
    pub fn parameter(self) -> Parameter {
        match self {
            Self::Outside { parameter, .. } => parameter,
            Self::NoIndex => Parameter::N,
        }
    }
}

impl Parameters {
    /// Checks those parameters against the mathematical domain (not the ranges of the sliders).
    pub fn validate(&self, used: ParameterSet) -> Result<(), ParameterError> {
        for parameter in used {
            let value = self[parameter];
            if !parameter.domain().contains(value) {
                return Err(ParameterError::Outside { parameter, value });
            }
        }
        match RefractiveIndex::new(self.n, self.k) {
            Err(RefractiveIndexError::Zero) if used.contains(Parameter::N) => Err(ParameterError::NoIndex),
            _ => Ok(()),
        }
    }

    /// As an array in the order of [`Parameter::ALL`].
    #[must_use]
    pub fn to_array(&self) -> [f64; 9] {
        Parameter::ALL.map(|parameter| self[parameter])
    }
}

/// A set of parameters: those a model uses, or those a fit may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ParameterSet(u16);

impl ParameterSet {
    /// No parameter.
    pub const EMPTY: Self = Self(0);
    /// All nine.
    pub const ALL: Self = Self(0x1ff);

    /// Whether a parameter is in it.
    #[must_use]
    pub fn contains(self, parameter: Parameter) -> bool {
        self.0 & (1 << parameter as u16) != 0
    }

    /// With one parameter more.
    #[must_use]
    pub fn with(self, parameter: Parameter) -> Self {
        Self(self.0 | 1 << parameter as u16)
    }

    /// With one parameter less.
    #[must_use]
    pub fn without(self, parameter: Parameter) -> Self {
        Self(self.0 & !(1 << parameter as u16))
    }

    /// The parameters in both.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The parameters in either.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Without those of another set.
    #[must_use]
    pub fn without_all(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// How many.
    #[must_use]
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Each in the order of [`Parameter::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Parameter> {
        Parameter::ALL.into_iter().filter(move |&parameter| self.contains(parameter))
    }
}

impl FromIterator<Parameter> for ParameterSet {
    fn from_iter<I: IntoIterator<Item = Parameter>>(parameters: I) -> Self {
        parameters.into_iter().fold(Self::EMPTY, Self::with)
    }
}

impl IntoIterator for ParameterSet {
    type Item = Parameter;
    type IntoIter = std::vec::IntoIter<Parameter>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter().collect::<Vec<_>>().into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::{Parameter, ParameterSet, Parameters};

    #[test]
    fn defaults_lie_in_the_ranges_and_the_ranges_in_the_domains() {
        for parameter in Parameter::ALL {
            let range = parameter.range();
            assert!(range.contains(&Parameters::default()[parameter]), "{parameter:?}");
            assert!(parameter.domain().contains(*range.start()) && parameter.domain().contains(*range.end()), "{parameter:?}");
        }
    }

    #[test]
    fn keys_find_their_parameters() {
        for parameter in Parameter::ALL {
            assert_eq!(Parameter::from_key(parameter.key()), Some(parameter));
        }
        assert_eq!(Parameter::from_key("m"), None);
    }

    #[test]
    fn sets_keep_what_was_put_in() {
        let set = ParameterSet::ALL.without(Parameter::Ks);
        assert_eq!(set.len(), 8);
        assert!(!set.contains(Parameter::Ks) && set.contains(Parameter::SigmaV));
        assert_eq!(set.with(Parameter::Ks), ParameterSet::ALL);
    }
}
