//! Points given by their angles, prepared in vectors: the formulas of [`crate::optics::Facet`] without a point's own record.

use crate::model::Pbrdf;
use crate::model::batch::elementary::log2;
use crate::model::batch::lanes::{Instructions, Mask, V, Vectorised, choose, dispatch, number};
use crate::model::batch::prepared::{LANES, PointBlock, blocks};
use crate::model::batch::runner::radiances_of_blocks;
use crate::model::batch::trigonometry::{cos_of_quadrant, half_angle_squares, sin_of_half, sin_of_half_near_zero};
use crate::optics::{Facet, Geometry, GeometryError, RADIANS_PER_DEGREE};
use fearless_simd::prelude::*;
use std::ops::Range;

/// Points that are prepared and evaluated before the next ones: their blocks are 28 KiB.
const CHUNK: usize = 512;
/// Azimuths beyond this, in degrees, go the scalar way, which reduces them exactly.
const LARGEST_AZIMUTH: f64 = 1e6;

/// Angles of many points, column by column, in degrees: θi in [0, 90), θr in [0, 90), any finite Δφ; or θr in (−90, 0), the backscatter
/// side, where Δφ is 180.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleColumns<'a> {
    theta_i: &'a [f64],
    theta_r: &'a [f64],
    dphi: &'a [f64],
    instructions: Instructions,
}

/// Why angles are no points.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AngleColumnsError {
    /// The columns are not of one length.
    #[error("the columns of angles differ in length: {0}, {1} and {2}")]
    Lengths(usize, usize, usize),
    /// A signed θr where Δφ says another side.
    #[error("theta_r = {theta_r} with dphi = {dphi}: a negative theta_r is the backscatter side, allowed only where dphi is 180")]
    Side {
        /// Which point, counted from 0.
        point: usize,
        /// θr in degrees, negative.
        theta_r: f64,
        /// Δφ in degrees, not 180.
        dphi: f64,
    },
    /// A point has no geometry.
    #[error("{error}")]
    Point {
        /// Which point, counted from 0.
        point: usize,
        /// What is wrong with it.
        error: GeometryError,
    },
}

/// Points of columns of angles, prepared for many surfaces.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedAngles {
    angles: [Vec<f64>; 3],
    blocks: Vec<PointBlock>,
}

impl<'a> AngleColumns<'a> {
    /// Of columns.
    ///
    /// # Errors
    ///
    /// [`AngleColumnsError::Lengths`] where they are not of one length.
    pub fn new(theta_i: &'a [f64], theta_r: &'a [f64], dphi: &'a [f64]) -> Result<Self, AngleColumnsError> {
        if theta_i.len() != theta_r.len() || theta_i.len() != dphi.len() {
            return Err(AngleColumnsError::Lengths(theta_i.len(), theta_r.len(), dphi.len()));
        }
        Ok(Self { theta_i, theta_r, dphi, instructions: Instructions::Widest })
    }

    /// Prepared with other instructions than the widest that the processor has.
    #[must_use]
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { instructions, ..self }
    }

    /// How many points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.theta_i.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.theta_i.is_empty()
    }

    /// Some of the points.
    ///
    /// # Panics
    ///
    /// Where there are not so many.
    #[must_use]
    pub fn part(&self, points: Range<usize>) -> Self {
        Self { theta_i: &self.theta_i[points.clone()], theta_r: &self.theta_r[points.clone()], dphi: &self.dphi[points], ..*self }
    }

    /// The geometry of a point.
    ///
    /// # Errors
    ///
    /// [`AngleColumnsError::Point`] where an angle lies outside its range, [`AngleColumnsError::Side`] where θr is negative and Δφ not 180.
    pub fn geometry(&self, point: usize) -> Result<Geometry, AngleColumnsError> {
        let (theta_i, theta_r, dphi) = (self.theta_i[point], self.theta_r[point], self.dphi[point]);
        let geometry = if theta_r >= 0.0 || theta_r.is_nan() {
            Geometry::new(theta_i, theta_r, dphi)
        } else if dphi == 180.0 {
            Geometry::in_plane(theta_i, theta_r)
        } else {
            return Err(AngleColumnsError::Side { point, theta_r, dphi });
        };
        geometry.map_err(|error| AngleColumnsError::Point { point, error })
    }

    /// BRDF in sr⁻¹, DoLP and the specular part of the BRDF of each point, on the calling thread; as [`Pbrdf::reflection`] has them, to
    /// about 10⁻¹⁴. Nothing is kept of a point. A column that is not wanted is empty.
    ///
    /// # Errors
    ///
    /// [`AngleColumnsError::Point`] or [`AngleColumnsError::Side`] of the first point that has no geometry; [`AngleColumnsError::Lengths`] where a column is of another
    /// length.
    pub fn radiances(&self, surface: &Pbrdf, mut out: [&mut [f64]; 3]) -> Result<(), AngleColumnsError> {
        self.check_lengths(&out)?;
        let mut buffer = Vec::new();
        for first in (0..self.len()).step_by(CHUNK) {
            let points = first..self.len().min(first + CHUNK);
            let part = self.part(points.clone());
            part.prepare_into(&mut buffer, first)?;
            let columns = out.each_mut().map(|column| if column.is_empty() { &mut [] } else { &mut column[points.clone()] });
            evaluate(surface, &buffer, &part, columns);
        }
        Ok(())
    }

    /// Prepares the points.
    ///
    /// # Errors
    ///
    /// [`AngleColumnsError::Point`] or [`AngleColumnsError::Side`] of the first point that has no geometry.
    pub fn prepare(&self) -> Result<PreparedAngles, AngleColumnsError> {
        let mut blocks = Vec::new();
        self.prepare_into(&mut blocks, 0)?;
        Ok(PreparedAngles { angles: [self.theta_i, self.theta_r, self.dphi].map(<[f64]>::to_vec), blocks })
    }

    fn check_lengths(&self, columns: &[&mut [f64]; 3]) -> Result<(), AngleColumnsError> {
        match columns.iter().find(|column| !column.is_empty() && column.len() != self.len()) {
            Some(column) => Err(AngleColumnsError::Lengths(self.len(), self.len(), column.len())),
            None => Ok(()),
        }
    }

    /// The blocks of the points, of which the first one has that number.
    fn prepare_into(&self, out: &mut Vec<PointBlock>, first: usize) -> Result<(), AngleColumnsError> {
        out.resize(self.len().div_ceil(LANES), PointBlock::default());
        let mut whole = false;
        dispatch(self.instructions, Preparation { angles: self, out, whole: &mut whole });
        if !whole {
            // Angles that the vectors don't take, or that are none.
            let facets = (0..self.len()).map(|point| self.geometry(point).map(Facet::new)).collect::<Result<Vec<_>, _>>();
            *out = blocks(&facets.map_err(|error| error.moved_by(first))?);
        }
        Ok(())
    }
}

impl AngleColumnsError {
    /// The same error of a point that stands behind others.
    fn moved_by(self, first: usize) -> Self {
        match self {
            Self::Point { point, error } => Self::Point { point: first + point, error },
            Self::Side { point, theta_r, dphi } => Self::Side { point: first + point, theta_r, dphi },
            lengths @ Self::Lengths(..) => lengths,
        }
    }
}

impl PreparedAngles {
    /// The angles.
    #[must_use]
    pub fn angles(&self) -> AngleColumns<'_> {
        let [theta_i, theta_r, dphi] = &self.angles;
        AngleColumns { theta_i, theta_r, dphi, instructions: Instructions::Widest }
    }

    /// As [`AngleColumns::radiances`] has them.
    ///
    /// # Errors
    ///
    /// [`AngleColumnsError::Lengths`] where a column is of another length.
    pub fn radiances(&self, surface: &Pbrdf, out: [&mut [f64]; 3]) -> Result<(), AngleColumnsError> {
        let angles = self.angles();
        angles.check_lengths(&out)?;
        evaluate(surface, &self.blocks, &angles, out);
        Ok(())
    }
}

/// BRDF, DoLP and specular part of prepared points, whose angles are known to be some.
fn evaluate(surface: &Pbrdf, blocks: &[PointBlock], angles: &AngleColumns<'_>, [brdf, dolp, specular]: [&mut [f64]; 3]) {
    let reflection = |point: usize| angles.geometry(point).map(|geometry| surface.reflection(&Facet::new(geometry))).unwrap_or_default();
    radiances_of_blocks(surface, blocks, angles.len(), [dolp, brdf, specular], &reflection);
}

/// Preparation of all blocks; `whole` says whether vectors did for all points.
struct Preparation<'a, 'b> {
    angles: &'a AngleColumns<'b>,
    out: &'a mut [PointBlock],
    whole: &'a mut bool,
}

impl Vectorised for Preparation<'_, '_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let AngleColumns { theta_i, theta_r, dphi, .. } = *self.angles;
        let mut good = Mask::<S>::splat(simd, true);
        let whole = theta_i.len() / LANES;
        for (i, block) in self.out.iter_mut().enumerate().take(whole) {
            let at = LANES * i..LANES * (i + 1);
            good &= prepare_block(simd, [&theta_i[at.clone()], &theta_r[at.clone()], &dphi[at]], block);
        }
        if let Some(block) = self.out.get_mut(whole) {
            // Places that are left over repeat the first point.
            let padded = [theta_i, theta_r, dphi].map(|column| {
                let rest = &column[LANES * whole..];
                std::array::from_fn::<f64, LANES, _>(|lane| rest.get(lane).or(rest.first()).copied().unwrap_or_default())
            });
            good &= prepare_block(simd, [&padded[0], &padded[1], &padded[2]], block);
        }
        *self.whole = good.all_true();
    }

    fn run_scalar(self) {}
}

/// Prepares a block of points; returns where the angles of all are some. Without inlining it would be compiled for any processor.
#[inline(always)]
fn prepare_block<S: Simd>(simd: S, [theta_i, theta_r, dphi]: [&[f64]; 3], block: &mut PointBlock) -> Mask<S> {
    let mut good = Mask::<S>::splat(simd, true);
    for first in (0..LANES).step_by(V::<S>::LEN) {
        let lanes = [load(simd, theta_i, first), load(simd, theta_r, first), load(simd, dphi, first)];
        good &= prepare(simd, lanes, block, first);
    }
    good
}

/// As many numbers of a column as a vector has lanes.
#[inline(always)]
fn load<S: Simd>(simd: S, column: &[f64], first: usize) -> V<S> {
    V::<S>::from_slice(simd, &column[first..first + V::<S>::LEN])
}

/// Writes what [`Facet::new`] and [`PointBlock`] make of angles in degrees; returns where they are some.
#[inline(always)]
fn prepare<S: Simd>(simd: S, [theta_i, signed_theta_r, dphi]: [V<S>; 3], block: &mut PointBlock, first: usize) -> Mask<S> {
    let of = |value| number(simd, value);
    let behind = signed_theta_r.simd_lt(of(0.0));
    let theta_r = signed_theta_r.abs();
    let good = theta_i.simd_ge(of(0.0))
        & theta_i.simd_lt(of(90.0))
        & theta_r.simd_lt(of(90.0))
        & dphi.abs().simd_lt(of(LARGEST_AZIMUTH))
        & (signed_theta_r.simd_ge(of(0.0)) | dphi.simd_eq(of(180.0)));
    let dphi = choose::<S>(behind, of(0.0), dphi);

    let (cos_i, cos_r) = (cos_of_quadrant(simd, theta_i), cos_of_quadrant(simd, theta_r));
    let [sin_half_sq, cos_half_sq] = half_angle_squares(simd, dphi);
    let sin_p = sin_of_half(simd, theta_i + theta_r);
    let sin_m = sin_of_half_near_zero(simd, theta_i - theta_r);

    // p = (θi + θr)/2, m = (θi − θr)/2, c = (cos θi + cos θr)/2 = cos p cos m = cos β cos α, s = sin θi sin θr = sin²p − sin²m:
    // sin²β = s sin²½Δφ + sin²m, cos²β = s cos²½Δφ + c²/cos²m, tan²α = (s cos²½Δφ + c² tan²m)/c².
    let sines = (sin_p - sin_m) * (sin_p + sin_m);
    let cosines = cos_i * cos_r;
    let mean_cosine = (cos_i + cos_r) * 0.5;
    let c_sq = mean_cosine * mean_cosine;
    let sin_m_sq = sin_m * sin_m;
    // cos θi cos θr − 1 = −sin²p − sin²m.
    let cosines_minus_1 = -sin_p.mul_add(sin_p, sin_m_sq);
    let cos_m_sq = -sin_m_sq + 1.0;
    let sin_beta_sq = sines.mul_add(sin_half_sq, sin_m_sq);
    let across = sines * cos_half_sq * cos_m_sq;
    // cos²β cos²m and c² cos²m, and 1 over both by one division: neither is below 10⁻³².
    let (b, d) = (across + c_sq, c_sq * cos_m_sq);
    let inverse = of(1.0) / (b * d);
    let over_d = inverse * b;
    let cos_beta_sq = b * (over_d * c_sq);
    let tan_alpha_sq = c_sq.mul_add(sin_m_sq, across) * over_d;
    // cos²α = c²/cos²β.
    let cos_alpha_sq = d * (inverse * d);
    // cos⁴α cos θi cos θr/G = cos²α max(cos²α cos θi cos θr, ½ cos β cos α max(cos θi, cos θr)).
    let over_open = cos_alpha_sq * cosines;
    let grooves = (mean_cosine * 0.5) * cos_i.max(cos_r);

    let end = first + V::<S>::LEN;
    sin_beta_sq.store_slice(&mut block.sin_beta_sq[first..end]);
    cos_beta_sq.store_slice(&mut block.cos_beta_sq[first..end]);
    tan_alpha_sq.store_slice(&mut block.tan_alpha_sq[first..end]);
    (over_open.max(grooves) * cos_alpha_sq).store_slice(&mut block.over_geometric[first..end]);
    (over_open * cos_alpha_sq).store_slice(&mut block.over_open[first..end]);
    log2(simd, cosines, cosines_minus_1).store_slice(&mut block.log2_cosines[first..end]);
    (theta_r * theta_r * (0.5 * RADIANS_PER_DEGREE * RADIANS_PER_DEGREE)).store_slice(&mut block.half_theta_r_sq[first..end]);
    good
}
