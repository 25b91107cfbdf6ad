//! Which terms a model has, and how its DoLP is formed.

use crate::model::{Parameter, ParameterSet};
use crate::optics::{Masking, SlopeDistribution};
use serde::{Deserialize, Serialize};

/// The diffuse term of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Diffuse {
    /// Not there.
    Absent,
    /// The same in all directions: Minnaert's c is 0.
    Lambert,
    /// Eq. (12) with the exponent c.
    Minnaert,
    /// Lambertian, and as strong as the light that single reflection loses: `k_s (1 − ρ(θi))/π`, ρ the directional-hemispherical
    /// reflectance of the specular lobe of a perfect reflector in V-grooves (Hyde, Schmidt, Havrilla, Opt. Express 17, 22138 (2009)). That k_s scales it
    /// as it scales the specular lobe is a choice of this project's. Without a specular lobe there is none of it.
    Hyde,
}

/// What Eq. (17) divides by F00 to give DoLP.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DolpFormula {
    /// The polarised radiance with k_s inside, as Eqs. (14, 15) have it: DoLP is 0 to 1.
    #[default]
    Consistent,
    /// The polarised radiance without k_s, as Eq. (17) is printed: the consistent value divided by k_s, which may exceed 1.
    #[serde(alias = "printed")]
    AsPrinted,
}

/// Which distribution and which terms there are. A term that is absent is not evaluated and has no parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Model {
    /// How the slopes of the facets are distributed.
    pub distribution: SlopeDistribution,
    /// How facets shadow and mask each other.
    pub masking: Masking,
    /// Whether there is a specular lobe.
    pub specular: bool,
    /// The diffuse lobe.
    pub diffuse: Diffuse,
    /// Whether there is a volume lobe.
    pub volume: bool,
    /// How DoLP is formed, Eq. (17).
    #[serde(default)]
    pub dolp_formula: DolpFormula,
}

impl Model {
    /// All terms with Cauchy facets: the nine-parameter model of Wang et al.
    pub const CAUCHY: Self = Self::full(SlopeDistribution::Cauchy);
    /// All terms with Gauss facets.
    pub const GAUSS: Self = Self::full(SlopeDistribution::Gauss);
    /// The specular lobe of Cauchy facets alone: its DoLP is that of Fresnel reflection.
    pub const SPECULAR: Self = Self { diffuse: Diffuse::Absent, volume: false, ..Self::CAUCHY };

    /// All terms, with that distribution.
    #[must_use]
    pub const fn full(distribution: SlopeDistribution) -> Self {
        Self {
            distribution,
            masking: Masking::VGroove,
            specular: true,
            diffuse: Diffuse::Minnaert,
            volume: true,
            dolp_formula: DolpFormula::Consistent,
        }
    }

    /// The same terms with DoLP by that formula.
    #[must_use]
    pub const fn with_dolp_formula(self, dolp_formula: DolpFormula) -> Self {
        Self { dolp_formula, ..self }
    }

    /// The parameters that play a part in it.
    #[must_use]
    pub fn parameters(&self) -> ParameterSet {
        let mut set = ParameterSet::EMPTY;
        if self.specular {
            set = [Parameter::N, Parameter::K, Parameter::Sigma, Parameter::Ks].into_iter().collect();
            if self.distribution == SlopeDistribution::Cauchy {
                set = set.with(Parameter::Q);
            }
        }
        match self.diffuse {
            Diffuse::Absent | Diffuse::Hyde => {}
            Diffuse::Lambert => set = set.with(Parameter::Kd),
            Diffuse::Minnaert => set = set.with(Parameter::Kd).with(Parameter::C),
        }
        if self.volume {
            set = set.with(Parameter::Kv).with(Parameter::SigmaV);
        }
        set
    }

    /// The parameters that its DoLP depends on.
    ///
    /// A lone specular lobe has the DoLP of its facets, whatever their distribution: σ and q show in the BRDF only. In the
    /// consistent formula k_s cancels there and beside Hyde's term alone; as printed, DoLP is inversely proportional to k_s.
    #[must_use]
    pub fn dolp_parameters(&self) -> ParameterSet {
        if !self.specular {
            return ParameterSet::EMPTY;
        }
        let is_alone = self.diffuse == Diffuse::Absent && !self.volume;
        let set = if is_alone { [Parameter::N, Parameter::K].into_iter().collect() } else { self.parameters() };
        let ks_cancels = is_alone || (self.diffuse == Diffuse::Hyde && !self.volume);
        match self.dolp_formula {
            DolpFormula::Consistent if ks_cancels => set.without(Parameter::Ks),
            DolpFormula::Consistent => set,
            DolpFormula::AsPrinted => set.with(Parameter::Ks),
        }
    }
}
