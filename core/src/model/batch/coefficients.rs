//! What the kernels need of a surface, formed once.

use crate::model::{Diffuse, DolpFormula, Model, Parameters, Pbrdf};
use crate::optics::SlopeDistribution;
use std::f64::consts::{FRAC_1_PI, PI};

/// √(2π).
const SQRT_TWO_PI: f64 = 2.506_628_274_631_000_5;

/// A surface as the kernels take it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coefficients {
    /// Terms that are there and have a weight.
    pub model: Model,
    pub parameters: Parameters,
    /// (n − 1)(n + 1) − k², |(n − 1)(n + 1)|, n², (n − k)(n + k), n k and (2 n k)².
    pub excess: f64,
    pub excess_size: f64,
    pub n_sq: f64,
    pub difference: f64,
    pub nk: f64,
    pub two_nk_sq: f64,
    /// E = |N² − 1|².
    pub e: f64,
    /// ∂ln E/∂n and ∂ln E/∂k.
    pub ln_e_slopes: [f64; 2],
    /// 1/2σ².
    pub half_over_sigma_sq: f64,
    /// −1/σ_v².
    pub minus_over_sigma_v_sq: f64,
    /// k_s E h/8πσ²: the specular lobe is that times H e^(−x) / (W² Z), over the geometric factor.
    pub specular: f64,
    /// DoLP over the consistent value: 1, or 1/k_s as printed.
    pub dolp_gain: f64,
    /// 1/π and 1/(√(2π) σ_v).
    pub diffuse_height: f64,
    pub volume_height: f64,
    /// The same over `specular`.
    pub diffuse_over_specular: f64,
    pub volume_over_specular: f64,
}

/// Numbers that no product or quotient of the kernels takes out of the range of f64.
fn is_plain(value: f64) -> bool {
    (1e-30..=1e30).contains(&value)
}

impl Coefficients {
    /// None for a surface that only the scalar form does justice: no specular light, Hyde's
    /// integral, or values near the ends of f64.
    pub(crate) fn new(surface: &Pbrdf) -> Option<Self> {
        let model = surface.model();
        let p = *surface.parameters();
        let (minus, plus) = (p.n - 1.0, p.n + 1.0);
        let e = (minus * minus + p.k * p.k) * (plus * plus + p.k * p.k);
        let height = model.distribution.height(p.q);
        let specular = p.ks * e * height / (8.0 * PI * p.sigma * p.sigma);
        let volume_height = 1.0 / (SQRT_TWO_PI * p.sigma_v);
        let coefficients = Self {
            model,
            parameters: p,
            excess: minus * plus - p.k * p.k,
            excess_size: (minus * plus).abs(),
            n_sq: p.n * p.n,
            difference: (p.n - p.k) * (p.n + p.k),
            nk: p.n * p.k,
            two_nk_sq: (2.0 * (p.n * p.k)) * (2.0 * (p.n * p.k)),
            e,
            ln_e_slopes: [4.0 * p.n * (minus * plus + p.k * p.k) / e, 4.0 * p.k * (p.n * p.n + p.k * p.k + 1.0) / e],
            half_over_sigma_sq: 0.5 / (p.sigma * p.sigma),
            minus_over_sigma_v_sq: -1.0 / (p.sigma_v * p.sigma_v),
            specular,
            diffuse_height: FRAC_1_PI,
            volume_height,
            dolp_gain: match model.dolp_formula {
                DolpFormula::Consistent => 1.0,
                DolpFormula::AsPrinted => 1.0 / p.ks,
            },
            diffuse_over_specular: FRAC_1_PI / specular,
            volume_over_specular: volume_height / specular,
        };
        (model.specular && model.diffuse != Diffuse::Hyde && coefficients.is_plain()).then_some(coefficients)
    }

    fn is_plain(&self) -> bool {
        let p = &self.parameters;
        let index = |value: f64| value == 0.0 || (1e-30..=1e6).contains(&value);
        let weight = |value: f64| value == 0.0 || is_plain(value);
        let tail = self.model.distribution == SlopeDistribution::Gauss || (is_plain(p.q - 1.0) && p.q < 1e9);
        let volume = !self.model.volume || (weight(p.kv) && (1e-9..=1e9).contains(&p.sigma_v));
        let diffuse = self.model.diffuse == Diffuse::Absent || (weight(p.kd) && p.c.abs() < 1e6);
        index(p.n) && index(p.k) && is_plain(p.ks) && is_plain(p.sigma) && is_plain(self.specular) && tail && volume && diffuse
    }

    /// Without the terms whose weight is 0, and with c = 0 as Lambert's term: for values, not for derivatives.
    pub(crate) fn without_zero_terms(mut self) -> Self {
        let p = &self.parameters;
        self.model.volume &= p.kv > 0.0;
        self.model.diffuse = match self.model.diffuse {
            Diffuse::Lambert | Diffuse::Minnaert if p.kd == 0.0 => Diffuse::Absent,
            Diffuse::Minnaert if p.c == 0.0 => Diffuse::Lambert,
            other => other,
        };
        self
    }
}
