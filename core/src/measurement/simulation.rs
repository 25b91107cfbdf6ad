//! Simulated measurements: the model's values with seeded Gaussian noise.
//!
//! The same seed gives the same numbers on every platform: the generator (PCG XSL RR 128/64) is
//! specified to the bit, and deviates and model use the elementary functions of `libm`.

use crate::measurement::{Measurement, Quantity, Row, unwatched};
use crate::model::{GeometrySet, Parameters, Pbrdf};
use crate::optics::{Geometry, GeometryError};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// Geometries that are simulated at once: a multiple of the lanes of any kernel.
const BLOCK: usize = 65_536;

/// Which quantities a simulation writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Columns {
    /// DoLP alone.
    Dolp,
    /// BRDF alone.
    Brdf,
    /// Both.
    Both,
}

/// What to simulate.
#[derive(Debug, Clone)]
pub struct Simulation {
    /// Name of the model, for the metadata.
    pub model_name: String,
    /// The surface.
    pub surface: Pbrdf,
    /// Angles of incidence in degrees.
    pub theta_i: Vec<f64>,
    /// Angles of view in degrees; negative is the backscatter side, allowed only with Δφ = 180.
    pub theta_r: Vec<f64>,
    /// Relative azimuth in degrees.
    pub dphi: f64,
    /// Which quantities.
    pub columns: Columns,
    /// Standard deviation of the noise in DoLP, absolute; the result is clipped to 0…1.
    pub noise: f64,
    /// Standard deviation of the noise in BRDF, relative to its value; the result is clipped to ≥
    /// 0.
    pub brdf_noise: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// Every θr for every θi, in degrees. A negative θr is the backscatter side, allowed only with Δφ =
/// 180.
///
/// # Errors
/// An angle is outside its range.
pub fn grid_geometries(theta_i: &[f64], theta_r: &[f64], dphi: f64) -> Result<Vec<Geometry>, GeometryError> {
    let mut geometries = Vec::with_capacity(theta_i.len() * theta_r.len());
    for &theta_i in theta_i {
        for &theta_r in theta_r {
            let in_plane = theta_r < 0.0 && dphi == 180.0;
            geometries.push(if in_plane { Geometry::in_plane(theta_i, theta_r) } else { Geometry::new(theta_i, theta_r, dphi) }?);
        }
    }
    Ok(geometries)
}

impl Simulation {
    /// The geometries, row after row of θr for each θi.
    ///
    /// # Errors
    /// An angle is outside its range.
    pub fn geometries(&self) -> Result<Vec<Geometry>, GeometryError> {
        grid_geometries(&self.theta_i, &self.theta_r, self.dphi)
    }

    /// Simulates the measurement, in the order of the geometries.
    ///
    /// # Errors
    /// An angle is outside its range.
    pub fn run(&self) -> Result<Measurement, GeometryError> {
        self.run_with(&mut unwatched).map(Option::unwrap_or_default)
    }

    /// The same; tells which fraction is done, from 0 to 1, now and then, and is none where it is told to stop.
    ///
    /// # Errors
    /// An angle is outside its range.
    pub fn run_with(&self, watch: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Option<Measurement>, GeometryError> {
        Ok(self.run_at(&self.geometries()?, watch))
    }

    /// The same at other geometries than its own, in their order.
    pub fn run_at(&self, geometries: &[Geometry], watch: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Option<Measurement> {
        let mut deviates = Deviates::new(self.seed);
        let mut rows = Vec::with_capacity(geometries.len());
        for block in geometries.chunks(BLOCK) {
            #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress line")]
            if watch(rows.len() as f64 / geometries.len() as f64).is_break() {
                return None;
            }
            self.simulate(block, &mut deviates, &mut rows);
        }
        Some(Measurement { rows, metadata: self.metadata(), ..Measurement::default() })
    }

    /// Adds the rows of those geometries.
    fn simulate(&self, geometries: &[Geometry], deviates: &mut Deviates, rows: &mut Vec<Row>) {
        let scene = GeometrySet::new(geometries.iter().copied());
        rows.extend(geometries.iter().zip(scene.reflections(&self.surface)).map(|(&geometry, reflection)| {
            let (z_dolp, z_brdf) = deviates.pair();
            let noisy_dolp = (reflection.dolp + self.noise * z_dolp).clamp(0.0, 1.0);
            let dolp = Quantity { value: noisy_dolp, sigma: positive(self.noise) };
            let brdf_sigma = self.brdf_noise * reflection.brdf;
            let brdf = Quantity { value: (reflection.brdf + brdf_sigma * z_brdf).max(0.0), sigma: positive(brdf_sigma) };
            Row {
                geometry,
                dolp: (self.columns != Columns::Brdf).then_some(dolp),
                brdf: (self.columns != Columns::Dolp).then_some(brdf),
                masked: false,
            }
        }));
    }

    /// Metadata: that the rows are simulated, the model, its parameters, the noise and the seed.
    fn metadata(&self) -> Vec<(String, String)> {
        let model = self.surface.model();
        let parameters: &Parameters = self.surface.parameters();
        let mut lines = vec![("simulated".to_owned(), "true".to_owned()), ("model".to_owned(), self.model_name.clone())];
        lines.extend(model.parameters().iter().map(|parameter| (parameter.key().to_owned(), parameters[parameter].to_string())));
        lines.push(("noise".to_owned(), self.noise.to_string()));
        lines.push(("brdf_noise".to_owned(), self.brdf_noise.to_string()));
        lines.push(("seed".to_owned(), self.seed.to_string()));
        lines
    }
}

fn positive(sigma: f64) -> Option<f64> {
    (sigma > 0.0).then_some(sigma)
}

/// Pairs of independent standard normal deviates (Box and Muller, Ann. Math. Stat. 29, 610 (1958)).
#[derive(Debug, Clone)]
pub(crate) struct Deviates(Pcg64);

impl Deviates {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    pub(crate) fn pair(&mut self) -> (f64, f64) {
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        let angle = 2.0 * PI * self.uniform();
        (radius * libm::cos(angle), radius * libm::sin(angle))
    }

    /// Uniform in (0, 1], in steps of 2⁻⁵³.
    pub(crate) fn uniform(&mut self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit an f64 exactly")]
        let steps = ((self.0.next_u64() >> 11) + 1) as f64;
        steps / 9_007_199_254_740_992.0
    }
}
