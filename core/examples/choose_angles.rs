//! Predicted standard errors of three choices of angles, before anything is measured.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use pbrdf::fit::{Design, NoiseModel};
use pbrdf::measurement::grid_geometries;
use pbrdf::rounding::with_error;
use pbrdf::{Model, Parameters};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let surface = Parameters::default();
    let theta_r: Vec<f64> = (0..16).map(|i| f64::from(5 * i)).collect();
    let noise = NoiseModel { dolp: Some(0.005), brdf: Some(0.02) };
    for theta_i in [&[45.0][..], &[30.0, 60.0], &[20.0, 50.0, 75.0]] {
        let geometries = grid_geometries(theta_i, &theta_r, 180.0)?;
        let prediction = Design::new(Model::CAUCHY, surface, geometries, noise).predict()?;
        println!("angles of incidence {theta_i:?}:");
        for (parameter, error) in &prediction.errors {
            let (value, error) = with_error(surface[*parameter], *error);
            println!("  {:>4} = {value} ± {}", parameter.symbol(), error.as_deref().unwrap_or("undetermined"));
        }
        prediction.undetermined.iter().for_each(|direction| println!("  {direction}"));
    }
    Ok(())
}
