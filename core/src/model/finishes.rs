//! Surface finishes: what polishing, grinding and blasting roughly do to the parameters that describe a surface.
//!
//! Illustrative, not measured: they show the sizes that go together, for a lesson or a first guess. Material (n, k) and the shape of
//! the depolarising lobes (c, σ_v) are not part of a finish.

use crate::model::Parameters;

/// A named set of σ, q, k_d and k_v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finish {
    /// Name in files.
    pub key: &'static str,
    /// Name for people; says that it is illustrative.
    pub name: &'static str,
    /// Surface slope σ.
    pub sigma: f64,
    /// Tail exponent q of the Cauchy distribution.
    pub q: f64,
    /// Diffuse coefficient k_d, with k_s = 1.
    pub kd: f64,
    /// Volume coefficient k_v, with k_s = 1.
    pub kv: f64,
}

/// From smooth to rough.
pub const FINISHES: [Finish; 3] = [
    Finish { key: "polished", name: "polished (illustrative)", sigma: 0.03, q: 2.0, kd: 0.002, kv: 0.002 },
    Finish { key: "ground", name: "ground (illustrative)", sigma: 0.2, q: 1.8, kd: 0.03, kv: 0.02 },
    Finish { key: "blasted", name: "blasted (illustrative)", sigma: 0.5, q: 2.5, kd: 0.12, kv: 0.1 },
];

impl Finish {
    /// Those parameters with this finish; the others stay, but for k_s = 1, to which k_d and k_v refer.
    #[must_use]
    pub fn on(&self, parameters: Parameters) -> Parameters {
        let Self { sigma, q, kd, kv, .. } = *self;
        Parameters { sigma, q, ks: 1.0, kd, kv, ..parameters }
    }
}

#[cfg(test)]
mod tests {
    use super::FINISHES;
    use crate::model::{Parameter, Parameters};

    #[test]
    fn finishes_lie_within_the_sliders_and_say_that_they_are_illustrative() {
        let before = Parameters { n: 0.4, k: 2.95, ks: 0.5, c: -0.3, sigma_v: 0.7, ..Parameters::default() };
        for finish in FINISHES {
            let after = finish.on(before);
            assert!(Parameter::ALL.into_iter().all(|parameter| parameter.range().contains(&after[parameter])), "{}", finish.key);
            assert_eq!((after.n, after.k, after.ks, after.c, after.sigma_v), (0.4, 2.95, 1.0, -0.3, 0.7));
            assert!(finish.name.contains("illustrative"));
        }
    }
}
