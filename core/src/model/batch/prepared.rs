//! Prepared geometries in blocks: what the kernels need of a point, column by column.

use crate::optics::Facet;

/// Points in a [`PointBlock`]: the widest vector, of AVX-512.
pub(crate) const LANES: usize = 8;

/// Eight points, side by side. One cache line a column.
#[derive(Debug, Clone, PartialEq)]
#[repr(align(64))]
pub(crate) struct PointBlock {
    pub sin_beta_sq: [f64; LANES],
    pub cos_beta_sq: [f64; LANES],
    pub cos_beta: [f64; LANES],
    pub tan_alpha_sq: [f64; LANES],
    /// cos⁴α cos θi cos θr/G: by what the specular lobe is divided.
    pub over_geometric: [f64; LANES],
    /// The same without masking–shadowing, G = 1.
    pub over_open: [f64; LANES],
    /// ln(cos θi cos θr).
    pub ln_cosines: [f64; LANES],
    /// θr²/2, in radians squared.
    pub half_theta_r_sq: [f64; LANES],
}

impl PointBlock {
    /// Up to block points; places that are left over repeat the first one.
    fn new(facets: &[Facet]) -> Self {
        let column = |of: fn(&Facet) -> f64| std::array::from_fn(|lane| facets.get(lane).or(facets.first()).map_or(0.0, of));
        Self {
            sin_beta_sq: column(|facet| facet.sin_beta_sq),
            cos_beta_sq: column(|facet| facet.cos_beta_sq),
            cos_beta: column(|facet| facet.cos_beta),
            tan_alpha_sq: column(|facet| facet.tan_alpha_sq),
            over_geometric: column(|facet| over(facet, facet.g_over_cosines)),
            over_open: column(|facet| over(facet, facet.one_over_cosines)),
            ln_cosines: column(|facet| facet.ln_cosines),
            half_theta_r_sq: column(|facet| 0.5 * facet.theta_r * facet.theta_r),
        }
    }
}

fn over(facet: &Facet, g_over_cosines: f64) -> f64 {
    let one_over_cos_sq = 1.0 + facet.tan_alpha_sq;
    1.0 / (one_over_cos_sq * one_over_cos_sq * g_over_cosines)
}

/// All points in blocks.
pub(crate) fn blocks(facets: &[Facet]) -> Vec<PointBlock> {
    facets.chunks(LANES).map(PointBlock::new).collect()
}
