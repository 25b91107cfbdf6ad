//! Lobes far out in their tails.
//!
//! A lobe is `factor · e^(−x)`, and an error of one unit in the last place of x is an error of x units in the lobe: beyond x = 64 the
//! digits of BRDF and DoLP begin to go. Mostly nothing is lost, since such a lobe is dark beside the others. Where it is not (all
//! lobes that are there are dark, or their weights faint), x is formed in double-double arithmetic, and so are the logarithms of a σ whose
//! square leaves the range of f64.

use crate::model::lobes::{Lobe, has_plain_factor, is_plain};
use crate::model::pbrdf::{Lobes, Pbrdf};
use crate::model::{Diffuse, Model, Parameters};
use crate::optics::{Double, LN_2, SharpFacet, SlopeDistribution};

/// Exponents up to here hold what the bar of 1e-13 asks for: 64 · 5 roundings.
const FAR: f64 = 64.0;
/// A lobe darker than another by e^120 does not show beside it, nor in the absolute: 1e-52.
const INVISIBLE: f64 = 120.0;
/// Exponents above this are darkness, to whatever digit.
const DARKNESS: f64 = 1e200;
/// Beyond this ln(1 + w) is ln w, which is formed without w: that could overflow.
const LARGE: f64 = 1e40;
/// A σ below this makes w larger than that under nearly all geometries.
const NARROW: f64 = 1e-20;

/// ln σ and the logarithm of [`SlopeDistribution::height`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Logarithms {
    sigma: Double,
    height: Double,
}

impl Logarithms {
    /// Of a surface whose exponents need them under nearly all geometries; of others they are formed where they are needed.
    pub(crate) fn where_needed(model: Model, p: &Parameters) -> Option<Self> {
        let height = model.distribution.height(p.q);
        let is_needed = model.specular && (p.sigma < NARROW || !has_plain_factor(p.sigma, height));
        is_needed.then(|| Self { sigma: Double::from(p.sigma).ln(), height: Double::from(height).ln() })
    }
}

/// −ln of a weighted lobe, to within its binary magnitude.
fn darkness(lobe: Lobe, weight: f64) -> f64 {
    let factor = lobe.factor.min(f64::MAX);
    if weight > 0.0 && factor > 0.0 {
        lobe.exponent - LN_2.hi * (f64::from(libm::ilogb(weight)) + f64::from(libm::ilogb(factor)))
    } else {
        f64::INFINITY
    }
}

impl Lobes {
    /// Whether an exponent is too large for its digits, or a σ too extreme for its square.
    pub(crate) fn are_far(&self, parameters: &Parameters) -> bool {
        let Self { specular, diffuse, volume, .. } = self;
        let largest = specular.exponent.abs().max(diffuse.exponent.abs()).max(volume.exponent);
        largest > FAR || (specular.factor > 0.0 && !is_plain(parameters.sigma))
    }
}

impl Pbrdf {
    /// Gives the exponents their digits back where they show.
    #[cold]
    pub(crate) fn sharpen(&self, sharp: impl FnOnce() -> SharpFacet, lobes: &mut Lobes) {
        let p = self.parameters();
        let model = self.model();
        let all = [darkness(lobes.specular, p.ks), darkness(lobes.diffuse, self.diffuse_weight()), darkness(lobes.volume, p.kv)];
        let brightest = all.into_iter().fold(f64::INFINITY, f64::min);
        let present = all.iter().filter(|darkness| **darkness < f64::INFINITY).count();
        // A far lobe shows if it is the only bright one, or if nothing beside it is brighter.
        let shows = |darkness: f64, exponent: f64| {
            exponent.abs() > FAR && exponent < DARKNESS && darkness - brightest < INVISIBLE && (present > 1 || darkness < INVISIBLE)
        };
        let exponents = [lobes.specular.exponent, lobes.diffuse.exponent, lobes.volume.exponent];
        let is_extreme = model.specular && !is_plain(p.sigma);
        if !is_extreme && !all.into_iter().zip(exponents).any(|(darkness, exponent)| shows(darkness, exponent)) {
            return;
        }
        let sharp = sharp();
        if model.specular
            && lobes.specular.exponent < DARKNESS
            && let Some(exponent) = self.specular_exponent(&sharp, lobes.w)
        {
            lobes.specular = lobes.specular.with_exponent(exponent);
        }
        if model.diffuse == Diffuse::Minnaert && lobes.diffuse.exponent.abs() < DARKNESS {
            lobes.diffuse = lobes.diffuse.with_exponent(sharp.ln_cosines * -p.c);
        }
        if model.volume && lobes.volume.exponent < DARKNESS && p.sigma_v > 1.0 / DARKNESS {
            let reduced = sharp.theta_r / p.sigma_v;
            lobes.volume = lobes.volume.with_exponent(reduced * reduced * 0.5);
        }
    }
    /// The exponent of the specular lobe as [`crate::model::lobes::specular`] splits it; none where w overflows under a Gaussian.
    fn specular_exponent(&self, sharp: &SharpFacet, w: f64) -> Option<Double> {
        let p = self.parameters();
        let distribution = self.model().distribution;
        let height = distribution.height(p.q);
        let ln_sigma = || self.logarithms().map_or_else(|| Double::from(p.sigma).ln(), |known| known.sigma);
        let ln_height = || self.logarithms().map_or_else(|| Double::from(height).ln(), |known| known.height);
        let sharp_w = || sharp.tan_alpha_sq / p.sigma / p.sigma * 0.5;
        let tail = match distribution {
            SlopeDistribution::Gauss if w < DARKNESS => sharp_w(),
            SlopeDistribution::Gauss => return None,
            SlopeDistribution::Cauchy if w < LARGE => sharp_w().ln_1p() * p.q,
            SlopeDistribution::Cauchy => (sharp.ln_tan_alpha_sq - ln_sigma() * 2.0 - LN_2) * p.q,
        };
        Some(if has_plain_factor(p.sigma, height) { tail } else { tail + ln_sigma() * 2.0 - ln_height() })
    }
}
