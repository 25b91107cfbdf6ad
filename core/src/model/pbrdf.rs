//! The polarimetric BRDF: which terms are there, and what they add up to.
//!
//! `F = k_s F^s + k_d F^d + k_v F^v` (3, 14). For unpolarised light in, BRDF = F00 and, (17) with k_s where
//! (14) has it, `DoLP = √(F10² + F20²)/F00 = DoLP_s / (1 + (k_d F^d + k_v F^v)/(k_s F^s00))`: no rotation, no difference,
//! and right even where the specular term underflows. [`DolpFormula`] chooses between that and (17) as printed.

use crate::model::hyde_diffuse::SingleScatteringLoss;
use crate::model::lobes;
use crate::model::lobes::Lobe;
use crate::model::prepared::PreparedGeometry;
use crate::model::terms::{Diffuse, DolpFormula, Model};
use crate::model::{ParameterError, Parameters};
use crate::optics::{Facet, Fresnel, Geometry, Mueller, RefractiveIndex};

/// A reflection under one geometry, for unpolarised light in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
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
}

/// A product that is 0 wherever a factor is, however large the other.
pub(crate) fn mul_zero_absorbing(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// The lobes of unit weight under one geometry.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lobes {
    /// tan²α/2σ².
    pub w: f64,
    pub specular: Lobe,
    pub diffuse: Lobe,
    pub volume: Lobe,
}

impl Pbrdf {
    /// A model with values; only the parameters of the model are looked at.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] where one of them lies outside its domain, or n and k are both 0.
    pub fn new(model: Model, parameters: Parameters) -> Result<Self, ParameterError> {
        parameters.validate(model.parameters())?;
        let index = RefractiveIndex::new(parameters.n, parameters.k);
        // A model without a specular lobe has no index: any serves.
        let vacuum = RefractiveIndex::new(1.0, 0.0);
        let index = index.or(vacuum).map_err(|_| ParameterError::NoIndex)?;
        Ok(Self { model, parameters, index })
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

    /// Like [`Self::reflection`], with whatever of the geometry is prepared.
    pub(crate) fn reflection_with(&self, at: &impl PreparedGeometry) -> Reflection {
        let p = &self.parameters;
        let lobes = self.lobes(at);
        let mut reflection = Reflection {
            diffuse: lobes.diffuse.scaled(self.diffuse_weight()).value(),
            volume: lobes.volume.scaled(p.kv).value(),
            ..Reflection::default()
        };
        if self.model.specular {
            let fresnel = at.fresnel(self.index);
            let mean = fresnel.mean();
            reflection.specular = lobes.specular.scaled(mean).scaled(p.ks).value();
            reflection.dolp = mul_zero_absorbing(fresnel.dolp(), self.polarised_share(mean, self.depolarised_over_specular(&lobes)));
        }
        reflection.brdf = reflection.specular + reflection.diffuse + reflection.volume;
        reflection
    }

    /// DoLP at a prepared geometry, and nothing else.
    #[must_use]
    pub fn dolp(&self, facet: &Facet) -> f64 {
        self.dolp_with(facet)
    }

    /// Like [`Self::dolp`], with whatever of the geometry is prepared.
    pub(crate) fn dolp_with(&self, at: &impl PreparedGeometry) -> f64 {
        if !self.model.specular {
            return 0.0;
        }
        let fresnel = at.fresnel(self.index);
        if self.model.diffuse == Diffuse::Absent && !self.model.volume {
            return fresnel.dolp() * self.polarised_share(fresnel.mean(), 0.0);
        }
        let lobes = self.lobes(at);
        mul_zero_absorbing(fresnel.dolp(), self.polarised_share(fresnel.mean(), self.depolarised_over_specular(&lobes)))
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
        let d_g = self.lobes(facet).specular.scaled(self.parameters.ks).value();
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
        let g_over_cosines = model.masking.over_cosines(facet);
        let w = if model.specular { crate::optics::reduced_slope_sq(facet.tan_alpha_sq, p.sigma) } else { 0.0 };
        Lobes {
            w,
            specular: if model.specular { lobes::specular(model.distribution, w, facet, g_over_cosines, p.sigma, p.q) } else { Lobe::ZERO },
            diffuse: match model.diffuse {
                Diffuse::Absent => Lobe::ZERO,
                Diffuse::Lambert => lobes::diffuse(facet, 0.0),
                Diffuse::Minnaert => lobes::diffuse(facet, p.c),
                Diffuse::Hyde if model.specular => SingleScatteringLoss::at(model.distribution, facet.theta_i, p.sigma, p.q).lobe,
                Diffuse::Hyde => Lobe::ZERO,
            },
            volume: if model.volume { lobes::volume(facet, p.sigma_v) } else { Lobe::ZERO },
        }
    }

    /// What the diffuse lobe is multiplied by: k_d, or k_s in Hyde's balance.
    pub(crate) fn diffuse_weight(&self) -> f64 {
        if self.model.diffuse == Diffuse::Hyde { self.parameters.ks } else { self.parameters.kd }
    }

    /// b: the depolarised terms over the specular lobe of unit weight and reflectance.
    pub(crate) fn depolarised_over_specular(&self, lobes: &Lobes) -> f64 {
        let diffuse = lobes.diffuse.scaled(self.diffuse_weight());
        let volume = lobes.volume.scaled(self.parameters.kv);
        diffuse.ratio(lobes.specular) + volume.ratio(lobes.specular)
    }

    /// The weight of the polarised radiance in the numerator of Eq. (17): k_s, or 1 as printed.
    pub(crate) fn polarised_weight(&self) -> f64 {
        match self.model.dolp_formula {
            DolpFormula::Consistent => self.parameters.ks,
            DolpFormula::AsPrinted => 1.0,
        }
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
        self.polarised_weight() * mean / (self.parameters.ks * mean + depolarised)
    }

    /// Whether any light leaves by the specular lobe.
    pub(crate) fn reflects_specularly(&self) -> bool {
        self.parameters.ks > 0.0 && !self.index.is_vacuum()
    }

    pub(crate) fn index(&self) -> RefractiveIndex {
        self.index
    }
}
