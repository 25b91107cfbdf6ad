//! One surface fitted to the Stokes vectors of a camera's pixels, under one lamp or several.
//!
//! A lamp is distant and unpolarised, of irradiance 1 across its beam: a pixel shows S0 = cos θi · BRDF, times the unknown scale of the camera's
//! radiances, which is what k_s becomes. Half vector and angle of polarisation are the same in every pixel of a lamp; S1 and S2 are turned
//! into that plane, P = −(S1 cos 2φ + S2 sin 2φ) for a lamp at azimuth φ: it is cos θi · BRDF · DoLP, with the sign of the noise, where
//! √(S1² + S2²) would be biased upwards.
//!
//! With a million pixels the noise in a divisor matters: (X − Xm)/Xm and P/S0 are biased by its square. So the fit is made again with
//! residuals (X − Xm)/X′ and P/X′ − DoLP, X′ the BRDF of the fit before, until the values stay: it needs three rounds.

use crate::error::{refused, refused_with};
use crate::fitting::{Fitted, Outcome, Plan, Settings};
use crate::watched::{Watch, watched};
use numpy::{PyArray1, PyReadonlyArray1};
use pbrdf::fit::{Fit, FitError, FitOptions, FitResult, Intervals, Problem, Starts, Weights};
use pbrdf::measurement::{Quantity, Row};
use pbrdf::model::{Batch, Lamp, Radiances};
use pbrdf::{Measurement, Pbrdf};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Points that are evaluated at once.
const BLOCK: usize = 16_384;

/// Pixels side by side, lamp after lamp.
#[derive(FromPyObject)]
pub struct Pixels<'py> {
    /// Angle from z and from x towards y, degrees.
    lamps: Vec<(f64, f64)>,
    /// Three components for each pixel.
    normals: PyReadonlyArray1<'py, f64>,
    s0: PyReadonlyArray1<'py, f64>,
    s1: PyReadonlyArray1<'py, f64>,
    s2: PyReadonlyArray1<'py, f64>,
    used: PyReadonlyArray1<'py, bool>,
    /// The largest θi and θr, degrees.
    max_angle: f64,
}

/// A pixel under a lamp.
struct Lit {
    /// Its place in the arrays.
    place: usize,
    /// S0/cos θi and P/cos θi.
    brdf: f64,
    polarised: f64,
}

/// What is fitted.
struct Scene {
    lit: Vec<Lit>,
    measurement: Measurement,
}

impl Scene {
    fn new(lamps: &[Lamp], normals: &[f64], [s0, s1, s2]: [&[f64]; 3], used: &[bool], max_angle: f64) -> Self {
        let pixels = normals.len() / 3;
        let point = |place: usize| {
            let (lamp, pixel) = (&lamps[place / pixels], place % pixels);
            let normal = [normals[3 * pixel], normals[3 * pixel + 1], normals[3 * pixel + 2]];
            let geometry = lamp.geometry(normal)?;
            if !(geometry.theta_i().0 <= max_angle && geometry.theta_r().0 <= max_angle) {
                return None;
            }
            let cos_i = lamp.cos_incidence(normal);
            let (sin, cos) = pbrdf::optics::Degrees(2.0 * lamp.azimuth().0).sin_cos();
            let brdf = s0[place] / cos_i;
            let polarised = -(s1[place] * cos + s2[place] * sin) / cos_i;
            let quantity = |value: f64| Some(Quantity { value, sigma: None });
            let row = Row { geometry, dolp: quantity(polarised / brdf), brdf: quantity(brdf), masked: false };
            Some((Lit { place, brdf, polarised }, row))
        };
        let points = (0..lamps.len() * pixels).into_par_iter().filter(|&place| used[place]);
        let (lit, rows) = points.filter_map(point).unzip();
        Self { lit, measurement: Measurement { rows, ..Measurement::default() } }
    }

    /// BRDF and DoLP of a surface at the rows.
    fn predicted(&self, surface: &Pbrdf) -> (Vec<f64>, Vec<f64>) {
        let blocks = self.measurement.rows.par_chunks(BLOCK).map(|rows| {
            let mut radiances = Radiances::default();
            Batch::new(rows.iter().map(|row| row.geometry)).radiances(surface, &mut radiances);
            (radiances.brdf.clone(), radiances.dolp.clone())
        });
        let blocks: Vec<(Vec<f64>, Vec<f64>)> = blocks.collect();
        let brdf = blocks.iter().flat_map(|block| block.0.iter().copied()).collect();
        (brdf, blocks.iter().flat_map(|block| block.1.iter().copied()).collect())
    }

    /// Residuals of BRDF and DoLP in units of the BRDF that is predicted.
    fn residuals(&self, (brdf, dolp): &(Vec<f64>, Vec<f64>)) -> [Vec<f64>; 2] {
        let of_brdf = self.lit.iter().zip(brdf).map(|(lit, brdf)| lit.brdf / brdf - 1.0).collect();
        let of_dolp = self.lit.iter().zip(brdf).zip(dolp).map(|((lit, brdf), dolp)| lit.polarised / brdf - dolp).collect();
        [of_brdf, of_dolp]
    }

    /// Weighs the rows by what is predicted and how far they are from it.
    fn weigh(&mut self, brdf: &[f64], noise: [f64; 2]) {
        for ((lit, row), &brdf) in self.lit.iter().zip(&mut self.measurement.rows).zip(brdf) {
            row.brdf = Some(Quantity { value: lit.brdf, sigma: Some(noise[0] * brdf) });
            row.dolp = Some(Quantity { value: lit.polarised / brdf, sigma: Some(noise[1]) });
        }
    }
}

/// Root mean square of residuals; a picture without noise has that of its last digits.
#[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
fn spread(residuals: &[f64]) -> f64 {
    let sum: f64 = residuals.iter().map(|residual| residual * residual).sum();
    (sum / residuals.len().max(1) as f64).sqrt().max(1e-12)
}

/// What comes of pixels: the fit, noise of BRDF and DoLP relative to the BRDF, the places of the pixels that were fitted, and their residuals.
type PixelFit<'py> = (Fitted, [f64; 2], Bound<'py, PyArray1<i64>>, [Bound<'py, PyArray1<f64>>; 2]);

/// Fits a surface to pixels.
#[pyfunction]
pub fn fit_pixels<'py>(py: Python<'py>, pixels: Pixels<'py>, settings: Settings, progress: Option<Py<PyAny>>) -> PyResult<PixelFit<'py>> {
    let plan = Plan::new(settings)?;
    let lamps = pixels.lamps.iter().map(|&(polar, azimuth)| Lamp::new(polar, azimuth)).collect::<Result<Vec<_>, _>>().map_err(refused)?;
    let (normals, used) = (pixels.normals.as_slice()?, pixels.used.as_slice()?);
    let stokes = [pixels.s0.as_slice()?, pixels.s1.as_slice()?, pixels.s2.as_slice()?];
    if stokes.iter().any(|column| column.len() != lamps.len() * (normals.len() / 3)) || used.len() != stokes[0].len() {
        return Err(refused("the arrays of pixels differ in length"));
    }
    let max_angle = pixels.max_angle;
    let found = watched(py, progress.as_ref(), |watch| {
        let scene = Scene::new(&lamps, normals, stokes, used, max_angle);
        fitted(&plan, scene, watch)
    })?;
    let (scene, problem, result, noise, residuals) = found.map_err(|error| refused_with(&error, error.hint()))?;
    let places = scene.lit.iter().map(|lit| i64::try_from(lit.place).unwrap_or(i64::MAX)).collect();
    let fitted = Fitted { outcome: Outcome::Single(Box::new((problem, result))), preset: plan.preset };
    Ok((fitted, noise, PyArray1::from_vec(py, places), residuals.map(|column| PyArray1::from_vec(py, column))))
}

/// A finished fit, its noise and its residuals.
type Finished = (Scene, Problem, FitResult, [f64; 2], [Vec<f64>; 2]);

fn fitted(plan: &Plan, mut scene: Scene, watch: &Watch<'_>) -> Result<Finished, FitError> {
    let problem = plan.describe(Fit::new(&scene.measurement, plan.preset.model), "").problem()?;
    let result = watch.observe(|observer| pbrdf::fit::fit(&problem, plan.starts, plan.seed, observer)).without_errors();
    drop(problem);
    let (_, result, _) = round(plan, &mut scene, &result, Intervals::None, watch)?;
    let (problem, result, noise) = round(plan, &mut scene, &result, plan.intervals, watch)?;
    let residuals = scene.residuals(&scene.predicted(&Pbrdf::new(result.model, result.parameters)?));
    Ok((scene, problem, result, noise, residuals))
}

/// A fit from where the last one ended, with weights by its predictions; the noise that they suppose.
fn round(
    plan: &Plan,
    scene: &mut Scene,
    last: &FitResult,
    intervals: Intervals,
    watch: &Watch<'_>,
) -> Result<(Problem, FitResult, [f64; 2]), FitError> {
    let predicted = scene.predicted(&Pbrdf::new(last.model, last.parameters)?);
    let noise = scene.residuals(&predicted).each_ref().map(|column| spread(column));
    scene.weigh(&predicted.0, noise);
    drop(predicted);
    let problem = again(plan, scene, last)?;
    let result = watch.observe(|observer| {
        let result = pbrdf::fit::fit(&problem, Starts::One, plan.seed, observer);
        match intervals {
            Intervals::Profile => pbrdf::fit::with_intervals(&problem, result, observer),
            Intervals::Linear => result,
            Intervals::None => result.without_errors(),
        }
    });
    Ok((problem, result, noise))
}

/// The problem of the next round, from where the last one ended, with the weights of the rows.
fn again(plan: &Plan, scene: &Scene, result: &FitResult) -> Result<Problem, FitError> {
    let fit = plan.describe(Fit::new(&scene.measurement, plan.preset.model), "");
    let fit = fit.options(FitOptions { weights: Weights::Sigma, ..plan.options });
    let free = result.estimates.iter().filter(|estimate| estimate.free);
    free.fold(fit, |fit, estimate| fit.start(estimate.parameter, estimate.value)).problem()
}
