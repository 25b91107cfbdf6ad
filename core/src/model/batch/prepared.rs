//! Prepared geometries in blocks: what the kernels need of a point, column by column.

use crate::optics::Facet;
use std::f64::consts::LOG2_E;

/// Points in a [`PointBlock`]: the widest vector, of AVX-512.
pub(crate) const LANES: usize = 8;

/// Eight points, side by side. One cache line a column.
#[derive(Debug, Clone, PartialEq, Default)]
#[repr(align(64))]
pub(crate) struct PointBlock {
    pub sin_beta_sq: [f64; LANES],
    pub cos_beta_sq: [f64; LANES],
    pub tan_alpha_sq: [f64; LANES],
    /// cos⁴α cos θi cos θr/G: by what the specular lobe is divided.
    pub over_geometric: [f64; LANES],
    /// The same without masking–shadowing, G = 1.
    pub over_open: [f64; LANES],
    /// log₂(cos θi cos θr).
    pub log2_cosines: [f64; LANES],
    /// θr²/2, in radians squared.
    pub half_theta_r_sq: [f64; LANES],
}

/// What the columns of a [`PointBlock`] hold of one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BlockPoint {
    pub sin_beta_sq: f64,
    pub cos_beta_sq: f64,
    pub tan_alpha_sq: f64,
    pub over_geometric: f64,
    pub over_open: f64,
    pub log2_cosines: f64,
    pub half_theta_r_sq: f64,
}

impl From<&Facet> for BlockPoint {
    fn from(facet: &Facet) -> Self {
        Self {
            sin_beta_sq: facet.sin_beta_sq,
            cos_beta_sq: facet.cos_beta_sq,
            tan_alpha_sq: facet.tan_alpha_sq,
            over_geometric: over(facet.tan_alpha_sq, facet.g_over_cosines),
            over_open: over(facet.tan_alpha_sq, facet.one_over_cosines),
            log2_cosines: facet.ln_cosines * LOG2_E,
            half_theta_r_sq: 0.5 * facet.theta_r * facet.theta_r,
        }
    }
}

impl PointBlock {
    /// Up to a block of points; places that are left over repeat the first one.
    fn new<T>(points: &[T]) -> Self
    where
        BlockPoint: for<'a> From<&'a T>,
    {
        let points: [Option<BlockPoint>; LANES] = std::array::from_fn(|lane| points.get(lane).or(points.first()).map(BlockPoint::from));
        let column = |of: fn(&BlockPoint) -> f64| points.each_ref().map(|point| point.as_ref().map_or(0.0, of));
        Self {
            sin_beta_sq: column(|point| point.sin_beta_sq),
            cos_beta_sq: column(|point| point.cos_beta_sq),
            tan_alpha_sq: column(|point| point.tan_alpha_sq),
            over_geometric: column(|point| point.over_geometric),
            over_open: column(|point| point.over_open),
            log2_cosines: column(|point| point.log2_cosines),
            half_theta_r_sq: column(|point| point.half_theta_r_sq),
        }
    }
}

impl From<&BlockPoint> for BlockPoint {
    fn from(point: &Self) -> Self {
        *point
    }
}

/// cos⁴α over G/(cos θi cos θr).
pub(crate) fn over(tan_alpha_sq: f64, g_over_cosines: f64) -> f64 {
    let one_over_cos_sq = 1.0 + tan_alpha_sq;
    1.0 / (one_over_cos_sq * one_over_cos_sq * g_over_cosines)
}

/// All points in blocks.
pub(crate) fn blocks<T>(points: &[T]) -> Vec<PointBlock>
where
    BlockPoint: for<'a> From<&'a T>,
{
    points.chunks(LANES).map(PointBlock::new).collect()
}
