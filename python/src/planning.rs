//! Measurements simulated, and angles chosen.

use crate::error::refused;
use crate::measurement::Measurement;
use crate::names::{choice, parameter, preset, surface};
use crate::surface::geometry;
use crate::watched::watched;
use pbrdf::fit::{AngleChoice, CandidateGrid, Design, DesignCriterion, NoiseModel, choose};
use pbrdf::measurement::Simulation;
use pbrdf::model::{Parameter, ParameterSet, Parameters};
use pyo3::prelude::*;

/// What is simulated: every θr for every θi, in degrees.
#[derive(FromPyObject)]
pub struct Scene {
    model: String,
    parameters: Vec<(String, f64)>,
    theta_i: Vec<f64>,
    theta_r: Vec<f64>,
    dphi: f64,
    columns: String,
    noise: f64,
    brdf_noise: f64,
    seed: u64,
}

/// A standard deviation, 0 or more.
fn check_noise(name: &str, value: f64) -> PyResult<()> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(refused(format_args!("{name} = {value}; expected a standard deviation of 0 or more")))
}

/// A measurement of a surface with seeded noise.
#[pyfunction]
pub fn simulate(py: Python<'_>, scene: Scene) -> PyResult<Measurement> {
    check_noise("noise", scene.noise)?;
    check_noise("brdf_noise", scene.brdf_noise)?;
    let preset = preset(&scene.model)?;
    if preset.dolp_only && scene.columns != "dolp" {
        return Err(refused(format_args!("the model {} predicts DoLP only, not a BRDF; simulate columns=\"dolp\"", preset.key)));
    }
    let simulation = Simulation {
        model_name: preset.key.to_owned(),
        surface: surface(&scene.model, &scene.parameters)?,
        theta_i: scene.theta_i,
        theta_r: scene.theta_r,
        dphi: scene.dphi,
        columns: choice("columns", &scene.columns)?,
        noise: scene.noise,
        brdf_noise: scene.brdf_noise,
        seed: scene.seed,
    };
    let measurement = py.detach(|| simulation.run()).map_err(refused)?;
    Ok(Measurement { measurement })
}

/// Which angles are asked for.
#[derive(FromPyObject)]
pub struct Request {
    model: String,
    surfaces: Vec<Vec<(String, f64)>>,
    theta_i: Vec<f64>,
    theta_r: Vec<f64>,
    dphi: Vec<f64>,
    count: usize,
    repeats: bool,
    /// Standard deviation of DoLP, and of the BRDF relative to its value.
    noise: Option<f64>,
    brdf_noise: Option<f64>,
    fix: Vec<String>,
    free: Vec<String>,
    /// The parameters that are to become certain; none for all that are free.
    wanted: Vec<String>,
    given: Option<Py<Measurement>>,
}

/// Angles in degrees and how often; value and efficiency of the criterion; predicted standard errors; what stays open.
type Choice = (Vec<([f64; 3], usize)>, f64, f64, Vec<(&'static str, Option<f64>)>, Vec<String>);

fn set(names: &[String]) -> PyResult<ParameterSet> {
    names.iter().map(|name| parameter(name)).collect()
}

/// Chooses angles of a grid, and predicts what they determine of the first surface.
#[pyfunction]
pub fn choose_angles(py: Python<'_>, request: Request, progress: Option<Py<PyAny>>) -> PyResult<Choice> {
    let model = preset(&request.model)?.model;
    for (name, noise) in [("noise", request.noise), ("brdf_noise", request.brdf_noise)] {
        if let Some(noise) = noise.filter(|&noise| !(noise > 0.0 && noise.is_finite())) {
            return Err(refused(format_args!("{name} = {noise}; expected a standard deviation above 0, or None where it is not measured")));
        }
    }
    if request.noise.is_none() && request.brdf_noise.is_none() {
        return Err(refused("neither noise nor brdf_noise is given; state how well DoLP or BRDF is measured"));
    }
    let noise = NoiseModel { dolp: request.noise, brdf: request.brdf_noise };
    let grid = CandidateGrid::new(&request.theta_i, &request.theta_r, &request.dphi).map_err(refused)?;
    let surfaces: Vec<Parameters> =
        request.surfaces.iter().map(|values| Ok(*surface(&request.model, values)?.parameters())).collect::<PyResult<_>>()?;
    let first = *surfaces.first().ok_or_else(|| refused("parameters: the list is empty; expected at least one surface"))?;
    let one = grid.geometry(0).map_err(refused)?;
    // What is free by default depends on what is measured, not on where.
    let mut design = Design::new(model, first, vec![one], noise);
    let freed = set(&request.free)?.intersection(model.parameters());
    design.free = design.free.without_all(set(&request.fix)?).union(freed);
    design.given = request.given.as_ref().map_or_else(Vec::new, |given| given.get().measurement.rows.clone());
    let wanted = request.wanted.iter().map(|name| parameter(name)).collect::<PyResult<Vec<Parameter>>>()?;
    let asked = AngleChoice {
        model,
        surfaces,
        noise,
        free: design.free,
        grid,
        given: design.given.clone(),
        count: request.count,
        repeats: request.repeats,
        criterion: if wanted.is_empty() { DesignCriterion::Determinant } else { DesignCriterion::Variances(wanted) },
    };
    let chosen =
        watched(py, progress.as_ref(), |watch| watch.fit_quietly(|observer| choose(&asked, observer, &|share| watch.tell_share(share))))?
            .map_err(refused)?;
    let repeated = chosen.angles.iter().flat_map(|&(angles, times)| std::iter::repeat_n(angles, times));
    design.geometries =
        repeated.map(|[theta_i, theta_r, dphi]| geometry(theta_i, theta_r, dphi)).collect::<Result<_, _>>().map_err(refused)?;
    let predicted = py.detach(|| design.predict()).map_err(refused)?;
    let errors = predicted.errors.iter().map(|&(parameter, error)| (parameter.key(), error)).collect();
    let open = predicted.undetermined.iter().map(ToString::to_string).collect();
    Ok((chosen.angles, chosen.value, chosen.efficiency, errors, open))
}
