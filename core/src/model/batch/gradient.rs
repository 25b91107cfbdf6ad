//! The kernels for DoLP, for BRDF, and their derivatives by the parameters, as `model::gradient` has them.
//!
//! With `T = B W² Z` (so that r = H/(H + T) is the specular share of the radiance and 1 − r = T/(H + T)) and the reflectance
//! `R = E H/(W² Z)`:
//!
//! - by n and k: `r ∂DoLP_s + DoLP_s r (1 − r) ∂ln R`
//! - by σ, q, k_s: `DoLP_s r (1 − r)` times the logarithmic slope of the specular lobe
//! - by k_d, k_v: `−DoLP T₁/(H + T)`, T₁ being T of the lobe of unit weight; by c and σ_v that times weight and logarithmic slope
//!
//! With the specular lobe S, `BRDF = S + k_d D + k_v V` has the derivatives `S ∂ln R` by n and k, S times the logarithmic slope by σ, q and
//! k_s, and those of the other lobes term by term.
//!
//! DoLP [as printed](DolpFormula::AsPrinted) is 1/k_s times the consistent value, and so are its derivatives, but by k_s: `−DoLP r/k_s`.

use crate::model::batch::coefficients::Coefficients;
use crate::model::batch::elementary::exp2;
use crate::model::batch::kernels::{FresnelLanes, MINNAERT, NONE, STEEPEST, Slopes, diffuse_exponent, over_geometric, volume_exponent};
use crate::model::batch::lanes::{Kernel, Mask, Points, V, choose, number};
use crate::model::{DolpFormula, Parameter};
use fearless_simd::prelude::*;
use std::f64::consts::LN_2;

/// Depolarised terms beyond this multiple of the specular one go the scalar way: their products near the end of f64.
const DARKEST: f64 = 1e280;

/// A surface, and whether derivatives by n or k are wanted: they cost half of all.
#[derive(Clone, Copy)]
pub(crate) struct Slopewise<'a> {
    pub of: &'a Coefficients,
    pub by_index: bool,
}

/// DoLP, then its derivatives in the order of [`Parameter::ALL`].
pub(crate) struct DolpGradient<'a, const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool>(pub Slopewise<'a>);

/// BRDF, then its derivatives in the order of [`Parameter::ALL`].
pub(crate) struct BrdfGradient<'a, const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool>(pub Slopewise<'a>);

/// Columns of a kernel: the value and a derivative by each parameter.
pub(crate) const COLUMNS: usize = 1 + Parameter::COUNT;

/// Where the column of a parameter is.
const fn column(parameter: Parameter) -> usize {
    1 + parameter as usize
}

impl<const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool> Kernel<COLUMNS> for DolpGradient<'_, CAUCHY, DIFFUSE, VOLUME> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, points: &Points<'_, S>) -> ([V<S>; COLUMNS], Mask<S>) {
        let Slopewise { of, by_index } = self.0;
        let p = &of.parameters;
        let zero = number(simd, 0.0);
        let fresnel = FresnelLanes::new(simd, points, of);
        let slopes = Slopes::new::<CAUCHY>(simd, points, of);
        let gain = over_geometric(points, of) * fresnel.w_sq_z();
        let mut steepest = slopes.exponent;
        let (mut diffuse, mut volume) = (zero, zero);
        if DIFFUSE != NONE {
            let exponent = if DIFFUSE == MINNAERT { diffuse_exponent(points, of) + slopes.exponent } else { slopes.exponent };
            steepest = steepest.max(exponent);
            diffuse = exp2(simd, exponent) * of.diffuse_over_specular * gain;
        }
        if VOLUME {
            volume = exp2(simd, volume_exponent(points, of) + slopes.exponent) * of.volume_over_specular * gain;
        }
        let depolarised = diffuse.mul_add(number(simd, p.kd), volume * p.kv);
        let total = fresnel.h + depolarised;
        let one_over = number(simd, 1.0) / total;
        let dolp = fresnel.polarised * one_over * of.dolp_gain;
        let specular = fresnel.h * one_over;
        let share = specular * of.dolp_gain;
        let rest = depolarised * one_over;
        let both = dolp * rest;

        let mut out = [zero; COLUMNS];
        out[0] = dolp;
        if by_index {
            let ([mean_n, mean_k], [limit_n, limit_k]) = index_slopes(simd, &fresnel, of);
            out[column(Parameter::N)] = share.mul_add(limit_n, both * mean_n);
            out[column(Parameter::K)] = share.mul_add(limit_k, both * mean_k);
        }
        out[column(Parameter::Ks)] = match of.model.dolp_formula {
            DolpFormula::Consistent => both * (1.0 / p.ks),
            DolpFormula::AsPrinted => dolp * specular * (-1.0 / p.ks),
        };
        [out[column(Parameter::Sigma)], out[column(Parameter::Q)]] = lobe_slopes::<CAUCHY, S>(simd, &slopes, of, both);
        let darkening = -(dolp * one_over);
        if DIFFUSE != NONE {
            let by_weight = darkening * diffuse;
            out[column(Parameter::Kd)] = by_weight;
            if DIFFUSE == MINNAERT {
                out[column(Parameter::C)] = by_weight * (p.kd * LN_2) * points.load(|block| &block.log2_cosines);
            }
        }
        if VOLUME {
            let by_weight = darkening * volume;
            out[column(Parameter::Kv)] = by_weight;
            let slope = volume_exponent(points, of) * (2.0 * LN_2) + 1.0;
            out[column(Parameter::SigmaV)] = by_weight * slope * (-p.kv / p.sigma_v);
        }
        let needs_scalar = steepest.simd_gt(number(simd, STEEPEST)) | fresnel.a_sq.simd_eq(zero) | total.simd_gt(number(simd, DARKEST));
        (out, needs_scalar)
    }
}

impl<const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool> Kernel<COLUMNS> for BrdfGradient<'_, CAUCHY, DIFFUSE, VOLUME> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, points: &Points<'_, S>) -> ([V<S>; COLUMNS], Mask<S>) {
        let Slopewise { of, by_index } = self.0;
        let p = &of.parameters;
        let zero = number(simd, 0.0);
        let fresnel = FresnelLanes::new(simd, points, of);
        let slopes = Slopes::new::<CAUCHY>(simd, points, of);
        let mut steepest = slopes.exponent;
        let specular = exp2(simd, -slopes.exponent) * of.specular * fresnel.h / (over_geometric(points, of) * fresnel.w_sq_z());
        let mut out = [zero; COLUMNS];
        out[0] = specular;
        if by_index {
            let ([mean_n, mean_k], _) = index_slopes(simd, &fresnel, of);
            out[column(Parameter::N)] = specular * mean_n;
            out[column(Parameter::K)] = specular * mean_k;
        }
        out[column(Parameter::Ks)] = specular * (1.0 / p.ks);
        [out[column(Parameter::Sigma)], out[column(Parameter::Q)]] = lobe_slopes::<CAUCHY, S>(simd, &slopes, of, specular);
        if DIFFUSE != NONE {
            let mut diffuse = number(simd, of.diffuse_height);
            if DIFFUSE == MINNAERT {
                let exponent = diffuse_exponent(points, of);
                steepest = steepest.max(exponent);
                diffuse = exp2(simd, exponent) * of.diffuse_height;
                out[column(Parameter::C)] = diffuse * (p.kd * LN_2) * points.load(|block| &block.log2_cosines);
            }
            out[0] += diffuse * p.kd;
            out[column(Parameter::Kd)] = diffuse;
        }
        if VOLUME {
            let exponent = volume_exponent(points, of);
            let volume = exp2(simd, exponent) * of.volume_height;
            out[0] += volume * p.kv;
            out[column(Parameter::Kv)] = volume;
            out[column(Parameter::SigmaV)] = volume * (exponent * (2.0 * LN_2) + 1.0) * (-p.kv / p.sigma_v);
        }
        let needs_scalar = steepest.simd_gt(number(simd, STEEPEST)) | fresnel.a_sq.simd_eq(zero);
        (out, needs_scalar)
    }
}

/// The derivatives by σ and q of what is proportional to the specular lobe, given that times its factor.
#[inline(always)]
fn lobe_slopes<const CAUCHY: bool, S: Simd>(simd: S, slopes: &Slopes<S>, of: &Coefficients, times: V<S>) -> [V<S>; 2] {
    let p = &of.parameters;
    if CAUCHY {
        let slope = number(simd, p.q - 1.0).mul_sub(slopes.w, number(simd, 1.0)) / (slopes.w + 1.0);
        [times * slope * (2.0 / p.sigma), times * slopes.log2.mul_add(number(simd, -LN_2), number(simd, 1.0 / (p.q - 1.0)))]
    } else {
        [times * (slopes.w - 1.0) * (2.0 / p.sigma), number(simd, 0.0)]
    }
}

/// Derivatives of ln R, the reflectance, and of DoLP_s by n and k.
#[inline(always)]
fn index_slopes<S: Simd>(simd: S, fresnel: &FresnelLanes<S>, of: &Coefficients) -> ([V<S>; 2], [V<S>; 2]) {
    let (n, k) = (of.parameters.n, of.parameters.k);
    let splat = |value| number(simd, value);
    let FresnelLanes { sin_sq, cos_sq, u_cos, a_sq, larger, smaller, dense, .. } = *fresnel;
    let v_cos = choose::<S>(dense, smaller, larger);
    let one_over_a_sq = splat(1.0) / a_sq;
    // cos β ∂u/∂n and cos β ∂u/∂k, the latter without the difference v² − k² (`optics::fresnel`).
    let along = u_cos.mul_add(splat(n), v_cos * k) * one_over_a_sq;
    let size_sq = v_cos.mul_add(v_cos, cos_sq * of.index.n_sq);
    let across = choose::<S>(size_sq.simd_gt(splat(0.0)), sin_sq * cos_sq * v_cos * n / size_sq, splat(0.0)) * one_over_a_sq;
    let modulus_sq = of.index.n_sq + k * k;
    let by_n = IndexSlope { u_cos: along, a_sq: (splat(modulus_sq) - sin_sq) * (2.0 * n) * one_over_a_sq, ln_e: of.index.ln_e_slopes[0] };
    let by_k = IndexSlope { u_cos: across, a_sq: (sin_sq + modulus_sq) * (2.0 * k) * one_over_a_sq, ln_e: of.index.ln_e_slopes[1] };
    let shared = Shared::new(simd, fresnel, of);
    let (mean_n, limit_n) = shared.slopes(simd, fresnel, &by_n);
    let (mean_k, limit_k) = shared.slopes(simd, fresnel, &by_k);
    ([mean_n, mean_k], [limit_n, limit_k])
}

/// Derivatives of u cos β, |a|² and ln E by one of n and k.
struct IndexSlope<S: Simd> {
    u_cos: V<S>,
    a_sq: V<S>,
    ln_e: f64,
}

/// What the derivatives by n and by k share.
struct Shared<S: Simd> {
    over_h: V<S>,
    over_z: V<S>,
    over_w: V<S>,
    /// R, and where it is so large that the form of `1 − R` keeps more digits.
    mean: V<S>,
    bright: Mask<S>,
    /// sin²β/2Z and Rs: (1 − R)/(4u cos β) = 1/W + Rs sin²β/2Z.
    p_part: V<S>,
    rs: V<S>,
}

impl<S: Simd> Shared<S> {
    #[inline(always)]
    fn new(simd: S, fresnel: &FresnelLanes<S>, of: &Coefficients) -> Self {
        let one = number(simd, 1.0);
        let (over_h, over_z, over_w) = (one / fresnel.h, one / fresnel.z, one / fresnel.w);
        let rs = over_w * over_w * of.index.e;
        let mean = rs * fresnel.h * over_z;
        Self { over_h, over_z, over_w, mean, bright: mean.simd_ge(number(simd, 0.5)), p_part: fresnel.sin_sq * over_z * 0.5, rs }
    }

    /// ∂ln R and ∂DoLP_s.
    #[inline(always)]
    fn slopes(&self, simd: S, fresnel: &FresnelLanes<S>, by: &IndexSlope<S>) -> (V<S>, V<S>) {
        let Self { over_h, over_z, over_w, mean, bright, p_part, rs } = *self;
        let FresnelLanes { cos_sq, sin_sq, u_cos, .. } = *fresnel;
        let two_cos_du = by.u_cos + by.u_cos;
        let dh = cos_sq * by.a_sq;
        let ln_dh = dh * over_h;
        let ln_dw = (two_cos_du + by.a_sq) * over_w;
        let ln_dz = two_cos_du.mul_add(sin_sq, dh) * over_z;
        let of_dim = ln_dh - ln_dw * 2.0 - ln_dz + by.ln_e;
        // A strong reflector hardly changes: 1 − R = 4u cos β (1/W + Rs sin²β/2Z) keeps the digits.
        let absorbed = rs.mul_add(p_part, over_w);
        let ln_drs = number(simd, by.ln_e) - ln_dw * 2.0;
        let dabsorbed = (rs * p_part).mul_add(ln_drs - ln_dz, -(over_w * ln_dw));
        let of_bright = u_cos.mul_add(dabsorbed, by.u_cos * absorbed) * -4.0 / mean;
        let limit = sin_sq * 2.0 * over_h * (by.u_cos - u_cos * ln_dh);
        (choose::<S>(bright, of_bright, of_dim), limit)
    }
}
