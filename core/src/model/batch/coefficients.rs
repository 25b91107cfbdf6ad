//! What the kernels need of a surface, formed once.

use crate::model::{Diffuse, DolpFormula, Model, Parameter, Parameters, Pbrdf};
use crate::optics::RefractiveIndex;
use std::f64::consts::{FRAC_1_PI, LOG2_E, PI};

/// √(2π).
const SQRT_TWO_PI: f64 = 2.506_628_274_631_000_5;

/// Beyond this, coefficients times 2^720 leave the range of f64 ([`crate::model::batch::kernels::STEEPEST`]).
const LARGEST_RATIO: f64 = 1e60;
/// Below this, squares of |N|² at normal incidence leave the range of f64.
const SMALLEST_INDEX: f64 = 1e-30;

/// A surface as the kernels take it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coefficients {
    /// Terms that are there and have a weight.
    pub model: Model,
    pub parameters: Parameters,
    pub index: IndexCoefficients,
    /// 1/2σ².
    pub half_over_sigma_sq: f64,
    /// −log₂e/σ_v²: θr²/2 times that is the exponent of 2 in the volume lobe.
    pub volume_fall: f64,
    /// k_s E h/8πσ²: the specular lobe is that times H 2^(−x) / (W² Z), over the geometric factor.
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

/// What depends on n and k alone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct IndexCoefficients {
    /// (n − 1)(n + 1) − k² and |(n − 1)(n + 1)|.
    pub excess: f64,
    pub excess_size: f64,
    /// n², (n − k)(n + k), n k and (2 n k)².
    pub n_sq: f64,
    pub difference: f64,
    pub nk: f64,
    pub two_nk_sq: f64,
    /// E = |N² − 1|².
    pub e: f64,
    /// ∂ln E/∂n and ∂ln E/∂k.
    pub ln_e_slopes: [f64; 2],
}

impl IndexCoefficients {
    fn new(n: f64, k: f64) -> Self {
        let (minus, plus) = (n - 1.0, n + 1.0);
        let e = (minus * minus + k * k) * (plus * plus + k * k);
        Self {
            excess: minus * plus - k * k,
            excess_size: (minus * plus).abs(),
            n_sq: n * n,
            difference: (n - k) * (n + k),
            nk: n * k,
            two_nk_sq: (2.0 * (n * k)) * (2.0 * (n * k)),
            e,
            ln_e_slopes: [4.0 * n * (minus * plus + k * k) / e, 4.0 * k * (n * n + k * k + 1.0) / e],
        }
    }
}

impl Coefficients {
    /// None for a surface that only the scalar form evaluates: without specular light, with Hyde's integral, or with
    /// coefficients that kernels could take out of the range of f64.
    pub(crate) fn new(surface: &Pbrdf) -> Option<Self> {
        let model = surface.model();
        let p = *surface.parameters();
        let index = IndexCoefficients::new(p.n, p.k);
        let specular = p.ks * index.e * model.distribution.height(p.q) / (8.0 * PI * p.sigma * p.sigma);
        let volume_height = 1.0 / (SQRT_TWO_PI * p.sigma_v);
        let coefficients = Self {
            model,
            parameters: p,
            index,
            half_over_sigma_sq: 0.5 / (p.sigma * p.sigma),
            volume_fall: -LOG2_E / (p.sigma_v * p.sigma_v),
            specular,
            dolp_gain: match model.dolp_formula {
                DolpFormula::Consistent => 1.0,
                DolpFormula::AsPrinted => 1.0 / p.ks,
            },
            diffuse_height: FRAC_1_PI,
            volume_height,
            diffuse_over_specular: FRAC_1_PI / specular,
            volume_over_specular: volume_height / specular,
        };
        (model.specular && model.diffuse != Diffuse::Hyde && coefficients.stay_in_range()).then_some(coefficients)
    }

    /// The same surface with another n or k; none where [`Self::new`] has none.
    pub(crate) fn with_index(&self, parameter: Parameter, value: f64) -> Option<Self> {
        let mut parameters = self.parameters;
        parameters[parameter] = value;
        if !parameter.domain().contains(value) || RefractiveIndex::new(parameters.n, parameters.k).is_err() {
            return None;
        }
        let index = IndexCoefficients::new(parameters.n, parameters.k);
        let specular = self.specular / self.index.e * index.e;
        let over_specular = 1.0 / specular;
        let coefficients = Self {
            parameters,
            index,
            specular,
            diffuse_over_specular: self.diffuse_height * over_specular,
            volume_over_specular: self.volume_height * over_specular,
            ..*self
        };
        coefficients.stay_in_range().then_some(coefficients)
    }

    /// Whether there is a diffuse term.
    pub(crate) fn has_diffuse(&self) -> bool {
        self.model.diffuse != Diffuse::Absent
    }

    fn stay_in_range(&self) -> bool {
        let p = &self.parameters;
        let is_moderate = |height: f64, weight: f64| height.max(weight * height) <= LARGEST_RATIO;
        let diffuse = self.model.diffuse == Diffuse::Absent || is_moderate(self.diffuse_over_specular, p.kd);
        let volume = !self.model.volume || is_moderate(self.volume_over_specular, p.kv);
        p.n.max(p.k) >= SMALLEST_INDEX && self.specular > 0.0 && diffuse && volume
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
