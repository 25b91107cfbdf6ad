//! How facets shadow and mask each other.

use crate::optics::Facet;
use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// The masking–shadowing factor G of the specular lobe.
///
/// Files of earlier releases say `true` for [`Masking::VGroove`] and `false` for [`Masking::None`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Masking {
    /// Every facet is seen: G = 1.
    None,
    /// V-grooves, Eq. (6): `G = min(1, 2 cos α cos θr / cos β, 2 cos α cos θi / cos β)`.
    VGroove,
}

impl Masking {
    /// `G/(cos θi cos θr)` in sr⁻¹, finite at grazing angles.
    ///
    /// Both factors depend on the directions alone, and a [`Facet`] holds them. A factor that depends on the slopes (Smith's, which
    /// takes σ and q) is a variant whose arm forms it here from the facet's angles and from these parameters, given as further
    /// arguments: [`Facet`] and prepared sets stay as they are. Its derivative by σ joins `∂ln P/∂σ` in the gradient, and the batch
    /// leaves its surfaces to the scalar form until kernels have it.
    #[must_use]
    pub fn over_cosines(self, facet: &Facet) -> f64 {
        match self {
            Self::None => facet.one_over_cosines,
            Self::VGroove => facet.g_over_cosines,
        }
    }
}

impl<'de> Deserialize<'de> for Masking {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Name;

        impl Visitor<'_> for Name {
            type Value = Masking;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("none or v-groove")
            }

            fn visit_bool<E: Error>(self, masks: bool) -> Result<Masking, E> {
                Ok(if masks { Masking::VGroove } else { Masking::None })
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Masking, E> {
                match name {
                    "none" => Ok(Masking::None),
                    "v-groove" => Ok(Masking::VGroove),
                    _ => Err(E::invalid_value(Unexpected::Str(name), &self)),
                }
            }
        }

        deserializer.deserialize_any(Name)
    }
}

#[cfg(test)]
mod tests {
    use super::Masking;

    #[test]
    fn files_hold_names_and_older_ones_flags() {
        for (masking, texts) in [(Masking::None, ["\"none\"", "false"]), (Masking::VGroove, ["\"v-groove\"", "true"])] {
            assert_eq!(serde_json::to_string(&masking).expect("a name"), texts[0]);
            for text in texts {
                assert_eq!(serde_json::from_str::<Masking>(text).expect("a masking"), masking, "{text}");
            }
        }
        let error = serde_json::from_str::<Masking>("\"smith\"").expect_err("no masking");
        assert!(error.to_string().contains("expected none or v-groove"), "{error}");
    }
}
