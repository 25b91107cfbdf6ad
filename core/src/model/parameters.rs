//! The parameters, declared once: sliders, file headers, options, bounds and help derive from here.

use crate::model::Domain;
use crate::optics::RefractiveIndex;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ops::{Index, IndexMut, RangeInclusive};

macro_rules! parameters {
    ($($variant:ident $field:ident {
        key: $key:literal, symbol: $symbol:literal, name: $name:literal, unit: $unit:literal,
        range: $low:literal..=$high:literal, domain: $domain:expr, default: $default:literal, logarithmic: $log:literal,
        help: $help:literal $(,)?
    })*) => {
        /// A parameter of the model; a file holds its key.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Parameter { $(#[doc = $help] $variant,)* }

        /// Values of the parameters.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        #[serde(default)]
        pub struct Parameters { $(#[doc = $help] pub $field: f64,)* }

        impl Default for Parameters {
            fn default() -> Self { Self { $($field: $default,)* } }
        }

        impl Parameter {
            /// How many there are.
            pub const COUNT: usize = Self::KEYS.len();

            /// All of them, in the order of files and tables.
            pub const ALL: [Self; Self::COUNT] = [$(Self::$variant,)*];

            const KEYS: &[&str] = &[$($key,)*];

            /// Name in files, options and JSON.
            #[must_use]
            pub fn key(self) -> &'static str { Self::KEYS[self as usize] }

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

            /// Values that it may have.
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

/// Of a slope or an angle: a mirror below, a surface without direction above.
const WIDTH: Domain = Domain::Between(1e-30, 1e30);
/// Of k_s, k_d and k_v.
const WEIGHT: Domain = Domain::ZeroOrBetween(1e-100, 1e100);
/// Of n and k.
const INDEX: Domain = Domain::Between(0.0, RefractiveIndex::LARGEST);

parameters! {
    N n {
        key: "n", symbol: "n", name: "refractive index", unit: "",
        range: 0.01..=10.0, domain: INDEX, default: 2.0, logarithmic: true,
        help: "Real part of the complex refractive index N = n + i k of the metal. With k it sets the Fresnel limit that DoLP cannot exceed.",
    }
    K k {
        key: "k", symbol: "k", name: "extinction coefficient", unit: "",
        range: 0.0..=20.0, domain: INDEX, default: 3.0, logarithmic: false,
        help: "Imaginary part of the complex refractive index N = n + i k. For a good metal it is larger than n, and at moderate angles DoLP knows little more than n/(n² + k²).",
    }
    Sigma sigma {
        key: "sigma", symbol: "σ", name: "surface slope", unit: "",
        range: 0.001..=3.0, domain: WIDTH, default: 0.3, logarithmic: true,
        help: "Scale of the facet slopes: larger is rougher and gives a wider specular lobe. For Gauss it is the rms slope along one direction; for Cauchy there is no rms slope if q ≤ 2. A slope, without unit; not a height in µm.",
    }
    Ks ks {
        key: "ks", symbol: "k_s", name: "specular coefficient", unit: "",
        range: 0.0..=10.0, domain: WEIGHT, default: 1.0, logarithmic: true,
        help: "Weight of the specular lobe, the only one that polarises. DoLP depends on k_d/k_s and k_v/k_s alone: fix k_s = 1 unless the BRDF is measured too.",
    }
    Kd kd {
        key: "kd", symbol: "k_d", name: "diffuse coefficient", unit: "",
        range: 0.0..=10.0, domain: WEIGHT, default: 0.1, logarithmic: true,
        help: "Weight of the Minnaert lobe, which depolarises.",
    }
    Kv kv {
        key: "kv", symbol: "k_v", name: "volume coefficient", unit: "",
        range: 0.0..=10.0, domain: WEIGHT, default: 0.1, logarithmic: true,
        help: "Weight of the volume lobe around the surface normal, which depolarises.",
    }
    Q q {
        key: "q", symbol: "q", name: "tail exponent", unit: "",
        range: 1.0001..=20.0, domain: Domain::Between(1.000_000_000_001, 1e12), default: 2.0, logarithmic: true,
        help: "Tail of the Cauchy slope distribution, which falls off as slope to the power −2q: smaller is a heavier tail. q = 2 is GGX.",
    }
    C c {
        key: "c", symbol: "c", name: "Minnaert exponent", unit: "",
        range: -1.0..=0.0, domain: Domain::Between(-1e3, 1e3), default: -0.5, logarithmic: false,
        help: "Exponent of (cos θi cos θr) in the Minnaert lobe. c = 0 is Lambert; towards −1 the lobe brightens at grazing angles.",
    }
    SigmaV sigma_v {
        key: "sigma_v", symbol: "σ_v", name: "volume width", unit: "rad",
        range: 0.01..=3.0, domain: WIDTH, default: 0.5, logarithmic: true,
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
        Self::KEYS.join(", ")
    }
}

impl Serialize for Parameter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}

impl<'de> Deserialize<'de> for Parameter {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        // Sessions of earlier releases hold the names of the variants.
        let by_variant = || Self::ALL.into_iter().find(|parameter| format!("{parameter:?}") == name);
        Self::from_key(&name).or_else(by_variant).ok_or_else(|| D::Error::unknown_variant(&name, Self::KEYS))
    }
}

impl Parameters {
    /// With weights too small for their domain set to 0, as [`Domain::flush_to_zero`] has it.
    #[must_use]
    pub fn flushed_to_zero(mut self) -> Self {
        for parameter in Parameter::ALL {
            self[parameter] = parameter.domain().flush_to_zero(self[parameter]);
        }
        self
    }

    /// As an array in the order of [`Parameter::ALL`].
    #[must_use]
    pub fn to_array(&self) -> [f64; Parameter::COUNT] {
        Parameter::ALL.map(|parameter| self[parameter])
    }
}

#[cfg(test)]
mod tests {
    use super::{Parameter, Parameters};

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
    fn files_hold_keys_and_older_ones_names_of_variants() {
        for parameter in Parameter::ALL {
            let text = serde_json::to_string(&parameter).expect("a text");
            assert_eq!(text, format!("{:?}", parameter.key()));
            for text in [text, format!("\"{parameter:?}\"")] {
                assert_eq!(serde_json::from_str::<Parameter>(&text).expect("a parameter"), parameter);
            }
        }
        let error = serde_json::from_str::<Parameter>("\"m\"").expect_err("no parameter");
        assert!(error.to_string().contains("unknown variant `m`, expected one of `n`, `k`"), "{error}");
    }
}
