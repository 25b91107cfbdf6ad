//! The misfit of DoLP for many surfaces that differ in one parameter: surfaces in the lanes, point after point.
//!
//! What the parameter does not change is computed once for a point: the Fresnel reflection unless it is n or k, the fall of the
//! specular lobe unless it is σ or q, the other lobes unless it is c or σ_v.

use crate::model::batch::coefficients::Coefficients;
use crate::model::batch::elementary::{exp2, log2_1p};
use crate::model::batch::kernels::{FresnelLanes, IndexLanes, STEEPEST};
use crate::model::batch::lanes::{Instructions, V, Vectorised, choose, dispatch, number};
use crate::model::batch::prepared::LANES;
use crate::model::{Diffuse, Model, Parameter, Parameters, Pbrdf};
use crate::optics::{Facet, Masking, SlopeDistribution};
use fearless_simd::prelude::*;
use std::f64::consts::LOG2_E;

/// A measured DoLP at a facet, and what the difference is multiplied by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeasuredDolp<'a> {
    pub facet: &'a Facet,
    pub measured: f64,
    pub weight: f64,
}

/// As many surfaces as a block has places, column by column.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct SurfaceBlock {
    excess: [f64; LANES],
    excess_size: [f64; LANES],
    n_sq: [f64; LANES],
    difference: [f64; LANES],
    nk: [f64; LANES],
    two_nk_sq: [f64; LANES],
    half_over_sigma_sq: [f64; LANES],
    q: [f64; LANES],
    c: [f64; LANES],
    volume_fall: [f64; LANES],
    /// k_d F^d and k_v F^v without their exponentials, over the specular lobe without H 2^(−x)/(W² Z g).
    diffuse: [f64; LANES],
    volume: [f64; LANES],
    gain: [f64; LANES],
}

impl SurfaceBlock {
    /// Places that are left over repeat the first surface.
    fn new(surfaces: &[Coefficients]) -> Self {
        let mut block = Self {
            excess: [0.0; LANES],
            excess_size: [0.0; LANES],
            n_sq: [0.0; LANES],
            difference: [0.0; LANES],
            nk: [0.0; LANES],
            two_nk_sq: [0.0; LANES],
            half_over_sigma_sq: [0.0; LANES],
            q: [0.0; LANES],
            c: [0.0; LANES],
            volume_fall: [0.0; LANES],
            diffuse: [0.0; LANES],
            volume: [0.0; LANES],
            gain: [0.0; LANES],
        };
        for lane in 0..LANES {
            if let Some(of) = surfaces.get(lane).or(surfaces.first()) {
                block.put(lane, of);
            }
        }
        block
    }

    fn put(&mut self, lane: usize, of: &Coefficients) {
        self.excess[lane] = of.index.excess;
        self.excess_size[lane] = of.index.excess_size;
        self.n_sq[lane] = of.index.n_sq;
        self.difference[lane] = of.index.difference;
        self.nk[lane] = of.index.nk;
        self.two_nk_sq[lane] = of.index.two_nk_sq;
        self.half_over_sigma_sq[lane] = of.half_over_sigma_sq;
        self.q[lane] = of.parameters.q;
        // Lambert's lobe has the exponent 0.
        self.c[lane] = if of.model.diffuse == Diffuse::Minnaert { of.parameters.c } else { 0.0 };
        self.volume_fall[lane] = of.volume_fall;
        self.diffuse[lane] = if of.has_diffuse() { of.diffuse_over_specular * of.parameters.kd } else { 0.0 };
        self.volume[lane] = if of.model.volume { of.volume_over_specular * of.parameters.kv } else { 0.0 };
        self.gain[lane] = of.dolp_gain;
    }
}

/// `Σ (w (X − Xm))²` for the surface of those parameters with each of the values of one parameter; NaN where only the scalar form evaluates a surface. None for
/// a model without lanes.
pub(crate) fn dolp_misfits(
    data: &[MeasuredDolp<'_>],
    model: Model,
    parameters: &Parameters,
    parameter: Parameter,
    values: &[f64],
) -> Option<Vec<f64>> {
    let coefficients = |&value: &f64| {
        let mut parameters = *parameters;
        parameters[parameter] = value;
        Pbrdf::new(model, parameters).ok().and_then(|surface| Coefficients::new(&surface))
    };
    // Of surfaces that differ in their index the rest is formed once.
    let base = if matches!(parameter, Parameter::N | Parameter::K) { values.iter().find_map(coefficients) } else { None };
    let all: Vec<Option<Coefficients>> = match &base {
        Some(base) => values.iter().map(|&value| base.with_index(parameter, value)).collect(),
        None => values.iter().map(coefficients).collect(),
    };
    let first = *all.iter().flatten().next()?;
    let filled: Vec<Coefficients> = all.iter().map(|one| one.unwrap_or(first)).collect();
    let blocks: Vec<SurfaceBlock> = filled.chunks(LANES).map(SurfaceBlock::new).collect();
    let mut sums = vec![[0.0; LANES]; blocks.len()];
    let is_cauchy = model.distribution == SlopeDistribution::Cauchy;
    let row = Row { data, blocks: &blocks, sums: &mut sums, parameter, is_cauchy, is_masked: model.masking == Masking::VGroove };
    dispatch(Instructions::default(), row);
    let misfit = |(place, one): (usize, &Option<Coefficients>)| one.map_or(f64::NAN, |_| sums[place / LANES][place % LANES]);
    Some(all.iter().enumerate().map(misfit).collect())
}

/// A row of surfaces under way.
struct Row<'a> {
    data: &'a [MeasuredDolp<'a>],
    blocks: &'a [SurfaceBlock],
    sums: &'a mut [[f64; LANES]],
    parameter: Parameter,
    is_cauchy: bool,
    is_masked: bool,
}

/// As many surfaces as a vector has lanes.
struct SurfaceLanes<'a, S: Simd> {
    simd: S,
    block: &'a SurfaceBlock,
    first: usize,
}

impl<S: Simd> SurfaceLanes<'_, S> {
    #[inline(always)]
    fn load(&self, column: impl Fn(&SurfaceBlock) -> &[f64; LANES]) -> V<S> {
        V::<S>::from_slice(self.simd, &column(self.block)[self.first..self.first + V::<S>::LEN])
    }

    #[inline(always)]
    fn fresnel(&self, facet: &Facet) -> (V<S>, V<S>, V<S>) {
        let index = IndexLanes {
            excess: self.load(|block| &block.excess),
            excess_size: self.load(|block| &block.excess_size),
            n_sq: self.load(|block| &block.n_sq),
            difference: self.load(|block| &block.difference),
            nk: self.load(|block| &block.nk),
            two_nk_sq: self.load(|block| &block.two_nk_sq),
        };
        let [sin_sq, cos_sq] = [facet.sin_beta_sq, facet.cos_beta_sq].map(|value| number(self.simd, value));
        let lanes = FresnelLanes::of(self.simd, sin_sq, cos_sq, &index);
        (lanes.polarised, lanes.h, lanes.w_sq_z())
    }

    /// x: the specular lobe falls as 2^(−x).
    #[inline(always)]
    fn fall(&self, facet: &Facet, is_cauchy: bool) -> V<S> {
        let w = self.load(|block| &block.half_over_sigma_sq) * facet.tan_alpha_sq;
        if is_cauchy { log2_1p(self.simd, w) * self.load(|block| &block.q) } else { w * LOG2_E }
    }

    /// Exponents of the diffuse and the volume lobe.
    #[inline(always)]
    fn lobes(&self, facet: &Facet) -> [V<S>; 2] {
        [
            self.load(|block| &block.c) * (facet.ln_cosines * LOG2_E),
            self.load(|block| &block.volume_fall) * (0.5 * facet.theta_r * facet.theta_r),
        ]
    }
}

impl Row<'_> {
    #[inline(always)]
    fn add_point<S: Simd>(&mut self, simd: S, point: &MeasuredDolp<'_>) {
        let facet = point.facet;
        let by_index = matches!(self.parameter, Parameter::N | Parameter::K);
        let by_slope = matches!(self.parameter, Parameter::Sigma | Parameter::Q);
        let by_lobe = matches!(self.parameter, Parameter::C | Parameter::SigmaV);
        let one_over_cos_sq = 1.0 + facet.tan_alpha_sq;
        let g = if self.is_masked { facet.g_over_cosines } else { facet.one_over_cosines };
        let over_geometric = 1.0 / (one_over_cos_sq * one_over_cos_sq * g);
        let steepest = number(simd, STEEPEST);
        let Some(block) = self.blocks.first() else { return };
        let same = SurfaceLanes { simd, block, first: 0 };
        let (fresnel, fall, lobes) = (same.fresnel(facet), same.fall(facet, self.is_cauchy), same.lobes(facet));
        let (rise, [diffuse, volume]) = (exp2(simd, fall), lobes.map(|exponent| exp2(simd, exponent)));
        for (block, sums) in self.blocks.iter().zip(self.sums.iter_mut()) {
            for first in (0..LANES).step_by(V::<S>::LEN) {
                let lanes = SurfaceLanes { simd, block, first };
                let (polarised, h, w_sq_z) = if by_index { lanes.fresnel(facet) } else { fresnel };
                let (mut highest, mut rise) = (fall, rise);
                if by_slope {
                    highest = lanes.fall(facet, self.is_cauchy);
                    rise = exp2(simd, highest);
                }
                let ([mut diffuse, mut volume], mut bent) = ([diffuse, volume], lobes);
                if by_lobe {
                    bent = lanes.lobes(facet);
                    [diffuse, volume] = bent.map(|exponent| exp2(simd, exponent));
                }
                let added = diffuse.mul_add(lanes.load(|block| &block.diffuse), volume * lanes.load(|block| &block.volume));
                let b = rise * added * over_geometric;
                let dolp = polarised / b.mul_add(w_sq_z, h) * lanes.load(|block| &block.gain);
                let residual = (dolp - point.measured) * point.weight;
                let sum = V::<S>::from_slice(simd, &sums[first..first + V::<S>::LEN]);
                let is_steep = highest.max(highest + bent[0]).max(bent[0]).simd_gt(steepest);
                choose::<S>(is_steep, number(simd, f64::NAN), residual.mul_add(residual, sum))
                    .store_slice(&mut sums[first..first + V::<S>::LEN]);
            }
        }
    }
}

impl Vectorised for Row<'_> {
    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) {
        for point in self.data {
            self.add_point(simd, point);
        }
    }

    fn run_scalar(self) {
        self.sums.iter_mut().for_each(|sums| *sums = [f64::NAN; LANES]);
    }
}
