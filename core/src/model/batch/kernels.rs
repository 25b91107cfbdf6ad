//! The kernels: DoLP, BRDF, and both with the specular part, of as many points as a vector has lanes.
//!
//! With the letters of `optics::fresnel` (a = u + iv, W = |cos β + a|², H, Z, E) and the specular lobe
//! `S = K_s g 2^(−x) H/(W² Z)`, K_s = k_s E h/8πσ², g the geometric factor, x the exponent of the slope distribution, of 2 as all
//! exponents here:
//!
//! - `W = |a|² + cos²β + 2u cos β`, since `u² + v² = |a|²`: v is not needed
//! - `DoLP = 2u sin²β cos β / (H + B W² Z)`, `B = (k_d F^d + k_v F^v) 2^x / (K_s g)`: one division, no reflectance
//!
//! A term that is absent, or whose weight is 0, is not in the machine code that runs.

use crate::model::batch::coefficients::Coefficients;
use crate::model::batch::elementary::{exp2, log2_1p};
use crate::model::batch::lanes::{Kernel, Mask, Points, V, choose, number};
use crate::optics::Masking;
use fearless_simd::prelude::*;
use std::f64::consts::LOG2_E;

/// Exponents of 2 beyond this go the scalar way: 2^720 times any weight is far from the end of f64.
pub(crate) const STEEPEST: f64 = 720.0;

/// Which terms a kernel has.
pub(crate) const NONE: u8 = 0;
pub(crate) const LAMBERT: u8 = 1;
pub(crate) const MINNAERT: u8 = 2;

/// Fresnel reflection of the facets, without a reflectance: what DoLP and BRDF share.
#[derive(Clone, Copy)]
pub(crate) struct FresnelLanes<S: Simd> {
    pub sin_sq: V<S>,
    pub cos_sq: V<S>,
    pub a_sq: V<S>,
    /// Whether Re(N² − sin²β) ≥ 0, and the larger and the smaller of u cos β and v cos β.
    pub dense: Mask<S>,
    pub larger: V<S>,
    pub smaller: V<S>,
    pub u_cos: V<S>,
    /// 2u cos β sin²β ≤ H: over H it is DoLP_s.
    pub polarised: V<S>,
    pub h: V<S>,
    pub z: V<S>,
    pub w: V<S>,
}

/// What [`FresnelLanes`] needs of an index, in lanes: [`crate::model::batch::coefficients::IndexCoefficients`].
#[derive(Clone, Copy)]
pub(crate) struct IndexLanes<S: Simd> {
    pub excess: V<S>,
    pub excess_size: V<S>,
    pub n_sq: V<S>,
    pub difference: V<S>,
    pub nk: V<S>,
    pub two_nk_sq: V<S>,
}

impl<S: Simd> FresnelLanes<S> {
    /// Of many points under one index.
    #[inline(always)]
    pub(crate) fn new(simd: S, points: &Points<'_, S>, of: &Coefficients) -> Self {
        let splat = |value| number(simd, value);
        let index = IndexLanes {
            excess: splat(of.index.excess),
            excess_size: splat(of.index.excess_size),
            n_sq: splat(of.index.n_sq),
            difference: splat(of.index.difference),
            nk: splat(of.index.nk),
            two_nk_sq: splat(of.index.two_nk_sq),
        };
        Self::of(simd, points.load(|block| &block.sin_beta_sq), points.load(|block| &block.cos_beta_sq), &index)
    }

    /// Given sin²β and cos²β.
    #[inline(always)]
    pub(crate) fn of(simd: S, sin_sq: V<S>, cos_sq: V<S>, index: &IndexLanes<S>) -> Self {
        let splat = |value| number(simd, value);
        // Re(N² − sin²β), by whichever of two equal sums has the smaller terms.
        let by_excess = index.excess_size.max(cos_sq).simd_lt(index.n_sq.max(sin_sq));
        let x = choose::<S>(by_excess, cos_sq + index.excess, index.difference - sin_sq);
        let a_sq = x.mul_add(x, index.two_nk_sq).sqrt();
        let larger = ((a_sq + x.abs()) * 0.5 * cos_sq).sqrt();
        // The least number keeps 0/0 away at the critical angle of a transparent index.
        let smaller = index.nk * cos_sq / larger.max(splat(f64::MIN_POSITIVE));
        let dense = x.simd_ge(splat(0.0));
        let u_cos = choose::<S>(dense, larger, smaller);
        let h = a_sq.mul_add(cos_sq, sin_sq * sin_sq);
        let two_u_cos = u_cos + u_cos;
        let numerator = two_u_cos * sin_sq;
        Self {
            sin_sq,
            cos_sq,
            a_sq,
            dense,
            larger,
            smaller,
            u_cos,
            // An ulp or two above H near Brewster's angle.
            polarised: numerator.min(h),
            h,
            z: h + numerator,
            w: a_sq + cos_sq + two_u_cos,
        }
    }

    /// W² Z.
    #[inline(always)]
    pub(crate) fn w_sq_z(&self) -> V<S> {
        self.w * self.w * self.z
    }
}

/// What the slopes do to the specular lobe.
pub(crate) struct Slopes<S: Simd> {
    /// w = tan²α/2σ².
    pub w: V<S>,
    /// log₂(1 + w); Cauchy only.
    pub log2: V<S>,
    /// x: the lobe falls off as 2^(−x).
    pub exponent: V<S>,
}

impl<S: Simd> Slopes<S> {
    #[inline(always)]
    pub(crate) fn new<const CAUCHY: bool>(simd: S, points: &Points<'_, S>, of: &Coefficients) -> Self {
        let w = points.load(|block| &block.tan_alpha_sq) * of.half_over_sigma_sq;
        if CAUCHY {
            let log2 = log2_1p(simd, w);
            Self { w, log2, exponent: log2 * of.parameters.q }
        } else {
            Self { w, log2: w, exponent: w * LOG2_E }
        }
    }
}

/// 1/g.
#[inline(always)]
pub(crate) fn over_geometric<S: Simd>(points: &Points<'_, S>, of: &Coefficients) -> V<S> {
    match of.model.masking {
        Masking::None => points.load(|block| &block.over_open),
        Masking::VGroove => points.load(|block| &block.over_geometric),
    }
}

/// Exponents of 2 in F^d and F^v; those of a term that is not there are not formed.
#[inline(always)]
pub(crate) fn diffuse_exponent<S: Simd>(points: &Points<'_, S>, of: &Coefficients) -> V<S> {
    points.load(|block| &block.log2_cosines) * of.parameters.c
}

#[inline(always)]
pub(crate) fn volume_exponent<S: Simd>(points: &Points<'_, S>, of: &Coefficients) -> V<S> {
    points.load(|block| &block.half_theta_r_sq) * of.volume_fall
}

/// DoLP.
pub(crate) struct Dolp<'a, const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool>(pub &'a Coefficients);

impl<const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool> Kernel<1> for Dolp<'_, CAUCHY, DIFFUSE, VOLUME> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, points: &Points<'_, S>) -> ([V<S>; 1], Mask<S>) {
        let of = self.0;
        let fresnel = FresnelLanes::new(simd, points, of);
        if DIFFUSE == NONE && !VOLUME {
            return ([fresnel.polarised / fresnel.h * of.dolp_gain], Mask::<S>::splat(simd, false));
        }
        let slopes = Slopes::new::<CAUCHY>(simd, points, of);
        let mut steepest = slopes.exponent;
        let mut b = number(simd, 0.0);
        if DIFFUSE == LAMBERT {
            b = exp2(simd, slopes.exponent) * (of.diffuse_over_specular * of.parameters.kd);
        } else if DIFFUSE == MINNAERT {
            let exponent = diffuse_exponent(points, of) + slopes.exponent;
            steepest = steepest.max(exponent);
            b = exp2(simd, exponent) * (of.diffuse_over_specular * of.parameters.kd);
        }
        if VOLUME {
            let exponent = volume_exponent(points, of) + slopes.exponent;
            b = exp2(simd, exponent).mul_add(number(simd, of.volume_over_specular * of.parameters.kv), b);
        }
        let b = b * over_geometric(points, of);
        let dolp = fresnel.polarised / b.mul_add(fresnel.w_sq_z(), fresnel.h);
        ([dolp * of.dolp_gain], steepest.simd_gt(number(simd, STEEPEST)))
    }
}

/// DoLP, BRDF and its specular part; without `DOLP` the first is left out and 0.
pub(crate) struct Radiance<'a, const DOLP: bool, const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool>(pub &'a Coefficients);

impl<const DOLP: bool, const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool> Radiance<'_, DOLP, CAUCHY, DIFFUSE, VOLUME> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, points: &Points<'_, S>) -> ([V<S>; 3], Mask<S>) {
        let of = self.0;
        let fresnel = FresnelLanes::new(simd, points, of);
        let slopes = Slopes::new::<CAUCHY>(simd, points, of);
        let mut steepest = slopes.exponent;
        // S/H.
        let specular_over_h = exp2(simd, -slopes.exponent) * of.specular / (over_geometric(points, of) * fresnel.w_sq_z());
        let specular = specular_over_h * fresnel.h;
        let mut brdf = specular;
        if DIFFUSE == LAMBERT {
            brdf += of.diffuse_height * of.parameters.kd;
        } else if DIFFUSE == MINNAERT {
            let exponent = diffuse_exponent(points, of);
            steepest = steepest.max(exponent);
            brdf = exp2(simd, exponent).mul_add(number(simd, of.diffuse_height * of.parameters.kd), brdf);
        }
        if VOLUME {
            brdf = exp2(simd, volume_exponent(points, of)).mul_add(number(simd, of.volume_height * of.parameters.kv), brdf);
        }
        let dolp = if !DOLP {
            number(simd, 0.0)
        } else if DIFFUSE == NONE && !VOLUME {
            fresnel.polarised / fresnel.h
        } else {
            fresnel.polarised * specular_over_h / brdf
        };
        ([dolp * of.dolp_gain, brdf, specular], steepest.simd_gt(number(simd, STEEPEST)))
    }
}

/// BRDF alone.
pub(crate) struct Brdf<'a, const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool>(pub &'a Coefficients);

impl<const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool> Kernel<1> for Brdf<'_, CAUCHY, DIFFUSE, VOLUME> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, points: &Points<'_, S>) -> ([V<S>; 1], Mask<S>) {
        let ([_, brdf, _], needs_scalar) = Radiance::<false, CAUCHY, DIFFUSE, VOLUME>(self.0).at(simd, points);
        ([brdf], needs_scalar)
    }
}

/// DoLP, BRDF and its specular part.
pub(crate) struct Both<'a, const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool>(pub &'a Coefficients);

impl<const CAUCHY: bool, const DIFFUSE: u8, const VOLUME: bool> Kernel<3> for Both<'_, CAUCHY, DIFFUSE, VOLUME> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, points: &Points<'_, S>) -> ([V<S>; 3], Mask<S>) {
        Radiance::<true, CAUCHY, DIFFUSE, VOLUME>(self.0).at(simd, points)
    }
}
