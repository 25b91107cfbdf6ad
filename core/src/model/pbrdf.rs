//! The polarimetric BRDF: which terms are there, and what they add up to.
//!
//! `F = k_s F^s + k_d F^d + k_v F^v` (3, 14). For unpolarised light in, BRDF = F00 and, (17) with k_s where
//! (14) has it, `DoLP = √(F10² + F20²)/F00 = DoLP_s / (1 + (k_d F^d + k_v F^v)/(k_s F^s00))`: no rotation, no difference,
//! and right even where the specular term underflows.

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
}

impl Model {
    /// All terms, with that distribution.
    #[must_use]
    pub const fn full(distribution: SlopeDistribution) -> Self {
        Self { distribution, masking: true, specular: true, diffuse: Diffuse::Minnaert, volume: true }
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

    /// Whether its DoLP depends on those parameters at all: a lone specular lobe has the DoLP of its facets,
    /// whatever their distribution, and then σ, q and k_s show in the BRDF only; beside Hyde's term alone k_s cancels.
    #[must_use]
    pub fn dolp_parameters(&self) -> ParameterSet {
        if !self.specular {
            ParameterSet::EMPTY
        } else if self.diffuse == Diffuse::Absent && !self.volume {
            [Parameter::N, Parameter::K].into_iter().collect()
        } else if self.diffuse == Diffuse::Hyde && !self.volume {
            self.parameters().without(Parameter::Ks)
        } else {
            self.parameters()
        }
    }
}

/// A reflection under one geometry, for unpolarised light in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reflection {
    /// BRDF, F00, in sr⁻¹.
    pub brdf: f64,
    /// Degree of linear polarisation, 0 to 1.
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
            reflection.dolp = fresnel.dolp() * self.specular_share(mean, self.depolarised_over_specular(&lobes));
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
            return if self.reflects_specularly() { fresnel.dolp() } else { 0.0 };
        }
        let lobes = self.lobes(at);
        fresnel.dolp() * self.specular_share(fresnel.mean(), self.depolarised_over_specular(&lobes))
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

    /// The specular part of the radiance, `k_s R/(k_s R + b)`, for the mean reflectance R and b.
    pub(crate) fn specular_share(&self, mean: f64, depolarised: f64) -> f64 {
        if depolarised == 0.0 {
            // Nothing else, or nothing else that f64 can tell from nothing.
            return if self.reflects_specularly() { 1.0 } else { 0.0 };
        }
        let specular = self.raised(self.parameters.ks) * mean;
        specular / (specular + depolarised)
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
