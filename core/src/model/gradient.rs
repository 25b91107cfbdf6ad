//! Analytic partial derivatives of BRDF and DoLP by each of the parameters.
//!
//! With the lobes of unit weight U (specular, without reflectance), D and V, the mean reflectance R and `b = (k_d D + k_v V)/U`:
//!
//! - `BRDF = k_s R U + k_d D + k_v V`
//! - `DoLP = DoLP_s s`, `s = κ R/(k_s R + b)`, κ = k_s (consistent) or 1 (as printed); `1 − r = b/(k_s R + b)` is the depolarised share
//!
//! so that `∂s = s (1 − r) ∂ln(R U)` by the specular lobe and `∂s = −s ∂b/(k_s R + b)` by the others; by k_s it is
//! `(1 − r) R/(k_s R + b)` in the consistent formula and `−s R/(k_s R + b)` as printed. Products are
//! formed so that none of them is 0/0 at k_s, k_d, k_v, k = 0 or N = 1, nor where a lobe underflows. At k, k_d, k_v = 0 the
//! derivatives are one-sided; one beyond f64 is infinite.

use crate::model::hyde_diffuse::SingleScatteringLoss;
use crate::model::lobes::Lobe;
use crate::model::pbrdf::{Lobes, Pbrdf, Reflection, mul_zero_absorbing};
use crate::model::prepared::PreparedGeometry;
use crate::model::{Diffuse, DolpFormula, Parameter, ParameterSet, PerParameter};
use crate::optics::{Facet, Fresnel, FresnelGradient};

/// Partial derivatives of BRDF (sr⁻¹ per unit of the parameter) and DoLP.
///
/// Those by parameters that play no part in the model are 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Gradient {
    /// ∂BRDF/∂p.
    pub brdf: PerParameter<f64>,
    /// ∂DoLP/∂p.
    pub dolp: PerParameter<f64>,
}

/// Which derivatives are wanted; the others are left out and stay 0, and so do BRDF with its terms, or DoLP, where no derivative of them is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GradientRequest {
    /// By these parameters.
    pub by: ParameterSet,
    /// Of the BRDF.
    pub brdf: bool,
    /// Of DoLP.
    pub dolp: bool,
}

impl GradientRequest {
    /// Everything.
    pub const ALL: Self = Self { by: ParameterSet::ALL, brdf: true, dolp: true };
}

/// Adds to a derivative; one that lies beyond f64 already stays there, even against another.
fn add_saturating(derivative: &mut f64, other: f64) {
    if derivative.is_finite() {
        *derivative += other;
    }
}

/// What the derivatives of DoLP share.
struct Mixture {
    /// R, the mean reflectance.
    mean: f64,
    /// DoLP_s.
    limit: f64,
    /// s = DoLP/DoLP_s: the specular share of the radiance, over k_s as printed.
    share: f64,
    /// 1 − r, formed without a difference.
    depolarised_share: f64,
    /// k_s R + b.
    total: f64,
}

impl Pbrdf {
    /// BRDF, DoLP and terms with their derivatives at a prepared geometry: those that are wanted.
    #[must_use]
    pub fn reflection_and_gradient(&self, facet: &Facet, wanted: GradientRequest) -> (Reflection, Gradient) {
        self.reflection_and_gradient_with(facet, wanted)
    }

    /// Like [`Self::reflection_and_gradient`], with whatever of the geometry is prepared.
    pub(crate) fn reflection_and_gradient_with(&self, at: &impl PreparedGeometry, wanted: GradientRequest) -> (Reflection, Gradient) {
        let p = self.parameters();
        let facet = at.facet();
        let lobes = self.lobes(at);
        let mut reflection = Reflection::default();
        let mut gradient = Gradient::default();
        if wanted.brdf {
            reflection.diffuse = lobes.diffuse.scaled(self.diffuse_weight()).value();
            reflection.volume = lobes.volume.scaled(p.kv).value();
        }
        if self.model().specular {
            let fresnel = at.fresnel(self.index());
            let mean = fresnel.mean();
            let by_index = if wanted.by.contains(Parameter::N) || wanted.by.contains(Parameter::K) {
                fresnel.gradient()
            } else {
                FresnelGradient { mean: [0.0; 2], dolp: [0.0; 2] }
            };
            if wanted.brdf {
                reflection.specular = lobes.specular.scaled(mean).scaled(p.ks).value();
                self.specular_brdf_gradient(&lobes, mean, reflection.specular, by_index, wanted.by, &mut gradient.brdf);
            }
            if wanted.dolp {
                let mixture = self.mixture(&lobes, &fresnel, mean);
                reflection.dolp = mul_zero_absorbing(mixture.limit, mixture.share);
                if self.reflects_or_depolarises(&lobes) {
                    self.dolp_gradient(&lobes, facet, &mixture, by_index, wanted.by, &mut gradient.dolp);
                }
            }
        }
        if wanted.brdf {
            reflection.brdf = reflection.specular + reflection.diffuse + reflection.volume;
            self.depolarised_brdf_gradient(&lobes, facet, &reflection, wanted.by, &mut gradient.brdf);
        }
        mask(&mut gradient, wanted.by);
        (reflection, gradient)
    }

    /// Specular and depolarised light.
    fn mixture(&self, lobes: &Lobes, fresnel: &Fresnel, mean: f64) -> Mixture {
        let depolarised = self.depolarised_over_specular(lobes);
        let share = self.polarised_share(mean, depolarised);
        let total = self.parameters().ks * mean + depolarised;
        let depolarised_share = if depolarised == 0.0 {
            if self.reflects_specularly() { 0.0 } else { 1.0 }
        } else if total.is_finite() {
            depolarised / total
        } else {
            1.0
        };
        Mixture { mean, limit: fresnel.dolp(), share, depolarised_share, total }
    }

    /// Whether there is any light, so that DoLP has a derivative.
    fn reflects_or_depolarises(&self, lobes: &Lobes) -> bool {
        let p = self.parameters();
        self.reflects_specularly() || self.diffuse_weight() * lobes.diffuse.factor > 0.0 || p.kv * lobes.volume.factor > 0.0
    }

    fn specular_brdf_gradient(
        &self,
        lobes: &Lobes,
        mean: f64,
        specular: f64,
        by_index: FresnelGradient,
        by: ParameterSet,
        out: &mut PerParameter<f64>,
    ) {
        let p = self.parameters();
        let distribution = self.model().distribution;
        if by.contains(Parameter::N) || by.contains(Parameter::K) {
            let weighted = lobes.specular.scaled(p.ks).value();
            out[Parameter::N] = mul_zero_absorbing(weighted, by_index.mean[0]);
            out[Parameter::K] = mul_zero_absorbing(weighted, by_index.mean[1]);
        }
        out[Parameter::Sigma] = mul_zero_absorbing(specular, distribution.sigma_log_slope(lobes.w, p.q) / p.sigma);
        if by.contains(Parameter::Ks) {
            out[Parameter::Ks] = lobes.specular.value() * mean;
        }
        if by.contains(Parameter::Q) {
            let per_height = lobes.specular.scaled(mean / distribution.height(p.q)).scaled(p.ks).value();
            out[Parameter::Q] = mul_zero_absorbing(per_height, distribution.q_slope(libm::log1p(lobes.w), p.q));
        }
    }

    fn depolarised_brdf_gradient(
        &self,
        lobes: &Lobes,
        facet: &Facet,
        reflection: &Reflection,
        by: ParameterSet,
        out: &mut PerParameter<f64>,
    ) {
        let p = self.parameters();
        let value = |parameter: Parameter, lobe: Lobe| if by.contains(parameter) { lobe.value() } else { 0.0 };
        out[Parameter::Kv] = value(Parameter::Kv, lobes.volume);
        match self.model().diffuse {
            Diffuse::Absent => {}
            Diffuse::Lambert => out[Parameter::Kd] = value(Parameter::Kd, lobes.diffuse),
            Diffuse::Minnaert => {
                out[Parameter::Kd] = value(Parameter::Kd, lobes.diffuse);
                out[Parameter::C] = reflection.diffuse * facet.ln_cosines;
            }
            Diffuse::Hyde if self.model().specular => {
                let loss = self.loss(facet);
                out[Parameter::Ks] += lobes.diffuse.value();
                add_saturating(&mut out[Parameter::Sigma], mul_zero_absorbing(reflection.diffuse, loss.by_sigma));
                add_saturating(&mut out[Parameter::Q], mul_zero_absorbing(reflection.diffuse, loss.by_q));
            }
            Diffuse::Hyde => {}
        }
        if self.model().volume {
            out[Parameter::SigmaV] = mul_zero_absorbing(reflection.volume, volume_slope(lobes.volume, p.sigma_v));
        }
    }

    fn dolp_gradient(
        &self,
        lobes: &Lobes,
        facet: &Facet,
        mixture: &Mixture,
        by_index: FresnelGradient,
        by: ParameterSet,
        out: &mut PerParameter<f64>,
    ) {
        let p = self.parameters();
        let &Mixture { mean, limit, share, depolarised_share, total } = mixture;
        let distribution = self.model().distribution;
        // ∂s/∂R and ∂s/∂k_s, without s/R or s/k_s, which are 0/0 in the dark.
        let by_mean = mul_zero_absorbing(depolarised_share * self.polarised_weight(), 1.0 / total);
        for (j, parameter) in [Parameter::N, Parameter::K].into_iter().enumerate() {
            out[parameter] = mul_zero_absorbing(share, by_index.dolp[j]);
            add_saturating(&mut out[parameter], mul_zero_absorbing(mul_zero_absorbing(limit, by_mean), by_index.mean[j]));
        }
        out[Parameter::Ks] = mul_zero_absorbing(mul_zero_absorbing(limit, self.ks_factor(depolarised_share, share)) * mean, 1.0 / total);
        let both = mul_zero_absorbing(limit, share * depolarised_share);
        out[Parameter::Sigma] = mul_zero_absorbing(both, distribution.sigma_log_slope(lobes.w, p.q) / p.sigma);
        if by.contains(Parameter::Q) {
            out[Parameter::Q] = mul_zero_absorbing(both, distribution.q_slope(libm::log1p(lobes.w), p.q) / distribution.height(p.q));
        }

        // −DoLP_s s ∂b/(k_s R + b): the small factors enter before the exponential can overflow.
        let gains = [-mul_zero_absorbing(limit, share), 1.0 / total];
        let neg_ratio = |lobe: Lobe, weight: f64| lobe.scaled(weight).scaled_ratio(lobes.specular, gains);
        let neg_ratio_for =
            |parameter: Parameter, lobe: Lobe, weight: f64| if by.contains(parameter) { neg_ratio(lobe, weight) } else { 0.0 };
        out[Parameter::Kv] = neg_ratio_for(Parameter::Kv, lobes.volume, 1.0);
        match self.model().diffuse {
            Diffuse::Absent => {}
            Diffuse::Lambert => out[Parameter::Kd] = neg_ratio_for(Parameter::Kd, lobes.diffuse, 1.0),
            Diffuse::Minnaert => {
                out[Parameter::Kd] = neg_ratio_for(Parameter::Kd, lobes.diffuse, 1.0);
                out[Parameter::C] = neg_ratio_for(Parameter::C, lobes.diffuse, p.kd) * facet.ln_cosines;
            }
            Diffuse::Hyde => {
                let loss = self.loss(facet);
                let balance = neg_ratio(lobes.diffuse, p.ks);
                add_saturating(&mut out[Parameter::Sigma], mul_zero_absorbing(balance, loss.by_sigma));
                add_saturating(&mut out[Parameter::Q], mul_zero_absorbing(balance, loss.by_q));
                // Specular lobe and balance rise together with k_s: in the consistent formula k_s counts against the
                // volume lobe alone.
                let others = lobes.volume.scaled(p.kv).ratio(lobes.specular);
                let volume_share = if others == 0.0 { 0.0 } else { (others / total).min(1.0) };
                out[Parameter::Ks] = match self.model().dolp_formula {
                    DolpFormula::Consistent => mul_zero_absorbing(limit * volume_share * mean, 1.0 / total),
                    // −DoLP ∂ln(k_s R + b)/∂k_s
                    DolpFormula::AsPrinted => {
                        let ratio = lobes.diffuse.ratio(lobes.specular);
                        mul_zero_absorbing(mul_zero_absorbing(-mul_zero_absorbing(limit, share), mean + ratio), 1.0 / total)
                    }
                };
            }
        }
        if self.model().volume {
            out[Parameter::SigmaV] =
                mul_zero_absorbing(neg_ratio_for(Parameter::SigmaV, lobes.volume, p.kv), volume_slope(lobes.volume, p.sigma_v));
        }
    }
}

impl Pbrdf {
    /// `∂s/∂k_s` over `R/(k_s R + b)`.
    fn ks_factor(&self, depolarised_share: f64, share: f64) -> f64 {
        match self.model().dolp_formula {
            DolpFormula::Consistent => depolarised_share,
            DolpFormula::AsPrinted => -share,
        }
    }

    /// The light that single reflection loses: Hyde's term.
    fn loss(&self, facet: &Facet) -> SingleScatteringLoss {
        SingleScatteringLoss::at(self.model().distribution, facet.theta_i, self.parameters().sigma, self.parameters().q)
    }
}

/// `∂ln F^v/∂σ_v = (θr²/σ_v² − 1)/σ_v`.
fn volume_slope(volume: Lobe, sigma_v: f64) -> f64 {
    (2.0 * volume.exponent - 1.0) / sigma_v
}

/// Sets derivatives that are not requested to 0.
fn mask(gradient: &mut Gradient, wanted: ParameterSet) {
    if wanted == ParameterSet::ALL {
        return;
    }
    for parameter in Parameter::ALL {
        if !wanted.contains(parameter) {
            gradient.brdf[parameter] = 0.0;
            gradient.dolp[parameter] = 0.0;
        }
    }
}
