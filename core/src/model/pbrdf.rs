//! The polarimetric BRDF: which terms are there, and what they add up to.
//!
//! `F = k_s F^s + k_d F^d + k_v F^v` (3, 14). For unpolarised light in, BRDF = F00 and, (17) with k_s where
//! (14) has it, `DoLP = √(F10² + F20²)/F00 = DoLP_s / (1 + (k_d F^d + k_v F^v)/(k_s F^s00))`: no rotation, no difference,
//! and right even where the specular term underflows. [`DolpFormula`] chooses between that and (17) as printed.

use crate::model::far_tail::Logarithms;
use crate::model::hyde_diffuse::SingleScatteringLoss;
use crate::model::lobes;
use crate::model::lobes::Lobe;
use crate::model::prepared::PreparedGeometry;
use crate::model::{Parameter, ParameterError, ParameterSet, Parameters};
use crate::optics::{Facet, Fresnel, Geometry, Mueller, RefractiveIndex, SlopeDistribution};
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
    /// Whether facets shadow and mask each other, Eq. (6); without, G = 1.
    pub masking: bool,
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
            masking: true,
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

/// A reflection under one geometry, for unpolarised light in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reflection {
    /// BRDF, F00, in sr⁻¹.
    pub brdf: f64,
    /// Degree of linear polarisation, 0 to 1; as printed it may exceed 1 ([`DolpFormula`]).
    pub dolp: f64,
    /// Specular part of the BRDF, k_s F^s, in sr⁻¹.
    pub specular: f64,
    /// Diffuse part of the BRDF, k_d F^d, in sr⁻¹.
    pub diffuse: f64,
    /// Volume part of the BRDF, k_v F^v, in sr⁻¹.
    pub volume: f64,
}

/// A model with values: a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pbrdf {
    model: Model,
    parameters: Parameters,
    index: RefractiveIndex,
    weight_scale: f64,
    logarithms: Option<Logarithms>,
}

/// Weights below this lose digits when they are multiplied, and above [`GLARING`] the products overflow: DoLP, a ratio, is then
/// formed with all three weights moved by one power of two.
const FAINT: f64 = 1e-250;
const GLARING: f64 = 1e150;
/// 2^300 and 2^−500.
const RAISED: f64 = 2.037_035_976_334_486e90;
const LOWERED: f64 = 3.054_936_363_499_605e-151;

/// By what the weights are multiplied before DoLP is formed.
fn weight_scale(weights: [f64; 3]) -> f64 {
    let largest = weights.into_iter().fold(0.0, f64::max);
    let smallest = weights.into_iter().filter(|&weight| weight > 0.0).fold(f64::INFINITY, f64::min);
    if largest > GLARING {
        LOWERED
    } else if smallest < FAINT {
        RAISED
    } else {
        1.0
    }
}

/// The lobes of unit weight under one geometry.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lobes {
    /// tan²α/2σ², at most the largest f64.
    pub w: f64,
    /// tan²α.
    pub tan_alpha_sq: f64,
    pub specular: Lobe,
    pub diffuse: Lobe,
    pub volume: Lobe,
}

impl Lobes {
    /// ln(1 + w), also where a σ below 1e-154 makes w overflow.
    pub(crate) fn ln_1p_w(&self, sigma: f64) -> f64 {
        if self.w < f64::MAX { libm::log1p(self.w) } else { libm::log(self.tan_alpha_sq) - 2.0 * libm::log(sigma) - std::f64::consts::LN_2 }
    }
}

impl Pbrdf {
    /// A model with values; only the parameters that play a part are looked at.
    pub fn new(model: Model, parameters: Parameters) -> Result<Self, ParameterError> {
        parameters.validate(model.parameters())?;
        let index = RefractiveIndex::new(parameters.n, parameters.k);
        // A model without a specular lobe has no index: any serves.
        let vacuum = RefractiveIndex::new(1.0, 0.0);
        let index = index.or(vacuum).map_err(|_| ParameterError::NoIndex)?;
        let used = |parameter| if model.parameters().contains(parameter) { parameters[parameter] } else { 0.0 };
        let weight_scale = weight_scale([Parameter::Ks, Parameter::Kd, Parameter::Kv].map(used));
        let logarithms = Logarithms::where_needed(model, &parameters);
        Ok(Self { model, parameters, index, weight_scale, logarithms })
    }

    /// The same surface with DoLP by that formula.
    #[must_use]
    pub fn with_dolp_formula(self, dolp_formula: DolpFormula) -> Self {
        Self { model: self.model.with_dolp_formula(dolp_formula), ..self }
    }

    /// Which terms there are.
    #[must_use]
    pub fn model(&self) -> Model {
        self.model
    }

    /// The values.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// BRDF, DoLP and the terms at a prepared geometry.
    #[must_use]
    pub fn reflection(&self, facet: &Facet) -> Reflection {
        self.reflection_with(facet)
    }

    /// The same of a geometry of which more may be at hand.
    pub(crate) fn reflection_with(&self, at: &impl PreparedGeometry) -> Reflection {
        let p = &self.parameters;
        let lobes = self.lobes(at);
        let mut reflection = Reflection {
            diffuse: lobes.diffuse.weighted(self.diffuse_weight()),
            volume: lobes.volume.weighted(p.kv),
            ..Reflection::default()
        };
        if self.model.specular {
            let fresnel = at.fresnel(self.index);
            let mean = fresnel.mean();
            reflection.specular = lobes.specular.scaled(mean).weighted(p.ks);
            reflection.dolp = fresnel.dolp() * self.polarised_share(mean, self.depolarised_over_specular(&lobes));
        }
        reflection.brdf = reflection.specular + reflection.diffuse + reflection.volume;
        reflection
    }

    /// DoLP at a prepared geometry, and nothing else.
    #[must_use]
    pub fn dolp(&self, facet: &Facet) -> f64 {
        self.dolp_with(facet)
    }

    /// The same of a geometry of which more may be at hand.
    pub(crate) fn dolp_with(&self, at: &impl PreparedGeometry) -> f64 {
        if !self.model.specular {
            return 0.0;
        }
        let fresnel = at.fresnel(self.index);
        if self.model.diffuse == Diffuse::Absent && !self.model.volume {
            return fresnel.dolp() * self.polarised_share(fresnel.mean(), 0.0);
        }
        let lobes = self.lobes(at);
        fresnel.dolp() * self.polarised_share(fresnel.mean(), self.depolarised_over_specular(&lobes))
    }

    /// The whole Mueller matrix between the meridian bases of the incident and the reflected ray.
    #[must_use]
    pub fn mueller(&self, geometry: Geometry) -> Mueller {
        let (specular, depolarised) = self.mueller_parts(&Facet::new(geometry));
        if !self.model.specular {
            return depolarised;
        }
        let meridian_from_incidence = Mueller::rotator(geometry.rotation_out().inverse());
        let incidence_from_meridian = Mueller::rotator(geometry.rotation_in());
        meridian_from_incidence * specular * incidence_from_meridian + depolarised
    }

    /// The whole Mueller matrix with both rays in the facet's plane of incidence, which holds both: no rotation.
    #[must_use]
    pub fn mueller_in_facet_plane(&self, facet: &Facet) -> Mueller {
        let (specular, depolarised) = self.mueller_parts(facet);
        specular + depolarised
    }

    /// The specular lobe in the facet's plane of incidence, and what depolarises.
    fn mueller_parts(&self, facet: &Facet) -> (Mueller, Mueller) {
        let reflection = self.reflection(facet);
        let depolarised = Mueller::depolarizer(reflection.diffuse + reflection.volume);
        if !self.model.specular {
            return (Mueller::depolarizer(0.0), depolarised);
        }
        let fresnel = Mueller::fresnel(&Fresnel::new(self.index, facet));
        let d_g = self.lobes(facet).specular.weighted(self.parameters.ks);
        (fresnel * d_g, depolarised)
    }

    /// The Fresnel limit DoLP_s at a prepared geometry: what DoLP would be without any depolarising term.
    #[must_use]
    pub fn fresnel_limit(&self, facet: &Facet) -> f64 {
        Fresnel::new(self.index, facet).dolp()
    }

    /// The lobes of unit weight; those of absent terms are dark.
    pub(crate) fn lobes(&self, at: &impl PreparedGeometry) -> Lobes {
        let Self { model, parameters: p, .. } = self;
        let facet = at.facet();
        let g_over_cosines = if model.masking { facet.g_over_cosines } else { facet.one_over_cosines };
        let w = if model.specular { crate::optics::reduced_slope_sq(facet.tan_alpha_sq, p.sigma) } else { 0.0 };
        let mut lobes = Lobes {
            w,
            tan_alpha_sq: facet.tan_alpha_sq,
            specular: if model.specular { lobes::specular(model.distribution, w, facet, g_over_cosines, p.sigma, p.q) } else { Lobe::DARK },
            diffuse: match model.diffuse {
                Diffuse::Absent => Lobe::DARK,
                Diffuse::Lambert => lobes::diffuse(facet, 0.0),
                Diffuse::Minnaert => lobes::diffuse(facet, p.c),
                Diffuse::Hyde if model.specular => SingleScatteringLoss::at(model.distribution, facet.theta_i, p.sigma, p.q).lobe,
                Diffuse::Hyde => Lobe::DARK,
            },
            volume: if model.volume { lobes::volume(facet, p.sigma_v) } else { Lobe::DARK },
        };
        if lobes.are_far(p) {
            self.sharpen(|| at.sharp(), &mut lobes);
        }
        lobes
    }

    /// What the diffuse lobe is multiplied by: k_d, or k_s in Hyde's balance.
    pub(crate) fn diffuse_weight(&self) -> f64 {
        if self.model.diffuse == Diffuse::Hyde { self.parameters.ks } else { self.parameters.kd }
    }

    /// A weight as DoLP takes it: the same, unless k_s is so faint that all three are raised.
    pub(crate) fn raised(&self, weight: f64) -> f64 {
        weight * self.weight_scale
    }

    /// b: the (raised) depolarised terms over the specular lobe of unit weight and reflectance.
    pub(crate) fn depolarised_over_specular(&self, lobes: &Lobes) -> f64 {
        let diffuse = lobes.diffuse.scaled(self.raised(self.diffuse_weight()));
        let volume = lobes.volume.scaled(self.raised(self.parameters.kv));
        diffuse.over(lobes.specular) + volume.over(lobes.specular)
    }

    /// The (raised) weight of the polarised radiance in the numerator of Eq. (17): k_s, or 1 as printed.
    pub(crate) fn polarised_weight(&self) -> f64 {
        self.raised(match self.model.dolp_formula {
            DolpFormula::Consistent => self.parameters.ks,
            DolpFormula::AsPrinted => 1.0,
        })
    }

    /// DoLP over the Fresnel limit, `κ R/(k_s R + b)`, for the mean reflectance R and b; κ is [`Self::polarised_weight`].
    /// Without any light it is 0.
    pub(crate) fn polarised_share(&self, mean: f64, depolarised: f64) -> f64 {
        if depolarised == 0.0 {
            // No depolarised light, or less than f64 can tell from none.
            return match self.model.dolp_formula {
                _ if !self.reflects_specularly() => 0.0,
                DolpFormula::Consistent => 1.0,
                DolpFormula::AsPrinted => 1.0 / self.parameters.ks,
            };
        }
        self.polarised_weight() * mean / (self.raised(self.parameters.ks) * mean + depolarised)
    }

    /// Whether any light leaves by the specular lobe.
    pub(crate) fn reflects_specularly(&self) -> bool {
        self.parameters.ks > 0.0 && !self.index.is_vacuum()
    }

    pub(crate) fn index(&self) -> RefractiveIndex {
        self.index
    }

    pub(crate) fn logarithms(&self) -> Option<Logarithms> {
        self.logarithms
    }
}
