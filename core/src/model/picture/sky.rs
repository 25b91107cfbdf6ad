//! What a surface shows under a uniform, unpolarised sky of radiance 1, by the zenith angle of the camera.
//!
//! In the frame of the normal nothing else counts: S0(θr) and S1(θr) in the meridian basis, S2 = 0. Diffuse and volume term have closed forms;
//! the specular term is a [`FacetMean`] at nodes `θr = 90° z (2 − z)` of even z, closer towards the limb, between which a cubic leads through the
//! four nearest.

use crate::model::facet_mean::FacetMean;
use crate::model::map_parallel::map_parallel;
use crate::model::reflectance::minnaert;
use crate::model::terms::Diffuse;
use crate::model::{Pbrdf, lost_by_single_reflection};
use crate::optics::{Degrees, Order};
use std::f64::consts::PI;

/// How finely the light of the sky is summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Quality {
    /// For files: 193 nodes, errors below 10⁻⁶ for σ ≥ 0.1.
    #[default]
    Fine,
    /// For pictures that move: 49 nodes, errors below 10⁻³.
    Fast,
}

/// The last node, in degrees: the table goes on flat to the limb.
const LAST: f64 = 89.99;

/// The light of the sky on one surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyTable {
    surface: Pbrdf,
    /// Specular S0 and S1 at the nodes.
    nodes: Vec<[f64; 2]>,
    /// What of the diffuse term does not depend on θr.
    diffuse: f64,
}

impl SkyTable {
    /// Of a surface. The nodes are shared among threads.
    #[must_use]
    pub fn new(surface: &Pbrdf, quality: Quality) -> Self {
        let (model, p) = (surface.model(), surface.parameters());
        let (count, order) = match quality {
            Quality::Fine => (193, Order::Fine),
            Quality::Fast => (49, Order::Coarse),
        };
        let node = |index: usize| {
            let mean = FacetMean::new(surface, Degrees(node(index, count).min(LAST)), order);
            [p.ks * mean.reflected, p.ks * mean.polarised]
        };
        let nodes = if model.specular { map_parallel(count, &node) } else { vec![[0.0; 2]; count] };
        let diffuse = match model.diffuse {
            Diffuse::Absent => 0.0,
            Diffuse::Lambert => p.kd,
            // (cos θi cos θr)^c/π over cos θi dω, without the power of cos θr.
            Diffuse::Minnaert => p.kd * minnaert(Degrees(0.0), p.c),
            Diffuse::Hyde if model.specular => p.ks * mean_loss(surface, order),
            Diffuse::Hyde => 0.0,
        };
        Self { surface: *surface, nodes, diffuse }
    }

    /// S0 and S1 towards a camera at that zenith angle, 0 to 90 degrees. S1 is positive for light that swings across the meridian plane.
    #[must_use]
    pub fn at(&self, theta_r: f64) -> [f64; 2] {
        let [specular, polarised] = self.specular(theta_r);
        [specular + self.depolarised(Degrees(theta_r)), polarised]
    }

    /// Diffuse and volume term.
    fn depolarised(&self, theta_r: Degrees) -> f64 {
        let (model, p) = (self.surface.model(), self.surface.parameters());
        let diffuse = match model.diffuse {
            Diffuse::Minnaert if self.diffuse > 0.0 => self.diffuse * libm::pow(theta_r.cos(), p.c),
            _ => self.diffuse,
        };
        let width = theta_r.radians() / p.sigma_v;
        let volume = if model.volume { p.kv * PI * libm::exp(-0.5 * width * width) / ((2.0 * PI).sqrt() * p.sigma_v) } else { 0.0 };
        diffuse + volume
    }

    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of nodes")]
    fn specular(&self, theta_r: f64) -> [f64; 2] {
        let last = self.nodes.len() - 1;
        let place = (1.0 - (1.0 - (theta_r / 90.0).clamp(0.0, 1.0)).sqrt()) * last as f64;
        let first = (place as usize).clamp(1, last - 2) - 1;
        let x = place - first as f64;
        // Lagrange's cubic through 0, 1, 2, 3.
        let weights = [
            -(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0,
            x * (x - 2.0) * (x - 3.0) / 2.0,
            -x * (x - 1.0) * (x - 3.0) / 2.0,
            x * (x - 1.0) * (x - 2.0) / 6.0,
        ];
        let mut sums = [0.0; 2];
        for (weight, node) in weights.iter().zip(&self.nodes[first..]) {
            sums[0] += weight * node[0];
            sums[1] += weight * node[1];
        }
        sums
    }
}

/// θr of a node in degrees.
#[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
fn node(index: usize, count: usize) -> f64 {
    let z = index as f64 / (count - 1) as f64;
    90.0 * z * (2.0 - z)
}

/// `∫ (1 − ρ(θi))/π cos θi dω` of Hyde's term, for unit k_s.
fn mean_loss(surface: &Pbrdf, order: Order) -> f64 {
    let loss = |theta: Degrees| lost_by_single_reflection(surface.model(), surface.parameters(), theta);
    order
        .between(0.0, 90.0)
        .map(|(theta, weight)| weight * Degrees(1.0).radians() * loss(Degrees(theta)) * Degrees(2.0 * theta).sin())
        .sum()
}
